/* Slides that stick, break loose, and reach the ends of their cables: events/end_stops.c. */
#ifndef FUNICULAR_EVENTS_END_STOPS_H
#define FUNICULAR_EVENTS_END_STOPS_H

#include "couplings/slide/slide.h"

double fu_stick_margin(const fu_run *run, const fu_state *state, int slide);
double fu_buffer_margin(const fu_run *run, const fu_state *state, int slide, int side);
void fu_find_slip_direction(fu_run *run, const fu_coupling *coupling);
int fu_begin_stops(fu_run *run, const fu_coupling *coupling);
int fu_reach_end(fu_run *run, const fu_coupling *coupling, int side, const char **what);
void fu_pass_buffer(fu_run *run, const fu_coupling *coupling, int end, int enters, const char **what);
int fu_release_or_stick(fu_run *run, const fu_coupling *coupling, const char **what);

#endif
