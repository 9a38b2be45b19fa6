/* Events that a run stops at or passes: events/events.c. */
#ifndef FUNICULAR_EVENTS_EVENTS_H
#define FUNICULAR_EVENTS_EVENTS_H

#include "base/common.h"
#include "base/event.h"

/* How eq 38 is solved for what is watched: anew for each number; for all that are read together at one state once,
 * which is still to be done, has been done, or has found no solution. */
enum { FU_SOLVE_ANEW = 0, FU_SOLVE_ONCE, FU_IS_SOLVED, FU_HAS_NO_SOLUTION };
/* The accelerations at a state for a watched number, with run->accelerator as it is after them; null where there is no
 * solution. */
const double *fu_event_accelerations(const fu_run *run, const fu_state *state);

fu_event fu_find_event(fu_run *run, fu_event but);
fu_event fu_late_event(fu_run *run);
double fu_locate(fu_run *run, fu_event event, double h);
int fu_has_lost_an_event(fu_run *run);
void fu_evaluate_event_functions(fu_run *run, fu_event event, double h);
void fu_restart_event_functions(fu_run *run, int coupling);
void fu_evaluate_far_event_functions(fu_run *run);

/* events/grazing.c: what is watched, and its rate; when it is farthest beyond zero in a step of h, s after the start,
 * where it leaves the side (1 or -1) on which it is at both ends; 0 where it is not predicted to, or not by more than
 * `least`. */
double fu_time_of_grazing(const fu_run *run, double h);

/* Loops over the couplings: events/coupling_events.c. */
int fu_coupling_event_functions(const fu_model *model, fu_event_function *out);
/* Whether couplings can change by themselves; how they do at the start, a status; what follows from velocities that
 * have jumped; what follows where `now` stands at an end of a path, and where a coupling's watch has passed zero. */
int fu_couplings_can_act(const fu_model *model);
int fu_begin_couplings(fu_run *run);
void fu_couplings_take_velocities(fu_run *run);

extern const fu_event fu_no_event;

#endif
