/* Radau IIA of three stages, order 5, on the index-1 form of the equations, eq 38: implicit, for stiff scenes.
 *
 * Unknowns are the stages' velocities less those at the start, Z; configurations follow from them by the same
 * quadrature (attitudes by a few sweeps of it), slides by C_l = 0, accelerations by eq 38. Newton's systems are, for
 * each eigenvalue L of A^-1,
 *
 *   (M + (h/L) D + (h/L)^2 K) x + H' mu = M r,   H x = H r,   r = (h/L)^2 (T^-1 a - (L/h) T^-1 Z)
 *
 * with T^-1 Z growing by (L/h) x: the real one is that of any implicit step, the complex one has the same parts. What
 * depends on the state in M^-1 H' but K is left out. The end of the step is its last stage, projected on the joints.
 * (Hairer & Wanner 1996, IV.8.)
 */
#include "engine.h"

#include "complex_system.h"
#include "workspace.h"


#include <string.h>

#define MOST_ITERATIONS 10
#define SLOW 0.3          /* contraction above which the matrix is made anew for the next step */
#define FIRST_CONTRACTION 0.5 /* before there are two increments */
#define QUICKEST 1e-3     /* contraction by which the rest of the error is estimated: least and most */
#define SLOWEST 0.9
#define DIVERGES 2.0      /* growth of an increment from one iteration to the next */
#define BEYOND_ROUNDING 100.0 /* times the rounding of positions: an increment that is no rounding */
#define SAFE 1.5e-2       /* of the allowed error: what Newton may leave */
#define VIBRATION 2.0     /* of the estimate for vibrations: what counts, as sensitive motions let errors grow */
#define EMBEDDED 0.1      /* the same of the embedded estimate, of too low an order */
#define KINK 0.2          /* of tol: the error that one kink of friction may make */
#define SWEEPS 4          /* of the attitudes' quadrature for each iteration */

enum { STAGES = 3 };

/* A^-1 = T L T^-1 with L = gamma beside the block of alpha +- i beta; the error's weights stand over the stages'
 * increments, beside gamma0 = 1/gamma times the rate at the start. */
typedef struct {
    double A[STAGES * STAGES], A_inverse[STAGES * STAGES], c[STAGES], T[STAGES * STAGES], T_inverse[STAGES * STAGES];
    double gamma, alpha, beta, error[STAGES];
} parameters;
_Static_assert(sizeof(parameters) == (4 * STAGES * STAGES + 2 * STAGES + 3) * sizeof(double),
               "parameters are an array of doubles");

static const parameters *method_of(const fu_run *run)
{
    return (const parameters *)run->parameters;
}

static long n_parameters(const double *given)
{
    (void)given;
    return FU_DOUBLES(1, parameters);
}

/* The head of the scratch, and the arrays behind it. */
typedef struct {
    double *Z;        /* stages' increments of velocity, n_dof each */
    double *a;        /* accelerations: likewise */
    double *w;        /* their transforms: likewise */
    double *q;        /* configurations, n_q each */
    double *powers;   /* dissipated and external, of each stage */
    double *multipliers; /* of eq 38 at the start and at each stage, where forces depend on them */
    double *unknowns; /* of a Newton system */
    double *D_real;   /* the real system's border before it was factored */
    double *last;     /* the last step's Z */
    double h_last;    /* its size, s; 0: there is none to predict from */
    fu_complex_system newton;
} workspace;

static workspace *space(const fu_run *run)
{
    return (workspace *)run->scratch;
}

/* Places the arrays in the scratch; returns how many doubles it takes, which is all that is done where it is null. */
static long lay_out(const fu_run *run, double *scratch)
{
    const fu_model *model = run->model;
    const long n = model->n_dof, m = run->newton.m;
    long taken = FU_DOUBLES(1, workspace);
    workspace unused, *w = scratch ? (workspace *)scratch : &unused;
    w->Z = fu_take(scratch, &taken, STAGES * n);
    w->a = fu_take(scratch, &taken, STAGES * n);
    w->w = fu_take(scratch, &taken, STAGES * n);
    w->q = fu_take(scratch, &taken, STAGES * (long)model->n_q);
    w->powers = fu_take(scratch, &taken, 2 * STAGES);
    w->multipliers = fu_take(scratch, &taken, (STAGES + 1) * (long)model->n_multipliers);
    w->unknowns = fu_take(scratch, &taken, run->newton.n + m);
    w->D_real = fu_take(scratch, &taken, m * m);
    w->last = fu_take(scratch, &taken, STAGES * n);
    fu_complex_system_take(&w->newton, &run->newton, scratch, &taken);
    return taken;
}

