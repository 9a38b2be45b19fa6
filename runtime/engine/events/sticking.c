/* Friction that sticks at rest and breaks loose: a coupling is locked by a constraint, whose force is compared with the
 * limit, and slides in a known direction, since its change is an event. */
#include "events/sticking.h"
#include "equations/equations.h"
#include "equations/run.h"

int fu_try_to_stick(fu_run *run, const fu_coupling *coupling, const fu_sticking *of)
{
    double pull;
    of->flags(run->model, coupling, &run->now)->mode = FU_LOCKED;
    of->lock(run, coupling);
    if (fu_project_velocities(run->model, &run->now, &run->accelerator, run->work)) return FU_SINGULAR;
    fu_impact(run, run->work, 0.0);
    if (fu_complete(run, &run->now)) return FU_SINGULAR;
    if (of->excess(run, coupling, &run->now, &pull) > 0.0) of->release(run, coupling, pull);
    return FU_RUNNING;
}

void fu_set_slip_direction(fu_run *run, const fu_coupling *coupling, const fu_sticking *of)
{
    fu_sticking_flags *flags = of->flags(run->model, coupling, &run->now);
    const double rate = flags->mode == FU_SLIDES ? of->rate(run->model, coupling, &run->now) : 0.0;
    if (rate != 0.0) flags->slip_direction = rate > 0.0 ? 1 : -1;
}

double fu_sticking_margin(const fu_run *run, const fu_coupling *coupling, const fu_state *state, const fu_sticking *of)
{
    const fu_sticking_flags *flags = of->flags(run->model, coupling, state);
    double pull;
    if (flags->mode == FU_LOCKED) return of->excess(run, coupling, state, &pull);
    return -flags->slip_direction * of->rate(run->model, coupling, state);
}

int fu_stick_or_turn(fu_run *run, const fu_coupling *coupling, const fu_sticking *of, const char **what)
{
    const int status = fu_try_to_stick(run, coupling, of);
    *what = of->flags(run->model, coupling, &run->now)->mode == FU_LOCKED ? "stuck" : "turned round";
    return status;
}
