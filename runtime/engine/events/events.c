/* Events: a coupling passes a boundary of its path or changes its state, a quantity passes a threshold, a function of
 * the user changes sign. */
#include "base/underflow.h"
#include "equations/equations.h"
#include "equations/run.h"
#include "events/events.h"

#include <math.h>

#define MAX_TRIALS 80 /* trial steps for the end on an event */
/* number of trials after which every second one halves the interval, since rounding may dominate the value */
#define SECANT_TRIALS 10
#define MIN_BRACKET 1e-13 /* of the duration: shorter intervals are not divided */
/* of Newton's tolerance near an event, so that its error does not decide the instant */
#define NEWTON_TOLERANCE_FACTOR 1e-2
/* of a segment, or of the change of an event function in the step: distance of the step's end from an event */
#define EVENT_TOLERANCE 1e-13
#define BOUNDARY_ERROR_SHARE 1e-2 /* of the permitted error: that of an event beside a boundary */
/* of the change of a distance in the step: distance of an adaptive step's end from a deferrable event */
#define DEFERRED_TOLERANCE 1e-6
#define MAX_BOUNDARY_DISTANCE 1e-6 /* of a segment: largest distance of a step's end from a boundary */
#define SMALLEST_VALUE 1e-300      /* a value with a sign that is nearly zero */

const fu_event fu_no_event = {FU_NO_EVENT, 0, 0, 0};

const double *fu_event_accelerations(const fu_run *run, const fu_state *state)
{
    fu_run *scratch = (fu_run *)run; /* a run is never a constant object */
    int known = run->event_solution;
    if (known == FU_SOLVE_ANEW || known == FU_SOLVE_ONCE) {
        const int failed = fu_accelerations(run->model, state, &scratch->accelerator, run->event_work, 0);
        if (known == FU_SOLVE_ONCE) scratch->event_solution = failed ? FU_HAS_NO_SOLUTION : FU_IS_SOLVED;
        known = failed ? FU_HAS_NO_SOLUTION : FU_IS_SOLVED;
    }
    return known == FU_IS_SOLVED ? run->event_work : 0;
}

/* Returns a component of a coupling's row of output; NaN if eq 38 has no solution. */
static double output_of(const fu_run *run, const fu_state *state, const fu_coupling *c, int which)
{
    const double *acceleration = fu_event_accelerations(run, state);
    double *out = run->event_work + run->model->n_dof;
    if (!acceleration) return NAN;
    c->type->outputs(run->model, c, state, acceleration, &run->accelerator, out);
    return out[which];
}

/* Returns the value of the caller's function, which runs with the floating-point mode outside of the time loop. */
static double called(const fu_run *run, const fu_state *state, int k)
{
    const unsigned before = fu_underflow();
    fu_set_underflow(before & ~FU_TINY_IS_ZERO);
    const double value = run->call(run->context, k, state);
    fu_set_underflow(before);
    return value;
}

/* Returns the value of an event function of the user or of a coupling. */
static double value_of(const fu_run *run, const fu_state *state, int k)
{
    const fu_event_function *function = &run->event_functions[k];
    if (function->kind == FU_EVENT_OF_Q) return state->q[function->index] - function->value;
    if (function->kind == FU_EVENT_OF_V) return state->v[function->index] - function->value;
    if (function->kind == FU_EVENT_OF_S) return state->s[function->index] - function->value;
    if (function->kind == FU_EVENT_OF_CALL) return called(run, state, k);
    const fu_coupling *c = run->model->couplings[function->index];
    if (function->kind == FU_EVENT_OF_RATE) return c->events->path->rate(run->model, c, state) - function->value;
    if (function->kind == FU_EVENT_OF_OUTPUT) return output_of(run, state, c, function->which) - function->value;
    return c->events->of_state ? c->events->of_state->value(run->model, c, state, function->which)
                               : c->events->value(run, c, state, function->which);
}

/* Returns the value of an event at a state: the event happens where it reaches zero from below. */
static double value(const fu_run *run, const fu_state *state, fu_event event)
{
    if (event.kind == FU_EVENT_FUNCTION) return event.side * value_of(run, state, event.which);
    const fu_coupling *c = run->model->couplings[event.which];
    const int boundary = run->now.segment[c->coordinate] + (event.side > 0);
    const fu_path path = fu_path_of(run->model, c, state);
    return event.side * (fu_path_coordinate(path, c, state) - fu_boundary(path, boundary));
}

