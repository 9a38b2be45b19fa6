/* Prediction of a step from earlier ones. Accelerations consist of motions that a step resolves, which a polynomial
 * through the last steps predicts, and of unresolved vibrations, which nothing predicts. The next step is predicted
 * by the polynomial, of degree 0 to 2, that would have predicted the last one best; or, if velocities alone would
 * have been better, by `rest` times the last acceleration, with which the integrator continues its velocities.
 *
 * A polynomial extrapolates unknowns alone: dofs tied to them follow, prescribed ones have `rest` times the last.
 * Newton's method does not correct other parts of a prediction, and rounding in them, extrapolated by polynomials,
 * would grow without bounds. */
#include "base/simd.h"
#include "base/workspace.h"
#include "bodies/unknowns.h"
#include "equations/run.h"
#include "integrators/extrapolation.h"

#include <math.h>
#include <string.h>

enum { BY_VELOCITIES = -1, MAX_DEGREE = 2 };

/* Places the arrays in a work space; only counts them if it is null. */
void fu_extrapolation_take(fu_extrapolation *past, const fu_model *model, double *scratch, long *taken)
{
    past->before = fu_take(scratch, taken, model->n_dof);
    past->earlier = fu_take(scratch, taken, model->n_dof);
    past->slope = fu_take(scratch, taken, model->n_coordinates);
    past->slope_before = fu_take(scratch, taken, model->n_coordinates);
    past->force_before = fu_take(scratch, taken, model->n_forces);
    past->force_earlier = fu_take(scratch, taken, model->n_forces);
    past->last = (fu_last_steps *)fu_take(scratch, taken, FU_DOUBLES(1, fu_last_steps));
}

/* Starts without a history. */
void fu_extrapolation_start(const fu_extrapolation *past)
{
    *past->last = (fu_last_steps){0.0, 0.0, 0.0, BY_VELOCITIES};
}

/* Factors of the accelerations at `now` and of the two steps before in a prediction. */
typedef struct {
    double now, before, earlier;
} factors;

static factors factors_of(const fu_last_steps *last, int degree, double rest, double h)
{
    if (degree == BY_VELOCITIES) return (factors){rest, 0.0, 0.0};
    if (degree == 0) return (factors){1.0, 0.0, 0.0};
    const double first = h / last->h;
    if (degree == 1) return (factors){1.0 + first, -first, 0.0};
    const double bend = h * (h + last->h) / (last->h + last->h_before), now = bend / last->h,
                 earlier = bend / last->h_before;
    return (factors){1.0 + first + now, -first - now - earlier, earlier};
}

static double predicted(const fu_extrapolation *past, factors f, const double *a, int i)
{
    return f.now * a[i] + f.before * past->before[i] + f.earlier * past->earlier[i];
}

/* Computes the accelerations of a first `next`: `rest` times those at `now`, and the predicted change of unknowns
 * beyond that. */
static void predict_accelerations(const fu_extrapolation *past, fu_run *run, factors f, double rest)
{
    const fu_model *model = run->model;
    const double *a = run->now.a;
    memset(run->rhs, 0, sizeof(double) * (size_t)(model->n_band + model->n_border_dof));
    for (int i = 0; i < model->n_dof; ++i) {
        const int unknown = model->unknown_of_dof[i];
        if (unknown >= 0) run->rhs[unknown] = predicted(past, f, a, i) - rest * a[i];
    }
    fu_spread(model, run->rhs, run->work);
    for (int i = 0; i < model->n_dof; ++i) run->next.a[i] = rest * a[i] + run->work[i];
}

/* Computes the forces of a first `next`, predicted like accelerations. Unchanged ones stay, such as those of redundant
 * rows. Steps with error control gain nothing by it: they are as large as Newton's method permits. */
static void predict_forces(const fu_extrapolation *past, fu_run *run, factors f)
{
    const double *now = run->now.forces;
    for (int i = 0; i < run->model->n_forces; ++i)
        if (now[i] != past->force_before[i])
            run->next.forces[i] =
                f.now * now[i] + f.before * past->force_before[i] + f.earlier * past->force_earlier[i];
}

