/* The velocity of a fluid by position and time, with its derivatives: a velocity times a profile over height, or a
 * table of splines, times a signal. */
#include "bodies/model.h"
#include "couplings/fluid/drag.h"

#include <math.h>
#include <string.h>

/* Returns the factor of a profile at a height, and its derivative. */
static double profile_at(const fu_flow *flow, double height, double *slope)
{
    *slope = 0.0;
    if (flow->profile == FU_TABLE) {
        const fu_signal table = {flow->n_segments, flow->breaks, flow->coefficients, 0.0, 0.0, 0.0};
        return fu_signal_at(&table, height, slope, 0);
    }
    if (flow->profile == FU_UNIFORM) return 1.0;
    const double h = fmax(height, flow->least), factor = pow(h / flow->reference, flow->exponent);
    if (height > flow->least) *slope = flow->exponent * factor / h;
    return factor;
}

/* The nonzero B-splines at a point of an axis: the number of the first, their values and derivatives. */
typedef struct {
    int first, n;
    double value[FU_FLOW_DEGREE + 1], slope[FU_FLOW_DEGREE + 1];
} splines;

/* Computes the nonzero ones of n splines with these knots (de Boor's recursion; derivatives from the splines of one
 * degree less). Values are constant beyond the ends of the axis. */
static splines splines_at(int degree, int n, const double *knots, double x)
{
    splines out = {0, 1, {1.0}, {0.0}};
    if (n == 1) return out;
    const double low = knots[degree], high = knots[n], at = fmin(fmax(x, low), high);
    const int left = fu_last_reached(
        knots, degree, n, at); /* knots[left] <= at < knots[left + 1]; at the end of the axis at = knots[left + 1] */
    out.first = left - degree;
    out.n = degree + 1;
    for (int k = 1; k <= degree; ++k) {
        double lower[FU_FLOW_DEGREE + 1], saved = 0.0, before = 0.0;
        memcpy(lower, out.value, sizeof lower);
        for (int j = 0; j < k; ++j) {
            const double from = knots[left + 1 - k + j], to = knots[left + 1 + j];
            const double part = lower[j] / (to - from);
            out.value[j] = saved + (to - at) * part;
            out.slope[j] = k * (before - part);
            saved = (at - from) * part;
            before = part;
        }
        out.value[k] = saved;
        out.slope[k] = k * before;
    }
    if (x < low || x > high) memset(out.slope, 0, sizeof out.slope);
    return out;
}

/* Computes the coordinates of a point on the axes of a table: time, and three directions of the ground. */
static void place_in_table(const fu_model *model, const fu_flow *flow, double t, const double *r,
                           double x[FU_FLOW_AXES])
{
    x[0] = t;
    for (int i = 0; i < 3; ++i) x[i + 1] = flow->origin[i] + fu_dot(model->dim, flow->axes + 3 * i, r);
}

/* Computes the velocity of a table and its derivatives, without the signal. */
static void table_at(const fu_model *model, const fu_flow *flow, double t, const double *r, fu_flow_state *out)
{
    const int dim = model->dim, *n = flow->n_splines;
    const double *knots = flow->knots;
    double x[FU_FLOW_AXES], by_ground[9] = {0.0};
    splines of[FU_FLOW_AXES];
    place_in_table(model, flow, t, r, x);
    for (int k = 0; k < FU_FLOW_AXES; ++k) {
        of[k] = splines_at(flow->degree, n[k], knots, x[k]);
        if (n[k] > 1) knots += n[k] + flow->degree + 1;
    }
    memset(out, 0, sizeof *out);
    for (int a = 0; a < of[0].n; ++a)
        for (int b = 0; b < of[1].n; ++b)
            for (int c = 0; c < of[2].n; ++c)
                for (int d = 0; d < of[3].n; ++d) {
                    const long at =
                        (((long)(of[0].first + a) * n[1] + of[1].first + b) * n[2] + of[2].first + c) * n[3] +
                        of[3].first + d;
                    const double *U = flow->table + at * dim, ab = of[0].value[a] * of[1].value[b];
                    const double cd = of[2].value[c] * of[3].value[d];
                    const double by[FU_FLOW_AXES] = {
                        of[0].slope[a] * of[1].value[b] * cd, of[0].value[a] * of[1].slope[b] * cd,
                        ab * of[2].slope[c] * of[3].value[d], ab * of[2].value[c] * of[3].slope[d]};
                    for (int i = 0; i < dim; ++i) {
                        out->U[i] += ab * cd * U[i];
                        out->rate[i] += by[0] * U[i];
                        for (int j = 0; j < 3; ++j) by_ground[i * 3 + j] += by[j + 1] * U[i];
                    }
                }
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
            for (int k = 0; k < 3; ++k) out->gradient[i * dim + j] += by_ground[i * 3 + k] * flow->axes[k * 3 + j];
}

void fu_current_at(const fu_model *model, const fu_flow *flow, double t, const double *r, fu_flow_state *out)
{
    const int dim = model->dim;
    double rate = 0.0, slope;
    const double signal = flow->signal < 0 ? 1.0 : fu_signal_at(&model->signals[flow->signal], t, &rate, 0);
    if (flow->degree) {
        table_at(model, flow, t, r, out);
        for (int i = 0; i < dim; ++i) out->rate[i] = signal * out->rate[i] + rate * out->U[i];
        for (int i = 0; i < dim; ++i) out->U[i] *= signal;
        for (int i = 0; i < dim * dim; ++i) out->gradient[i] *= signal;
        return;
    }
    const double factor = profile_at(flow, flow->base + fu_dot(dim, flow->up, r), &slope);
    for (int i = 0; i < dim; ++i) {
        out->U[i] = signal * factor * flow->velocity[i];
        out->rate[i] = rate * factor * flow->velocity[i];
        for (int j = 0; j < dim; ++j) out->gradient[i * dim + j] = signal * slope * flow->velocity[i] * flow->up[j];
    }
}

/* Returns the distance of a point and time within the edges of a table, relative to its axes: negative outside, 1
 * without a table. */
double fu_flow_margin(const fu_model *model, const fu_flow *flow, double t, const double *r)
{
    const double *knots = flow->knots;
    double x[FU_FLOW_AXES], least = 1.0;
    if (!flow->degree) return least;
    place_in_table(model, flow, t, r, x);
    for (int k = 0; k < FU_FLOW_AXES; ++k) {
        const int n = flow->n_splines[k];
        if (n == 1) continue;
        const double low = knots[flow->degree], high = knots[n];
        least = fmin(least, fmin(x[k] - low, high - x[k]) / (high - low));
        knots += n + flow->degree + 1;
    }
    return least;
}
