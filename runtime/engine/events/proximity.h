/* Couplings that may act, and event functions that may pass zero: events/proximity.c. */
#ifndef FUNICULAR_EVENTS_PROXIMITY_H
#define FUNICULAR_EVENTS_PROXIMITY_H

#include "couplings/common/proximity.h"

/* The event functions that may pass zero up to a state (null: in any way), or within a step of h that leads to
 * `next`. */
typedef struct {
    const int *list; /* null: all, in order */
    int n;
} fu_event_function_list;
fu_event_function_list fu_near_event_functions(const fu_run *run, const fu_state *state);
fu_event_function_list fu_near_event_functions_within(const fu_run *run, double h);
static inline int fu_event_function_of(fu_event_function_list list, int i)
{
    return list.list ? list.list[i] : i;
}
/* Whether an event function was left out at the last evaluation at `now`. */
int fu_is_far_event_function(const fu_run *run, int function);

/* Repeats the search for near pairs after a step of h, if necessary or in any case. */
void fu_look_around(fu_run *run, double h, int anew);

#endif
