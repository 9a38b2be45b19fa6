/* Motion about the configuration at the start by the linear model (linear_model.h), in time by the generalised-alpha
 * scheme of genalpha.c over the coordinates y, with one factorisation for each size of step. The forces of all that is
 * not linear (springs that go slack, contacts that wander, bodies, loads) are those of the positions reached:
 *     r(y) = L y + Z' F(y),   change = -(L + E)^-1 r,
 * with the operator L of cables and joints, exact, and E, the derivative of Z' F at the start. Iterations continue
 * with r = Z' (F(y + change) - F(y)) - E change, which is small unless F has changed since the start, and take no
 * product with L. F includes the forces of constraints that move along cables, whose multipliers each iteration changes
 * so that its solution closes their gaps. */
#include "base/clock.h"
#include "base/simd.h"
#include "base/workspace.h"
#include "couplings/common/couplings.h"
#include "equations/equations.h"
#include "equations/step_control.h"
#include "integrators/generalised_alpha.h"
#include "integrators/linear_constraints.h"

#include <math.h>
#include <string.h>

#define MOST_ITERATIONS 20
#define RESIDUAL_UNDERESTIMATE 10.0 /* largest ratio of the contraction of changes to that of the residual */
#define MAX_CONTRACTION 0.9         /* largest contraction for the estimate of the remaining error */
#define LEFT_SHARE 0.5              /* of the permitted error of a step: its change by an iteration that is left out */
#define ROUNDING_FACTOR 100.0       /* times the rounding of positions: a change that is not rounding */
#define STEPS_PER_ESTIMATE 8        /* of a fixed size: an estimate of the error costs as much as a solution */
#define ROWS_PER_ESTIMATE 8         /* an estimate of the model's error costs as much as several steps */
#define SHORT_STEP_SHARE 0.1        /* of the usual step: a shorter one keeps its initial a, as in genalpha.c */

static long n_scratch(const fu_run *run)
{
    fu_linear_space unused;
    return fu_linear_lay_out(run, NULL, &unused);
}

/* Computes w->linear, the residual of cables and joints at `next`. */
static void linear_residual(fu_run *run, const fu_linear_space *w)
{
    fu_linear_model_cable_forces(run, &w->motion, w->force, NULL);
    fu_linear_model_project(run->linear, w->force, w->linear);
    fu_sparse_add_times(&run->linear->joints, 1.0, w->next.y, w->linear);
}

/* Weights of the matrices of a step; the change of the coordinates for a residual, and that of a for the former;
 * whether constraints that move are closed: in a very short step rounding over h^2 would dominate their forces. */
typedef struct {
    double of[FU_MATRICES], psi, a;
    int closes;
} step_weights;

static step_weights weights_of(const fu_run *run, double h)
{
    const fu_alpha_scheme *g = fu_alpha_scheme_of(run);
    const double sigma = fu_alpha_sigma(g, h), rate = g->gamma / (g->beta * h);
    return (step_weights){
        {1.0, sigma * rate, sigma}, sigma, 1.0 / (g->beta * h * h), run->linear->n_moving && !fu_is_short(run, h)};
}

/* x[i] = a y[i] + b z[i] + c w[i] + d v[i] */
FU_INLINE void combine_all(int n, const double *factors, const double *const *of, double *restrict x)
{
    int i = 0;
    for (; i + FU_SIMD_WIDTH <= n; i += FU_SIMD_WIDTH)
        *(fu_simd_block *)(x + i) =
            *(const fu_simd_block *)(of[0] + i) * factors[0] + *(const fu_simd_block *)(of[1] + i) * factors[1] +
            (*(const fu_simd_block *)(of[2] + i) * factors[2] + *(const fu_simd_block *)(of[3] + i) * factors[3]);
    for (; i < n; ++i)
        x[i] = of[0][i] * factors[0] + of[1][i] * factors[1] + (of[2][i] * factors[2] + of[3][i] * factors[3]);
}

FU_SIMD_FUNCTION(combine, combine_all, (int n, const double *factors, const double *const *of, double *restrict x),
                 (n, factors, of, x))

