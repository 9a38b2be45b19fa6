/* Energy-momentum method with constraints on positions (Simo & Tarnow 1992; Gonzalez 1996, 1999; Simo & Wong 1991).
 *     psi = q_n+1 - q_n = h (v_n + v_n+1)/2,
 *     M (v_n+1 - v_n)/h + f(q_n, q_n+1) + G' lambda = Q at the middle,   phi(q_n+1) = 0,
 * where f is a discrete gradient of the elastic energy, f . psi = U_n+1 - U_n, and G one of the constraints, G psi =
 * phi_n+1 - phi_n: energy is conserved to rounding, and so are linear and angular momentum without external forces.
 *
 * Bodies rotate by a Cayley vector Theta, A_n+1 = A_n cay(Theta), (Omega_n + Omega_n+1)/2 = Theta/h; the balance of
 * their spatial angular momentum A J Omega, along the columns of A_n (1 + Theta~/2), is that of J (Omega_n+1 -
 * Omega_n)/h + Theta/h x J Theta/h with the moments along them: the inertia force at the mean velocity.
 *
 * Unknowns as in genalpha.c with sigma = h^2/2. The Newton matrix has the elasticity at the middle, without the
 * change of curvature of the energy over a step: Newton converges linearly, by a factor of order h^2 or higher.
 * Algorithmic dissipation (algorithmic_dissipation.c) appears in it as additional stiffness, exact except for
 * rotations and tension. */
#include "base/clock.h"
#include "base/workspace.h"
#include "bodies/growth.h"
#include "bodies/rotation.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/force/force.h"
#include "equations/equations.h"
#include "equations/run.h"
#include "events/events.h"
#include "integrators/algorithmic_dissipation.h"

#include <string.h>

#define NEWTON_TOLERANCE 1e-17 /* of the displacement in a step: Newton's tolerance, as small as possible */

/* Part of the work space after that of algorithmic dissipation: the middle of the step, and forces. */
typedef struct {
    double *q, *v, *force;
} middle_view;

static middle_view middle(const fu_run *run)
{
    double *q = run->scratch + run->model->n_dissipation_state, *v = q + run->model->n_q;
    return (middle_view){q, v, v + run->model->n_dof};
}

static long n_parameters(const double *given)
{
    (void)given;
    return FU_DOUBLES(1, fu_algorithmic);
}

static long n_scratch(const fu_run *run)
{
    return run->model->n_dissipation_state + (long)run->model->n_q + 2L * run->model->n_dof;
}

/* Returns the middle as a state; its couplings' unknowns are those of `next`. */
static fu_state middle_of(const fu_run *run, double h)
{
    const middle_view m = middle(run);
    return (fu_state){.t = run->now.t + 0.5 * h, .q = m.q, .v = m.v};
}

static double sigma(double h)
{
    return 0.5 * h * h;
}

static void predict(fu_run *run, double h)
{
    const fu_state *now = &run->now;
    for (int i = 0; i < run->model->n_dof; ++i) run->psi[i] = h * (now->v[i] + 0.5 * h * now->acceleration[i]);
    fu_predict_internal(run, h);
}

/* Computes q, v and the mean acceleration of `next` from psi, and the middle of the step. */
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
    const fu_equations at = {.now = now, .next = next, .psi = run->psi, .h = h};
    fu_history_velocities(model, &at, run->since);
    fu_between(model, now->q, next->q, m.q);
    if (fu_update_deferred(run, 1)) run->factored = 0;
}

/* Returns the equations over a step. */
static fu_equations equations(const fu_run *run, const fu_state *middle_state, double h)
{
    return (fu_equations){&run->now, &run->next, middle_state, run->psi, h, {1.0, 2.0 / h, sigma(h)}};
}

static void residual(fu_run *run, double h)
{
    const double begin = fu_clock();
    const fu_model *model = run->model;
    const fu_state *now = &run->now, *next = &run->next;
    const middle_view m = middle(run);
    const fu_state middle_state = middle_of(run, h);
    const fu_equations at = equations(run, &middle_state, h);
    fu_constant_mass_times(model, m.q, next->acceleration, run->force); /* of others: in their residuals */
    fu_discrete_forces(model, now->q, next->q, run->force);
    fu_algorithmic_forces(run, m.q, run->force);
    fu_rate_forces(model, m.q, m.v, run->force);
    fu_external_forces(model, middle_state.t, m.q, run->force);
    fu_coupling_step_residuals(model, &at, run->force, fu_internal_unknowns(run));
    fu_scale_residual(run, at.weights.stiffness);
    run->statistics.time_residual += fu_clock() - begin;
}

/* Adds the stiffness of the mean stress. Elasticity half-way has the stress of the mean vectors, which a rotation over
 * the step shortens; it does not change the mean stress. */
