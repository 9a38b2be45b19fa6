/* Sheaves at a state: angles of both tangent points, and the material that passes. */
#include "bodies/model.h"
#include "couplings/sheave/sheave.h"

#include <math.h>

/* of the length of the least wrap that stretches: that of a short one whose zones are equal beyond rounding */
#define RESOLVED 0.5

double fu_stretch_at(const fu_sheave_state *at, int k)
{
    return sqrt(fu_dot(DIM, at->slope[k], at->slope[k]));
}

/* Computes the angles of both tangent points: the wrap counts the turns by which its stretch is nearest to the mean of
 * both spans. */
static void find_angles(const fu_sheave *sheave, fu_sheave_state *at)
{
    const double length = 0.5 * (fu_stretch_at(at, 0) + fu_stretch_at(at, 1)) * wrap_length(sheave, at);
    const double *a = at->x[0], *b = at->x[1], turn = 2.0 * acos(-1.0), sense = sheave->wheel.sense;
    const double part = sense * atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
    const double wrap = part + turn * round((length / sheave->wheel.radius - part) / turn);
    at->phi[0] = atan2(a[1], a[0]);
    at->phi[1] = at->phi[0] + sense * wrap;
}

/* Extends a wrap without length to the least one, at the stretch of the spans. */
static void extend(const fu_sheave *sheave, fu_sheave_state *at)
{
    const double middle = 0.5 * (at->phi[0] + at->phi[1]), length = fu_least_length(sheave);
    const double half =
        0.25 * sheave->wheel.sense * (fu_stretch_at(at, 0) + fu_stretch_at(at, 1)) * length / sheave->wheel.radius;
    for (int j = 0; j < sheave->n_zones; ++j) at->length[j] = length / sheave->n_zones;
    for (int j = 0; j <= sheave->n_zones; ++j) at->angle[j] = middle + (2.0 * at->share[j] - 1.0) * half;
}

/* Computes the angles of the ends of the zones, and their lengths. */
static void find_zones(const fu_sheave *sheave, fu_sheave_state *at)
{
    for (int j = 0; j < sheave->n_zones; ++j) at->length[j] = at->s[j + 1] - at->s[j];
    for (int j = 0; j <= sheave->n_zones; ++j) {
        const double share = (double)j / sheave->n_zones;
        at->share[j] = share;
        at->angle[j] = at->phi[0] + share * (at->phi[1] - at->phi[0]);
        at->angle_rate[j] = at->phi_rate[0] + share * (at->phi_rate[1] - at->phi_rate[0]);
        at->angle_acc[j] = at->phi_acc[0] + share * (at->phi_acc[1] - at->phi_acc[0]);
    }
    if (!fu_may_leave(sheave)) return;
    if (wrap_length(sheave, at) < fu_least_length(sheave)) extend(sheave, at);
    else if (wrap_length(sheave, at) < RESOLVED * sheave->least_wrap * sheave->wheel.radius)
        for (int j = 0; j < sheave->n_zones; ++j) at->length[j] = wrap_length(sheave, at) / sheave->n_zones;
}

/* Computes the motion of a node from the centre, with the acceleration x_acc, in space. */
static void find_node_in_space(const fu_sheave *sheave, const double *q, const double *v, const double *a, int k,
                               fu_sheave_state *out, double x_acc[DIM])
{
    const int r = sheave->nodes[k];
    const double *slope = q + r + SPACE, size = sqrt(fu_dot(SPACE, slope, slope));
    for (int d = 0; d < SPACE; ++d) out->stretch[k][d] = slope[d] / size;
    out->rise[k] = fu_dot(SPACE, out->wheel.axis, q + r) - fu_dot(SPACE, out->wheel.axis, out->wheel.centre.p);
    fu_from_centre(&sheave->wheel, &out->wheel, q + r, v + r, a + r, out->x[k], out->x_rate[k], x_acc);
    out->slope[k][0] = size;
    const double rate = fu_dot(SPACE, out->stretch[k], v + r + SPACE);
    out->slope_rate[k][0] = rate;
    out->slope_rate[k][1] = sqrt(fmax(fu_dot(SPACE, v + r + SPACE, v + r + SPACE) - rate * rate, 0.0));
    out->slope[k][1] = 0.0;
}

/* Computes the motion of a node from the centre, with the acceleration x_acc, in the plane. */
static void find_node_in_plane(const fu_sheave *sheave, const double *q, const double *v, const double *a, int k,
                               fu_sheave_state *out, double x_acc[DIM])
{
    const int r = sheave->nodes[k], slope = r + SLOPE;
    for (int d = 0; d < DIM; ++d) {
        out->x[k][d] = q[r + d] - out->wheel.centre.p[d];
        out->slope[k][d] = q[slope + d];
        out->x_rate[k][d] = v[r + d] - out->wheel.centre.v[d];
        out->slope_rate[k][d] = v[slope + d];
        x_acc[d] = a[r + d] - out->wheel.c_acc[d];
    }
}

/* Returns the angular velocity of the sheave as friction has it. In statics the rope is about to slide where the sheave
 * is held or its rotation is prescribed; a sheave that turns freely has no friction at rest. */
static double spin_below(const fu_model *model, const fu_sheave *sheave, double turn_rate)
{
    const fu_wheel *wheel = &sheave->wheel;
    if (wheel->turn >= 0 && model->unknown_of_dof[wheel->turn] >= 0) return turn_rate;
    return turn_rate - wheel->sense * model->impending * sheave->slip_velocity / wheel->radius;
}

void fu_sheave_at(const fu_model *model, const fu_sheave *sheave, const fu_state *state, const double *a,
                  fu_sheave_state *out)
{
    const double *v = state->v ? state->v : model->zero;
    const fu_state moving = {.t = state->t, .q = state->q, .v = (double *)v};
    if (!a) a = model->zero;
    out->q = state->q;
    fu_wheel_at(model, &sheave->wheel, &moving, a, &out->wheel);
    out->spin_below = spin_below(model, sheave, out->wheel.turn_rate);
    for (int k = 0; k < ENDS; ++k) {
        double x_acc[DIM];
        (is_in_space(sheave) ? find_node_in_space : find_node_in_plane)(sheave, state->q, v, a, k, out, x_acc);
        sheave->wheel.kernel->angle(out->x[k], out->x_rate[k], x_acc, &out->phi_rate[k], &out->phi_acc[k],
                                    out->phi_x[k], out->phi_xx[k], out->rate_x[k], out->acc_x[k], out->acc_v[k]);
    }
    for (int j = 0; j <= sheave->n_zones; ++j) {
        out->s[j] = state->q[sheave->s[j]];
        out->s_rate[j] = v[sheave->s[j]];
        out->s_acc[j] = a[sheave->s[j]];
    }
    out->s[sheave->n_zones] += sheave->closing;
    find_angles(sheave, out);
    find_zones(sheave, out);
    out->mode = fu_wrap_mode(sheave, out, state);
    const int lies = state->numbers && is_in_space(sheave) && out->mode != FU_LIFTED;
    out->aside = lies ? fu_place_in(sheave, state)->aside : 0.0;
    out->tension = 0.0;
}
