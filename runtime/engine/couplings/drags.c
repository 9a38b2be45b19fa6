/* The force of a fluid on cables and bodies: drag by the square of the velocity of the fluid past them
 * (derive/couplings/drag.py), and buoyancy. Along a cable it is integrated by Gauss quadrature on each element.
 *
 * With the velocity U of the fluid and w = U - v, the power of drag f on what moves at v is f . U - f . w: the fluid gives the first,
 * work from outside, and the second, which is never negative, goes to heat.
 */
#include "engine.h"

#include <math.h>
#include <string.h>

/* Where the fluid acts: a point of a cable's axis, or of a body. r_x only of a cable. */
typedef struct {
    double r[3], r_x[3], v[3];
} place;

/* What it does there: velocity of the fluid and its derivative by height; drag with its derivatives. */
typedef struct {
    double U[3], by_height[3], w[3], f[3], by_slope[9], by_w[9];
} action;

typedef struct {
    double dissipated, external; /* W */
} powers;

/* Returns the factor of a profile at a height, and its derivative. */
static double profile_at(const fu_flow *flow, double height, double *slope)
{
    *slope = 0.0;
    if (flow->profile == FU_TABLE) {
        const fu_signal table = {flow->n_pieces, flow->breaks, flow->coefficients, 0.0, 0.0, 0.0};
        double second;
        return fu_signal_at(&table, height, slope, &second);
    }
    if (flow->profile == FU_UNIFORM) return 1.0;
    const double h = fmax(height, flow->least), factor = pow(h / flow->reference, flow->exponent);
    if (height > flow->least) *slope = flow->exponent * factor / h;
    return factor;
}

/* Makes what the fluid does at a place. */
static void act(const fu_model *model, const fu_drag *drag, double t, const place *at, action *out)
{
    const fu_flow *flow = &drag->flow;
    const int dim = model->dim;
    const double signal = flow->signal < 0 ? 1.0 : fu_signal_at(&model->signals[flow->signal], t, 0, 0);
    double slope;
    const double factor = profile_at(flow, flow->base + fu_dot(dim, flow->up, at->r), &slope);
    for (int d = 0; d < dim; ++d) {
        out->U[d] = signal * factor * flow->velocity[d];
        out->by_height[d] = signal * slope * flow->velocity[d];
        out->w[d] = out->U[d] - at->v[d];
    }
    if (drag->cable >= 0)
        drag->kernel->along_cable(at->r_x, out->w, drag->coefficients, out->f, out->by_slope, out->by_w);
    else
        drag->kernel->on_point(out->w, drag->coefficients, out->f, out->by_w);
}

/* Makes the force of drag and buoyancy, N/m or N: so much of it as of all loads acts. */
static void whole_force(const fu_model *model, const fu_drag *drag, const action *a, double force[3])
{
    for (int d = 0; d < model->dim; ++d) force[d] = model->load_fraction * (a->f[d] + drag->buoyancy[d]);
}

/* Adds to `sum` the powers at a place of this weight. */
static void add_powers(const fu_model *model, const fu_drag *drag, const place *at, const action *a, double weight, powers *sum)
{
    const double part = weight * model->load_fraction;
    sum->dissipated += part * fu_dot(model->dim, a->f, a->w);
    sum->external += part * (fu_dot(model->dim, a->f, a->U) + fu_dot(model->dim, drag->buoyancy, at->v));
}

/* A point of quadrature on an element: its weight in m, shape functions and their slopes. */
typedef struct {
    double weight;
    const double *N, *N_x;
} quadrature_point;

static quadrature_point point_of(const fu_drag *drag, int n, int element, int point)
{
    const long k = (long)element * drag->stride + point;
    return (quadrature_point){drag->weights[k], drag->N + k * n, drag->N_x + k * n};
}

/* Makes the place of a point of quadrature on an element with the coordinates e and rates v. */
static void place_on_axis(const fu_model *model, const fu_drag *drag, const double *e, const double *v, quadrature_point point,
                          place *at)
{
    const fu_cable *cable = &model->cables[drag->cable];
    const int dim = model->dim, n = cable->coordinates / dim;
    const double *N = point.N, *N_x = point.N_x;
    memset(at, 0, sizeof *at);
    for (int k = 0; k < n; ++k)
        for (int d = 0; d < dim; ++d) {
            /* from the first node: slopes do not see where that is, and no digits are lost far from the origin */
            const double local = e[k * dim + d] - (k % cable->kernel->vectors == 0 ? e[d] : 0.0);
            at->r[d] += N[k] * e[k * dim + d];
            at->r_x[d] += N_x[k] * local;
            at->v[d] += N[k] * v[k * dim + d];
        }
}