/* Computes the coordinates at the end of a step from their a. */
static void take_step(const fu_run *run, const fu_linear_space *w, double h)
{
    const fu_alpha_scheme *g = fu_alpha_scheme_of(run);
    const fu_linear_coordinates *now = &w->now, *next = &w->next;
    const double over = 1.0 / (1.0 - g->alpha_f);
    const double of_y[] = {1.0, h, h * h * (0.5 - g->beta), h * h * g->beta};
    const double of_rate[] = {1.0, 0.0, h * (1.0 - g->gamma), h * g->gamma};
    const double of_second[] = {-over * g->alpha_f, 0.0, over * g->alpha_m, over * (1.0 - g->alpha_m)};
    combine(run->linear->n, of_y, (const double *[]){now->y, now->rate, now->a, next->a}, next->y);
    combine(run->linear->n, of_rate, (const double *[]){now->rate, now->y, now->a, next->a}, next->rate);
    combine(run->linear->n, of_second, (const double *[]){now->second, now->y, now->a, next->a}, next->second);
}

/* Returns the size of a change of the coordinates, m. */
static double size_of(const fu_run *run, const double *change)
{
    double largest = 0.0;
    for (int i = 0; i < run->linear->n; ++i) {
        const double size = run->linear->weight[i] * fabs(change[i]);
        if (!(size <= largest)) largest = size;
    }
    return largest;
}

/* Computes the residual of `next` in w->left, with its forces; returns the root of the sum of squares. */
static double residual(const fu_run *run, const fu_linear_space *w)
{
    fu_linear_exact_forces(run, w);
    fu_linear_model_project(run->linear, w->force, w->left);
    fu_add_times(NULL, run->linear->n, 1.0, w->linear, w->left);
    return sqrt(fu_dot(run->linear->n, w->left, w->left));
}

/* Computes the change of the coordinates by the residual in w->left, and w->linear after it; returns its size, m. */
static double solve(fu_run *run, const fu_linear_space *w, const step_weights *weights, const double *L)
{
    const fu_linear_model *linear = run->linear;
    const double begin = fu_clock();
    if (weights->closes) {
        fu_linear_gaps(run, w, FU_OF_POSITIONS, 1, NULL);
        fu_linear_change_multipliers(run, w);
    }
    fu_add_times(NULL, linear->n, -1.0, w->left, w->linear);
    fu_set_times(NULL, linear->n, -weights->psi, w->left, w->change);
    fu_linear_model_solve(linear, L, 0, w->change);
    for (int k = 0; k < FU_MATRICES; ++k)
        fu_sparse_add_times(&linear->exact[k], -weights->of[k] / weights->psi, w->change, w->linear);
    ++run->statistics.newton_iterations;
    run->statistics.time_solve += fu_clock() - begin;
    return size_of(run, w->change);
}

/* Returns the factor of a step, rounded, so that steps which differ by rounding share it: it does not depend on other
 * steps; null unless its matrix is positive definite. */
static const double *factor_of(fu_run *run, double h)
{
    int is_known;
    const double rounded = (float)h;
    const step_weights weights = weights_of(run, rounded);
    fu_step_factor *of = fu_step_factor_of(run->linear, rounded, &is_known);
    if (is_known) return of->L;
    const double begin = fu_clock();
    of->h = 0.0;
    ++run->statistics.factorisations;
    if (fu_linear_model_factor(run->linear, weights.of, of->L)) {
        fu_fail(run, FU_MATRIX, run->next.v, -1);
        return NULL;
    }
    of->h = rounded;
    run->statistics.time_factor += fu_clock() - begin;
    return of->L;
}

/* Returns the size of changes at which iterations end, m: later steps compensate the residual that is left. */
static double enough(const fu_run *run)
{
    return fmax(run->round_off, LEFT_SHARE * (run->fixed_step > 0.0 ? run->last_error : run->allowed));
}

/* Records a failed iteration; returns 1. */
static int fail(fu_run *run, const fu_linear_space *w)
{
    ++run->statistics.newton_failures;
    fu_linear_model_expand(run->linear, run->model->n_dof, w->change, run->work);
    return fu_fail(run, FU_ITERATION, run->work, -1);
}

