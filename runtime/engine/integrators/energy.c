/* Energy-momentum method with constraints on positions (Simo & Tarnow 1992; Gonzalez 1996, 1999; Simo & Wong 1991).
 *
 *   psi = q_n+1 - q_n = h (v_n + v_n+1)/2
 *   M (v_n+1 - v_n)/h + f(q_n, q_n+1) + G' lambda = Q at the middle,   phi(q_n+1) = 0
 *
 * f is a discrete gradient of the elastic energy, f . psi = U_n+1 - U_n, and G one of the constraints, G psi =
 * phi_n+1 - phi_n: energy is kept to rounding, and so are linear and angular momentum where nothing outside takes them.
 * Bodies turn by a Cayley vector Theta, A_n+1 = A_n cay(Theta), (Omega_n + Omega_n+1)/2 = Theta/h; the balance of their
 * spatial angular momentum A J Omega, along the columns of A_n (1 + Theta~/2), is that of J (Omega_n+1 - Omega_n)/h +
 * Theta/h x J Theta/h with the moments along them: the inertia force as it stands, at the mean velocity.
 *
 * Unknowns as in genalpha.c with sigma = h^2/2. The Newton matrix takes elasticity at the middle, which leaves the
 * change of curvature of the energy over a step out: Newton converges linearly, by a factor that falls as h^2 or faster.
 * Algorithmic dissipation (algorithmic_dissipation.c) stands in it as so much more stiffness, which it is but for turns and tension.
 */
#include "engine.h"

#include <string.h>

/* Scratch: the middle of the step, and forces. */
typedef struct {
    double *q, *v, *force;
} middle_view;

static middle_view middle(const fu_run *run)
{
    double *q = run->scratch, *v = q + run->model->n_q;
    return (middle_view){q, v, v + run->model->n_dof};
}

static double sigma(double h)
{
    return 0.5 * h * h;
}

static void predict(fu_run *run, double h)
{
    const fu_state *now = &run->now;
    for (int i = 0; i < run->model->n_dof; ++i) run->psi[i] = h * (now->v[i] + 0.5 * h * now->acceleration[i]);
    fu_predict_extra(run, h);
}

/* next.q, v, and the mean acceleration of the step, from psi; the middle */
static void kinematics(fu_run *run, double h)
{
    const fu_model *model = run->model;
    const fu_state *now = &run->now;
    fu_state *next = &run->next;
    const middle_view m = middle(run);
    memcpy(next->q, now->q, sizeof(double) * (size_t)model->n_q);
    fu_cayley_move(model, next->q, run->psi);
    for (int i = 0; i < model->n_dof; ++i) next->v[i] = 2.0 * run->psi[i] / h - now->v[i];
    if (model->n_motions) fu_prescribe(model, next);
    for (int k = 0; k < model->n_motions; ++k) {
        const int i = model->motions[k].dof;
        run->psi[i] = next->q[i] - now->q[i];
    }
    for (int i = 0; i < model->n_dof; ++i) {
        next->acceleration[i] = (next->v[i] - now->v[i]) / h;
        m.v[i] = run->psi[i] / h;
    }
    fu_between(model, now->q, next->q, m.q);
}

static const double *configuration(const fu_model *model, const fu_state *state, const fu_slide *slide)
{
    return state->q + model->bodies[slide->rider.body].configuration;
}

