/* Public: the types of couplings with the events that they find: events/list.c. */
#ifndef FUNICULAR_EVENTS_LIST_H
#define FUNICULAR_EVENTS_LIST_H

#include "couplings/common/coupling_events.h"

/* The type of this name, null if there is none; assigns the events of its type to a coupling. */
const fu_coupling_type *fu_coupling_type_of(const char *name);
const fu_coupling_type *fu_coupling_type_at(size_t k); /* type number k, null beyond the last */
void fu_bind_events(fu_coupling *coupling);

#endif
