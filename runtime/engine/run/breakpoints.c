/* Breakpoints: instants at which signals are not smooth, and steps end. */
#include "couplings/common/couplings.h"
#include "equations/equations.h"
#include "events/events.h"
#include "run/run.h"

#include <math.h>

/* Returns the first breakpoint after `now` at which steps end, until `latest`; null if there is none. */
const fu_breakpoint *fu_next_breakpoint(const fu_run *run, double latest)
{
    const double close = FU_AT_ONCE * run->duration;
    int low = 0, high = run->n_breakpoints;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (run->breakpoints[middle].t > run->now.t + close) high = middle;
        else low = middle + 1;
    }
    return low < run->n_breakpoints && run->breakpoints[low].t <= latest + close ? &run->breakpoints[low] : 0;
}

/* Continues from a breakpoint that `now` has reached; returns a status. A discontinuity restarts the scheme; so does
 * any breakpoint between steps of fixed length, whose neighbours can have any ratio. Where a rate is discontinuous, so
 * are all rates that joints tie to it, and the drive does the work of that; a drive that changed within an instant
 * would not. */
int fu_pass_breakpoint(fu_run *run, const fu_breakpoint *breakpoint, int event)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    now->t = breakpoint->t;
    run->drive_step = fmin(run->drive_step, 0.0); /* earlier powers do not predict the power from here */
    if (breakpoint->jumps == FU_HIGHER_JUMPS && run->fixed_step <= 0.0) return FU_RUNNING;
    if (breakpoint->jumps == FU_RATE_JUMPS) {
        const double before = fu_kinetic_energy_at(model, now);
        fu_prescribe(model, now);
        if (fu_project_velocities(model, now, &run->accelerator, run->work)) return FU_SINGULAR;
        for (int i = 0; i < model->n_dof; ++i) now->v[i] += run->work[i];
        fu_history_jump(model, now, run->work);
        run->external += fu_kinetic_energy_at(model, now) - before;
    }
    fu_prescribe(model, now);
    if (!event) fu_evaluate_event_functions(run, fu_no_event, INFINITY);
    return fu_start_scheme(run, 0);
}
