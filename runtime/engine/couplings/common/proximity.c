/* Couplings that are far from acting, as most of many pairs of bodies and surfaces are: loops pass them over.
 *
 * Each such coupling tells its clearance at a configuration. It is far while the ways of what it is between have not used that up.
 * The ways are counted from look to look; between two looks each cable and body may go as far as it is expected to go in some
 * steps, which is taken off the clearances beforehand. So a state needs only its distance from the configuration of the last look,
 * cable by cable and body by body: where one has gone farther, all couplings are taken. What is passed over would give nothing, and
 * the rest stays in its order: results do not depend on when it was looked.
 */
#include "engine.h"

#include <math.h>
#include <string.h>

#define STEPS 16      /* for which a look shall do */
#define MOST_AGE 256  /* steps after which there is another look, as motions may have become slower */
#define ROUNDING 1e-9 /* of clearances, ways and places */

static const fu_body *body_of(const fu_model *model, int mover)
{
    return mover < model->n_cables ? 0 : &model->bodies[mover - model->n_cables];
}

/* Returns how far points of a cable may be moved at most by numbers that its nodal vectors differ by, or by their rates. */
static double most_of_cable(const fu_cable *cable, const double *to, const double *from)
{
    const int dim = cable->kernel->dim, vectors = cable->kernel->vectors;
    double sum = 0.0;
    for (int k = 0; k < vectors; ++k) {
        double most = 0.0;
        if (cable->share[k] == 0.0) continue;
        for (int node = 0; node <= cable->n_elements; ++node) {
            const int first = cable->first + node * cable->per_node + k * dim;
            double square = 0.0;
            for (int d = 0; d < dim; ++d) {
                const double change = to[first + d] - (from ? from[first + d] : 0.0);
                square += change * change;
            }
            most = square > most ? square : most;
        }
        sum += cable->share[k] * sqrt(most);
    }
    return sum;
}

/* Makes how far a mover is from where it was at the last look: its way, m, and the norm of the change of its axes. */
static void gone_by(const fu_model *model, int mover, const double *q, double *way, double *turn)
{
    const fu_body *body = body_of(model, mover);
    const double *from = model->proximity->at;
    *turn = 0.0;
    if (!body) {
        *way = most_of_cable(&model->cables[mover], q, from);
        return;
    }
    const double *b = q + body->configuration, *b0 = from + body->configuration;
    double square = 0.0, turned = 0.0;
    for (int i = 0; i < body->kernel->configuration; ++i) {
        const double change = b[i] - b0[i];
        *(i < model->dim ? &square : &turned) += change * change;
    }
    *way = sqrt(square);
    *turn = 2.0 * sqrt(turned); /* of unit quaternions at an angle of a/2: 2 sin(a/2) <= 2 |e - e0| */
}

/* Makes the speeds of a mover, m/s and rad/s. */
static void speeds_of(const fu_model *model, int mover, const double *v, double *speed, double *spin)
{
    const fu_body *body = body_of(model, mover);
    *spin = 0.0;
    if (!body) {
        *speed = most_of_cable(&model->cables[mover], v, 0);
        return;
    }
    const double *w = v + body->dof;
    *speed = sqrt(fu_dot(model->dim, w, w));
    for (int i = model->dim; i < body->kernel->velocity; ++i) *spin += w[i] * w[i];
    *spin = sqrt(*spin);
}

/* Returns whether no mover is farther from where it was at the last look than it may be. */
static int is_within(const fu_model *model, const double *q)
{
    const fu_proximity *p = model->proximity;
    if (!p || !p->is_known) return 0;
    for (int m = 0; m < p->n_movers; ++m) {
        double way, turn;
        if (!p->movers[m].pairs) continue;
        gone_by(model, m, q, &way, &turn);
        if (!(way <= p->movers[m].way && turn <= p->movers[m].turn)) return 0;
    }
    return 1;
}

static fu_couplings all_of(const fu_model *model)
{
    return (fu_couplings){model->couplings, model->n_couplings};
}

static fu_couplings near_of(const fu_model *model)
{
    return (fu_couplings){model->proximity->near, model->proximity->n_near};
}

/* Returns whether evaluations pass over couplings that are far: those that are more than a contact take part in all. */
static int has_lone_pairs(const fu_model *model)
{
    return model->n_others < model->n_couplings;
}

fu_couplings fu_acting(const fu_model *model, const fu_state *state)
{
    return has_lone_pairs(model) && is_within(model, state->q) ? near_of(model) : all_of(model);
}

