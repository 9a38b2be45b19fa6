/* Sizes of steps: from the error of the last one, from what is left to the next instant of output. */
#include "bodies/unknowns.h"
#include "equations/run.h"
#include "equations/step_control.h"

#include <math.h>

/* of the largest motion: what a step may err by in what nobody named, lest it upset the step */
#define UNCONTROLLED 0.1

#define RECOVERY 1.05 /* growth, with each step that is taken, of what steps stay below after a failure */
/* of the duration: errors in it share one allowance, as in it hardly anything has moved */
#define FIRST_PART 1e-3
#define SAFETY 0.5             /* of tol: local errors add up to tol times a logarithm, which this pays for */
#define CAUTIOUS 0.8           /* of the step that the error would allow; smaller factors shorten the step */
#define LARGEST_FACTOR 2.0     /* growth of a step over the one before */
#define LEAST_FACTOR 0.2       /* of a step that was rejected for its error: what the next is at least */
#define LEAST_RATIO 1e-12      /* of an error to what is allowed, lest a power of it overflow */
#define MIN_GROWTH 1.4         /* growth below which a step keeps its size, and its factored matrix */
#define AFTER_FAILURE 0.5      /* of a step that could not be made: what the next is */
#define ROUNDING_OF_STEPS 1e-9 /* of a number of steps: what rounding may add to it */
#define ROUND_OFF 4e-16        /* of a coordinate or a lever: two units in its last place */
#define NEWTON_PART 0.1        /* of what is allowed, times the step over the duration: what Newton may leave */
#define NEWTON_MOST 1e-10      /* of the extent: what Newton may leave at most */
/* of the last step's error, times the step over the duration: what Newton may leave of a fixed step */
#define FIXED_PART 1e-2
#define FIXED_MOST 1e-14 /* of the extent: what Newton may leave of a fixed step at most */
/* of what is allowed: what Newton may leave where the steps to come make up for it */
#define CARRIED_PART 1e-3
#define CARRIED_MOST 1e-9        /* of the extent: what Newton may leave there at most */
#define CARRIED_FIXED_PART 3e-3  /* of the last step's error: what Newton may leave there of a fixed step */
#define CARRIED_FIXED_MOST 1e-10 /* of the extent: what Newton may leave there of a fixed step at most */

/* Returns the step that ends at the target, or one of equal steps to there, none larger than wanted, s. */
double fu_fit_step(double remaining, double want)
{
    const double pieces = ceil(remaining / want * (1.0 - ROUNDING_OF_STEPS));
    return pieces <= 1.0 ? remaining : remaining / pieces;
}

/* Returns what Newton may leave of a step, m. What it leaves has the same sign step after step and acts like a force:
 * it counts (T/h)^2 times in positions, the local error T/h times; a fixed step is solved as well as it can be,
 * whatever its error. Where the steps to come make up for it, it counts once. Even so it must stay small: with a matrix
 * of some steps before, what is left goes with the vibrations and can feed them, up to where they make it larger than
 * this. */
static double newton_tolerance(const fu_run *run, double h, double allowed, double extent)
{
    const int fixed = run->fixed_step > 0.0;
    const double share = h / run->duration;
    if (fu_carries_rest(run))
        return fixed ? fmin(CARRIED_FIXED_PART * run->last_error, CARRIED_FIXED_MOST * extent)
                     : fmin(CARRIED_PART * allowed, CARRIED_MOST * extent);
    return fixed ? fmin(FIXED_PART * share * run->last_error, FIXED_MOST * extent)
                 : fmin(NEWTON_PART * share * allowed, NEWTON_MOST * extent);
}

/* Returns the error that is allowed over the whole run, m, of what has moved so far. */
double fu_allowed_error(const fu_run *run)
{
    return run->tol * fmax(run->controlled_motion, run->least_motion) + run->absolute_tol;
}

/* Returns the size of a step's error of the dofs, m: of what tol is the error of and what acts on it, and of the rest
 * over what that may err by (others, m), so that both are compared to run->allowed. */
double fu_error_size(const fu_run *run, const double *error, double others)
{
    const fu_model *model = run->model;
    if (run->controlled == model->weight) return fu_size(model, error);
    return fmax(fu_weighted_size(model, run->counted, error), fu_size(model, error) * run->allowed / others);
}

/* Returns what a step may err by in what is not named, m. */
double fu_allowed_elsewhere(const fu_run *run)
{
    return UNCONTROLLED * fmax(run->motion, run->least_motion);
}

/* Sets the tolerances of a step: of its error, of Newton, and where rounding begins. Returns the first, m. */
double fu_allow(fu_run *run, double h)
{
    run->round_off = ROUND_OFF * fu_largest_length(run);
    const double scale = fmax(run->motion, run->least_motion);
    /* Of what is allowed until t, relative to the motion until then, a step gets the part h/t: local errors then add up
     * to tol times the logarithm of the times at most. With h/duration the first instants, in which hardly anything has
     * moved yet, would take most of the steps. Of named quantities that is so only where nothing turns: turns are as
     * large as they become within a moment, and what a step then loses of a vibration goes on growing until the end. */
    const int turns = run->controlled != run->model->weight && run->model->n_bodies;
    const double share = SAFETY * h / (turns ? run->duration : fmax(run->now.t + h, FIRST_PART * run->duration));
    const double allowed = fmax(fu_allowed_error(run) * fmin(1.0, run->error_overestimate * share), run->round_off);
    run->newton_tolerance = newton_tolerance(run, h, allowed, fmax(run->extent, scale));
    return run->allowed = allowed;
}

/* Sets the next step by the last one's error over what is allowed: the error falls with the power order + 1 of the
 * step, what is allowed with the first. Small changes are not worth a new factorisation. After a step that failed the
 * next ones stay below it for a while. */
void fu_adapt_step(fu_run *run, double h, double ratio)
{
    const double factor = fmin(LARGEST_FACTOR, CAUTIOUS * pow(fmax(ratio, LEAST_RATIO), -1.0 / run->order));
    run->ceiling = fmin(RECOVERY * run->ceiling, run->duration);
    const double larger = fmin(h * factor, run->ceiling);
    if (larger > MIN_GROWTH * h) run->h = fmax(run->h, larger);
    else if (factor < CAUTIOUS) run->h = h * factor;
}

/* Returns the step after one whose error was too large, s. */
double fu_shrink_step(fu_run *run, double h, double ratio)
{
    double want = h * fmax(LEAST_FACTOR, CAUTIOUS * pow(ratio, -1.0 / run->order));
    if (!(want > 0.0)) want = LEAST_FACTOR * h; /* an error that is not a number */
    fu_fail(run, FU_ERROR, run->work, -1);
    ++run->statistics.rejected;
    ++run->net_rejections;
    return run->h = want;
}

/* Returns the step after one that could not be made, s. */
double fu_retry_step(fu_run *run, double h)
{
    const double want = AFTER_FAILURE * h;
    if (run->fixed_step <= 0.0 && run->retry_factor > 0.0) {
        run->h = want;
        run->ceiling = run->retry_factor * h;
    }
    ++run->statistics.rejected;
    ++run->net_rejections;
    return want;
}
