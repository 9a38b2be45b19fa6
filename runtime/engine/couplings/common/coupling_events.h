/* Events that a coupling finds by itself: a part of its table of operations (couplings/common/coupling.h).
 * events/boundaries.c and events/events.c find the instants at which they happen, run/event_handling.c lets them
 * happen; none of them knows a kind of coupling.
 */
#ifndef FUNICULAR_COUPLINGS_COMMON_COUPLING_EVENTS_H
#define FUNICULAR_COUPLINGS_COMMON_COUPLING_EVENTS_H

#include "couplings/common/coupling.h"
#include "base/event.h"

/* The path of a coupling's coordinate: n segments, of one length, m, or between given boundaries, m, where the length
 * is their mean and boundaries is not null. At the boundaries the equations are not smooth. state->segment tells on
 * which segment a coupling is. n is zero while the coupling is on none of them. */
typedef struct {
    int n;
    double length;
    const double *boundaries;
} fu_path;

/* The path of a coupling's own coordinate, and what its boundaries ask for. */
typedef struct {
    /* Returns the path at a state. */
    fu_path (*at)(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
    /* Rate of the coordinate along the path, m/s. */
    double (*rate)(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
    /* Whether every step must end where the coupling passes a boundary, whatever the integrator. */
    int (*stops_at_boundaries)(const fu_model *model, const fu_coupling *coupling);
    /* Changes the velocities of `now` as the change to another segment asks for; returns a status. Null: it asks for
     * nothing. */
    int (*enter)(fu_run *run, const fu_coupling *coupling, int segment);
    /* Handles what follows where the coupling stands at an end of its path and goes on outwards: at the last segment
     * where side is 1, at the first where it is -1. Returns a status; *what says in words what has happened. */
    int (*reach_end)(fu_run *run, const fu_coupling *coupling, int side, const char **what);
} fu_path_operations;

/* Deferred events: changes that a step may go over, as only a slope of the force jumps there. */
typedef struct {
    /* Computes the flags of `to` those that follow from the flags of `from` and from where `to` is; returns whether
     * that changes them. */
    int (*follow)(const fu_model *model, const fu_coupling *coupling, const fu_state *from, fu_state *to);
    /* Returns after which part of a step of h from one state to the other the coupling has passed; *what as above.
     * Bends: the states have the accelerations there, and not means of steps. */
    double (*part)(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                   double h, int bends, const char **what);
    /* Returns how long before a state close to it the coupling has passed what it is about to, s; not a number where
     * that needs the state itself. */
    double (*since)(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
    /* Adds to f, times a factor, by how much the force at `to` differs from that without the change. */
    void (*force_change)(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                         double factor, double *f);
} fu_deferred_operations;

struct fu_coupling_events {
    const fu_path_operations *path;         /* null: the coupling has no path */
    const fu_deferred_operations *deferred; /* null: steps end on each of its events */

    /* Event functions: numbers, each an event where it passes zero. Writes their `which` and `direction` to `out`,
     * unless it is null, and returns how many they are. Null: there is one, of this direction. */
    int (*functions)(const fu_coupling *coupling, fu_event_function *out);
    int direction;
    double (*value)(const fu_run *run, const fu_coupling *coupling, const fu_state *state, int which);
    /* When an event function is farthest beyond zero in the step just made, of h, at both ends of which it is on one
     * side, as fu_grazing_time (events/events.h) predicts it; or where the step should end as an impact needs shorter
     * ones; else 0. Null: it is not known. */
    double (*grazing)(const fu_run *run, const fu_coupling *coupling, int which, double h);
    /* How deep what touches has sunk, m, at a state where the coupling's event function has this value. Null: it cannot
     * sink. */
    double (*depth)(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double value);
    /* How far beyond where its surface's shape is given (fu_surface_beyond) anything touches, m; not positive where
     * nothing does. Null: its surface has no ends. */
    double (*beyond)(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
    /* The sign that an event function has from here on, after it has been zero and the coupling has changed: 1 or -1.
     * Null: -1. */
    int (*sign)(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int which);
    /* Handles what follows where an event function has passed zero to this side; returns a status. *what says in
     * words what has happened, and is null where nothing has. */
    int (*act)(fu_run *run, const fu_coupling *coupling, int which, int side, const char **what);

    /* Whether the coupling can change by itself (null: it can): `begin` then finds how it is at the start; returns a
     * status. */
    int (*can_act)(const fu_coupling *coupling);
    int (*begin)(fu_run *run, const fu_coupling *coupling);
    /* Gives the state what follows from velocities that have jumped. Null: nothing does. */
    void (*take_velocities)(fu_run *run, const fu_coupling *coupling);
};

/* Whether a coupling can change by itself. */
static inline int fu_can_act(const fu_coupling *coupling)
{
    const fu_coupling_events *events = coupling->events;
    return events && (!events->can_act || events->can_act(coupling));
}

static inline int fu_can_defer(const fu_coupling *coupling)
{
    return fu_can_act(coupling) && coupling->events->deferred && !coupling->is_damped;
}

/* The path of a coupling at a state, with no segments where it has none. */
static inline fu_path fu_path_of(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_coupling_events *events = coupling->events;
    return events && events->path ? events->path->at(model, coupling, state) : (fu_path){0, 0.0, 0};
}

#endif