static long n_scratch(const fu_run *run)
{
    return lay_out(run, NULL);
}

/* h / L, with the complex eigenvalue L */
static fu_complex complex_step(const parameters *method, double h)
{
    return fu_complex_quotient((fu_complex){h, 0.0}, (fu_complex){method->alpha, method->beta});
}

static int is_damped(const fu_model *model)
{
    int damped = 0;
    for (int c = 0; c < model->n_cables; ++c) damped |= model->cables[c].tau > 0.0 || model->cables[c].mass_damping > 0.0;
    return damped || model->n_damped || model->n_bodies; /* forces of inertia go with the velocity of a body */
}

/* The real and the complex matrix at `now`. Both are made of M + J, K and D, which systems of other weights differ by. */
static int factor(fu_run *run, double h)
{
    const double begin = fu_clock();
    const parameters *method = method_of(run);
    const fu_system *s = &run->newton;
    workspace *w = space(run);
    fu_complex_system *c = &w->newton;
    const double real = h / method->gamma, rate = 1.0 / real;
    const fu_complex other = complex_step(method, h), square = fu_complex_product(other, other);
    const fu_complex by_damping = {other.re / real, other.im / real};
    const fu_complex by_stiffness = {square.re / (real * real), square.im / (real * real)};
    const int damped = is_damped(run->model);
    fu_complex_system_clear(c, s);
    fu_matrix_of_weights(run, (fu_weights){1.0, 0.0, 2.0 * real * real});
    fu_complex_system_accumulate(c, s, (fu_complex){by_stiffness.re - 1.0, by_stiffness.im});
    if (damped) {
        fu_matrix_of_weights(run, (fu_weights){1.0, 0.0, real * real});
        const fu_complex rest = {2.0 - by_stiffness.re - by_damping.re, -by_stiffness.im - by_damping.im};
        fu_complex_system_accumulate(c, s, rest);
    }
    fu_matrix_of_weights(run, (fu_weights){1.0, rate, real * real});
    fu_complex_system_accumulate(c, s, damped ? by_damping : (fu_complex){2.0 - by_stiffness.re, -by_stiffness.im});
    memcpy(w->D_real, s->D, sizeof(double) * (size_t)s->m * (size_t)s->m);
    int info = fu_system_factor_band(&run->newton, run->model->lapack);
    if (!info) info = fu_system_factor_border(&run->newton, run->model->lapack);
    if (!info) info = fu_complex_system_factor(c, s, run->model->lapack, w->unknowns);
    run->factored = !info;
    run->h_factored = h;
    run->statistics.factorisations += 2;
    run->statistics.time_factor += fu_clock() - begin;
    return info;
}

/* right sides H r of the constraint rows from this one on */
static void keep_row(fu_run *run, int first, int rows, const double *unknowns)
{
    const fu_model *model = run->model;
    const fu_system *s = &run->newton;
    for (int row = model->n_border_dof + first; rows-- > 0; ++row) {
        const double *along = s->C + (long)row * s->n;
        double sum = 0.0;
        for (const fu_piece *p = s->rows; p < s->rows + s->n_rows; ++p)
            for (int i = p->rows.first; i < p->rows.end && p->k == row; ++i) sum += along[i] * unknowns[i];
        for (int i = 0; i < model->n_border_dof; ++i)
            sum += space(run)->D_real[(long)i * s->m + row] * unknowns[s->n + i];
        run->rhs[s->n + row] = sum;
    }
}

