/* Spans of ropes: sums over elements whose ends flow along the rope. */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/rope/span.h"

#include <string.h>

enum { ENDS = FU_SPAN_ENDS, LOCAL = FU_MAX_COORDINATES + ENDS };

void fu_span_at_ends(const fu_span_coupling *span, int k, const double *dofs, double out[ENDS])
{
    const double first = dofs[span->s[0]], change = dofs[span->s[1]] - first;
    for (int i = 0; i < ENDS; ++i) out[i] = first + span->share[k + i] * change;
}

fu_span_element fu_span_element_at(const fu_model *model, const fu_span_coupling *span, int k, const double *q,
                                   const double *v, const double *a)
{
    fu_span_element it = {.at = span->first + k * (span->kernel->coordinates / ENDS)};
    double s[ENDS];
    if (!v) v = model->zero;
    if (!a) a = model->zero;
    fu_span_at_ends(span, k, q, s);
    fu_span_at_ends(span, k, v, it.s_rate);
    fu_span_at_ends(span, k, a, it.s_acc);
    it.l = s[1] - s[0];
    it.e = q + it.at;
    it.v = v + it.at;
    it.a = a + it.at;
    return it;
}

void fu_span_add_force(const fu_span_coupling *span, int k, int at, const double *of_e, const double *of_ends,
                       double of_length, double *f)
{
    for (int i = 0; i < span->kernel->coordinates; ++i) f[at + i] += of_e[i];
    for (int i = 0; i < ENDS; ++i) {
        const double force = (of_ends ? of_ends[i] : 0.0) + (i ? of_length : -of_length), share = span->share[k + i];
        f[span->s[0]] += (1.0 - share) * force;
        f[span->s[1]] += share * force;
    }
}

/* Adds a matrix over e and both ends (LOCAL columns a row) to a system. */
static void add_matrix(const fu_model *model, const fu_span_coupling *span, int k, int at, double (*K)[LOCAL],
                       fu_system *system)
{
    const int n = span->kernel->coordinates;
    const double a = span->share[k], b = span->share[k + 1];
    int dofs[LOCAL];
    for (int i = 0; i < n; ++i) dofs[i] = at + i;
    for (int i = 0; i < ENDS; ++i) dofs[n + i] = span->s[i];
    for (int i = 0; i < n + ENDS; ++i) {
        const double first = K[i][n], last = K[i][n + 1];
        K[i][n] = (1.0 - a) * first + (1.0 - b) * last;
        K[i][n + 1] = a * first + b * last;
    }
    for (int j = 0; j < n + ENDS; ++j) {
        const double first = K[n][j], last = K[n + 1][j];
        K[n][j] = (1.0 - a) * first + (1.0 - b) * last;
        K[n + 1][j] = a * first + b * last;
    }
    for (int i = 0; i < n + ENDS; ++i)
        for (int j = 0; j < n + ENDS; ++j)
            if (K[i][j] != 0.0) fu_add(model, system, dofs[i], dofs[j], K[i][j]);
}

/* --- inertia ---------------------------------------------------------------------------------------------------- */

static void inertial_force(const fu_model *model, const fu_coupling *coupling, const double *q, const double *a,
                           double *f)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    double of_e[FU_MAX_COORDINATES], of_ends[ENDS];
    for (int k = 0; k < span->n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, span, k, q, 0, a);
        span->kernel->inertia(span->rho, it.l, it.e, it.v, it.s_rate, it.a, it.s_acc, of_e, of_ends);
        fu_span_add_force(span, k, it.at, of_e, of_ends, 0.0, f);
    }
}

static void mass_matrix(const fu_model *model, const fu_coupling *coupling, const double *q, double scale,
                        fu_system *system)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    const int n = span->kernel->coordinates, all = n + ENDS;
    double M[LOCAL * LOCAL], local[LOCAL][LOCAL];
    for (int k = 0; k < span->n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, span, k, q, 0, 0);
        span->kernel->mass_matrix(span->rho, it.l, it.e, M);
        for (int i = 0; i < all; ++i)
            for (int j = 0; j < all; ++j) local[i][j] = scale * M[i * all + j];
        add_matrix(model, span, k, it.at, local, system);
    }
}

