/* What waits for a slide at the ends of its cable: couplings/end_stops.c. */
#ifndef FUNICULAR_END_STOPS_H
#define FUNICULAR_END_STOPS_H

#include "events.h"

/* What waits for a slide at an end of its cable, and what it does in its own way: restitution of a hard stop; length
 * before the end, stiffness and damping of a buffer. */
enum { FU_END_IS_ERROR, FU_END_IS_OPEN, FU_END_IS_HARD, FU_END_IS_BUFFERED };
typedef struct {
    int kind;
    double restitution, length, stiffness, damping;
} fu_end_stop;

/* slides that stick, break loose, and reach what is at the ends of their cables */
int fu_has_stops(const fu_model *model);
double fu_stick_margin(const fu_run *run, const fu_state *state, int slide);
double fu_buffer_margin(const fu_run *run, const fu_state *state, int slide, int side);
int fu_begin_stops(fu_run *run);
int fu_reach_end(fu_run *run, int slide, int side, int *what);
int fu_act(fu_run *run, const fu_watch *watch, int side, int *what);

#endif
