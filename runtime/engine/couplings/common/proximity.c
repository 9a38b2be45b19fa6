/* Couplings that are far from acting, as most of many pairs of bodies and surfaces: loops skip them.
 *
 * Each such coupling gives its clearance at a configuration. It is far until the paths of its parts have used that
 * up. Path lengths are summed from search to search. Between two searches each cable and body may move as far as
 * expected in some steps, which is subtracted from the clearances beforehand. So a state needs only its distance
 * from the configuration of the last search, cable by cable and body by body: if one has moved farther, all
 * couplings are evaluated. A search itself visits only the cables and bodies one of whose pairs, as their first part,
 * may have become near. Skipped couplings would contribute nothing, and the others keep their order: results do not
 * depend on the times of searches. */
#include "base/simd.h"
#include "couplings/common/coupling_events.h"
#include "couplings/common/couplings.h"
#include "couplings/common/proximity.h"

#include <math.h>

const fu_body *fu_body_of_mover(const fu_model *model, int mover)
{
    return mover < model->n_cables ? 0 : &model->bodies[mover - model->n_cables];
}

int fu_acts_alone(const fu_coupling *coupling)
{
    const fu_coupling_type *type = coupling->type;
    const fu_coupling_events *events = coupling->events;
    const int asked = type->inertia || type->rows || type->supply || type->reaction || type->take_forces ||
                      type->gaps || type->coordinates || type->detect ||
                      (type->start && (type->start->may_be_open || type->start->is_possible)) ||
                      (events && (events->path || events->deferred));
    return type->proximity && !asked;
}

/* Returns the largest square of the change of a cable's k-th nodal vectors, in a number of dimensions known to the
 * compiler. */
FU_INLINE double largest_square(int dim, const fu_cable *cable, int k, const double *to, const double *from)
{
    double most = 0.0;
    FU_EACH_NODE(node, cable)
    {
        const double *at = to + node + k * dim, *before = from ? from + node + k * dim : 0;
        double square = 0.0;
        for (int d = 0; d < dim; ++d) {
            const double change = before ? at[d] - before[d] : at[d];
            square += change * change;
        }
        most = square > most ? square : most;
    }
    return most;
}

/* Returns the largest displacement of points of a cable by a change of its nodal vectors, or the speed by their
 * rates. */
double fu_most_of_cable(const fu_cable *cable, const double *to, const double *from)
{
    double sum = 0.0;
    for (int k = 0; k < cable->kernel->vectors; ++k) {
        if (cable->share[k] == 0.0) continue;
        const double most =
            cable->kernel->dim == 2 ? largest_square(2, cable, k, to, from) : largest_square(3, cable, k, to, from);
        sum += cable->share[k] * sqrt(most);
    }
    return sum;
}

/* Returns the square of a body's displacement since the last search. */
static inline double square_of_displacement(const fu_model *model, const fu_body *body, const double *q)
{
    const double *b = q + body->configuration, *b0 = model->proximity->at + body->configuration;
    double square = 0.0;
    for (int i = 0; i < model->dim; ++i) square += (b[i] - b0[i]) * (b[i] - b0[i]);
    return square;
}

/* Returns the square of the change of a body's axes since the last search, 0 for a body that is not the second part of
 * a pair: spheres about the origin of a first part contain its points in any axes. */
static inline double square_of_turn(const fu_model *model, const fu_mover *mover, const fu_body *body, const double *q)
{
    const double *b = q + body->configuration, *b0 = model->proximity->at + body->configuration;
    const int n = mover->is_carrier ? body->kernel->configuration : 0;
    double square = 0.0;
    for (int i = model->dim; i < n; ++i) square += (b[i] - b0[i]) * (b[i] - b0[i]);
    return square;
}

/* Computes the distance of a moving part from its position at the last search, m, and the norm of the change of its
 * axes. */
void fu_mover_gone_by(const fu_model *model, int mover, const double *q, double *displacement, double *turn)
{
    const fu_proximity *p = model->proximity;
    const fu_body *body = fu_body_of_mover(model, mover);
    *turn = 0.0;
    if (!body) {
        *displacement = fu_most_of_cable(&model->cables[mover], q, p->at);
        return;
    }
    *displacement = sqrt(square_of_displacement(model, body, q));
    /* of unit quaternions at an angle of a/2: 2 sin(a/2) <= 2 |e - e0| */
    *turn = 2.0 * sqrt(square_of_turn(model, &p->movers[mover], body, q));
}

