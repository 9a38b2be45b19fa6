/* Events: a slide leaves its element, a quantity passes a threshold, a function of the user's changes sign. */
#include "engine.h"

#define MOST_TRIALS 80

static double boundary_tolerance(const fu_run *run, int j)
{
    return 1e-11 * run->model->cables[run->model->joints[j].cable].length;
}

/* how far s lies outside its element, negative inside */
static double outside(const fu_run *run, const fu_state *state, int j, int *side)
{
    const double length = run->model->cables[run->model->joints[j].cable].length;
    const double x = state->s[j] - fu_element_start(run->model, j, state->element[j]);
    *side = x > 0.5 * length ? 1 : -1;
    return *side > 0 ? x - length : -x;
}

/* what an event of the user's watches, positive where it has happened when `side` is 1 */
static double watched(const fu_run *run, const fu_state *state, int k)
{
    const fu_watch *watch = &run->watches[k];
    switch (watch->kind) {
    case FU_WATCH_Q: return state->q[watch->index] - watch->value;
    case FU_WATCH_V: return state->v[watch->index] - watch->value;
    case FU_WATCH_S: return state->s[watch->index] - watch->value;
    default: return run->call(run->context, k, state);
    }
}

/* an event's value at a state: it happens where this reaches zero from below */
static double value(const fu_run *run, const fu_state *state, fu_event event)
{
    if (event.kind == FU_WATCHED) return event.side * watched(run, state, event.which);
    const int boundary = run->now.element[event.which] + (event.side > 0);
    return event.side * (state->s[event.which] - fu_element_start(run->model, event.which, boundary));
}

/* whether a watch passes between the value kept and this one */
static fu_event passes(const fu_run *run, int k, double after)
{
    const double before = run->watched[k];
    const int side = before < 0.0 && after >= 0.0 ? 1 : before > 0.0 && after < 0.0 ? -1 : 0;
    return side && run->watches[k].direction * side >= 0 ? (fu_event){FU_WATCHED, k, side}
                                                         : (fu_event){FU_NO_EVENT, 0, 0};
}

/* The slide of `next` that is farthest outside its element, else the first of the user's events between `now` and
 * `next`, but for one that is known. */
fu_event fu_find_event(const fu_run *run, fu_event known)
{
    fu_event found = {FU_NO_EVENT, 0, 0};
    double worst = 0.0;
    for (int j = 0; j < run->model->n_joints; ++j) {
        int side;
        const double d = outside(run, &run->next, j, &side) - boundary_tolerance(run, j);
        if (d > worst) {
            worst = d;
            found = (fu_event){FU_CROSSING, j, side};
        }
    }
    for (int k = 0; k < run->n_watches && !found.kind; ++k)
        if (known.kind != FU_WATCHED || known.which != k) found = passes(run, k, watched(run, &run->next, k));
    return found;
}

/* Whether a slide stands on the boundary already: then the element changes and not the time. */
int fu_stands_on_boundary(const fu_run *run, fu_event event)
{
    int side;
    return event.kind == FU_CROSSING && outside(run, &run->now, event.which, &side) >=
        -boundary_tolerance(run, event.which) && side == event.side;
}

/* Shorten the step until it ends where the event happens (Illinois); returns the step, 0 on failure. `next` is there
 * then. */
double fu_locate(fu_run *run, fu_event event, double h)
{
    double low = 0.0, high = h, g_high = value(run, &run->next, event);
    double g_low = event.kind == FU_WATCHED ? event.side * run->watched[event.which] : value(run, &run->now, event);
    const double close = event.kind == FU_CROSSING ? boundary_tolerance(run, event.which) : 1e-13 * (g_high - g_low);
    const double least = 1e-13 * run->duration;
    int last = 0;
    if (g_high <= close) return h;
    for (int i = 0; i < MOST_TRIALS; ++i) {
        double middle = low + (high - low) * g_low / (g_low - g_high);
        if (!(middle > low && middle < high) || (i > 10 && i % 2)) middle = 0.5 * (low + high); /* rounding may rule g */
        if (run->integrator->step(run, middle)) return 0.0;
        const double g = value(run, &run->next, event);
        if (fabs(g) <= close) return middle;
        if (g >= 0.0) {
            if (middle - low <= least) return middle;
            high = middle;
            g_high = g;
            if (last > 0) g_low *= 0.5;
            last = 1;
        } else {
            low = middle;
            g_low = g;
            if (last < 0) g_high *= 0.5;
            last = -1;
            if (high - low <= least) return run->integrator->step(run, high) ? 0.0 : high;
        }
    }
    return 0.0;
}

/* Values of the user's events at `now`; none of those that have just passed, or rounding would let them pass again.
 * `late` tells which did together with the one that the step was for. */
void fu_watch_now(fu_run *run, fu_event event)
{
    for (int k = 0; k < run->n_watches; ++k) {
        const int known = event.kind == FU_WATCHED && event.which == k;
        const double value = known ? 0.0 : watched(run, &run->now, k);
        const fu_event late = passes(run, k, value);
        if (known || late.kind) run->watched[k] = 0.0;
        else if (value != 0.0) run->watched[k] = value;
        if (!known && late.kind) run->late[k] = late.side;
    }
}

/* An event of the user's that passed together with another one. */
fu_event fu_late_event(fu_run *run)
{
    for (int k = 0; k < run->n_watches; ++k)
        if (run->late[k]) {
            const fu_event event = {FU_WATCHED, k, run->late[k]};
            run->late[k] = 0;
            return event;
        }
    return (fu_event){FU_NO_EVENT, 0, 0};
}
