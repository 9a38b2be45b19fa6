/* Events of friction of a joint that sticks: it comes to rest, turns round and breaks loose (events/sticking.c). */
#include "couplings/joint/joint.h"
#include "equations/run.h"
#include "events/events.h"
#include "events/sticking.h"

#include <math.h>

#define REST_MOTION 1e-12 /* of the scene's size over the duration: a smaller speed of sliding is zero */

static void lock(fu_run *run, const fu_coupling *coupling)
{
    fu_joint_lock(run->model, coupling, &run->now);
}

/* The forces of Newton's method have the rounding of positions over h^2: those of eq 38 replace them. */
static double excess(const fu_run *run, const fu_coupling *coupling, const fu_state *state, double *pull)
{
    const double *lambda = 0;
    if (run->integrator->newton && fu_event_accelerations(run, state)) lambda = run->accelerator.multipliers;
    return fu_joint_excess(run->model, coupling, state, lambda, pull);
}

/* The force of the lock opposes the motion that follows. */
static void release(fu_run *run, const fu_coupling *coupling, double pull)
{
    fu_sticking_flags *flags = fu_joint_sticking_flags(run->model, coupling, &run->now);
    flags->mode = FU_SLIDES;
    flags->slip_direction = pull > 0.0 ? 1 : -1;
}

static const fu_sticking sticking = {fu_joint_sticking_flags, fu_joint_free_rate, lock, excess, release};

static double value_of(const fu_run *run, const fu_coupling *coupling, const fu_state *state, int which)
{
    (void)which;
    return fu_sticking_margin(run, coupling, state, &sticking);
}

static int act(fu_run *run, const fu_coupling *coupling, int which, int side, const char **what)
{
    double pull;
    (void)which, (void)side;
    if (fu_joint_sticking_flags(run->model, coupling, &run->now)->mode != FU_LOCKED)
        return fu_stick_or_turn(run, coupling, &sticking, what);
    excess(run, coupling, &run->now, &pull);
    release(run, coupling, pull);
    *what = "broke loose";
    return FU_RUNNING;
}

static void update_direction(fu_run *run, const fu_coupling *coupling)
{
    fu_set_slip_direction(run, coupling, &sticking);
}

static int begin(fu_run *run, const fu_coupling *coupling)
{
    const double arm = ((const fu_joint_friction *)coupling)->arms[0];
    const double speed = arm * fabs(fu_joint_free_rate(run->model, coupling, &run->now));
    return speed * run->duration <= REST_MOTION * run->size ? fu_try_to_stick(run, coupling, &sticking) : FU_RUNNING;
}

const fu_coupling_events fu_joint_sticking_events = {
    .direction = 1, .value = value_of, .act = act, .update_direction = update_direction, .begin = begin};
