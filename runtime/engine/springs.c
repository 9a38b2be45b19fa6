/* Springs and dampers between two points (derive/couplings/spring.py has the law). Where a Newton system is solved the
 * force is an unknown of its own, so that ends far apart on cables do not widen the band. */
#include "engine.h"

#include <string.h>

/* Position and velocity of an end, and how it moves; returns its first dof. */
static int end_point(const fu_model *model, const fu_attachment *end, const double *q, const double *v, fu_attachment_state *place)
{
    const fu_state state = {.q = (double *)q, .v = (double *)v};
    fu_attachment_at(model, end, &state, 0.0, FU_POINT, place);
    return place->n ? place->at[0] : 0;
}

static void gap_of(const fu_model *model, const fu_spring *spring, const double *q, const double *v, double gap[3],
                   double rate[3])
{
    fu_attachment_state place[2];
    for (int e = 0; e < 2; ++e) end_point(model, &spring->ends[e], q, v, &place[e]);
    for (int d = 0; d < 3; ++d) {
        gap[d] = place[1].p[d] - place[0].p[d];
        rate[d] = place[1].v[d] - place[0].v[d];
    }
}

/* Force on the first end, and its derivatives by the gap p_2 - p_1 and by the gap's rate (dim x dim). */
void fu_spring_force(const fu_model *model, const fu_spring *spring, const double *q, const double *v, double force[3],
                     double by_gap[9], double by_rate[9])
{
    double gap[3], rate[3];
    gap_of(model, spring, q, v, gap, rate);
    spring->kernel->tangent(spring->stiffness, spring->damping, spring->length, gap, rate, force, by_gap, by_rate);
}

static void force_of(const fu_model *model, const fu_spring *spring, const double *q, const double *v, double force[3])
{
    double gap[3], rate[3];
    gap_of(model, spring, q, v, gap, rate);
    spring->kernel->force(spring->stiffness, spring->damping, spring->length, gap, rate, force);
}

/* f += what a force on the first end, and its opposite on the second, puts on the left of the equations of motion */
void fu_spring_pull(const fu_model *model, const fu_spring *spring, const double *q, const double force[3], double *f)
{
    for (int e = 0; e < 2; ++e) {
        fu_attachment_state place;
        const int first = end_point(model, &spring->ends[e], q, model->zero, &place), n = place.n;
        for (int d = 0; d < spring->dim; ++d)
            for (int i = 0; i < n; ++i) f[first + i] += (e ? 1.0 : -1.0) * place.P[d * n + i] * force[d];
    }
}

/* f += all spring forces */
void fu_spring_forces(const fu_model *model, const double *q, const double *v, double *f)
{
    double force[3];
    for (int k = 0; k < model->n_springs; ++k) {
        force_of(model, &model->springs[k], q, v, force);
        fu_spring_pull(model, &model->springs[k], q, force, f);
    }
}