/* Adds what acts on a cable to the left of the equations of motion, f, its powers and its sum to the others; each may be null. */
static void on_cable(const fu_model *model, const fu_drag *drag, double t, const double *q, const double *v, double *f,
                     powers *power, double total[3])
{
    const fu_cable *cable = &model->cables[drag->cable];
    const int dim = model->dim, n = cable->coordinates / dim;
    for (int e = 0; e < cable->n_elements; ++e) {
        const int first = cable->first + e * cable->per_node;
        for (int g = 0; g < drag->n_points; ++g) {
            place at;
            action a;
            double force[3];
            const quadrature_point point = point_of(drag, n, e, g);
            place_on_axis(model, drag, q + first, v + first, point, &at);
            act(model, drag, t, &at, &a);
            whole_force(model, drag, &a, force);
            if (power) add_powers(model, drag, &at, &a, point.weight, power);
            for (int d = 0; d < dim; ++d) {
                const double part = point.weight * force[d];
                if (total) total[d] += part;
                for (int k = 0; f && k < n; ++k) f[first + k * dim + d] -= point.N[k] * part;
            }
        }
    }
}

/* Adds the derivatives of the same to a system. */
static void matrix_of_cable(const fu_model *model, const fu_drag *drag, const fu_state *state, fu_weights weights,
                            fu_system *system)
{
    const fu_cable *cable = &model->cables[drag->cable];
    const int dim = model->dim, n = cable->coordinates / dim, all = cable->coordinates;
    double K[FU_MAX_COORDINATES * FU_MAX_COORDINATES];
    for (int e = 0; e < cable->n_elements; ++e) {
        const int first = cable->first + e * cable->per_node;
        memset(K, 0, sizeof(double) * (size_t)(all * all));
        for (int g = 0; g < drag->n_points; ++g) {
            const quadrature_point point = point_of(drag, n, e, g);
            const double *N = point.N, *N_x = point.N_x;
            const double scale = -weights.stiffness * model->load_fraction * point.weight;
            place at;
            action a;
            place_on_axis(model, drag, state->q + first, state->v + first, point, &at);
            act(model, drag, state->t, &at, &a);
            for (int i = 0; i < dim; ++i) {
                const double by_height = fu_dot(dim, a.by_w + i * dim, a.by_height);
                for (int j = 0; j < dim; ++j) {
                    const double by_r = by_height * drag->flow.up[j] - weights.rate * a.by_w[i * dim + j];
                    for (int k = 0; k < n; ++k)
                        for (int l = 0; l < n; ++l)
                            K[(k * dim + i) * all + l * dim + j] +=
                                scale * N[k] * (a.by_slope[i * dim + j] * N_x[l] + by_r * N[l]);
                }
            }
        }
        for (int i = 0; i < all; ++i)
            for (int j = 0; j < all; ++j)
                if (K[i * all + j] != 0.0) fu_add(model, system, first + i, first + j, K[i * all + j]);
    }
}

/* Makes the place of a body's point, and how the point moves with the coordinates; over a step that conserves energy, the place in
 * its middle, with the velocity that the step has on average. */
static void place_on_body(const fu_model *model, const fu_drag *drag, const fu_state *state, const fu_equations *step, place *at,
                          fu_attachment_state *end)
{
    const fu_attachment *on = &drag->attachments[0];
    memset(at, 0, sizeof *at);
    fu_attachment_at(model, on, step ? step->now : state, 0.0, FU_POINT, end);
    memcpy(at->r, end->p, sizeof at->r);
    memcpy(at->v, end->v, sizeof at->v);
    if (!step) return;
    const fu_body *body = &model->bodies[on->body];
    fu_attachment_state after;
    fu_attachment_at(model, on, step->next, 0.0, FU_POINT, &after);
    for (int d = 0; d < model->dim; ++d) {
        at->r[d] = 0.5 * (end->p[d] + after.p[d]);
        at->v[d] = (after.p[d] - end->p[d]) / step->h;
    }
    body->kernel->discrete_point(step->now->q + body->configuration, on->u, step->next->q + body->configuration, end->P);
}

/* Does for a body what on_cable does for a cable. */
static void on_body(const fu_model *model, const fu_drag *drag, double t, const fu_state *state, const fu_equations *step, double *f,
                    powers *power, double total[3])
{
    fu_attachment_state end;
    place at;
    action a;
    double force[3];
    place_on_body(model, drag, state, step, &at, &end);
    act(model, drag, t, &at, &a);
    whole_force(model, drag, &a, force);
    if (power) add_powers(model, drag, &at, &a, 1.0, power);
    for (int d = 0; d < model->dim; ++d) {
        if (total) total[d] += force[d];
        for (int i = 0; f && i < end.n; ++i) f[end.at[i]] -= end.P[d * end.n + i] * force[d];
    }
}

static void matrix_of_body(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *psi,
                           fu_weights weights, fu_system *system)
{
    const fu_attachment *on = &drag->attachments[0];
    const int dim = model->dim;
    double turned[3 * FU_ATTACHMENT_COORDINATES], by_place[3 * FU_ATTACHMENT_COORDINATES];
    double K[FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES], force[3];
    fu_attachment_state end;
    place at;
    action a;
    place_on_body(model, drag, state, 0, &at, &end);
    act(model, drag, state->t, &at, &a);
    whole_force(model, drag, &a, force);
    const int n = end.n;
    memcpy(turned, end.P, sizeof turned);
    memset(by_place, 0, sizeof by_place);
    fu_turn_point(model, on, state, force, psi, &end, turned, by_place, K);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            double sum = K[i * n + j];
            for (int d = 0; d < dim; ++d)
                for (int c = 0; c < dim; ++c) {
                    double change = -by_place[c * n + j] - weights.rate * end.P[c * n + j];
                    for (int b = 0; b < dim; ++b) change += a.by_height[c] * drag->flow.up[b] * turned[b * n + j];
                    sum += model->load_fraction * end.P[d * n + i] * a.by_w[d * dim + c] * change;
                }
            fu_add(model, system, end.at[i], end.at[j], -weights.stiffness * sum);
        }
}

