/* Step sizes: from the last error and the time to the next output. */
#include "bodies/unknowns.h"
#include "equations/run.h"
#include "equations/step_control.h"

#include <math.h>

/* of the largest motion: permitted error of a step in dofs that nobody named, so that they do not disturb the step */
#define UNCONTROLLED_ERROR_SHARE 0.1

#define CEILING_GROWTH 1.05 /* growth of the upper bound of steps with each accepted step after a failure */
/* of the duration: errors in it share one allowance, since hardly anything has moved */
#define FIRST_PERIOD 1e-3
#define ERROR_SAFETY 0.5           /* of tol: local errors add up to tol times a logarithm, which this compensates */
#define STEP_SAFETY 0.8            /* of the step that the error would permit; smaller factors shorten the step */
#define MAX_STEP_GROWTH 2.0        /* growth of a step over the one before */
#define MIN_STEP_FACTOR 0.2        /* of a step that was rejected for its error: least next step */
#define MIN_ERROR_RATIO 1e-12      /* of an error to the permitted one, to avoid overflow of its power */
#define MIN_GROWTH 1.4             /* growth below which a step keeps its size, and its factored matrix */
#define RETRY_FACTOR 0.5           /* of a failed step: the next one */
#define ROUNDING_OF_STEPS 1e-9     /* of a number of steps: its rounding */
#define REMAINDER_SHARE 0.1        /* of the last step's error: it is permitted to short steps */
#define ROUND_OFF 4e-16            /* of a coordinate or a lever: two units in its last place */
#define NEWTON_SHARE 0.1           /* of the permitted error, times the step over the duration: Newton's tolerance */
#define MAX_NEWTON_TOLERANCE 1e-10 /* of the extent: largest Newton tolerance */
/* of the last step's error, times the step over the duration: Newton's tolerance of a fixed step */
#define FIXED_NEWTON_SHARE 1e-2
#define MAX_FIXED_NEWTON_TOLERANCE 1e-14 /* of the extent: largest Newton tolerance of a fixed step */
/* of the permitted error: Newton's tolerance if later steps compensate the residual */
#define CARRIED_NEWTON_SHARE 1e-3
#define MAX_CARRIED_NEWTON_TOLERANCE 1e-7        /* of the extent: the largest one then */
#define CARRIED_FIXED_NEWTON_SHARE 3e-3          /* of the last step's error: Newton's tolerance of a fixed step then */
#define MAX_CARRIED_FIXED_NEWTON_TOLERANCE 1e-10 /* of the extent: the largest one of a fixed step then */

/* Returns the step that ends at the target, or one of equal steps to there, none larger than intended, s. */
double fu_fit_step(double remaining, double want)
{
    const double pieces = ceil(remaining / want * (1.0 - ROUNDING_OF_STEPS));
    return pieces <= 1.0 ? remaining : remaining / pieces;
}

/* Returns Newton's tolerance of a step, m. Its residual has the same sign step after step and acts like a force: it
 * counts (T/h)^2 times in positions, the local error T/h times; a fixed step is solved as well as possible, whatever
 * its error. If later steps compensate the residual, it counts once. Even so it must stay small: with a matrix of some
 * steps before, it follows the vibrations and can excite them, until they make it larger than this. */
static double newton_tolerance(const fu_run *run, double h, double allowed, double extent)
{
    const int fixed = run->fixed_step > 0.0;
    const double share = h / run->duration;
    if (fu_compensates_residual(run))
        return fixed ? fmin(CARRIED_FIXED_NEWTON_SHARE * run->last_error, MAX_CARRIED_FIXED_NEWTON_TOLERANCE * extent)
                     : fmin(CARRIED_NEWTON_SHARE * allowed, MAX_CARRIED_NEWTON_TOLERANCE * extent);
    return fixed ? fmin(FIXED_NEWTON_SHARE * share * run->last_error, MAX_FIXED_NEWTON_TOLERANCE * extent)
                 : fmin(NEWTON_SHARE * share * allowed, MAX_NEWTON_TOLERANCE * extent);
}

