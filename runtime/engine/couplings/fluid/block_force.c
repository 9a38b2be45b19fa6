/* Forces of a fluid along a cable at blocks of points: drag and lift by the relative velocity, buoyancy, and the
 * inertia of the fluid (derive/couplings/drag.py, derive/couplings/added_mass.py), with their derivatives. */
#include "bodies/model.h"
#include "couplings/common/point_lanes.h"
#include "couplings/fluid/drag.h"

#include <string.h>

FU_INLINE void add_to(int n, const fu_points *x, fu_points *sum)
{
    for (int i = 0; i < n; ++i) sum[i] += x[i];
}

FU_INLINE void add_dot(int dim, const fu_points *a, const fu_points *b, fu_points *sum)
{
    for (int d = 0; d < dim; ++d) *sum += a[d] * b[d];
}

static void add_lift(const fu_drag_block *block, int with_derivatives, fu_block_action *out)
{
    const fu_block_constants *c = block->constants;
    fu_points f[3], by_slope[9], by_w[9];
    c->kernel->lift_along_cable(block->motion.r_x, out->w, c->lift, f, by_slope, by_w);
    add_to(3, f, out->f);
    if (!with_derivatives) return;
    add_to(9, by_slope, out->by_slope);
    add_to(9, by_w, out->by_w);
}

/* Multiplies the forces of full wetting by the wet part, and computes their derivative by position through it. */
FU_INLINE void take_wet_part(int dim, const fu_drag_block *block, int with_derivatives, fu_block_action *out)
{
    const fu_points part = block->fluid.wet[0], slope = block->fluid.wet[1];
    for (int i = 0; i < dim; ++i) {
        for (int j = 0; j < dim && with_derivatives; ++j) {
            out->by_wet[i * dim + j] = (out->f[i] + out->buoyancy[i]) * slope * block->fluid.up[j];
            out->by_slope[i * dim + j] *= part;
            out->by_w[i * dim + j] *= part;
        }
        out->f[i] *= part;
        out->buoyancy[i] *= part;
    }
}

FU_INLINE void act(int dim, const fu_drag *drag, const fu_drag_block *block, int with_derivatives, fu_block_action *out)
{
    const fu_block_constants *c = block->constants;
    const fu_block_motion *at = &block->motion;
    for (int d = 0; d < dim; ++d) {
        out->w[d] = block->fluid.U[d] - at->v[d];
        out->buoyancy[d] = c->buoyancy[d];
    }
    if (with_derivatives) c->kernel->along_cable(at->r_x, out->w, c->coefficients, out->f, out->by_slope, out->by_w);
    else c->kernel->force_along_cable(at->r_x, out->w, c->coefficients, out->f);
    if (drag->lift[0] != 0.0) add_lift(block, with_derivatives, out);
    if (fu_drag_on_section(drag)) fu_section_act(drag, block, with_derivatives, out);
    if (drag->wet != FU_ALL_WET) take_wet_part(dim, block, with_derivatives, out);
    else if (with_derivatives) memset(out->by_wet, 0, sizeof out->by_wet);
}

void fu_block_act(const fu_model *model, const fu_drag *drag, const fu_drag_block *block, fu_block_action *out)
{
    act(model->dim, drag, block, 0, out);
}

/* Computes force on the particles and on the slope by the inertia of the fluid, and its external power. */
static void inertia_at(const fu_drag_block *block, fu_points left[3], fu_points on_slope[3], fu_points *power)
{
    const fu_block_constants *c = block->constants;
    const fu_block_motion *at = &block->motion;
    const fu_block_fluid *fluid = &block->fluid;
    (c->is_morison ? c->kernel->morison_of_cable : c->kernel->inertia_of_cable)(
        at->r_x, at->r_x_rate, c->added, &c->displaced, at->v, at->a, fluid->U, fluid->rate, fluid->gradient,
        fluid->wet, fluid->up, left, on_slope, power);
}

void fu_block_inertia(const fu_drag_block *block, fu_points left[3], fu_points on_slope[3])
{
    fu_points power;
    inertia_at(block, left, on_slope, &power);
}

/* Adds the powers of drag and buoyancy at points of these weights. */
FU_INLINE void add_powers(int dim, const fu_drag_block *block, const fu_block_action *a, const fu_points *part,
                          fu_drag_powers *sum)
{
    fu_points dissipated = {0.0}, external = {0.0};
    add_dot(dim, a->f, a->w, &dissipated);
    add_dot(dim, a->f, block->fluid.U, &external);
    add_dot(dim, a->buoyancy, block->motion.v, &external);
    if (block->shapes.has_chord) fu_section_power(&block->motion, a, &external);
    dissipated *= *part;
    external *= *part;
    sum->dissipated += fu_block_sum(&dissipated);
    sum->external += fu_block_sum(&external);
}

