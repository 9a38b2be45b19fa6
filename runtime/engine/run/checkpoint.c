/* Checkpoints: all data on which later steps depend, so that a resumed run continues bit for bit. */
#include "couplings/common/couplings.h"
#include "couplings/common/proximity.h"
#include "equations/run.h"
#include "events/events.h"
#include "events/slack_cables.h"
#include "run/run.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* Wide bounds of a state in which a run has paused: bytes beyond them are damaged or forged. */
/* of a path segment: largest distance of a coupling from it; events leave it within 1e-6 */
#define MAX_SEGMENT_DISTANCE 1e-3
#define MIN_STEP 1e-13   /* of the duration: a step, or a bound of steps; a run ends at 1e-12 */
#define MAX_STEP 2.0     /* of the duration: a step, or a bound of steps */
#define MAX_COUNT 100000 /* rejected steps, and reversals on a boundary; a run ends at 10000 */

enum { MEASURE, SAVE, RESTORE };

/* The position in the bytes, their number so far, and the direction of the copy. */
typedef struct {
    char *at;
    long size;
    int what;
} copier;

/* Copies bytes to the checkpoint or from it, or counts them. */
static void copy(copier *c, void *data, size_t size)
{
    if (c->what == SAVE) memcpy(c->at, data, size);
    if (c->what == RESTORE) memcpy(data, c->at, size);
    if (c->what != MEASURE) c->at += size;
    c->size += (long)size;
}

/* Copies a state: its time and all its arrays. */
static void copy_state(copier *c, const fu_model *model, fu_state *state)
{
    copy(c, &state->t, sizeof state->t);
    for (int k = 0; k < FU_N_STATE_ARRAYS; ++k) {
        const fu_array array = fu_state_array(model, state, k);
        copy(c, array.data, array.size * (size_t)array.items);
    }
}

/* Copies inputs and the signals that they give. */
static void copy_inputs(copier *c, fu_run *run)
{
    const fu_inputs *all = run->inputs;
    copy(c, all->inputs, sizeof *all->inputs * (size_t)all->n);
    for (int i = 0; i < all->n_signals; ++i) {
        const fu_signal *signal = &run->model->signals[all->signals[i].signal];
        copy(c, (double *)signal->breaks, 2 * sizeof(double));
        copy(c, (double *)signal->coefficients, FU_SIGNAL_TERMS * sizeof(double));
    }
}

/* Copies all data on which later steps depend. Factored matrices are left out: fu_pause drops the Newton matrix, and
 * fu_start computes that of eq 38. */
static void copy_all(copier *c, fu_run *run)
{
    const fu_model *model = run->model;
    const size_t numbers = offsetof(fu_run, h);
    copy_state(c, model, &run->now);
    copy_state(c, model, &run->next);
    copy(c, run->first, sizeof(double) * (size_t)model->n_q);
    copy(c, run->s_slope, sizeof(double) * (size_t)model->n_coordinates);
    copy(c, run->event_values, sizeof(double) * (size_t)run->n_event_functions);
    if (run->integrator->keeps_scratch) copy(c, run->scratch, sizeof(double) * (size_t)run->integrator->n_scratch(run));
    copy(c, run->late, sizeof(int) * (size_t)run->n_event_functions);
    copy(c, run->slackness, sizeof *run->slackness * (size_t)model->n_cables);
    copy(c, &run->record.n, sizeof run->record.n);
    copy(c, &run->statistics, sizeof run->statistics);
    copy(c, &run->accelerator.evaluated, sizeof run->accelerator.evaluated);
    if (run->inputs) copy_inputs(c, run);
    copy(c, (char *)run + numbers, sizeof *run - numbers);
}

/* Drops the data that a checkpoint does not hold, and evaluates all event functions, since a checkpoint does not record
 * which are inactive. Done at each pause, so that results do not depend on checkpoints. */
void fu_pause(fu_run *run)
{
    run->factored = 0;
    run->h_factored = 0.0;
    run->residual_at = NAN;
    run->mass_is_near = 0;
    if (run->integrator->forget) run->integrator->forget(run);
    fu_evaluate_far_event_functions(run);
}

/* Copies the data on which later steps depend to `bytes`, unless it is null; returns their number of bytes. */
long fu_save(const fu_run *run, char *bytes)
{
    copier c = {bytes, 0, bytes ? SAVE : MEASURE};
    copy_all(&c, (fu_run *)run);
    return c.size;
}

/* Returns whether a value is in a range. */
static int in_range(int value, int least, int most)
{
    return value >= least && value <= most;
}

/* Returns the last index of n, or 0, the value of an unused index. */
static int last_of(int n)
{
    return n > 0 ? n - 1 : 0;
}

/* Returns whether all real numbers of a state are finite. */
static int finite_state(const fu_model *model, const fu_state *state)
{
    for (int k = 0; k < FU_N_STATE_ARRAYS; ++k) {
        const fu_array array = fu_state_array(model, state, k);
        if (array.is_real && !fu_all_finite(array.data, array.items)) return 0;
    }
    return fu_all_finite(&state->t, 1);
}

