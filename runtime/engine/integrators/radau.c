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

#include "complex_number.h"

#include <string.h>

#define MOST_ITERATIONS 10
#define SLOW 0.3          /* contraction above which the matrix is made anew for the next step */
#define SAFE 1.5e-2       /* of the allowed error: what Newton may leave */
#define VIBRATION 2.0     /* of the estimate for vibrations: what counts, as sensitive motions let errors grow */
#define EMBEDDED 0.1      /* the same of the embedded estimate, of too low an order */
#define KINK 0.2          /* of tol: the error that one kink of friction may make */
#define SWEEPS 4          /* of the attitudes' quadrature for each iteration */

enum { STAGES = 3 };

/* Scratch: stages' increments of velocity, accelerations, their transforms (n_dof each), the last step's increments and
 * its size, configurations (n_q each), powers, unknowns, normal forces (2 a slide, at the start and at each stage). */
typedef struct {
    double *Z, *a, *w, *last, *q, *powers, *h_last, *unknowns, *normal;
} workspace;

static workspace space(const fu_run *run)
{
    const long n = run->model->n_dof, stages = STAGES * n;
    double *p = run->scratch;
    return (workspace){p,
                       p + stages,
                       p + 2 * stages,
                       p + 3 * stages,
                       p + 4 * stages,
                       p + 4 * stages + STAGES * (long)run->model->n_q,
                       p + 4 * stages + STAGES * (long)run->model->n_q + 2 * STAGES,
                       p + 4 * stages + STAGES * (long)run->model->n_q + 2 * STAGES + 1,
                       p + 4 * stages + STAGES * (long)run->model->n_q + 2 * STAGES + 1 + run->newton.n + run->newton.m};
}

/* h / L, with the complex eigenvalue L */
static fu_complex complex_step(const fu_collocation *method, double h)
{
    return fu_complex_quotient((fu_complex){h, 0.0}, (fu_complex){method->alpha, method->beta});
}

/* complex += real factor * system, entry by entry */
static void accumulate(fu_run *run, fu_complex factor)
{
    const fu_system *s = &run->newton;
    const fu_complex_system *c = &run->complex_newton;
    const long band = (long)(3 * s->width + 1) * s->n, corner = (long)s->m * s->m;
    fu_complex *K = c->K, *D = c->D;
    for (long i = 0; i < band; ++i) fu_complex_add(&K[i], factor, s->K[i]);
    for (int k = 0; k < s->m; ++k)
        for (int half = 0; half < 2 * s->n_chains; ++half) {
            const fu_span right = s->span_B[k * 2 * s->n_chains + half], below = s->span_C[k * 2 * s->n_chains + half];
            fu_complex *B = (fu_complex *)c->B + (long)k * s->n, *C = (fu_complex *)c->C + (long)k * s->n;
            for (int i = right.first; i < right.end; ++i) fu_complex_add(&B[i], factor, s->B[(long)k * s->n + i]);
            for (int i = below.first; i < below.end; ++i) fu_complex_add(&C[i], factor, s->C[(long)k * s->n + i]);
        }
    for (long i = 0; i < corner; ++i) fu_complex_add(&D[i], factor, s->D[i]);
}

static int is_damped(const fu_model *model)
{
    int damped = 0;
    for (int c = 0; c < model->n_cables; ++c) damped |= model->cables[c].tau > 0.0 || model->cables[c].mass_damping > 0.0;
    for (int k = 0; k < model->n_springs; ++k) damped |= model->springs[k].damping > 0.0;
    return damped || model->n_resistances || model->n_bodies; /* forces of inertia go with the velocity of a body */
}

