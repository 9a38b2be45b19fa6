/* Events of a coupling: a part of its table of operations (couplings/common/coupling.h). events/boundaries.c and
 * events/events.c find their instants, run/event_handling.c executes their actions, for any kind of coupling. */
#ifndef FUNICULAR_COUPLINGS_COMMON_COUPLING_EVENTS_H
#define FUNICULAR_COUPLINGS_COMMON_COUPLING_EVENTS_H

#include "couplings/common/coupling.h"
#include "base/event.h"

/* The path of a coupling's coordinate: n segments, of one length, or between given boundaries if that is not null, with
 * their mean length. At the boundaries the equations are not smooth. state->segment is the segment of a coupling. n is
 * zero for a coupling without a segment. Boundaries count from `origin`, m, in units of m, 0 and 1 on a cable: on a
 * rope its nodes move, and both have rates. */
typedef struct {
    int n;
    double length;
    const double *boundaries;
    double origin, unit, origin_rate, unit_rate;
} fu_path;

/* The path of a coupling's coordinate, and the actions at its boundaries. */
typedef struct {
    /* Returns the path at a state. */
    fu_path (*at)(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
    /* Rate of the coordinate, m/s. */
    double (*rate)(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
    /* Whether every step must end where the coupling passes a boundary, with any integrator. */
    int (*stops_at_boundaries)(const fu_model *model, const fu_coupling *coupling);
    /* Changes the velocities of `now` for the transition to another segment; returns a status. Null: no change. */
    int (*enter)(fu_run *run, const fu_coupling *coupling, int segment);
    /* Handles a coupling that leaves its path at an end: at the last segment for side 1, at the first for -1. Returns a
     * status; *what describes the event in words. */
    int (*reach_end)(fu_run *run, const fu_coupling *coupling, int side, const char **what);
} fu_path_operations;

/* Deferred events: changes within a step, at which only a slope of the force is discontinuous. */
typedef struct {
    /* Computes the flags of `to` from the flags of `from` and the positions of `to`; returns whether they change. */
    int (*update_flags)(const fu_model *model, const fu_coupling *coupling, const fu_state *from, fu_state *to);
    /* Returns the part of a step of h from one state to the other after which the event happens; *what as above.
     * has_accelerations: the states contain accelerations at their instants, not means over steps. */
    double (*part)(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                   double h, int has_accelerations, const char **what);
    /* Returns the time between the event and a state close to it, s; NaN if that needs the state itself. */
    double (*since)(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
    /* Adds to f a factor times the difference between the force at `to` and the force there without the change. */
    void (*force_change)(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                         double factor, double *f);
} fu_deferred_operations;

/* Events that follow from states alone and change only the coupling's own state. The file of a coupling has them, as
 * they need no run. */
typedef struct {
    /* Returns the value of an event function at a state. */
    double (*value)(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int which);
    /* Changes the coupling's state where an event function has passed zero to this side; returns the change in words,
     * null if there is none. */
    const char *(*change)(const fu_model *model, const fu_coupling *coupling, fu_state *now, int which, int side);
    /* Determines the coupling's state at the start. Null: it stays as it is given. */
    void (*begin)(const fu_model *model, const fu_coupling *coupling, fu_state *now);
} fu_state_event_operations;

struct fu_coupling_events {
    const fu_state_event_operations *of_state; /* null: `value`, `act` and `begin` need the run */
    const fu_path_operations *path;            /* null: the coupling has no path */
    const fu_deferred_operations *deferred;    /* null: steps end on each of its events */

    /* Event functions: numbers, each an event where it passes zero. Writes their `which` and `direction` to `out`,
     * unless it is null, and returns their number. Null: there is one, of this direction. */
    int (*functions)(const fu_coupling *coupling, fu_event_function *out);
    int direction;
    double (*value)(const fu_run *run, const fu_coupling *coupling, const fu_state *state, int which);
    /* For an event function on one side at both ends of the last step, of h: returns the time of its largest excursion
     * beyond zero within the step, as predicted by fu_grazing_time (base/cubic.h), or the end of the step that resolves
     * an impact; 0 without either. Null: unknown. */
    double (*grazing)(const fu_run *run, const fu_coupling *coupling, int which, double h);
    /* Returns the penetration, m, at a state with this value of the coupling's event function. Null: no penetration. */
    double (*depth)(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double value);
    /* Returns the distance of contact beyond the ends of the surface's shape (fu_surface_beyond), m; not positive for
     * none. Null: its surface has no ends. */
    double (*beyond)(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
    /* Returns the sign, 1 or -1, of an event function after its zero and the change of the coupling. Null: -1. */
    int (*sign)(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int which);
    /* Executes the action of an event function that has passed zero to this side; returns a status. *what describes the
     * change in words, is empty for one that is not reported, and null if there is none. */
    int (*act)(fu_run *run, const fu_coupling *coupling, int which, int side, const char **what);
    /* Updates the direction of motion after a jump of velocities. Null: none. */
    void (*update_direction)(fu_run *run, const fu_coupling *coupling);
    /* Whether velocities are continuous there: a method that conserves energy does not project them. */
    int keeps_velocities;

    /* Whether the coupling can change its state (null: it can): `begin` then determines its state at the start; returns
     * a status. */
    int (*can_act)(const fu_coupling *coupling);
    int (*begin)(fu_run *run, const fu_coupling *coupling);
};

/* Whether a coupling can change its state. */
static inline int fu_can_act(const fu_coupling *coupling)
{
    const fu_coupling_events *events = coupling->events;
    return events && (!events->can_act || events->can_act(coupling));
}

static inline int fu_can_defer(const fu_coupling *coupling)
{
    return fu_can_act(coupling) && coupling->events->deferred && !coupling->is_damped;
}

/* Returns the path of a coupling at a state, without segments if it has none. */
static inline fu_path fu_path_of(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_coupling_events *events = coupling->events;
    return events && events->path ? events->path->at(model, coupling, state) : (fu_path){.unit = 1.0};
}

#endif
