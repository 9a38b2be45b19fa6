/* Newton's method of an implicit step: residual and matrix belong to the integrator, the iteration is here. */
#include "base/clock.h"
#include "bodies/unknowns.h"
#include "equations/equations.h"
#include "equations/run.h"
#include "equations/step_control.h"

#include <math.h>

/* increments of the size of rounding whose ratio exceeds this are rounding */
#define STAGNATION_RATIO 0.3
/* assumed before the second increment: too large to stop after one iteration */
#define FIRST_CONTRACTION 0.5
#define MAX_CONTRACTION 0.9 /* largest contraction for the estimate of the remaining error */
/* least contraction for it: first iterations reduce linear errors, later ones are slower */
#define MIN_CONTRACTION 0.03
#define ROUNDING_FACTOR 100.0 /* times the rounding of positions: an increment that is not rounding */
/* of a matrix, in iterations: below its true cost, since an old one costs accuracy, too; and, of a net of bodies, whose
 * factorisation costs as much as tens of solves, a part of these: an iteration has a residual beside its solve */
#define MATRIX_COST 2.0
#define MATRIX_COST_SHARE 0.1
/* largest ratio of the contraction of the residual, which weights stiffness more, to that of increments */
#define RESIDUAL_UNDERESTIMATE 10.0
/* a step with more than a fourth of the permitted iterations requests a new matrix for the next; of a costly one with
 * more than half of them */
#define SLOW_ITERATION_FRACTION 4
#define SLOW_COSTLY_FRACTION 2

/* Returns the cost of a matrix in iterations. */
static double cost_of_matrix(const fu_run *run)
{
    return fmax(MATRIX_COST, MATRIX_COST_SHARE * run->newton.fronts->solves);
}

static int factor(fu_run *run, const fu_newton *method, double h)
{
    const double begin = fu_clock();
    method->matrix(run, h);
    const int info = fu_system_factor(&run->newton, run->model->lapack);
    if (info) fu_fail_at(run, FU_MATRIX, info - 1);
    run->factored = !info;
    run->h_factored = h;
    run->contraction = FIRST_CONTRACTION;
    run->matrix_cost = cost_of_matrix(run);
    run->matrix_steps = 0;
    ++run->statistics.factorisations;
    run->statistics.time_factor += fu_clock() - begin;
    return info;
}

/* Returns the largest of the unknowns in run->rhs, as a length; run->work keeps the dofs' part. */
double fu_spread_size(fu_run *run)
{
    const fu_model *model = run->model;
    const double *extra = run->rhs + model->n_band + model->n_border_dof;
    fu_spread(model, run->rhs, run->work);
    double largest = fu_size(model, run->work);
    for (int i = 0; i < model->n_extra; ++i)
        if (!(fabs(extra[i]) <= largest)) largest = fabs(extra[i]);
    return largest;
}

/* Predicts time, and the couplings' part of `next`, for integrators without a prediction of their own. */
void fu_predict_internal(fu_run *run, double h)
{
    const fu_model *model = run->model;
    run->next.t = run->now.t + h;
    fu_state_take_couplings(model, &run->next, &run->now);
    for (int i = 0; i < model->n_coordinates; ++i) run->next.s[i] = run->now.s[i] + h * run->s_slope[i];
}

/* Records the failure of the iteration at the largest component of its last correction, in run->rhs and run->work;
 * returns 1. */
static int blame(fu_run *run)
{
    const fu_model *model = run->model;
    const double *internal = fu_internal_unknowns(run);
    double largest = fu_size(model, run->work);
    int coupling = -1;
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active) {
        for (int i = 0; c->n_coordinates && i < c->n_coordinates + c->n_forces; ++i) {
            const double size = fabs(internal[c->unknown + i]);
            if (!(size > largest)) continue;
            largest = size;
            coupling = c->number;
        }
    }
    return fu_fail(run, FU_ITERATION, run->work, coupling);
}

/* Counts the last step for the matrix, which is renewed if its further use costs more than the average step, the matrix
 * included. */
static void count_for_matrix(fu_run *run, int iterations, int permitted)
{
    const int most = permitted / (cost_of_matrix(run) > MATRIX_COST ? SLOW_COSTLY_FRACTION : SLOW_ITERATION_FRACTION);
    run->matrix_cost += iterations;
    ++run->matrix_steps;
    if ((double)iterations * run->matrix_steps > run->matrix_cost || iterations > most) run->factored = 0;
}