/* Returns the event of an event function that passes zero between the stored value and this one, else none. */
static fu_event passes(const fu_run *run, int k, double after)
{
    const double before = run->event_values[k];
    const int side = before < 0.0 && after >= 0.0 ? 1 : before > 0.0 && after < 0.0 ? -1 : 0;
    return side && run->event_functions[k].direction * side >= 0 ? (fu_event){FU_EVENT_FUNCTION, k, side, 0}
                                                                 : fu_no_event;
}

/* Returns the boundary deferred event of the coupling of `next` that is farthest outside its segment, else the first
 * event function that passes zero between `now` and `next`; without the event `but`. */
fu_event fu_find_event(fu_run *run, fu_event but)
{
    fu_event found = fu_no_event;
    const fu_event_function_list near = fu_near_event_functions(run, &run->next);
    double worst = 0.0;
    FU_EACH_COUPLING(c, run->model->always_active, run->model->n_always_active) {
        const fu_path path = fu_path_of(run->model, c, &run->next);
        int side;
        if (!path.n) continue;
        const double d = fu_outside(run->model, c, &run->next, &side) - fu_boundary_tolerance(path);
        if (d > worst && (but.kind != FU_PATH_BOUNDARY || but.which != c->number)) {
            worst = d;
            found = (fu_event){FU_PATH_BOUNDARY, c->number, side, 0};
        }
    }
    run->event_solution = FU_SOLVE_ONCE;
    for (int i = 0; i < near.n && !found.kind; ++i) {
        const int k = fu_event_function_of(near, i);
        if (but.kind == FU_EVENT_FUNCTION && but.which == k) continue;
        found = passes(run, k, value_of(run, &run->next, k));
        if (found.kind && fu_is_far_event_function(run, k))
            run->event_values[k] = value_of(run, &run->now, k); /* which was not evaluated before */
    }
    run->event_solution = FU_SOLVE_ANEW;
    return found;
}

/* Returns the part of a step at which g = g_low + rate x + ... reaches zero on its way to g_high, by the parabola. */
static double root_of_parabola(double g_low, double g_high, double rate)
{
    const double bend = g_high - g_low - rate, square = rate * rate - 4.0 * bend * g_low;
    return square > 0.0 ? -2.0 * g_low / (rate + sqrt(square)) : -g_low / (g_high - g_low);
}

/* Returns the coupling of an event that gives its instant itself; null for none. */
static const fu_coupling *passing(const fu_run *run, fu_event event)
{
    const fu_coupling *c = event.kind == FU_EVENT_FUNCTION ? fu_event_coupling(run, event.which) : 0;
    return c && c->events->deferred ? c : 0;
}

/* Returns whether a step may end slightly off an event: the slope of a force is discontinuous there, which is
 * negligible over so short a distance, and the instant follows from the rate (run/event_handling.c). */
static int may_miss(const fu_run *run, fu_event event)
{
    const fu_coupling *c = passing(run, event);
    return c && fu_can_defer(c) && run->fixed_step <= 0.0;
}

/* End of a step at an event: the event's value is `aim` there, within `close`. */
typedef struct {
    double aim, close;
} landing_place;

/* Returns the required distance of a step's end from an event: beyond a deferrable one, so that it does not recur. A
 * coupling that continues in the next segment, at a distance d from the boundary, has moved along the wrong curve,
 * whose direction is wrong by d times the jump of r_xx: its velocity by less than rate d/length for segments that bend
 * by less than a radian. Over the step that must be small beside the permitted error. */
static landing_place landing(const fu_run *run, fu_event event, double range)
{
    if (event.kind == FU_EVENT_FUNCTION)
        return may_miss(run, event)
                   ? (landing_place){0.5 * DEFERRED_TOLERANCE * range, 0.5 * DEFERRED_TOLERANCE * range}
                   : (landing_place){0.0, EVENT_TOLERANCE * range};
    const fu_coupling *c = run->model->couplings[event.which];
    const fu_path path = fu_path_of(run->model, c, &run->now);
    const int next = run->now.segment[c->coordinate] + event.side;
    if (run->fixed_step > 0.0 || next < 0 || next >= path.n) return (landing_place){0.0, EVENT_TOLERANCE * path.length};
    const double shorter = fmin(fu_path_segment_length(path, next), fu_path_segment_length(path, next - event.side));
    return (landing_place){
        0.0, fmax(EVENT_TOLERANCE * path.length,
                  fmin(MAX_BOUNDARY_DISTANCE, BOUNDARY_ERROR_SHARE * run->allowed / (path.unit * range)) * shorter)};
}

