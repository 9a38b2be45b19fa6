/* Constraints of the linear model that move along cables, such as those of slides, condensed onto their multipliers. */
#include "base/workspace.h"
#include "integrators/linear_constraints.h"

#include <math.h>
#include <string.h>

/* Returns the half bandwidth of a full matrix of n rows as a band. */
static int full_width(int n)
{
    return n < FU_BAND_GROUP ? FU_BAND_GROUP - 1 : n - 1;
}

long fu_linear_take_constraints(const fu_run *run, double *scratch, long taken, fu_linear_constraints *c)
{
    const fu_linear_model *linear = run->linear;
    const int m = linear->n_moving, width = full_width(m);
    if (!m) return taken;
    c->lambda = fu_take(scratch, &taken, run->model->n_multipliers);
    c->lambda_now = fu_take(scratch, &taken, run->model->n_multipliers);
    c->H = fu_take(scratch, &taken, (long)m * linear->n);
    c->X = fu_take(scratch, &taken, (long)m * FU_BAND_LENGTH(linear->n, linear->width));
    c->S = fu_take(scratch, &taken, (long)(m + FU_BAND_MORE(width)) * (width + 1));
    c->values = fu_take(scratch, &taken, FU_BAND_LENGTH(m, width));
    return taken;
}

/* The active constraints that move, one after the other: a row of H over the dofs, and its multiplier. */
typedef struct {
    int block, row;
    const fu_rows *rows;
} moving;

/* Goes on to the next one; returns whether there is one. Begin with {0, -1, NULL}. */
static int next_of(const fu_run *run, moving *it)
{
    for (; it->block < run->model->n_rows; ++it->block, it->row = -1) {
        it->rows = &run->accelerator.rows[it->block];
        if (!run->linear->moves[it->block]) continue;
        while (++it->row < it->rows->rows)
            if (!(it->rows->redundant_rows >> it->row & 1)) return 1;
    }
    return 0;
}

static void add_row(const moving *it, double factor, double *dofs)
{
    const double *row = it->rows->H + it->row * it->rows->n;
    for (int k = 0; k < it->rows->n; ++k) dofs[it->rows->at[k]] += factor * row[k];
}

static double *column_of(const fu_run *run, const fu_linear_space *w, int k)
{
    return w->moving.X + k * FU_BAND_LENGTH(run->linear->n, run->linear->width);
}

/* Solves S x = w->moving.values of n constraints. */
static void solve(const fu_linear_space *w, int n)
{
    const int width = full_width(n);
    memset(w->moving.values + n, 0, sizeof(double) * FU_BAND_BEYOND(width));
    fu_band_solve(n, width, w->moving.S, 0, w->moving.values);
}

/* Returns the product of the k-th row of H with coordinates. */
static double row_times(const fu_linear_model *linear, const fu_linear_space *w, int k, const double *x)
{
    double sum = 0.0;
    for (int i = linear->moving_start[k]; i < linear->moving_start[k + 1]; ++i)
        sum += w->moving.H[i] * x[linear->moving_column[i]];
    return sum;
}

/* Stores the entries of a row of H, given over all coordinates, as the k-th; returns the place of the first. */
static int store_row(fu_linear_model *linear, const fu_linear_space *w, int k, const double *row)
{
    int n = linear->moving_start[k];
    for (int i = 0; i < linear->n; ++i) {
        if (row[i] == 0.0) continue;
        linear->moving_column[n] = i;
        w->moving.H[n++] = row[i];
    }
    linear->moving_start[k + 1] = n;
    return n > linear->moving_start[k] ? linear->moving_column[linear->moving_start[k]] : 0;
}

int fu_linear_condense(const fu_run *run, const fu_linear_space *w, double psi, const double *L)
{
    fu_linear_model *linear = run->linear;
    int m = 0;
    for (moving it = {0, -1, NULL}; next_of(run, &it); ++m) {
        double *X = column_of(run, w, m);
        memset(w->force, 0, sizeof(double) * (size_t)run->model->n_dof);
        add_row(&it, 1.0, w->force);
        fu_linear_model_project(linear, w->force, X);
        const int first = store_row(linear, w, m, X);
        fu_set_times(NULL, linear->n, psi, X, X);
        fu_linear_model_solve(linear, L, first, X);
    }
    const int width = full_width(m);
    memset(w->moving.S, 0, sizeof(double) * (size_t)((m + FU_BAND_MORE(width)) * (width + 1)));
    for (int j = 0; j < m; ++j)
        for (int i = j; i < m; ++i)
            w->moving.S[j * (width + 1) + i - j] = row_times(linear, w, i, column_of(run, w, j));
    return m && fu_band_factor(m, width, w->moving.S);
}

double fu_linear_gap(const fu_run *run)
{
    double largest = 0.0;
    for (moving it = {0, -1, NULL}; next_of(run, &it);) largest = fmax(largest, fabs(it.rows->C[it.row]));
    return largest;
}

void fu_linear_change_multipliers(const fu_run *run, const fu_linear_space *w)
{
    const fu_linear_model *linear = run->linear;
    double *values = w->moving.values;
    int m = 0;
    for (moving it = {0, -1, NULL}; next_of(run, &it); ++m)
        values[m] = w->gaps[it.rows->first + it.row] - fu_dot(linear->n, column_of(run, w, m), w->left);
    if (!m) return;
    solve(w, m);
    m = 0;
    for (moving it = {0, -1, NULL}; next_of(run, &it); ++m) {
        w->moving.lambda[it.rows->first + it.row] += values[m];
        for (int i = linear->moving_start[m]; i < linear->moving_start[m + 1]; ++i)
            w->left[linear->moving_column[i]] += values[m] * w->moving.H[i];
    }
}

void fu_linear_keep_constraints(const fu_run *run, const fu_linear_space *w)
{
    const int n = run->linear->n;
    int m = 0;
    for (moving it = {0, -1, NULL}; next_of(run, &it); ++m)
        w->moving.values[m] = row_times(run->linear, w, m, w->change);
    if (!m) return;
    solve(w, m);
    for (int k = 0; k < m; ++k) fu_add_times(NULL, n, -w->moving.values[k], column_of(run, w, k), w->change);
}

void fu_linear_add_constraint_forces(const fu_run *run, const fu_linear_space *w)
{
    for (moving it = {0, -1, NULL}; next_of(run, &it);)
        add_row(&it, w->moving.lambda[it.rows->first + it.row], w->force);
}