/* Returns the error permitted over the whole run, m, by the motion so far. */
double fu_allowed_error(const fu_run *run)
{
    return run->tol * fmax(run->controlled_motion, run->least_motion) + run->absolute_tol;
}

/* Returns the size of a step's error of the dofs, m: of the dofs in the error of tol and those that act on them, and of
 * the unnamed relative to their permitted error (unnamed, m), so that both are compared to run->allowed. */
double fu_error_size(const fu_run *run, const double *error, double unnamed)
{
    const fu_model *model = run->model;
    if (run->controlled == model->weight) return fu_size(model, error);
    return fmax(fu_weighted_size(model, run->counted, error), fu_size(model, error) * run->allowed / unnamed);
}

/* Returns the permitted error of a step in dofs that are not named, m. */
double fu_allowed_elsewhere(const fu_run *run)
{
    return UNCONTROLLED_ERROR_SHARE * fmax(run->motion, run->least_motion);
}

/* Sets the tolerances of a step: of its error, of Newton, and of rounding. Returns the first, m. */
double fu_allow(fu_run *run, double h)
{
    run->round_off = ROUND_OFF * fu_largest_length(run);
    const double scale = fmax(run->motion, run->least_motion);
    /* Of the error permitted until t, relative to the motion until then and at least to a part of the prescribed motion
     * (run/start.c), a step gets the part h/t: local errors then add up to at most tol times the logarithm of the
     * times. With h/duration the first instants, with hardly any motion, would take most of the steps. For named
     * quantities that holds only without rotations: these reach their size within a moment, and the error of a
     * vibration then grows until the end. */
    const int turns = run->controlled != run->model->weight && run->model->n_bodies;
    const double share =
        ERROR_SAFETY * h / (turns ? run->duration : fmax(run->now.t + h, FIRST_PERIOD * run->duration));
    const double allowed = fmax(fu_allowed_error(run) * fmin(1.0, run->error_overestimate * share), run->round_off);
    run->newton_tolerance = newton_tolerance(run, h, allowed, fmax(run->extent, scale));
    return run->allowed = fmax(allowed, REMAINDER_SHARE * run->last_error);
}

/* Sets the next step by the last error relative to the permitted one: the error falls with the power order + 1 of the
 * step, the permitted one with the first. Small changes do not justify a new factorisation. After a failed step the
 * next ones stay below it for a while. */
void fu_adapt_step(fu_run *run, double h, double ratio)
{
    const double factor = fmin(MAX_STEP_GROWTH, STEP_SAFETY * pow(fmax(ratio, MIN_ERROR_RATIO), -1.0 / run->order));
    run->ceiling = fmin(CEILING_GROWTH * run->ceiling, run->duration);
    const double larger = fmin(h * factor, run->ceiling);
    if (larger > MIN_GROWTH * h) run->h = fmax(run->h, larger);
    else if (factor < STEP_SAFETY) run->h = h * factor;
}

/* Returns the step after one whose error was too large, s. */
double fu_shrink_step(fu_run *run, double h, double ratio)
{
    double want = h * fmax(MIN_STEP_FACTOR, STEP_SAFETY * pow(ratio, -1.0 / run->order));
    if (!(want > 0.0)) want = MIN_STEP_FACTOR * h; /* an error that is not finite */
    fu_fail(run, FU_ERROR, run->work, -1);
    ++run->statistics.rejected;
    ++run->net_rejections;
    return run->h = want;
}

/* Returns the step after a failed one, s. */
double fu_retry_step(fu_run *run, double h)
{
    const double want = RETRY_FACTOR * h;
    if (run->fixed_step <= 0.0 && run->retry_factor > 0.0) {
        run->h = want;
        run->ceiling = run->retry_factor * h;
    }
    ++run->statistics.rejected;
    ++run->net_rejections;
    return want;
}
