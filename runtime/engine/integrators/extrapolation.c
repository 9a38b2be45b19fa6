/* Prediction of a step from the steps before. A way to predict is exact for polynomials through `points` values, and for
 * vibrations far beyond the step, which change by the factor -r with each step: it solves (1 - z)^points (1 + r z)^alternating
 * a = 0 for the next value, where z takes a value to the one a step before. With points alone steps may differ in size. The
 * next step is predicted by the way that would have predicted the last ones best; or, where velocities alone would have been
 * better, by `rest` times the last acceleration, with which the integrator goes on with its velocities.
 *
 * Couplings' forces go with accelerations; their coordinates go with positions, whose second difference does, and so take two
 * points more.
 *
 * What is predicted are unknowns alone: dofs that are tied to them follow, those that are prescribed have `rest` times the
 * last. Newton's method does not mend what a prediction has besides, and rounding in that, continued by polynomials, would
 * grow without bounds. So forces that have not changed stay as they are, as those of redundant rows do.
 */
#include "engine.h"

#include "extrapolation.h"
#include "unknowns.h"
#include "workspace.h"

#include <math.h>
#include <string.h>

#define MEMORY 0.5 /* of a mean of misses: what it keeps of the one before; vibrations make one way seem best by chance */

enum { BY_VELOCITIES = 0, MOST_VALUES = FU_LONGER_PAST + 1, SUMS = 4 };

typedef struct {
    int points, alternating;
} way;
static const way ways[FU_WAYS] = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {1, 1}, {3, 1}, {3, 2}};

/* Factors by which a prediction has n values: at `now`, then of the steps before. */
typedef struct {
    double of[MOST_VALUES];
    int n;
} factors;

/* Places the arrays in a work space; only counts them where it is null. */
void fu_extrapolation_take(fu_extrapolation *past, const fu_model *model, double *scratch, long *taken)
{
    for (int k = 0; k < FU_PAST; ++k) {
        past->accelerations[k] = fu_take(scratch, taken, model->n_dof);
        past->forces[k] = fu_take(scratch, taken, model->n_forces);
    }
    for (int k = 0; k < FU_LONGER_PAST; ++k) past->coordinates[k] = fu_take(scratch, taken, model->n_coordinates);
    past->weight = fu_take(scratch, taken, model->n_dof);
    past->last = (fu_last_steps *)fu_take(scratch, taken, FU_DOUBLES(1, fu_last_steps));
}

/* Begins where nothing is known of the past. */
void fu_extrapolation_start(const fu_extrapolation *past, const fu_model *model)
{
    *past->last = (fu_last_steps){.way = BY_VELOCITIES};
    for (int i = 0; i < model->n_dof; ++i) past->weight[i] = model->unknown_of_dof[i] >= 0 ? model->weight[i] : 0.0;
}

/* Returns how many steps are of one size after one of size h. */
static double equal_steps(const fu_last_steps *last, double h)
{
    return last->steps > 0.0 && fabs(h - last->h[0]) <= FU_SAME_STEP * h ? last->equal + 1.0 : 1.0;
}

/* Returns whether a step of size h can be predicted by so many values of a way: `now` and what is known before it. */
static int is_possible(const fu_last_steps *last, way by, double h)
{
    const int values = by.points + by.alternating;
    return values <= last->steps + 1.0 && (!by.alternating || values <= equal_steps(last, h));
}

static factors of_equal_steps(way by, double alternating)
{
    double product[MOST_VALUES + 1] = {1.0};
    factors f = {.n = by.points + by.alternating};
    for (int k = 0; k < f.n; ++k)
        for (int j = k + 1; j > 0; --j) product[j] += (k < by.points ? -1.0 : alternating) * product[j - 1];
    for (int k = 0; k < f.n; ++k) f.of[k] = -product[k + 1];
    return f;
}

/* Returns the factors of a polynomial through points at the ends of the last steps, a step of size h beyond them. */
static factors of_polynomial(const fu_last_steps *last, int points, double h)
{
    double before[MOST_VALUES] = {h}; /* the instant that is predicted */
    factors f = {.n = points};
    for (int k = 1; k < points; ++k) before[k] = before[k - 1] + last->h[k - 1];
    for (int k = 0; k < points; ++k) {
        f.of[k] = 1.0;
        for (int j = 0; j < points; ++j)
            if (j != k) f.of[k] *= before[j] / (before[j] - before[k]);
    }
    return f;
}

static factors factors_of(const fu_last_steps *last, way by, fu_own_motion own, double h)
{
    if (by.alternating) return of_equal_steps(by, own.alternating);
    return by.points ? of_polynomial(last, by.points, h) : (factors){{own.rest}, 1};
}

