/* Public: events at which a run stops, or which it defers: events/events.c. */
#ifndef FUNICULAR_EVENTS_EVENTS_H
#define FUNICULAR_EVENTS_EVENTS_H

#include "base/common.h"
#include "base/event.h"
#include "couplings/common/coupling.h"
#include "couplings/common/coupling_events.h"
#include "couplings/common/proximity.h"

/* Solution of eq 38 for event functions: again for each; once for all evaluated at one state, not done yet, done, or
 * without a solution. */
enum { FU_SOLVE_ANEW = 0, FU_SOLVE_ONCE, FU_IS_SOLVED, FU_HAS_NO_SOLUTION };
/* Returns the accelerations at a state for an event function, with run->accelerator in its state after them; null
 * without a solution. */
const double *fu_event_accelerations(const fu_run *run, const fu_state *state);

fu_event fu_find_event(fu_run *run, fu_event but);
void fu_set_late(fu_run *run, int function, int side); /* to which side it passed together with another event */
fu_event fu_late_event(fu_run *run);
double fu_locate(fu_run *run, fu_event event, double h);
int fu_has_lost_an_event(fu_run *run);
void fu_evaluate_event_functions(fu_run *run, fu_event event, double h);
void fu_restart_event_functions(fu_run *run, int coupling);
void fu_evaluate_far_event_functions(fu_run *run);

/* events/grazing.c: time of the first grazing event of the last step, of h, s after its start; 0 if none is predicted.
 */
double fu_time_of_grazing(const fu_run *run, double h);

/* Loops over the couplings: events/coupling_events.c. */
int fu_coupling_event_functions(const fu_model *model, fu_event_function *out);
/* Whether couplings can change their state; their state at the start, a status; updates after a jump of velocities;
 * actions at the end of a path, and after an event function of a coupling has passed zero. */
int fu_couplings_can_act(const fu_model *model);
int fu_begin_couplings(fu_run *run);
void fu_update_directions(fu_run *run);

extern const fu_event fu_no_event;

/* Boundaries between the segments of couplings' paths, as between the elements of a cable: events/boundaries.c. */
double fu_boundary_tolerance(fu_path path);
double fu_boundary(fu_path path, int k);
double fu_path_segment_length(fu_path path, int k);
/* Return a coupling's coordinate at the state of its path, in the units of the boundaries, and its rate there. */
double fu_path_coordinate(fu_path path, const fu_coupling *coupling, const fu_state *state);
double fu_path_rate(fu_path path, const fu_run *run, const fu_coupling *coupling, const fu_state *state);
double fu_outside(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int *side);
int fu_stop_at_boundaries(const fu_model *model);
double fu_time_to_boundary(const fu_run *run);
double fu_time_of_turn(const fu_run *run, double h);
void fu_choose_path_segments(fu_run *run);
int fu_count_changes(const fu_run *run);
void fu_restore_path_segments(fu_run *run);
void fu_find_path_segments(const fu_model *model, fu_state *state);
int fu_stands_on_boundary(const fu_run *run, fu_event event);
int fu_are_on_path_segments(const fu_model *model, const fu_state *state, double aside);

/* Deferred events, changes of couplings within a step: events/deferred.c. */
int fu_update_deferred(fu_run *run, int first);
int fu_has_unbounded_error(const fu_run *run);
int fu_count_deferred(const fu_run *run);
void fu_undo_deferred(fu_run *run);
void fu_record_deferred(fu_run *run, double h);
double fu_deferred_error(fu_run *run, double h);
double fu_friction_error(fu_run *run, double h);
int fu_take_deferred(fu_run *run);

/* Largest penetration, and contact beyond the ends of surfaces: events/penetration.c. */
void fu_record_penetrations(fu_run *run);
/* Returns the distance of contact beyond the ends of a surface, m; not positive for none. */
double fu_beyond(const fu_model *model, const fu_coupling *coupling, const fu_state *state);

/* events/proximity.c: the event functions that may pass zero up to a state (null: in any way), or within a step of h
 * that leads to `next`. */
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
void fu_search_near_pairs(fu_run *run, double h, int anew);

#endif
