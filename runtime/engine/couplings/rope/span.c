/* Spans of ropes: sums over elements whose ends flow along the rope. */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/rope/rope.h"

#include <string.h>

enum { ENDS = FU_SPAN_ENDS, LOCAL = FU_SPAN_LOCAL };

/* --- inertia ---------------------------------------------------------------------------------------------------- */

static void inertial_force(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                           const double *a, double *f)
{
    (void)t;
    const fu_span_coupling *span = fu_span_of(coupling);
    double of_e[FU_MAX_COORDINATES], of_ends[ENDS];
    for (int k = 0; k < span->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &span->on, k, q, 0, a);
        span->on.kernel->inertia(span->rho, it.l, it.e, it.v, it.s_rate, it.a, it.s_acc, of_e, of_ends);
        fu_add_span_force(&span->on, &it, of_e, of_ends, 0.0, f);
    }
}

static void mass_matrix(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double scale,
                        fu_system *system)
{
    (void)t;
    const fu_span_coupling *span = fu_span_of(coupling);
    const int n = span->on.kernel->coordinates, all = n + ENDS;
    double M[LOCAL * LOCAL], local[LOCAL][LOCAL];
    for (int k = 0; k < span->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &span->on, k, q, 0, 0);
        span->on.kernel->mass_matrix(span->rho, it.l, it.e, M);
        for (int i = 0; i < all; ++i)
            for (int j = 0; j < all; ++j) local[i][j] = scale * M[i * all + j];
        fu_add_span_matrix(model, &span->on, &it, local, system);
    }
}

static double kinetic_energy(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                             const double *v, int past_fluid)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    double total = 0.0, T;
    (void)t, (void)past_fluid;
    for (int k = 0; k < span->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &span->on, k, q, v, 0);
        span->on.kernel->kinetic_energy(span->rho, it.l, it.e, it.v, it.s_rate, &T);
        total += T;
    }
    return total;
}

static double potential_energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    double total = 0.0, V, f[FU_MAX_COORDINATES], f_l, K_l[FU_MAX_COORDINATES], K_ll;
    for (int k = 0; k < span->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &span->on, k, state->q, 0, 0);
        span->on.kernel->weight(span->rho, it.l, it.e, span->g, &V, f, &f_l, K_l, &K_ll);
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
    for (int k = 0; k < span->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &span->on, k, state->q, state->v, 0);
        span->on.kernel->inertia(span->rho, it.l, it.e, it.v, it.s_rate, it.a, it.s_acc, of_e, of_ends);
        fu_add_span_force(&span->on, &it, of_e, of_ends, 0.0, f);
        span->on.kernel->weight(span->rho, it.l, it.e, span->g, &V, of_e, &of_length, K_l, &K_ll);
        fu_add_span_force(&span->on, &it, of_e, 0, of_length, f);
        span->on.kernel->elastic_force(it.l, it.e, span->A, of_e, &of_length);
        fu_add_span_force(&span->on, &it, of_e, 0, of_length, f);
        if (span->tau == 0.0) continue;
        span->on.kernel->damping_force(it.l, it.e, it.v, it.s_rate, span->A, span->tau, of_e, of_ends);
        fu_add_span_force(&span->on, &it, of_e, of_ends, 0.0, f);
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
    const fu_span_coupling *span = fu_span_of(coupling);
    const fu_state *state = at->next;
    const fu_weights w = at->weights;
    const int n = span->on.kernel->coordinates, all = n + ENDS;
    double D[LOCAL * LOCAL], K[LOCAL * LOCAL], local[LOCAL][LOCAL], K_l[FU_MAX_COORDINATES], K_ll,
        f[FU_MAX_COORDINATES], f_l, V;
    for (int k = 0; k < span->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &span->on, k, state->q, state->v, state->acceleration);
        memset(local, 0, sizeof local);
        span->on.kernel->elastic_tangent(it.l, it.e, span->A, K, K_l, &K_ll);
        fu_add_by_energy(n, w.stiffness, K, K_l, K_ll, local);
        span->on.kernel->weight(span->rho, it.l, it.e, span->g, &V, f, &f_l, K_l, &K_ll);
        fu_add_by_energy(n, w.stiffness, 0, K_l, K_ll, local);
        if (w.inertia != 0.0 || w.rate != 0.0) {
            span->on.kernel->inertia_tangent(span->rho, it.l, it.e, it.v, it.s_rate, it.a, it.s_acc, D, K);
            fu_add_by_length(all, n, w.stiffness, K, local);
            fu_add_by_rates(all, w.stiffness * w.rate, D, local);
        }
        if (span->tau > 0.0) {
            span->on.kernel->damping_tangent(it.l, it.e, it.v, it.s_rate, span->A, span->tau, D, K);
            fu_add_by_length(all, n, w.stiffness, K, local);
            fu_add_by_rates(all, w.stiffness * w.rate, D, local);
        }
        fu_add_span_matrix(model, &span->on, &it, local, system);
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
    for (int k = 0; k < span->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &span->on, k, state->q, 0, 0);
        span->on.kernel->energy(it.l, it.e, span->A, &U);
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
    for (int k = 0; span->tau > 0.0 && k < span->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &span->on, k, state->q, state->v, 0);
        span->on.kernel->dissipation(it.l, it.e, it.v, it.s_rate, span->A, span->tau, &P);
        total += P;
    }
    return total;
}

double fu_span_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    (void)model;
    return state->q[span->on.s[1]] - state->q[span->on.s[0]] - span->least_length;
}

double fu_grip_margin(const fu_coupling *coupling, const fu_state *state, int end)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    const double apart = span->grips[end] - state->q[span->on.s[end]];
    return end ? -apart : apart;
}

static const fu_field fields[] = {
    FU_SPAN_FIELDS(fu_span_coupling, on),
    FU_FIELD(fu_span_coupling, rho, FU_REAL, 0),
    FU_FIELD(fu_span_coupling, tau, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_span_coupling, g, FU_REAL),
    FU_FIELD_ARRAY(fu_span_coupling, A, FU_REAL),
    FU_FIELD(fu_span_coupling, least_length, FU_REAL, 0),
    FU_FIELD(fu_span_coupling, is_gripped, FU_INTEGER, 0),
    FU_FIELD_ARRAY(fu_span_coupling, grips, FU_REAL),
    {0},
};

static const fu_inertia_operations inertia = {.force = inertial_force,
                                              .matrix = mass_matrix,
                                              .kinetic_energy = kinetic_energy,
                                              .potential_energy = potential_energy,
                                              .beyond_velocities = fu_span_energy_beyond_velocities};
static const fu_history_operations history = {.size = fu_span_history_size,
                                              .over_step = fu_span_history_over_step,
                                              .jump = fu_span_history_jump,
                                              .velocities = fu_span_velocities};

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