fu_couplings fu_acting_in_step(const fu_model *model, const fu_equations *at)
{
    return has_lone_pairs(model) && is_within(model, at->now->q) && is_within(model, at->next->q) ? near_of(model) : all_of(model);
}

static fu_watch_list every_watch(const fu_run *run)
{
    return (fu_watch_list){0, run->n_watches};
}

static fu_watch_list near_watches(const fu_run *run)
{
    return (fu_watch_list){run->model->proximity->near_watches, run->model->proximity->n_near_watches};
}

fu_watch_list fu_near_watches(const fu_run *run, const fu_state *state)
{
    return run->model->n_pairs && is_within(run->model, state->q) ? near_watches(run) : every_watch(run);
}

/* A cubic goes no farther from its ends than a third of the step at their rates. */
fu_watch_list fu_near_watches_within(const fu_run *run, double h)
{
    const fu_model *model = run->model;
    const fu_proximity *p = model->proximity;
    const fu_state *ends[2] = {&run->now, &run->next};
    if (!model->n_pairs || !p->is_known) return every_watch(run);
    for (int m = 0; m < p->n_movers; ++m)
        for (int end = 0; end < 2 && p->movers[m].pairs; ++end) {
            double way, turn, speed, spin;
            gone_by(model, m, ends[end]->q, &way, &turn);
            speeds_of(model, m, ends[end]->v, &speed, &spin);
            way += 0.34 * h * (speed + spin * p->movers[m].radius);
            turn += 0.34 * h * spin;
            if (!(way <= p->movers[m].way && turn <= p->movers[m].turn)) return every_watch(run);
        }
    return near_watches(run);
}

int fu_is_far_watch(const fu_run *run, int watch)
{
    const fu_coupling *c = fu_own_coupling(run, watch);
    return c && run->model->n_pairs && run->model->proximity->is_known && run->model->proximity->is_far[c->number];
}

/* Returns what a pair's movers have gone at all, or may go until the next look. */
static double used_by(const fu_proximity *p, const fu_pair *pair, int ahead)
{
    double sum = 0.0;
    for (int i = 0; i < 2; ++i) {
        if (pair->between[i] < 0) continue;
        const fu_mover *mover = &p->movers[pair->between[i]];
        sum += ahead ? mover->way : mover->gone;
        if (i) sum += pair->lever * (ahead ? mover->turn : mover->turned);
    }
    return sum;
}

/* Measures a pair at a state. The lever grows by no more than the gap before that is used up. */
static void measure(const fu_model *model, fu_pair *pair, const fu_state *state)
{
    const fu_coupling *c = model->couplings[pair->coupling];
    fu_proximity *p = model->proximity;
    const fu_clearance found = c->type->clearance(model, c, state);
    pair->lever = found.lever + fmax(found.gap, 0.0);
    pair->limit = found.gap * (1.0 - ROUNDING) + used_by(p, pair, 0);
    if (pair->between[0] >= model->n_cables) p->movers[pair->between[0]].radius = fmax(p->movers[pair->between[0]].radius, found.radius);
}

/* Returns whether a pair stays far while its movers go no farther than they may until the next look. */
static int stays_far(const fu_run *run, const fu_pair *pair)
{
    const fu_proximity *p = run->model->proximity;
    const double ahead = used_by(p, pair, 1);
    return pair->limit - used_by(p, pair, 0) > ahead + ROUNDING * (ahead + run->extent);
}

/* Measures pairs at a state that may be near before the next look, or all of them, and notes which are far. */
static void sort_pairs(fu_run *run, const fu_state *state, int all)
{
    fu_proximity *p = run->model->proximity;
    for (int k = 0; k < p->n_pairs; ++k) {
        fu_pair *pair = &p->pairs[k];
        if (all || !stays_far(run, pair)) measure(run->model, pair, state);
        p->is_far[pair->coupling] = (char)stays_far(run, pair);
    }
}

/* Lists what is not far. */
static void list_near(fu_run *run)
{
    const fu_model *model = run->model;
    fu_proximity *p = model->proximity;
    p->n_near = p->n_near_watches = 0;
    for (int k = 0; k < model->n_couplings; ++k)
        if (!p->is_far[k] || !p->is_alone[k]) p->near[p->n_near++] = model->couplings[k];
    p->is_known = 1;
    for (int k = 0; k < run->n_watches; ++k)
        if (!fu_is_far_watch(run, k)) p->near_watches[p->n_near_watches++] = k;
}

