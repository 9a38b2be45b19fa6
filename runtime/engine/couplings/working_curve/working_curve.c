/* Working curves of ropes: below the highest strain of a point its force departs from that of first loading, which is
 * the law of the cable (derive/couplings/working_curve.py).
 *
 * Within a step the highest strain is that at its beginning, or the strain at the state where this is larger. Memory is
 * in the highest strain alone: force, stored energy and loss are functions of it and of the strain. */
#include "couplings/working_curve/working_curve.h"
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/accelerator.h"
#include "couplings/common/attachments.h"

#include <math.h>
#include <string.h>

enum { POINTS = FU_WORKING_CURVE_POINTS };

static const fu_working_curve *of(const fu_coupling *coupling)
{
    return (const fu_working_curve *)coupling;
}

static double *highest_of(const fu_working_curve *curve, const fu_state *state)
{
    return state->numbers + curve->base.numbers;
}

/* Computes the slope at a point, or its rate, of the vectors of the element or their rates. */
static void slope_at(const fu_model *model, const fu_working_curve *curve, int k, const double *q, double *a)
{
    const fu_cable *cable = &model->cables[curve->cable];
    const int dim = model->dim, all = cable->coordinates;
    fu_interpolate(dim, all, curve->N_x + k * (all / dim), q + fu_element_entry(cable, curve->element), a);
}

/* A point at a state: slope, strain, the highest strain with this one; the change of the force, its derivative, and the
 * change of the energy per length. */
typedef struct {
    double a[3], strain, highest, n, D, U;
} curve_point;

/* Computes the change at a strain below the highest one; first loading has none. */
static void change_at(const fu_working_curve *curve, double strain, double highest, curve_point *at)
{
    at->n = at->D = at->U = 0.0;
    if (highest > 0.0)
        curve->kernel->change(strain, highest, curve->permanent, curve->first, curve->shape, &at->n, &at->D, &at->U);
}

/* Returns the energy per length that a point has lost up to a highest strain, J/m. */
static double lost_at(const fu_working_curve *curve, double highest)
{
    curve_point at;
    change_at(curve, highest, highest, &at);
    return -at.U;
}

static void point_at(const fu_model *model, const fu_working_curve *curve, const fu_state *state, int k,
                     curve_point *at)
{
    const double before = highest_of(curve, state)[k];
    slope_at(model, curve, k, state->q, at->a);
    curve->kernel->measure(at->a, &at->strain);
    at->highest = fmax(before, at->strain);
    change_at(curve, at->strain, at->highest, at);
    /* small vibrations about a state of first loading follow its working curve: the strain is then the highest one */
    if (at->strain > before && !model->vibrates) at->D = 0.0;
    if (at->strain > before) at->n = 0.0;
    if (at->strain > before && !curve->remembers) at->U = -lost_at(curve, before);
}

static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    const fu_working_curve *curve = of(coupling);
    const fu_cable *cable = &model->cables[curve->cable];
    const int dim = model->dim, n = cable->coordinates / dim;
    double g[3], *to = f + fu_element_entry(cable, curve->element);
    for (int k = 0; k < POINTS; ++k) {
        curve_point at;
        point_at(model, curve, state, k, &at);
        if (at.n == 0.0) continue;
        curve->kernel->force(at.a, at.n, g);
        for (int v = 0; v < n; ++v)
            for (int d = 0; d < dim; ++d) to[v * dim + d] += curve->weights[k] * curve->N_x[k * n + v] * g[d];
    }
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                     double *internal)
{
    (void)internal;
    force(model, coupling, at->next, f);
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    const fu_working_curve *curve = of(coupling);
    const fu_cable *cable = &model->cables[curve->cable];
    const int dim = model->dim, all = cable->coordinates, n = all / dim;
    double block[9], K[FU_MAX_COORDINATES * FU_MAX_COORDINATES] = {0.0};
    for (int k = 0; k < POINTS; ++k) {
        const double *shapes = curve->N_x + k * n;
        curve_point point;
        point_at(model, curve, at->next, k, &point);
        curve->kernel->tangent(point.a, point.n, point.D, block);
        fu_add_element_product(dim, all, at->weights.stiffness * curve->weights[k], shapes, shapes, block, K);
    }
    fu_add_element_matrix(model, fu_element_entry(cable, curve->element), all, K, system);
}

/* --- history and energies --------------------------------------------------------------------------------------- */

static void reset(const fu_coupling *coupling, fu_state *state)
{
    memcpy(highest_of(of(coupling), state), of(coupling)->highest, sizeof(double[FU_WORKING_CURVE_POINTS]));
}

static void update_history(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    const fu_working_curve *curve = of(coupling);
    for (int k = 0; k < POINTS && curve->remembers; ++k) {
        curve_point at;
        point_at(model, curve, state, k, &at);
        highest_of(curve, state)[k] = at.highest;
    }
}

