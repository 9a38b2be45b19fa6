/* Radau IIA of three stages, order 5, on the index-1 form of the equations, eq 38: implicit, for stiff scenes.
 *
 * Unknowns are the stages' velocities less those at the start, Z; configurations follow from them by the same
 * quadrature (attitudes by a few sweeps of it), slides by C_l = 0, accelerations by eq 38. Newton's systems are, for
 * each eigenvalue L of A^-1,
 *     (M + (h/L) D + (h/L)^2 K) x + H' mu = M r,   H x = H r,
 *     r = (h/L)^2 (T^-1 a - (L/h) T^-1 Z),
 * and T^-1 Z changes by (L/h) x: the real one has the form of any implicit step, the complex one the same parts.
 *
 * The dependence of M^-1 H' on the state is neglected, except K. The end of the step is its last stage, projected on
 * the joints. (Hairer & Wanner 1996, IV.8.) */
#include "equations/equations.h"
#include "integrators/radau.h"

#include <math.h>
#include <string.h>

#define SHORT_STEP 1e-4       /* of the output step: shorter steps are tried with constant velocities, too */
#define MAX_ITERATIONS 10     /* of Newton's method in a step before it fails */
#define FIRST_CONTRACTION 0.5 /* ratio of increments assumed before the second one */
/* contraction above which the matrix is renewed for the next step */
#define SLOW_CONTRACTION 0.3
/* least contraction for the estimate of the remaining error: a smaller one may be chance */
#define MIN_CONTRACTION 1e-3
#define MAX_CONTRACTION 0.9 /* largest contraction for it, 9 increments */
/* growth of an increment from one iteration to the next at which the iteration fails */
#define DIVERGENCE_GROWTH 2.0
#define ROUNDING_FACTOR 100.0 /* times the rounding of positions: an increment that is not rounding */
#define NEWTON_SHARE 1.5e-2   /* of the permitted error: Newton's tolerance */

static long n_parameters(const double *given)
{
    (void)given;
    return FU_DOUBLES(1, fu_radau_parameters);
}

/* Places the arrays in the scratch, unless it is null; returns their number of doubles. */
static long lay_out(const fu_run *run, double *scratch)
{
    const fu_model *model = run->model;
    const long n = model->n_dof, m = run->newton.m;
    long taken = FU_DOUBLES(1, fu_radau_workspace);
    fu_radau_workspace unused, *w = scratch ? (fu_radau_workspace *)scratch : &unused;
    w->Z = fu_take(scratch, &taken, STAGES * n);
    w->a = fu_take(scratch, &taken, STAGES * n);
    w->w = fu_take(scratch, &taken, STAGES * n);
    w->q = fu_take(scratch, &taken, STAGES * (long)model->n_q);
    w->powers = fu_take(scratch, &taken, 2 * STAGES);
    w->multipliers = fu_take(scratch, &taken, (STAGES + 1) * (long)model->n_multipliers);
    w->unknowns = fu_take(scratch, &taken, run->newton.n + m);
    w->D_real = fu_take(scratch, &taken, run->newton.fronts->size);
    w->border_product = fu_take(scratch, &taken, m);
    w->last = fu_take(scratch, &taken, STAGES * n);
    fu_complex_system_take(&w->newton, &run->newton, scratch, &taken);
    return taken;
}

static long n_scratch(const fu_run *run)
{
    return lay_out(run, NULL);
}

/* Newton's method from a prediction with the current matrix; returns 0 on convergence. */
static int iterate(fu_run *run, fu_radau_workspace *w, double h, fu_radau_prediction prediction)
{
    double last = 0.0, before = 0.0;
    const double enough =
        fmax(run->fixed_step > 0.0 ? run->newton_tolerance : NEWTON_SHARE * run->allowed, run->round_off);
    fu_radau_predict(run, w, h, prediction);
    for (int i = 0; i < MAX_ITERATIONS; ++i) {
        if (fu_radau_evaluate(run, w, h)) return 1;
        const double size = fu_radau_correct(run, w, h);
        ++run->statistics.newton_iterations;
        if (!(size < FU_RUNS_AWAY)) return fu_fail(run, FU_ITERATION, run->work, -1);
        double ratio = 1.0;
        if (i > 0) {
            ratio = size / last;
            if (ratio >= DIVERGENCE_GROWTH || (ratio >= 1.0 && size > ROUNDING_FACTOR * run->round_off && i > 2))
                return fu_fail(run, FU_ITERATION, run->work, -1);
            /* the mean of two, as in RADAU5: one may be small by chance, where corrections of stiff and of constrained
             * motions alternate */
            const double mean = i > 1 ? sqrt(ratio * before) : ratio;
            run->contraction = mean < MIN_CONTRACTION   ? MIN_CONTRACTION
                               : mean > MAX_CONTRACTION ? MAX_CONTRACTION
                                                        : mean;
            before = ratio;
        }
        if (size * run->contraction / (1.0 - run->contraction) <= enough || size <= run->round_off) {
            if (i > 0 && run->contraction > SLOW_CONTRACTION) run->factored = 0;
            return 0;
        }
        last = size;
    }
    return fu_fail(run, FU_ITERATION, run->work, -1);
}

