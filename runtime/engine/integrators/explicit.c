/* Explicit Runge-Kutta with an embedded error estimate on the index-1 form of the equations, eq 38.
 *
 * The entries of the configuration (attitudes included, normalised at the end of a step) and the velocities are
 * integrated; the slides' s solves C_l = 0, eq 21, at every stage. Constraint errors of a step are projected away in
 * the norm of the mass: C_m = 0 by Newton, then H v = 0. The accelerations at the end are the first stage of the
 * next step and the last of the error estimate (Hairer, Norsett & Wanner 1993, II.5 and II.10). */
#include "base/clock.h"
#include "bodies/cables.h"
#include "bodies/rotation.h"
#include "couplings/common/couplings.h"
#include "equations/equations.h"
#include "equations/run.h"
#include "equations/step_control.h"
#include "events/events.h"

#include <math.h>
#include <string.h>

/* of the coarse estimate's square, as in DOP853 (Hairer, Norsett & Wanner 1993, II.10) */
#define COARSE_SHARE 0.01
/* of the dissipation of a step: permitted error of the method's quadrature; from -z = 3 on it is larger */
#define HEAT_TOLERANCE 0.01

/* The powers of a state: of damping within bodies, of other dissipation, and external power, W. */
enum { INTERNAL, OTHER, EXTERNAL, POWERS };

/* An explicit Runge-Kutta method with two embedded error estimates: A (stages x stages, row by row), b, c (stages),
 * error, coarse (stages + 1: the last is of the state at the end). */
typedef struct {
    int stages;
    const double *A, *b, *c, *error, *coarse;
} tableau;

static tableau tableau_of(const fu_run *run)
{
    const double *p = run->parameters;
    const int n = (int)p[0];
    const double *A = p + 1, *b = A + n * n, *c = b + n, *error = c + n;
    return (tableau){n, A, b, c, error, error + n + 1};
}

static long n_parameters(const double *given)
{
    const long n = (long)given[0];
    return 1 + n * n + 2 * n + 2 * (n + 1);
}

/* Returns the size of the work space: the rates of q and v of each stage, of the end of the step, and of an error
 * estimate; the powers of each stage and of the end; the time of `now` whose internal power is that of the first stage.
 */
static long n_scratch(const fu_run *run)
{
    const long n = tableau_of(run).stages;
    return (n + 2) * ((long)run->model->n_q + run->model->n_dof) + POWERS * (n + 1) + 1;
}

static double *stage(const fu_run *run, int k)
{
    return run->scratch + (long)k * (run->model->n_q + run->model->n_dof);
}

static double *powers(const fu_run *run, int k)
{
    return stage(run, tableau_of(run).stages + 2) + POWERS * k;
}

static double *known_at(const fu_run *run)
{
    return powers(run, tableau_of(run).stages + 1);
}

/* Computes the rates of the configuration and of the velocities of a state with known accelerations. */
static void rates(const fu_model *model, const fu_state *state, double *rate)
{
    const int n_flexible = model->n_bodies ? model->bodies[0].dof : model->n_dof;
    memcpy(rate, state->v, sizeof(double) * (size_t)n_flexible);
    FU_EACH_BODY(body, model) {
        body->kernel->rate(state->q + body->configuration, state->v + body->dof, rate + body->configuration);
        memcpy(rate + body->configuration + body->kernel->configuration, state->v + body->dof + body->kernel->velocity,
               sizeof(double) * (size_t)body->modes);
    }
    memcpy(rate + model->n_q, state->acceleration, sizeof(double) * (size_t)model->n_dof);
}

/* Adds the row's combination of the first n stages. */
static void combine(fu_run *run, const double *row, int n, double h, double *q, double *v)
{
    const fu_model *model = run->model;
    for (int k = 0; k < n; ++k) {
        const double weight = h * row[k], *rate = stage(run, k);
        if (weight == 0.0) continue;
        for (int i = 0; i < model->n_q; ++i) q[i] += weight * rate[i];
        for (int i = 0; i < model->n_dof; ++i) v[i] += weight * rate[model->n_q + i];
    }
}