static double kinetic_energy(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                             const double *v, int past_fluid)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    double total = 0.0, T;
    (void)t, (void)past_fluid;
    for (int k = 0; k < span->n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, span, k, q, v, 0);
        span->kernel->kinetic_energy(span->rho, it.l, it.e, it.v, it.s_rate, &T);
        total += T;
    }
    return total;
}

static double potential_energy(const fu_model *model, const fu_coupling *coupling, const double *q)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    double total = 0.0, V, f[FU_MAX_COORDINATES], f_l, K_l[FU_MAX_COORDINATES], K_ll;
    for (int k = 0; k < span->n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, span, k, q, 0, 0);
        span->kernel->weight(span->rho, it.l, it.e, span->g, &V, f, &f_l, K_l, &K_ll);
        total += V;
    }
    return total;
}

/* --- forces ----------------------------------------------------------------------------------------------------- */

/* Adds all forces at zero accelerations. */
static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    double of_e[FU_MAX_COORDINATES], of_ends[ENDS], of_length, V, K_l[FU_MAX_COORDINATES], K_ll;
    for (int k = 0; k < span->n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, span, k, state->q, state->v, 0);
        span->kernel->inertia(span->rho, it.l, it.e, it.v, it.s_rate, it.a, it.s_acc, of_e, of_ends);
        fu_span_add_force(span, k, it.at, of_e, of_ends, 0.0, f);
        span->kernel->weight(span->rho, it.l, it.e, span->g, &V, of_e, &of_length, K_l, &K_ll);
        fu_span_add_force(span, k, it.at, of_e, 0, of_length, f);
        span->kernel->elastic_force(it.l, it.e, span->A, of_e, &of_length);
        fu_span_add_force(span, k, it.at, of_e, 0, of_length, f);
        if (span->tau == 0.0) continue;
        span->kernel->damping_force(it.l, it.e, it.v, it.s_rate, span->A, span->tau, of_e, of_ends);
        fu_span_add_force(span, k, it.at, of_e, of_ends, 0.0, f);
    }
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                     double *internal)
{
    (void)internal;
    force(model, coupling, at->next, f);
}

/* Adds derivatives by e and by the length (n + 1 columns a row of `by`) times a factor. */
static void add_by_length(int rows, int n, double factor, const double *by, double (*local)[LOCAL])
{
    for (int i = 0; i < rows; ++i, by += n + 1) {
        for (int j = 0; j < n; ++j) local[i][j] += factor * by[j];
        local[i][n] -= factor * by[n];
        local[i][n + 1] += factor * by[n];
    }
}

/* Adds second derivatives of an energy by e (K, null: none), by e and l, by l. */
static void add_energy(int n, double factor, const double *K, const double *K_l, double K_ll, double (*local)[LOCAL])
{
    static const double sign[ENDS] = {-1.0, 1.0};
    for (int i = 0; i < n; ++i) {
        for (int j = 0; K && j < n; ++j) local[i][j] += factor * K[i * n + j];
        for (int e = 0; e < ENDS; ++e) {
            local[i][n + e] += factor * sign[e] * K_l[i];
            local[n + e][i] += factor * sign[e] * K_l[i];
        }
    }
    for (int i = 0; i < ENDS; ++i)
        for (int j = 0; j < ENDS; ++j) local[n + i][n + j] += factor * sign[i] * sign[j] * K_ll;
}

