/* What Newton's method leaves of the equations of motion, carried into the next steps.
 *
 * The residual r that an iteration leaves has one sign step after step, and acts like a force: after n steps it has
 * moved positions by n^2/2 times the increment that was left out. Here its impulse P and the moment X of that are
 * summed,
 *
 *   P_n+1 = P_n + h r_n+1,   X_n+1 = X_n + h P_n+1
 *
 * and the next step is solved with the force c = -(X/T + P)/T on its right side, r = c + what Newton leaves there. With
 * T = h that brings both sums back in one step: r_n+1 = e_n+1 - 2 e_n + e_n-1 of what is left in each step, e, so that
 * the motion is off by e alone, however many steps are made. (The same is done to the noise of quantisation: Schreier &
 * Temes 2005.) Equations of motion are those of the dofs and of couplings' own coordinates: of a slide, the balance
 * along the cable. What is left of a constraint is a gap of `next` alone. After a step of T, T does not end sooner than
 * that step would have been made up for: each step takes no more than its own h from T. Otherwise one short step to an
 * event would make up for a long one with a large force, and many, each shorter than the last, with forces that grow
 * without bounds. For T > h the sums go to zero in some steps, for any T. Steps that are solved to rounding make up for
 * those before as well: without the force c, the impulse would go on moving positions.
 */
#include "base/workspace.h"
#include "equations/run.h"
#include "integrators/carried_residual.h"

#include <math.h>
#include <string.h>

/* Returns how many equations there are: those of constraints have their places too, but nothing to carry. */
static int size(const fu_model *model)
{
    return model->n_band + model->n_border_dof + model->n_extra;
}

/* Places the arrays in a work space; only counts them where it is null. */
void fu_carried_residual_take(fu_carried_residual *carried, const fu_model *model, double *scratch, long *taken)
{
    double **arrays[] = {&carried->impulse, &carried->moment, &carried->correction, &carried->left};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; ++k) *arrays[k] = fu_take(scratch, taken, size(model));
    carried->span = fu_take(scratch, taken, 1);
}

/* Begins with nothing to make up for. */
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

/* Computes the force by which a step of size h makes up for the steps before: its residual, unless Newton leaves
 * something. */
void fu_carried_residual_correct(const fu_carried_residual *carried, const fu_model *model, double h)
{
    const double per = 1.0 / span(carried, h);
    for (int i = 0; i < size(model); ++i)
        carried->left[i] = carried->correction[i] = -(per * carried->moment[i] + carried->impulse[i]) * per;
}

/* Notes that the step just made satisfies the equations of motion, without that force. */
void fu_carried_residual_note_none(const fu_carried_residual *carried, const fu_model *model)
{
    memset(carried->left, 0, sizeof(double) * (size_t)size(model));
}

/* Adds it to minus the residual in run->rhs, whose equations of motion are multiplied by `scale`. */
void fu_carried_residual_add(const fu_carried_residual *carried, fu_run *run, double scale)
{
    for (int i = 0; i < size(run->model); ++i) run->rhs[i] += scale * carried->correction[i];
}

/* Notes the residual of the step just made, of which run->rhs has what Newton left. */
void fu_carried_residual_note(const fu_carried_residual *carried, const fu_run *run, double scale)
{
    const fu_model *model = run->model;
    double *own = carried->left + model->n_band + model->n_border_dof;
    for (int i = 0; i < size(model); ++i) carried->left[i] = carried->correction[i] - run->rhs[i] / scale;
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active)
        for (int i = 0; i < c->n_forces; ++i) own[c->unknown + c->n_coordinates + i] = 0.0;
}

/* Takes the step just made: what it left is to be made up for. */
void fu_carried_residual_accept(const fu_carried_residual *carried, const fu_model *model, double h)
{
    *carried->span = span(carried, h);
    for (int i = 0; i < size(model); ++i) {
        carried->impulse[i] += h * carried->left[i];
        carried->moment[i] += h * carried->impulse[i];
    }
}
