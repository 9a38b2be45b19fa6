/* Eq 38: accelerations and multipliers of a state, from M, H, W; and what else needs M and H. */
#include "engine.h"

#include <string.h>

/* Layout of one joint's terms in the work space; n = coordinates of element and rider. */
typedef struct {
    double *C, *C_q, *C_s, *G, *s_rate, *Q_d, *H, *W, *s_bias;
} terms_view;

static terms_view view(const fu_accelerator *work, int joint)
{
    double *p = work->terms + (long)joint * FU_JOINT_TERMS;
    const int n = FU_MAX_COORDINATES;
    terms_view t = {p, p + 3, p + 3 + 3 * n, p + 6 + 3 * n, p + 6 + 4 * n, p + 7 + 4 * n, p + 10 + 4 * n,
                    p + 10 + 6 * n, p + 12 + 6 * n};
    return t;
}

/* dof of a joint's k-th coordinate: element first, then rider */
static int joint_dof(const fu_model *model, const fu_joint *joint, int element, int k)
{
    const fu_cable *cable = &model->cables[joint->cable];
    return k < cable->coordinates ? cable->first + element * cable->per_node + k
                                  : model->rigids[joint->rider].dof + k - cable->coordinates;
}

static void evaluate(const fu_model *model, const fu_state *state, fu_accelerator *work)
{
    for (int j = 0; j < model->n_joints; ++j) {
        const fu_joint *joint = &model->joints[j];
        const fu_cable *cable = &model->cables[joint->cable];
        const fu_rigid *rider = &model->rigids[joint->rider];
        const int element = state->element[j], at = cable->first + element * cable->per_node;
        const terms_view t = view(work, j);
        joint->kernel->terms(cable->length, state->s[j] - fu_element_start(model, j, element), state->q + at,
                             state->q + rider->configuration, joint->u, state->v + at, state->v + rider->dof,
                             state->director + 3 * j, t.C, t.C_q, t.C_s, t.G, t.s_rate, t.Q_d, t.H, t.W, t.s_bias);
    }
}

/* The band of M factored, once: it is constant, and so is the part of rigid bodies, by body axes. */
int fu_accelerator_prepare(const fu_model *model, fu_accelerator *work)
{
    fu_system_clear(&work->mass);
    fu_dynamic_matrix(model, model->zero, model->zero, 1.0, 0.0, 0.0, &work->mass);
    fu_bodies_mass(model, model->zero, 1, &work->mass);
    memcpy(work->bodies, work->mass.D, sizeof(double) * (size_t)(work->mass.m * work->mass.m));
    if (fu_system_factor_band(&work->mass, model->lapack)) return 1;
    return !work->mass.definite; /* else it would be in K, which the Newton matrix takes */
}

/* The border of M: that of the bodies. */
static void border(const fu_model *model, const double *q, fu_accelerator *work)
{
    fu_system *s = &work->mass;
    const int n = model->n_border_dof, whole = n + model->n_multipliers;
    fu_system_clear_border(s);
    for (int k = 0; k < n; ++k)
        memcpy(s->D + (long)k * s->m, work->bodies + (long)k * whole, sizeof(double) * (size_t)n);
    fu_bodies_mass(model, q, 0, s);
}

/* Border of [M H'; H 0] at a state whose terms are evaluated. */
static int factor_border(const fu_model *model, const fu_state *state, fu_accelerator *work)
{
    fu_system *s = &work->mass;
    border(model, state->q, work);
    for (int j = 0; j < model->n_joints; ++j) {
        const fu_joint *joint = &model->joints[j];
        const terms_view t = view(work, j);
        const int n = joint->kernel->coordinates;
        for (int c = 0; c < joint->kernel->dim - 1; ++c)
            for (int k = 0; k < n; ++k) {
                const int row = fu_extra(model, joint->multiplier + c);
                const int dof = joint_dof(model, joint, state->element[j], k);
                /* rows in kg, so that the border is of one scale */
                fu_add(model, s, row, dof, joint->mass * t.H[c * n + k]);
                fu_add(model, s, dof, row, joint->mass * t.H[c * n + k]);
            }
    }
    return fu_system_factor_border(s, model->lapack);
}

/* Solve [M H'; H 0] with forces on the dofs and right sides of the joints; multipliers are scaled back. */
static void solve(const fu_model *model, fu_accelerator *work, const double *force, double *solution)
{
    double *x = work->rhs, *lambda = x + model->n_band + model->n_border_dof;
    fu_gather(model, force, x);
    for (int j = 0; j < model->n_joints; ++j)
        for (int c = 0; c < model->joints[j].kernel->dim - 1; ++c)
            lambda[model->joints[j].multiplier + c] *= model->joints[j].mass;
    fu_system_solve(&work->mass, model->lapack, x);
    fu_spread(model, x, solution);
    for (int j = 0; j < model->n_joints; ++j)
        for (int c = 0; c < model->joints[j].kernel->dim - 1; ++c)
            lambda[model->joints[j].multiplier + c] *= model->joints[j].mass;
}

