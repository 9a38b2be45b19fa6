/* What the integrators on eq 38 share: slides where C_l = 0, projection of what the constraints lost in a step, and
 * what follows from positions and velocities. */
#include "bodies/rotation.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "equations/acceleration.h"
#include "equations/projection.h"
#include "equations/run.h"

#include <math.h>
#include <string.h>

/* of positions, each of second order, before a state has no way back onto its joints */
#define MOST_PROJECTIONS 10
#define SHORT_STEP 1e-3 /* of the usual step: in a shorter one rounding over h^2 would rule accelerations */
#define CLOSED 1e-13    /* of the largest length: smaller gaps at the start are rounding */
/* of the largest length: gaps with which a probed mechanism is back on its joints */
#define PROBE_TOLERANCE 1e-12

/* Notes that a coupling's own coordinates do not follow from the others; returns 1. */
static int lost(fu_run *run, const double *v, const fu_coupling *coupling)
{
    return fu_fail(run, FU_LOST_RIDER, v, coupling->number);
}

/* Finds the own coordinates of `next` that follow from the others, from what the last step's slope predicts; returns 0
 * where they were found. */
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

/* Brings the positions of a state back onto its joints, and s with them, until a correction is small enough; returns 0
 * where that converged. */
static int close_gaps(fu_run *run, fu_state *state, double enough)
{
    const fu_model *model = run->model;
    for (int i = 0;; ++i) {
        if (fu_project_positions(model, state, &run->accelerator, run->work))
            return fu_fail(run, FU_MATRIX, state->v, -1);
        const double size = fu_size(model, run->work);
        if (!(size < FU_RUNS_AWAY) || i == MOST_PROJECTIONS) return fu_fail(run, FU_ITERATION, run->work, -1);
        fu_move(model, state->q, run->work);
        const fu_coupling *failed = fu_solve_coordinates(model, state);
        if (failed) return lost(run, state->v, failed);
        if (size <= enough) return 0;
    }
}

/* Brings a start with small gaps onto its joints, if it is not there; run->closed is how large they are. Returns 0
 * where that converged. */
int fu_close(fu_run *run)
{
    const double rounding = CLOSED * fu_largest_length(run);
    if (fu_project_positions(run->model, &run->now, &run->accelerator, run->work)) return 1;
    run->closed = fu_size(run->model, run->work);
    return run->closed > rounding && close_gaps(run, &run->now, rounding);
}

/* Brings a state back onto its joints, after attitudes are normalised: positions, s, velocities; returns 0 where that
 * converged. */
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

/* Goes from `now` along these dofs, made ones that joints allow and no longer than given, and back onto the joints.
 * `left` is what is left of the couplings' equations then, redundant ones too, in the places of their forces. Returns
 * not zero where there is no way back. */
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

/* Finds the accelerations of a state by eq 38, and with them the couplings' forces; run->force is what supports give,
 * where something moves them. Returns 0 where that was found. */
int fu_complete(fu_run *run, fu_state *state)
{
    const fu_model *model = run->model;
    const int info = fu_accelerations(model, state, &run->accelerator, state->acceleration,
                                      fu_supports_move(model, state) ? run->force : 0);
    if (!info) fu_take_forces(model, &run->accelerator, state);
    return info;
}

/* Returns whether a step is so much shorter than usual, as one to an event or an output time can be, that the rounding
 * of positions would rule a velocity or an acceleration that is made of them. */
int fu_is_short(const fu_run *run, double h)
{
    return h < SHORT_STEP * run->usual;
}

/* Makes such a step, of any length: `next` from `now` by its accelerations, and back onto the joints, but for what the
 * scheme has beside them; returns 0 where that converged. */
int fu_coast(fu_run *run, double h)
{
    const fu_model *model = run->model;
    const fu_state *now = &run->now;
    fu_state *next = &run->next;
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