static void residual(fu_run *run, double h)
{
    const double begin = fu_clock(), scale = sigma(h);
    const fu_model *model = run->model;
    const fu_state *now = &run->now, *next = &run->next;
    const middle_view m = middle(run);
    double *extra = run->rhs + model->n_band + model->n_border_dof;
    fu_mass_times(model, m.q, next->acceleration, run->force);
    fu_discrete_forces(model, now->q, next->q, run->force);
    fu_algorithmic_forces(run, m.q, run->force);
    fu_rate_forces(model, m.q, m.v, run->force);
    fu_external_forces(model, now->t + 0.5 * h, m.q, run->force);
    for (int j = 0; j < model->n_slides; ++j) {
        const fu_slide *slide = &model->slides[j];
        const double length = model->cables[slide->cable].length, start = fu_element_start(model, j, now->element[j]);
        const double *f = next->f + 3 * j;
        double G[3 * FU_MAX_COORDINATES], phi[3], unused[FU_MAX_COORDINATES];
        int at[FU_SLIDE_COORDINATES + 1];
        fu_slide_coordinates(model, next, j, at);
        slide->kernel->discrete_gradient(length, now->s[j] - start, next->s[j] - start, now->q + at[0], next->q + at[0],
                                         configuration(model, now, slide), configuration(model, next, slide), G);
        slide->kernel->residual(length, next->s[j] - start, next->q + at[0], configuration(model, next, slide), slide->rider.u,
                                f, phi, unused);
        const int s = slide->kernel->coordinates, dim = slide->kernel->dim, n = s + 1;
        double along = 0.0;
        for (int d = 0; d < dim; ++d) {
            for (int i = 0; i < s; ++i) run->force[at[i]] += f[d] * G[d * n + i];
            along += f[d] * G[d * n + s];
            extra[slide->unknown + 1 + d] = -slide->mass * phi[d];
        }
        extra[slide->unknown] = -scale * along;
    }
    for (int k = 0; k < model->n_springs; ++k) {
        const fu_spring *spring = &model->springs[k];
        double force[3];
        fu_discrete_pull(model, spring, now->q, next->q, next->spring + 3 * k, run->force);
        fu_discrete_spring(model, spring, now->q, next->q, h, force);
        for (int d = 0; d < spring->dim; ++d)
            extra[spring->unknown + d] = -scale * (next->spring[3 * k + d] - force[d]);
    }
    fu_gather(model, run->force, run->rhs);
    for (int i = 0; i < model->n_band + model->n_border_dof; ++i) run->rhs[i] *= -scale;
    run->statistics.time_residual += fu_clock() - begin;
}

/* Rows and columns of a joint: the constraint at the end of the step, its discrete gradient, half the derivative of the
 * force there. */
static void joint_matrix(fu_run *run, int j, double stiffness)
{
    const fu_model *model = run->model;
    const fu_state *now = &run->now, *next = &run->next;
    fu_system *system = &run->newton;
    const fu_slide *slide = &model->slides[j];
    const fu_body *rider = &model->bodies[slide->rider.body];
    const double length = model->cables[slide->cable].length, start = fu_element_start(model, j, now->element[j]);
    const int s = slide->kernel->coordinates, n = s + 1, dim = slide->kernel->dim;
    const int turns = model->cables[slide->cable].coordinates;
    double G[3 * FU_MAX_COORDINATES], J[3 * FU_MAX_COORDINATES], K[FU_MAX_COORDINATES * FU_MAX_COORDINATES];
    int at[FU_SLIDE_COORDINATES + 1];
    fu_slide_coordinates(model, next, j, at);
    slide->kernel->discrete_gradient(length, now->s[j] - start, next->s[j] - start, now->q + at[0], next->q + at[0],
                                     configuration(model, now, slide), configuration(model, next, slide), G);
    slide->kernel->tangent(length, next->s[j] - start, next->q + at[0], configuration(model, next, slide), slide->rider.u,
                           next->f + 3 * j, J, K);
    fu_cayley_columns(rider->kernel, J, dim, n, turns, run->psi + rider->dof);
    fu_cayley_columns(rider->kernel, K, n, n, turns, run->psi + rider->dof);
    for (int i = 0; i < n; ++i) {
        for (int d = 0; d < dim; ++d) {
            fu_add(model, system, at[i], at[s] + 1 + d, slide->mass * G[d * n + i]);
            fu_add(model, system, at[s] + 1 + d, at[i], slide->mass * J[d * n + i]);
        }
        for (int k = 0; k < n; ++k)
            if (K[i * n + k] != 0.0) fu_add(model, system, at[i], at[k], stiffness * K[i * n + k]);
    }
}

/* Elasticity half-way knows the stress of the mean vectors: a turn over the step shortens these, the mean stress not. */
static void mean_stress(fu_run *run, double stiffness)
{
    const fu_model *model = run->model;
    double k[FU_MAX_COORDINATES * FU_MAX_COORDINATES];
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        const int dim = cable->kernel->dim, n = cable->coordinates / dim;
        for (int e = 0, at = cable->first; e < cable->n_elements; ++e, at += cable->per_node) {
            cable->law->step_stiffness(cable->length, run->now.q + at, run->next.q + at,
                                       cable->A + (long)e * cable->A_stride, k);
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j)
                    for (int d = 0; d < dim; ++d)
                        fu_add(model, &run->newton, at + i * dim + d, at + j * dim + d, stiffness * k[i * n + j]);
        }
    }
}

