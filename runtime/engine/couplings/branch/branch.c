/* Branches beside the elastic law of a cable, that give it memory: a spring in series with a dashpot or with a slider,
 * at two points of an element (derive/couplings/branch.py).
 *
 * The force at a state follows from the history at the end of the last step and the configuration at the state, as if
 * the measures had changed linearly between them: it is implicit in the configuration. A dashpot is relaxed before any
 * step, so that statics has the stiffness of long times. A slider holds from the straight cable on. */
#include "couplings/branch/branch.h"
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/accelerator.h"
#include "couplings/common/attachments.h"
#include "couplings/common/stick_friction.h"

#include <math.h>
#include <string.h>

#define AT_LIMIT (1.0 - 1e-9) /* of the limit: from there on a slider slides */

enum { MEASURES = FU_BRANCH_MEASURES, POINTS = FU_BRANCH_POINTS };

static const fu_branch *of(const fu_coupling *coupling)
{
    return (const fu_branch *)coupling;
}

static fu_branch_history *history_of(const fu_branch *branch, const fu_state *state)
{
    return (fu_branch_history *)(state->numbers + branch->base.numbers);
}

static int measures_of(int dim)
{
    return dim == 3 ? MEASURES : 2;
}

/* Computes slope and its derivative, one after the other, of the vectors of the element, or of their rates. */
static void slopes_at(const fu_model *model, const fu_branch *branch, int k, const double *q, double *ab)
{
    const fu_cable *cable = &model->cables[branch->cable];
    const int dim = model->dim, all = cable->coordinates, at = k * (all / dim);
    const double *e = q + fu_element_entry(cable, branch->element);
    fu_interpolate(dim, all, branch->N_x + at, e, ab);
    fu_interpolate(dim, all, branch->N_xx + at, e, ab + dim);
}

static void unit_tangent(int dim, const double *a, double *i)
{
    const double size = sqrt(fu_dot(dim, a, a));
    for (int d = 0; d < dim; ++d) i[d] = a[d] / size;
}

/* What a dashpot leaves of the elastic part over a time, and the share of a change of the measures in it. */
typedef struct {
    double decay, share;
} relaxation;

static relaxation relaxation_over(const fu_branch *branch, double h)
{
    if (branch->time == 0.0) return (relaxation){1.0, 1.0};
    if (h >= FU_NO_TIME) return (relaxation){0.0, 0.0};
    const double x = h / branch->time;
    return (relaxation){exp(-x), x > 0.0 ? -expm1(-x) / x : 1.0};
}

/* A point at a state: slope and derivative, measures, those at the beginning of the step with their elastic part and
 * the tangent; the stress, its derivatives, and whether a slider slides. */
typedef struct {
    double ab[6], m[MEASURES], n[MEASURES], D[MEASURES * MEASURES];
    fu_branch_mark from;
    int slides;
} branch_point;

static void point_at(const fu_model *model, const fu_branch *branch, const fu_state *state, int k, branch_point *at)
{
    const int count = measures_of(model->dim);
    const fu_branch_history *history = history_of(branch, state);
    const int begun = history->time != FU_NO_TIME;
    slopes_at(model, branch, k, state->q, at->ab);
    at->from = history->marks[k];
    if (!begun) unit_tangent(model->dim, at->ab, at->from.i);
    const relaxation over = relaxation_over(branch, begun ? state->t - history->time : FU_NO_TIME);
    branch->kernel->measures(at->from.i, at->ab, at->ab + model->dim, at->m);
    branch->kernel->hold(at->m, at->from.m, at->from.d, branch->stiffness, over.decay, over.share, at->n, at->D);
    at->slides = branch->time == 0.0 && fu_dot(count, at->n, at->n) > branch->limit * branch->limit;
    if (at->slides)
        branch->kernel->slide(at->m, at->from.m, at->from.d, branch->stiffness, branch->limit, at->n, at->D);
}

/* The elastic part of a measure at a point, at the end of the step; zero for a measure without stiffness. */
static double elastic_part(const fu_branch *branch, const branch_point *at, int i)
{
    return branch->stiffness[i] > 0.0 ? at->n[i] / branch->stiffness[i] : 0.0;
}

