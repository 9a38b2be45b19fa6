/* Prediction of a step from the steps before. Accelerations are those of what a step resolves, which a polynomial
 * through the last steps predicts, and of vibrations that it does not, which none predicts. So the next step is predicted
 * by the polynomial, of degree 0 to 2, that would have predicted the last one best; or, where velocities alone would have
 * been better, by `rest` times the last acceleration, with which the integrator goes on with its velocities.
 */
#include "engine.h"

#include "extrapolation.h"
#include "workspace.h"

#include <math.h>
#include <string.h>

enum { BY_VELOCITIES = -1, MOST_DEGREE = 2 };

/* Places the arrays in a work space; only counts them where it is null. */
void fu_extrapolation_take(fu_extrapolation *past, const fu_model *model, double *scratch, long *taken)
{
    past->before = fu_take(scratch, taken, model->n_dof);
    past->earlier = fu_take(scratch, taken, model->n_dof);
    past->slope = fu_take(scratch, taken, model->n_coordinates);
    past->slope_before = fu_take(scratch, taken, model->n_coordinates);
}

/* Begins where nothing is known of the past. */
void fu_extrapolation_start(fu_extrapolation *past)
{
    past->steps = 0;
    past->degree = BY_VELOCITIES;
    past->h = past->h_before = 0.0;
}

/* Factors by which a prediction has the accelerations at `now` and of the two steps before. */
typedef struct {
    double now, before, earlier;
} factors;

static factors factors_of(const fu_extrapolation *past, int degree, double rest, double h)
{
    if (degree == BY_VELOCITIES) return (factors){rest, 0.0, 0.0};
    if (degree == 0) return (factors){1.0, 0.0, 0.0};
    const double first = h / past->h;
    if (degree == 1) return (factors){1.0 + first, -first, 0.0};
    const double second = h * (h + past->h) / (past->h + past->h_before), last = second / past->h_before;
    const double both = second / past->h;
    return (factors){1.0 + first + both, -first - both - last, last};
}

static double predicted(const fu_extrapolation *past, factors f, const double *a, int i)
{
    return f.now * a[i] + f.before * past->before[i] + f.earlier * past->earlier[i];
}

/* Makes a first `next`: its accelerations, and the couplings' own coordinates, which are those of a parabola. */
void fu_extrapolate(const fu_extrapolation *past, fu_run *run, double rest, double h)
{
    const factors f = factors_of(past, past->degree, rest, h);
    for (int i = 0; i < run->model->n_dof; ++i) run->next.a[i] = predicted(past, f, run->now.a, i);
    fu_predict_own(run, h);
    if (past->steps < 2) return;
    const double bend = h * (h + past->h) / (past->h + past->h_before);
    for (int i = 0; i < run->model->n_coordinates; ++i)
        run->next.s[i] += bend * (past->slope[i] - past->slope_before[i]);
}

/* Returns the sum of squares of what the prediction of `next` was off by. */
static double miss(const fu_extrapolation *past, const fu_run *run, factors f)
{
    const double *weight = run->model->weight;
    double sum = 0.0;
    for (int i = 0; i < run->model->n_dof; ++i) {
        const double d = weight[i] * (run->next.a[i] - predicted(past, f, run->now.a, i));
        sum += d * d;
    }
    return sum;
}

/* Takes the step just made from `now` to `next`, and chooses how the one to come is predicted. */
void fu_extrapolation_accept(fu_extrapolation *past, const fu_run *run, double rest, double h)
{
    const fu_model *model = run->model;
    double least = INFINITY;
    past->degree = BY_VELOCITIES;
    for (int degree = BY_VELOCITIES; degree <= MOST_DEGREE && degree <= past->steps; ++degree) {
        const double sum = miss(past, run, factors_of(past, degree, rest, h));
        if (!(sum < least)) continue;
        least = sum;
        past->degree = degree;
    }
    double *spare = past->earlier;
    past->earlier = past->before;
    past->before = spare;
    memcpy(past->before, run->now.a, sizeof(double) * (size_t)model->n_dof);
    spare = past->slope_before;
    past->slope_before = past->slope;
    past->slope = spare;
    memcpy(past->slope, run->s_slope, sizeof(double) * (size_t)model->n_coordinates);
    past->h_before = past->h;
    past->h = h;
    ++past->steps;
}
