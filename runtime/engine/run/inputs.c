/* Inputs: values of signals that are given from outside while a run goes on. */
#include "run/run.h"

/* Gives an input a value at `now`, with which it goes on at a rate. */
void fu_set_input(fu_run *run, int k, double value, double rate)
{
    run->inputs->inputs[k] = (fu_input){run->now.t, value, rate, 1};
}

/* Returns the value of an input at `now`, or that it has after the next step. */
double fu_input_value(const fu_run *run, int k)
{
    const fu_input *input = &run->inputs->inputs[k];
    return input->value + input->rate * (run->now.t - input->since);
}

/* Returns whether an input prescribes a position, which cannot jump. */
int fu_is_position(const fu_run *run, int k)
{
    const fu_inputs *all = run->inputs;
    for (int i = 0; i < all->n_signals; ++i)
        for (int j = 0; j < all->signals[i].n; ++j) {
            const fu_input_term *term = &all->terms[all->signals[i].first + j];
            if (all->signals[i].drives && term->input == k && !term->is_integral) return 1;
        }
    return 0;
}

/* A signal as a polynomial of the time from `now` on: value, rate, and half the second derivative. */
typedef struct {
    double c[3];
} polynomial;

/* Returns the polynomial of a signal until the end of a step; now: its value. */
static polynomial made(const fu_run *run, const fu_input_signal *signal, double now, double until)
{
    polynomial p = {{signal->constant, 0.0, 0.0}};
    int integrates = 0;
    for (int j = 0; j < signal->n; ++j) {
        const fu_input_term *term = &run->inputs->terms[signal->first + j];
        const double rate = run->inputs->inputs[term->input].rate;
        p.c[term->is_integral] += term->factor * fu_input_value(run, term->input);
        p.c[term->is_integral + 1] += term->factor * rate / (term->is_integral + 1);
        integrates |= term->is_integral;
    }
    if (!signal->drives) return p;
    if (integrates) p.c[0] = now;
    else p = (polynomial){{now, (p.c[0] - now) / (until - run->now.t), 0.0}};
    return p;
}

/* Returns whether an input of a signal has been given since the last step. */
static int is_given(const fu_inputs *all, const fu_input_signal *signal)
{
    for (int j = 0; j < signal->n; ++j)
        if (all->inputs[all->terms[signal->first + j].input].is_new) return 1;
    return 0;
}

/* Gives the signals of inputs their values for a step until a time, s; forces, and rates of driven motions, may jump.
 * Returns a status. */
int fu_give_inputs(fu_run *run, double until)
{
    const fu_inputs *all = run->inputs;
    int jumps = 0, of_rates = 0;
    for (int i = 0; i < all->n_signals; ++i) {
        const fu_input_signal *signal = &all->signals[i];
        const int given = is_given(all, signal);
        double rate, second;
        if (!given && !signal->drives) continue;
        const fu_signal *of = &run->model->signals[signal->signal];
        const double value = fu_signal_at(of, run->now.t, &rate, &second);
        const polynomial p = made(run, signal, value, until);
        if (!given && p.c[0] == value && p.c[1] == rate) continue;
        jumps |= !signal->drives && p.c[0] != value;
        of_rates |= signal->drives && p.c[1] != rate;
        double *breaks = (double *)of->breaks, *coefficients = (double *)of->coefficients;
        breaks[0] = run->now.t;
        breaks[1] = run->now.t + 1.0;
        for (int k = 0; k < FU_SIGNAL_TERMS; ++k) coefficients[k] = k < 3 ? p.c[k] : 0.0;
    }
    for (int k = 0; k < all->n; ++k) all->inputs[k].is_new = 0;
    if (!jumps && !of_rates) return FU_RUNNING;
    const fu_breakpoint now = {run->now.t, of_rates ? FU_RATE_JUMPS : FU_ACCELERATION_JUMPS};
    return fu_pass_breakpoint(run, &now, 0);
}
