/* Points of contact that come and go: events/contact.c. */
#ifndef FUNICULAR_EVENTS_CONTACT_H
#define FUNICULAR_EVENTS_CONTACT_H

#include "couplings/contact/contact.h"

/* Makes the gap of a point, and its rate; where it is and how it moves along the shape's axes, unless that is null. */
double fu_contact_gap(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                      const fu_state *state, int element, int number, double *rate, fu_surface_end *end);
/* Returns when the first point is below the surface in a step of h at both ends of which it is off it, s, else 0. */
double fu_contact_detect_within(const fu_run *run, const fu_contact *contact, double h);

#endif
