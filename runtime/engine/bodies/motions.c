/* Signals, and the dofs that follow them. */
#include "bodies/model.h"
#include "bodies/state.h"

#include <math.h>

/* Returns f(t), and its two derivatives if requested. */
double fu_signal_at(const fu_signal *signal, double t, double *rate, double *second)
{
    double f = 0.0, f1 = 0.0, f2 = 0.0;
    if (signal->n) {
        const double *breaks = signal->breaks;
        const int low = fu_last_reached(breaks, 0, signal->n, t);
        const double d = t - breaks[low];
        for (int k = FU_SIGNAL_TERMS - 1; k >= 0; --k) {
            f2 = f2 * d + 2.0 * f1;
            f1 = f1 * d + f;
            f = f * d + signal->coefficients[low * FU_SIGNAL_TERMS + k];
        }
    }
    if (signal->amplitude != 0.0) {
        const double w = signal->angular_frequency, angle = w * t + signal->phase;
        f += signal->amplitude * sin(angle);
        f1 += signal->amplitude * w * cos(angle);
        f2 -= signal->amplitude * w * w * sin(angle);
    }
    if (rate) *rate = f1;
    if (second) *second = f2;
    return f;
}

double fu_scale_at(const fu_model *model, int signal, double t)
{
    return signal < 0 ? 1.0 : fu_signal_at(&model->signals[signal], t, 0, 0);
}

/* Returns whether a motion moves its dof, so that the support's force has a power. */
int fu_supports_move(const fu_model *model, const fu_state *state)
{
    for (int k = 0; k < model->n_motions; ++k)
        if (state->v[model->motions[k].dof] != 0.0) return 1;
    return 0;
}

/* Sets position, velocity and acceleration of the prescribed dofs at state->t; several motions of one dof add up. */
void fu_prescribe(const fu_model *model, fu_state *state)
{
    for (int k = 0; k < model->n_motions; ++k) {
        const int i = model->motions[k].dof;
        state->q[i] = state->v[i] = state->acceleration[i] = 0.0;
    }
    for (int k = 0; k < model->n_motions; ++k) {
        const fu_motion *m = &model->motions[k];
        double rate, second;
        const double f = fu_signal_at(&model->signals[m->signal], state->t, &rate, &second);
        const double c = cos(f), s = sin(f), slope = m->linear - m->cosine * s + m->sine * c;
        state->q[m->dof] += m->base + m->linear * f + m->cosine * c + m->sine * s;
        state->v[m->dof] += slope * rate;
        state->acceleration[m->dof] += slope * second - (m->cosine * c + m->sine * s) * rate * rate;
    }
}
