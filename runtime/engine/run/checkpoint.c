/* Checkpoints: what the steps to come depend on, so that a run that is taken up again goes on bit for bit. */
#include "engine.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define ASIDE 1e-3       /* of an element: how far from it a slide may stand, which events leave much nearer */
#define SHORTEST 1e-13   /* of the duration: a step, or what steps stay below; the time loop gives up before */
#define LONGEST 2.0      /* of the duration: the same */
#define MOST_COUNT 100000 /* of rejected steps, of turns on a boundary */

enum { MEASURE, SAVE, RESTORE };

typedef struct {
    char *at;
    long size;
    int what;
} copier;

static void copy(copier *c, void *data, size_t size)
{
    if (c->what == SAVE) memcpy(c->at, data, size);
    if (c->what == RESTORE) memcpy(data, c->at, size);
    if (c->what != MEASURE) c->at += size;
    c->size += (long)size;
}

static void copy_state(copier *c, const fu_model *model, fu_state *state)
{
    const size_t dofs = sizeof(double) * (size_t)model->n_dof, slides = (size_t)model->n_slides;
    copy(c, &state->t, sizeof state->t);
    copy(c, state->q, sizeof(double) * (size_t)model->n_q);
    copy(c, state->v, dofs);
    copy(c, state->acceleration, dofs);
    copy(c, state->a, dofs);
    copy(c, state->s, sizeof(double) * slides);
    copy(c, state->f, 3 * sizeof(double) * slides);
    copy(c, state->spring, 3 * sizeof(double) * (size_t)model->n_springs);
    copy(c, state->multipliers, 6 * sizeof(double) * (size_t)model->n_joints);
    copy(c, state->locked_s, sizeof(double) * slides);
    copy(c, state->element, sizeof(int) * slides);
    copy(c, state->mode, sizeof(int) * slides);
    copy(c, state->slip_direction, sizeof(int) * slides);
    copy(c, state->contact, sizeof(int) * slides);
    copy(c, state->director, 3 * sizeof(double) * slides);
    copy(c, state->memory, sizeof(double) * (size_t)model->n_memory);
}

/* The list of it. Factored matrices are not in it: fu_pause drops the Newton matrix, and fu_start makes that of eq 38. */
static void copy_all(copier *c, fu_run *run)
{
    const fu_model *model = run->model;
    const size_t numbers = offsetof(fu_run, h);
    copy_state(c, model, &run->now);
    copy_state(c, model, &run->next);
    copy(c, run->first, sizeof(double) * (size_t)model->n_q);
    copy(c, run->s_slope, sizeof(double) * (size_t)model->n_slides);
    copy(c, run->watched, sizeof(double) * (size_t)run->n_watches);
    copy(c, run->late, sizeof(int) * (size_t)run->n_watches);
    copy(c, &run->record.n, sizeof run->record.n);
    copy(c, &run->statistics, sizeof run->statistics);
    copy(c, &run->accelerator.evaluated, sizeof run->accelerator.evaluated);
    copy(c, (char *)run + numbers, sizeof *run - numbers);
}

/* Forget what a checkpoint does not hold. Done at each pause whether a checkpoint is taken or not, so that results do
 * not depend on it. */
void fu_pause(fu_run *run)
{
    run->factored = run->predictor = 0;
    run->h_factored = 0.0;
}

/* Copy it to `bytes`, null to learn the number of them, which is returned. */
long fu_save(const fu_run *run, char *bytes)
{
    copier c = {bytes, 0, bytes ? SAVE : MEASURE};
    copy_all(&c, (fu_run *)run);
    return c.size;
}

static int in_range(int value, int least, int most)
{
    return value >= least && value <= most;
}

/* the last of n, or 0, as which it is when there is none and nothing has happened */
static int last_of(int n)
{
    return n > 0 ? n - 1 : 0;
}

/* whether a slide can be in its mode: only then is there room for the multiplier that holds it */
static int possible_mode(const fu_slide *slide, int mode)
{
    const fu_end_stop *ends = slide->stops;
    if (mode == FU_LEFT) return ends[0].kind == FU_END_IS_OPEN || ends[1].kind == FU_END_IS_OPEN;
    if (slide->drive >= 0) return mode == FU_LOCKED;
    if (mode == FU_LOCKED) return slide->sticks || ends[0].kind == FU_END_IS_HARD || ends[1].kind == FU_END_IS_HARD;
    return mode == FU_SLIDES;
}

/* whether what tells where slides are can be: it leads to places in memory */
static int possible_places(const fu_model *model, const fu_state *state)
{
    for (int j = 0; j < model->n_slides; ++j) {
        const fu_slide *slide = &model->slides[j];
        if (!in_range(state->element[j], 0, model->cables[slide->cable].n_elements - 1)) return 0;
        if (!possible_mode(slide, state->mode[j])) return 0;
        if (!in_range(state->slip_direction[j], -1, 1) || !in_range(state->contact[j], -1, 1)) return 0;
    }
    return 1;
}

