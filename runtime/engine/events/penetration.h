/* How deep parts sink below what they touch, and how far beyond its ends: events/penetration.c. */
#ifndef FUNICULAR_EVENTS_PENETRATION_H
#define FUNICULAR_EVENTS_PENETRATION_H

#include "couplings/common/coupling.h"

void fu_note_depths(fu_run *run);
void fu_keep_largest(double *largest, double value);
/* How far beyond the ends of its surface anything touches, m; not positive where nothing does. */
double fu_beyond(const fu_model *model, const fu_coupling *coupling, const fu_state *state);

#endif