/* -sum_k H_ck x_k: what the joints' right sides lose to known accelerations or velocities */
static double minus_H(const fu_model *model, const fu_state *state, const fu_accelerator *work, int j, int c,
                      const double *x)
{
    const int n = model->joints[j].kernel->coordinates;
    const double *H = view(work, j).H + c * n;
    double sum = 0.0;
    for (int k = 0; k < n; ++k) sum -= H[k] * x[joint_dof(model, &model->joints[j], state->element[j], k)];
    return sum;
}

/* S = H M^-1 H' (multipliers x multipliers) at a state: singular where joints hold the same. */
int fu_compliance(const fu_model *model, const fu_state *state, fu_accelerator *work, double *S)
{
    fu_system *s = &work->mass;
    const int n = model->n_multipliers, whole = s->m;
    evaluate(model, state, work);
    s->m = model->n_border_dof; /* M alone */
    border(model, state->q, work);
    const int info = fu_system_factor_border(s, model->lapack);
    for (int j = 0; j < model->n_joints && !info; ++j) {
        const fu_joint *joint = &model->joints[j];
        for (int c = 0; c < joint->kernel->dim - 1; ++c) {
            const double *H = view(work, j).H + c * joint->kernel->coordinates;
            for (int i = 0; i < model->n_dof; ++i) work->work[i] = 0.0;
            for (int k = 0; k < joint->kernel->coordinates; ++k)
                work->work[joint_dof(model, joint, state->element[j], k)] += H[k];
            fu_gather(model, work->work, work->rhs);
            fu_system_solve(s, model->lapack, work->rhs);
            fu_spread(model, work->rhs, work->work);
            for (int i = 0; i < model->n_joints; ++i)
                for (int d = 0; d < model->joints[i].kernel->dim - 1; ++d)
                    S[(joint->multiplier + c) * n + model->joints[i].multiplier + d] =
                        -minus_H(model, state, work, i, d, work->work);
        }
    }
    s->m = whole;
    return info;
}

/* Eq 38. `joints` may be null, and `reaction`: what supports give to each dof, zero to rounding where it is free. */
int fu_accelerations(const fu_model *model, const fu_state *state, fu_accelerator *work, double *acceleration,
                     fu_joint_output *joints, double *reaction)
{
    double *lambda = work->rhs + model->n_band + model->n_border_dof, *prescribed = work->prescribed;
    evaluate(model, state, work);
    const int info = factor_border(model, state, work);
    if (info) return info;
    for (int i = 0; i < model->n_dof; ++i) work->force[i] = prescribed[i] = work->work[i] = 0.0;
    fu_internal_forces(model, state->q, state->v, work->force);
    fu_spring_forces(model, state->q, state->v, work->force);
    fu_external_forces(model, state->t, state->q, work->force);
    for (int k = 0; k < model->n_motions; ++k)
        prescribed[model->motions[k].dof] = state->acceleration[model->motions[k].dof];
    if (model->n_motions) fu_mass_times(model, state->q, prescribed, work->work);
    for (int i = 0; i < model->n_dof; ++i) work->work[i] = -work->force[i] - work->work[i];
    for (int j = 0; j < model->n_joints; ++j)
        for (int c = 0; c < model->joints[j].kernel->dim - 1; ++c)
            lambda[model->joints[j].multiplier + c] =
                view(work, j).W[c] + minus_H(model, state, work, j, c, prescribed);
    solve(model, work, work->work, acceleration);
    for (int i = 0; i < model->n_dof; ++i) acceleration[i] += prescribed[i];
    if (joints)
        for (int j = 0; j < model->n_joints; ++j) {
            const fu_joint *joint = &model->joints[j];
            const terms_view t = view(work, j);
            const int n = joint->kernel->coordinates, dim = joint->kernel->dim;
            const int rider = model->cables[joint->cable].coordinates;
            fu_joint_output *out = &joints[j];
            *out = (fu_joint_output){0};
            out->s_rate = t.s_rate[0];
            out->s_acceleration = t.s_bias[0];
            for (int k = 0; k < n; ++k)
                out->s_acceleration += t.G[k] * acceleration[joint_dof(model, joint, state->element[j], k)];
            for (int c = 0; c < dim - 1; ++c) out->multiplier[c] = lambda[joint->multiplier + c];
            for (int d = 0; d < dim; ++d) {
                out->residual[d] = t.C[d];
                for (int c = 0; c < dim - 1; ++c) out->force[d] -= t.H[c * n + rider + d] * out->multiplier[c];
            }
        }
    if (reaction) {
        fu_mass_times(model, state->q, acceleration, work->work);
        for (int i = 0; i < model->n_dof; ++i) reaction[i] = work->work[i] + work->force[i];
        for (int j = 0; j < model->n_joints; ++j) {
            const fu_joint *joint = &model->joints[j];
            const terms_view t = view(work, j);
            const int n = joint->kernel->coordinates;
            for (int k = 0; k < n; ++k)
                for (int c = 0; c < joint->kernel->dim - 1; ++c)
                    reaction[joint_dof(model, joint, state->element[j], k)] +=
                        t.H[c * n + k] * lambda[joint->multiplier + c];
        }
    }
    return 0;
}

