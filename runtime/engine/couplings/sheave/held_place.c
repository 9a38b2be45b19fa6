/* Places of material that lies on the groove of a sheave where it lay in a state before, see held_wrap.c. */
#include "bodies/model.h"
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
    const double angle = fu_angle_of_point(at, j);
    return is_in_space(sheave) ? angle : angle - atan2(A[DIM], A[0]);
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

/* Returns the place of a material coordinate in the state before, m, and the stretch there; n: number of the last
 * point. */
static double place_of(const fu_model *model, const fu_sheave *sheave, int n, double s, double *stretch)
{
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
    const int n = at->mode == FU_SHORT ? 0 : sheave->n_zones;
    const double s = fu_s_of_point(sheave, at, j);
    const double material = place_of(model, sheave, n, s, stretch) - place_before(sheave, point);
    return sheave->wheel.sense * sheave->wheel.radius * along - material;
}

void fu_hold_at(const fu_sheave *sheave, const fu_sheave_state *at, fu_wrap_point *point)
{
    point->held.is_held = 1;
    point->held.s = fu_s_of_point(sheave, at, point->place);
    point->held.angle = angle_on_carrier(sheave, at, point->place);
    point->held.turn = own_turn(sheave, at);
    for (int k = 0; k < ENDS; ++k) point->held.stretch[k] = fu_stretch_at(at, k);
}
