/* The parts of a state of a hard contact, and the ends of its surface. */
#include "bodies/model.h"
#include "couplings/hard_contact/hard_contact.h"

fu_hard_flags *fu_hard_flags_of(const fu_coupling *coupling, const fu_state *state)
{
    return (fu_hard_flags *)(state->flags + coupling->flags);
}

fu_hard_numbers *fu_hard_numbers_of(const fu_coupling *coupling, const fu_state *state)
{
    return (fu_hard_numbers *)(state->numbers + coupling->numbers);
}

double fu_hard_beyond(const fu_model *model, const fu_hard_contact *hard, const fu_state *state)
{
    const fu_contact *contact = &hard->contact;
    fu_attachment_state on;
    fu_contact_point point;
    fu_surface_at(model, &contact->surface, state, &on);
    fu_contact_place(model, contact, &on, state, 0, 0, &point);
    return fu_surface_beyond(model->dim, &contact->surface, &on, point.r);
}
