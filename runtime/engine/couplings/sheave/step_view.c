/* A sheave over a step that conserves energy: its groove, turns of its tangent points, and moments on these.
 *
 * A turn of a tangent point by dphi, from x_0 to x_1, has the measure 2 tan(dphi/2). A moment on it is the force along
 * k x x~ whose work is the moment times this; in the plane, where |x_0| = |x_1|, it has this moment about the centre. A
 * zone turns at its part of the wrap by the angle in between; so a moment there is shared between both tangent points
 * by the parts of its work. */
#include "bodies/model.h"
#include "couplings/common/momenta.h"
#include "couplings/sheave/sheave.h"

#include <math.h>

double fu_over_sine(double x)
{
    return fabs(x) < 1e-4 ? 1.0 + x * x / 6.0 : x / sin(x);
}

double fu_sheave_spin(const fu_sheave *sheave, const fu_sheave_state *at, const fu_state *state)
{
    const fu_momenta *known = fu_momenta_of(&sheave->wheel.base, state);
    return known->is_known != 0.0 ? known->P[momentum_number(sheave, sheave->n_zones, 0)] : at->wheel.turn_rate;
}

/* Computes the mean places of the tangent points from the centre, in space. */
static void find_places(const fu_sheave *sheave, const fu_equations *at, fu_sheave_over *out)
{
    for (int k = 0; k < ENDS; ++k)
        fu_mean_from_centre(sheave->nodes[k], at, &out->now.wheel, &out->next.wheel, out->x[k]);
}

void fu_sheave_over_step(const fu_model *model, const fu_sheave *sheave, const fu_equations *at, fu_sheave_over *out)
{
    fu_state middle = *at->middle;
    middle.numbers = at->next->numbers;
    middle.flags = at->next->flags;
    fu_sheave_at(model, sheave, at->now, 0, &out->now);
    fu_sheave_at(model, sheave, at->next, 0, &out->next);
    fu_sheave_at(model, sheave, &middle, 0, &out->middle);
    for (int k = 0; k < ENDS; ++k)
        for (int d = 0; d < DIM; ++d) out->middle.x[k][d] = 0.5 * (out->now.x[k][d] + out->next.x[k][d]);
    const double *from = out->now.x[0], *to = out->next.x[0];
    const double wrap = out->now.phi[1] - out->now.phi[0], wrap_next = out->next.phi[1] - out->next.phi[0];
    out->half[0] = 0.5 * atan2(from[0] * to[1] - from[1] * to[0], from[0] * to[0] + from[1] * to[1]);
    out->half[1] = out->half[0] + 0.5 * (wrap_next - wrap);
    for (int k = 0; k < ENDS; ++k) {
        const double *one = out->now.x[k], *other = out->next.x[k], turn = cos(out->half[k]);
        out->arm[k] = 1.0 / (sqrt(fu_dot(DIM, one, one) * fu_dot(DIM, other, other)) * turn * turn);
    }
    fu_groove_over_step(model, &sheave->wheel, at, &out->now.wheel, &out->next.wheel, &out->middle.wheel, &out->groove);
    for (int d = 0; d < DIM; ++d) {
        out->c[d] = is_in_space(sheave) ? 0.0 : out->now.wheel.c[d];
        out->c_change[d] = is_in_space(sheave) ? 0.0 : out->next.wheel.c[d] - out->now.wheel.c[d];
    }
    if (is_in_space(sheave)) find_places(sheave, at, out);
    out->spin[0] = fu_sheave_spin(sheave, &out->now, at->now);
    out->spin[1] = 2.0 * fu_wheel_turn(&sheave->wheel, &out->groove, at) / at->h - out->spin[0];
    for (int j = 0; j <= sheave->n_zones; ++j) out->s_change[j] = at->psi[sheave->s[j]];
}

void fu_add_turn(const fu_sheave_over *step, double part, double moment, fu_sheave_step_forces *out)
{
    const double open = step->half[1] - step->half[0], here = step->half[0] + part * open;
    const double share = part * fu_over_sine(open) / fu_over_sine(part * open) * cos(step->half[1]) / cos(here);
    out->turn[0] += (1.0 - share) * moment;
    out->turn[1] += share * moment;
}

void fu_add_opening(const fu_sheave_over *step, double moment, fu_sheave_step_forces *out)
{
    const double opening =
        moment * fu_over_sine(step->half[1] - step->half[0]) * cos(step->half[0]) * cos(step->half[1]);
    out->turn[0] -= opening;
    out->turn[1] += opening;
}
