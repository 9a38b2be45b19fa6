/* The mass that fluids add to cables and bodies, and its kinetic energy: M of T = w . M w/2
 * (couplings/fluid/added_mass.c). */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/attachments.h"
#include "couplings/common/point_lanes.h"
#include "couplings/fluid/drag.h"

#include <string.h>

/* Computes the impulse M w and M of a body at a point of the velocity at->v relative to the fluid; A: axes of the body.
 */
static void impulse(const fu_model *model, const fu_drag *drag, double t, const fu_drag_place *at, const double *A,
                    double p[3], double M[9])
{
    drag->kernel->impulse_of_point(A, drag->added, at->v, p, M);
    fu_wetness wet;
    fu_fluid_at(model, drag, t, at->r, 0, &wet);
    for (int i = 0; i < model->dim; ++i) p[i] *= wet.part;
    for (int i = 0; i < model->dim * model->dim; ++i) M[i] *= wet.part;
}

/* Computes position and velocity of a body's point. */
static void place_on_body(const fu_model *model, const fu_drag *drag, const double *q, const double *v,
                          fu_attachment_state *end, fu_drag_place *at)
{
    const fu_state state = {.q = (double *)q, .v = (double *)v};
    fu_attachment_at(model, &drag->attachments[0], &state, 0.0, FU_POINT | FU_AXES, end);
    memset(at, 0, sizeof *at);
    memcpy(at->r, end->p, sizeof at->r);
    memcpy(at->v, end->v, sizeof at->v);
}

/* Computes the same of a length of cable, of the wet part, at a block. */
FU_INLINE void impulse_at(int dim, const fu_drag_block *block, const fu_points *w, fu_points *p, fu_points *M)
{
    block->constants->kernel->impulse_of_cable(block->motion.r_x, w, block->constants->added, p, M);
    for (int i = 0; i < dim; ++i) p[i] *= block->fluid.wet[0];
    for (int i = 0; i < dim * dim; ++i) M[i] *= block->fluid.wet[0];
}

/* Adds M a to f; the rates at the block are the accelerations. */
FU_INLINE void add_force_at(const fu_model *model, const fu_drag *drag, const fu_drag_block *block, fu_drag_loop *loop,
                            double *K)
{
    fu_points p[3], M[9];
    (void)drag;
    (void)K;
    impulse_at(model->dim, block, block->motion.v, p, M);
    for (int d = 0; d < model->dim; ++d) p[d] *= -block->shapes.weight;
    fu_block_subtract(model->dim, &block->shapes, 1, p, loop->sums->f + block->first);
}

static fu_drag_visitor add_force, add_mass, add_energy;
FU_SIMD_FUNCTION(add_force, add_force_at,
                 (const fu_model *model, const fu_drag *drag, const fu_drag_block *block, fu_drag_loop *loop,
                  double *K),
                 (model, drag, block, loop, K))

void fu_added_mass_force(const fu_model *model, const fu_coupling *coupling, double t, const double *q, const double *a,
                         double *f)
{
    const fu_drag *drag = (const fu_drag *)coupling;
    if (drag->cable >= 0) {
        const fu_drag_sums sums = {.f = f};
        fu_drag_loop loop = {.t = t, .sums = &sums, .is_still = 1};
        fu_drag_visit(model, drag, q, a, 0, add_force, &loop, 0);
        return;
    }
    if (drag->on.kernel) {
        fu_span_added_mass_force(model, drag, q, a, f);
        return;
    }
    double p[3], M[9];
    fu_attachment_state end;
    fu_drag_place at;
    place_on_body(model, drag, q, model->zero, &end, &at);
    for (int d = 0; d < model->dim; ++d)
        for (int i = 0; i < end.n; ++i) at.v[d] += end.P[d * end.n + i] * a[end.at[i]];
    impulse(model, drag, t, &at, end.A, p, M);
    fu_add_wrench(model->dim, &end, p, 0, 1.0, f);
}

