/* Deferred events: changes of couplings within a step whose discontinuity of forces is within the permitted error.
 * The forces at the step's end, and at all stages within it, are those of the couplings' state there.
 *
 * An event at a part x of the step makes the force grow as (t - x h) F/(h - x h), to F at the end. A quadrature with
 * weights b at c has an error of a part of F h in the momentum: |(1 - x)/2 - sum over c > x of b (c - x)/(1 - x)|.
 * That is the error of velocities. Times h it counts as a local error of positions, since errors of velocities
 * persist and the permitted error is h/t of the whole. Estimates of integrators do not replace it: they assume
 * smooth forces, and may vanish by chance.
 *
 * A discrete gradient of the energy is the mean force over the path, also across events: it conserves the energy,
 * has hardly a larger error than without events, and defers all of them, at steps of any kind. */
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "equations/equations.h"
#include "equations/run.h"
#include "equations/step_control.h"
#include "events/events.h"
#include "events/slack_cables.h"

#include <math.h>
#include <string.h>

#define DEFERRED_ERROR_FACTOR 2.0 /* the counted error over the bound, since the errors of many events add up */
/* of a step: uncertainty of the instant of an event, for the bound of its error */
#define PART_UNCERTAINTY 0.1
#define SCANNED_INSTANTS 8 /* number of instants evaluated on either side */

static int has_passed(const fu_run *run, const fu_coupling *c)
{
    const size_t size = sizeof(int) * (size_t)c->type->n_flags;
    return fu_can_defer(c) && memcmp(run->now.flags + c->flags, run->next.flags + c->flags, size) != 0;
}

/* Updates the flags of the couplings of `next`, unless they must keep those of `now`; returns whether that changes
 * them. First: it is the first stage of the step, or the only one. */
int fu_update_deferred(fu_run *run, int first)
{
    const fu_model *model = run->model;
    int changed = 0;
    if (run->keep_forces) return 0;
    FU_EACH_COUPLING(c, model->always_active, model->n_deferring ? model->n_always_active : 0)
        changed |= fu_can_defer(c) && c->events->deferred->update_flags(model, c, &run->now, &run->next);
    const int count = model->n_deferring ? fu_count_deferred(run) : 0;
    if (first || count > run->max_deferred) run->max_deferred = count;
    return changed;
}

/* Returns whether a stage of the last step had an event that its end has not: then its error has no bound. */
int fu_has_unbounded_error(const fu_run *run)
{
    return !run->keep_forces && run->model->n_deferring && run->max_deferred > fu_count_deferred(run);
}

/* Returns the number of couplings with an event in the step. */
int fu_count_deferred(const fu_run *run)
{
    int count = 0;
    FU_EACH_COUPLING(c, run->model->always_active, run->model->n_deferring ? run->model->n_always_active : 0)
        count += has_passed(run, c);
    return count;
}

/* Resets the couplings of `next` to their state in `now`, for a repetition of the rest of the step. */
void fu_undo_deferred(fu_run *run)
{
    run->keep_forces = 1;
    FU_EACH_COUPLING(c, run->model->always_active, run->model->n_deferring ? run->model->n_always_active : 0) {
        if (!has_passed(run, c)) continue;
        memcpy(run->next.flags + c->flags, run->now.flags + c->flags, sizeof(int) * (size_t)c->type->n_flags);
        run->factored = 0;
    }
}

/* Records the events of couplings in the step that is about to be accepted, for the caller. */
void fu_record_deferred(fu_run *run, double h)
{
    for (int k = 0; k < run->n_event_functions && run->model->n_deferring; ++k) {
        const fu_coupling *c = fu_event_coupling(run, k);
        if (!c || !has_passed(run, c)) continue;
        const double part = c->events->deferred->part(run->model, c, &run->now, &run->next, h,
                                                      !run->integrator->keeps_energy, &run->deferred[k]);
        run->deferred_at[k] = run->now.t + part * h;
    }
}

