/* Events at which a run stops, or which it defers: events/events.c. */
#ifndef FUNICULAR_EVENTS_EVENTS_H
#define FUNICULAR_EVENTS_EVENTS_H

#include "base/common.h"
#include "base/event.h"

/* Solution of eq 38 for event functions: again for each; once for all evaluated at one state, not done yet, done, or
 * without a solution. */
enum { FU_SOLVE_ANEW = 0, FU_SOLVE_ONCE, FU_IS_SOLVED, FU_HAS_NO_SOLUTION };
/* Returns the accelerations at a state for an event function, with run->accelerator in its state after them; null
 * without a solution. */
const double *fu_event_accelerations(const fu_run *run, const fu_state *state);

fu_event fu_find_event(fu_run *run, fu_event but);
fu_event fu_late_event(fu_run *run);
double fu_locate(fu_run *run, fu_event event, double h);
int fu_has_lost_an_event(fu_run *run);
void fu_evaluate_event_functions(fu_run *run, fu_event event, double h);
void fu_restart_event_functions(fu_run *run, int coupling);
void fu_evaluate_far_event_functions(fu_run *run);

/* events/grazing.c: event function and its rate; time of its largest excursion beyond zero in a step of h, s after the
 * start, if it leaves the side (1 or -1) of both ends; 0 if none is predicted, or none of more than `least`. */
double fu_time_of_grazing(const fu_run *run, double h);

/* Loops over the couplings: events/coupling_events.c. */
int fu_coupling_event_functions(const fu_model *model, fu_event_function *out);
/* Whether couplings can change their state; their state at the start, a status; updates after a jump of velocities;
 * actions at the end of a path, and after an event function of a coupling has passed zero. */
int fu_couplings_can_act(const fu_model *model);
int fu_begin_couplings(fu_run *run);
void fu_update_directions(fu_run *run);

extern const fu_event fu_no_event;

#endif
