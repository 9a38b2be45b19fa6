/* Spans over a step that conserves energy (derive/couplings/span_step.py). History variables are the momenta of the
 * material at points, which are those of the velocities where they are not known. */
#include "bodies/model.h"
#include "couplings/common/momenta.h"
#include "couplings/rope/rope.h"

#include <string.h>

enum { ENDS = FU_SPAN_ENDS, MAX_POINTS = 8, MAX_NUMBERS = 3 * MAX_POINTS };

/* Numbers of the momenta of an element. */
static int of_element(const fu_span_coupling *span)
{
    return span->on.kernel->points * span->on.kernel->dim;
}

int fu_span_history_size(const fu_coupling *coupling)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    return FU_MOMENTA_HEAD + span->on.n_elements * of_element(span);
}

/* Computes the momenta of an element at a state. */
static void momenta_at(const fu_model *model, const fu_span_coupling *span, int k, const fu_state *state, double *P)
{
    const fu_momenta *known = fu_momenta_of(&span->base, state);
    if (known->is_known != 0.0) {
        memcpy(P, known->P + k * of_element(span), sizeof(double) * (size_t)of_element(span));
        return;
    }
    const fu_span_element it = fu_span_element_at(model, &span->on, k, state->q, state->v, 0);
    span->on.kernel->momentum(it.l, it.e, it.v, it.s_rate, P);
}

/* The inertial forces of an element over a step, and the momenta at its end. */
typedef struct {
    double of_e[FU_MAX_COORDINATES], of_ends[ENDS], P[MAX_NUMBERS];
} inertia;

static void inertia_of(const fu_model *model, const fu_span_coupling *span, int k, const fu_equations *at, inertia *out)
{
    const fu_span_element now = fu_span_element_at(model, &span->on, k, at->now->q, 0, 0);
    double P[MAX_NUMBERS], s_change[ENDS];
    momenta_at(model, span, k, at->now, P);
    fu_span_at_ends(&span->on, k, at->psi, s_change);
    span->on.kernel->momentum_step(span->rho, at->h, now.l, s_change, now.e, at->psi + now.at, P, out->of_e,
                                   out->of_ends, out->P);
}

void fu_span_history_over_step(const fu_model *model, const fu_coupling *coupling, const fu_equations *at)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    fu_momenta *next = fu_momenta_of(coupling, at->next);
    for (int k = 0; k < span->on.n_elements; ++k) {
        inertia of;
        inertia_of(model, span, k, at, &of);
        memcpy(next->P + k * of_element(span), of.P, sizeof(double) * (size_t)of_element(span));
    }
    next->is_known = 1.0;
}

void fu_span_velocities(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double since)
{
    const fu_span_elements *on = &fu_span_of(coupling)->on;
    (void)model;
    const int n = (on->n_elements + 1) * on->kernel->coordinates / 2;
    for (int i = 0; i < n; ++i) fu_velocity_of_step(at, since, on->first + i);
    for (int e = 0; e < ENDS; ++e) fu_velocity_of_step(at, since, on->s[e]);
}

void fu_span_history_jump(const fu_model *model, const fu_coupling *coupling, fu_state *state, const double *change)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    fu_momenta *known = fu_momenta_of(coupling, state);
    double P[MAX_NUMBERS];
    for (int k = 0; known->is_known != 0.0 && k < span->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &span->on, k, state->q, change, 0);
        span->on.kernel->momentum(it.l, it.e, it.v, it.s_rate, P);
        for (int i = 0; i < of_element(span); ++i) known->P[k * of_element(span) + i] += P[i];
    }
}

double fu_span_energy_beyond_velocities(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    const fu_momenta *known = fu_momenta_of(coupling, state);
    double total = 0.0, T, velocities;
    for (int k = 0; known->is_known != 0.0 && k < span->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &span->on, k, state->q, state->v, 0);
        span->on.kernel->momentum_energy(span->rho, it.l, known->P + k * of_element(span), &T);
        span->on.kernel->kinetic_energy(span->rho, it.l, it.e, it.v, it.s_rate, &velocities);
        total += T - velocities;
    }
    return total;
}

/* --- forces ----------------------------------------------------------------------------------------------------- */