/* column k of X, and the rows of it that count; not if B has none */
static void solve_column(fu_run *run, int k)
{
    const fu_system *s = &run->newton;
    fu_complex_system *c = &run->complex_newton;
    int n = s->n, width = s->width, rows = 3 * width + 1, one = 1, touched = 0, info;
    fu_complex *x = (fu_complex *)c->X + (long)k * n;
    double *size = space(run).unknowns;
    for (int half = 0; half < 2 * s->n_chains; ++half) touched |= s->span_B[k * 2 * s->n_chains + half].end;
    if (!touched) return;
    memcpy(x, (fu_complex *)c->B + (long)k * n, sizeof(fu_complex) * (size_t)n);
    run->model->lapack->zgbtrs("N", &n, &width, &width, &one, c->K, &rows, c->pivot_band, x, &n, &info);
    for (int i = 0; i < n; ++i) size[i] = hypot(x[i].re, x[i].im);
    for (int chain = 0; chain < s->n_chains; ++chain)
        c->n_columns += fu_pieces(s, k, chain, size, c->columns + c->n_columns);
}

static int factor_complex(fu_run *run)
{
    const fu_system *s = &run->newton;
    fu_complex_system *c = &run->complex_newton;
    const fu_lapack *lapack = run->model->lapack;
    int n = s->n, m = s->m, width = s->width, rows = 3 * width + 1, info = 0;
    fu_complex *C = c->C, *D = c->D, *X = c->X;
    if (n) lapack->zgbtrf(&n, &n, &width, &width, c->K, &rows, c->pivot_band, &info);
    if (info || !m) return info;
    c->n_columns = 0;
    for (int k = 0; k < m; ++k) solve_column(run, k);
    for (const fu_piece *p = c->columns; p < c->columns + c->n_columns; ++p)
        for (const fu_piece *r = s->rows; r < s->rows + s->n_rows; ++r) {
            const fu_span of = fu_common(p->rows, r->rows);
            for (int i = of.first; i < of.end; ++i)
                fu_complex_subtract_product(&D[(long)p->k * m + r->k], C[(long)r->k * n + i], X[(long)p->k * n + i]);
        }
    lapack->zgetrf(&m, &m, D, &m, c->pivot_border, &info);
    return info;
}

static void solve_complex(fu_run *run)
{
    const fu_system *s = &run->newton;
    const fu_complex_system *c = &run->complex_newton;
    const fu_lapack *lapack = run->model->lapack;
    int n = s->n, m = s->m, width = s->width, rows = 3 * width + 1, one = 1, info;
    fu_complex *x = c->x, *y = x + n, *C = c->C, *X = c->X;
    if (n) lapack->zgbtrs("N", &n, &width, &width, &one, c->K, &rows, c->pivot_band, x, &n, &info);
    if (!m) return;
    for (const fu_piece *r = s->rows; r < s->rows + s->n_rows; ++r)
        for (int i = r->rows.first; i < r->rows.end; ++i)
            fu_complex_subtract_product(&y[r->k], C[(long)r->k * n + i], x[i]);
    lapack->zgetrs("N", &m, &one, c->D, &m, c->pivot_border, y, &m, &info);
    for (const fu_piece *p = c->columns; p < c->columns + c->n_columns; ++p)
        for (int i = p->rows.first; i < p->rows.end; ++i)
            fu_complex_subtract_product(&x[i], y[p->k], X[(long)p->k * n + i]);
}

/* The real and the complex matrix at `now`. Both are made of M + J, K and D, which systems of other weights differ by. */
static int factor(fu_run *run, double h)
{
    const double begin = fu_clock();
    const fu_collocation *method = &run->collocation;
    const fu_system *s = &run->newton;
    const fu_complex_system *c = &run->complex_newton;
    const double real = h / method->gamma, rate = 1.0 / real;
    const fu_complex other = complex_step(method, h), square = fu_complex_product(other, other);
    const fu_complex by_damping = {other.re / real, other.im / real};
    const fu_complex by_stiffness = {square.re / (real * real), square.im / (real * real)};
    const int damped = is_damped(run->model);
    memset(c->K, 0, sizeof(fu_complex) * (size_t)(3 * s->width + 1) * (size_t)s->n);
    memset(c->B, 0, sizeof(fu_complex) * (size_t)s->n * (size_t)s->m);
    memset(c->C, 0, sizeof(fu_complex) * (size_t)s->n * (size_t)s->m);
    memset(c->D, 0, sizeof(fu_complex) * (size_t)s->m * (size_t)s->m);
    fu_matrix(run, (fu_weights){1.0, 0.0, 2.0 * real * real});
    accumulate(run, (fu_complex){by_stiffness.re - 1.0, by_stiffness.im});
    if (damped) {
        fu_matrix(run, (fu_weights){1.0, 0.0, real * real});
        accumulate(run, (fu_complex){2.0 - by_stiffness.re - by_damping.re, -by_stiffness.im - by_damping.im});
    }
    fu_matrix(run, (fu_weights){1.0, rate, real * real});
    accumulate(run, damped ? by_damping : (fu_complex){2.0 - by_stiffness.re, -by_stiffness.im});
    memcpy(c->D_real, s->D, sizeof(double) * (size_t)s->m * (size_t)s->m);
    int info = fu_system_factor_band(&run->newton, run->model->lapack);
    if (!info) info = fu_system_factor_border(&run->newton, run->model->lapack);
    if (!info) info = factor_complex(run);
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
            sum += run->complex_newton.D_real[(long)i * s->m + row] * unknowns[s->n + i];
        run->rhs[s->n + row] = sum;
    }
}