static double energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_working_curve *curve = of(coupling);
    double sum = 0.0;
    for (int k = 0; k < POINTS; ++k) {
        curve_point at;
        point_at(model, curve, state, k, &at);
        sum += curve->weights[k] * at.U;
    }
    return sum;
}

static double lost_in_step(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                           int by_ends)
{
    const fu_working_curve *curve = of(coupling);
    double sum = 0.0;
    (void)by_ends;
    for (int k = 0; k < POINTS && curve->remembers; ++k) {
        const double before = highest_of(curve, from)[k];
        curve_point at;
        point_at(model, curve, to, k, &at);
        if (at.strain > before) sum += curve->weights[k] * (lost_at(curve, at.strain) - lost_at(curve, before));
    }
    return sum;
}

static double rate_at(const fu_model *model, const fu_working_curve *curve, const fu_state *state, int k)
{
    double a[3], moving[3], along[3];
    slope_at(model, curve, k, state->q, a);
    slope_at(model, curve, k, state->v, moving);
    curve->kernel->force(a, 1.0, along);
    return fu_dot(model->dim, along, moving);
}

/* The error of the highest strain, as a displacement over the element: a maximum within the step, of the parabola by
 * the rates at its ends. */
static double history_error(const fu_model *model, const fu_coupling *coupling, const fu_state *from,
                            const fu_state *to)
{
    const fu_working_curve *curve = of(coupling);
    const double h = to->t - from->t, length = fu_element_length(&model->cables[curve->cable], curve->element);
    double largest = 0.0;
    for (int k = 0; k < POINTS; ++k) {
        const double rise = rate_at(model, curve, from, k), fall = -rate_at(model, curve, to, k);
        if (!(rise > 0.0 && fall > 0.0)) continue;
        curve_point before, after;
        point_at(model, curve, from, k, &before);
        point_at(model, curve, to, k, &after);
        const double least = fmin(rise, fall), above = 0.5 * h * least * least / (rise + fall);
        largest = fmax(largest, length * fmin(above, fmax(before.strain, after.strain) + above - before.highest));
    }
    return largest;
}

/* --- results ----------------------------------------------------------------------------------------------------- */

/* Of each point: the axial force of the rope, its strain, and the highest one. */
typedef struct {
    double tension[FU_WORKING_CURVE_POINTS], strain[FU_WORKING_CURVE_POINTS], highest_strain[FU_WORKING_CURVE_POINTS];
} fu_working_curve_output;

static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    fu_working_curve_output *numbers = (fu_working_curve_output *)out;
    (void)acceleration, (void)work;
    for (int k = 0; k < POINTS; ++k) {
        curve_point at;
        point_at(model, of(coupling), state, k, &at);
        numbers->tension[k] = fu_cubic_value(of(coupling)->first, at.strain) + at.n;
        numbers->strain[k] = at.strain;
        numbers->highest_strain[k] = at.highest;
    }
}

static const char *const role[] = {"working_curve", 0};
static const fu_field fields[] = {
    FU_FIELD(fu_working_curve, kernel, FU_KERNELS, role),
    FU_FIELD(fu_working_curve, cable, FU_INTEGER, 0),
    FU_FIELD(fu_working_curve, element, FU_INTEGER, 0),
    FU_FIELD(fu_working_curve, remembers, FU_INTEGER, 0),
    FU_FIELD(fu_working_curve, permanent, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_working_curve, highest, FU_REAL),
    FU_FIELD_ARRAY(fu_working_curve, weights, FU_REAL),
    FU_FIELD(fu_working_curve, N_x, FU_REALS, 0),
    FU_FIELD(fu_working_curve, first, FU_REALS, 0),
    FU_FIELD(fu_working_curve, shape, FU_REALS, 0),
    {0},
};

static const fu_start_operations start = {.reset = reset};
static const fu_history_operations history = {.update = update_history, .error = history_error};

static const fu_output output_fields[] = {
    FU_OUTPUT(fu_working_curve_output, tension, "N", NULL),
    FU_OUTPUT(fu_working_curve_output, strain, "1", NULL),
    FU_OUTPUT(fu_working_curve_output, highest_strain, "1", NULL),
    FU_LAST_OUTPUT(fu_working_curve_output),
};

const fu_coupling_type fu_working_curve_type = {
    .name = "working_curve",
    .size = sizeof(fu_working_curve),
    .fields = fields,
    .output_fields = output_fields,
    .n_numbers = FU_WORKING_CURVE_POINTS,
    .residual = residual,
    .tangent = tangent,
    .force = force,
    .energy = energy,
    .lost_in_step = lost_in_step,
    .outputs = outputs,
    .history = &history,
    .start = &start,
};
