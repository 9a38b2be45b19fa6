/* What a run watches, and what happens to it; a watched number over a step. */
#ifndef FUNICULAR_BASE_EVENT_H
#define FUNICULAR_BASE_EVENT_H

#include "base/common.h"

/* What is watched. `index` is an entry of the state's q, v or s, less a value; or a coupling, of which `which` tells a
 * number of its row of output, less a value, or one of its own watches; or nothing, for a function of the user's. A
 * number of a row of output is of the accelerations, which eq 38 gives anew at each state that is looked at. */
enum {
    FU_EVENT_OF_Q,
    FU_EVENT_OF_V,
    FU_EVENT_OF_S,
    FU_EVENT_OF_RATE,
    FU_EVENT_OF_OUTPUT,
    FU_EVENT_OF_CALL,
    FU_EVENT_OF_COUPLING
};
typedef struct fu_event_function {
    int kind, index, which, direction; /* direction: 1 rising, -1 falling, 0 both */
    double value;
} fu_event_function;

/* An event. FU_PATH_BOUNDARY: a coupling, `which`, passes a boundary of its path to a side. FU_EVENT_FUNCTION: the
 * watch `which` passes zero to a side. FU_ACTED: a coupling, `which`, has changed by itself, as `what` says in words.
 * FU_DEFERRED: a step went over that. FU_WENT_SLACK: a cable, `which`, has become slack, or taut again; `side` is an
 * element of it. */
enum { FU_NO_EVENT = 0, FU_PATH_BOUNDARY, FU_EVENT_FUNCTION, FU_ACTED, FU_DEFERRED, FU_WENT_SLACK };
typedef struct {
    int kind, which, side;
    const char *what;
} fu_event;

#endif