/* run->rhs = [M r; H r] of dofs r that keep to the supports */
static void right_side(fu_run *run, const double *r, double *unknowns)
{
    const fu_model *model = run->model;
    const int beyond = model->n_band + model->n_border_dof;
    for (int i = 0; i < model->n_dof; ++i)
        if (model->place[i] >= 0) unknowns[model->place[i]] = r[i];
    for (int i = 0; i < model->n_dof; ++i) run->work[i] = r[i];
    for (int k = 0; k < model->n_motions; ++k) run->work[model->motions[k].dof] = 0.0;
    fu_mass_times(model, run->next.q, run->work, run->psi);
    fu_gather(model, run->psi, run->rhs);
    for (int i = 0; i < model->n_extra; ++i) run->rhs[beyond + i] = 0.0;
    for (int j = 0; j < model->n_slides; ++j)
        keep_row(run, model->slides[j].unknown + 1, model->slides[j].kernel->dim, unknowns);
    for (int k = 0; k < model->n_joints; ++k)
        keep_row(run, model->joints[k].unknown, model->joints[k].kernel->rows, unknowns);
}

/* Entries of the stages' q that have n dofs for rates, moved by the quadrature of velocities. */
static void integrate(fu_run *run, workspace w, double h, int at, int dof, int n)
{
    const fu_model *model = run->model;
    const fu_collocation *method = &run->collocation;
    const double *Z = w.Z + dof, *v = run->now.v + dof;
    for (int k = 0; k < STAGES; ++k) {
        double *q = w.q + (long)k * model->n_q + at;
        const double *row = method->A + STAGES * k;
        for (int i = 0; i < n; ++i)
            q[i] = run->now.q[at + i] + h * (method->c[k] * v[i] + row[0] * Z[i] + row[1] * Z[model->n_dof + i] +
                                             row[2] * Z[2 * model->n_dof + i]);
    }
}

/* A stage's dofs, moved by the quadrature of velocities; attitudes by sweeps over those at hand. */
static void configure(fu_run *run, workspace w, double h)
{
    const fu_model *model = run->model;
    const fu_collocation *method = &run->collocation;
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
                    velocity[i] = now->v[body->dof + i] + w.Z[(long)k * n + body->dof + i];
                fu_body_rate(body->kernel, w.q + (long)k * model->n_q + at, velocity, rates[k]);
            }
            for (int k = 0; k < STAGES; ++k) {
                const double *row = method->A + STAGES * k;
                for (int i = 0; i < size; ++i)
                    w.q[(long)k * model->n_q + at + i] =
                        now->q[at + i] + h * (row[0] * rates[0][i] + row[1] * rates[1][i] + row[2] * rates[2][i]);
            }
        }
}

/* `next` at stage k, without accelerations; 0 when its slides were found */
static int place_stage(fu_run *run, workspace w, int k, double h)
{
    const fu_model *model = run->model;
    fu_state *next = &run->next;
    memcpy(next->q, w.q + (long)k * model->n_q, sizeof(double) * (size_t)model->n_q);
    for (int i = 0; i < model->n_dof; ++i) next->v[i] = run->now.v[i] + w.Z[(long)k * model->n_dof + i];
    next->t = run->now.t + run->collocation.c[k] * h;
    if (model->n_motions) fu_prescribe(model, next);
    return fu_find_slides(run);
}

