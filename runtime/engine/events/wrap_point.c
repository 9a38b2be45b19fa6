/* Points of a wrap that break loose, where they are asked for more than the limit of friction, and stick where sliding
 * stops. One change moves others at the same instant: all points of a scene are determined together, by the
 * accelerations that follow. */
#include "bodies/unknowns.h"
#include "couplings/common/coupling_events.h"
#include "couplings/sheave/sheave.h"
#include "equations/equations.h"
#include "equations/run.h"
#include "equations/scene_size.h"
#include "events/events.h"
#include "events/wrap_points.h"

#include <math.h>

/* of the limit: excess at which a point breaks loose; small vibrations stay below it */
#define EXCESS_TOLERANCE 1e-7
/* of EA: excess of a point without normal force that is rounding */
#define FORCE_TOLERANCE 1e-12
#define SPEED_TOLERANCE 1e-11   /* of the size of the scene over the duration: slower points do not slide */
#define ROUNDING_OF_SPEED 1e-11 /* of the largest speed: the same */
#define ROUNDING_OF_RATE 1e-9   /* of its terms: a rate of w that is none */
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

/* Returns whether friction acts at a point: not on a rope that has left its sheave. */
static int acts(const fu_run *run, const fu_coupling *coupling)
{
    fu_sheave_state at;
    fu_sheave_at(run->model, fu_sheave_of_point(run->model, coupling), &run->now, 0, &at);
    return fu_point_acts(&at, fu_place_of_point(coupling));
}

/* Returns whether a coupling is a point of a sheave. */
static int is_of(const fu_run *run, const fu_coupling *coupling, const fu_coupling *sheave)
{
    return coupling->type == &fu_wrap_point_type &&
           fu_sheave_of_point(run->model, coupling) == (const fu_sheave *)sheave;
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

/* Removes the speed of sticking points, which is that of an event's instant; returns nonzero where eq 38 has no
 * solution. */
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

/* Returns whether a speed of sliding is none. */
static int is_at_rest(const fu_run *run, double w)
{
    return fabs(w) <=
           fmax(SPEED_TOLERANCE * run->size / run->duration, ROUNDING_OF_SPEED * fu_size(run->model, run->now.v));
}

/* Returns whether a sliding point at rest is accelerated against its direction, so that it sticks. */
static int goes_back(const fu_run *run, const fu_coupling *coupling)
{
    const fu_sheave *sheave = fu_sheave_of_point(run->model, coupling);
    const int mode = *fu_wrap_point_flag(coupling, &run->now);
    fu_sheave_state at;
    fu_coulomb of;
    if (mode == FU_STICKS || mode == FU_POINT_IS_FREE) return 0;
    fu_wrap_point_at(run->model, coupling, &run->now, &of);
    if (!is_at_rest(run, of.w)) return 0;
    fu_sheave_at(run->model, sheave, &run->now, run->now.acceleration, &at);
    double size;
    const double rate = fu_coulomb_rate(sheave, &at, fu_place_of_point(coupling), &of, &size);
    return mode * rate < -ROUNDING_OF_RATE * size;
}

/* Determines the points after sticking ones, at rest, have been chosen: the loosest are released one by one, and one
 * that would go back sticks again. Returns a status. */
static int settle(fu_run *run)
{
    for (int changes = 0; changes < MAX_CHANGES; ++changes) {
        if (fu_complete(run, &run->now)) return FU_SINGULAR;
        const fu_coupling *loose = loosest(run), *back = 0;
        if (loose) {
            release(run, loose);
            continue;
        }
        FU_EACH_COUPLING(c, run->model->couplings, run->model->n_couplings)
            if (c->type == &fu_wrap_point_type && goes_back(run, c)) back = c;
        if (!back) return FU_RUNNING;
        *fu_wrap_point_flag(back, &run->now) = FU_STICKS;
    }
    return FU_NO_CONVERGENCE;
}

/* Lets the points of a scene stick at which sliding has stopped. */
static void stick_at_rest(fu_run *run)
{
    FU_EACH_COUPLING(c, run->model->couplings, run->model->n_couplings) {
        if (c->type != &fu_wrap_point_type) continue;
        int *mode = fu_wrap_point_flag(c, &run->now);
        fu_coulomb of;
        fu_wrap_point_at(run->model, c, &run->now, &of);
        if (*mode != FU_STICKS && *mode != FU_POINT_IS_FREE && is_at_rest(run, of.w)) *mode = FU_STICKS;
    }
}

static int act(fu_run *run, const fu_coupling *coupling, int which, int side, const char **what)
{
    int *mode = fu_wrap_point_flag(coupling, &run->now);
    fu_coulomb of;
    (void)which, (void)side;
    *what = 0;
    if (*mode == FU_STICKS) {
        if (fu_complete(run, &run->now)) return FU_SINGULAR;
        fu_wrap_point_at(run->model, coupling, &run->now, &of);
        if (fabs(run->now.forces[coupling->force]) < of.limit) { /* another change holds it */
            fu_restart_event_functions(run, coupling->number);
            return FU_RUNNING;
        }
        release(run, coupling);
    } else {
        *mode = FU_STICKS;
        stick_at_rest(run);
        if (!run->integrator->keeps_energy && stop(run)) return FU_SINGULAR;
    }
    *what = "";
    return settle(run);
}

/* Determines all points of a scene: those that do not slide stick, where friction can hold them; is_new: those that
 * stick now do so, too. Returns a status. */
static int determine(fu_run *run, int is_new)
{
    const fu_model *model = run->model;
    FU_EACH_COUPLING(c, model->couplings, model->n_couplings) {
        if (c->type != &fu_wrap_point_type) continue;
        int *mode = fu_wrap_point_flag(c, &run->now);
        fu_coulomb of;
        if (!acts(run, c)) *mode = FU_POINT_IS_FREE;
        else if (is_new || *mode != FU_STICKS) {
            fu_wrap_point_at(model, c, &run->now, &of);
            *mode = of.w > 0.0 ? FU_SLIDES_FORWARDS : FU_SLIDES_BACKWARDS;
        }
    }
    stick_at_rest(run);
    return stop(run) ? FU_SINGULAR : settle(run);
}

/* The first point determines all. */
static int begin(fu_run *run, const fu_coupling *coupling)
{
    return coupling->index ? FU_RUNNING : determine(run, 1);
}

/* --- wraps that change ------------------------------------------------------------------------------------------ */

void fu_change_points(fu_run *run, const fu_coupling *sheave)
{
    int has_new = 0, sticks = 0;
    FU_EACH_COUPLING(c, run->model->couplings, run->model->n_couplings) {
        if (!is_of(run, c, sheave)) continue;
        const int mode = *fu_wrap_point_flag(c, &run->now);
        has_new |= acts(run, c) != (mode != FU_POINT_IS_FREE);
        sticks |= mode == FU_STICKS;
    }
    FU_EACH_COUPLING(c, run->model->couplings, run->model->n_couplings)
        if (has_new && is_of(run, c, sheave))
            *fu_wrap_point_flag(c, &run->now) = sticks && acts(run, c) ? FU_STICKS : FU_POINT_IS_FREE;
}

int fu_settle_points(fu_run *run)
{
    FU_EACH_COUPLING(c, run->model->couplings, run->model->n_couplings)
        if (c->type == &fu_wrap_point_type) return determine(run, 0);
    return FU_RUNNING;
}

const fu_coupling_events fu_wrap_point_events = {
    .direction = 1, .value = value, .act = act, .keeps_velocities = 1, .begin = begin};