static void mean_stress(fu_run *run, double stiffness)
{
    const fu_model *model = run->model;
    double k[FU_MAX_COORDINATES * FU_MAX_COORDINATES];
    FU_EACH_CABLE(cable, model) {
        const int dim = cable->kernel->dim, n = cable->coordinates / dim;
        FU_EACH_ELEMENT(e, at, cable)
        {
            if (cable->growth >= 0) fu_grown_step_stiffness(cable, e, run->now.q, run->next.q, k);
            else
                cable->law->step_stiffness(fu_element_length(cable, e), run->now.q + at, run->next.q + at,
                                           fu_element_constants(cable, e), k);
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
    const fu_state m = middle_of(run, h);
    const double stiffer = 1.0 + 2.0 * fu_algorithmic_of(run)->weight;
    fu_equations at = equations(run, &m, h);
    fu_weights *w = &at.weights;
    w->stiffness *= 0.5; /* the middle moves by half of psi */
    fu_system_clear(&run->newton);
    fu_dynamic_matrix(model, m.q, m.v, w->inertia, w->rate / stiffer, w->stiffness * stiffer, &run->newton);
    fu_bodies_matrix(model, &m, 0, *w, &run->newton);
    fu_coupling_masses(model, m.t, m.q, w->inertia, &run->newton);
    mean_stress(run, w->stiffness);
    fu_coupling_step_tangents(model, &at, &run->newton);
}

static double apply(fu_run *run, double h)
{
    const double size = fu_spread_size(run);
    for (int i = 0; i < run->model->n_dof; ++i) run->psi[i] += run->work[i];
    fu_add_solution(run, 1.0, sigma(h));
    return size;
}

static const fu_newton newton = {predict, kinematics, residual, matrix, apply, 24, 1, NULL, NULL};

static int start(fu_run *run)
{
    run->since = 0.0;
    run->factored = 0;
    return FU_RUNNING;
}

static int step(fu_run *run, double h)
{
    /* the remaining residual does work on the step: psi and not positions measure it */
    run->newton_tolerance = NEWTON_TOLERANCE * h * fu_size(run->model, run->now.v);
    fu_algorithmic_start(run, h);
    return fu_newton_step(run, &newton, h);
}

/* Adds to the local error of rotations the part that the change of their rate does not contain: Cayley's map has an
 * error of order h^3 in a steady rotation, too. */
static void add_turn_errors(const fu_model *model, double h, const double *rate, const double *change, double *error)
{
    FU_EACH_BODY(body, model) {
        const int first = body->dof + body->kernel->dim, end = body->dof + body->kernel->velocity;
        double of_turn[FU_SPACE];
        body->kernel->cayley_error(rate + body->dof, change + body->dof, of_turn);
        for (int i = first; i < end; ++i) error[i] += h * h * h * of_turn[i - first];
    }
}

/* Returns the local error of positions, m: h^3/12 times the rate of acceleration, from the means of this step and the
 * one before, and that of finite rotations. */
static double error(fu_run *run, double h)
{
    const double factor = h * h * h / 12.0 / (0.5 * h + run->since);
    for (int i = 0; i < run->model->n_dof; ++i)
        run->work[i] = factor * (run->next.acceleration[i] - run->now.acceleration[i]);
    add_turn_errors(run->model, h, middle(run).v, run->next.acceleration, run->work);
    return fu_filtered_size(run);
}

/* Adds the work of nonconservative forces by the quadrature of the step: energy balances to rounding. */
static void account(fu_run *run, double h)
{
    const fu_model *model = run->model;
    const fu_state *now = &run->now, *next = &run->next;
    const middle_view m = middle(run);
    const fu_state middle_state = middle_of(run, h);
    const fu_equations at = equations(run, &middle_state, h);
    run->since = 0.5 * h;
    fu_history_over_step(model, &at);
    if (fu_count_deferred(run)) run->factored = 0; /* the matrix has the mean stiffness over the step */
    for (int i = 0; i < model->n_dof; ++i) m.force[i] = 0.0;
    fu_rate_forces(model, m.q, m.v, m.force);
    const int n_flexible = model->n_bodies ? model->bodies[0].dof : model->n_dof; /* gyroscopic moments do no work */
    for (int i = 0; i < n_flexible; ++i) run->dissipated += m.force[i] * run->psi[i];
    run->dissipated += fu_algorithmic_account(run, m.q);
    const fu_couplings near = fu_acting_in_step(model, &at);
    FU_EACH_COUPLING(c, near.list, near.n) {
        if (c->type->step_dissipation) run->dissipated += c->type->step_dissipation(model, c, &at);
        if (c->type->supply && c->type->supply->step_work) run->external += c->type->supply->step_work(model, c, &at);
    }
    for (int i = 0; i < model->n_dof; ++i) m.force[i] = 0.0;
    fu_coupling_external_forces(model, now->t + 0.5 * h, m.q, m.force);
    for (int i = 0; i < model->n_dof; ++i) run->external -= m.force[i] * run->psi[i];
    if (!model->n_motions) return;
    /* of the motions: velocities there are given, so that their mean differs slightly from psi/h */
    residual(run, h);
    fu_constant_mass_times(model, m.q, next->acceleration, m.force);
    for (int k = 0; k < model->n_motions; ++k) {
        const int i = model->motions[k].dof;
        if (model->motions[k].first)
            run->external +=
                run->force[i] * run->psi[i] + m.force[i] * (0.5 * h * (now->v[i] + next->v[i]) - run->psi[i]);
    }
}

const fu_integrator fu_energy = {.name = "energy",
                                 .n_parameters = n_parameters,
                                 .n_scratch = n_scratch,
                                 .n_dissipation_state = fu_algorithmic_state,
                                 .start = start,
                                 .step = step,
                                 .error = error,
                                 .account = account,
                                 .keeps_energy = 1,
                                 .defers_all = 1,
                                 .newton = &newton};