/* change = the smallest (in the mass norm) change of the dofs with H change = -C_m, or, of velocities, -H v */
static int project(const fu_model *model, const fu_state *state, fu_accelerator *work, int of_velocities,
                   double *change)
{
    double *lambda = work->rhs + model->n_band + model->n_border_dof;
    evaluate(model, state, work);
    const int info = factor_border(model, state, work);
    if (info) return info;
    for (int i = 0; i < model->n_dof; ++i) work->work[i] = 0.0;
    for (int j = 0; j < model->n_joints; ++j)
        for (int c = 0; c < model->joints[j].kernel->dim - 1; ++c)
            lambda[model->joints[j].multiplier + c] =
                of_velocities ? minus_H(model, state, work, j, c, state->v) : -view(work, j).C[1 + c];
    solve(model, work, work->work, change);
    return 0;
}

/* change = an increment of the dofs that makes C_m = 0, to first order */
int fu_project_positions(const fu_model *model, const fu_state *state, fu_accelerator *work, double *change)
{
    return project(model, state, work, 0, change);
}

/* change = a change of v that makes H v = 0 */
int fu_project_velocities(const fu_model *model, const fu_state *state, fu_accelerator *work, double *change)
{
    return project(model, state, work, 1, change);
}

/* C, C_s, the Newton step for s, and the tangent, of a joint where it stands with this s */
static double evaluate_constraint(const fu_model *model, const fu_state *state, int j, double s, double i[3])
{
    const fu_joint *joint = &model->joints[j];
    const fu_cable *cable = &model->cables[joint->cable];
    const int dim = joint->kernel->dim;
    double C[3], C_s[3], step, A_t[9];
    joint->kernel->constraint(cable->length, s - fu_element_start(model, j, state->element[j]),
                              state->q + cable->first + state->element[j] * cable->per_node,
                              state->q + model->rigids[joint->rider].configuration, joint->u, state->director + 3 * j,
                              C, C_s, &step, A_t);
    for (int d = 0; d < dim; ++d) i[d] = A_t[d * dim];
    return step;
}

/* Newton for C_l(s) = 0 (eq 21) on the curve of the element that holds s; 0 when it converged. */
int fu_find_arc_length(const fu_model *model, const fu_state *state, int j, double *s)
{
    const double length = model->cables[model->joints[j].cable].length;
    double step = 0.0, tangent[3];
    for (int i = 0; i < 50; ++i) {
        step = evaluate_constraint(model, state, j, *s, tangent);
        *s += step;
        if (fabs(step) <= 1e-15 * (length + fabs(*s))) return 0;
    }
    return fabs(step) <= 1e-12 * length ? 0 : 1;
}

/* Turn each director that no element gives with the tangent: the part of it across the tangent, of unit length. Where
 * the tangent has swung onto it, the axis least along the tangent takes over. */
void fu_carry_directors(const fu_model *model, fu_state *state)
{
    for (int j = 0; j < model->n_joints; ++j) {
        if (!model->joints[j].carries_director) continue;
        double *d = state->director + 3 * j, i[3];
        evaluate_constraint(model, state, j, state->s[j], i);
        double along = i[0] * d[0] + i[1] * d[1] + i[2] * d[2];
        if (!(fabs(along) < 0.99)) {
            const double x = fabs(i[0]), y = fabs(i[1]), z = fabs(i[2]);
            const int least = x <= y && x <= z ? 0 : y <= z ? 1 : 2;
            for (int k = 0; k < 3; ++k) d[k] = k == least;
            along = i[least];
        }
        double square = 0.0;
        for (int k = 0; k < 3; ++k) d[k] -= along * i[k];
        for (int k = 0; k < 3; ++k) square += d[k] * d[k];
        for (int k = 0; k < 3; ++k) d[k] /= sqrt(square);
    }
}
