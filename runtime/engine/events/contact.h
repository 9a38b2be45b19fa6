/* Points of contact that come and go: events/contact.c. */
#ifndef FUNICULAR_EVENTS_CONTACT_H
#define FUNICULAR_EVENTS_CONTACT_H

#include "couplings/common/continuous_detection.h"
#include "couplings/contact/contact.h"

/* Returns when a point touches its surface, or grazes it, in the step just made, of h, at both ends of which it is off
 * the surface, s after `now`; else 0. on: the surface at both ends. */
double fu_contact_grazing(const fu_run *run, const fu_contact *contact, const fu_attachment_state on[2], int element,
                          int number, double h);

#endif
