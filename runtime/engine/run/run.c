/* The time loop: from breakpoint to breakpoint, from output time to output time. */
#include "base/clock.h"
#include "base/underflow.h"
#include "events/events.h"
#include "run/run.h"

/* of a breakpoint: distance of the end of a step before it, at which the signal is still that of the step */
#define BREAKPOINT_MARGIN 1e-15

/* Returns whether the run ends on a breakpoint: its last row is of the instant before. */
static int ends_on(const fu_run *run, const fu_breakpoint *breakpoint)
{
    return breakpoint->t >= run->duration * (1.0 - FU_AT_ONCE);
}

/* Computes one step towards an output time, or the first breakpoint before it; returns a status. */
static int approach(fu_run *run, double target)
{
    const fu_breakpoint *breakpoint = run->n_breakpoints ? fu_next_breakpoint(run, target) : 0;
    if (!breakpoint) return fu_step_towards(run, target);
    const int status = fu_step_towards(run, breakpoint->t * (1.0 - BREAKPOINT_MARGIN));
    if ((status && status != FU_EVENT) || run->now.t < breakpoint->t - FU_AT_ONCE * run->duration) return status;
    if (ends_on(run, breakpoint)) return status;
    const int passed = fu_pass_breakpoint(run, breakpoint, status == FU_EVENT);
    return passed ? passed : status;
}

/* Returns whether the run has reached the number of evaluations at which its continuation is decided; iterations count
 * for integrators without evaluations. */
int fu_has_worked(const fu_run *run)
{
    const fu_statistics *done = &run->statistics;
    return run->most_evaluations &&
           (done->evaluations ? done->evaluations : done->newton_iterations) >= run->most_evaluations;
}

/* Records the row of an output time, with the signals of the step that ended there; returns a status. */
static int record(fu_run *run, double target)
{
    fu_record *r = &run->record;
    if (run->n_breakpoints && target == run->duration && ends_on(run, &run->breakpoints[run->n_breakpoints - 1])) {
        run->now.t = target * (1.0 - BREAKPOINT_MARGIN);
        const int recorded = fu_record_row(run);
        if (!recorded) run->now.t = run->recorded = r->time[r->n - 1 - r->first] = target;
        return recorded;
    }
    run->now.t = target;
    return fu_record_row(run);
}

/* Pauses after a row, unless the caller does; returns whether the caller takes over. */
static int pauses(fu_run *run)
{
    fu_record *r = &run->record;
    if (!r->every) return 1;
    fu_pause(run);
    r->pause += r->every;
    return fu_has_worked(run);
}

/* Continues from row to row, or to one time alone, unless that is negative; returns a status. */
static int advance(fu_run *run, double seconds, double alone)
{
    const double until = fu_clock() + seconds;
    for (;;) {
        if (fu_take_deferred(run)) return FU_EVENT;
        double target = alone < 0.0 ? run->record.n * run->output_step : alone;
        if (target > run->duration * (1.0 - FU_AT_ONCE)) target = run->duration;
        if (run->now.t >= target - FU_AT_ONCE * run->duration) {
            const int recorded = record(run, target);
            if (recorded) return recorded;
            if (target == run->duration || alone >= 0.0) return FU_DONE;
            if (run->record.n == run->record.pause && pauses(run)) return FU_RUNNING;
            if (fu_clock() > until) return FU_RUNNING;
        } else {
            const int status = approach(run, target);
            if (status == FU_EVENT) return status;
            if (status) {
                const int stopped = fu_stop(run);
                return stopped == FU_EVENT ? status : stopped;
            }
            if (fu_clock() > until || fu_has_worked(run)) return FU_RUNNING;
        }
    }
}

/* Advances with tiny numbers as zeros. */
static int advance_without_tiny(fu_run *run, double seconds, double alone)
{
    const unsigned before = fu_underflow();
    fu_set_underflow(before | FU_TINY_IS_ZERO);
    const int status = advance(run, seconds, alone);
    fu_set_underflow(before);
    return status;
}

/* Continues for a number of seconds, or to the pause; returns a status, FU_RUNNING before the end. */
int fu_advance(fu_run *run, double seconds)
{
    return advance_without_tiny(run, seconds, -1.0);
}

/* Continues for a number of seconds, or to a time after `now`, s, at most the duration, and records its row; returns a
 * status: FU_DONE with the row, FU_RUNNING before. */
int fu_reach(fu_run *run, double time, double seconds)
{
    return advance_without_tiny(run, seconds, time);
}
