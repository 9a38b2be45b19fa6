/* The loop over all points of quadrature of a cable in a fluid, in blocks, with the fluid there. */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/point_lanes.h"
#include "couplings/fluid/drag.h"
#include "couplings/ice/ice.h"

#include <string.h>

static void broadcast(int n, const double *x, fu_points *out)
{
    for (int i = 0; i < n; ++i) out[i] = (fu_points){0.0} + x[i];
}

/* Lets the diameter of a cable under ice grow by twice its thickness. */
static void grow(const fu_model *model, const fu_drag *drag, double t, fu_block_constants *out)
{
    const fu_iced *iced = &drag->iced;
    const double thickness = fu_ice_thickness(model, iced->signal, iced->factor, t, 0);
    const double growth = iced->width > 0.0 ? 1.0 + 2.0 * thickness / iced->width : 1.0;
    const double ring = thickness * (iced->diameter + thickness);
    for (int i = 0; i < 2; ++i) out->coefficients[i] *= growth;
    out->lift[0] *= growth;
    for (int d = 0; d < 3; ++d) out->buoyancy[d] += ring * iced->buoyancy[d];
}

static fu_block_constants constants_of(const fu_model *model, const fu_drag *drag, double t)
{
    fu_block_constants out = {.kernel = fu_drag_blocks_of(drag->kernel->name), .is_morison = drag->is_morison};
    broadcast(3, drag->coefficients, out.coefficients);
    broadcast(2, drag->lift, out.lift);
    broadcast(3, drag->section, out.section);
    broadcast(2, drag->added, out.added);
    broadcast(1, &drag->displaced, &out.displaced);
    broadcast(3, drag->buoyancy, out.buoyancy);
    if (drag->iced.has_ice) grow(model, drag, t, &out);
    return out;
}

/* Returns whether the velocity of a fluid without its waves is the same everywhere. */
static int is_uniform(const fu_drag *drag)
{
    return !drag->flow.degree && drag->flow.profile == FU_UNIFORM;
}

/* Takes the velocity of the fluid without waves at one point of a block from the p-th on. */
static void current_from(const fu_model *model, const fu_drag *drag, double t, int p, const fu_block_motion *motion,
                         fu_block_fluid *out)
{
    double r[3];
    fu_flow_state flow;
    fu_block_vector(model->dim, motion->r, p, r);
    fu_current_at(model, &drag->flow, t, r, &flow);
    for (; p < FU_BLOCK_POINTS; ++p) {
        for (int d = 0; d < model->dim; ++d) {
            out->U[d][p] = flow.U[d];
            out->rate[d][p] = flow.rate[d];
        }
        for (int i = 0; i < model->dim * model->dim; ++i) out->gradient[i][p] = flow.gradient[i];
    }
}

static void wet_part_from(const fu_model *model, const fu_drag *drag, double t, int p, const fu_block_motion *motion,
                          fu_block_fluid *out)
{
    double r[3];
    fu_wetness wet;
    fu_block_vector(model->dim, motion->r, p, r);
    fu_fluid_at(model, drag, t, r, 0, &wet);
    for (; p < FU_BLOCK_POINTS; ++p) {
        out->wet[0][p] = wet.part;
        out->wet[1][p] = wet.slope;
        out->wet[2][p] = wet.curvature;
        out->wet[3][p] = wet.rate;
        for (int d = 0; d < model->dim; ++d) out->up[d][p] = wet.up[d];
    }
}

/* Computes the fluid at a block; what is the same at all points only at the first block. */
static void fluid_at(const fu_model *model, const fu_drag *drag, const fu_drag_loop *loop, int is_first,
                     const fu_block_shapes *shapes, const fu_block_motion *motion, fu_block_fluid *out)
{
    const int has_waves = drag->waves.n_waves > 0, uniform = is_uniform(drag), all_wet = drag->wet == FU_ALL_WET;
    if (loop->is_still && (is_first || has_waves)) memset(out, 0, sizeof *out);
    for (int p = 0; p < shapes->n && !loop->is_still && (!uniform || ((is_first || has_waves) && p == 0)); ++p)
        current_from(model, drag, loop->t, p, motion, out);
    if (has_waves) fu_block_in_waves(model, drag, loop->t, motion->r, shapes->n, !loop->is_still, out);
    for (int p = 0; p < shapes->n && !has_waves && (!all_wet || (is_first && p == 0)); ++p)
        wet_part_from(model, drag, loop->t, p, motion, out);
}

void fu_drag_visit(const fu_model *model, const fu_drag *drag, const double *q, const double *v, const double *a,
                   fu_drag_visitor *visit, fu_drag_loop *loop, fu_system *system)
{
    const fu_cable *cable = &model->cables[drag->cable];
    const int all = cable->coordinates, n_shapes = all / model->dim;
    const int points_alike = !drag->stride && drag->wet == FU_ALL_WET; /* of all elements */
    const fu_block_constants constants = constants_of(model, drag, loop->t);
    int is_first = 1;
    double K[FU_MAX_COORDINATES * FU_MAX_COORDINATES];
    fu_drag_points points;
    fu_drag_block block; /* set member by member: most of its memory is of larger elements */
    block.points = &points;
    block.constants = &constants;
    for (int e = drag->first; e < drag->first + drag->n_elements; ++e) {
        block.element = e;
        block.first = fu_element_entry(cable, e);
        if (is_first || !points_alike) fu_drag_points_on(model, drag, loop->t, e, q + block.first, &points);
        if (loop->has_matrix) memset(K, 0, sizeof(double) * (size_t)(all * all));
        for (block.from = 0; block.from < points.n; block.from += FU_BLOCK_POINTS) {
            if (is_first || !points_alike || points.n > FU_BLOCK_POINTS)
                fu_block_shapes_of(&points, block.from, n_shapes, &block.shapes);
            fu_block_motion_of(cable, &block.shapes, q + block.first, v + block.first, a ? a + block.first : 0,
                               &block.motion);
            fluid_at(model, drag, loop, is_first, &block.shapes, &block.motion, &block.fluid);
            is_first = 0;
            visit(model, drag, &block, loop, K);
        }
        if (loop->has_matrix) fu_add_element_matrix(model, block.first, all, K, system);
    }
}