/* run->rhs = [M r; H r] of dofs r that keep to the supports */
static void right_side(fu_run *run, const double *r, double *unknowns)
{
    const fu_model *model = run->model;
    const int beyond = model->n_band + model->n_border_dof;
    for (int i = 0; i < model->n_dof; ++i)
        if (model->unknown_of_dof[i] >= 0) unknowns[model->unknown_of_dof[i]] = r[i];
    for (int i = 0; i < model->n_dof; ++i) run->work[i] = r[i];
    for (int k = 0; k < model->n_motions; ++k) run->work[model->motions[k].dof] = 0.0;
    fu_mass_times(model, run->next.q, run->work, run->psi);
    fu_gather(model, run->psi, run->rhs);
    for (int i = 0; i < model->n_extra; ++i) run->rhs[beyond + i] = 0.0;
    for (int k = 0; k < model->n_couplings; ++k) {
        const fu_coupling *c = model->couplings[k];
        if (c->row >= 0) keep_row(run, c->unknown + c->n_coordinates, c->n_forces, unknowns);
    }
}

/* Entries of the stages' q that have n dofs for rates, moved by the quadrature of velocities. */
static void integrate(fu_run *run, workspace *w, double h, int at, int dof, int n)
{
    const fu_model *model = run->model;
    const parameters *method = method_of(run);
    const double *Z = w->Z + dof, *v = run->now.v + dof;
    for (int k = 0; k < STAGES; ++k) {
        double *q = w->q + (long)k * model->n_q + at;
        const double *row = method->A + STAGES * k;
        for (int i = 0; i < n; ++i)
            q[i] = run->now.q[at + i] + h * (method->c[k] * v[i] + row[0] * Z[i] + row[1] * Z[model->n_dof + i] +
                                             row[2] * Z[2 * model->n_dof + i]);
    }
}

/* A stage's dofs, moved by the quadrature of velocities; attitudes by sweeps over those at hand. */
static void configure(fu_run *run, workspace *w, double h)
{
    const fu_model *model = run->model;
    const parameters *method = method_of(run);
    const fu_state *now = &run->now;
    const int n = model->n_dof, n_flexible = model->n_bodies ? model->bodies[0].dof : n;
    integrate(run, w, h, 0, 0, n_flexible);
    for (int b = 0; b < model->n_bodies; ++b) {
        const fu_body *body = &model->bodies[b];
        integrate(run, w, h, body->configuration + body->kernel->configuration, body->dof + body->kernel->velocity,
                  body->modes);
    }
    for (int sweep = 0; sweep < SWEEPS; ++sweep)
        for (int b = 0; b < model->n_bodies; ++b) {
            const fu_body *body = &model->bodies[b];
            const int at = body->configuration, size = body->kernel->configuration;
            double rates[STAGES][7], velocity[6];
            for (int k = 0; k < STAGES; ++k) {
                for (int i = 0; i < body->kernel->velocity; ++i)
                    velocity[i] = now->v[body->dof + i] + w->Z[(long)k * n + body->dof + i];
                fu_body_rate(body->kernel, w->q + (long)k * model->n_q + at, velocity, rates[k]);
            }
            for (int k = 0; k < STAGES; ++k) {
                const double *row = method->A + STAGES * k;
                for (int i = 0; i < size; ++i)
                    w->q[(long)k * model->n_q + at + i] =
                        now->q[at + i] + h * (row[0] * rates[0][i] + row[1] * rates[1][i] + row[2] * rates[2][i]);
            }
        }
}

/* `next` at stage k, without accelerations; 0 when its slides were found */
static int place_stage(fu_run *run, workspace *w, int k, double h)
{
    const fu_model *model = run->model;
    fu_state *next = &run->next;
    memcpy(next->q, w->q + (long)k * model->n_q, sizeof(double) * (size_t)model->n_q);
    for (int i = 0; i < model->n_dof; ++i) next->v[i] = run->now.v[i] + w->Z[(long)k * model->n_dof + i];
    next->t = run->now.t + method_of(run)->c[k] * h;
    if (model->n_motions) fu_prescribe(model, next);
    return fu_find_own(run);
}

/* The multipliers of the state that accelerations have just been found of, as those of stage k. */
static void keep_multipliers(fu_run *run, workspace *w, int k)
{
    const long n = run->model->n_multipliers;
    if (run->model->n_reacting) memcpy(w->multipliers + k * n, run->accelerator.multipliers, sizeof(double) * (size_t)n);
}

