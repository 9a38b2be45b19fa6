/* Search for near pairs: clearances of couplings measured again, and event functions that may pass zero.
 *
 * couplings/common/proximity.c explains the search and the interval between two searches. */
#include "equations/run.h"
#include "events/events.h"

#include <math.h>
#include <string.h>

#define STEPS_PER_UPDATE 16        /* for which a search should suffice */
#define MAX_STEPS_PER_UPDATE 256   /* steps after which the search is repeated, since motions may have become slower */
#define ROUNDING_OF_CLEARANCE 1e-9 /* of clearances, path lengths and positions */

/* Computes the speeds of a moving part, m/s and rad/s. */
static void speeds_of(const fu_model *model, int mover, const double *v, double *speed, double *spin)
{
    const fu_body *body = fu_body_of_mover(model, mover);
    *spin = 0.0;
    if (!body) {
        *speed = fu_most_of_cable(&model->cables[mover], v, 0);
        return;
    }
    const double *w = v + body->dof;
    *speed = sqrt(fu_dot(model->dim, w, w));
    for (int i = model->dim; i < body->kernel->velocity; ++i) *spin += w[i] * w[i];
    *spin = sqrt(*spin);
}

static fu_event_function_list every_function(const fu_run *run)
{
    return (fu_event_function_list){0, run->n_event_functions};
}

static fu_event_function_list near_functions(const fu_run *run)
{
    return (fu_event_function_list){run->model->proximity->near_functions, run->model->proximity->n_near_functions};
}

fu_event_function_list fu_near_event_functions(const fu_run *run, const fu_state *state)
{
    return run->model->n_pairs && fu_movers_are_near(run->model, state->q) ? near_functions(run) : every_function(run);
}

/* A cubic moves no farther from its ends than a third of the step at their rates. */
fu_event_function_list fu_near_event_functions_within(const fu_run *run, double h)
{
    const fu_model *model = run->model;
    const fu_proximity *p = model->proximity;
    const fu_state *ends[2] = {&run->now, &run->next};
    if (!model->n_pairs || !p->is_known) return every_function(run);
    for (int m = 0; m < p->n_movers; ++m)
        for (int end = 0; end < 2 && p->movers[m].pairs; ++end) {
            double displacement, turn, speed, spin;
            fu_mover_gone_by(model, m, ends[end]->q, &displacement, &turn);
            speeds_of(model, m, ends[end]->v, &speed, &spin);
            displacement += 0.34 * h * (speed + spin * p->movers[m].radius);
            turn += 0.34 * h * spin;
            if (!(displacement <= p->movers[m].displacement && turn <= p->movers[m].turn)) return every_function(run);
        }
    return near_functions(run);
}

int fu_is_far_event_function(const fu_run *run, int function)
{
    const fu_coupling *c = fu_event_coupling(run, function);
    return c && run->model->n_pairs && run->model->proximity->is_known && run->model->proximity->is_far[c->number];
}

/* Returns the path length of a pair's parts so far, or its limit until the next search. */
static double used_by(const fu_proximity *p, const fu_pair *pair, int ahead)
{
    double sum = 0.0;
    for (int i = 0; i < 2; ++i) {
        if (pair->between[i] < 0) continue;
        const fu_mover *mover = &p->movers[pair->between[i]];
        sum += ahead ? mover->displacement : mover->travelled;
        if (i) sum += pair->lever * (ahead ? mover->turn : mover->turned);
    }
    return sum;
}

/* Measures a pair at a state. The lever grows by no more than the gap before that is used up. */
static void measure(const fu_model *model, fu_pair *pair, const fu_state *state)
{
    const fu_coupling *c = model->couplings[pair->coupling];
    fu_proximity *p = model->proximity;
    const fu_clearance found = c->type->proximity->clearance(model, c, state);
    pair->lever = found.lever + fmax(found.gap, 0.0);
    pair->limit = found.gap * (1.0 - ROUNDING_OF_CLEARANCE) + used_by(p, pair, 0);
    if (pair->between[0] >= model->n_cables)
        p->movers[pair->between[0]].radius = fmax(p->movers[pair->between[0]].radius, found.radius);
}

/* Returns whether a pair stays far while its parts move within their limit until the next search. */
static int stays_far(const fu_run *run, const fu_pair *pair)
{
    const fu_proximity *p = run->model->proximity;
    const double ahead = used_by(p, pair, 1);
    return pair->limit - used_by(p, pair, 0) > ahead + ROUNDING_OF_CLEARANCE * (ahead + run->extent);
}

/* Returns whether all pairs of one first part stay far: their margin exceeds what it and the carriers have moved since
 * it was known, and may move until the next search. */
static int group_stays_far(const fu_run *run, const fu_mover *mover)
{
    const fu_proximity *p = run->model->proximity;
    const fu_pair_group *group = &mover->group;
    const double used = mover->travelled - group->travelled + (p->carried - group->carried) +
                        group->lever * (p->carried_turn - group->carried_turn);
    const double ahead = mover->displacement + p->carrier_displacement + group->lever * p->carrier_turn;
    return group->margin - used > ahead + ROUNDING_OF_CLEARANCE * (ahead + run->extent);
}