FU_INLINE void forces_at(int dim, const fu_model *model, const fu_drag *drag, const fu_drag_block *block,
                         fu_drag_loop *loop)
{
    const fu_drag_sums *sums = loop->sums;
    const fu_points part = model->load_fraction * block->shapes.weight;
    const int has_section = loop->has_drag && block->shapes.has_chord;
    fu_points forces[FU_BLOCK_FIELDS * 3];
    memset(forces, 0, sizeof forces);
    if (loop->has_drag) {
        fu_block_action a;
        act(dim, drag, block, 0, &a);
        for (int d = 0; d < dim; ++d) forces[d] = part * (a.f[d] + a.buoyancy[d]);
        for (int i = 3; i < 9 && has_section; ++i) forces[i] = part * a.of_section[i];
        if (sums->power) add_powers(dim, block, &a, &part, sums->power);
    }
    if (loop->has_inertia) {
        fu_points left[3], on_slope[3], power;
        inertia_at(block, left, on_slope, &power);
        for (int d = 0; d < dim; ++d) {
            forces[d] -= part * left[d];
            forces[dim + d] += part * on_slope[d];
        }
        power *= part;
        if (sums->power) sums->power->external += fu_block_sum(&power);
    }
    for (int d = 0; d < dim && sums->total; ++d) sums->total[d] += fu_block_sum(&forces[d]);
    if (sums->f)
        fu_block_subtract(dim, &block->shapes,
                          has_section         ? 3
                          : loop->has_inertia ? 2
                                              : 1,
                          forces, sums->f + block->first);
}

FU_INLINE void add_forces(const fu_model *model, const fu_drag *drag, const fu_drag_block *block, fu_drag_loop *loop,
                          double *K)
{
    (void)K;
    if (model->dim == 2) forces_at(2, model, drag, block, loop);
    else forces_at(3, model, drag, block, loop);
}

FU_SIMD_FUNCTION(fu_block_forces, add_forces,
                 (const fu_model *model, const fu_drag *drag, const fu_drag_block *block, fu_drag_loop *loop,
                  double *K),
                 (model, drag, block, loop, K))

/* Subtracts the derivatives of drag and buoyancy from blocks (dim x dim) by place and slope. */
FU_INLINE void subtract_drag(int dim, const fu_drag *drag, const fu_drag_block *block, double rate,
                             const fu_points *scale, fu_points *by)
{
    const int size = dim * dim;
    fu_block_action a;
    act(dim, drag, block, 1, &a);
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) {
            fu_points by_place = a.by_wet[i * dim + j];
            for (int k = 0; k < dim; ++k) by_place += a.by_w[i * dim + k] * block->fluid.gradient[k * dim + j];
            by[i * dim + j] -= *scale * (by_place - rate * a.by_w[i * dim + j]);
            by[size + i * dim + j] -= *scale * a.by_slope[i * dim + j];
        }
    if (block->shapes.has_chord) fu_section_derivatives(&block->fluid, &a, scale, rate, by);
}

/* Adds those of the inertia of the fluid; on_slope: the blocks of the force on the slope. */
FU_INLINE void add_inertia(int dim, const fu_drag_block *block, double rate, const fu_points *scale, fu_points *by,
                           fu_points *on_slope)
{
    const int size = dim * dim;
    const fu_block_constants *c = block->constants;
    const fu_block_motion *at = &block->motion;
    const fu_block_fluid *fluid = &block->fluid;
    fu_points f_t[9], f_t_rate[9], f_r[9], f_v[9], g_t[9], g_r[9], g_v[9];
    (c->is_morison ? c->kernel->morison_of_cable_tangent : c->kernel->inertia_of_cable_tangent)(
        at->r_x, at->r_x_rate, c->added, &c->displaced, at->v, at->a, fluid->U, fluid->rate, fluid->gradient,
        fluid->wet, fluid->up, f_t, f_t_rate, f_r, f_v, g_t, g_r, g_v);
    for (int i = 0; i < size; ++i) {
        by[i] += *scale * (f_r[i] + rate * f_v[i]);
        by[size + i] += *scale * (f_t[i] + rate * f_t_rate[i]);
        on_slope[i] -= *scale * (g_r[i] + rate * g_v[i]);
        on_slope[size + i] -= *scale * g_t[i];
    }
}

FU_INLINE void tangent_at(int dim, const fu_model *model, const fu_drag *drag, const fu_drag_block *block,
                          const fu_drag_loop *loop, double *K)
{
    const int has_section = loop->has_drag && block->shapes.has_chord, n_columns = has_section ? 3 : 2;
    const fu_points scale = (loop->weights.stiffness * model->load_fraction) * block->shapes.weight;
    fu_points by[FU_BLOCK_FIELDS * FU_BLOCK_FIELDS * 9];
    memset(by, 0, sizeof by);
    if (loop->has_drag) subtract_drag(dim, drag, block, loop->weights.rate, &scale, by);
    if (loop->has_inertia) add_inertia(dim, block, loop->weights.rate, &scale, by, by + n_columns * dim * dim);
    fu_block_add_matrix(dim, &block->shapes, has_section ? 3 : loop->has_inertia ? 2 : 1, n_columns, by, K);
}

FU_INLINE void add_tangent(const fu_model *model, const fu_drag *drag, const fu_drag_block *block, fu_drag_loop *loop,
                           double *K)
{
    if (model->dim == 2) tangent_at(2, model, drag, block, loop, K);
    else tangent_at(3, model, drag, block, loop, K);
}

FU_SIMD_FUNCTION(fu_block_tangent, add_tangent,
                 (const fu_model *model, const fu_drag *drag, const fu_drag_block *block, fu_drag_loop *loop,
                  double *K),
                 (model, drag, block, loop, K))