/* Computes `next` at the predicted end of a step, and its residual, with the impulse of what the last step has left,
 * and its size; returns nonzero where that fails. */
static int begin_step(fu_run *run, const fu_linear_space *w, const step_weights *weights, const double *L, double h,
                      double *size)
{
    take_step(run, w, h);
    if (fu_linear_kinematics(run, w)) return 1;
    if (weights->closes && fu_linear_condense(run, w, weights->psi, L)) return fu_fail(run, FU_MATRIX, run->next.v, -1);
    linear_residual(run, w);
    fu_add_times(NULL, run->linear->n, *w->h_now / h, w->left_now, w->linear);
    *size = residual(run, w);
    return 0;
}

/* Returns whether the constraints that move are closed after a change of this size, which has grown if it is rounding.
 * A gap after a fixed step would cause a force in the next one whose vibrations decay slowly. */
static int is_closed(const fu_run *run, const step_weights *weights, double size, double last)
{
    const double tolerance = run->fixed_step > 0.0 ? run->round_off : enough(run);
    return !weights->closes || size >= last || fu_linear_gap(run) <= tolerance;
}

/* Iterates to the end of a step; returns 0 on convergence. The residual that remains is compensated by the next step.
 */
static int iterate(fu_run *run, const fu_linear_space *w, double h)
{
    const step_weights weights = weights_of(run, h);
    const double *L = factor_of(run, h), tolerance = enough(run);
    if (!L) return 1;
    double begin = fu_clock(), last = INFINITY, before = INFINITY;
    if (begin_step(run, w, &weights, L, h, &before)) return 1;
    run->statistics.time_residual += fu_clock() - begin;
    for (int i = 0; i < MOST_ITERATIONS; ++i) {
        const double size = solve(run, w, &weights, L);
        if (!(size < FU_RUNS_AWAY) || (size >= last && size > ROUNDING_FACTOR * run->round_off)) break;
        fu_add_times(NULL, run->linear->n, weights.a, w->change, w->next.a);
        begin = fu_clock();
        take_step(run, w, h);
        if (fu_linear_kinematics(run, w)) return 1;
        const double after = residual(run, w), ratio = fmin(size / last, MAX_CONTRACTION);
        double contraction = fmin(1.0, RESIDUAL_UNDERESTIMATE * after / before);
        if (i) contraction = fmin(contraction, ratio / (1.0 - ratio));
        run->statistics.time_residual += fu_clock() - begin;
        *w->h_left = h;
        if (size <= run->round_off || (!(size * contraction > tolerance) && is_closed(run, &weights, size, last)))
            return 0;
        last = size;
        before = after;
    }
    return fail(run, w);
}

/* Copies the multipliers of constraints that move. */
static void take_multipliers(const fu_run *run, const double *from, double *to)
{
    if (run->linear->n_moving) memcpy(to, from, sizeof(double) * (size_t)run->model->n_multipliers);
}

static int step(fu_run *run, double h)
{
    const fu_linear_space w = fu_linear_space_of(run);
    fu_predict_internal(run, h);
    take_multipliers(run, w.moving.lambda_now, w.moving.lambda);
    memcpy(w.next.a, w.now.a, sizeof(double) * (size_t)run->linear->n);
    return iterate(run, &w, h);
}

/* Returns the local error of positions, m, as genalpha.c does; in steps of a fixed size now and then. */
static double error(fu_run *run, double h)
{
    if (run->fixed_step > 0.0 && run->statistics.steps % STEPS_PER_ESTIMATE) return run->last_error;
    const fu_linear_space w = fu_linear_space_of(run);
    const double factor = h * h * fu_alpha_error_factor(run);
    for (int i = 0; i < run->model->n_dof; ++i)
        run->work[i] = factor * (run->next.acceleration[i] - run->now.acceleration[i]);
    fu_mass_times(run->model, run->next.t, run->next.q, run->work, run->before);
    fu_linear_model_project(run->linear, run->before, w.change);
    fu_linear_model_solve(run->linear, factor_of(run, h), 0, w.change);
    if (weights_of(run, h).closes) fu_linear_keep_constraints(run, &w);
    fu_linear_model_expand(run->linear, run->model->n_dof, w.change, run->work);
    return fu_error_size(run, run->work, fu_allowed_elsewhere(run));
}