/* Measures the pairs of one first part that may be near before the next search, or all of them, and records the far
 * ones; returns whether they are others than before. */
static int sort_group(fu_run *run, fu_mover *mover, const fu_state *state, int all)
{
    fu_proximity *p = run->model->proximity;
    fu_pair_group *group = &mover->group;
    int changed = 0;
    group->travelled = mover->travelled;
    group->carried = p->carried;
    group->carried_turn = p->carried_turn;
    group->margin = INFINITY;
    group->lever = 0.0;
    for (int k = group->first; k < group->first + group->n; ++k) {
        fu_pair *pair = &p->pairs[k];
        if (all || !stays_far(run, pair)) measure(run->model, pair, state);
        const char is_far = (char)stays_far(run, pair);
        changed |= is_far != p->is_far[pair->coupling];
        p->is_far[pair->coupling] = is_far;
        const double margin = pair->limit - used_by(p, pair, 0);
        if (!(margin >= group->margin)) group->margin = margin;
        group->lever = fmax(group->lever, pair->lever);
    }
    return changed;
}

/* The same for all pairs. */
static int sort_pairs(fu_run *run, const fu_state *state, int all)
{
    fu_proximity *p = run->model->proximity;
    int changed = 0;
    for (int m = 0; m < p->n_movers; ++m)
        if (p->movers[m].group.n && (all || !group_stays_far(run, &p->movers[m])))
            changed |= sort_group(run, &p->movers[m], state, all);
    return changed;
}

/* Lists the near pairs. */
static void list_near(fu_run *run)
{
    const fu_model *model = run->model;
    fu_proximity *p = model->proximity;
    p->n_near = p->n_near_functions = 0;
    FU_EACH_COUPLING(c, model->couplings, model->n_couplings)
        if (!p->is_far[c->number] || !p->is_alone[c->number]) p->near[p->n_near++] = c;
    p->is_known = 1;
    for (int k = 0; k < run->n_event_functions; ++k)
        if (!fu_is_far_event_function(run, k)) p->near_functions[p->n_near_functions++] = k;
}

/* Adds the path lengths of parts since the last search; returns whether one has used half of its limit. */
static int add_path_lengths(const fu_model *model, const fu_state *state, double *displacements, double *turns)
{
    const fu_proximity *p = model->proximity;
    int is_late = 0;
    for (int m = 0; m < p->n_movers; ++m) {
        displacements[m] = turns[m] = 0.0;
        if (!p->movers[m].pairs) continue;
        fu_mover_gone_by(model, m, state->q, &displacements[m], &turns[m]);
        is_late |= !(displacements[m] <= 0.5 * p->movers[m].displacement && turns[m] <= 0.5 * p->movers[m].turn);
    }
    return is_late;
}

/* Sets the limits of parts until the next search to their recent or present motion over several steps of h. */
static void expect(const fu_model *model, const fu_state *state, double h, int steps, const double *displacements,
                   const double *turns)
{
    fu_proximity *p = model->proximity;
    double carried = 0.0, carried_turn = 0.0;
    p->carrier_displacement = p->carrier_turn = 0.0;
    for (int m = 0; m < p->n_movers; ++m) {
        fu_mover *mover = &p->movers[m];
        double speed, spin;
        if (!mover->pairs) continue;
        speeds_of(model, m, state->v, &speed, &spin);
        mover->travelled += displacements[m];
        mover->turned += turns[m];
        mover->displacement = STEPS_PER_UPDATE * fmax(displacements[m] / steps, h * (speed + spin * mover->radius));
        mover->turn = STEPS_PER_UPDATE * fmax(turns[m] / steps, h * spin);
        if (!mover->is_carrier) continue;
        carried = fmax(carried, displacements[m]);
        carried_turn = fmax(carried_turn, turns[m]);
        p->carrier_displacement = fmax(p->carrier_displacement, mover->displacement);
        p->carrier_turn = fmax(p->carrier_turn, mover->turn);
    }
    p->carried += carried;
    p->carried_turn += carried_turn;
}

void fu_search_near_pairs(fu_run *run, double h, int anew)
{
    const fu_model *model = run->model;
    fu_proximity *p = model->proximity;
    if (!model->n_pairs) return;
    double *displacements = p->displacements, *turns = p->displacements + p->n_movers;
    anew |= !p->is_known;
    ++p->age;
    if (anew) memset(displacements, 0, sizeof(double) * 2 * (size_t)p->n_movers);
    else if (!add_path_lengths(model, &run->now, displacements, turns) && p->age < MAX_STEPS_PER_UPDATE) return;
    expect(model, &run->now, run->fixed_step > 0.0 ? run->fixed_step : fmax(h, run->h), p->age, displacements, turns);
    memcpy(p->at, run->now.q, sizeof(double) * (size_t)model->n_q);
    if (sort_pairs(run, &run->now, anew) || anew) list_near(run);
    p->age = 0;
}