/* accelerations of all stages; 0 when they were found */
static int evaluate(fu_run *run, workspace *w, double h)
{
    const double begin = fu_clock();
    const fu_model *model = run->model;
    fu_state *next = &run->next;
    double *reaction = model->n_motions ? run->force : 0;
    configure(run, w, h);
    for (int k = 0; k < STAGES; ++k) {
        if (place_stage(run, w, k, h)) return 1;
        if (fu_accelerations(model, next, &run->accelerator, next->acceleration, reaction)) return fu_fail_eq38(run);
        memcpy(w->a + (long)k * model->n_dof, next->acceleration, sizeof(double) * (size_t)model->n_dof);
        w->powers[2 * k] = fu_dissipated_power(run, next);
        w->powers[2 * k + 1] = fu_external_power(run, next, reaction);
        keep_multipliers(run, w, k + 1);
    }
    run->statistics.evaluations += STAGES;
    run->statistics.time_residual += fu_clock() - begin;
    return 0;
}

/* One Newton correction of the stages; returns its size as a length. */
static double correct(fu_run *run, workspace *w, double h)
{
    const double begin = fu_clock();
    const fu_model *model = run->model;
    const parameters *method = method_of(run);
    const int n = model->n_dof, all = run->newton.n + run->newton.m;
    const double real = h / method->gamma;
    const fu_complex other = complex_step(method, h), square = fu_complex_product(other, other);
    fu_complex *x = w->newton.x;
    for (int i = 0; i < n; ++i)
        for (int r = 0; r < STAGES; ++r) {
            const double *row = method->T_inverse + STAGES * r;
            w->w[(long)r * n + i] = 0.0;
            for (int k = 0; k < STAGES; ++k) {
                const double *A = method->A_inverse + STAGES * k;
                w->w[(long)r * n + i] += row[k] * (w->a[(long)k * n + i] - (A[0] * w->Z[i] + A[1] * w->Z[n + i] +
                                                                       A[2] * w->Z[2 * n + i]) / h);
            }
        }
    for (int i = 0; i < n; ++i) {
        const fu_complex r = fu_complex_product(square, (fu_complex){w->w[n + i], w->w[2 * n + i]});
        w->w[i] *= real * real;
        w->w[n + i] = r.re;
        w->w[2 * n + i] = r.im;
    }
    for (int part = 1; part < STAGES; ++part) {
        right_side(run, w->w + (long)part * n, w->unknowns);
        for (int i = 0; i < all; ++i) *(part == 1 ? &x[i].re : &x[i].im) = run->rhs[i];
    }
    fu_complex_system_solve(&w->newton, &run->newton, model->lapack);
    right_side(run, w->w, w->unknowns);
    fu_system_solve(&run->newton, model->lapack, run->rhs);
    fu_spread(model, run->rhs, w->w);
    for (int i = 0; i < n; ++i) w->w[i] /= real;
    for (int part = 1; part < STAGES; ++part) {
        for (int i = 0; i < all; ++i) {
            const fu_complex change = fu_complex_quotient(x[i], other);
            run->rhs[i] = part == 1 ? change.re : change.im;
        }
        fu_spread(model, run->rhs, w->w + (long)part * n);
    }
    for (int i = 0; i < model->n_extra; ++i) run->rhs[model->n_band + model->n_border_dof + i] = 0.0;
    double largest = 0.0;
    for (int k = 0; k < STAGES; ++k) {
        const double *row = method->T + STAGES * k;
        for (int i = 0; i < n; ++i) {
            const double change = row[0] * w->w[i] + row[1] * w->w[n + i] + row[2] * w->w[2 * n + i];
            w->Z[(long)k * n + i] += change;
            run->work[i] = h * change;
        }
        const double size = fu_size(model, run->work);
        if (!(size <= largest)) largest = size;
    }
    run->statistics.time_solve += fu_clock() - begin;
    return largest;
}

