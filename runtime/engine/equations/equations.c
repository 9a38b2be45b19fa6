/* Equations of motion with their constraints at an instant, for implicit integrators, and statics. */
#include "base/clock.h"
#include "bodies/rotation.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/force/force.h"
#include "equations/equations.h"
#include "equations/run.h"

/* Computes run->rhs of the dofs: minus the scaled sum in run->force. */
void fu_scale_residual(fu_run *run, double scale)
{
    const fu_model *model = run->model;
    fu_gather(model, run->force, run->rhs);
    fu_set_times(model->threads, model->n_band + model->n_border_dof, -scale, run->rhs, run->rhs);
}

/* Computes run->rhs, minus the scaled residual over the unknowns; run->force keeps the unscaled sum over the dofs. */
void fu_residual(fu_run *run, const fu_equations *at)
{
    const double begin = fu_clock();
    const fu_model *model = run->model;
    const fu_state *next = at->next;
    if (at->weights.inertia != 0.0) {
        fu_constant_mass_times(model, next->q, next->acceleration, run->force);
        fu_coupling_inertia_beside_residuals(model, next->t, next->q, next->acceleration, run->force);
    } else
        for (int i = 0; i < model->n_dof; ++i) run->force[i] = 0.0;
    fu_internal_forces(model, next->q, next->v, run->force);
    fu_external_forces(model, next->t, next->q, run->force);
    fu_coupling_residuals(model, at, run->force, fu_internal_unknowns(run));
    fu_scale_residual(run, at->weights.stiffness);
    run->statistics.time_residual += fu_clock() - begin;
}

static void matrix_of_cables(fu_run *run, const fu_equations *at)
{
    const fu_weights w = at->weights;
    fu_system_clear(&run->newton);
    fu_dynamic_matrix(run->model, at->next->q, at->next->v, w.inertia, w.rate, w.stiffness, &run->newton);
}

static void add_matrix_without_cables(fu_run *run, const fu_equations *at)
{
    fu_bodies_matrix(run->model, at->next, at->psi, at->weights, &run->newton);
    if (at->weights.inertia != 0.0)
        fu_coupling_masses(run->model, at->next->t, at->next->q, at->weights.inertia, &run->newton);
    if (at->weights.stiffness != 0.0) fu_coupling_tangents(run->model, at, &run->newton);
}

/* Computes run->newton, the derivative at `next` of the scaled residual by the unknowns. */
void fu_matrix(fu_run *run, const fu_equations *at)
{
    matrix_of_cables(run, at);
    add_matrix_without_cables(run, at);
}

/* Computes the cables' part of it. */
void fu_matrix_of_cables(fu_run *run, fu_weights weights)
{
    const fu_equations at = {.now = &run->now, .next = &run->next, .weights = weights};
    matrix_of_cables(run, &at);
    run->factored = 0;
}

/* Adds the part of bodies and couplings. */
void fu_add_matrix_without_cables(fu_run *run, fu_weights weights)
{
    const fu_equations at = {.now = &run->now, .next = &run->next, .weights = weights};
    add_matrix_without_cables(run, &at);
}

/* Computes the same for these weights, unfactored; unknowns move bodies from `next`. */
void fu_matrix_of_weights(fu_run *run, fu_weights weights)
{
    fu_matrix_of_cables(run, weights);
    fu_add_matrix_without_cables(run, weights);
}

/* Moves `next` by unknowns from its position, in statics. */
void fu_static_move(fu_run *run, const double *change)
{
    const fu_model *model = run->model;
    for (int i = 0; i < run->newton.n + run->newton.m; ++i) run->rhs[i] = change[i];
    fu_spread(model, run->rhs, run->work);
    fu_move(model, run->next.q, run->work);
    fu_add_solution(run, 0.0, 1.0);
    fu_detect_contact(model, &run->next);
}

/* Computes run->rhs of statics: minus the sum of forces, and the residuals of constraints. */
void fu_static_residual(fu_run *run)
{
    const fu_equations at = {.now = &run->now, .next = &run->next, .weights = {0.0, 0.0, 1.0}};
    fu_residual(run, &at);
}
