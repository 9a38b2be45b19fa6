/* Forces of a fluid on slope and chord of a beam by the moment on its section (derive/couplings/section_flow.py). The
 * force on its axis is that of any cable, in couplings/fluid/block_force.c. */
#include "bodies/cables.h"
#include "couplings/common/point_lanes.h"
#include "couplings/fluid/drag.h"

#include <math.h>

/* Computes the coefficients by the angle of attack at one point of a block. */
static void polar_at(const fu_drag *drag, const fu_drag_block *block, const fu_points *flow, int point, double polar[6])
{
    double i[3], chord[3], w[3];
    fu_block_vector(3, block->motion.r_x, point, i);
    fu_block_vector(3, block->motion.chord, point, chord);
    fu_block_vector(3, flow, point, w);
    const double inverse = 1.0 / sqrt(fu_dot(3, i, i));
    for (int d = 0; d < 3; ++d) i[d] *= inverse;
    const double along = fu_dot(3, i, chord);
    for (int d = 0; d < 3; ++d) chord[d] -= along * i[d];
    fu_drag_polar(3, drag, chord, i, w, 3, polar);
}

void fu_section_act(const fu_drag *drag, const fu_drag_block *block, int with_derivatives, fu_block_action *out)
{
    const fu_block_constants *c = block->constants;
    fu_points polar[6];
    for (int p = 0; p < FU_BLOCK_POINTS; ++p) {
        double at_point[6];
        polar_at(drag, block, out->w, p, at_point);
        for (int k = 0; k < 6; ++k) polar[k][p] = at_point[k];
    }
    c->kernel->on_section(block->motion.r_x, block->motion.chord, out->w, c->section, polar, out->of_section,
                          out->section_by);
    for (int d = 0; d < 3; ++d) {
        out->f[d] += out->of_section[d];
        for (int k = 0; k < 3 && with_derivatives; ++k) {
            out->by_slope[3 * d + k] += out->section_by[9 * d + k];
            out->by_w[3 * d + k] += out->section_by[9 * d + 6 + k];
        }
    }
}

void fu_section_power(const fu_block_motion *at, const fu_block_action *action, fu_points *power)
{
    for (int d = 0; d < 3; ++d)
        *power += action->of_section[3 + d] * at->r_x_rate[d] + action->of_section[6 + d] * at->chord_rate[d];
}

void fu_section_derivatives(const fu_block_fluid *fluid, const fu_block_action *action, const fu_points *scale,
                            double rate, fu_points *by)
{
    for (int force = 0; force < 3; ++force)
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const fu_points *row = action->section_by + 9 * (3 * force + i);
                fu_points *out = by + 27 * force + 3 * i + j, by_place = -rate * row[6 + j];
                out[18] -= *scale * row[3 + j];
                if (force == 0) continue; /* by slope and place among those of any cable */
                for (int k = 0; k < 3; ++k) by_place += row[6 + k] * fluid->gradient[3 * k + j];
                out[0] -= *scale * by_place;
                out[9] -= *scale * row[j];
            }
}