static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    const fu_branch *branch = of(coupling);
    const fu_cable *cable = &model->cables[branch->cable];
    const int dim = model->dim, n = cable->coordinates / dim;
    double g[6], *to = f + fu_element_entry(cable, branch->element);
    for (int k = 0; k < POINTS; ++k) {
        branch_point at;
        point_at(model, branch, state, k, &at);
        branch->kernel->force(at.from.i, at.ab, at.ab + dim, at.n, g);
        for (int v = 0; v < n; ++v)
            for (int d = 0; d < dim; ++d)
                to[v * dim + d] +=
                    branch->weights[k] * (branch->N_x[k * n + v] * g[d] + branch->N_xx[k * n + v] * g[dim + d]);
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
    const fu_branch *branch = of(coupling);
    const fu_cable *cable = &model->cables[branch->cable];
    const int dim = model->dim, all = cable->coordinates, n = all / dim;
    double by[36], block[9], K[FU_MAX_COORDINATES * FU_MAX_COORDINATES] = {0.0};
    for (int k = 0; k < POINTS; ++k) {
        branch_point point;
        const double *shapes[] = {branch->N_x + k * n, branch->N_xx + k * n};
        point_at(model, branch, at->next, k, &point);
        branch->kernel->tangent(point.from.i, point.ab, point.ab + dim, point.n, point.D, by);
        for (int row = 0; row < 2; ++row)
            for (int column = 0; column < 2; ++column) {
                for (int i = 0; i < dim; ++i)
                    for (int j = 0; j < dim; ++j) block[i * dim + j] = by[(row * dim + i) * 2 * dim + column * dim + j];
                fu_add_element_product(dim, all, at->weights.stiffness * branch->weights[k], shapes[row],
                                       shapes[column], block, K);
            }
    }
    fu_add_element_matrix(model, fu_element_entry(cable, branch->element), all, K, system);
}

/* --- history and energies --------------------------------------------------------------------------------------- */

static void reset(const fu_coupling *coupling, fu_state *state)
{
    history_of(of(coupling), state)->time = FU_NO_TIME;
}

/* Turns the curvature's elastic part, across the tangent i, with the section to a tangent i_next: the kernel of the
 * measures takes the curvature of r' = i, r'' = d x i. */
static void turn(const fu_branch *branch, const double *i, const double *i_next, double *d)
{
    double second[3], turned[MEASURES];
    fu_cross(d + 1, i, second);
    branch->kernel->measures(i_next, i, second, turned);
    memcpy(d + 1, turned + 1, sizeof(double[3]));
}

static void update_history(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    const fu_branch *branch = of(coupling);
    fu_branch_history *history = history_of(branch, state);
    const int dim = model->dim;
    for (int k = 0; k < POINTS; ++k) {
        branch_point at;
        fu_branch_mark *mark = &history->marks[k];
        point_at(model, branch, state, k, &at);
        unit_tangent(dim, at.ab, mark->i);
        branch->kernel->measures(mark->i, at.ab, at.ab + dim, mark->m);
        for (int i = 0; i < measures_of(dim); ++i) mark->d[i] = elastic_part(branch, &at, i);
        if (dim == 3) turn(branch, at.from.i, mark->i, mark->d);
    }
    history->time = state->t;
}

static double energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_branch *branch = of(coupling);
    double sum = 0.0;
    for (int k = 0; k < POINTS; ++k) {
        branch_point at;
        point_at(model, branch, state, k, &at);
        for (int i = 0; i < measures_of(model->dim); ++i)
            sum += 0.5 * branch->weights[k] * at.n[i] * elastic_part(branch, &at, i);
    }
    return sum;
}

/* Returns the loss at a point in a step of h, J/m. A dashpot takes the work of the stress on the measures less the
 * change of the stored energy: the integral of d over the step is tau times what m changes more than d. A slider takes
 * the stress at the end times the slip. */
static double loss_at(const fu_model *model, const fu_branch *branch, const branch_point *at, double h)
{
    double sum = 0.0;
    for (int i = 0; i < measures_of(model->dim); ++i) {
        const double d = elastic_part(branch, at, i), before = at->from.d[i], change = at->m[i] - at->from.m[i];
        const double slip = change - (d - before);
        if (branch->time == 0.0) sum += at->n[i] * slip;
        else sum += branch->stiffness[i] * (branch->time / h * change * slip - 0.5 * (d - before) * (d + before));
    }
    return sum;
}

static double lost_in_step(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                           int by_ends)
{
    const fu_branch *branch = of(coupling);
    double sum = 0.0;
    (void)by_ends;
    for (int k = 0; k < POINTS; ++k) {
        branch_point at;
        point_at(model, branch, to, k, &at);
        sum += branch->weights[k] * loss_at(model, branch, &at, to->t - from->t);
    }
    return sum;
}

/* Computes the rates of the measures at a point of a state, with the tangent i_0. */
static void rates_at(const fu_model *model, const fu_branch *branch, const fu_state *state, int k, const double *i_0,
                     double *rates)
{
    const int dim = model->dim;
    double ab[6], moving[6], g[6];
    slopes_at(model, branch, k, state->q, ab);
    slopes_at(model, branch, k, state->v, moving);
    for (int i = 0; i < measures_of(dim); ++i) {
        double one[MEASURES] = {0.0};
        one[i] = 1.0;
        branch->kernel->force(i_0, ab, ab + dim, one, g);
        rates[i] = 0.0;
        for (int d = 0; d < 2 * dim; ++d) rates[i] += g[d] * moving[d];
    }
}

