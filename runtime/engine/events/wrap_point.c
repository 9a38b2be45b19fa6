/* Points of a wrap that break loose, where they are asked for more than the limit of friction, and stick where sliding
 * stops. One change moves others at the same instant: all points of a scene are determined together, by the
 * accelerations that follow. */
#include "bodies/unknowns.h"
#include "couplings/common/coupling_events.h"
#include "couplings/sheave/wrap_point.h"
#include "equations/equations.h"
#include "equations/run.h"
#include "equations/scene_size.h"
#include "events/events.h"

#include <math.h>

#define EXCESS_TOLERANCE 1e-7   /* of the limit: excess at which a point breaks loose; small vibrations stay below it */
#define SPEED_TOLERANCE 1e-12   /* of the size of the scene over the duration: slower points do not slide */
#define ROUNDING_OF_SPEED 1e-12 /* of the speed of the groove: the same */
#define FORCE_TOLERANCE 1e-12   /* of EA: excess of a point without normal force that is rounding */
#define ROUNDING_OF_RATE 1e-10  /* of its terms: rate of w that is none */
#define MAX_CHANGES 1000        /* of points at one instant */

/* Returns f of a sticking point: by eq 38, since multipliers of Newton's method have the rounding of positions over
 * h^2. */
static double held(const fu_run *run, const fu_coupling *coupling, const fu_state *state)
{
    if (!run->integrator->newton) return state->forces[coupling->force];
    return fu_event_accelerations(run, state) ? run->accelerator.multipliers[coupling->multiplier] : NAN;
}

static double largest_without_excess(const fu_sheave *sheave, double limit)
{
    return (1.0 + EXCESS_TOLERANCE) * limit + FORCE_TOLERANCE * sheave->wheel.A[0];
}

/* The excess of |f| over the limit, N; of a sliding point, the speed against its direction, m/s. */
static double value(const fu_run *run, const fu_coupling *coupling, const fu_state *state, int which)
{
    const int mode = *fu_wrap_point_flag(coupling, state);
    fu_coulomb of;
    (void)which;
    if (mode == FU_POINT_IS_FREE) return -1.0;
    fu_wrap_point_at(run->model, coupling, state, &of);
    if (mode != FU_STICKS) return -mode * of.w;
    return fabs(held(run, coupling, state)) -
           largest_without_excess(fu_sheave_of_point(run->model, coupling), of.limit);
}

/* Removes the speed of sticking points; returns nonzero where eq 38 has no solution. */
static int stop(fu_run *run)
{
    if (fu_project_velocities(run->model, &run->now, &run->accelerator, run->work)) return 1;
    fu_impact(run, run->work, 0.0);
    return 0;
}

/* Returns the sticking point with the largest excess over its limit, null for none. */
static const fu_coupling *loosest(const fu_run *run)
{
    const fu_coupling *found = 0;
    double worst = 0.0;
    FU_EACH_COUPLING(c, run->model->couplings, run->model->n_couplings) {
        if (c->type != &fu_wrap_point_type || *fu_wrap_point_flag(c, &run->now) != FU_STICKS) continue;
        fu_coulomb of;
        fu_wrap_point_at(run->model, c, &run->now, &of);
        const double excess =
            fabs(run->now.forces[c->force]) - largest_without_excess(fu_sheave_of_point(run->model, c), of.limit);
        if (excess > worst) worst = excess, found = c;
    }
    return found;
}

/* Lets a sticking point slide in the direction that its f opposes. */
static void release(fu_run *run, const fu_coupling *coupling)
{
    *fu_wrap_point_flag(coupling, &run->now) =
        run->now.forces[coupling->force] > 0.0 ? FU_SLIDES_FORWARDS : FU_SLIDES_BACKWARDS;
}

/* Determines the points after sticking ones, at rest, have been chosen; returns a status. */
static int settle(fu_run *run)
{
    for (int changes = 0; changes < MAX_CHANGES; ++changes) {
        if (fu_complete(run, &run->now)) return FU_SINGULAR;
        const fu_coupling *loose = loosest(run);
        if (!loose) return FU_RUNNING;
        release(run, loose);
    }
    return FU_NO_CONVERGENCE;
}

static int act(fu_run *run, const fu_coupling *coupling, int which, int side, const char **what)
{
    int *mode = fu_wrap_point_flag(coupling, &run->now);
    (void)which, (void)side;
    *what = "";
    if (*mode == FU_STICKS) {
        fu_coulomb of;
        if (fu_complete(run, &run->now)) return FU_SINGULAR;
        fu_wrap_point_at(run->model, coupling, &run->now, &of);
        if (fabs(run->now.forces[coupling->force]) >= of.limit)
            release(run, coupling); /* the change of another may hold it */
    } else {
        *mode = FU_STICKS;
        if (stop(run)) return FU_SINGULAR;
    }
    return settle(run);
}

/* The first point determines all: those that do not slide stick, where friction can hold them. */
static int begin(fu_run *run, const fu_coupling *coupling)
{
    const fu_model *model = run->model;
    const double slow = SPEED_TOLERANCE * run->size / run->duration;
    if (coupling->index) return FU_RUNNING;
    FU_EACH_COUPLING(c, model->couplings, model->n_couplings) {
        if (c->type != &fu_wrap_point_type) continue;
        fu_coulomb of;
        fu_wrap_point_at(model, c, &run->now, &of);
        const double rounding = ROUNDING_OF_SPEED * fu_size(model, run->now.v);
        *fu_wrap_point_flag(c, &run->now) = fabs(of.w) <= fmax(slow, rounding) ? FU_STICKS
                                            : of.w > 0.0                       ? FU_SLIDES_FORWARDS
                                                                               : FU_SLIDES_BACKWARDS;
    }
    return stop(run) ? FU_SINGULAR : settle(run);
}

const fu_coupling_events fu_wrap_point_events = {.direction = 1, .value = value, .act = act, .begin = begin};
