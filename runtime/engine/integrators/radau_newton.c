/* Newton's systems of Radau IIA, a real and a complex one (integrators/radau.c). */
#include "base/clock.h"
#include "bodies/unknowns.h"
#include "equations/equations.h"
#include "integrators/radau.h"

#include <string.h>

/* Returns h / L, with the complex eigenvalue L. */
static fu_complex complex_step(const fu_radau_parameters *method, double h)
{
    return fu_complex_quotient((fu_complex){h, 0.0}, (fu_complex){method->alpha, method->beta});
}

/* Returns whether forces of the cables depend on velocities. */
static int cables_are_damped(const fu_model *model)
{
    FU_EACH_CABLE(cable, model)
        if (cable->tau > 0.0 || cable->mass_damping > 0.0) return 1;
    return 0;
}

/* Adds the matrix of these weights to the complex one, times a factor; whole: with the cables' part, else without. */
static void add_weights(fu_run *run, fu_weights weights, int whole, fu_complex factor)
{
    if (whole) fu_matrix_of_weights(run, weights);
    else {
        fu_system_clear(&run->newton);
        fu_add_matrix_without_cables(run, weights);
    }
    fu_complex_system_accumulate(&fu_radau_space(run)->newton, &run->newton, factor);
}

/* Computes both matrices at `now`, from M + J, K and D, the differences of systems with other weights. Cables without
 * damping have M, and M + K; their K, the most expensive part, is computed once. */
static void make_matrices(fu_run *run, double h)
{
    const fu_radau_parameters *method = fu_radau_method(run);
    const fu_model *model = run->model;
    fu_complex_system *c = &fu_radau_space(run)->newton;
    const double real = h / method->gamma, rate = 1.0 / real;
    const fu_complex other = complex_step(method, h), square = fu_complex_product(other, other);
    const fu_complex by_damping = {other.re / real, other.im / real};
    const fu_complex by_stiffness = {square.re / (real * real), square.im / (real * real)};
    const int whole = cables_are_damped(model),
              /* inertial forces depend on the velocity of a body */
        damped = whole || model->n_damped || model->n_bodies;
    const fu_complex last = damped ? by_damping : (fu_complex){2.0 - by_stiffness.re, -by_stiffness.im};
    fu_complex_system_clear(c, &run->newton);
    add_weights(run, (fu_weights){1.0, 0.0, 2.0 * real * real}, whole,
                (fu_complex){by_stiffness.re - 1.0, by_stiffness.im});
    if (damped) {
        const fu_complex rest = {2.0 - by_stiffness.re - by_damping.re, -by_stiffness.im - by_damping.im};
        add_weights(run, (fu_weights){1.0, 0.0, real * real}, whole, rest);
    }
    if (!whole) {
        fu_matrix_of_cables(run, (fu_weights){1.0, 0.0, 0.0});
        fu_complex_system_accumulate(c, &run->newton, (fu_complex){1.0 - by_stiffness.re, -by_stiffness.im});
    }
    fu_matrix_of_cables(run, (fu_weights){1.0, rate, real * real});
    if (!whole)
        fu_complex_system_accumulate(c, &run->newton,
                                     (fu_complex){by_stiffness.re - last.re, by_stiffness.im - last.im});
    fu_add_matrix_without_cables(run, (fu_weights){1.0, rate, real * real});
    fu_complex_system_accumulate(c, &run->newton, last);
}

/* Computes both and factors the real band. If that is not definite, the complex one needs more than its lower half. */
static int make_and_factor_band(fu_run *run, double h)
{
    fu_system *s = &run->newton;
    fu_radau_workspace *w = fu_radau_space(run);
    for (;;) {
        make_matrices(run, h);
        memcpy(w->D_real, s->D, sizeof(double) * (size_t)s->fronts->size);
        const int info = fu_system_factor_band(s);
        if (s->definite || !w->newton.is_lower) return info;
        w->newton.is_lower = 0; /* from now on, since it may stay so */
    }
}

/* Computes and factors the real and the complex matrix at `now`; returns 0, or nonzero if one is singular. */
int fu_radau_factor(fu_run *run, double h)
{
    const double begin = fu_clock();
    fu_radau_workspace *w = fu_radau_space(run);
    int info = make_and_factor_band(run, h);
    if (!info) info = fu_system_factor_border(&run->newton, run->model->lapack);
    if (!info) info = fu_complex_system_factor(&w->newton, &run->newton, run->model->lapack, w->unknowns);
    run->factored = !info;
    run->h_factored = h;
    run->statistics.factorisations += 2;
    run->statistics.time_factor += fu_clock() - begin;
    return info;
}

/* Computes the products of the border's rows with dofs, which for constraint rows are H r. */
static void border_times(fu_run *run, const double *unknowns)
{
    const fu_system *s = &run->newton;
    double *border_product = fu_radau_space(run)->border_product;
    for (int row = 0; row < s->m; ++row) border_product[row] = 0.0;
    for (int c = 0; c < s->n_chains; ++c) {
        const fu_matrix_block *rows = s->rows + FU_HALVES * s->chain_start[c];
        for (const fu_matrix_block *p = rows; p < rows + s->n_rows[c]; ++p)
            for (int i = p->rows.first; i < p->rows.end; ++i)
                border_product[p->k] += s->C[s->strips[p->strip].at + i] * unknowns[i];
    }
    fu_fronts_add_product(s->fronts, fu_radau_space(run)->D_real, run->model->n_border_dof, unknowns + s->n,
                          border_product);
}