/* Stores the rates of stage k, and the powers of its state. */
static void store_stage(fu_run *run, int k, const fu_state *state)
{
    rates(run->model, state, stage(run, k));
    powers(run, k)[INTERNAL] = fu_internal_dissipation(run->model, state->q, state->v);
    powers(run, k)[OTHER] = fu_coupling_dissipation(run->model, state, &run->accelerator);
    powers(run, k)[EXTERNAL] = fu_external_power(run, state, run->force);
}

/* Computes `next` from `now` and the row's combination, at t, with C_l = 0 at each slide; returns 0 on convergence. */
static int move_to(fu_run *run, const double *row, int n, double t, double h)
{
    const fu_model *model = run->model;
    fu_state *next = &run->next;
    memcpy(next->q, run->now.q, sizeof(double) * (size_t)model->n_q);
    memcpy(next->v, run->now.v, sizeof(double) * (size_t)model->n_dof);
    combine(run, row, n, h, next->q, next->v);
    next->t = t;
    if (model->n_motions) fu_prescribe(model, next);
    if (fu_find_internal(run)) return 1;
    fu_update_deferred(run, n == 1);
    return 0;
}

static int start(fu_run *run)
{
    *known_at(run) = NAN;
    return FU_RUNNING;
}

/* Computes the rates of all stages after the first, which is known; returns 0 on success. */
static int evaluate(fu_run *run, double h)
{
    const double begin = fu_clock();
    const fu_model *model = run->model;
    const tableau method = tableau_of(run);
    const int n = method.stages;
    fu_state *next = &run->next;
    for (int k = 1; k < n; ++k) {
        if (move_to(run, method.A + k * n, k, run->now.t + method.c[k] * h, h)) return 1;
        double *reaction = fu_supports_move(model, next) ? run->force : 0;
        if (fu_accelerations(model, next, &run->accelerator, next->acceleration, reaction)) return fu_fail_eq38(run);
        store_stage(run, k, next);
    }
    run->statistics.time_residual += fu_clock() - begin;
    return 0;
}

static int step(fu_run *run, double h)
{
    const fu_model *model = run->model;
    const tableau method = tableau_of(run);
    const int n = method.stages;
    fu_state *next = &run->next;
    fu_predict_internal(run, h);
    rates(model, &run->now, stage(run, 0));
    if (*known_at(run) != run->now.t) powers(run, 0)[INTERNAL] = fu_internal_dissipation(model, run->now.q, run->now.v);
    *known_at(run) = run->now.t;
    powers(run, 0)[OTHER] = run->dissipated_power - powers(run, 0)[INTERNAL];
    powers(run, 0)[EXTERNAL] = run->external_power;
    if (evaluate(run, h)) return 1;
    if (move_to(run, method.b, n, run->now.t + h, h)) return 1;
    if (fu_return_to_joints(run, next)) return 1;
    if (fu_complete(run, next)) return fu_fail_eq38(run);
    store_stage(run, n, next);
    run->statistics.evaluations += n;
    for (int i = 0; i < model->n_dof; ++i)
        if (!(fabs(next->v[i]) < FU_RUNS_AWAY)) return fu_fail(run, FU_NOT_FINITE, next->v, -1);
    return 0;
}

/* Converts increments of the configuration to those of dofs. */
static void increments(const fu_run *run, const double *q, double *out)
{
    const fu_model *model = run->model;
    const int n_flexible = model->n_bodies ? model->bodies[0].dof : model->n_dof;
    memcpy(out, q, sizeof(double) * (size_t)n_flexible);
    FU_EACH_BODY(body, model) {
        body->kernel->increment(run->next.q + body->configuration, q + body->configuration, out + body->dof);
        memcpy(out + body->dof + body->kernel->velocity, q + body->configuration + body->kernel->configuration,
               sizeof(double) * (size_t)body->modes);
    }
}

/* Returns the size of an estimate as a length, m: of positions, and of velocities times the step. */
static double estimate(fu_run *run, const double *row, double h)
{
    const fu_model *model = run->model;
    const int end = tableau_of(run).stages;
    double *q = stage(run, end + 1), *v = q + model->n_q;
    memset(q, 0, sizeof(double) * (size_t)(model->n_q + model->n_dof));
    combine(run, row, end + 1, h, q, v);
    increments(run, q, run->work);
    for (int k = 0; k < model->n_motions; ++k) run->work[model->motions[k].dof] = v[model->motions[k].dof] = 0.0;
    for (int i = 0; i < model->n_dof; ++i) v[i] *= h;
    /* dofs that are not named must not become unstable either: their error is limited to tol of the largest motion */
    const double unnamed = run->allowed * run->tol * fmax(run->motion, run->least_motion) / fu_allowed_error(run);
    return fmax(fu_error_size(run, run->work, unnamed), fu_error_size(run, v, unnamed));
}