/* Returns the largest gap of a constraint in run->rhs, m. */
static double largest_gap(fu_run *run)
{
    const fu_model *model = run->model;
    const double *internal = fu_internal_unknowns(run);
    double gap = 0.0;
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active)
        for (int i = 0; i < c->n_forces; ++i)
            gap = fmax(gap, fabs(internal[c->unknown + c->n_coordinates + i]) / c->scale[i]);
    return gap;
}

/* Closes the gaps after an iteration with the factored matrix, as if the equations of the dofs were linear. Gaps result
 * from directions that have rotated since the factorisation, and dominate the next iteration. This needs no forces of
 * cables and no substitution in their chains; without chains it would cost as much as an iteration. */
static void close_gaps(fu_run *run, const fu_newton *method, double h)
{
    const fu_model *model = run->model;
    if (!method->internal_residual || !model->n_extra || !model->n_band) return;
    method->internal_residual(run, h);
    if (largest_gap(run) <= run->round_off) return;
    fu_system_solve_border(&run->newton, model->lapack, run->rhs);
    method->apply(run, h);
    method->kinematics(run, h);
}

/* Returns whether an iteration may end after an increment of this size, with its ratio to the last one. Increments that
 * shrink no more are rounding, which long chains of joints amplify beyond that of one position. */
static int leaves_nothing(const fu_run *run, const fu_newton *method, double size, double ratio)
{
    if (size * run->contraction / (1.0 - run->contraction) <= run->newton_tolerance) return 1;
    if (method->to_rounding) return size <= run->round_off && ratio > STAGNATION_RATIO;
    return size <= run->round_off || (ratio >= 1.0 && size <= ROUNDING_FACTOR * run->round_off);
}

/* Solves for a correction by the residual in run->rhs, and applies it; returns nonzero if there is none. */
static int correct(fu_run *run, const fu_newton *method, double h, double *size)
{
    if (!run->factored && factor(run, method, h)) return 1;
    const double begin = fu_clock();
    fu_system_solve(&run->newton, run->model->lapack, run->rhs);
    run->statistics.time_solve += fu_clock() - begin;
    *size = method->apply(run, h);
    ++run->statistics.newton_iterations;
    return *size < FU_RUNS_AWAY ? 0 : blame(run);
}

/* Iterates from the prediction with the current matrix; returns 0 on convergence. */
static int iterate(fu_run *run, const fu_newton *method, double h)
{
    double last = 0.0, ratio = 0.0;
    method->kinematics(run, h);
    for (int i = 0; i < method->most_iterations; ++i) {
        double size;
        method->residual(run, h);
        if (correct(run, method, h, &size)) return 1;
        if (i > 0) {
            ratio = size / last;
            if (ratio >= 1.0 && size > ROUNDING_FACTOR * run->round_off) return blame(run);
            run->contraction = ratio < MIN_CONTRACTION   ? MIN_CONTRACTION
                               : ratio > MAX_CONTRACTION ? MAX_CONTRACTION
                                                         : ratio;
        }
        if (leaves_nothing(run, method, size, ratio)) {
            method->kinematics(run, h);
            if (method->note_rest) count_for_matrix(run, i + 1, method->most_iterations);
            else if (SLOW_ITERATION_FRACTION * (i + 1) > method->most_iterations)
                run->factored = 0; /* renewed for the next step */
            return 0;
        }
        last = size;
        method->kinematics(run, h);
        close_gaps(run, method, h);
    }
    if (last > ROUNDING_FACTOR * run->round_off) return blame(run);
    run->factored = 0; /* rounding, which long chains of joints amplify beyond that of one position */
    return 0;
}

/* Largest residuals in run->rhs: root of the sum of squares over the equations of motion; of the couplings' internal
 * equations; and gaps of constraints, m. */
typedef struct {
    double motion, internal, gap;
} residual_size;

static residual_size size_of_residual(fu_run *run)
{
    const fu_model *model = run->model;
    const double *internal = fu_internal_unknowns(run);
    residual_size size = {0.0, 0.0, 0.0};
    for (int i = 0; i < model->n_band + model->n_border_dof; ++i) size.motion += run->rhs[i] * run->rhs[i];
    size.motion = sqrt(size.motion);
    for (int i = 0; i < model->n_extra; ++i) size.internal = fmax(size.internal, fabs(internal[i]));
    size.gap = largest_gap(run);
    return size;
}

