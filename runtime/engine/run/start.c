/* The start of a run, and of its scheme after any discontinuity. */
#include "couplings/common/couplings.h"
#include "equations/equations.h"
#include "equations/scene_size.h"
#include "events/events.h"
#include "events/slack_cables.h"
#include "run/run.h"

#include <math.h>
#include <string.h>

#define REST_MOTION 1e-9 /* of the extent: largest motion of a scene at rest */
/* of the scene's size: least motion to which errors are relative */
#define MIN_MOTION 1e-6
#define MOTION_SAMPLES 64 /* of prescribed motions over the run */
/* of the largest motion that is prescribed: least motion; first errors, which may grow, stay small beside later ones */
#define PRESCRIBED_MOTION_SHARE 0.001
#define FIRST_PERIOD 1e-3 /* of the duration: until then the velocities at the start define the scale of motion */

/* Starts the scheme at `now` with consistent velocities, projected on the joints if requested, and with accelerations
 * and forces from eq 38; returns a status. A start from zero accelerations makes every error first order in the step
 * (tests/benchmarks/order.py). */
int fu_start_scheme(fu_run *run, int project)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    if (project) {
        if (fu_project_velocities(model, now, &run->accelerator, run->before)) return FU_SINGULAR;
        for (int i = 0; i < model->n_dof; ++i) now->v[i] += run->before[i];
    }
    run->residual_at = NAN;
    if (fu_complete(run, now)) return FU_SINGULAR;
    run->dissipated_power = fu_dissipated_power(run, now);
    run->external_power = fu_external_power(run, now, run->force);
    run->drive_step = -1.0;
    fu_coordinate_rates(model, &run->accelerator, run->s_slope);
    return run->integrator->start(run);
}

/* Prepares the first evaluation: a state on its cables, the mass matrix; returns a status. */
int fu_prepare(fu_run *run)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    fu_prescribe(model, now);
    fu_update_history(model, now);
    if (fu_solve_coordinates(model, now)) return FU_SINGULAR;
    if (fu_accelerator_prepare(model, &run->accelerator)) return FU_SINGULAR;
    memset(run->first, 0, sizeof(double) * (size_t)model->n_q);
    run->extent = fu_extent(model, run->first, now->q);
    run->lever = fu_longest_lever(model);
    run->size = fu_scene_size(model, run->first, now->q);
    return FU_RUNNING;
}

/* Computes the first state: on its cables, small gaps closed, velocities consistent with constraints; returns a status.
 * The history of friction starts after the gaps are closed, with the velocities there: the closing of a gap is no
 * motion. */
static int begin_state(fu_run *run)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    const size_t size = sizeof(double) * (size_t)model->n_numbers;
    memcpy(run->next.numbers, now->numbers, size);
    if (fu_prepare(run)) return FU_SINGULAR;
    if (fu_may_start_open(model, now)) {
        if (fu_close(run)) return FU_SINGULAR;
        memcpy(now->numbers, run->next.numbers, size);
        fu_update_history(model, now);
    }
    memcpy(run->first, now->q, sizeof(double) * (size_t)model->n_q);
    if (fu_start_scheme(run, 1)) return FU_SINGULAR;
    fu_update_history(model, now);
    return FU_RUNNING;
}

/* Returns a motion of the dofs in the error of tol that signals prescribe between `now` and the end, m: at most the
 * largest one. */
static double prescribed_motion(fu_run *run)
{
    const fu_model *model = run->model;
    double largest = 0.0;
    memcpy(run->next.q, run->now.q, sizeof(double) * (size_t)model->n_q);
    for (int sample = 1; model->n_motions && sample <= MOTION_SAMPLES; ++sample) {
        run->next.t = run->now.t + (run->duration - run->now.t) * sample / MOTION_SAMPLES;
        fu_prescribe(model, &run->next);
        for (int k = 0; k < model->n_motions; ++k) {
            const int dof = model->motions[k].dof;
            largest = fmax(largest, run->controlled[dof] * fabs(run->next.q[dof] - run->now.q[dof]));
        }
    }
    return largest;
}

/* Starts a run: computes the first state, records the first row; returns a status. run->before then has the change of
 * velocities by constraints. */
int fu_start(fu_run *run)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    run->ceiling = run->duration;
    if (model->proximity) model->proximity->is_known = 0;
    if (begin_state(run)) return FU_SINGULAR;
    if (fu_couplings_can_act(model)) {
        memcpy(run->psi, run->before,
               sizeof(double) * (size_t)model->n_dof); /* velocity change of the start, for the caller */
        const int begun = fu_begin_couplings(run);
        if (begun == FU_ROPE_LEFT && fu_record_row(run) == FU_RUNNING) return begun;
        if (begun || fu_start_scheme(run, 0)) return FU_SINGULAR;
        memcpy(run->before, run->psi, sizeof(double) * (size_t)model->n_dof);
    }
    fu_begin_slackness(run);
    const int recorded = fu_record_row(run);
    if (recorded) return recorded == FU_NO_CONVERGENCE ? recorded : FU_SINGULAR;
    if (run->rest_start) {
        memset(now->acceleration, 0, sizeof(double) * (size_t)model->n_dof);
        memset(now->a, 0, sizeof(double) * (size_t)model->n_dof);
    }
    /* tolerances are relative to the largest motion: at first, that of a thousandth of the duration, and never less
     * than the unavoidable motion of a scene at rest, and the motion that is prescribed */
    if (run->absolute_tol < 0.0) run->absolute_tol = MIN_MOTION * run->tol * run->size;
    run->least_motion = fmax(REST_MOTION * run->extent, PRESCRIBED_MOTION_SHARE * prescribed_motion(run));
    for (int i = 0; i < model->n_dof; ++i) {
        const double t = fmin(run->output_step, FIRST_PERIOD * run->duration);
        const double d = run->controlled[i] * (fabs(now->v[i]) * t + 0.5 * fabs(now->acceleration[i]) * t * t);
        if (d > run->least_motion) run->least_motion = d;
    }
    fu_evaluate_event_functions(run, fu_no_event, INFINITY);
    fu_restart_event_functions(run, -1);
    fu_search_near_pairs(run, 0.0, 1);
    fu_record_penetrations(run);
    return FU_RUNNING;
}
