/* Event functions and events of a run; an event function over a step. */
#ifndef FUNICULAR_BASE_EVENT_H
#define FUNICULAR_BASE_EVENT_H

#include "base/common.h"

/* Kinds of event functions. `index` is an entry of the state's q, v or s, less a value; or a coupling, with `which` a
 * component of its row of output, less a value, or one of its own event functions; or unused, for a function of the
 * user. Components of a row of output depend on accelerations, which eq 38 gives at each evaluated state. */
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
 * event function `which` passes zero to a side. FU_ACTED: a coupling, `which`, has changed its state, as `what` says in
 * words. FU_DEFERRED: an event within a step. FU_WENT_SLACK: a cable, `which`, has become slack, or taut again; `side`
 * is an element of it. */
enum { FU_NO_EVENT = 0, FU_PATH_BOUNDARY, FU_EVENT_FUNCTION, FU_ACTED, FU_DEFERRED, FU_WENT_SLACK };
typedef struct {
    int kind, which, side;
    const char *what;
} fu_event;

#endif