/* Returns the local error of positions, m, from two embedded estimates, combined as in DOP853. */
static double error(fu_run *run, double h)
{
    const tableau method = tableau_of(run);
    const double fine = estimate(run, method.error, h);
    if (fine * fine == 0.0) return 0.0; /* the quotient of two that vanish together would be NaN */
    const double coarse = estimate(run, method.coarse, h);
    return fine * fine / sqrt(fine * fine + COARSE_SHARE * coarse * coarse);
}

static fu_quadrature quadrature(const fu_run *run)
{
    const tableau method = tableau_of(run);
    return (fu_quadrature){method.stages, method.b, method.c};
}

/* Returns the dissipation of damping in a step by its force's mean over the stages, along the displacement of the step,
 * J. The power is a quadratic form of velocities, B(v, v), and this is h B(dq/h, (v_n + v_n+1)/2): the loss that the
 * method itself gives a mode of any decay. */
static double taken_by_means(fu_run *run, double h)
{
    const fu_model *model = run->model;
    double *q = stage(run, tableau_of(run).stages + 1), *v = q + model->n_q;
    const fu_state *now = &run->now, *next = &run->next;
    double taken = 0.0;
    memset(q, 0, sizeof(double) * (size_t)(model->n_q + model->n_dof));
    combine(run, tableau_of(run).b, tableau_of(run).stages, 1.0, q, v);
    increments(run, q, run->work);
    for (int i = 0; i < model->n_q; ++i) q[i] = 0.5 * (now->q[i] + next->q[i]);
    for (int sign = 1; sign >= -1; sign -= 2) {
        for (int i = 0; i < model->n_dof; ++i) v[i] = 0.5 * run->work[i] + sign * 0.25 * (now->v[i] + next->v[i]);
        taken += sign * h * fu_internal_dissipation(model, q, v);
    }
    return taken;
}

/* Returns the dissipation of damping within bodies in a step, J: by the method's quadrature, whose error is estimated
 * like that of the step. In steps at the stability limit the fastest modes decay so much that stages overshoot them,
 * and their squares are many times the energy of the modes. */
static double taken_within(fu_run *run, double h)
{
    const tableau method = tableau_of(run);
    double sum = 0.0, off = method.error[method.stages] * powers(run, method.stages)[INTERNAL];
    for (int k = 0; k < method.stages; ++k) {
        sum += method.b[k] * powers(run, k)[INTERNAL];
        off += method.error[k] * powers(run, k)[INTERNAL];
    }
    return fabs(off) <= HEAT_TOLERANCE * fabs(sum) ? h * sum : taken_by_means(run, h);
}

/* Adds dissipation, J. In a step beyond the limit the method gives energy to the fastest modes, which is no
 * dissipation: it is recorded as owed, and later losses of the modes compensate it first. Until then the balance shows
 * it. */
static void count_heat(fu_run *run, double heat)
{
    const double counted = fmax(heat - run->heat_owed, 0.0);
    run->heat_owed = fmax(run->heat_owed - heat, 0.0);
    run->dissipated += counted;
}

static void account(fu_run *run, double h)
{
    const tableau method = tableau_of(run);
    const int n = method.stages;
    count_heat(run, taken_within(run, h));
    for (int k = 0; k < n; ++k) {
        run->dissipated += h * method.b[k] * powers(run, k)[OTHER];
        run->external += h * method.b[k] * powers(run, k)[EXTERNAL];
    }
    run->dissipated_power = powers(run, n)[INTERNAL] + powers(run, n)[OTHER];
    run->external_power = powers(run, n)[EXTERNAL];
    powers(run, 0)[INTERNAL] = powers(run, n)[INTERNAL];
    *known_at(run) = run->next.t;
}

const fu_integrator fu_explicit = {.name = "explicit",
                                   .n_parameters = n_parameters,
                                   .n_scratch = n_scratch,
                                   .start = start,
                                   .step = step,
                                   .error = error,
                                   .quadrature = quadrature,
                                   .account = account};
