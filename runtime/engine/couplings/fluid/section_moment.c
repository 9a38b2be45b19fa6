/* Forces of a fluid on slope and chord of a beam by the moment on its section (derive/couplings/section_flow.py). The
 * force on its axis is that of any cable, in couplings/fluid/drag.c. */
#include "bodies/cables.h"
#include "couplings/fluid/drag.h"

#include <string.h>

/* Returns the power per length of the forces on slope and chord, W/m. */
double fu_section_power(const fu_drag_place *at, const fu_drag_action *action)
{
    return fu_dot(3, action->of_section + 3, at->r_x_rate) + fu_dot(3, action->of_section + 6, at->chord_rate);
}

/* Subtracts `part` times these forces from f, the left side of the equations of motion of an element of n shape
 * functions. */
void fu_section_forces(const fu_drag_action *action, fu_quadrature_point point, double part, int n, double *f)
{
    for (int k = 0; k < n; ++k)
        for (int d = 0; d < 3; ++d)
            f[k * 3 + d] -=
                part * (point.N_x[k] * action->of_section[3 + d] + point.N_chord[k] * action->of_section[6 + d]);
}

/* Computes the derivative of one of the three forces by one of r_x, chord and w. */
static void block(const fu_drag_action *action, int force, int by, double out[9])
{
    for (int d = 0; d < 3; ++d)
        memcpy(out + 3 * d, action->section_by + 9 * (3 * force + d) + 3 * by, sizeof(double[3]));
}

/* Adds to K (all x all) `scale` times their derivatives, and that of the force on the axis by the chord; rate:
 * derivative of velocities by positions. */
void fu_section_matrix(const fu_drag_action *action, fu_quadrature_point point, double scale, double rate, int all,
                       double *K)
{
    const double *shapes[3] = {point.N, point.N_x, point.N_chord};
    double by[9], by_w[9], by_place[9];
    for (int force = 0; force < 3; ++force) {
        block(action, force, 1, by);
        fu_add_element_product(3, all, scale, shapes[force], point.N_chord, by, K);
        if (force == 0) continue;
        block(action, force, 0, by);
        block(action, force, 2, by_w);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                by_place[3 * i + j] = -rate * by_w[3 * i + j];
                for (int k = 0; k < 3; ++k) by_place[3 * i + j] += by_w[3 * i + k] * action->flow.gradient[3 * k + j];
            }
        fu_add_field_matrix(3, all, scale, shapes[force], &(fu_field_change){by, point.N_x, by_place, point.N}, K);
    }
}