/* Stages from the last step's polynomial, else from the acceleration at hand. */
static void predict(fu_run *run, workspace *w, double h)
{
    const fu_model *model = run->model;
    const parameters *method = method_of(run);
    const int n = model->n_dof;
    const double *c = method->c;
    for (int k = 0; k < STAGES; ++k) {
        double weight[STAGES];
        const double x = w->h_last > 0.0 ? 1.0 + c[k] * h / w->h_last : 0.0;
        for (int j = 0; j < STAGES; ++j) { /* Lagrange on 0 and the nodes */
            weight[j] = x / c[j];
            for (int m = 0; m < STAGES; ++m)
                if (m != j) weight[j] *= (x - c[m]) / (c[j] - c[m]);
        }
        for (int i = 0; i < n; ++i)
            w->Z[(long)k * n + i] = w->h_last > 0.0
                ? weight[0] * w->last[i] + weight[1] * w->last[n + i] + weight[2] * w->last[2 * n + i] - w->last[2 * n + i]
                : c[k] * h * run->now.acceleration[i];
        memcpy(w->q + (long)k * model->n_q, run->now.q, sizeof(double) * (size_t)model->n_q);
    }
}

static int iterate(fu_run *run, workspace *w, double h)
{
    double last = 0.0, before = 0.0;
    const double enough = fmax(run->fixed_step > 0.0 ? run->newton_tolerance : SAFE * run->allowed, run->round_off);
    predict(run, w, h);
    for (int i = 0; i < MOST_ITERATIONS; ++i) {
        if (evaluate(run, w, h)) return 1;
        const double size = correct(run, w, h);
        ++run->statistics.newton_iterations;
        if (!(size < FU_RUNS_AWAY)) return fu_fail(run, FU_ITERATION, run->work, -1);
        double ratio = 1.0;
        if (i > 0) {
            ratio = size / last;
            if (ratio >= DIVERGES || (ratio >= 1.0 && size > BEYOND_ROUNDING * run->round_off && i > 2))
                return fu_fail(run, FU_ITERATION, run->work, -1);
            /* the mean of two, as in RADAU5: one may be small by chance, where corrections of what is stiff and of what
             * constraints hold take turns */
            const double mean = i > 1 ? sqrt(ratio * before) : ratio;
            run->contraction = mean < QUICKEST ? QUICKEST : mean > SLOWEST ? SLOWEST : mean;
            before = ratio;
        }
        if (size * run->contraction / (1.0 - run->contraction) <= enough || size <= run->round_off) {
            if (i > 0 && run->contraction > SLOW) run->factored = 0;
            return 0;
        }
        last = size;
    }
    return fu_fail(run, FU_ITERATION, run->work, -1);
}

static int start(fu_run *run)
{
    lay_out(run, run->scratch);
    space(run)->h_last = 0.0;
    run->factored = 0;
    return FU_RUNNING;
}

/* `next` as `now`, for what is linearised there and for what a step does not change */
static void begin_step(fu_run *run)
{
    const fu_model *model = run->model;
    const size_t dofs = sizeof(double) * (size_t)model->n_dof;
    fu_predict_own(run, 0.0);
    memcpy(run->next.q, run->now.q, sizeof(double) * (size_t)model->n_q);
    memcpy(run->next.v, run->now.v, dofs);
    memcpy(run->next.acceleration, run->now.acceleration, dofs);
}

static int step(fu_run *run, double h)
{
    workspace *w = space(run);
    if (fabs(h - run->h_factored) > FU_SAME_STEP * h) run->factored = 0;
    for (int fresh = !run->factored;; fresh = 1) {
        begin_step(run);
        if (fresh) {
            if (factor(run, h)) return 1;
            run->contraction = FIRST_CONTRACTION;
        }
        const int failed = iterate(run, w, h);
        if (!failed) break;
        run->factored = 0;
        w->h_last = 0.0;
        if (fresh) {
            ++run->statistics.newton_failures;
            return 1;
        }
    }
    configure(run, w, h);
    if (place_stage(run, w, STAGES - 1, h) || fu_return_to_joints(run, &run->next)) return 1;
    return fu_complete(run, &run->next) ? fu_fail_eq38(run) : 0;
}

/* Kinks of forces within a step are single events, so that one may cost a part of tol, however short its step. Returns the
 * largest error that one may make as a part of what is allowed, m. */