/* The normal forces of the state that accelerations have just been found of, as those of stage k. */
static void keep_normals(fu_run *run, workspace w, int k)
{
    const fu_model *model = run->model;
    double *normal = w.normal + 2L * k * model->n_slides;
    if (!model->n_resistances) return;
    for (int j = 0; j < model->n_slides; ++j)
        for (int c = 0; c < 2; ++c)
            normal[2 * j + c] = c < model->dim - 1 ? run->accelerator.multipliers[model->slides[j].multiplier + c] : 0.0;
}

/* accelerations of all stages; 0 when they were found */
static int evaluate(fu_run *run, workspace w, double h)
{
    const double begin = fu_clock();
    const fu_model *model = run->model;
    fu_state *next = &run->next;
    double *reaction = model->n_motions ? run->force : 0;
    configure(run, w, h);
    for (int k = 0; k < STAGES; ++k) {
        if (place_stage(run, w, k, h)) return 1;
        if (fu_accelerations(model, next, &run->accelerator, next->acceleration, 0, reaction)) return fu_fail_eq38(run);
        memcpy(w.a + (long)k * model->n_dof, next->acceleration, sizeof(double) * (size_t)model->n_dof);
        w.powers[2 * k] = fu_dissipated_power(run, next);
        w.powers[2 * k + 1] = fu_external_power(run, next, reaction);
        keep_normals(run, w, k + 1);
    }
    run->statistics.evaluations += STAGES;
    run->statistics.time_residual += fu_clock() - begin;
    return 0;
}

/* One Newton correction of the stages; returns its size as a length. */
static double correct(fu_run *run, workspace w, double h)
{
    const double begin = fu_clock();
    const fu_model *model = run->model;
    const fu_collocation *method = &run->collocation;
    const int n = model->n_dof, all = run->newton.n + run->newton.m;
    const double real = h / method->gamma;
    const fu_complex other = complex_step(method, h), square = fu_complex_product(other, other);
    fu_complex *x = run->complex_newton.x;
    for (int i = 0; i < n; ++i)
        for (int r = 0; r < STAGES; ++r) {
            const double *row = method->T_inverse + STAGES * r;
            w.w[(long)r * n + i] = 0.0;
            for (int k = 0; k < STAGES; ++k) {
                const double *A = method->A_inverse + STAGES * k;
                w.w[(long)r * n + i] += row[k] * (w.a[(long)k * n + i] - (A[0] * w.Z[i] + A[1] * w.Z[n + i] +
                                                                       A[2] * w.Z[2 * n + i]) / h);
            }
        }
    for (int i = 0; i < n; ++i) {
        const fu_complex r = fu_complex_product(square, (fu_complex){w.w[n + i], w.w[2 * n + i]});
        w.w[i] *= real * real;
        w.w[n + i] = r.re;
        w.w[2 * n + i] = r.im;
    }
    for (int part = 1; part < STAGES; ++part) {
        right_side(run, w.w + (long)part * n, w.unknowns);
        for (int i = 0; i < all; ++i) *(part == 1 ? &x[i].re : &x[i].im) = run->rhs[i];
    }
    solve_complex(run);
    right_side(run, w.w, w.unknowns);
    fu_system_solve(&run->newton, model->lapack, run->rhs);
    fu_spread(model, run->rhs, w.w);
    for (int i = 0; i < n; ++i) w.w[i] /= real;
    for (int part = 1; part < STAGES; ++part) {
        for (int i = 0; i < all; ++i) {
            const fu_complex change = fu_complex_quotient(x[i], other);
            run->rhs[i] = part == 1 ? change.re : change.im;
        }
        fu_spread(model, run->rhs, w.w + (long)part * n);
    }
    for (int i = 0; i < model->n_extra; ++i) run->rhs[model->n_band + model->n_border_dof + i] = 0.0;
    double largest = 0.0;
    for (int k = 0; k < STAGES; ++k) {
        const double *row = method->T + STAGES * k;
        for (int i = 0; i < n; ++i) {
            const double change = row[0] * w.w[i] + row[1] * w.w[n + i] + row[2] * w.w[2 * n + i];
            w.Z[(long)k * n + i] += change;
            run->work[i] = h * change;
        }
        const double size = fu_size(model, run->work);
        if (!(size <= largest)) largest = size;
    }
    run->statistics.time_solve += fu_clock() - begin;
    return largest;
}