/* Returns an upper bound of the next increment relative to the last, from the contraction of the residual. */
static double contraction_of_residual(residual_size before, residual_size after)
{
    const double motion = before.motion > 0.0 ? after.motion / before.motion : 0.0;
    const double internal = before.internal > 0.0 ? after.internal / before.internal : 0.0;
    return fmin(1.0, RESIDUAL_UNDERESTIMATE * fmax(motion, internal));
}

/* Returns whether an iteration may end after an increment of this size, at this contraction and these gaps. */
static int leaves_little(const fu_run *run, double size, double contraction, double gap)
{
    const double enough = fmax(run->newton_tolerance, run->round_off);
    return size <= run->round_off || (size * contraction <= enough && gap <= enough);
}

/* Iterates likewise if later steps compensate the remaining residual, which is evaluated and bounds the error. */
static int iterate_compensated(fu_run *run, const fu_newton *method, double h)
{
    double last = INFINITY;
    method->kinematics(run, h);
    method->residual(run, h);
    residual_size before = size_of_residual(run);
    for (int i = 0; i < method->most_iterations; ++i) {
        double size;
        if (correct(run, method, h, &size)) return 1;
        const double ratio = fmin(fmax(size / last, MIN_CONTRACTION), MAX_CONTRACTION);
        if (size >= last && size > ROUNDING_FACTOR * run->round_off) return blame(run);
        method->kinematics(run, h);
        method->residual(run, h);
        const residual_size after = size_of_residual(run);
        double contraction = contraction_of_residual(before, after);
        if (i > 0) contraction = fmin(contraction, ratio / (1.0 - ratio));
        if (leaves_little(run, size, contraction, after.gap)) {
            method->note_rest(run, h);
            count_for_matrix(run, i + 1, method->most_iterations);
            run->residual_at = run->next.t;
            return 0;
        }
        last = size;
        before = after;
    }
    if (last > ROUNDING_FACTOR * run->round_off) return blame(run);
    method->note_rest(run, h); /* rounding, which long chains of joints amplify beyond that of one position */
    run->factored = 0;
    return 0;
}

/* Computes one step of size h from `now` to `next`; returns 0 if the Newton iteration converged. */
int fu_newton_step(fu_run *run, const fu_newton *method, double h)
{
    if (fabs(h - run->h_factored) > FU_SAME_STEP * h) run->factored = 0;
    const int stale = run->factored;
    int (*const solve)(fu_run *, const fu_newton *, double) =
        fu_compensates_residual(run) ? iterate_compensated : iterate;
    run->residual_at = NAN;
    method->predict(run, h);
    if (!solve(run, method, h)) return 0;
    if (stale) { /* the matrix belonged to an earlier step: renew it before giving up */
        run->factored = 0;
        method->predict(run, h);
        if (!solve(run, method, h)) return 0;
    }
    run->factored = 0;
    ++run->statistics.newton_failures;
    return 1;
}

/* Returns the size of an error of positions in run->work, filtered by (M + sigma K)^-1 M on the constraints' tangent
 * space, so that unresolved vibrations count by their amplitude and not by their acceleration. */
double fu_filtered_size(fu_run *run)
{
    const fu_model *model = run->model;
    fu_mass_times(model, run->next.t, run->next.q, run->work, run->before);
    fu_gather(model, run->before, run->rhs);
    for (int i = 0; i < model->n_extra; ++i) run->rhs[model->n_band + model->n_border_dof + i] = 0.0;
    const double begin = fu_clock();
    fu_system_solve(&run->newton, model->lapack, run->rhs);
    run->statistics.time_solve += fu_clock() - begin;
    fu_spread(model, run->rhs, run->work);
    return fu_error_size(run, run->work, fu_allowed_elsewhere(run));
}

/* Computes, for tests of the matrix, minus the residual after a displacement of the predicted step by `change`
 * (unknowns), in run->rhs, and the unfactored matrix there in run->newton. */
void fu_linearise(fu_run *run, double h, const double *change)
{
    const fu_newton *method = run->integrator->newton;
    method->predict(run, h);
    for (int i = 0; i < run->newton.n + run->newton.m; ++i) run->rhs[i] = change[i];
    method->apply(run, h);
    method->kinematics(run, h);
    method->matrix(run, h);
    method->residual(run, h);
    run->factored = 0;
}
