/* What the integrators on eq 38 share: slides where C_l = 0, projection of what the constraints lost in a step, and what
 * follows from positions and velocities. */
#include "engine.h"

#include <string.h>

#define MOST_PROJECTIONS 10

/* s of `next` where C_l = 0 (eq 21), from what the last step's slope predicts; 0 when that was found */
int fu_find_slides(fu_run *run)
{
    fu_state *next = &run->next;
    for (int j = 0; j < run->model->n_joints; ++j) {
        if (next->mode[j] == FU_LEFT) continue;
        next->s[j] = run->now.s[j] + (next->t - run->now.t) * run->s_slope[j];
        if (fu_find_arc_length(run->model, next, j, &next->s[j])) return fu_fail(run, FU_LOST_RIDER, next->v, j);
    }
    return 0;
}

static void normalise(const fu_model *model, double *q)
{
    for (int b = 0; b < model->n_rigids; ++b) {
        const fu_body *kernel = model->rigids[b].kernel;
        double *p = q + model->rigids[b].configuration + kernel->dim, square = 0.0;
        const int n = kernel->configuration - kernel->dim;
        for (int i = 0; i < n; ++i) square += p[i] * p[i];
        for (int i = 0; i < n; ++i) p[i] /= sqrt(square);
    }
}

/* `next` back onto its joints, after attitudes: positions, s, velocities; 0 when that converged */
int fu_return_to_joints(fu_run *run)
{
    const fu_model *model = run->model;
    fu_state *next = &run->next;
    normalise(model, next->q);
    if (!model->n_multipliers) return 0;
    for (int i = 0;; ++i) {
        if (fu_project_positions(model, next, &run->accelerator, run->work))
            return fu_fail(run, FU_MATRIX, next->v, -1);
        const double size = fu_size(model, run->work);
        if (!(size < 1e30) || i == MOST_PROJECTIONS) return fu_fail(run, FU_ITERATION, run->work, -1);
        fu_move(model, next->q, run->work);
        for (int j = 0; j < model->n_joints; ++j)
            if (next->mode[j] != FU_LEFT && fu_find_arc_length(model, next, j, &next->s[j]))
                return fu_fail(run, FU_LOST_RIDER, next->v, j);
        if (size <= fmax(run->round_off, run->newton_tolerance)) break;
    }
    if (fu_project_velocities(model, next, &run->accelerator, run->work)) return fu_fail(run, FU_MATRIX, next->v, -1);
    for (int i = 0; i < model->n_dof; ++i) next->v[i] += run->work[i];
    return 0;
}

/* Accelerations of a state by eq 38, and with them the forces of joints and springs; what supports give, in run->force,
 * where something moves them. 0 when that was found. */
int fu_complete(fu_run *run, fu_state *state)
{
    const fu_model *model = run->model;
    fu_joint_output *joints = (fu_joint_output *)run->accelerator.joints;
    const int info = fu_accelerations(model, state, &run->accelerator, state->acceleration, joints,
                                      model->n_motions ? run->force : 0);
    if (info) return info;
    for (int j = 0; j < model->n_joints; ++j) memcpy(state->f + 3 * j, joints[j].force, sizeof joints[j].force);
    for (int k = 0; k < model->n_links; ++k)
        memcpy(state->multipliers + 6 * k, run->accelerator.multipliers + model->links[k].multiplier,
               sizeof(double) * (size_t)model->links[k].kernel->rows);
    fu_forces_of_springs(model, state, state->spring);
    return 0;
}
