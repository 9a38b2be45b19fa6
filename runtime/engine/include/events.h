/* Events that a run stops at or passes: run/events.c. */
#ifndef FUNICULAR_EVENTS_H
#define FUNICULAR_EVENTS_H

#include "common.h"

/* What the user watches: an entry of the state less a value, a slide's rate or traction less a value, or a function of
 * his; what couplings/end_stops.c watches on a slide: whether it stays as it is, and its buffer at the end that `value` is the side of.
 * A traction is of the accelerations, which eq 38 gives anew at each state that is looked at. */
enum { FU_WATCH_Q, FU_WATCH_V, FU_WATCH_S, FU_WATCH_RATE, FU_WATCH_TRACTION, FU_WATCH_CALL, FU_WATCH_STICK,
       FU_WATCH_BUFFER };
typedef struct {
    int kind, index, direction; /* direction: 1 rising, -1 falling, 0 both */
    double value;
} fu_watch;

/* FU_ACTED: a slide, `which`, has done what `side` says: engine.pyx has words for it */
enum { FU_NO_EVENT = 0, FU_CROSSING, FU_WATCHED, FU_ACTED };
enum { FU_NOTHING, FU_STUCK, FU_BROKE_LOOSE, FU_TURNED, FU_STRUCK, FU_FREED, FU_FLEW, FU_ENTERED, FU_CAME_OUT, FU_RESTS };
typedef struct {
    int kind, which, side;
} fu_event;

fu_event fu_find_event(const fu_run *run, fu_event but);
fu_event fu_late_event(fu_run *run);
double fu_time_to_boundary(fu_run *run);
double fu_time_of_turn(fu_run *run, double h);
void fu_seat_slides(fu_run *run);
int fu_count_changes(const fu_run *run);
void fu_keep_elements(fu_run *run);
int fu_stands_on_boundary(const fu_run *run, fu_event event);
double fu_locate(fu_run *run, fu_event event, double h);
void fu_watch_now(fu_run *run, fu_event event);
void fu_watch_anew(fu_run *run, int slide);

#endif
