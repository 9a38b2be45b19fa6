/* Ropes that stick to sheaves in statics. Their material lies on the groove where it lay in a state before: the place
 * of a material point is linear between the points of the wrap in that state, and beyond both tangent points the rope
 * has the stretch that its spans had there. Friction at a point holds it there, or is at its limit, by the mode. */
#include "bodies/model.h"
#include "couplings/rope/rope.h"
#include "couplings/sheave/sheave.h"

#include <math.h>

static const fu_wrap_point *point_of(const fu_model *model, const fu_sheave *sheave, int j)
{
    return (const fu_wrap_point *)model->couplings[sheave->wrap_points + j];
}

/* Returns the angle of a point in the axes of what carries the sheave. In space the groove is in these axes. */
static double angle_on_carrier(const fu_sheave *sheave, const fu_sheave_state *at, int j)
{
    const double *A = at->wheel.centre.A;
    return is_in_space(sheave) ? at->angle[j] : at->angle[j] - atan2(A[DIM], A[0]);
}

static double own_turn(const fu_sheave *sheave, const fu_sheave_state *at)
{
    return sheave->wheel.turn < 0 ? 0.0 : at->q[sheave->wheel.turn];
}

/* Returns the place along the groove of a point in the state before, m. */
static double place_before(const fu_sheave *sheave, const fu_wrap_point *point)
{
    return sheave->wheel.sense * sheave->wheel.radius * point->held.angle;
}

/* Returns the place of a material coordinate in the state before, m, and the stretch there. */
static double place_of(const fu_model *model, const fu_sheave *sheave, double s, double *stretch)
{
    const int n = sheave->n_zones;
    int k = 0;
    while (k < n && s > point_of(model, sheave, k + 1)->held.s) ++k;
    const fu_wrap_point *one = point_of(model, sheave, k), *other = point_of(model, sheave, k < n ? k + 1 : n);
    const double place = place_before(sheave, one);
    if (s < one->held.s) *stretch = one->held.stretch[0];
    else if (k == n) *stretch = one->held.stretch[1];
    else *stretch = (place_before(sheave, other) - place) / (other->held.s - one->held.s);
    return place + *stretch * (s - one->held.s);
}

double fu_held_slip(const fu_model *model, const fu_sheave *sheave, const fu_sheave_state *at, int j, double *stretch)
{
    const fu_wrap_point *point = point_of(model, sheave, j);
    const double turned = remainder(angle_on_carrier(sheave, at, j) - point->held.angle, 2.0 * acos(-1.0));
    const double along = turned - (own_turn(sheave, at) - point->held.turn);
    const double material = place_of(model, sheave, at->s[j], stretch) - place_before(sheave, point);
    return sheave->wheel.sense * sheave->wheel.radius * along - material;
}

void fu_hold_point(const fu_model *model, fu_coupling *coupling, const fu_state *state)
{
    const fu_sheave *sheave = fu_sheave_of_point(model, coupling);
    fu_wrap_point *point = (fu_wrap_point *)coupling;
    const int j = point->place;
    fu_sheave_state at;
    fu_sheave_at(model, sheave, state, 0, &at);
    point->held.is_held = 1;
    point->held.s = at.s[j];
    point->held.angle = angle_on_carrier(sheave, &at, j);
    point->held.turn = own_turn(sheave, &at);
    for (int k = 0; k < ENDS; ++k) point->held.stretch[k] = fu_stretch_at(&at, k);
    *fu_wrap_point_flag(coupling, state) = FU_STICKS;
}

void fu_held_point(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_held_friction *out)
{
    const fu_sheave *sheave = fu_sheave_of_point(model, coupling);
    const int j = fu_place_of_point(coupling);
    double stretch;
    fu_sheave_state at;
    fu_wrap_force of;
    fu_sheave_at(model, sheave, state, 0, &at);
    fu_wrap_force_at(model, sheave, &at, j, state, 0, &of);
    *out = (fu_held_friction){.mode = *fu_wrap_point_flag(coupling, state),
                              .f = of.f,
                              .limit = of.at.limit,
                              .slip = fu_held_slip(model, sheave, &at, j, &stretch)};
}

void fu_set_held_mode(const fu_coupling *coupling, const fu_state *state, int mode)
{
    *fu_wrap_point_flag(coupling, state) = mode;
}
