/* Remaining residuals of Newton's method in the equations of motion, compensated by later steps.
 *
 * The residual r of an iteration has one sign step after step, and acts like a force: after n steps it has moved
 * positions by n^2/2 times the omitted increment. Its impulse P and the moment X of that are summed, P_n+1 = P_n + h
 * r_n+1,   X_n+1 = X_n + h P_n+1, and the next step is solved with the force c = -(X/T + P)/T on its right side, r = c
 * + the remaining residual there. T = h returns both sums in one step: r_n+1 = e_n+1 - 2 e_n + e_n-1 of the remaining
 * residuals e, so that the error of the motion is e alone, for any number of steps. (The noise of quantisation is
 * treated likewise: Schreier & Temes 2005.)
 *
 * The equations are those of the dofs and of couplings' coordinates: of a slide, the balance along the cable. The
 * residual of a constraint is a gap of `next` alone.
 *
 * After a step of T, T must not end sooner than that step would have been compensated: each step reduces T by no more
 * than its h. Otherwise one short step to an event would compensate a long one with a large force, and many, each
 * shorter than the last, with unbounded forces. For T > h the sums go to zero in some steps, for any T. Steps that are
 * solved to rounding compensate earlier ones as well: without the force c, the impulse would continue to move
 * positions.
 */
#include "base/workspace.h"
#include "equations/run.h"
#include "integrators/carried_residual.h"

#include <math.h>
#include <string.h>

/* Returns the number of equations: those of constraints have places, but no carried residual. */
static int size(const fu_model *model)
{
    return model->n_band + model->n_border_dof + model->n_extra;
}

/* Places the arrays in a work space; only counts them if it is null. */
void fu_carried_residual_take(fu_carried_residual *carried, const fu_model *model, double *scratch, long *taken)
{
    double **arrays[] = {&carried->impulse, &carried->moment, &carried->correction, &carried->left};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; ++k) *arrays[k] = fu_take(scratch, taken, size(model));
    carried->span = fu_take(scratch, taken, 1);
}

/* Starts without residuals. */
void fu_carried_residual_start(const fu_carried_residual *carried, const fu_model *model)
{
    double *arrays[] = {carried->impulse, carried->moment, carried->correction, carried->left};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; ++k)
        memset(arrays[k], 0, sizeof(double) * (size_t)size(model));
    *carried->span = 0.0;
}

static double span(const fu_carried_residual *carried, double h)
{
    return fmax(h, *carried->span - h);
}

/* Computes the force by which a step of size h compensates earlier steps: its residual without that of Newton's method.
 */
void fu_carried_residual_correct(const fu_carried_residual *carried, const fu_model *model, double h)
{
    const double per = 1.0 / span(carried, h);
    for (int i = 0; i < size(model); ++i)
        carried->left[i] = carried->correction[i] = -(per * carried->moment[i] + carried->impulse[i]) * per;
}

/* Records that the last step satisfies the equations of motion, without that force. */
void fu_carried_residual_note_none(const fu_carried_residual *carried, const fu_model *model)
{
    memset(carried->left, 0, sizeof(double) * (size_t)size(model));
}

/* Adds it to minus the residual in run->rhs, whose equations of motion are multiplied by `scale`. */
void fu_carried_residual_add(const fu_carried_residual *carried, fu_run *run, double scale)
{
    for (int i = 0; i < size(run->model); ++i) run->rhs[i] += scale * carried->correction[i];
}

/* Records the residual of the last step, with Newton's in run->rhs. */
void fu_carried_residual_note(const fu_carried_residual *carried, const fu_run *run, double scale)
{
    const fu_model *model = run->model;
    double *internal = carried->left + model->n_band + model->n_border_dof;
    for (int i = 0; i < size(model); ++i) carried->left[i] = carried->correction[i] - run->rhs[i] / scale;
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active)
        for (int i = 0; i < c->n_forces; ++i) internal[c->unknown + c->n_coordinates + i] = 0.0;
}

/* Accepts the last step, whose residual is to be compensated. */
void fu_carried_residual_accept(const fu_carried_residual *carried, const fu_model *model, double h)
{
    *carried->span = span(carried, h);
    for (int i = 0; i < size(model); ++i) {
        carried->impulse[i] += h * carried->left[i];
        carried->moment[i] += h * carried->impulse[i];
    }
}
