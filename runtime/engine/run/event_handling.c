/* Actions of events at the instant `now`. */
#include "couplings/common/coupling_events.h"
#include "events/events.h"
#include "run/run.h"

#include <math.h>

#define MAX_DELAY 1e-6 /* of the duration: largest time between an event and the end of its step */
#define MAX_ACTS 100   /* changes of couplings at one instant: more is no motion */

/* Restarts the scheme after a coupling has changed, as `what` says, a time ago, s; returns FU_EVENT to inform the
 * caller, unless `what` is empty, or the status of a run that cannot continue. */
static int acted(fu_run *run, const fu_coupling *coupling, const char *what, double since)
{
    const int status = fu_start_scheme(run, !run->integrator->keeps_energy || !coupling->events->keeps_velocities);
    run->acts = run->now.t - run->acted <= FU_AT_ONCE * run->duration ? run->acts + 1 : 0;
    run->acted = run->now.t;
    if (run->acts > MAX_ACTS) {
        fu_fail(run, FU_SELF_LOCKING, run->now.v, coupling->number);
        return FU_NO_CONVERGENCE;
    }
    fu_restart_event_functions(run, coupling->number);
    if (status || !*what) return status;
    run->event = (fu_event){FU_ACTED, coupling->number, 0, what};
    run->event_time = run->now.t - since;
    return FU_EVENT;
}

/* Moves a coupling on a boundary to the next path segment, or to the end of its path; returns a status. Accelerations
 * and force are discontinuous with r_xx there: the scheme restarts. If they were carried over, the short steps around a
 * boundary would amplify the constraint errors in them by the ratio of the steps at every node deferred event, and a
 * spectral radius of 1 does not damp them. */
static int cross(fu_run *run, const fu_coupling *coupling, int side)
{
    const fu_coupling_events *events = coupling->events;
    fu_state *now = &run->now;
    const int segment = now->segment[coupling->coordinate] + side;
    if (segment < 0 || segment >= fu_path_of(run->model, coupling, now).n) {
        const char *what = 0;
        const int status = events->path->reach_end(run, coupling, side, &what);
        return status ? status : acted(run, coupling, what, 0.0);
    }
    const int status = events->path->enter ? events->path->enter(run, coupling, segment) : FU_RUNNING;
    if (status) return status;
    now->segment[coupling->coordinate] = segment;
    ++run->statistics.node_passages;
    fu_evaluate_event_functions(run, fu_no_event, 0.0);
    return fu_start_scheme(run, !run->integrator->keeps_energy);
}

/* Executes the action of an event at `now`; returns a status, FU_EVENT to inform the caller. */
int fu_handle_event(fu_run *run, fu_event event)
{
    if (event.kind == FU_PATH_BOUNDARY) return cross(run, run->model->couplings[event.which], event.side);
    const fu_coupling *coupling = fu_event_coupling(run, event.which);
    if (coupling) {
        const fu_coupling_events *events = coupling->events;
        const int which = run->event_functions[event.which].which;
        const char *what = 0;
        const double since = events->deferred ? events->deferred->since(run->model, coupling, &run->now) : 0.0;
        int status = FU_RUNNING;
        if (events->of_state) what = events->of_state->change(run->model, coupling, &run->now, which, event.side);
        else status = events->act(run, coupling, which, event.side, &what);
        return status || !what ? status
                               : acted(run, coupling, what, fabs(since) < MAX_DELAY * run->duration ? since : 0.0);
    }
    run->event = event;
    return FU_EVENT;
}