static double dissipated_power(fu_run *run, const fu_linear_space *w, const fu_state *state)
{
    return fu_linear_model_dissipation(run, w->motion.velocity) +
           fu_coupling_dissipation(run->model, state, &run->accelerator);
}

/* Computes the powers of `next`, by its exact forces in w->force. */
static void find_powers(fu_run *run, const fu_linear_space *w, double *dissipated, double *external)
{
    fu_linear_multipliers(run, w);
    if (fu_supports_move(run->model, &run->next)) fu_linear_reactions(run, w, run->force, NULL);
    *external = fu_external_power(run, &run->next, run->force);
    *dissipated = dissipated_power(run, w, &run->next);
}

static void account(fu_run *run, double h)
{
    const fu_linear_space w = fu_linear_space_of(run);
    const size_t size = sizeof(double) * (size_t)run->linear->n;
    double dissipated, external;
    if (run->is_remainder && h < SHORT_STEP_SHARE * run->usual) memcpy(w.next.a, w.now.a, size);
    memcpy(w.now.y, w.next.y, 4 * size); /* its rates and a are behind it */
    memcpy(w.left_now, w.left, size);
    *w.h_now = *w.h_left;
    take_multipliers(run, w.moving.lambda, w.moving.lambda_now);
    find_powers(run, &w, &dissipated, &external);
    run->dissipated += 0.5 * h * (run->dissipated_power + dissipated);
    run->external += 0.5 * h * (run->external_power + external);
    run->dissipated_power = dissipated;
    run->external_power = external;
}

/* Notes the error of the linear model at `now`: the displacement by the forces of cables that it leaves out, held by
 * the stiffness; run->before: the forces of cables without those of inertia. */
static void note_error(fu_run *run, const fu_linear_space *w)
{
    const fu_model *model = run->model;
    fu_linear_model *linear = run->linear;
    fu_set_times(NULL, model->n_dof, -1.0, run->before, run->before);
    fu_internal_forces(model, run->now.q, run->now.v, run->before);
    for (int i = fu_rope_dofs(model).first; i < model->n_dof; ++i) run->before[i] = 0.0; /* bodies are exact */
    fu_linear_model_project(linear, run->before, w->change);
    fu_linear_model_solve(linear, linear->at_rest.L, 0, w->change);
    const double size = size_of(run, w->change);
    if (size <= w->error[0]) return;
    w->error[0] = size;
    w->error[1] = run->now.t;
}

/* Corrects the accelerations of `next`, and the multipliers, so that the constraints that move hold in them: those of
 * the scheme hold in positions. Returns nonzero where that fails. */
static int correct_accelerations(fu_run *run, const fu_linear_space *w)
{
    const fu_linear_model *linear = run->linear;
    if (fu_linear_condense(run, w, 1.0, linear->of_mass.L)) return 1;
    memset(w->left, 0, sizeof(double) * (size_t)linear->n);
    fu_linear_gaps(run, w, FU_OF_ACCELERATIONS, 1, run->next.acceleration);
    fu_linear_change_multipliers(run, w);
    fu_set_times(NULL, linear->n, -1.0, w->left, w->change);
    fu_linear_model_solve(linear, linear->of_mass.L, 0, w->change);
    fu_linear_model_expand(linear, run->model->n_dof, w->change, run->work);
    fu_add_times(NULL, run->model->n_dof, 1.0, run->work, run->next.acceleration);
    memcpy(w->motion.acceleration, run->next.acceleration, sizeof(double) * (size_t)run->model->n_dof);
    return 0;
}