/* Stages from the last step's polynomial, else from the acceleration at hand. */
static void predict(fu_run *run, workspace w, double h)
{
    const fu_model *model = run->model;
    const fu_collocation *method = &run->collocation;
    const int n = model->n_dof;
    const double *c = method->c;
    for (int k = 0; k < STAGES; ++k) {
        double weight[STAGES];
        const double x = run->predictor ? 1.0 + c[k] * h / *w.h_last : 0.0;
        for (int j = 0; j < STAGES; ++j) { /* Lagrange on 0 and the nodes */
            weight[j] = x / c[j];
            for (int m = 0; m < STAGES; ++m)
                if (m != j) weight[j] *= (x - c[m]) / (c[j] - c[m]);
        }
        for (int i = 0; i < n; ++i)
            w.Z[(long)k * n + i] = run->predictor
                ? weight[0] * w.last[i] + weight[1] * w.last[n + i] + weight[2] * w.last[2 * n + i] - w.last[2 * n + i]
                : c[k] * h * run->now.acceleration[i];
        memcpy(w.q + (long)k * model->n_q, run->now.q, sizeof(double) * (size_t)model->n_q);
    }
}

static int iterate(fu_run *run, workspace w, double h)
{
    double last = 0.0, before = 0.0;
    const double enough = fmax(run->fixed_step > 0.0 ? run->newton_tolerance : SAFE * run->allowed, run->round_off);
    predict(run, w, h);
    for (int i = 0; i < MOST_ITERATIONS; ++i) {
        if (evaluate(run, w, h)) return 1;
        const double size = correct(run, w, h);
        ++run->statistics.newton_iterations;
        if (!(size < 1e30)) return fu_fail(run, FU_ITERATION, run->work, -1);
        double ratio = 1.0;
        if (i > 0) {
            ratio = size / last;
            if (ratio >= 2.0 || (ratio >= 1.0 && size > 100.0 * run->round_off && i > 2))
                return fu_fail(run, FU_ITERATION, run->work, -1);
            /* the mean of two, as in RADAU5: one may be small by chance, where corrections of what is stiff and of what
             * constraints hold take turns */
            const double mean = i > 1 ? sqrt(ratio * before) : ratio;
            run->contraction = mean < 1e-3 ? 1e-3 : mean > 0.9 ? 0.9 : mean;
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
    run->factored = run->predictor = 0;
    return FU_RUNNING;
}

/* `next` as `now`, for what is linearised there and for what a step does not change */
static void begin_step(fu_run *run)
{
    const fu_model *model = run->model;
    const size_t dofs = sizeof(double) * (size_t)model->n_dof;
    fu_predict_extra(run, 0.0);
    memcpy(run->next.q, run->now.q, sizeof(double) * (size_t)model->n_q);
    memcpy(run->next.v, run->now.v, dofs);
    memcpy(run->next.acceleration, run->now.acceleration, dofs);
}

static int step(fu_run *run, double h)
{
    const workspace w = space(run);
    if (fabs(h - run->h_factored) > 1e-6 * h) run->factored = 0;
    for (int fresh = !run->factored;; fresh = 1) {
        begin_step(run);
        if (fresh) {
            if (factor(run, h)) return 1;
            run->contraction = 0.5; /* nothing is known yet */
        }
        const int failed = iterate(run, w, h);
        if (!failed) break;
        run->factored = run->predictor = 0;
        if (fresh) {
            ++run->statistics.newton_failures;
            return 1;
        }
    }
    configure(run, w, h);
    if (place_stage(run, w, STAGES - 1, h) || fu_return_to_joints(run, &run->next)) return 1;
    return fu_complete(run, &run->next) ? fu_fail_eq38(run) : 0;
}

/* Where the normal force of a slide turns round within a step, friction has a kink, and no quadrature over the step is
 * right: the friction of the mean normal force differs from the mean friction, by at least the error made. The rider's
 * speed stays wrong, and its position is off by that times the time that is left. Kinks are single events, so that one may
 * cost a part of tol, however short its step. Returns the error as a part of what is allowed, m. */
static double kink(fu_run *run, workspace w, double h)
{
    const fu_model *model = run->model;
    const double *c = run->collocation.c, left = run->duration - run->now.t;
    const double weight[STAGES + 1] = {0.5 * c[0], 0.5 * c[1], 0.5 * (c[2] - c[0]), 0.5 * (c[2] - c[1])};
    double worst = 0.0;
    if (!model->n_resistances) return 0.0;
    if (fu_accelerations(model, &run->now, &run->accelerator, run->work, 0, 0)) return INFINITY;
    keep_normals(run, w, 0);
    ++run->statistics.evaluations;
    for (int j = 0; j < model->n_slides; ++j) {
        const fu_slide *slide = &model->slides[j];
        double mean[2] = {0.0, 0.0}, all = 0.0;
        if (!slide->resistance || run->next.mode[j] != FU_SLIDES) continue;
        for (int k = 0; k <= STAGES; ++k) {
            const double *N = w.normal + 2L * (k * model->n_slides + j);
            for (int d = 0; d < 2; ++d) mean[d] += weight[k] * N[d];
            all += weight[k] * hypot(N[0], N[1]);
        }
        worst = fmax(worst, h * left * slide->friction * (all - hypot(mean[0], mean[1])) / slide->mass);
    }
    return worst * run->allowed / (KINK * run->tol * fmax(run->motion, run->least_motion));
}

/* run->work = (M + (h/L) D + (h/L)^2 K)^-1 M r on the joints, for the real L; returns its size as a length. */
static double filtered(fu_run *run, workspace w, const double *r)
{
    const fu_model *model = run->model;
    right_side(run, r, w.unknowns);
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
    const fu_collocation *method = &run->collocation;
    const workspace w = space(run);
    const int n = model->n_dof;
    const double real = h / method->gamma, *e = method->error;
    for (int i = 0; i < n; ++i) {
        double by_velocity = run->now.acceleration[i], by_position = run->now.v[i];
        for (int k = 0; k < STAGES; ++k) {
            const double *row = method->A + STAGES * k;
            by_velocity += e[k] * w.Z[(long)k * n + i] / h;
            by_position += e[k] * (method->c[k] * run->now.v[i] + row[0] * w.Z[i] + row[1] * w.Z[n + i] +
                                   row[2] * w.Z[2 * n + i]);
        }
        w.w[i] = real * real * by_velocity + real * by_position;
    }
    const double embedded = filtered(run, w, w.w);
    for (int i = 0; i < n; ++i) w.w[i] = w.w[n + i] = run->work[i];
    filtered(run, w, w.w);
    for (int i = 0; i < n; ++i) run->work[i] = w.w[n + i] - run->work[i];
    const double linear = fmax(VIBRATION * fu_size(model, run->work), EMBEDDED * embedded);
    return run->fixed_step > 0.0 ? linear : fmax(linear, kink(run, w, h));
}

/* Powers by the stages' weights, the last row of A; and the stages, for the next prediction. */
static void book(fu_run *run, double h)
{
    const workspace w = space(run);
    const double *b = run->collocation.A + STAGES * (STAGES - 1);
    for (int k = 0; k < STAGES; ++k) {
        run->dissipated += h * b[k] * w.powers[2 * k];
        run->external += h * b[k] * w.powers[2 * k + 1];
    }
    run->dissipated_power = fu_dissipated_power(run, &run->next);
    run->external_power = fu_external_power(run, &run->next, run->force);
    memcpy(w.last, w.Z, sizeof(double) * STAGES * (size_t)run->model->n_dof);
    *w.h_last = h;
    run->predictor = 1;
}

const fu_integrator fu_radau_method = {"radau", start, step, error, book, 0, 0, 0};
