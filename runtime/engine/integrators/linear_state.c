/* States by the linear model: positions on the joints, exact forces, multipliers, forces of supports. */
#include "base/workspace.h"
#include "bodies/rotation.h"
#include "couplings/common/couplings.h"
#include "couplings/force/force.h"
#include "equations/equations.h"
#include "events/events.h"
#include "integrators/linear_constraints.h"

#include <math.h>
#include <string.h>

#define MOST_CLOSINGS 10 /* of constraints at one position: each has the error of second order of the one before */

static void take_coordinates(fu_linear_coordinates *c, long n, double *scratch, long *taken)
{
    c->y = fu_take(scratch, taken, n);
    c->rate = fu_take(scratch, taken, n);
    c->second = fu_take(scratch, taken, n);
    c->a = fu_take(scratch, taken, n);
}

long fu_linear_lay_out(const fu_run *run, double *scratch, fu_linear_space *w)
{
    const fu_linear_model *linear = run->linear;
    const long n = linear->n, dofs = FU_HALF_BAND_ROWS(run->model->n_dof) + linear->stride;
    long taken = 0;
    take_coordinates(&w->now, n, scratch, &taken);
    take_coordinates(&w->next, n, scratch, &taken);
    w->linear = fu_take(scratch, &taken, n);
    w->change = fu_take(scratch, &taken, n + FU_BAND_BEYOND(linear->width));
    w->left = fu_take(scratch, &taken, n);
    w->left_now = fu_take(scratch, &taken, n);
    w->motion.displacement = fu_take(scratch, &taken, dofs);
    w->motion.velocity = fu_take(scratch, &taken, dofs);
    w->motion.acceleration = fu_take(scratch, &taken, dofs);
    w->force = fu_take(scratch, &taken, dofs);
    w->values = fu_take(scratch, &taken, linear->closing.rows);
    w->gaps = fu_take(scratch, &taken, run->model->n_multipliers);
    w->h_left = fu_take(scratch, &taken, 1);
    w->h_now = fu_take(scratch, &taken, 1);
    w->error = fu_take(scratch, &taken, 2);
    return fu_linear_take_constraints(run, scratch, taken, &w->moving);
}

fu_linear_space fu_linear_space_of(const fu_run *run)
{
    fu_linear_space w;
    fu_linear_lay_out(run, run->scratch, &w);
    return w;
}

/* Moves the dofs of determined unknowns so that these values of the constraints, in w->gaps, become zero, in the linear
 * model; returns the largest value. */
static double close(const fu_run *run, const fu_linear_space *w, double *dofs)
{
    const fu_linear_model *linear = run->linear;
    const fu_sparse *held = &linear->held;
    double largest = 0.0;
    memset(w->values, 0, sizeof(double) * (size_t)linear->closing.rows);
    fu_sparse_add_times(&linear->closing, -1.0, w->gaps, w->values);
    for (int i = 0; i < held->rows; ++i)
        for (int k = held->start[i]; k < held->start[i + 1]; ++k)
            dofs[held->column[k]] += held->value[k] * w->values[i];
    for (int i = 0; i < run->model->n_multipliers; ++i) largest = fmax(largest, fabs(w->gaps[i]));
    return largest;
}

void fu_linear_gaps(const fu_run *run, const fu_linear_space *w, fu_level of, int moves, const double *dofs)
{
    const fu_accelerator *work = &run->accelerator;
    memset(w->gaps, 0, sizeof(double) * (size_t)run->model->n_multipliers);
    for (int r = 0; r < run->model->n_rows; ++r) {
        const fu_rows *rows = &work->rows[r];
        for (int c = 0; c < rows->rows && run->linear->moves[r] == moves; ++c) {
            double *value = &w->gaps[rows->first + c];
            if (rows->redundant_rows >> c & 1) continue;
            *value = of == FU_OF_POSITIONS ? rows->C[c] : of == FU_OF_VELOCITIES ? rows->rate[c] : -rows->W[c];
            for (int k = 0; k < rows->n && of != FU_OF_POSITIONS; ++k)
                *value += rows->H[c * rows->n + k] * dofs[rows->at[k]];
        }
    }
}

