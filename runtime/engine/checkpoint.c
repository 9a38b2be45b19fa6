/* Checkpoints: what the steps to come depend on, so that a run that is taken up again goes on bit for bit. */
#include "engine.h"

#include <stddef.h>
#include <string.h>

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
    const size_t dofs = sizeof(double) * (size_t)model->n_dof, joints = (size_t)model->n_joints;
    copy(c, &state->t, sizeof state->t);
    copy(c, state->q, sizeof(double) * (size_t)model->n_q);
    copy(c, state->v, dofs);
    copy(c, state->acceleration, dofs);
    copy(c, state->a, dofs);
    copy(c, state->s, sizeof(double) * joints);
    copy(c, state->f, 3 * sizeof(double) * joints);
    copy(c, state->spring, 3 * sizeof(double) * (size_t)model->n_springs);
    copy(c, state->multipliers, 6 * sizeof(double) * (size_t)model->n_links);
    copy(c, state->hold, sizeof(double) * joints);
    copy(c, state->element, sizeof(int) * joints);
    copy(c, state->mode, sizeof(int) * joints);
    copy(c, state->way, sizeof(int) * joints);
    copy(c, state->contact, sizeof(int) * joints);
    copy(c, state->director, 3 * sizeof(double) * joints);
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
    copy(c, run->s_slope, sizeof(double) * (size_t)model->n_joints);
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

/* Take up again, after fu_start of the same model and settings; the rows before are not in the arrays. */
void fu_restore(fu_run *run, const char *bytes)
{
    copier c = {(char *)bytes, 0, RESTORE};
    copy_all(&c, run);
    run->record.first = run->record.n;
}
