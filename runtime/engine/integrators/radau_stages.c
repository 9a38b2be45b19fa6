/* Stages of Radau IIA: their configurations by the quadrature of velocities, their accelerations by eq 38. */
#include "base/clock.h"
#include "bodies/rotation.h"
#include "couplings/common/couplings.h"
#include "equations/equations.h"
#include "events/events.h"
#include "integrators/radau.h"

#include <string.h>

/* of the attitudes' quadrature for each Newton iteration, from the present ones */
#define SWEEPS 4

/* Moves the entries of the stages' q whose rates are dofs by the quadrature of velocities. */
static void integrate(fu_run *run, fu_radau_workspace *w, double h, int at, int dof, int n)
{
    const fu_model *model = run->model;
    const fu_radau_parameters *method = fu_radau_method(run);
    const double *Z = w->Z + dof, *v = run->now.v + dof;
    for (int k = 0; k < STAGES; ++k) {
        double *q = w->q + (long)k * model->n_q + at;
        const double *row = method->A + STAGES * k;
        for (int i = 0; i < n; ++i)
            q[i] = run->now.q[at + i] + h * (method->c[k] * v[i] + row[0] * Z[i] + row[1] * Z[model->n_dof + i] +
                                             row[2] * Z[2 * model->n_dof + i]);
    }
}

/* Moves the stages' dofs by the quadrature of velocities, attitudes by sweeps from the present ones. */
void fu_radau_configure(fu_run *run, fu_radau_workspace *w, double h)
{
    const fu_model *model = run->model;
    const fu_radau_parameters *method = fu_radau_method(run);
    const fu_state *now = &run->now;
    const int n = model->n_dof, n_flexible = model->n_bodies ? model->bodies[0].dof : n;
    integrate(run, w, h, 0, 0, n_flexible);
    FU_EACH_BODY(body, model) {
        integrate(run, w, h, body->configuration + body->kernel->configuration, body->dof + body->kernel->velocity,
                  body->modes);
    }
    for (int sweep = 0; sweep < SWEEPS; ++sweep)
        FU_EACH_BODY(body, model) {
            const int at = body->configuration, size = body->kernel->configuration;
            double rates[STAGES][7], velocity[6];
            for (int k = 0; k < STAGES; ++k) {
                for (int i = 0; i < body->kernel->velocity; ++i)
                    velocity[i] = now->v[body->dof + i] + w->Z[(long)k * n + body->dof + i];
                body->kernel->rate(w->q + (long)k * model->n_q + at, velocity, rates[k]);
            }
            for (int k = 0; k < STAGES; ++k) {
                const double *row = method->A + STAGES * k;
                for (int i = 0; i < size; ++i)
                    w->q[(long)k * model->n_q + at + i] =
                        now->q[at + i] + h * (row[0] * rates[0][i] + row[1] * rates[1][i] + row[2] * rates[2][i]);
            }
        }
}

/* Sets time and dofs of `next` to those of stage k. */
static void move_to_stage(fu_run *run, const fu_radau_workspace *w, int k, double h)
{
    const fu_model *model = run->model;
    fu_state *next = &run->next;
    memcpy(next->q, w->q + (long)k * model->n_q, sizeof(double) * (size_t)model->n_q);
    for (int i = 0; i < model->n_dof; ++i) next->v[i] = run->now.v[i] + w->Z[(long)k * model->n_dof + i];
    next->t = run->now.t + fu_radau_method(run)->c[k] * h;
    if (model->n_motions) fu_prescribe(model, next);
}

int fu_radau_place_stage(fu_run *run, fu_radau_workspace *w, int k, double h)
{
    move_to_stage(run, w, k, h);
    if (fu_find_internal(run)) return 1;
    fu_update_deferred(run, k == 0);
    return 0;
}

void fu_radau_add_internal_dissipation(fu_run *run, fu_radau_workspace *w, double h)
{
    for (int k = 0; k < STAGES; ++k) {
        move_to_stage(run, w, k, h);
        w->powers[2 * k] += fu_internal_dissipation(run->model, run->next.q, run->next.v);
    }
}

/* Stores the multipliers of the last solution of eq 38 as those of stage k. */
void fu_radau_keep_multipliers(fu_run *run, fu_radau_workspace *w, int k)
{
    const long n = run->model->n_multipliers;
    if (run->model->n_needing_reactions)
        memcpy(w->multipliers + k * n, run->accelerator.multipliers, sizeof(double) * (size_t)n);
}

/* Computes the accelerations of all stages, the powers of their couplings and loads; returns 0 on success. */
int fu_radau_evaluate(fu_run *run, fu_radau_workspace *w, double h)
{
    const double begin = fu_clock();
    const fu_model *model = run->model;
    fu_state *next = &run->next;
    fu_radau_configure(run, w, h);
    for (int k = 0; k < STAGES; ++k) {
        if (fu_radau_place_stage(run, w, k, h)) return 1;
        double *reaction = fu_supports_move(model, next) ? run->force : 0;
        if (fu_accelerations(model, next, &run->accelerator, next->acceleration, reaction)) return fu_fail_eq38(run);
        memcpy(w->a + (long)k * model->n_dof, next->acceleration, sizeof(double) * (size_t)model->n_dof);
        w->powers[2 * k] = fu_coupling_dissipation(model, next, &run->accelerator);
        w->powers[2 * k + 1] = fu_external_power(run, next, reaction);
        fu_radau_keep_multipliers(run, w, k + 1);
    }
    run->statistics.evaluations += STAGES;
    run->statistics.time_residual += fu_clock() - begin;
    return 0;
}

void fu_radau_predict(fu_run *run, fu_radau_workspace *w, double h, fu_radau_prediction prediction)
{
    const fu_model *model = run->model;
    const fu_radau_parameters *method = fu_radau_method(run);
    const int n = model->n_dof;
    const double *c = method->c;
    for (int k = 0; k < STAGES; ++k) {
        double weight[STAGES];
        const double x = prediction == FU_BY_LAST_STEP ? 1.0 + c[k] * h / w->h_last : 0.0;
        const double change = prediction == FU_BY_VELOCITY ? 0.0 : c[k] * h;
        for (int j = 0; j < STAGES; ++j) { /* Lagrange on 0 and the nodes */
            weight[j] = x / c[j];
            for (int m = 0; m < STAGES; ++m)
                if (m != j) weight[j] *= (x - c[m]) / (c[j] - c[m]);
        }
        for (int i = 0; i < n; ++i)
            w->Z[(long)k * n + i] = prediction == FU_BY_LAST_STEP
                                        ? weight[0] * w->last[i] + weight[1] * w->last[n + i] +
                                              weight[2] * w->last[2 * n + i] - w->last[2 * n + i]
                                        : change * run->now.acceleration[i];
        memcpy(w->q + (long)k * model->n_q, run->now.q, sizeof(double) * (size_t)model->n_q);
    }
}

/* Adds the stages' powers by their weights, the last row of A, and stores the stages for the next prediction. */
void fu_radau_account(fu_run *run, double h)
{
    fu_radau_workspace *w = fu_radau_space(run);
    const double *b = fu_radau_method(run)->A + STAGES * (STAGES - 1);
    for (int k = 0; k < STAGES; ++k) {
        run->dissipated += h * b[k] * w->powers[2 * k];
        run->external += h * b[k] * w->powers[2 * k + 1];
    }
    memcpy(w->last, w->Z, sizeof(double) * STAGES * (size_t)run->model->n_dof);
    w->h_last = h;
}