static int start(fu_run *run)
{
    lay_out(run, run->scratch);
    fu_radau_space(run)->h_last = 0.0;
    run->factored = 0;
    return FU_RUNNING;
}

/* Copies `now` to `next`, for linearisation there and for unchanged parts. */
static void begin_step(fu_run *run)
{
    const fu_model *model = run->model;
    const size_t dofs = sizeof(double) * (size_t)model->n_dof;
    fu_predict_internal(run, 0.0);
    memcpy(run->next.q, run->now.q, sizeof(double) * (size_t)model->n_q);
    memcpy(run->next.v, run->now.v, dofs);
    memcpy(run->next.acceleration, run->now.acceleration, dofs);
}

/* Solves for the stages with a fresh matrix; returns 0 on success. Accelerations of light ropes are inaccurate: a small
 * error of a strain is a large one of them. Where the prediction by accelerations fails, that by velocities may not: it
 * is tried in short steps alone, since in a long one friction may come to slide that sticks. */
static int solve_afresh(fu_run *run, fu_radau_workspace *w, double h)
{
    begin_step(run);
    if (fu_radau_factor(run, h)) return 1;
    run->contraction = FIRST_CONTRACTION;
    int failed = iterate(run, w, h, w->h_last > 0.0 ? FU_BY_LAST_STEP : FU_BY_ACCELERATION);
    if (failed && run->model->n_inertial && h < SHORT_STEP * run->output_step) {
        begin_step(run);
        run->contraction = FIRST_CONTRACTION;
        failed = iterate(run, w, h, FU_BY_VELOCITY);
    }
    if (!failed) return 0;
    ++run->statistics.newton_failures;
    run->factored = 0;
    w->h_last = 0.0;
    return 1;
}

/* Solves for the stages with the last matrix; returns 0 on success. */
static int solve_again(fu_run *run, fu_radau_workspace *w, double h)
{
    begin_step(run);
    if (!iterate(run, w, h, w->h_last > 0.0 ? FU_BY_LAST_STEP : FU_BY_ACCELERATION)) return 0;
    w->h_last = 0.0;
    return 1;
}

static int step(fu_run *run, double h)
{
    fu_radau_workspace *w = fu_radau_space(run);
    if (fabs(h - run->h_factored) > FU_SAME_STEP * h) run->factored = 0;
    if ((!run->factored || solve_again(run, w, h)) && solve_afresh(run, w, h)) return 1;
    fu_radau_configure(run, w, h);
    fu_radau_add_internal_dissipation(run, w, h);
    if (fu_radau_place_stage(run, w, STAGES - 1, h) || fu_return_to_joints(run, &run->next)) return 1;
    return fu_complete(run, &run->next) ? fu_fail_eq38(run) : 0;
}

static fu_quadrature quadrature(const fu_run *run)
{
    const fu_radau_parameters *method = fu_radau_method(run);
    return (fu_quadrature){STAGES, method->A + STAGES * (STAGES - 1), method->c};
}

static void forget(fu_run *run)
{
    fu_radau_space(run)->h_last = 0.0;
}

const fu_integrator fu_radau = {.name = "radau",
                                .n_parameters = n_parameters,
                                .n_scratch = n_scratch,
                                .start = start,
                                .step = step,
                                .error = fu_radau_error,
                                .quadrature = quadrature,
                                .account = fu_radau_account,
                                .has_matrix = 1,
                                .forget = forget};
