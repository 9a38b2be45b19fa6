/* Largest penetration, and contact beyond the ends of surfaces: events/penetration.c. */
#ifndef FUNICULAR_EVENTS_PENETRATION_H
#define FUNICULAR_EVENTS_PENETRATION_H

#include "couplings/common/coupling.h"

void fu_record_penetrations(fu_run *run);
/* Returns the distance of contact beyond the ends of a surface, m; not positive for none. */
double fu_beyond(const fu_model *model, const fu_coupling *coupling, const fu_state *state);

#endif
