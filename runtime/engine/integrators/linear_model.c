/* The linear model of motion about the start: matrices of cables, basis of the constraints, factors. */
#include "integrators/linear_model.h"
#include "base/simd.h"
#include "equations/equations.h"

#include <string.h>

void fu_sparse_add_times(const fu_sparse *A, double factor, const double *x, double *y)
{
    for (int i = 0; i < A->rows; ++i) {
        double sum = 0.0;
        for (int k = A->start[i]; k < A->start[i + 1]; ++k) sum += A->value[k] * x[A->column[k]];
        y[A->row[i]] += factor * sum;
    }
}

int fu_linear_model_factor(const fu_linear_model *linear, const double weights[FU_MATRICES], double *L)
{
    const long size = (long)linear->n * (linear->width + 1);
    const double *const *of = linear->matrices;
    fu_set_times(NULL, (int)size, weights[FU_MASS], of[FU_MASS], L);
    fu_add_times(NULL, (int)size, weights[FU_DAMPING], of[FU_DAMPING], L);
    fu_add_times(NULL, (int)size, weights[FU_STIFFNESS], of[FU_STIFFNESS], L);
    memset(L + size, 0, sizeof(double) * (size_t)(FU_BAND_MORE(linear->width) * (linear->width + 1)));
    return fu_band_factor(linear->n, linear->width, L);
}

fu_step_factor *fu_step_factor_of(fu_linear_model *linear, double h, int *is_known)
{
    fu_step_factor *oldest = linear->factors;
    ++linear->asked;
    for (fu_step_factor *each = linear->factors; each < linear->factors + FU_STEP_FACTORS; ++each) {
        *is_known = h == each->h;
        if (*is_known || each->used < oldest->used) oldest = each;
        if (*is_known) break;
    }
    oldest->used = linear->asked;
    return oldest;
}

void fu_linear_model_solve(const fu_linear_model *linear, const double *L, int first, double *x)
{
    memset(x + linear->n, 0, sizeof(double) * FU_BAND_BEYOND(linear->width));
    fu_band_solve(linear->n, linear->width, L, first, x);
}

void fu_linear_model_project(const fu_linear_model *linear, const double *force, double *y)
{
    const fu_sparse *rows = &linear->combinations;
    for (int i = 0; i < linear->n; ++i) y[i] = linear->dof[i] < 0 ? 0.0 : force[linear->dof[i]];
    for (int i = 0; i < rows->rows; ++i)
        for (int k = rows->start[i]; k < rows->start[i + 1]; ++k)
            y[rows->column[k]] += rows->value[k] * force[linear->mixed[i]];
}

/* Computes `count` vectors over the dofs by the coordinates, which pass through their numbers once. */
FU_INLINE void expand(const fu_linear_model *linear, int n_dof, int count, const double *const *y, double *const *dofs)
{
    const fu_sparse *rows = &linear->combinations;
    for (int m = 0; m < count; ++m) memset(dofs[m], 0, sizeof(double) * (size_t)n_dof);
    for (int i = 0; i < linear->n; ++i) {
        const int dof = linear->dof[i];
        if (dof < 0) continue;
        for (int m = 0; m < count; ++m) dofs[m][dof] = y[m][i];
    }
    for (int i = 0; i < rows->rows; ++i)
        for (int m = 0; m < count; ++m) {
            double sum = 0.0;
            for (int k = rows->start[i]; k < rows->start[i + 1]; ++k) sum += rows->value[k] * y[m][rows->column[k]];
            dofs[m][linear->mixed[i]] = sum;
        }
}

void fu_linear_model_expand(const fu_linear_model *linear, int n_dof, const double *y, double *dofs)
{
    expand(linear, n_dof, 1, &y, &dofs);
}

void fu_linear_model_expand_motion(const fu_linear_model *linear, int n_dof, const double *const y[FU_MATRICES],
                                   double *const dofs[FU_MATRICES])
{
    expand(linear, n_dof, FU_MATRICES, y, dofs);
}

static void add_product(const fu_linear_model *linear, int n, int which, const double *x, double *y)
{
    fu_add_half_bands_times(n, linear->stride, 1, &linear->cables[which], &x, y);
}

