/* Events that a run stops at or passes: run/events.c. */
#ifndef FUNICULAR_EVENTS_H
#define FUNICULAR_EVENTS_H

#include "common.h"

/* What is watched. `index` is an entry of the state's q, v or s, less a value; or a coupling, of which `which` tells a number
 * of its row of output, less a value, or one of its own watches; or nothing, for a function of the user's.
 * A number of a row of output is of the accelerations, which eq 38 gives anew at each state that is looked at. */
enum { FU_WATCH_Q, FU_WATCH_V, FU_WATCH_S, FU_WATCH_RATE, FU_WATCH_OUTPUT, FU_WATCH_CALL, FU_WATCH_COUPLING };
typedef struct {
    int kind, index, which, direction; /* direction: 1 rising, -1 falling, 0 both */
    double value;
} fu_watch;

/* An event. FU_CROSSING: a coupling, `which`, passes a boundary of its path to a side. FU_WATCHED: the watch `which` passes
 * zero to a side. FU_ACTED: a coupling, `which`, has changed by itself, as `what` says in words. FU_PASSED: a step went over that.
 * FU_GAVE_WAY: a cable, `which`, has become slack, or taut again; `side` is an element of it. */
enum { FU_NO_EVENT = 0, FU_CROSSING, FU_WATCHED, FU_ACTED, FU_PASSED, FU_GAVE_WAY };
typedef struct {
    int kind, which, side;
    const char *what;
} fu_event;
extern const fu_event fu_no_event;

/* How eq 38 is solved for what is watched: anew for each number; for all that are read together at one state once, which is still to
 * be done, has been done, or has found no solution. */
enum { FU_SOLVE_ANEW = 0, FU_SOLVE_ONCE, FU_IS_SOLVED, FU_HAS_NO_SOLUTION };
/* The accelerations at a state for a watched number, with run->accelerator as it is after them; null where there is no solution. */
const double *fu_watch_accelerations(const fu_run *run, const fu_state *state);

fu_event fu_find_event(fu_run *run, fu_event but);
fu_event fu_late_event(fu_run *run);
double fu_locate(fu_run *run, fu_event event, double h);
int fu_has_lost_a_watch(fu_run *run);
void fu_watch_now(fu_run *run, fu_event event, double h);
void fu_watch_anew(fu_run *run, int coupling);
void fu_watch_far(fu_run *run);

/* run/dips.c: what is watched, and its rate; when it is farthest beyond zero in a step of h, s after the start, where it leaves the
 * side (1 or -1) on which it is at both ends; 0 where it is not predicted to, or not by more than `least`. */
typedef struct {
    double value, rate;
} fu_course;
double fu_dip(fu_course from, fu_course to, int side, double h, double least);
double fu_part_of_minimum(const double y[2], const double m[2]);
double fu_time_of_dip(const fu_run *run, double h);

/* Loops over the couplings: couplings/coupling_events.c. */
int fu_coupling_watches(const fu_model *model, fu_watch *out);
/* Whether couplings can change by themselves; how they do at the start, a status; what follows from velocities that have
 * jumped; what follows where `now` stands at an end of a path, and where a coupling's watch has passed zero. */
int fu_couplings_can_act(const fu_model *model);
int fu_begin_couplings(fu_run *run);
void fu_couplings_take_velocities(fu_run *run);

#endif
