/* Lines in contact over a step, for the integrator that balances energy (derive/couplings/crossing.py): the force acts
 * at the closest points in the middle of the step, along a discrete gradient of the gap. */
#include "bodies/model.h"
#include "couplings/crossing/crossing.h"

#include <math.h>

/* A crossing over a step: the motion of the points half-way with the coordinates, the forces on them and on the slopes,
 * and the dissipation, J. */
typedef struct {
    fu_line_moves moves[FU_LINES];
    double force[3], on_slopes[6], lost;
} contact_step;

fu_state fu_crossing_middle(const fu_equations *at)
{
    fu_state middle = *at->middle;
    middle.numbers = at->next->numbers;
    middle.flags = at->next->flags;
    return middle;
}

/* Computes the closest points of a state and the contact there; returns whether there are such points. */
static int contact_at(const fu_model *model, const fu_crossing *crossing, const fu_state *state,
                      fu_closest_points *points, fu_crossing_contact *contact)
{
    fu_find_closest(model, crossing, state, points);
    fu_crossing_contact_at(crossing, points, contact);
    return points->found && !fu_crossing_swung(crossing, state, contact);
}

/* Computes the motion of a line's point over the step: its displacement is P psi, and its slope changes by T psi. */
static void moves_over_step(const fu_model *model, const fu_crossing *crossing, int line, const fu_equations *at,
                            const fu_state *middle, const fu_line_point *point, fu_line_moves *out)
{
    fu_line_moves_at(model, crossing, line, middle, point, out);
    if (crossing->cables[line] >= 0 || point->on.body < 0) return;
    fu_attachment on = point->on;
    fu_discrete_point(model, &on, at->now, at->next, out->P);
    if (model->dim == 2) return;
    for (int d = 0; d < 3; ++d) on.u[d] += crossing->axis[d];
    fu_discrete_point(model, &on, at->now, at->next, out->T);
    for (int i = 0; i < model->dim * out->n; ++i) out->T[i] -= out->P[i];
}

static void over_step(const fu_model *model, const fu_crossing *crossing, const fu_equations *at, contact_step *out)
{
    const int dim = model->dim, lines = dim - 1;
    const fu_state middle = fu_crossing_middle(at);
    fu_closest_points points;
    fu_crossing_contact now, next, half;
    double displacement[3] = {0.0}, turn[6] = {0.0}, size[FU_LINES] = {0.0};
    int found = contact_at(model, crossing, at->now, &points, &now);
    found &= contact_at(model, crossing, at->next, &points, &next);
    found &= contact_at(model, crossing, &middle, &points, &half); /* the last: its points are those of the force */
    for (int line = 0; line < FU_LINES; ++line) {
        fu_line_moves *moves = &out->moves[line];
        moves_over_step(model, crossing, line, at, &middle, &points.line[line], moves);
        for (int d = 0; d < dim; ++d)
            for (int i = 0; i < moves->n; ++i) {
                displacement[d] += (line ? -1.0 : 1.0) * moves->P[d * moves->n + i] * at->psi[moves->at[i]];
                if (line < lines) turn[line * dim + d] += moves->T[d * moves->n + i] * at->psi[moves->at[i]];
            }
        if (line < lines) size[line] = fu_line_size(model, crossing, line);
    }
    crossing->kernel->step(half.normal, displacement, turn, size, now.depth[0], next.depth[0], at->h, crossing->law,
                           out->force, out->on_slopes, &out->lost);
    if (!found)
        for (int d = 0; d < dim; ++d) out->force[d] = NAN;
}

void fu_crossing_step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                               double *internal)
{
    const int dim = model->dim;
    contact_step step;
    for (int i = 0; i < coupling->n_forces; ++i) internal[coupling->unknown + i] = 0.0;
    if (!at->next->flags[coupling->flags]) return;
    over_step(model, (const fu_crossing *)coupling, at, &step);
    for (int line = 0; line < FU_LINES; ++line) {
        const fu_line_moves *moves = &step.moves[line];
        for (int d = 0; d < dim; ++d)
            for (int i = 0; i < moves->n; ++i) {
                f[moves->at[i]] += (line ? 1.0 : -1.0) * moves->P[d * moves->n + i] * step.force[d];
                if (line < dim - 1) f[moves->at[i]] -= moves->T[d * moves->n + i] * step.on_slopes[line * dim + d];
            }
    }
}

double fu_crossing_step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at)
{
    contact_step step;
    if (!at->next->flags[coupling->flags]) return 0.0;
    over_step(model, (const fu_crossing *)coupling, at, &step);
    return step.lost;
}