static int row(fu_run *run, double *acceleration, double *reaction, double *elastic)
{
    const fu_linear_space w = fu_linear_space_of(run);
    const fu_model *model = run->model;
    const size_t size = sizeof(double) * (size_t)model->n_dof;
    const fu_state next = run->next;
    fu_cable_totals totals = {.without_inertia = run->before};
    run->next = run->now; /* the functions above compute `next` */
    memcpy(acceleration, run->now.acceleration, size);
    run->next.acceleration = acceleration;
    fu_evaluate_rows(model, &run->now, &run->accelerator);
    take_multipliers(run, w.moving.lambda_now, w.moving.lambda);
    const int failed = run->linear->n_moving && correct_accelerations(run, &w);
    fu_linear_exact_forces(run, &w);
    fu_linear_multipliers(run, &w);
    fu_linear_reactions(run, &w, reaction, &totals);
    fu_take_forces(model, &run->accelerator, &run->now);
    *elastic = totals.elastic + fu_coupling_energy(model, &run->now);
    if (run->record.n % ROWS_PER_ESTIMATE == 0 || run->now.t >= run->duration) note_error(run, &w);
    run->next = next;
    return failed;
}

/* Computes the second derivatives of `next`, and the multipliers of constraints that move; returns nonzero where that
 * fails. */
static int accelerate(fu_run *run, const fu_linear_space *w)
{
    const fu_linear_model *linear = run->linear;
    const size_t size = sizeof(double) * (size_t)linear->n;
    if (linear->n_moving) memset(w->moving.lambda, 0, sizeof(double) * (size_t)run->model->n_multipliers);
    if (fu_linear_kinematics(run, w)) return 1;
    if (linear->n_moving && fu_linear_condense(run, w, 1.0, linear->of_mass.L)) return 1;
    linear_residual(run, w);
    residual(run, w);
    if (linear->n_moving) {
        fu_linear_gaps(run, w, FU_OF_ACCELERATIONS, 1, run->next.acceleration);
        fu_linear_change_multipliers(run, w);
        take_multipliers(run, w->moving.lambda, w->moving.lambda_now);
    }
    fu_set_times(NULL, linear->n, -1.0, w->left, w->change);
    fu_linear_model_solve(linear, linear->of_mass.L, 0, w->change);
    memcpy(w->next.second, w->change, size);
    memcpy(w->next.a, w->change, size);
    return fu_linear_kinematics(run, w);
}

/* Reads the coordinates' rates from the velocities of `now`, and computes their second derivatives. */
static int start(fu_run *run)
{
    const fu_linear_space w = fu_linear_space_of(run);
    const fu_linear_model *linear = run->linear;
    const int n = linear->n;
    if (run->statistics.steps == 0) {
        if (fu_linear_model_start(run)) return FU_SINGULAR;
        memset(w.now.y, 0, sizeof(double) * (size_t)n);
        run->linear->error = w.error;
    }
    memset(w.now.rate, 0, sizeof(double) * (size_t)n);
    memset(w.now.second, 0, sizeof(double) * (size_t)n);
    fu_sparse_add_times(&linear->read, 1.0, run->now.v, w.now.rate);
    memcpy(w.next.y, w.now.y, 4 * sizeof(double) * (size_t)n);
    const fu_state next = run->next;
    run->next = run->now;
    const int failed = accelerate(run, &w);
    memcpy(w.now.y, w.next.y, 4 * sizeof(double) * (size_t)n);
    memset(w.left_now, 0, sizeof(double) * (size_t)n);
    *w.h_now = 0.0;
    fu_linear_exact_forces(run, &w);
    find_powers(run, &w, &run->dissipated_power, &run->external_power);
    run->next = next;
    return failed ? FU_SINGULAR : FU_RUNNING;
}

const fu_integrator fu_linear = {.name = "linear",
                                 .n_parameters = fu_alpha_parameters,
                                 .n_scratch = n_scratch,
                                 .start = start,
                                 .step = step,
                                 .error = error,
                                 .quadrature = fu_alpha_quadrature,
                                 .account = account,
                                 .row = row,
                                 .keeps_scratch = 1,
                                 .coasts = 1,
                                 .crosses_boundaries = 1,
                                 .defers_all = 1};
