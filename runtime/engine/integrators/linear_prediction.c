/* Linear prediction: the second difference of accelerations in the next step is a sum of those in the last steps,
 *
 *   d_n+1 = c_1 d_n + ... + c_8 d_n-7,   d_n = a_n - 2 a_n-1 + a_n-2
 *
 * with the factors c of least squares over the last steps and all unknowns (Makhoul, Proc. IEEE 63 (1975) 561-580). A vibration has
 * two such factors whatever its frequency, resolved or not, and a damping that the integrator may give it; so four vibrations are
 * predicted, or fewer and what polynomials of a higher degree predict. It needs steps of one size. Products of the
 * newest difference with those before are all that a step adds.
 */
#include "engine.h"

#include "linear_prediction.h"
#include "newton.h"
#include "workspace.h"

#include <math.h>
#include <string.h>

#define MEMORY 0.7        /* of the sums, with each step */
#define UNKNOWN 1e300     /* more than any sum of squares, but a number: checkpoints hold it */
#define LEAST_PIVOT 1e-13 /* of a difference's sum of squares: what is left of it by those after it is rounding below this */

enum { SUMS = 4 }; /* at a time */

/* Places the arrays in a work space; only counts them where it is null. */
void fu_linear_prediction_take(fu_linear_prediction *by, const fu_model *model, double *scratch, long *taken)
{
    by->n = model->n_dof + model->n_forces + model->n_coordinates;
    by->last = fu_take(scratch, taken, by->n);
    by->before = fu_take(scratch, taken, by->n);
    by->next = fu_take(scratch, taken, by->n);
    for (int k = 0; k <= FU_BENDS; ++k) by->bends[k] = fu_take(scratch, taken, by->n);
    by->weight = fu_take(scratch, taken, model->n_dof);
    by->known = (fu_known_steps *)fu_take(scratch, taken, FU_DOUBLES(1, fu_known_steps));
}

/* Begins where nothing is known of the past. */
void fu_linear_prediction_start(const fu_linear_prediction *by, const fu_model *model)
{
    *by->known = (fu_known_steps){.missed = UNKNOWN};
    for (int i = 0; i < model->n_dof; ++i)
        by->weight[i] = model->unknown_of_dof[i] >= 0 ? model->weight[i] * model->weight[i] : 0.0;
}

/* Returns the second differences of k steps before the last one. */
static double *bend(const fu_linear_prediction *by, int k)
{
    return by->bends[((int)by->known->newest + FU_BENDS + 1 - k) % (FU_BENDS + 1)];
}

/* Makes by->next, what is predicted for a step of size h; returns whether it is known how. */
int fu_linear_prediction_make(const fu_linear_prediction *by, double h)
{
    const fu_known_steps *known = by->known;
    if (known->order < 1.0 || fabs(h - known->h) > FU_SAME_STEP * h) return 0;
    double *restrict next = by->next;
    for (int i = 0; i < by->n; ++i) next[i] = 2.0 * by->last[i] - by->before[i];
    for (int k = 0; k < (int)known->order; ++k) {
        const double factor = known->factors[k], *d = bend(by, k);
        for (int i = 0; i < by->n; ++i) next[i] += factor * d[i];
    }
    return 1;
}

/* Takes the values of the step just made, and makes their second differences. */
static void take_values(const fu_linear_prediction *by, const fu_run *run, const double *slope_before)
{
    const fu_model *model = run->model;
    fu_known_steps *known = by->known;
    double *restrict value = by->next, *forces = value + model->n_dof, *changes = forces + model->n_forces;
    memcpy(value, run->next.a, sizeof(double) * (size_t)model->n_dof);
    memcpy(forces, run->next.forces, sizeof(double) * (size_t)model->n_forces);
    for (int i = 0; i < model->n_coordinates; ++i) changes[i] = run->s_slope[i] - slope_before[i];
    known->newest = ((int)known->newest + 1) % (FU_BENDS + 1);
    double *restrict newest = bend(by, 0);
    for (int i = 0; i < by->n; ++i) newest[i] = value[i] - 2.0 * by->last[i] + by->before[i];
    memcpy(by->before, by->last, sizeof(double) * (size_t)by->n);
    memcpy(by->last, value, sizeof(double) * (size_t)by->n);
}

