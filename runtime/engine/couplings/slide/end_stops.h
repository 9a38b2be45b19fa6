/* What waits for a slide at the ends of its cable: couplings/end_stops.c. */
#ifndef FUNICULAR_END_STOPS_H
#define FUNICULAR_END_STOPS_H

#include "coupling.h"

/* What waits for a slide at an end of its cable: the restitution of a hard stop; the length before the end, m, the stiffness,
 * N/m, and the damping, N s/m, of a buffer. */
enum { FU_END_IS_ERROR, FU_END_IS_OPEN, FU_END_IS_HARD, FU_END_IS_BUFFERED };
typedef struct {
    int kind;
    double restitution, length, stiffness, damping;
} fu_end_stop;

extern const char *const fu_end_stop_kinds[]; /* the words for them */

/* Slides that stick, break loose, and reach what is at the ends of their cables: parts of couplings/slide_events.c. */
double fu_stick_margin(const fu_run *run, const fu_state *state, int slide);
double fu_buffer_margin(const fu_run *run, const fu_state *state, int slide, int side);
void fu_find_slip_direction(fu_run *run, const fu_coupling *coupling);
int fu_begin_stops(fu_run *run, const fu_coupling *coupling);
int fu_reach_end(fu_run *run, const fu_coupling *coupling, int side, const char **what);
void fu_pass_buffer(fu_run *run, const fu_coupling *coupling, int end, int enters, const char **what);
int fu_release_or_stick(fu_run *run, const fu_coupling *coupling, const char **what);

#endif