/* Returns whether an event belongs to an event function of a coupling, whose value leaves its zero again after each
 * event. */
static int is_of_a_coupling(const fu_run *run, fu_event event)
{
    return event.kind == FU_EVENT_FUNCTION && fu_event_coupling(run, event.which);
}

/* An interval of steps in which the event's value g passes zero: g_low < 0 <= g_high. */
typedef struct {
    double low, high, g_low, g_high;
    int last; /* the side that moved last: 1 high, -1 low */
} bracket;

static double secant(const bracket *b)
{
    return b->low + (b->high - b->low) * b->g_low / (b->g_low - b->g_high);
}

/* Narrows the bracket by g at `middle`; the value of an end that stays twice is halved (Illinois method). */
static void narrow(bracket *b, double middle, double g)
{
    const int side = g >= 0.0 ? 1 : -1;
    if (side > 0) {
        b->high = middle;
        b->g_high = g;
        if (b->last > 0) b->g_low *= 0.5;
    } else {
        b->low = middle;
        b->g_low = g;
        if (b->last < 0) b->g_high *= 0.5;
    }
    b->last = side;
}

/* Moves the low end, for an event that has just happened and whose value leaves its zero again, to where it is off that
 * zero again. Returns 1 if found, 0 if there is none, -1 if a step fails. */
static int leave_zero(fu_run *run, fu_event event, bracket *b, double least, double close)
{
    for (b->low = 0.5 * b->high; b->low > least; b->low *= 0.5) {
        if (run->integrator->step(run, b->low)) return -1;
        b->g_low = value(run, &run->next, event);
        if (b->g_low < -close) return 1;
        b->high = b->low;
        b->g_high = b->g_low;
    }
    return 0;
}

/* Shortens the step until it ends at the event; returns the step, 0 on failure. `next` is there then. */
static double search(fu_run *run, fu_event event, bracket b, double middle, double least, landing_place at)
{
    b.g_low -= at.aim;
    b.g_high -= at.aim;
    for (int i = 0; i < MAX_TRIALS; ++i) {
        /* rounding may dominate g */
        if (!(middle > b.low && middle < b.high) || (i > SECANT_TRIALS && i % 2)) middle = 0.5 * (b.low + b.high);
        if (run->integrator->step(run, middle)) return 0.0;
        const double g = value(run, &run->next, event) - at.aim;
        if (fabs(g) <= at.close || (g >= 0.0 && middle - b.low <= least)) return middle;
        narrow(&b, middle, g);
        if (g < 0.0 && b.high - b.low <= least) return run->integrator->step(run, b.high) ? 0.0 : b.high;
        middle = secant(&b);
    }
    return 0.0;
}

/* The same from the step h, which leads beyond the event. */
static double locate(fu_run *run, fu_event event, double h)
{
    bracket b = {0.0, h, 0.0, value(run, &run->next, event), 0};
    b.g_low =
        event.kind == FU_EVENT_FUNCTION ? event.side * run->event_values[event.which] : value(run, &run->now, event);
    const double least = MIN_BRACKET * run->duration;
    const landing_place at = landing(run, event, b.g_high - b.g_low);
    double middle = h * b.g_low / (b.g_low - b.g_high);
    if (event.kind == FU_PATH_BOUNDARY) {
        const fu_coupling *c = run->model->couplings[event.which];
        const double rate = event.side * fu_path_rate(fu_path_of(run->model, c, &run->now), run, c, &run->now);
        middle = h * root_of_parabola(b.g_low, b.g_high, h * rate);
    }
    const fu_coupling *passes = passing(run, event);
    const char *unused;
    if (passes)
        middle = h * passes->events->deferred->part(run->model, passes, &run->now, &run->next, h,
                                                    !run->integrator->keeps_energy, &unused);
    if (b.g_high <= at.aim + at.close) return h;
    if (is_of_a_coupling(run, event) &&
        fabs(b.g_low) <= (at.aim > 0.0 ? EVENT_TOLERANCE * (b.g_high - b.g_low) : at.close)) {
        const int found = leave_zero(run, event, &b, least, at.close);
        if (found < 0) return 0.0;
        if (!found) return b.high < h || !run->integrator->step(run, b.high) ? b.high : 0.0;
        middle = secant(&b);
    }
    return search(run, event, b, middle, least, at);
}

