/* Passages: changes of couplings that a step goes over, as the jump that they make in its forces is within what is allowed. The
 * step's end has the forces of what couplings are there; its error counts the jump (integrators/genalpha.c). */
#include "engine.h"

#include <math.h>
#include <string.h>

/* Returns whether steps may go over changes of a coupling. */
int fu_can_pass(const fu_coupling *coupling)
{
    return fu_can_act(coupling) && coupling->type->events->pass;
}

static int has_passed(const fu_run *run, const fu_coupling *c)
{
    const size_t size = sizeof(int) * (size_t)c->type->n_flags;
    return fu_can_pass(c) && memcmp(run->now.flags + c->flags, run->next.flags + c->flags, size) != 0;
}

/* Gives the couplings of `next` the flags that follow from where it is, unless they are to keep those of `now`. The matrix is of the
 * flags that it was made with. */
void fu_choose_passages(fu_run *run)
{
    const fu_model *model = run->model;
    if (run->keep_forces) return;
    for (int k = 0; k < model->n_couplings && model->n_passing; ++k) {
        const fu_coupling *c = model->couplings[k];
        if (fu_can_pass(c) && c->type->events->pass(model, c, &run->now, &run->next)) run->factored = 0;
    }
}

/* Returns how many couplings have passed something in the step. */
int fu_count_passages(const fu_run *run)
{
    int count = 0;
    for (int k = 0; k < run->model->n_couplings && run->model->n_passing; ++k) count += has_passed(run, run->model->couplings[k]);
    return count;
}

/* Lets the couplings of `next` be as in `now`, for the rest of the step to be made so. */
void fu_undo_passages(fu_run *run)
{
    run->keep_forces = 1;
    for (int k = 0; k < run->model->n_couplings && run->model->n_passing; ++k) {
        const fu_coupling *c = run->model->couplings[k];
        if (!has_passed(run, c)) continue;
        memcpy(run->next.flags + c->flags, run->now.flags + c->flags, sizeof(int) * (size_t)c->type->n_flags);
        run->factored = 0;
    }
}

/* Notes what couplings pass in the step that is about to be accepted, for the caller to learn of it. */
void fu_note_passages(fu_run *run, double h)
{
    for (int k = 0; k < run->n_watches && run->model->n_passing; ++k) {
        const fu_coupling *c = fu_own_coupling(run, k);
        if (!c || !has_passed(run, c)) continue;
        const double part = c->type->events->passed(run->model, c, &run->now, &run->next, h, &run->passed[k]);
        run->passed_at[k] = run->now.t + part * h;
    }
}

/* Adds to f, times a factor, by how much forces at `next` differ from those without the step's passages. */
void fu_add_passed_forces(const fu_run *run, double factor, double *f)
{
    for (int k = 0; k < run->model->n_couplings && run->model->n_passing; ++k) {
        const fu_coupling *c = run->model->couplings[k];
        if (has_passed(run, c)) c->type->events->passed_force(run->model, c, &run->now, &run->next, factor, f);
    }
}

/* Makes the earliest of passages and slack cables that the caller does not know of the run's event; returns 0 where there is none. */
int fu_take_passage(fu_run *run)
{
    int first = -1;
    for (int k = 0; k < run->n_watches && run->model->n_passing; ++k)
        if (run->passed[k] && (first < 0 || run->passed_at[k] < run->passed_at[first])) first = k;
    if (fu_take_slackness(run, first < 0 ? INFINITY : run->passed_at[first])) return 1;
    if (first < 0) return 0;
    run->event = (fu_event){FU_PASSED, run->watches[first].index, 0, run->passed[first]};
    run->event_time = run->passed_at[first];
    run->passed[first] = 0;
    return 1;
}
