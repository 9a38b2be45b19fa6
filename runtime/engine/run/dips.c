/* Dips: what is watched passes zero within a step and is back at its end, as by a grazing contact. The step then ends where it
 * is predicted to be farthest beyond zero, by the cubic through its values and rates at both ends (Hermite's). */
#include "engine.h"

#define NEAR 1e-2    /* of a dip: how far from zero its end may be predicted and yet be looked at */
#define NOISE 1e-14  /* of what a watch is of, and of its values: dips less deep are rounding */

/* Returns the part of a step at which the cubic with the values y and the slopes m at its ends has a minimum; not within 0 and 1
 * where it has none there. */
static double part_of_minimum(const double y[2], const double m[2])
{
    const double a = 2.0 * (y[0] - y[1]) + m[0] + m[1], b = 3.0 * (y[1] - y[0]) - 2.0 * m[0] - m[1];
    const double square = b * b - 3.0 * a * m[0];
    if (!(square > 0.0)) return 0.0;
    return b > 0.0 ? -m[0] / (b + sqrt(square)) : (sqrt(square) - b) / (3.0 * a);
}

static double cubic(const double y[2], const double m[2], double x)
{
    const double rest = 1.0 - x;
    return rest * rest * ((1.0 + 2.0 * x) * y[0] + x * m[0]) + x * x * ((3.0 - 2.0 * x) * y[1] - rest * m[1]);
}

double fu_dip(fu_course from, fu_course to, int side, double h, double least)
{
    const double y[2] = {fmax(side * from.value, 0.0), side * to.value}, m[2] = {side * h * from.rate, side * h * to.rate};
    const double x = part_of_minimum(y, m);
    if (!(side * from.value >= -least && y[1] >= 0.0) || !(x > 0.0 && x < 1.0)) return 0.0;
    const double bottom = cubic(y, m, x), depth = fmin(y[0], y[1]) - bottom;
    const double noise = least + NOISE * (y[0] + y[1] + fabs(m[0]) + fabs(m[1]));
    return depth > noise && bottom < NEAR * depth ? x * h : 0.0;
}

/* Returns the rate of an entry of the configuration, 1/s or m/s. */
static double rate_of_q(const fu_model *model, const fu_state *state, int index)
{
    if (!model->n_bodies || index < model->bodies[0].configuration) return state->v[index];
    for (int b = model->n_bodies - 1; b >= 0; --b) {
        const fu_body *body = &model->bodies[b];
        const int k = index - body->configuration;
        double rate[FU_FRAME_ENTRIES];
        if (k < 0) continue;
        if (k >= body->kernel->configuration) return state->v[body->dof + body->kernel->velocity + k - body->kernel->configuration];
        fu_body_rate(body->kernel, state->q + body->configuration, state->v + body->dof, rate);
        return rate[k];
    }
    return NAN;
}

/* Makes value and rate of a watch that is of the state itself; the rate of others is not a number. */
static fu_course course_of(const fu_model *model, const fu_watch *watch, const fu_state *state)
{
    if (watch->kind == FU_WATCH_Q)
        return (fu_course){state->q[watch->index] - watch->value, rate_of_q(model, state, watch->index)};
    if (watch->kind == FU_WATCH_V) return (fu_course){state->v[watch->index] - watch->value, state->acceleration[watch->index]};
    for (int k = 0; k < model->n_others && watch->kind == FU_WATCH_S; ++k) {
        const fu_coupling *c = model->others[k];
        if (c->n_coordinates && c->coordinate == watch->index)
            return (fu_course){state->s[watch->index] - watch->value, c->type->events->rate(model, c, state)};
    }
    return (fu_course){0.0, NAN};
}

/* Returns after what part of a step a watch that has just passed to this side is farthest there, and is back at the end; 0 where
 * it is not. Without a value of its own it would not be seen to pass back. */
static double return_of(fu_course from, fu_course to, double h, double least)
{
    const int side = from.rate > 0.0 ? 1 : -1;
    const double y[2] = {0.0, -side * to.value}, m[2] = {-fabs(h * from.rate), -side * h * to.rate};
    const double x = part_of_minimum(y, m);
    return y[1] > least && x > 0.0 && x < 1.0 && -m[0] > least ? x * h : 0.0;
}

/* Returns when a watch is farthest beyond zero in the step, s after `now`. */
static double dip_of(const fu_run *run, int k, double h)
{
    const fu_watch *watch = &run->watches[k];
    const fu_coupling *c = fu_own_coupling(run, k);
    if (c) return c->type->events->dip ? c->type->events->dip(run, c, watch->which, h) : 0.0;
    const fu_course from = course_of(run->model, watch, &run->now), to = course_of(run->model, watch, &run->next);
    if (isnan(from.rate)) return 0.0;
    const double least = NOISE * fmax(fabs(watch->value), fmax(fabs(from.value + watch->value), fabs(to.value + watch->value)));
    if (run->watched[k] == 0.0) return return_of(from, to, h, least);
    return fu_dip(from, to, run->watched[k] > 0.0 ? 1 : -1, h, least);
}

/* Returns when the first of the watches that pass zero and are back within the step is farthest beyond, s after `now`; 0 where
 * none is predicted to. */
double fu_time_of_dip(const fu_run *run, double h)
{
    double first = 0.0;
    const fu_watch_list near = fu_near_watches_within(run, h);
    for (int i = 0; i < near.n; ++i) {
        const double dip = dip_of(run, fu_watch_of(near, i), h);
        if (dip > 0.0 && (first == 0.0 || dip < first)) first = dip;
    }
    return first;
}
