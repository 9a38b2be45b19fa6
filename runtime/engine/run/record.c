/* Rows of output. */
#include "base/clock.h"
#include "couplings/common/couplings.h"
#include "equations/equations.h"
#include "run/run.h"

#include <math.h>
#include <string.h>

/* Computes accelerations and forces of supports at `now`, by eq 38; from the equations of the last step if Newton's
 * method has evaluated them there; and the elastic energy. Returns 0 if there is one solution. */
static int accelerate(fu_run *run, double *acceleration, double *reaction, double *elastic)
{
    const fu_model *model = run->model;
    const fu_state *now = &run->now;
    *elastic = fu_elastic_energy(model, now);
    if (run->mass_is_near && fabs(now->t - run->residual_at) <= FU_AT_ONCE * run->duration) {
        memcpy(acceleration, now->acceleration, sizeof(double) * (size_t)model->n_dof);
        memcpy(reaction, run->force, sizeof(double) * (size_t)model->n_dof);
        if (!fu_refine_accelerations(model, now->t, now->q, &run->accelerator, acceleration, reaction)) return 0;
    }
    run->mass_is_near = 1;
    return fu_accelerations(model, now, &run->accelerator, acceleration, reaction);
}

/* Records `now` as a row. Returns FU_RUNNING; FU_SINGULAR or FU_UNSTABLE; or FU_NO_CONVERGENCE for a row that is not
 * finite, which does not count. */
int fu_record_row(fu_run *run)
{
    const double begin = fu_clock();
    const fu_model *model = run->model;
    const fu_state *now = &run->now;
    fu_record *r = &run->record;
    const long row = r->n - r->first;
    double *acceleration = r->acceleration + row * model->n_dof;
    r->time[row] = now->t;
    memcpy(r->q + row * model->n_q, now->q, sizeof(double) * (size_t)model->n_q);
    memcpy(r->v + row * model->n_dof, now->v, sizeof(double) * (size_t)model->n_dof);
    memcpy(r->s + row * model->n_coordinates, now->s, sizeof(double) * (size_t)model->n_coordinates);
    int (*const complete)(fu_run *, double *, double *, double *) =
        run->integrator->row ? run->integrator->row : accelerate;
    const int info = complete(run, acceleration, r->reaction + row * model->n_dof, &r->elastic[row]);
    r->kinetic[row] = fu_kinetic_energy_at(model, now);
    r->potential[row] = fu_potential_energy(model, now->q) + fu_coupling_potential_energy(model, now);
    r->dissipated[row] = run->dissipated;
    r->external[row] = run->external;
    if (!info) fu_coupling_outputs(model, now, acceleration, &run->accelerator, r->output + row * model->n_outputs);
    const double energies[FU_ENERGIES] = {r->kinetic[row], r->elastic[row], r->potential[row], run->dissipated,
                                          -run->external};
    run->statistics.time_output += fu_clock() - begin;
    if (!fu_record_is_finite(model, r, row)) {
        if (info) return FU_SINGULAR;
        fu_fail(run, FU_NOT_FINITE, now->v, -1);
        return FU_NO_CONVERGENCE;
    }
    ++r->n;
    run->recorded = now->t;
    return info ? FU_SINGULAR : fu_check_energy_balance(run, energies, row == 0) ? FU_UNSTABLE : FU_RUNNING;
}

/* Records the final row unless that is done; returns FU_EVENT, or the status of a row that cannot be recorded. */
int fu_stop(fu_run *run)
{
    const int recorded = run->now.t > run->recorded ? fu_record_row(run) : FU_RUNNING;
    return recorded ? recorded : FU_EVENT;
}
