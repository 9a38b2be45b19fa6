/* The part of a state that belongs to friction of a joint that sticks. */
#include "couplings/joint/joint.h"

fu_sticking_flags *fu_joint_sticking_flags(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    (void)model;
    return (fu_sticking_flags *)(state->flags + coupling->flags);
}

fu_joint_sticking_numbers *fu_joint_sticking_numbers_of(const fu_coupling *coupling, const fu_state *state)
{
    return (fu_joint_sticking_numbers *)(state->numbers + coupling->numbers);
}

const double *fu_joint_locked(const fu_joint *joint, const fu_state *state)
{
    const fu_coupling *coupling = &joint->base;
    if (coupling->type != &fu_joint_sticking_type || fu_joint_sticking_flags(0, coupling, state)->mode != FU_LOCKED)
        return 0;
    return fu_joint_sticking_numbers_of(coupling, state)->locked;
}