/* Adds what acts at a state, or over a step; what it is added to may be null. */
static void add(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const fu_equations *step, double *f,
                powers *power, double total[3])
{
    const fu_drag *drag = (const fu_drag *)coupling;
    if (drag->cable >= 0) on_cable(model, drag, state->t, state->q, state->v, f, power, total);
    else on_body(model, drag, state->t, state, step, f, power, total);
}

static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    add(model, coupling, state, 0, f, 0, 0);
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f, double *own)
{
    (void)own;
    add(model, coupling, at->next, 0, f, 0, 0);
}

static void step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f, double *own)
{
    (void)own;
    add(model, coupling, at->middle, at, f, 0, 0);
}

static void matrix(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const double *psi,
                   fu_weights weights, fu_system *system)
{
    const fu_drag *drag = (const fu_drag *)coupling;
    if (drag->cable >= 0) matrix_of_cable(model, drag, state, weights, system);
    else matrix_of_body(model, drag, state, psi, weights, system);
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    matrix(model, coupling, at->next, at->psi, at->weights, system);
}

/* The middle moves by half of psi, which weights.stiffness has. */
static void step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    matrix(model, coupling, at->middle, 0, at->weights, system);
}

static double dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const fu_accelerator *work)
{
    powers power = {0.0, 0.0};
    (void)work;
    add(model, coupling, state, 0, 0, &power, 0);
    return power.dissipated;
}

static double external_power(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    powers power = {0.0, 0.0};
    add(model, coupling, state, 0, 0, &power, 0);
    return power.external;
}

static double step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at)
{
    powers power = {0.0, 0.0};
    add(model, coupling, at->middle, at, 0, &power, 0);
    return at->h * power.dissipated;
}

static double step_work(const fu_model *model, const fu_coupling *coupling, const fu_equations *at)
{
    powers power = {0.0, 0.0};
    add(model, coupling, at->middle, at, 0, &power, 0);
    return at->h * power.external;
}

static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const double *acceleration,
                    const fu_accelerator *work, double *out)
{
    (void)acceleration, (void)work;
    memset(out, 0, sizeof(double[3]));
    add(model, coupling, state, 0, 0, 0, out);
}

static const char *const role[] = {"drag", 0};
static const char *const profiles[] = {"uniform", "power", "table", 0};
#define FLOW_FIELD(member, kind, words) {#member, kind, offsetof(fu_drag, flow.member), 1, 0, words}
#define FLOW_VECTOR(member) {#member, FU_REAL, offsetof(fu_drag, flow.member), 3, sizeof(double), NULL}

static const fu_field fields[] = {
    FU_FIELD(fu_drag, kernel, FU_KERNELS, role),
    FLOW_VECTOR(velocity),
    FLOW_VECTOR(up),
    FLOW_FIELD(base, FU_REAL, 0),
    FLOW_FIELD(signal, FU_INTEGER, 0),
    FLOW_FIELD(profile, FU_WORD, profiles),
    FLOW_FIELD(reference, FU_REAL, 0),
    FLOW_FIELD(exponent, FU_REAL, 0),
    FLOW_FIELD(least, FU_REAL, 0),
    FLOW_FIELD(n_pieces, FU_INTEGER, 0),
    FLOW_FIELD(breaks, FU_REALS, 0),
    {"coefficients_of_profile", FU_REALS, offsetof(fu_drag, flow.coefficients), 1, 0, NULL},
    FU_FIELD(fu_drag, cable, FU_INTEGER, 0),
    FU_FIELD_ARRAY(fu_drag, coefficients, FU_REAL),
    FU_FIELD_ARRAY(fu_drag, buoyancy, FU_REAL),
    FU_FIELD(fu_drag, n_points, FU_INTEGER, 0),
    FU_FIELD(fu_drag, stride, FU_INTEGER, 0),
    FU_FIELD(fu_drag, weights, FU_REALS, 0),
    FU_FIELD(fu_drag, N, FU_REALS, 0),
    FU_FIELD(fu_drag, N_x, FU_REALS, 0),
    FU_FIELD_ARRAY(fu_drag, attachments, FU_ATTACHMENT),
    {0},
};

const fu_coupling_type fu_drag_type = {
    .name = "drag", .size = sizeof(fu_drag), .fields = fields, .n_outputs = 3, .residual = residual, .tangent = tangent,
    .step_residual = step_residual, .step_tangent = step_tangent, .step_dissipation = step_dissipation, .step_work = step_work,
    .force = force, .external_power = external_power, .dissipation = dissipation, .outputs = outputs};