/* Computes q of `next` from the displacement, with prescribed dofs. */
static void place(fu_run *run, const fu_linear_space *w)
{
    const fu_model *model = run->model;
    fu_state *next = &run->next;
    memcpy(next->q, run->first, sizeof(double) * (size_t)model->n_q);
    fu_move(model, next->q, w->motion.displacement);
    if (!model->n_motions) return;
    fu_prescribe(model, next);
    for (int k = 0; k < model->n_motions; ++k) {
        const int dof = model->motions[k].dof;
        w->motion.displacement[dof] = next->q[dof] - run->first[dof];
    }
}

/* Solves for the dependent coordinates of `next`; returns nonzero without a solution. */
static int follow(fu_run *run)
{
    if (!run->linear->n_moving) return 0;
    fu_choose_path_segments(run);
    const fu_coupling *failed = fu_solve_coordinates(run->model, &run->next);
    return failed ? fu_fail(run, FU_LOST_RIDER, run->next.v, failed->number) : 0;
}

int fu_linear_kinematics(fu_run *run, const fu_linear_space *w)
{
    const fu_model *model = run->model;
    fu_state *next = &run->next;
    const size_t size = sizeof(double) * (size_t)model->n_dof;
    fu_linear_model_expand_motion(run->linear, model->n_dof,
                                  (const double *[]){w->next.y, w->next.rate, w->next.second},
                                  (double *[]){w->motion.displacement, next->v, next->acceleration});
    place(run, w);
    for (int i = 0; i < MOST_CLOSINGS && run->linear->held.rows; ++i) {
        fu_evaluate_rows(model, next, &run->accelerator);
        fu_linear_gaps(run, w, FU_OF_POSITIONS, 0, NULL);
        if (close(run, w, w->motion.displacement) <= run->round_off) break;
        place(run, w);
    }
    if (follow(run)) return 1;
    if (model->n_rows) {
        fu_linear_gaps(run, w, FU_OF_VELOCITIES, 0, next->v);
        close(run, w, next->v);
        fu_evaluate_rows(model, next, &run->accelerator); /* W is of the velocities */
        fu_linear_gaps(run, w, FU_OF_ACCELERATIONS, 0, next->acceleration);
        close(run, w, next->acceleration);
    }
    memcpy(w->motion.velocity, next->v, size);
    memcpy(w->motion.acceleration, next->acceleration, size);
    fu_update_deferred(run, 1);
    return 0;
}

void fu_linear_exact_forces(const fu_run *run, const fu_linear_space *w)
{
    const fu_model *model = run->model;
    const fu_state *next = &run->next;
    memset(w->force, 0, sizeof(double) * (size_t)model->n_dof);
    fu_bodies_mass_times(model, next->q, next->acceleration, w->force);
    fu_bodies_forces(model, next->q, next->v, w->force);
    fu_coupling_forces(model, next, w->force);
    fu_external_forces(model, next->t, next->q, w->force);
    if (run->linear->n_moving) fu_linear_add_constraint_forces(run, w);
}

void fu_linear_multipliers(fu_run *run, const fu_linear_space *w)
{
    const fu_linear_model *linear = run->linear;
    double *lambda = run->accelerator.multipliers;
    const size_t size = sizeof(double) * (size_t)run->model->n_multipliers;
    if (linear->n_moving) memcpy(lambda, w->moving.lambda, size);
    else memset(lambda, 0, size);
    for (int i = 0; i < linear->held.rows; ++i) {
        double force = 0.0;
        for (int k = linear->held.start[i]; k < linear->held.start[i + 1]; ++k) {
            const int dof = linear->held.column[k];
            force += linear->held.value[k] * (w->force[dof] + fu_linear_model_cable_force(run, &w->motion, dof));
        }
        for (int k = linear->closing.start[i]; k < linear->closing.start[i + 1]; ++k)
            lambda[linear->closing.column[k]] -= linear->closing.value[k] * force;
    }
}

void fu_linear_reactions(fu_run *run, const fu_linear_space *w, double *reaction, fu_cable_totals *totals)
{
    const fu_accelerator *work = &run->accelerator;
    memcpy(reaction, w->force, sizeof(double) * (size_t)run->model->n_dof);
    fu_linear_model_cable_forces(run, &w->motion, w->force, totals);
    fu_add_times(NULL, run->model->n_dof, 1.0, w->force, reaction);
    for (int r = 0; r < run->model->n_rows; ++r) {
        const fu_rows *rows = &work->rows[r];
        for (int c = 0; c < rows->rows && !run->linear->moves[r]; ++c)
            for (int k = 0; k < rows->n; ++k)
                reaction[rows->at[k]] += rows->H[c * rows->n + k] * work->multipliers[rows->first + c];
    }
}