/* Returns whether the values of inputs, and their signals, are possible. */
static int possible_inputs(const fu_run *run)
{
    const fu_inputs *all = run->inputs;
    for (int k = 0; k < all->n; ++k) {
        const fu_input *input = &all->inputs[k];
        const double numbers[] = {input->since, input->value, input->rate};
        if (!fu_all_finite(numbers, 3) || !in_range(input->is_new, 0, 1)) return 0;
    }
    for (int i = 0; i < all->n_signals; ++i) {
        const fu_signal *signal = &run->model->signals[all->signals[i].signal];
        if (!fu_all_finite(signal->breaks, 2) || !fu_all_finite(signal->coefficients, FU_SIGNAL_TERMS)) return 0;
    }
    return 1;
}

/* Returns whether a run is in a state of fu_pause: at the time of its last row, an output time unless it may be between
 * them, without a factored matrix */
static int is_paused(const fu_run *run, int rows, int between)
{
    return run->record.n == rows && (between || run->now.t == (rows - 1) * run->output_step) &&
           run->now.t < run->duration && run->recorded == run->now.t && !run->factored && run->h_factored == 0.0 &&
           (!run->inputs || possible_inputs(run));
}

/* Returns whether the counts of steps and events are possible. */
static int possible_counts(const fu_run *run)
{
    const fu_statistics *s = &run->statistics;
    const long counts[] = {s->steps,         s->rejected,        s->newton_iterations, s->factorisations,
                           s->node_passages, s->newton_failures, s->evaluations,       run->accelerator.evaluated};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; ++i)
        if (counts[i] < 0) return 0;
    for (int k = 0; k < run->n_event_functions; ++k)
        if (!in_range(run->late[k], -1, 1)) return 0;
    return fu_possible_slackness(run) && in_range(run->turned, 0, MAX_COUNT) &&
           in_range(run->net_rejections, -MAX_COUNT, MAX_COUNT);
}

/* Returns whether flags, and indices of couplings and dofs, are possible: some address memory. */
static int possible_indices(const fu_run *run)
{
    const int last = last_of(run->model->n_couplings);
    return in_range(run->stopped_slide, 0, last) && in_range(run->left, 0, last) &&
           in_range(run->keep_segments, 0, 1) && in_range(run->keep_forces, 0, 1) &&
           in_range(run->last_event_deferred, 0, 1) && in_range(run->rest_start, 0, 1) &&
           in_range(run->failure.cause, FU_NO_FAILURE, FU_SELF_LOCKING) &&
           in_range(run->failure.dof, 0, last_of(run->model->n_dof)) && in_range(run->failure.coupling, -1, last);
}

/* Returns whether the numbers on which later steps and messages depend are possible. */
static int possible_numbers(const fu_run *run)
{
    const double steps[] = {run->h, run->ceiling};
    const double positive[] = {run->motion, run->least_motion, run->extent, run->controlled_motion};
    const double numbers[] = {run->contraction,       run->since,
                              run->dissipated,        run->dissipated_power,
                              run->external,          run->external_power,
                              run->drive_power,       run->drive_power_before,
                              run->drive_step,        run->closed,
                              run->allowed,           run->round_off,
                              run->newton_tolerance,  run->statistics.h_min,
                              run->statistics.h_max,  run->statistics.error_sum,
                              run->balance.exchanged, run->balance.grown,
                              run->balance.lost,      run->heat_owed};
    for (size_t i = 0; i < sizeof steps / sizeof *steps; ++i)
        if (!(steps[i] >= MIN_STEP * run->duration && steps[i] <= MAX_STEP * run->duration)) return 0;
    for (size_t i = 0; i < sizeof positive / sizeof *positive; ++i)
        if (!(positive[i] >= 0.0 && isfinite(positive[i]))) return 0;
    return fu_all_finite(numbers, sizeof numbers / sizeof *numbers) && fu_all_finite(run->balance.first, FU_ENERGIES) &&
           (!run->integrator->keeps_scratch || fu_all_finite(run->scratch, run->integrator->n_scratch(run))) &&
           run->matrix_steps >= 0 && run->matrix_cost >= 0.0 && isfinite(run->matrix_cost) &&
           fu_all_finite(run->first, run->model->n_q) && fu_all_finite(run->s_slope, run->model->n_coordinates);
}

/* Resumes a run after fu_start of the same model and settings; the `rows` earlier rows are not in the arrays. between:
 * whether the run may be between output times. Returns nonzero if no run could have paused with these bytes: the run
 * must not continue. */
int fu_restore(fu_run *run, const char *bytes, int rows, int between)
{
    copier c = {(char *)bytes, 0, RESTORE};
    copy_all(&c, run);
    run->record.first = run->record.n;
    run->may_be_late = 1;
    if (run->model->proximity) run->model->proximity->is_known = 0;
    return !(is_paused(run, rows, between) && fu_is_possible(run->model, &run->now) &&
             fu_is_possible(run->model, &run->next) && finite_state(run->model, &run->now) &&
             fu_are_on_path_segments(run->model, &run->now, MAX_SEGMENT_DISTANCE) && possible_counts(run) &&
             possible_indices(run) && possible_numbers(run));
}