/* Returns whether a moving part is within its limits from the last search. */
static int is_within(const fu_model *model, int number, const double *q)
{
    const fu_mover *mover = &model->proximity->movers[number];
    const fu_body *body = fu_body_of_mover(model, number);
    const double displacement = mover->displacement, turn = 0.5 * mover->turn;
    if (!body) return fu_most_of_cable(&model->cables[number], q, model->proximity->at) <= displacement;
    return square_of_displacement(model, body, q) <= displacement * displacement &&
           square_of_turn(model, mover, body, q) <= turn * turn;
}

/* Returns whether all moving parts are within their limits from the last search. */
int fu_movers_are_near(const fu_model *model, const double *q)
{
    const fu_proximity *p = model->proximity;
    if (!p || !p->is_known) return 0;
    for (int m = 0; m < p->n_movers; ++m)
        if (p->movers[m].pairs && !is_within(model, m, q)) return 0;
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

/* Returns whether evaluations skip far couplings: those that are more than a contact take part in all. */
static int has_lone_pairs(const fu_model *model)
{
    return model->n_always_active < model->n_couplings;
}

fu_couplings fu_acting(const fu_model *model, const fu_state *state)
{
    return has_lone_pairs(model) && fu_movers_are_near(model, state->q) ? near_of(model) : all_of(model);
}

fu_couplings fu_acting_in_step(const fu_model *model, const fu_equations *at)
{
    return has_lone_pairs(model) && fu_movers_are_near(model, at->now->q) && fu_movers_are_near(model, at->next->q)
               ? near_of(model)
               : all_of(model);
}

/* Adds a cable or body to the moving parts, if its motion can be bounded. */
static void add_mover(const fu_model *model, fu_proximity *p, int mover, int is_second)
{
    if (mover < 0 || (mover < model->n_cables && !model->cables[mover].share)) return;
    ++p->movers[mover].pairs;
    p->movers[mover].is_carrier |= is_second;
}

/* Lists the pairs by their first parts. */
static void group_pairs(const fu_model *model, fu_proximity *p)
{
    int between[2];
    FU_EACH_COUPLING(c, model->couplings, model->n_couplings) {
        if (!c->type->proximity) continue;
        c->type->proximity->between(model, c, between);
        ++p->movers[between[0]].group.n;
        for (int i = 0; i < 2; ++i) add_mover(model, p, between[i], i);
    }
    for (int m = 0; m < p->n_movers; ++m) {
        p->movers[m].group.first = p->n_pairs;
        p->n_pairs += p->movers[m].group.n;
        p->movers[m].group.n = 0;
    }
    FU_EACH_COUPLING(c, model->couplings, model->n_couplings) {
        if (!c->type->proximity) continue;
        c->type->proximity->between(model, c, between);
        fu_pair_group *group = &p->movers[between[0]].group;
        p->pairs[group->first + group->n++] = (fu_pair){.between = {between[0], between[1]}, .coupling = c->number};
    }
}

/* Takes the next n bytes of a block of memory, aligned to 16; only counts them if it is null. */
static void *take(char *memory, size_t *taken, size_t n)
{
    void *found = memory ? memory + *taken : 0;
    *taken += (n + 15) / 16 * 16;
    return found;
}

/* Places the arrays in a block of memory; returns their bytes. */
static size_t place(const fu_model *model, int n_event_functions, char *memory, fu_proximity *p)
{
    const size_t couplings = (size_t)model->n_couplings;
    size_t taken = (sizeof *p + 15) / 16 * 16;
    p->n_movers = model->n_cables + model->n_bodies;
    p->at = take(memory, &taken, sizeof(double) * (size_t)model->n_q);
    p->displacements = take(memory, &taken, sizeof(double) * 2 * (size_t)p->n_movers);
    p->movers = take(memory, &taken, sizeof(fu_mover) * (size_t)p->n_movers);
    p->pairs = take(memory, &taken, sizeof(fu_pair) * (size_t)model->n_pairs);
    p->is_far = take(memory, &taken, couplings);
    p->is_alone = take(memory, &taken, couplings);
    p->near = take(memory, &taken, sizeof(fu_coupling *) * couplings);
    p->near_functions = take(memory, &taken, sizeof(int) * (size_t)n_event_functions);
    return taken;
}

size_t fu_proximity_size(const fu_model *model, int n_event_functions)
{
    fu_proximity unused;
    return place(model, n_event_functions, 0, &unused);
}

/* The memory is of zeros. */
void fu_proximity_place(fu_model *model, int n_event_functions, void *memory)
{
    fu_proximity *p = model->proximity = memory;
    place(model, n_event_functions, memory, p);
    FU_EACH_COUPLING(c, model->couplings, model->n_couplings) p->is_alone[c->number] = (char)fu_acts_alone(c);
    group_pairs(model, p);
}