/* Shortens the step h, which leads beyond an event, until it ends there, with couplings that keep their segments until
 * one leaves its segment. Returns the step, 0 on failure; `next` is there then. */
double fu_locate(fu_run *run, fu_event event, double h)
{
    const int saved = run->keep_segments;
    run->keep_segments |= event.kind == FU_PATH_BOUNDARY;
    run->newton_tolerance *= NEWTON_TOLERANCE_FACTOR;
    const double found = locate(run, event, h);
    run->keep_segments = saved;
    return found;
}

/* Evaluates event functions at `now`, after a step of h, except those that have just passed, which rounding could let
 * pass again. `late` records those that passed together with the event of the step. */
void fu_evaluate_event_functions(fu_run *run, fu_event event, double h)
{
    const int moved = h > FU_AT_ONCE * run->duration;
    const fu_event_function_list near = fu_near_event_functions(run, &run->now);
    run->event_solution = FU_SOLVE_ONCE;
    for (int i = 0; i < near.n; ++i) {
        const int k = fu_event_function_of(near, i);
        const int expected = event.kind == FU_EVENT_FUNCTION && event.which == k;
        const double value = expected ? 0.0 : value_of(run, &run->now, k);
        const fu_event late = passes(run, k, value);
        if (expected || late.kind) run->event_values[k] = 0.0;
        else if (value != 0.0 && (moved || run->event_values[k] != 0.0)) run->event_values[k] = value;
        if (!expected && late.kind) fu_set_late(run, k, late.side);
    }
    run->event_solution = FU_SOLVE_ANEW;
}

/* Evaluates at `now` the event functions of far pairs (couplings/common/proximity.c), which are not updated
 * otherwise. */
void fu_evaluate_far_event_functions(fu_run *run)
{
    for (int k = 0; k < run->n_event_functions; ++k)
        if (fu_is_far_event_function(run, k)) run->event_values[k] = value_of(run, &run->now, k);
}

/* Returns whether an event function of a coupling is not finite: then it cannot continue, and the cause is recorded. */
int fu_has_lost_an_event(fu_run *run)
{
    const fu_event_function_list near = fu_near_event_functions(run, &run->now);
    for (int i = 0; i < near.n; ++i) {
        const int k = fu_event_function_of(near, i);
        const fu_coupling *c = fu_event_coupling(run, k);
        if (c && isnan(run->event_values[k])) return fu_fail(run, FU_NOT_KNOWN, run->now.v, c->number);
    }
    return 0;
}

/* Sets the signs of the couplings' event functions after a change of a coupling (its number, or -1), one of whose
 * values has just been zero. */
void fu_restart_event_functions(fu_run *run, int coupling)
{
    const fu_event_function_list near = fu_near_event_functions(run, &run->now);
    run->event_solution = FU_SOLVE_ONCE;
    for (int i = 0; i < near.n; ++i) {
        const int k = fu_event_function_of(near, i);
        const fu_coupling *c = fu_event_coupling(run, k);
        if (!c) continue;
        if (c->number == coupling) run->late[k] = 0;
        if (run->late[k]) continue;
        const fu_coupling_events *events = c->events;
        const int sign = events->sign ? events->sign(run->model, c, &run->now, run->event_functions[k].which) : -1;
        run->event_values[k] = sign * fmax(sign * value_of(run, &run->now, k), SMALLEST_VALUE);
    }
    run->event_solution = FU_SOLVE_ANEW;
}

void fu_set_late(fu_run *run, int function, int side)
{
    run->late[function] = side;
    run->may_be_late = 1;
}

/* Returns an event that passed together with another one, and is still to happen; none if there is none. */
fu_event fu_late_event(fu_run *run)
{
    for (int k = 0; run->may_be_late && k < run->n_event_functions; ++k)
        if (run->late[k]) {
            const fu_event event = {FU_EVENT_FUNCTION, k, run->late[k], 0};
            run->late[k] = 0;
            return event;
        }
    run->may_be_late = 0;
    return fu_no_event;
}