/* Returns whether the slider of a point slides in a step, or did at its beginning. */
static int may_slide(const fu_branch *branch, const branch_point *at, int count)
{
    double square = 0.0;
    for (int i = 0; i < count; ++i) square += pow(branch->stiffness[i] * at->from.d[i], 2);
    return at->slides || sqrt(square) >= AT_LIMIT * branch->limit;
}

/* Returns the share of the change of their rates times the step by which measures that change linearly are off: of a
 * dashpot in its elastic part, of a slider that slides at an extreme within the step. */
static double share_of_error(const fu_branch *branch, const branch_point *at, int count, double h)
{
    if (branch->time > 0.0) return fmin(h / (12.0 * branch->time), 0.5);
    return may_slide(branch, at, count) ? 0.125 : 0.0;
}

/* The error of the elastic part, as a displacement over the element. */
static double history_error(const fu_model *model, const fu_coupling *coupling, const fu_state *from,
                            const fu_state *to)
{
    const fu_branch *branch = of(coupling);
    const double h = to->t - from->t, length = fu_element_length(&model->cables[branch->cable], branch->element);
    const int count = measures_of(model->dim);
    double largest = 0.0;
    for (int k = 0; k < POINTS; ++k) {
        branch_point at;
        double before[MEASURES], after[MEASURES];
        point_at(model, branch, to, k, &at);
        const double share = share_of_error(branch, &at, count, h);
        if (share == 0.0) continue;
        rates_at(model, branch, from, k, at.from.i, before);
        rates_at(model, branch, to, k, at.from.i, after);
        for (int i = 0; i < count; ++i) {
            const double bent = i ? length * length : length; /* m by a unit of the measure */
            if (branch->stiffness[i] > 0.0) largest = fmax(largest, bent * share * h * fabs(after[i] - before[i]));
        }
    }
    return largest;
}

/* --- results ----------------------------------------------------------------------------------------------------- */

/* Of each point: the tension, the moment, and whether the slider is at its limit, 1 or 0. */
typedef struct {
    double tension[FU_BRANCH_POINTS], moment[3 * FU_BRANCH_POINTS], sliding[FU_BRANCH_POINTS];
} fu_branch_output;

static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    const fu_branch *branch = of(coupling);
    fu_branch_output *numbers = (fu_branch_output *)out;
    const int count = measures_of(model->dim);
    (void)acceleration, (void)work;
    *numbers = (fu_branch_output){.tension = {0.0}};
    for (int k = 0; k < POINTS; ++k) {
        branch_point at;
        point_at(model, branch, state, k, &at);
        numbers->tension[k] = at.n[0];
        for (int i = 1; i < count; ++i) numbers->moment[3 * k + 3 - count + i] = at.n[i];
        numbers->sliding[k] = branch->time == 0.0 && sqrt(fu_dot(count, at.n, at.n)) >= AT_LIMIT * branch->limit;
    }
}

static const char *const role[] = {"branch", 0};
static const fu_field fields[] = {
    FU_FIELD(fu_branch, kernel, FU_KERNELS, role), FU_FIELD(fu_branch, cable, FU_INTEGER, 0),
    FU_FIELD(fu_branch, element, FU_INTEGER, 0),   FU_FIELD_ARRAY(fu_branch, stiffness, FU_REAL),
    FU_FIELD(fu_branch, time, FU_REAL, 0),         FU_FIELD(fu_branch, limit, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_branch, weights, FU_REAL),   FU_FIELD(fu_branch, N_x, FU_REALS, 0),
    FU_FIELD(fu_branch, N_xx, FU_REALS, 0),        {0},
};

static const fu_start_operations start = {.reset = reset};
static const fu_history_operations history = {.update = update_history, .error = history_error};

static const fu_output output_fields[] = {
    FU_OUTPUT(fu_branch_output, tension, "N", NULL),
    FU_OUTPUT(fu_branch_output, moment, "N m", NULL),
    FU_OUTPUT(fu_branch_output, sliding, "1", NULL),
    FU_LAST_OUTPUT(fu_branch_output),
};

const fu_coupling_type fu_branch_type = {
    .name = "branch",
    .size = sizeof(fu_branch),
    .fields = fields,
    .output_fields = output_fields,
    .n_numbers = FU_BRANCH_NUMBERS,
    .residual = residual,
    .tangent = tangent,
    .force = force,
    .energy = energy,
    .lost_in_step = lost_in_step,
    .outputs = outputs,
    .history = &history,
    .start = &start,
};