static void matrix(fu_run *run, double h)
{
    const fu_model *model = run->model;
    const middle_view m = middle(run);
    const double rate = 2.0 / h, stiffness = 0.5 * sigma(h); /* the middle moves by half of psi */
    const fu_state state = {.q = m.q, .v = m.v, .spring = run->next.spring};
    fu_system_clear(&run->newton);
    const double stiffer = 1.0 + 2.0 * run->algorithmic.weight;
    fu_dynamic_matrix(model, m.q, m.v, 1.0, rate / stiffer, stiffness * stiffer, &run->newton);
    fu_bodies_matrix(model, &state, 0, (fu_weights){1.0, rate, stiffness}, &run->newton);
    mean_stress(run, stiffness);
    fu_loads_matrix(model, run->now.t + 0.5 * h, m.q, 0, stiffness, &run->newton);
    for (int j = 0; j < model->n_slides; ++j) joint_matrix(run, j, stiffness);
    for (int k = 0; k < model->n_springs; ++k)
        fu_spring_matrix(model, &model->springs[k], &state, 0, rate, stiffness, model->springs[k].mass, &run->newton);
}

static double apply(fu_run *run, double h)
{
    const double size = fu_spread_size(run);
    for (int i = 0; i < run->model->n_dof; ++i) run->psi[i] += run->work[i];
    fu_apply_extra(run, 1.0, sigma(h));
    return size;
}

static const fu_newton newton = {predict, kinematics, residual, matrix, apply, 24, 1};

static int start(fu_run *run)
{
    run->since = 0.0;
    run->factored = 0;
    return FU_RUNNING;
}

static int step(fu_run *run, double h)
{
    /* what Newton leaves does work on the step: it is measured by psi and not by positions */
    run->newton_tolerance = 1e-17 * h * fu_size(run->model, run->now.v);
    fu_algorithmic_start(run, h);
    return fu_newton_step(run, &newton, h);
}

/* Local error of positions, m: h^3/12 times the rate of acceleration, from the means of this step and the one before. */
static double error(fu_run *run, double h)
{
    const double factor = h * h * h / 12.0 / (0.5 * h + run->since);
    for (int i = 0; i < run->model->n_dof; ++i)
        run->work[i] = factor * (run->next.acceleration[i] - run->now.acceleration[i]);
    return fu_filtered_size(run);
}

/* Work of the forces that are not conserved, as the step has it: energy balances to rounding. */
static void book(fu_run *run, double h)
{
    const fu_model *model = run->model;
    const fu_state *now = &run->now, *next = &run->next;
    const middle_view m = middle(run);
    double force[3];
    run->since = 0.5 * h;
    for (int i = 0; i < model->n_dof; ++i) m.force[i] = 0.0;
    fu_rate_forces(model, m.q, m.v, m.force);
    const int n_flexible = model->n_bodies ? model->bodies[0].dof : model->n_dof; /* gyroscopic moments do no work */
    for (int i = 0; i < n_flexible; ++i) run->dissipated += m.force[i] * run->psi[i];
    run->dissipated += fu_algorithmic_account(run, m.q);
    for (int k = 0; k < model->n_springs; ++k)
        run->dissipated += h * fu_discrete_spring(model, &model->springs[k], now->q, next->q, h, force);
    for (int i = 0; i < model->n_dof; ++i) m.force[i] = 0.0;
    fu_loads(model, now->t + 0.5 * h, m.q, m.force);
    for (int i = 0; i < model->n_dof; ++i) run->external -= m.force[i] * run->psi[i];
    if (!model->n_motions) return;
    /* of the motions: velocities there are given, so that their mean is not quite psi/h */
    residual(run, h);
    fu_mass_times(model, m.q, next->acceleration, m.force);
    for (int k = 0; k < model->n_motions; ++k) {
        const int i = model->motions[k].dof;
        if (model->motions[k].first)
            run->external += run->force[i] * run->psi[i] +
                             m.force[i] * (0.5 * h * (now->v[i] + next->v[i]) - run->psi[i]);
    }
}

const fu_integrator fu_energy_method = {"energy", start, step, error, book, 1, 0, &newton};