void fu_radau_right_side(fu_run *run, const double *r, double *unknowns)
{
    const fu_model *model = run->model;
    const int beyond = model->n_band + model->n_border_dof;
    for (int i = 0; i < model->n_dof; ++i)
        if (model->unknown_of_dof[i] >= 0) unknowns[model->unknown_of_dof[i]] = r[i];
    for (int i = 0; i < model->n_dof; ++i) run->work[i] = r[i];
    for (int k = 0; k < model->n_motions; ++k) run->work[model->motions[k].dof] = 0.0;
    fu_mass_times(model, run->next.t, run->next.q, run->work, run->psi);
    fu_gather(model, run->psi, run->rhs);
    for (int i = 0; i < model->n_extra; ++i) run->rhs[beyond + i] = 0.0;
    border_times(run, unknowns);
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active) {
        const int first = c->unknown + c->n_coordinates;
        for (int i = first; i < first + c->n_forces && c->row >= 0; ++i)
            run->rhs[beyond + i] = fu_radau_space(run)->border_product[model->n_border_dof + i];
    }
}

/* Computes the right sides r of both systems, as dofs, from the stages' accelerations and increments. */
static void transform_residual(const fu_run *run, fu_radau_workspace *w, double h)
{
    const fu_radau_parameters *method = fu_radau_method(run);
    const int n = run->model->n_dof;
    const double real = h / method->gamma;
    const fu_complex other = complex_step(method, h), square = fu_complex_product(other, other);
    for (int i = 0; i < n; ++i)
        for (int r = 0; r < STAGES; ++r) {
            const double *row = method->T_inverse + STAGES * r;
            w->w[(long)r * n + i] = 0.0;
            for (int k = 0; k < STAGES; ++k) {
                const double *A = method->A_inverse + STAGES * k;
                w->w[(long)r * n + i] += row[k] * (w->a[(long)k * n + i] -
                                                   (A[0] * w->Z[i] + A[1] * w->Z[n + i] + A[2] * w->Z[2 * n + i]) / h);
            }
        }
    for (int i = 0; i < n; ++i) {
        const fu_complex r = fu_complex_product(square, (fu_complex){w->w[n + i], w->w[2 * n + i]});
        w->w[i] *= real * real;
        w->w[n + i] = r.re;
        w->w[2 * n + i] = r.im;
    }
}

/* Adds the transformed solution to the stages' increments; returns the size of the correction as a length. */
static double add_increments(fu_run *run, fu_radau_workspace *w, double h)
{
    const fu_radau_parameters *method = fu_radau_method(run);
    const int n = run->model->n_dof;
    double largest = 0.0;
    for (int k = 0; k < STAGES; ++k) {
        const double *row = method->T + STAGES * k;
        for (int i = 0; i < n; ++i) {
            const double change = row[0] * w->w[i] + row[1] * w->w[n + i] + row[2] * w->w[2 * n + i];
            w->Z[(long)k * n + i] += change;
            run->work[i] = h * change;
        }
        const double size = fu_size(run->model, run->work);
        if (!(size <= largest)) largest = size;
    }
    return largest;
}

double fu_radau_correct(fu_run *run, fu_radau_workspace *w, double h)
{
    const double begin = fu_clock();
    const fu_model *model = run->model;
    const fu_radau_parameters *method = fu_radau_method(run);
    const int n = model->n_dof, all = run->newton.n + run->newton.m;
    const fu_complex other = complex_step(method, h);
    fu_complex *x = w->newton.x;
    transform_residual(run, w, h);
    for (int part = 1; part < STAGES; ++part) {
        fu_radau_right_side(run, w->w + (long)part * n, w->unknowns);
        for (int i = 0; i < all; ++i) *(part == 1 ? &x[i].re : &x[i].im) = run->rhs[i];
    }
    fu_complex_system_solve(&w->newton, &run->newton, model->lapack);
    fu_radau_right_side(run, w->w, w->unknowns);
    fu_system_solve(&run->newton, model->lapack, run->rhs);
    fu_spread(model, run->rhs, w->w);
    for (int i = 0; i < n; ++i) w->w[i] /= h / method->gamma;
    for (int part = 1; part < STAGES; ++part) {
        for (int i = 0; i < all; ++i) {
            const fu_complex change = fu_complex_quotient(x[i], other);
            run->rhs[i] = part == 1 ? change.re : change.im;
        }
        fu_spread(model, run->rhs, w->w + (long)part * n);
    }
    for (int i = 0; i < model->n_extra; ++i) run->rhs[model->n_band + model->n_border_dof + i] = 0.0;
    const double largest = add_increments(run, w, h);
    run->statistics.time_solve += fu_clock() - begin;
    return largest;
}
