/* Boundaries between the segments of couplings' paths, as between the elements of a cable: events/boundaries.c. */
#ifndef FUNICULAR_EVENTS_BOUNDARIES_H
#define FUNICULAR_EVENTS_BOUNDARIES_H

#include "couplings/common/coupling_events.h"

double fu_boundary_tolerance(fu_path path);
double fu_boundary(fu_path path, int k);
double fu_path_segment_length(fu_path path, int k);
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

#endif