/* Computes a first `next`: its accelerations, and the couplings' coordinates, by a parabola, and forces. */
void fu_extrapolate(const fu_extrapolation *past, fu_run *run, double rest, double h)
{
    const fu_last_steps *last = past->last;
    const factors f = factors_of(last, (int)last->degree, rest, h);
    predict_accelerations(past, run, f, rest);
    fu_predict_internal(run, h);
    if (last->degree > 0 && run->fixed_step > 0.0) predict_forces(past, run, f);
    if (last->steps < 2) return;
    const double bend = h * (h + last->h) / (last->h + last->h_before);
    for (int i = 0; i < run->model->n_coordinates; ++i)
        run->next.s[i] += bend * (past->slope[i] - past->slope_before[i]);
}

/* Factors of all predictions, by degree from BY_VELOCITIES on: they are evaluated side by side. */
enum { PREDICTIONS = MAX_DEGREE - BY_VELOCITIES + 1 };
_Static_assert(PREDICTIONS == FU_SIMD_WIDTH, "one block has all predictions");
typedef struct {
    fu_simd_block now, before, earlier;
} all_factors;

FU_INLINE void sum_misses(const fu_extrapolation *past, const fu_run *run, const all_factors *f, double *sums)
{
    const double *weight = run->model->weight, *a = run->now.a, *next = run->next.a;
    const int *unknown = run->model->unknown_of_dof, n = run->model->n_dof;
    fu_simd_block sum = {0.0};
    for (int i = 0; i < n; ++i) {
        if (unknown[i] < 0) continue;
        const fu_simd_block predicted = f->now * a[i] + f->before * past->before[i] + f->earlier * past->earlier[i];
        const fu_simd_block d = weight[i] * (next[i] - predicted);
        sum += d * d;
    }
    *(fu_simd_block *)sums = sum;
}

/* Computes the sums of squares of the errors of all predictions of the unknowns' `next`. */
static void misses(const fu_extrapolation *past, const fu_run *run, const all_factors *f, double *sums);
FU_SIMD_FUNCTION(misses, sum_misses,
                 (const fu_extrapolation *past, const fu_run *run, const all_factors *f, double *sums),
                 (past, run, f, sums))

/* Returns the degree of the prediction, of those with enough steps, that would have predicted the last step best. */
static int best_degree(const fu_extrapolation *past, const fu_run *run, double rest, double h)
{
    const fu_last_steps *last = past->last;
    all_factors all = {{0.0}, {0.0}, {0.0}};
    double sums[PREDICTIONS], least = INFINITY;
    int best = BY_VELOCITIES;
    for (int degree = BY_VELOCITIES; degree <= MAX_DEGREE && degree <= last->steps; ++degree) {
        const factors f = factors_of(last, degree, rest, h);
        all.now[degree - BY_VELOCITIES] = f.now;
        all.before[degree - BY_VELOCITIES] = f.before;
        all.earlier[degree - BY_VELOCITIES] = f.earlier;
    }
    misses(past, run, &all, sums);
    for (int degree = BY_VELOCITIES; degree <= MAX_DEGREE && degree <= last->steps; ++degree) {
        const double sum = sums[degree - BY_VELOCITIES];
        if (!(sum < least)) continue;
        least = sum;
        best = degree;
    }
    return best;
}

/* Records the last step from `now` to `next`, and chooses the prediction of the next one. */
void fu_extrapolation_accept(const fu_extrapolation *past, const fu_run *run, double rest, double h)
{
    const size_t dofs = sizeof(double) * (size_t)run->model->n_dof;
    const size_t coordinates = sizeof(double) * (size_t)run->model->n_coordinates;
    const size_t forces = sizeof(double) * (size_t)run->model->n_forces;
    fu_last_steps *last = past->last;
    const int best = best_degree(past, run, rest, h);
    memcpy(past->earlier, past->before, dofs);
    memcpy(past->before, run->now.a, dofs);
    memcpy(past->force_earlier, past->force_before, forces);
    memcpy(past->force_before, run->now.forces, forces);
    memcpy(past->slope_before, past->slope, coordinates);
    memcpy(past->slope, run->s_slope, coordinates);
    *last = (fu_last_steps){h, last->h, last->steps + 1, best};
}