/* Rows and columns of a spring in a Newton system; its rows are stiffness (F - law), its unknown F stiffness/unit. */
void fu_spring_matrix(const fu_model *model, const fu_spring *spring, const fu_state *state, const double *psi,
                      double rate, double stiffness, double unit, fu_system *system)
{
    const int dim = spring->dim, row = fu_extra(model, spring->unknown);
    double force[3], by_gap[9], by_rate[9];
    fu_spring_force(model, spring, state->q, state->v, force, by_gap, by_rate);
    for (int d = 0; d < dim; ++d) fu_add(model, system, row + d, row + d, unit);
    for (int e = 0; e < 2; ++e) {
        const fu_attachment *end = &spring->ends[e];
        fu_attachment_state place;
        double turned[3 * FU_ATTACHMENT_COORDINATES], by_place[3 * FU_ATTACHMENT_COORDINATES];
        const int first = end_point(model, end, state->q, state->v, &place), n = place.n;
        const double sign = e ? 1.0 : -1.0, *P = place.P;
        memcpy(turned, P, sizeof turned);
        for (int i = 0; i < dim * n; ++i) by_place[i] = 0.0; /* of the end's velocity, at fixed rates of its dofs */
        if (end->body >= 0) {
            const fu_body *body = &model->bodies[end->body];
            const double *turn = psi ? psi + body->dof : 0;
            double K[FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES];
            for (int d = 0; d < dim; ++d) {
                const double axis[3] = {d == 0, d == 1, d == 2};
                memset(K, 0, sizeof(double) * (size_t)(n * n));
                fu_geometric_stiffness(model, end, state, axis, 0, n, K);
                for (int i = 0; i < n; ++i)
                    for (int j = 0; j < n; ++j) by_place[d * n + j] += state->v[first + i] * K[i * n + j];
            }
            memset(K, 0, sizeof(double) * (size_t)(n * n));
            fu_geometric_stiffness(model, end, state, state->spring + 3 * (spring - model->springs), 0, n, K);
            if (turn) {
                fu_turn_columns(body->kernel, turned, dim, n, 0, turn);
                fu_turn_columns(body->kernel, by_place, dim, n, 0, turn);
                fu_turn_columns(body->kernel, K, n, n, 0, turn);
            }
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) fu_add(model, system, first + i, first + j, sign * stiffness * K[i * n + j]);
        }
        for (int i = 0; i < n; ++i)
            for (int d = 0; d < dim; ++d) {
                double change = 0.0;
                for (int k = 0; k < dim; ++k)
                    change += by_gap[d * dim + k] * turned[k * n + i] +
                              by_rate[d * dim + k] * (by_place[k * n + i] + rate * P[k * n + i]);
                fu_add(model, system, row + d, first + i, -sign * stiffness * change);
                fu_add(model, system, first + i, row + d, sign * unit * P[d * n + i]);
            }
    }
}

/* the force of each spring on its first end, 3 each */
void fu_spring_forces_of(const fu_model *model, const fu_state *state, double *forces)
{
    for (int k = 0; k < model->n_springs; ++k)
        force_of(model, &model->springs[k], state->q, state->v, forces + 3 * k);
}

/* Force on the first end over a step from q to q_next that takes as much work as the spring stores, and as much more as
 * the damper dissipates. Returns the power of the damper in W. */
double fu_discrete_spring(const fu_model *model, const fu_spring *spring, const double *q, const double *q_next, double h,
                          double force[3])
{
    double gap[3], gap_next[3], unused[3], power;
    gap_of(model, spring, q, model->zero, gap, unused);
    gap_of(model, spring, q_next, model->zero, gap_next, unused);
    spring->kernel->discrete_force(spring->stiffness, spring->damping, spring->length, h, gap, gap_next, force, &power);
    return power;
}

/* The same as fu_spring_pull over a step: what the force does is its work on the gap's change. */
void fu_discrete_pull(const fu_model *model, const fu_spring *spring, const double *q, const double *q_next,
                      const double force[3], double *f)
{
    for (int e = 0; e < 2; ++e) {
        const fu_attachment *end = &spring->ends[e];
        fu_attachment_state place;
        const int first = end_point(model, end, q, model->zero, &place), n = place.n;
        if (end->body >= 0) {
            const fu_body *body = &model->bodies[end->body];
            body->kernel->discrete_point(q + body->configuration, end->u, q_next + body->configuration, place.P);
        }
        for (int d = 0; d < spring->dim; ++d)
            for (int i = 0; i < n; ++i) f[first + i] += (e ? 1.0 : -1.0) * place.P[d * n + i] * force[d];
    }
}

double fu_spring_energy(const fu_model *model, const double *q)
{
    double total = 0.0, gap[3], rate[3], energy;
    for (int k = 0; k < model->n_springs; ++k) {
        const fu_spring *spring = &model->springs[k];
        gap_of(model, spring, q, model->zero, gap, rate);
        spring->kernel->energy(spring->stiffness, spring->length, gap, &energy);
        total += energy;
    }
    return total;
}

/* power taken out by the dampers */
double fu_spring_dissipation(const fu_model *model, const double *q, const double *v)
{
    double total = 0.0, gap[3], rate[3], power;
    for (int k = 0; k < model->n_springs; ++k) {
        const fu_spring *spring = &model->springs[k];
        gap_of(model, spring, q, v, gap, rate);
        spring->kernel->dissipation(spring->damping, spring->length, gap, rate, &power);
        total += power;
    }
    return total;
}