static void add_rates(int all, double factor, const double *D, double (*local)[LOCAL])
{
    for (int i = 0; i < all; ++i)
        for (int j = 0; j < all; ++j) local[i][j] += factor * D[i * all + j];
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    const fu_state *state = at->next;
    const fu_weights w = at->weights;
    const int n = span->kernel->coordinates, all = n + ENDS;
    double D[LOCAL * LOCAL], K[LOCAL * LOCAL], local[LOCAL][LOCAL], K_l[FU_MAX_COORDINATES], K_ll,
        f[FU_MAX_COORDINATES], f_l, V;
    for (int k = 0; k < span->n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, span, k, state->q, state->v, state->acceleration);
        memset(local, 0, sizeof local);
        span->kernel->elastic_tangent(it.l, it.e, span->A, K, K_l, &K_ll);
        add_energy(n, w.stiffness, K, K_l, K_ll, local);
        span->kernel->weight(span->rho, it.l, it.e, span->g, &V, f, &f_l, K_l, &K_ll);
        add_energy(n, w.stiffness, 0, K_l, K_ll, local);
        if (w.inertia != 0.0 || w.rate != 0.0) {
            span->kernel->inertia_tangent(span->rho, it.l, it.e, it.v, it.s_rate, it.a, it.s_acc, D, K);
            add_by_length(all, n, w.stiffness, K, local);
            add_rates(all, w.stiffness * w.rate, D, local);
        }
        if (span->tau > 0.0) {
            span->kernel->damping_tangent(it.l, it.e, it.v, it.s_rate, span->A, span->tau, D, K);
            add_by_length(all, n, w.stiffness, K, local);
            add_rates(all, w.stiffness * w.rate, D, local);
        }
        add_matrix(model, span, k, it.at, local, system);
    }
}

/* Adds the derivatives over a step by those half-way. */
static void step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    fu_state middle = *at->middle;
    fu_equations half_way = *at;
    middle.acceleration = at->next->acceleration;
    half_way.next = &middle;
    tangent(model, coupling, &half_way, system);
}

static double energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    double total = 0.0, U;
    for (int k = 0; k < span->n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, span, k, state->q, 0, 0);
        span->kernel->energy(it.l, it.e, span->A, &U);
        total += U;
    }
    return total;
}

static double dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const fu_accelerator *work)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    double total = 0.0, P;
    (void)work;
    for (int k = 0; span->tau > 0.0 && k < span->n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, span, k, state->q, state->v, 0);
        span->kernel->dissipation(it.l, it.e, it.v, it.s_rate, span->A, span->tau, &P);
        total += P;
    }
    return total;
}

double fu_span_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    (void)model;
    return state->q[span->s[1]] - state->q[span->s[0]] - span->least_length;
}

double fu_grip_margin(const fu_coupling *coupling, const fu_state *state, int end)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    const double apart = span->grips[end] - state->q[span->s[end]];
    return end ? -apart : apart;
}

static const fu_field fields[] = {
    FU_FIELD(fu_span_coupling, kernel, FU_KERNELS, 0),
    FU_FIELD(fu_span_coupling, n_elements, FU_INTEGER, 0),
    FU_FIELD(fu_span_coupling, first, FU_INTEGER, 0),
    FU_FIELD_ARRAY(fu_span_coupling, s, FU_INTEGER),
    FU_FIELD(fu_span_coupling, share, FU_REALS, 0),
    FU_FIELD(fu_span_coupling, rho, FU_REAL, 0),
    FU_FIELD(fu_span_coupling, tau, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_span_coupling, g, FU_REAL),
    FU_FIELD_ARRAY(fu_span_coupling, A, FU_REAL),
    FU_FIELD(fu_span_coupling, least_length, FU_REAL, 0),
    FU_FIELD(fu_span_coupling, is_gripped, FU_INTEGER, 0),
    FU_FIELD_ARRAY(fu_span_coupling, grips, FU_REAL),
    {0},
};

static const fu_inertia_operations inertia = {inertial_force, mass_matrix, kinetic_energy, potential_energy,
                                              fu_span_energy_beyond_velocities};
static const fu_history_operations history = {
    .size = fu_span_history_size, .over_step = fu_span_history_over_step, .jump = fu_span_history_jump};

const fu_coupling_type fu_span_type = {
    .name = "span",
    .size = sizeof(fu_span_coupling),
    .fields = fields,
    .inertia = &inertia,
    .history = &history,
    .residual = residual,
    .tangent = tangent,
    .step_residual = fu_span_step_residual,
    .step_tangent = step_tangent,
    .step_dissipation = fu_span_step_dissipation,
    .force = force,
    .energy = energy,
    .dissipation = dissipation,
};
