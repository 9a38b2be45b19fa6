/* Friction that sticks and breaks loose, of slides and of joints: events/sticking.c. */
#ifndef FUNICULAR_EVENTS_STICKING_H
#define FUNICULAR_EVENTS_STICKING_H

#include "couplings/common/coupling_events.h"
#include "couplings/common/sticking.h"

/* What a kind of coupling that sticks does. */
typedef struct {
    fu_sticking_flags *(*flags)(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
    /* Returns the rate against friction at a state. */
    double (*rate)(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
    /* Locks it at its place in `now`. */
    void (*lock)(fu_run *run, const fu_coupling *coupling);
    /* Computes the force on a locked coupling, `pull`, N; returns its excess over what can hold it, N. */
    double (*excess)(const fu_run *run, const fu_coupling *coupling, const fu_state *state, double *pull);
    /* Unlocks it with the force `pull`. */
    void (*release)(fu_run *run, const fu_coupling *coupling, double pull);
} fu_sticking;

/* Locks a coupling at rest if it can carry the force on it, else lets it slide; returns a status. */
int fu_try_to_stick(fu_run *run, const fu_coupling *coupling, const fu_sticking *of);
/* Sets the direction of sliding of a coupling that moves. */
void fu_set_slip_direction(fu_run *run, const fu_coupling *coupling, const fu_sticking *of);
/* Returns a number that is negative while a coupling stays locked, or slides in its direction. */
double fu_sticking_margin(const fu_run *run, const fu_coupling *coupling, const fu_state *state, const fu_sticking *of);
/* Locks a coupling that has come to rest, if it can; *what says which. Returns a status. */
int fu_stick_or_turn(fu_run *run, const fu_coupling *coupling, const fu_sticking *of, const char **what);

#endif