static double product(int n, const double *x, const double *y)
{
    double sum[SUMS] = {0.0};
    int i = 0;
    for (; i + SUMS <= n; i += SUMS)
        for (int k = 0; k < SUMS; ++k) sum[k] += x[i + k] * y[i + k];
    for (; i < n; ++i) sum[0] += x[i] * y[i];
    return sum[0] + sum[1] + (sum[2] + sum[3]);
}

/* Adds the products of the newest differences to the sums, after what the factors were off by there. */
static void take_products(const fu_linear_prediction *by, const fu_run *run, int bends)
{
    fu_known_steps *known = by->known;
    const int n = run->model->n_dof;
    for (int i = FU_BENDS; i > 0; --i)
        for (int j = FU_BENDS; j > 0; --j) known->products[i][j] = known->products[i - 1][j - 1];
    const double *newest = bend(by, 0);
    for (int i = 0; i < n; ++i) run->work[i] = by->weight[i] * newest[i];
    for (int k = 0; k <= FU_BENDS; ++k)
        known->products[0][k] = known->products[k][0] = k < bends ? product(n, run->work, bend(by, k)) : 0.0;
    double off[FU_BENDS + 1] = {1.0}, missed = 0.0;
    for (int k = 0; k < (int)known->order; ++k) off[k + 1] = -known->factors[k];
    for (int i = 0; i <= (int)known->order; ++i) missed += off[i] * product((int)known->order + 1, off, known->products[i]);
    known->missed = known->order < 1.0 ? UNKNOWN : fmax(0.0, missed);
    for (int i = 0; i <= FU_BENDS; ++i)
        for (int j = 0; j <= FU_BENDS; ++j) known->sums[i][j] = MEMORY * known->sums[i][j] + known->products[i][j];
}

/* Makes the factors of so many differences at most: as many as the sums tell apart. */
static void fit(fu_known_steps *known, int most)
{
    double L[FU_BENDS][FU_BENDS], x[FU_BENDS], scale[FU_BENDS];
    int n = 0;
    for (; n < most; ++n) {
        const double square = known->sums[n + 1][n + 1];
        if (!(square > 0.0)) break;
        scale[n] = 1.0 / sqrt(square);
        for (int j = 0; j <= n; ++j) {
            double sum = known->sums[n + 1][j + 1] * scale[n] * scale[j];
            for (int k = 0; k < j; ++k) sum -= L[n][k] * L[j][k];
            L[n][j] = j < n ? sum / L[j][j] : sum;
        }
        if (!(L[n][n] > LEAST_PIVOT)) break;
        L[n][n] = sqrt(L[n][n]);
        x[n] = known->sums[0][n + 1] * scale[n];
        for (int k = 0; k < n; ++k) x[n] -= L[n][k] * x[k];
        x[n] /= L[n][n];
    }
    for (int i = n - 1; i >= 0; --i) {
        for (int k = i + 1; k < n; ++k) x[i] -= L[k][i] * x[k];
        x[i] /= L[i][i];
    }
    for (int i = 0; i < n; ++i) known->factors[i] = scale[i] * x[i];
    known->order = n;
}

/* Takes the step of size h just made from `now` to `next`, before which couplings' own coordinates had these slopes. */
void fu_linear_prediction_accept(const fu_linear_prediction *by, const fu_run *run, const double *slope_before, double h)
{
    fu_known_steps *known = by->known;
    if (fabs(h - known->h) > FU_SAME_STEP * h) *known = (fu_known_steps){.h = h, .missed = UNKNOWN};
    take_values(by, run, slope_before);
    known->steps += 1.0;
    const int bends = known->steps < FU_BENDS + 3.0 ? (int)known->steps - 2 : FU_BENDS + 1;
    if (bends < 1) return;
    take_products(by, run, bends);
    fit(known, bends - 1);
}
