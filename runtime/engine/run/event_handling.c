/* What follows from events that a run stands on. */
#include "couplings/common/coupling_events.h"
#include "events/events.h"
#include "run/run.h"

#include <math.h>

#define MOST_SINCE 1e-6 /* of the duration: how far from its end a step may have passed what it ends on */
#define MOST_ACTS 100   /* changes of couplings at one instant: more is no motion */

/* Starts the scheme anew after a coupling has changed, as `what` says, so long ago, s; returns FU_EVENT, for the caller
 * to learn of it, or the status of a run that cannot go on. */
static int acted(fu_run *run, const fu_coupling *coupling, const char *what, double since)
{
    const int status = fu_start_scheme(run, 1);
    run->acts = run->now.t - run->acted <= FU_AT_ONCE * run->duration ? run->acts + 1 : 0;
    run->acted = run->now.t;
    if (run->acts > MOST_ACTS) {
        fu_fail(run, FU_SELF_LOCKING, run->now.v, coupling->number);
        return FU_NO_CONVERGENCE;
    }
    fu_restart_event_functions(run, coupling->number);
    run->event = (fu_event){FU_ACTED, coupling->number, 0, what};
    run->event_time = run->now.t - since;
    return status ? status : FU_EVENT;
}

/* Puts a coupling that stands on a boundary on the next piece, or lets it reach the end of its path; returns a status.
 * Accelerations and force jump with r_xx there: the scheme starts anew. Were they carried over, the short steps around
 * a boundary would raise what the constraints left in them by the ratio of the steps, crossing by crossing, and a
 * spectral radius of 1 never lets it decay. */
static int cross(fu_run *run, const fu_coupling *coupling, int side)
{
    const fu_coupling_events *events = coupling->events;
    fu_state *now = &run->now;
    const int piece = now->piece[coupling->coordinate] + side;
    if (piece < 0 || piece >= fu_path_of(run->model, coupling, now).n) {
        const char *what = 0;
        const int status = events->path->reach_end(run, coupling, side, &what);
        return status ? status : acted(run, coupling, what, 0.0);
    }
    const int status = events->path->enter ? events->path->enter(run, coupling, piece) : FU_RUNNING;
    if (status) return status;
    now->piece[coupling->coordinate] = piece;
    ++run->statistics.crossings;
    fu_evaluate_event_functions(run, fu_no_event, 0.0);
    return fu_start_scheme(run, !run->integrator->keeps_energy);
}

/* Lets happen what follows from an event that `now` stands on; returns a status, FU_EVENT where the caller is to learn
 * of it. */
int fu_handle_event(fu_run *run, fu_event event)
{
    if (event.kind == FU_PATH_BOUNDARY) return cross(run, run->model->couplings[event.which], event.side);
    const fu_coupling *coupling = fu_event_coupling(run, event.which);
    if (coupling) {
        const char *what = 0;
        const double since =
            coupling->events->deferred ? coupling->events->deferred->since(run->model, coupling, &run->now) : 0.0;
        const int status = coupling->events->act(run, coupling, run->watches[event.which].which, event.side, &what);
        return status || !what ? status
                               : acted(run, coupling, what, fabs(since) < MOST_SINCE * run->duration ? since : 0.0);
    }
    run->event = event;
    return FU_EVENT;
}