/* Makes the accelerations of a first `next`: `rest` times those at `now`, and what unknowns change by beyond that. */
static void predict_accelerations(const fu_extrapolation *past, fu_run *run, factors f, double rest)
{
    const fu_model *model = run->model;
    const double *a = run->now.a;
    memset(run->rhs, 0, sizeof(double) * (size_t)(model->n_band + model->n_border_dof));
    for (int i = 0; i < model->n_dof; ++i) {
        const int unknown = model->unknown_of_dof[i];
        if (unknown < 0) continue;
        run->rhs[unknown] = (f.of[0] - rest) * a[i];
        for (int k = 1; k < f.n; ++k) run->rhs[unknown] += f.of[k] * past->accelerations[k - 1][i];
    }
    fu_spread(model, run->rhs, run->work);
    for (int i = 0; i < model->n_dof; ++i) run->next.a[i] = rest * a[i] + run->work[i];
}

static void predict_forces(const fu_extrapolation *past, fu_run *run, factors f)
{
    const double *now = run->now.forces;
    for (int i = 0; i < run->model->n_forces; ++i) {
        if (now[i] == past->forces[0][i]) continue;
        run->next.forces[i] = f.of[0] * now[i];
        for (int k = 1; k < f.n; ++k) run->next.forces[i] += f.of[k] * past->forces[k - 1][i];
    }
}

/* Makes the couplings' coordinates of a first `next`: their changes, so that large ones lose no digits. */
static void predict_coordinates(const fu_extrapolation *past, fu_run *run, factors f)
{
    const double *now = run->now.s;
    for (int i = 0; i < run->model->n_coordinates; ++i) {
        run->next.s[i] = now[i];
        for (int k = 1; k < f.n; ++k) run->next.s[i] += f.of[k] * (past->coordinates[k - 1][i] - now[i]);
    }
}

/* Makes a first `next`: its accelerations, and the couplings' own coordinates and forces. */
void fu_extrapolate(const fu_extrapolation *past, fu_run *run, fu_own_motion own, double h)
{
    const fu_last_steps *last = past->last;
    way by = ways[(int)last->way];
    if (!is_possible(last, by, h)) by.alternating = 0;
    const factors f = factors_of(last, by, own, h);
    predict_accelerations(past, run, f, own.rest);
    fu_predict_own(run, h);
    if (!by.points) return;
    if (last->steps > 0.0) predict_forces(past, run, f);
    by.points += 2;
    if (!is_possible(last, by, h)) return;
    predict_coordinates(past, run, factors_of(last, by, own, h));
}

/* Returns the sum of squares of what the prediction of the unknowns' `next` was off by. */
static double miss(const fu_extrapolation *past, const fu_run *run, factors f)
{
    const double *weight = past->weight, *now = run->now.a, *next = run->next.a;
    double *restrict off = run->work, sum[SUMS] = {0.0};
    const int n = run->model->n_dof;
    for (int i = 0; i < n; ++i) off[i] = next[i] - f.of[0] * now[i];
    for (int k = 1; k < f.n; ++k) {
        const double *before = past->accelerations[k - 1];
        for (int i = 0; i < n; ++i) off[i] -= f.of[k] * before[i];
    }
    for (int i = 0; i < n; ++i) off[i] *= weight[i];
    for (int i = 0; i < n; ++i) sum[i % SUMS] += off[i] * off[i];
    return sum[0] + sum[1] + sum[2] + sum[3];
}

/* Returns the way that would have predicted the last steps best, the one of size h just made among them. */
static int best_way(const fu_extrapolation *past, const fu_run *run, fu_own_motion own, double h)
{
    fu_last_steps *last = past->last;
    int best = BY_VELOCITIES;
    for (int k = 0; k < FU_WAYS; ++k) {
        double *missed = &last->missed[k];
        if (!is_possible(last, ways[k], h)) {
            *missed = 0.0;
            continue;
        }
        const double now = miss(past, run, factors_of(last, ways[k], own, h));
        *missed = *missed > 0.0 ? MEMORY * *missed + (1.0 - MEMORY) * now : now;
        if (*missed < last->missed[best]) best = k;
    }
    return best;
}

/* Puts n numbers first in a list of arrays, of which the last one is dropped. */
static void put_first(double *const *list, int arrays, const double *numbers, int n)
{
    const size_t size = sizeof(double) * (size_t)n;
    for (int k = arrays - 1; k > 0; --k) memcpy(list[k], list[k - 1], size);
    memcpy(list[0], numbers, size);
}

/* Takes the step just made from `now` to `next`, and chooses how the one to come is predicted. */
void fu_extrapolation_accept(const fu_extrapolation *past, const fu_run *run, fu_own_motion own, double h)
{
    const fu_model *model = run->model;
    fu_last_steps *last = past->last;
    last->way = best_way(past, run, own, h);
    put_first(past->accelerations, FU_PAST, run->now.a, model->n_dof);
    put_first(past->forces, FU_PAST, run->now.forces, model->n_forces);
    put_first(past->coordinates, FU_LONGER_PAST, run->now.s, model->n_coordinates);
    last->equal = equal_steps(last, h);
    for (int k = FU_LONGER_PAST - 1; k > 0; --k) last->h[k] = last->h[k - 1];
    last->h[0] = h;
    last->steps += 1.0;
}
