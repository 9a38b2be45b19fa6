/* Ropes that stick to sheaves in statics. Their material lies on the groove where it lay in a state before: the place
 * of a material point is linear between the points of the wrap in that state, and beyond both tangent points the rope
 * has the stretch that its spans had there. Friction at a point holds it there, or is at its limit, by the mode. */
#include "bodies/model.h"
#include "couplings/common/couplings.h"
#include "couplings/sheave/sheave.h"

void fu_hold_point(const fu_model *model, fu_coupling *coupling, const fu_state *state)
{
    const fu_sheave *sheave = fu_sheave_of_point(model, coupling);
    fu_wrap_point *point = (fu_wrap_point *)coupling;
    fu_sheave_state at;
    fu_sheave_at(model, sheave, state, 0, &at);
    fu_hold_at(sheave, &at, point);
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