/* Computes the forces of cables one after the other, with the totals. */
static void forces_with_totals(const fu_run *run, const fu_small_motion *motion, double *force, fu_cable_totals *totals)
{
    const fu_linear_model *linear = run->linear;
    const int n = fu_rope_dofs(run->model).first;
    const size_t size = sizeof(double) * (size_t)run->model->n_dof;
    memset(force, 0, size);
    add_product(linear, n, FU_STIFFNESS, motion->displacement, force);
    totals->elastic =
        linear->elastic + fu_dot(n, motion->displacement, linear->force) + 0.5 * fu_dot(n, motion->displacement, force);
    fu_add_times(NULL, n, 1.0, linear->force, force);
    add_product(linear, n, FU_DAMPING, motion->velocity, force);
    memcpy(totals->without_inertia, force, size);
    add_product(linear, n, FU_MASS, motion->acceleration, force);
}

void fu_linear_model_cable_forces(const fu_run *run, const fu_small_motion *motion, double *force,
                                  fu_cable_totals *totals)
{
    const fu_linear_model *linear = run->linear;
    const double *const of[FU_MATRICES] = {motion->acceleration, motion->velocity, motion->displacement};
    if (totals) {
        forces_with_totals(run, motion, force, totals);
        return;
    }
    memcpy(force, linear->force, sizeof(double) * (size_t)run->model->n_dof);
    fu_add_half_bands_times(fu_rope_dofs(run->model).first, linear->stride, FU_MATRICES, linear->cables, of, force);
}

/* Returns the power of the damping of cables, W. */
double fu_linear_model_dissipation(const fu_run *run, const double *velocity)
{
    const fu_linear_model *linear = run->linear;
    double power;
    fu_half_band_form(fu_rope_dofs(run->model).first, linear->stride, linear->cables[FU_DAMPING], velocity, &power);
    return power;
}

/* Returns a force of a cable's dof by a row of its matrices, and the first entries of the columns before it. */
double fu_linear_model_cable_force(const fu_run *run, const fu_small_motion *motion, int dof)
{
    const fu_linear_model *linear = run->linear;
    const double *const of[FU_MATRICES] = {motion->acceleration, motion->velocity, motion->displacement};
    double sum = linear->force[dof];
    if (dof >= fu_rope_dofs(run->model).first) return 0.0;
    for (int k = 0; k < FU_MATRICES; ++k) {
        const double *A = linear->cables[k];
        for (int j = 0; j < linear->stride; ++j) {
            sum += A[(long)dof * linear->stride + j] * of[k][dof + j];
            if (j && j <= dof) sum += A[(long)(dof - j) * linear->stride + j] * of[k][dof - j];
        }
    }
    return sum;
}

int fu_linear_model_start(fu_run *run)
{
    static const fu_at_rest which[FU_MATRICES] = {FU_MASS_AT_REST, FU_DAMPING_AT_REST, FU_STIFFNESS_AT_REST};
    const fu_model *model = run->model;
    fu_linear_model *linear = run->linear;
    const long size = (long)FU_HALF_BAND_ROWS(fu_rope_dofs(model).first) * linear->stride;
    const double pace = 1.0 / run->duration, weights[FU_MATRICES] = {pace * pace, 0.0, 1.0},
                 of_mass[FU_MATRICES] = {1.0, 0.0, 0.0};
    for (int k = 0; k < FU_MATRICES; ++k) {
        memset(linear->cables[k], 0, sizeof(double) * (size_t)size);
        fu_add_cables_at_rest(model, run->first, which[k], linear->stride, linear->cables[k]);
    }
    memset(linear->force, 0, sizeof(double) * (size_t)model->n_dof);
    fu_internal_forces(model, run->first, model->zero, linear->force);
    for (int i = fu_rope_dofs(model).first; i < model->n_dof; ++i) linear->force[i] = 0.0; /* bodies are exact */
    linear->elastic = fu_constant_elastic_energy(model, run->first);
    return fu_linear_model_factor(linear, weights, linear->at_rest.L) ||
           fu_linear_model_factor(linear, of_mass, linear->of_mass.L);
}
