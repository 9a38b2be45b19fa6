/* The fluid at a point and at the points of a block: its velocity with that of waves, and the wet part. The elevation
 * of waves is computed once a point for both, and not where it changes nothing. */
#include "bodies/model.h"
#include "couplings/fluid/drag.h"

#include <math.h>
#include <string.h>

/* Returns the height of a point of a block above the origin. */
static double height_of(const fu_model *model, const fu_drag *drag, const fu_points *r, int p)
{
    double height = drag->flow.base;
    for (int d = 0; d < model->dim; ++d) height += drag->flow.up[d] * r[d][p];
    return height;
}

/* Computes the wet part at the first n points of a block with this elevation; returns whether any is wet. */
static int wet_at(const fu_model *model, const fu_drag *drag, const fu_points *r, int n, const fu_block_elevation *at,
                  fu_block_fluid *out)
{
    int any = 0;
    for (int p = 0; p < FU_BLOCK_POINTS; ++p) {
        const int of = p < n ? p : n - 1;
        const fu_wetness wet = drag->wet == FU_ALL_WET
                                   ? (fu_wetness){.part = 1.0}
                                   : fu_wet_at_height(drag, height_of(model, drag, r, of) - at->eta[of]);
        any |= wet.part != 0.0 || wet.slope != 0.0;
        out->wet[0][p] = wet.part;
        out->wet[1][p] = wet.slope;
        out->wet[2][p] = wet.curvature;
        out->wet[3][p] = -wet.slope * at->rate[of];
        for (int d = 0; d < model->dim; ++d) out->up[d][p] = drag->flow.up[d] - at->slope[d][of];
    }
    return any;
}

/* Returns whether waves may change the wet part at any of the first n points of a block. */
static int is_near_surface(const fu_model *model, const fu_drag *drag, const fu_points *r, int n)
{
    if (drag->wet == FU_ALL_WET) return 0;
    for (int p = 0; p < n; ++p)
        if (fu_near_surface(drag, height_of(model, drag, r, p))) return 1;
    return 0;
}

void fu_block_in_waves(const fu_model *model, const fu_drag *drag, double t, const fu_points *r, int n, int moves,
                       fu_block_fluid *out)
{
    fu_wave_phase phases[FU_MAX_WAVES];
    fu_block_elevation at = {{0.0}, {0.0}, {{0.0}}};
    const int has_velocity = moves && drag->waves.move_fluid, near = is_near_surface(model, drag, r, n);
    if (near) fu_block_elevations(model, drag, t, r, phases, &at);
    const int any = wet_at(model, drag, r, n, &at, out);
    if (!any || !has_velocity) return;
    if (!near) fu_block_elevations(model, drag, t, r, phases, &at);
    fu_block_add_waves(model, drag, r, &at, phases, out);
}

/* Takes the fluid in waves at one point. */
static void in_waves(const fu_model *model, const fu_drag *drag, double t, const double *r, fu_flow_state *flow,
                     fu_wetness *wet)
{
    const int dim = model->dim;
    fu_points place[3] = {{0.0}};
    fu_block_fluid out;
    memset(&out, 0, sizeof out);
    for (int d = 0; d < dim; ++d) place[d] = (fu_points){0.0} + r[d];
    fu_block_in_waves(model, drag, t, place, 1, flow != 0, &out);
    for (int d = 0; d < dim && flow; ++d) {
        flow->U[d] += out.U[d][0];
        flow->rate[d] += out.rate[d][0];
    }
    for (int i = 0; i < dim * dim && flow; ++i) flow->gradient[i] += out.gradient[i][0];
    if (!wet) return;
    *wet =
        (fu_wetness){.part = out.wet[0][0], .slope = out.wet[1][0], .curvature = out.wet[2][0], .rate = out.wet[3][0]};
    for (int d = 0; d < dim; ++d) wet->up[d] = out.up[d][0];
}

void fu_fluid_at(const fu_model *model, const fu_drag *drag, double t, const double *r, fu_flow_state *flow,
                 fu_wetness *wet)
{
    const int dim = model->dim;
    if (flow) fu_current_at(model, &drag->flow, t, r, flow);
    if (drag->waves.n_waves) {
        in_waves(model, drag, t, r, flow, wet);
        return;
    }
    if (!wet) return;
    *wet = (fu_wetness){.part = 1.0};
    if (drag->wet != FU_ALL_WET) *wet = fu_wet_at_height(drag, drag->flow.base + fu_dot(dim, drag->flow.up, r));
    for (int d = 0; d < dim; ++d) wet->up[d] = drag->flow.up[d];
}