static int slides_on_their_elements(const fu_model *model, const fu_state *state)
{
    for (int j = 0; j < model->n_slides; ++j) {
        const double length = model->cables[model->slides[j].cable].length;
        const double x = state->s[j] - fu_element_start(model, j, state->element[j]);
        if (state->mode[j] != FU_LEFT && !(x >= -ASIDE * length && x <= (1.0 + ASIDE) * length)) return 0;
    }
    return 1;
}

static int finite_state(const fu_model *model, const fu_state *state)
{
    return fu_all_finite(&state->t, 1) && fu_all_finite(state->q, model->n_q) && fu_all_finite(state->v, model->n_dof) &&
           fu_all_finite(state->acceleration, model->n_dof) && fu_all_finite(state->a, model->n_dof) &&
           fu_all_finite(state->s, model->n_slides) && fu_all_finite(state->f, 3L * model->n_slides) &&
           fu_all_finite(state->spring, 3L * model->n_springs) && fu_all_finite(state->multipliers, 6L * model->n_joints) &&
           fu_all_finite(state->locked_s, model->n_slides) && fu_all_finite(state->director, 3L * model->n_slides) &&
           fu_all_finite(state->memory, model->n_memory);
}

/* whether a run stands where fu_pause leaves one: at the time of its last row, without a factored matrix */
static int is_paused(const fu_run *run, int rows)
{
    return run->record.n == rows && run->now.t == (rows - 1) * run->output_step && run->now.t < run->duration &&
           run->recorded == run->now.t && !run->factored && !run->predictor && run->h_factored == 0.0;
}

/* whether the numbers that lead the steps to come, and those that messages tell, can be */
static int possible_numbers(const fu_run *run)
{
    const fu_model *model = run->model;
    const double positive[] = {run->h, run->ceiling};
    const double numbers[] = {run->motion, run->least_motion, run->extent, run->contraction, run->since, run->dissipated,
                              run->dissipated_power, run->external, run->external_power, run->drive_power,
                              run->drive_power_before, run->drive_step, run->closed, run->allowed,
                              run->round_off, run->newton_tolerance, run->statistics.h_min, run->statistics.h_max,
                              run->statistics.error_sum, run->balance.exchanged, run->balance.grown, run->balance.lost};
    const long counts[] = {run->statistics.steps, run->statistics.rejected, run->statistics.newton_iterations,
                           run->statistics.factorisations, run->statistics.crossings, run->statistics.newton_failures,
                           run->statistics.evaluations, run->accelerator.evaluated};
    for (size_t i = 0; i < sizeof positive / sizeof *positive; ++i)
        if (!(positive[i] >= SHORTEST * run->duration && positive[i] <= LONGEST * run->duration)) return 0;
    for (size_t i = 0; i < sizeof counts / sizeof *counts; ++i)
        if (counts[i] < 0) return 0;
    for (int k = 0; k < run->n_watches; ++k)
        if (!in_range(run->late[k], -1, 1)) return 0;
    return fu_all_finite(numbers, sizeof numbers / sizeof *numbers) && fu_all_finite(run->balance.first, FU_ENERGIES) &&
           fu_all_finite(run->first, model->n_q) && fu_all_finite(run->s_slope, model->n_slides) &&
           run->motion >= 0.0 && run->least_motion >= 0.0 && run->extent >= 0.0 &&
           in_range(run->stopped_joint, 0, last_of(model->n_slides)) &&
           in_range(run->turned, 0, MOST_COUNT) && in_range(run->holds, 0, 1) && in_range(run->rest_start, 0, 1) &&
           in_range(run->net_rejections, -MOST_COUNT, MOST_COUNT) && in_range(run->failure.cause, FU_NO_FAILURE, FU_JAM) &&
           in_range(run->failure.dof, 0, last_of(model->n_dof)) &&
           in_range(run->failure.slide, -1, last_of(model->n_slides));
}

/* Take up again, after fu_start of the same model and settings; the rows before, so many, are not in the arrays. Not zero
 * where the bytes are of no run that could have paused there: it must not go on then. */
int fu_restore(fu_run *run, const char *bytes, int rows)
{
    copier c = {(char *)bytes, 0, RESTORE};
    copy_all(&c, run);
    run->record.first = run->record.n;
    return !(is_paused(run, rows) && possible_places(run->model, &run->now) && possible_places(run->model, &run->next) &&
             finite_state(run->model, &run->now) && slides_on_their_elements(run->model, &run->now) &&
             possible_numbers(run));
}
