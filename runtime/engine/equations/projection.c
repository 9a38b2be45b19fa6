/* Functions of the integrators on eq 38: slides with C_l = 0, projection of constraint errors of a step, and quantities
 * that follow from positions and velocities. */
#include "bodies/rotation.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "equations/equations.h"
#include "equations/run.h"

#include <math.h>
#include <string.h>

/* largest number of projections of positions, each of second order */
#define MAX_PROJECTIONS 10
#define ROUNDING_FACTOR 100.0 /* times the rounding of positions: a correction that is not rounding */
#define SHORT_STEP 1e-3       /* of the usual step: in a shorter one rounding over h^2 would dominate accelerations */
#define GAP_TOLERANCE 1e-13   /* of the largest length: smaller initial gaps are rounding */
/* of the largest length: gaps of a probed mechanism that is back on its joints */
#define PROBE_TOLERANCE 1e-12

/* Records a coupling whose dependent coordinates have no solution; returns 1. */
static int lost(fu_run *run, const double *v, const fu_coupling *coupling)
{
    return fu_fail(run, FU_LOST_RIDER, v, coupling->number);
}

/* Solves for the dependent coordinates of `next`, predicted by the last step's slope; returns 0 on convergence. */
int fu_find_internal(fu_run *run)
{
    fu_state *next = &run->next;
    for (int i = 0; i < run->model->n_coordinates; ++i)
        next->s[i] = run->now.s[i] + (next->t - run->now.t) * run->s_slope[i];
    const fu_coupling *failed = fu_solve_coordinates(run->model, next);
    return failed ? lost(run, next->v, failed) : 0;
}

static void normalise(const fu_model *model, double *q)
{
    FU_EACH_BODY(body, model) {
        double *p = q + body->configuration + body->kernel->dim, square = 0.0;
        const int n = body->kernel->configuration - body->kernel->dim;
        for (int i = 0; i < n; ++i) square += p[i] * p[i];
        for (int i = 0; i < n; ++i) p[i] /= sqrt(square);
    }
}

/* Projects the positions of a state, and s, on its joints until a correction is small enough, or does not decrease as
 * it is rounding: that of a slope on a tangent point exceeds that of positions. Returns 0 on convergence. */
static int close_gaps(fu_run *run, fu_state *state, double enough)
{
    const fu_model *model = run->model;
    const double rounding = ROUNDING_FACTOR * run->round_off;
    double last = INFINITY;
    for (int i = 0;; ++i) {
        if (fu_project_positions(model, state, &run->accelerator, run->work))
            return fu_fail(run, FU_MATRIX, state->v, -1);
        const double size = fu_size(model, run->work);
        if (!(size < FU_RUNS_AWAY) || i == MAX_PROJECTIONS) return fu_fail(run, FU_ITERATION, run->work, -1);
        fu_move(model, state->q, run->work);
        const fu_coupling *failed = fu_solve_coordinates(model, state);
        if (failed) return lost(run, state->v, failed);
        if (size <= enough || (size >= last && size <= rounding)) return 0;
        last = size;
    }
}

/* Projects a start with small gaps on its joints if necessary; run->closed is the size of the gaps. Returns 0 on
 * convergence. */
int fu_close(fu_run *run)
{
    const double rounding = GAP_TOLERANCE * fu_largest_length(run);
    if (fu_project_positions(run->model, &run->now, &run->accelerator, run->work)) return 1;
    run->closed = fu_size(run->model, run->work);
    return run->closed > rounding && close_gaps(run, &run->now, rounding);
}

/* Projects a state on its joints after the normalisation of attitudes: positions, s, velocities; returns 0 on
 * convergence. */
int fu_return_to_joints(fu_run *run, fu_state *state)
{
    const fu_model *model = run->model;
    normalise(model, state->q);
    if (!model->n_multipliers) return 0;
    if (close_gaps(run, state, fmax(run->round_off, run->newton_tolerance))) return 1;
    if (fu_project_velocities(model, state, &run->accelerator, run->work)) return fu_fail(run, FU_MATRIX, state->v, -1);
    for (int i = 0; i < model->n_dof; ++i) state->v[i] += run->work[i];
    return 0;
}

/* Moves from `now` along these dofs, projected on the joints and no longer than given, and back onto the joints. `left`
 * is then the residual of the couplings' equations, redundant ones included, at the places of their forces. Returns
 * nonzero without convergence. */
int fu_probe_mechanism(fu_run *run, const double *along, double *left)
{
    const fu_model *model = run->model;
    fu_state *next = &run->next;
    fu_predict_internal(run, 0.0);
    memcpy(next->q, run->now.q, sizeof(double) * (size_t)model->n_q);
    memcpy(next->v, along, sizeof(double) * (size_t)model->n_dof);
    if (fu_project_velocities(model, next, &run->accelerator, run->work)) return 1;
    for (int i = 0; i < model->n_dof; ++i) run->work[i] += along[i];
    const double size = fu_size(model, run->work), most = fu_size(model, along);
    for (int i = 0; i < model->n_dof && size > most; ++i) run->work[i] *= most / size;
    fu_move(model, next->q, run->work);
    if (fu_solve_coordinates(model, next)) return 1;
    if (close_gaps(run, next, PROBE_TOLERANCE * fu_largest_length(run))) return 1;
    fu_gaps(model, next, left);
    return 0;
}

/* Solves eq 38 for the accelerations of a state and the couplings' forces; run->force is the force of supports, if they
 * move. Returns 0 on success. */
int fu_complete(fu_run *run, fu_state *state)
{
    const fu_model *model = run->model;
    const int info = fu_accelerations(model, state, &run->accelerator, state->acceleration,
                                      fu_supports_move(model, state) ? run->force : 0);
    if (!info) fu_take_forces(model, &run->accelerator, state);
    return info;
}

/* Returns whether a step is so much shorter than usual, as one to an event or an output time can be, that the rounding
 * of positions would dominate velocities or accelerations computed from them. */
int fu_is_short(const fu_run *run, double h)
{
    return h < SHORT_STEP * run->usual;
}

/* Computes such a step of any length: `next` from `now` by its accelerations, projected on the joints, without further
 * quantities of the scheme; returns 0 on convergence. */
int fu_coast(fu_run *run, double h)
{
    const fu_model *model = run->model;
    const fu_state *now = &run->now;
    fu_state *next = &run->next;
    run->residual_at = NAN;
    fu_predict_internal(run, h);
    for (int i = 0; i < model->n_dof; ++i) {
        run->psi[i] = h * (now->v[i] + 0.5 * h * now->acceleration[i]);
        next->v[i] = now->v[i] + h * now->acceleration[i];
    }
    memcpy(next->q, now->q, sizeof(double) * (size_t)model->n_q);
    fu_move(model, next->q, run->psi);
    if (model->n_motions) fu_prescribe(model, next);
    if (fu_find_internal(run) || fu_return_to_joints(run, next)) return 1;
    if (fu_complete(run, next)) return fu_fail_eq38(run);
    return 0;
}