/* Counts what movers have gone since the last look; returns whether one of them has gone half of what it may. */
static int count_ways(const fu_model *model, const fu_state *state, double *ways, double *turns)
{
    const fu_proximity *p = model->proximity;
    int is_late = 0;
    for (int m = 0; m < p->n_movers; ++m) {
        ways[m] = turns[m] = 0.0;
        if (!p->movers[m].pairs) continue;
        gone_by(model, m, state->q, &ways[m], &turns[m]);
        is_late |= !(ways[m] <= 0.5 * p->movers[m].way && turns[m] <= 0.5 * p->movers[m].turn);
    }
    return is_late;
}

/* Lets movers go as far until the next look as they have gone of late, or go now, in some steps of h. */
static void expect(const fu_model *model, const fu_state *state, double h, int steps, const double *ways, const double *turns)
{
    fu_proximity *p = model->proximity;
    for (int m = 0; m < p->n_movers; ++m) {
        fu_mover *mover = &p->movers[m];
        double speed, spin;
        if (!mover->pairs) continue;
        speeds_of(model, m, state->v, &speed, &spin);
        mover->gone += ways[m];
        mover->turned += turns[m];
        mover->way = STEPS * fmax(ways[m] / steps, h * (speed + spin * mover->radius));
        mover->turn = STEPS * fmax(turns[m] / steps, h * spin);
    }
}

void fu_look_around(fu_run *run, double h, int anew)
{
    const fu_model *model = run->model;
    fu_proximity *p = model->proximity;
    if (!model->n_pairs) return;
    double *ways = p->ways, *turns = p->ways + p->n_movers;
    anew |= !p->is_known;
    ++p->age;
    if (anew) memset(ways, 0, sizeof(double) * 2 * (size_t)p->n_movers);
    else if (!count_ways(model, &run->now, ways, turns) && p->age < MOST_AGE) return;
    expect(model, &run->now, run->fixed_step > 0.0 ? run->fixed_step : fmax(h, run->h), p->age, ways, turns);
    memcpy(p->at, run->now.q, sizeof(double) * (size_t)model->n_q);
    sort_pairs(run, &run->now, anew);
    list_near(run);
    p->age = 0;
}

/* Adds a cable or body to those whose ways are counted, where they can be told. */
static void add_mover(const fu_model *model, fu_proximity *p, int mover)
{
    if (mover >= 0 && (mover >= model->n_cables || model->cables[mover].share)) ++p->movers[mover].pairs;
}

/* Takes the next n bytes of a block of memory, on a border of 16; only counts them where it is null. */
static void *take(char *memory, size_t *taken, size_t n)
{
    void *found = memory ? memory + *taken : 0;
    *taken += (n + 15) / 16 * 16;
    return found;
}

/* Places the arrays in a block of memory; returns how many bytes they take. */
static size_t place(const fu_model *model, int n_watches, char *memory, fu_proximity *p)
{
    const size_t couplings = (size_t)model->n_couplings;
    size_t taken = (sizeof *p + 15) / 16 * 16;
    p->n_movers = model->n_cables + model->n_bodies;
    p->at = take(memory, &taken, sizeof(double) * (size_t)model->n_q);
    p->ways = take(memory, &taken, sizeof(double) * 2 * (size_t)p->n_movers);
    p->movers = take(memory, &taken, sizeof(fu_mover) * (size_t)p->n_movers);
    p->pairs = take(memory, &taken, sizeof(fu_pair) * (size_t)model->n_pairs);
    p->is_far = take(memory, &taken, couplings);
    p->is_alone = take(memory, &taken, couplings);
    p->near = take(memory, &taken, sizeof(fu_coupling *) * couplings);
    p->near_watches = take(memory, &taken, sizeof(int) * (size_t)n_watches);
    return taken;
}

size_t fu_proximity_size(const fu_model *model, int n_watches)
{
    fu_proximity unused;
    return place(model, n_watches, 0, &unused);
}

/* The memory is of zeros. */
void fu_proximity_place(fu_model *model, int n_watches, void *memory)
{
    fu_proximity *p = model->proximity = memory;
    place(model, n_watches, memory, p);
    for (int k = 0; k < model->n_couplings; ++k) {
        const fu_coupling *c = model->couplings[k];
        p->is_alone[k] = (char)fu_acts_alone(c);
        if (!c->type->clearance) continue;
        fu_pair *pair = &p->pairs[p->n_pairs++];
        pair->coupling = k;
        c->type->between(model, c, pair->between);
        for (int i = 0; i < 2; ++i) add_mover(model, p, pair->between[i]);
    }
}