FU_INLINE void add_mass_at(const fu_model *model, const fu_drag *drag, const fu_drag_block *block, fu_drag_loop *loop,
                           double *K)
{
    fu_points p[3], M[9];
    (void)drag;
    impulse_at(model->dim, block, block->motion.v, p, M);
    for (int i = 0; i < model->dim * model->dim; ++i) M[i] *= loop->weights.stiffness * block->shapes.weight;
    fu_block_add_matrix(model->dim, &block->shapes, 1, 1, M, K);
}

FU_SIMD_FUNCTION(add_mass, add_mass_at,
                 (const fu_model *model, const fu_drag *drag, const fu_drag_block *block, fu_drag_loop *loop,
                  double *K),
                 (model, drag, block, loop, K))

void fu_added_mass_matrix(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double scale,
                          fu_system *system)
{
    const fu_drag *drag = (const fu_drag *)coupling;
    const int dim = model->dim;
    if (drag->cable >= 0) {
        fu_drag_loop loop = {.t = t, .has_matrix = 1, .is_still = 1, .weights = {.stiffness = scale}};
        fu_drag_visit(model, drag, q, model->zero, 0, add_mass, &loop, system);
        return;
    }
    if (drag->on.kernel) {
        fu_span_added_mass_matrix(model, drag, q, scale, system);
        return;
    }
    double p[3], M[9], changes[3 * FU_ATTACHMENT_COORDINATES] = {0.0};
    fu_attachment_state end;
    fu_drag_place at;
    place_on_body(model, drag, q, model->zero, &end, &at);
    impulse(model, drag, t, &at, end.A, p, M);
    for (int c = 0; c < dim; ++c)
        for (int d = 0; d < dim; ++d)
            for (int i = 0; i < end.n; ++i) changes[c * end.n + i] += M[c * dim + d] * end.P[d * end.n + i];
    fu_add_wrench_tangent(model, &end, &end, changes, 0, 0, scale, system);
}

FU_INLINE void add_energy_at(const fu_model *model, const fu_drag *drag, const fu_drag_block *block, fu_drag_loop *loop,
                             double *K)
{
    fu_points w[3] = {{0.0}}, p[3], M[9], energy = {0.0};
    (void)drag;
    (void)K;
    for (int d = 0; d < model->dim; ++d) w[d] = block->motion.v[d] - block->fluid.U[d];
    impulse_at(model->dim, block, w, p, M);
    for (int d = 0; d < model->dim; ++d) energy += 0.5 * block->shapes.weight * p[d] * w[d];
    loop->energy += fu_block_sum(&energy);
}

FU_SIMD_FUNCTION(add_energy, add_energy_at,
                 (const fu_model *model, const fu_drag *drag, const fu_drag_block *block, fu_drag_loop *loop,
                  double *K),
                 (model, drag, block, loop, K))

double fu_added_mass_kinetic_energy(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                                    const double *v, int past_fluid)
{
    const fu_drag *drag = (const fu_drag *)coupling;
    if (drag->cable >= 0) {
        fu_drag_loop loop = {.t = t, .is_still = !past_fluid};
        fu_drag_visit(model, drag, q, v, 0, add_energy, &loop, 0);
        return loop.energy;
    }
    if (drag->on.kernel) return fu_span_added_mass_kinetic_energy(model, drag, t, q, v, past_fluid);
    double p[3], M[9];
    fu_attachment_state end;
    fu_drag_place at;
    fu_flow_state flow = {{0.0}, {0.0}, {0.0}};
    place_on_body(model, drag, q, v, &end, &at);
    if (past_fluid) fu_fluid_at(model, drag, t, at.r, &flow, 0);
    for (int d = 0; d < model->dim; ++d) at.v[d] -= flow.U[d];
    impulse(model, drag, t, &at, end.A, p, M);
    return 0.5 * fu_dot(model->dim, p, at.v);
}