static double kink(fu_run *run, workspace *w, double h)
{
    const fu_model *model = run->model;
    const double *c = method_of(run)->c, left = run->duration - run->now.t;
    const double weight[STAGES + 1] = {0.5 * c[0], 0.5 * c[1], 0.5 * (c[2] - c[0]), 0.5 * (c[2] - c[1])};
    double worst = 0.0;
    if (!model->n_reacting) return 0.0;
    if (fu_accelerations(model, &run->now, &run->accelerator, run->work, 0)) return INFINITY;
    keep_multipliers(run, w, 0);
    ++run->statistics.evaluations;
    for (int k = 0; k < model->n_couplings; ++k) {
        const fu_coupling *coupling = model->couplings[k];
        if (!coupling->type->kink) continue;
        worst = fmax(worst, coupling->type->kink(model, coupling, &run->next, STAGES + 1, weight, w->multipliers, h * left));
    }
    return worst * run->allowed / (KINK * run->tol * fmax(run->motion, run->least_motion));
}

/* run->work = (M + (h/L) D + (h/L)^2 K)^-1 M r on the joints, for the real L; returns its size as a length. */
static double filtered(fu_run *run, workspace *w, const double *r)
{
    const fu_model *model = run->model;
    right_side(run, r, w->unknowns);
    fu_system_solve(&run->newton, model->lapack, run->rhs);
    for (int i = 0; i < model->n_extra; ++i) run->rhs[model->n_band + model->n_border_dof + i] = 0.0;
    return fu_spread_size(run);
}

/* Local error of positions, m. The embedded estimate E, (L/h - J)^-1 of the rate at the start and what the stages say of
 * it for the real L, is of order 3: for a vibration with h omega = z it is z^-2 times the error of the method. What the same
 * filter, applied to E, takes away has the right order, and is 0.55 to 2.5 times the error for every z. A part of E counts
 * beside it, for what the matrix has nothing of: loads that change in time, bodies that turn.
 */
static double error(fu_run *run, double h)
{
    const fu_model *model = run->model;
    const parameters *method = method_of(run);
    workspace *w = space(run);
    const int n = model->n_dof;
    const double real = h / method->gamma, *e = method->error;
    for (int i = 0; i < n; ++i) {
        double by_velocity = run->now.acceleration[i], by_position = run->now.v[i];
        for (int k = 0; k < STAGES; ++k) {
            const double *row = method->A + STAGES * k;
            by_velocity += e[k] * w->Z[(long)k * n + i] / h;
            by_position += e[k] * (method->c[k] * run->now.v[i] + row[0] * w->Z[i] + row[1] * w->Z[n + i] +
                                   row[2] * w->Z[2 * n + i]);
        }
        w->w[i] = real * real * by_velocity + real * by_position;
    }
    const double embedded = filtered(run, w, w->w);
    for (int i = 0; i < n; ++i) w->w[i] = w->w[n + i] = run->work[i];
    filtered(run, w, w->w);
    for (int i = 0; i < n; ++i) run->work[i] = w->w[n + i] - run->work[i];
    const double linear = fmax(VIBRATION * fu_size(model, run->work), EMBEDDED * embedded);
    return run->fixed_step > 0.0 ? linear : fmax(linear, kink(run, w, h));
}

/* Powers by the stages' weights, the last row of A; and the stages, for the next prediction. */
static void account(fu_run *run, double h)
{
    workspace *w = space(run);
    const double *b = method_of(run)->A + STAGES * (STAGES - 1);
    for (int k = 0; k < STAGES; ++k) {
        run->dissipated += h * b[k] * w->powers[2 * k];
        run->external += h * b[k] * w->powers[2 * k + 1];
    }
    run->dissipated_power = fu_dissipated_power(run, &run->next);
    run->external_power = fu_external_power(run, &run->next, run->force);
    memcpy(w->last, w->Z, sizeof(double) * STAGES * (size_t)run->model->n_dof);
    w->h_last = h;
}

static void forget(fu_run *run)
{
    space(run)->h_last = 0.0;
}

const fu_integrator fu_radau = {.name = "radau",
                                .n_parameters = n_parameters,
                                .n_scratch = n_scratch,
                                .start = start,
                                .step = step,
                                .error = error,
                                .account = account,
                                .forget = forget};
