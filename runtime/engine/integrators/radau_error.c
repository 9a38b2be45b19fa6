/* The local error of Radau IIA. */
#include "bodies/unknowns.h"
#include "equations/equations.h"
#include "equations/step_control.h"
#include "integrators/radau.h"

#include <math.h>

/* factor of the estimate for vibrations: their errors alternate in sign */
#define VIBRATION_FACTOR 0.5
#define EMBEDDED_FACTOR 0.08 /* factor of the embedded estimate, whose order is too low */
/* factor where motions, drives or friction excite vibrations, whose errors then grow with them */
#define FED_VIBRATION_FACTOR 4.0
#define FED_EMBEDDED_FACTOR 0.1
/* factor where bodies rotate: lost vibrations change the rotation permanently */
#define TURNING_VIBRATION_FACTOR 2.0
#define TURNING_EMBEDDED_FACTOR 0.1 /* since the matrix contains no rotations */
/* of the permitted error: least rotation of a body within a step, as a length, that counts */
#define MIN_TURN_SHARE 0.01
#define REPORTED_FACTOR 2.0 /* factor of the estimate for vibrations in the report of fixed steps */
/* of the total permitted error: that of vibrations which a step does not resolve */
#define VIBRATION_SHARE 0.1
#define FRICTION_ERROR_SHARE 0.15 /* of tol: permitted error of one kink of friction */

/* Returns the largest error of a kink of a force within the step, relative to the permitted one, m. Kinks are single
 * events, so that one may have a share of tol in a step of any size. */
static double friction_error(fu_run *run, fu_radau_workspace *w, double h)
{
    const fu_model *model = run->model;
    const double *c = fu_radau_method(run)->c, left = run->duration - run->now.t;
    const double weight[STAGES + 1] = {0.5 * c[0], 0.5 * c[1], 0.5 * (c[2] - c[0]), 0.5 * (c[2] - c[1])};
    double worst = 0.0;
    if (!model->n_needing_reactions) return 0.0;
    if (fu_accelerations(model, &run->now, &run->accelerator, run->work, 0)) return INFINITY;
    fu_radau_keep_multipliers(run, w, 0);
    ++run->statistics.evaluations;
    FU_EACH_COUPLING(coupling, model->always_active, model->n_always_active) {
        if (!coupling->type->errors || !coupling->type->errors->friction) continue;
        worst = fmax(worst, coupling->type->errors->friction(model, coupling, &run->next, STAGES + 1, weight,
                                                             w->multipliers, h * left));
    }
    return worst * run->allowed / (FRICTION_ERROR_SHARE * fu_allowed_error(run));
}

/* Computes run->work = (M + (h/L) D + (h/L)^2 K)^-1 M r on the joints, for the real L; returns its size as a length. */
static double filtered(fu_run *run, fu_radau_workspace *w, const double *r)
{
    const fu_model *model = run->model;
    fu_radau_right_side(run, r, w->unknowns);
    fu_system_solve(&run->newton, model->lapack, run->rhs);
    for (int i = 0; i < model->n_extra; ++i) run->rhs[model->n_band + model->n_border_dof + i] = 0.0;
    fu_spread(model, run->rhs, run->work);
    return fu_error_size(run, run->work, fu_allowed_elsewhere(run));
}

/* Computes in run->work the part of run->work that the filter removes; returns the size of the rest. */
static double take_filtered(fu_run *run, fu_radau_workspace *w)
{
    const int n = run->model->n_dof;
    for (int i = 0; i < n; ++i) w->w[i] = w->w[n + i] = run->work[i];
    const double left = filtered(run, w, w->w);
    for (int i = 0; i < n; ++i) run->work[i] = w->w[n + i] - run->work[i];
    return left;
}

/* Computes in run->work the embedded estimate E of the error; returns its size as a length. */
static double embedded(fu_run *run, fu_radau_workspace *w, double h)
{
    const fu_radau_parameters *method = fu_radau_method(run);
    const int n = run->model->n_dof;
    const double real = h / method->gamma, *e = method->error;
    for (int i = 0; i < n; ++i) {
        double by_velocity = run->now.acceleration[i], by_position = run->now.v[i];
        for (int k = 0; k < STAGES; ++k) {
            const double *row = method->A + STAGES * k;
            by_velocity += e[k] * w->Z[(long)k * n + i] / h;
            by_position += e[k] * (method->c[k] * run->now.v[i] + row[0] * w->Z[i] + row[1] * w->Z[n + i] +
                                   row[2] * w->Z[2 * n + i]);
        }
        w->w[i] = real * real * by_velocity + real * by_position;
    }
    return filtered(run, w, w->w);
}

/* Returns whether a body rotates within the step. */
static int turns(const fu_run *run, double h)
{
    const fu_model *model = run->model;
    FU_EACH_BODY(body, model)
        for (int i = body->dof + body->kernel->dim; i < body->dof + body->kernel->velocity; ++i)
            if (model->weight[i] * h * fmax(fabs(run->now.v[i]), fabs(run->next.v[i])) > MIN_TURN_SHARE * run->allowed)
                return 1;
    return 0;
}

/* Returns the local error of positions, m. The embedded estimate E, (L/h - J)^-1 of the rate at the start minus that
 * by the stages for the real L, is of order 3: for a vibration with h omega = z it is z^-2 times the error of the
 * method. The part V that the same filter, applied to E, removes has the right order, and is 0.55 to 2.5 times the
 * error for every z. A part of E counts beside it, for effects that are not in the matrix: loads that change in
 * time, rotating bodies.
 *
 * Errors of steps add up, those of unresolved vibrations do not: the method damps them, so that they can be lost
 * only once. They may be a share of the total permitted error; errors that add up, which the filter leaves of E and
 * V, may be the step's share of it. Friction has kinks, which appear in the removed part: there all errors count as
 * adding up. So they do where bodies rotate: a vibration acts on a rotation with the square of its size, as a
 * torque, and a lost one makes an error that grows with the square of the time. */
double fu_radau_error(fu_run *run, double h)
{
    const fu_model *model = run->model;
    fu_radau_workspace *w = fu_radau_space(run);
    const int fed = model->n_motions || model->n_driven || model->n_needing_reactions;
    const double all = embedded(run, w, h), slow = take_filtered(run, w);
    const double vibration = fu_error_size(run, run->work, fu_allowed_elsewhere(run));
    if (run->fixed_step > 0.0) return fmax(REPORTED_FACTOR * vibration, FED_EMBEDDED_FACTOR * all);
    if (model->n_needing_reactions)
        return fmax(fmax(FED_VIBRATION_FACTOR * vibration, FED_EMBEDDED_FACTOR * all), friction_error(run, w, h));
    if ((fed && model->n_bodies) || turns(run, h))
        return fmax((fed ? FED_VIBRATION_FACTOR : TURNING_VIBRATION_FACTOR) * vibration, TURNING_EMBEDDED_FACTOR * all);
    for (int i = 0; i < model->n_dof; ++i) w->w[i] = run->work[i];
    const double adding_up = (fed ? FED_VIBRATION_FACTOR : VIBRATION_FACTOR) * filtered(run, w, w->w);
    const double by_embedded = fed ? FED_EMBEDDED_FACTOR : EMBEDDED_FACTOR;
    const double once = vibration * run->allowed / (VIBRATION_SHARE * fu_allowed_error(run));
    return fmax(fmax(adding_up, by_embedded * slow), once);
}