/* Adds a discrete gradient of the energy of gravity: its mean gradient, of degree two along the step. */
static void add_weight(const fu_model *model, const fu_span_coupling *span, int k, const fu_equations *at, double *f)
{
    static const double part[2] = {0.21132486540518712, 0.78867513459481288}; /* Gauss points */
    const fu_span_element from = fu_span_element_at(model, &span->on, k, at->now->q, 0, 0),
                          to = fu_span_element_at(model, &span->on, k, at->next->q, 0, 0);
    double e[FU_MAX_COORDINATES], of_e[FU_MAX_COORDINATES], of_length, V, K_l[FU_MAX_COORDINATES], K_ll;
    for (int g = 0; g < 2; ++g) {
        for (int i = 0; i < span->on.kernel->coordinates; ++i) e[i] = from.e[i] + part[g] * (to.e[i] - from.e[i]);
        span->on.kernel->weight(0.5 * span->rho, from.l + part[g] * (to.l - from.l), e, span->g, &V, of_e, &of_length,
                                K_l, &K_ll);
        fu_add_span_force(&span->on, &from, of_e, 0, of_length, f);
    }
}

/* Computes the energies of stretching and of bending of an element at a configuration. */
static void energies_of(const fu_span_coupling *span, const fu_span_element *it, double *U_m, double *U_b)
{
    double A[FU_ROPE_CONSTANTS], B[FU_ROPE_CONSTANTS] = {0.0};
    memcpy(A, span->A, sizeof A);
    B[1] = A[1];
    A[1] = 0.0;
    span->on.kernel->energy(it->l, it->e, A, U_m);
    span->on.kernel->energy(it->l, it->e, B, U_b);
}

static void add_elastic(const fu_model *model, const fu_span_coupling *span, int k, const fu_equations *at, double *f)
{
    const fu_span_element from = fu_span_element_at(model, &span->on, k, at->now->q, 0, 0),
                          to = fu_span_element_at(model, &span->on, k, at->next->q, 0, 0);
    double of_e[FU_MAX_COORDINATES], of_length, U_m[ENDS], U_b[ENDS];
    energies_of(span, &from, &U_m[0], &U_b[0]);
    energies_of(span, &to, &U_m[1], &U_b[1]);
    span->on.kernel->elastic_step(from.l, to.l, from.e, to.e, span->A, U_m, U_b, of_e, &of_length);
    fu_add_span_force(&span->on, &from, of_e, 0, of_length, f);
}

/* Returns an element half-way, in space with slopes weighted by the lengths at both ends of the step: the moments of
 * all forces over a step balance along these (derive/couplings/material_step.py). e: space for its nodal vectors. */
static fu_span_element half_way(const fu_model *model, const fu_span_coupling *span, int k, const fu_equations *at,
                                double e[FU_MAX_COORDINATES])
{
    const int dim = span->on.kernel->dim;
    fu_span_element it = fu_span_element_at(model, &span->on, k, at->middle->q, at->middle->v, 0);
    const fu_span_element from = fu_span_element_at(model, &span->on, k, at->now->q, 0, 0),
                          to = fu_span_element_at(model, &span->on, k, at->next->q, 0, 0);
    if (dim == 2) return it;
    for (int i = 0; i < span->on.kernel->coordinates; ++i) {
        const int is_slope = i / dim % 2;
        e[i] = is_slope ? (from.l * from.e[i] + to.l * to.e[i]) / (from.l + to.l) : it.e[i];
    }
    it.e = e;
    return it;
}

/* Adds the forces of damping half-way. */
static void add_damping(const fu_model *model, const fu_span_coupling *span, int k, const fu_equations *at, double *f)
{
    double of_e[FU_MAX_COORDINATES], of_ends[ENDS], e[FU_MAX_COORDINATES];
    const fu_span_element it = half_way(model, span, k, at, e);
    if (span->tau == 0.0) return;
    span->on.kernel->damping_force(it.l, it.e, it.v, it.s_rate, span->A, span->tau, of_e, of_ends);
    fu_add_span_force(&span->on, &it, of_e, of_ends, 0.0, f);
}

void fu_span_step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                           double *internal)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    (void)internal;
    for (int k = 0; k < span->on.n_elements; ++k) {
        inertia of;
        inertia_of(model, span, k, at, &of);
        const fu_span_element it = fu_span_element_at(model, &span->on, k, at->now->q, 0, 0);
        fu_add_span_force(&span->on, &it, of.of_e, of.of_ends, 0.0, f);
        add_weight(model, span, k, at, f);
        add_elastic(model, span, k, at, f);
        add_damping(model, span, k, at, f);
    }
}

double fu_span_step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at)
{
    const fu_span_coupling *span = fu_span_of(coupling);
    double total = 0.0, P;
    (void)model;
    for (int k = 0; span->tau > 0.0 && k < span->on.n_elements; ++k) {
        double e[FU_MAX_COORDINATES];
        const fu_span_element it = half_way(model, span, k, at, e);
        span->on.kernel->dissipation(it.l, it.e, it.v, it.s_rate, span->A, span->tau, &P);
        total += at->h * P;
    }
    return total;
}
