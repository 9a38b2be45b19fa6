/* Start and end of contact of points: events/contact.c. */
#ifndef FUNICULAR_EVENTS_CONTACT_H
#define FUNICULAR_EVENTS_CONTACT_H

#include "couplings/common/continuous_detection.h"
#include "couplings/contact/contact.h"

/* Returns the time of contact of a point with its surface, or of a graze, in the last step, of h, with the point off
 * the surface at both ends, s after `now`; else 0. on: the surface at both ends. */
double fu_contact_grazing(const fu_run *run, const fu_contact *contact, const fu_attachment_state on[2], int element,
                          int number, double h);

#endif