/* Returns the quadrature error of the momentum, over F h, of a force that grows to F from a part x of the step on. */
static double defect(fu_quadrature rule, double x)
{
    double sum = 0.5 * (1.0 - x);
    for (int k = 0; k < rule.n; ++k)
        if (rule.c[k] > x) sum -= rule.b[k] * (rule.c[k] - x) / (1.0 - x);
    return fabs(sum);
}

/* Returns the largest error for instants near x, within its uncertainty. */
static double largest_defect(fu_quadrature rule, double x)
{
    double worst = 0.0;
    for (int i = -SCANNED_INSTANTS; i <= SCANNED_INSTANTS; ++i) {
        const double at = x + PART_UNCERTAINTY * i / SCANNED_INSTANTS;
        if (at >= 0.0 && at < 1.0) worst = fmax(worst, defect(rule, at));
    }
    return worst;
}

/* Returns the size of the response to a force in a time with this square, s^2; by the matrix of the step, if there is
 * one, so that unresolved vibrations count by their amplitude and not by their acceleration. */
static double size_of_response(fu_run *run, const double *force, double square)
{
    const fu_model *model = run->model;
    if (run->integrator->has_matrix) {
        fu_gather(model, force, run->rhs);
        for (int i = 0; i < model->n_extra; ++i) run->rhs[model->n_band + model->n_border_dof + i] = 0.0;
        fu_system_solve(&run->newton, model->lapack, run->rhs);
        fu_spread(model, run->rhs, run->work);
    } else {
        if (fu_prepare_response(model, &run->next, &run->accelerator)) return INFINITY;
        fu_response(model, &run->accelerator, force, run->work);
    }
    for (int i = 0; i < model->n_dof; ++i) run->work[i] *= square;
    return fu_error_size(run, run->work, fu_allowed_elsewhere(run));
}

/* Returns the local error of positions by deferred events of the last step, m. */
double fu_deferred_error(fu_run *run, double h)
{
    const fu_model *model = run->model;
    if (!run->integrator->quadrature || !fu_count_deferred(run)) return 0.0;
    memset(run->before, 0, sizeof(double) * (size_t)model->n_dof);
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active) {
        const char *unused;
        if (!has_passed(run, c)) continue;
        const double x =
            c->events->deferred->part(model, c, &run->now, &run->next, h, !run->integrator->keeps_energy, &unused);
        const double part = largest_defect(run->integrator->quadrature(run), x);
        c->events->deferred->force_change(model, c, &run->now, &run->next, part, run->before);
    }
    return size_of_response(run, run->before, DEFERRED_ERROR_FACTOR * h * h);
}

/* Returns the local error of positions, m, by forces of the last step that are not smooth, which its estimate may miss:
 * an error of momentum persists for the rest of the run. */
double fu_friction_error(fu_run *run, double h)
{
    const fu_model *model = run->model;
    const fu_integrator *integrator = run->integrator;
    if (!integrator->quadrature || !integrator->has_matrix || run->order <= 2 || run->fixed_step > 0.0) return 0.0;
    const fu_quadrature rule = integrator->quadrature(run);
    memset(run->before, 0, sizeof(double) * (size_t)model->n_dof);
    if (!fu_coupling_quadrature_error(model, &run->now, &run->next, rule.n, rule.b, rule.c, run->before)) return 0.0;
    return size_of_response(run, run->before, h * h);
}

/* Computes the earliest unreported deferred event or slack cable the event of the run; returns 0 if there is none. */
int fu_take_deferred(fu_run *run)
{
    int first = -1;
    for (int k = 0; k < run->n_event_functions && run->model->n_deferring; ++k)
        if (run->deferred[k] && (first < 0 || run->deferred_at[k] < run->deferred_at[first])) first = k;
    if (fu_take_slackness(run, first < 0 ? INFINITY : run->deferred_at[first])) return 1;
    if (first < 0) return 0;
    run->event = (fu_event){FU_DEFERRED, run->event_functions[first].index, 0, run->deferred[first]};
    run->event_time = run->deferred_at[first];
    run->deferred[first] = 0;
    return 1;
}
