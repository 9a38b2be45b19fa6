/* Grazing events: an event function passes zero within a step and returns by its end, as in a grazing contact. The
 * step then ends at the predicted largest excursion beyond zero, by the cubic through values and rates at both ends
 * (Hermite).
 *
 * The prediction serves event functions that are plain numbers: entries of q, v and s, ends of buffers, bounds and
 * reversals of forces between points, and lines in contact. Without it, a double root within a step is found only if a
 * step happens to end between the roots. The cubic is sufficient here, since these functions are smooth over a step;
 * distances between bodies use couplings/common/continuous_detection.c.
 */
#include "base/cubic.h"
#include "bodies/rotation.h"
#include "equations/run.h"
#include "events/events.h"
#include "couplings/common/coupling_events.h"

#include <math.h>

/* of the values of an event function and its arguments: smaller excursions are rounding */
#define ROUNDING_OF_VALUES 1e-14

/* Returns the rate of an entry of the configuration, 1/s or m/s. */
static double rate_of_q(const fu_model *model, const fu_state *state, int index)
{
    if (!model->n_bodies || index < model->bodies[0].configuration) return state->v[index];
    for (int b = model->n_bodies - 1; b >= 0; --b) {
        const fu_body *body = &model->bodies[b];
        const int k = index - body->configuration;
        double rate[FU_FRAME_ENTRIES];
        if (k < 0) continue;
        if (k >= body->kernel->configuration)
            return state->v[body->dof + body->kernel->velocity + k - body->kernel->configuration];
        body->kernel->rate(state->q + body->configuration, state->v + body->dof, rate);
        return rate[k];
    }
    return NAN;
}

/* Computes value and rate of an event function of the state itself; the rate of others is NaN. */
static fu_course course_of(const fu_model *model, const fu_event_function *function, const fu_state *state)
{
    if (function->kind == FU_EVENT_OF_Q)
        return (fu_course){state->q[function->index] - function->value, rate_of_q(model, state, function->index)};
    if (function->kind == FU_EVENT_OF_V)
        return (fu_course){state->v[function->index] - function->value, state->acceleration[function->index]};
    FU_EACH_COUPLING(c, model->always_active, function->kind == FU_EVENT_OF_S ? model->n_always_active : 0) {
        if (c->n_coordinates && c->coordinate == function->index)
            return (fu_course){state->s[function->index] - function->value, c->events->path->rate(model, c, state)};
    }
    return (fu_course){0.0, NAN};
}

/* Returns the part of a step after which an event function that has just passed to this side is farthest there, and is
 * back at the end; 0 if it is not. Without this check its deferred return would be missed. */
static double return_of(fu_course from, fu_course to, double h, double least)
{
    const int side = from.rate > 0.0 ? 1 : -1;
    const fu_step_ends ends = {{0.0, -side * to.value}, {-fabs(from.rate), -side * to.rate}};
    const double x = fu_part_of_minimum(&ends, h);
    return ends.value[1] > least && x > 0.0 && x < 1.0 && fabs(h * from.rate) > least ? x * h : 0.0;
}

/* Returns the time of the largest excursion of an event function beyond zero in the step, s after `now`. */
static double grazing_of(const fu_run *run, int k, double h)
{
    const fu_event_function *function = &run->event_functions[k];
    const fu_coupling *c = fu_event_coupling(run, k);
    if (c) return c->events->grazing ? c->events->grazing(run, c, function->which, h) : 0.0;
    const fu_course from = course_of(run->model, function, &run->now), to = course_of(run->model, function, &run->next);
    if (isnan(from.rate)) return 0.0;
    const double least = ROUNDING_OF_VALUES * fmax(fabs(function->value), fmax(fabs(from.value + function->value),
                                                                               fabs(to.value + function->value)));
    if (run->event_values[k] == 0.0) return return_of(from, to, h, least);
    return fu_grazing_time(from, to, run->event_values[k] > 0.0 ? 1 : -1, h, least);
}

/* Returns the time of the largest excursion of the first event function that passes zero and returns within the step, s
 * after `now`; 0 if none is predicted. */
double fu_time_of_grazing(const fu_run *run, double h)
{
    double first = 0.0;
    const fu_event_function_list near = fu_near_event_functions_within(run, h);
    for (int i = 0; i < near.n; ++i) {
        const double grazing = grazing_of(run, fu_event_function_of(near, i), h);
        if (grazing > 0.0 && (first == 0.0 || grazing < first)) first = grazing;
    }
    return first;
}
