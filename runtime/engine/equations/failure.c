/* Cause and place of a failed step, for messages. */
#include "couplings/common/couplings.h"
#include "equations/run.h"

#include <math.h>

/* Records the failure of a step: the cause, the dof that moves farthest (or is not finite), and the number of the
 * coupling or -1. Returns 1. */
int fu_fail(fu_run *run, int cause, const double *dofs, int coupling)
{
    const fu_model *model = run->model;
    double largest = -1.0;
    run->failure = (fu_failure){cause, 0, coupling};
    for (int i = 0; i < model->n_dof; ++i) {
        const double size = fabs(dofs[i]) * model->weight[i];
        if (size <= largest) continue;
        run->failure.dof = i;
        if (isnan(size)) break;
        largest = size;
    }
    return 1;
}

/* The same by the unknown at which a matrix is singular. */
int fu_fail_at(fu_run *run, int cause, int unknown)
{
    const fu_model *model = run->model;
    const int extra = unknown - model->n_band - model->n_border_dof;
    run->failure = (fu_failure){cause, 0, -1};
    for (int i = 0; i < model->n_dof; ++i)
        if (model->unknown_of_dof[i] == unknown) run->failure.dof = i;
    const fu_coupling *owner = extra >= 0 ? fu_owner(model, extra) : 0;
    if (owner && owner->n_coordinates) run->failure.coupling = owner->number;
    return 1;
}

/* The same if eq 38 has no solution: by self-locking friction, or by its matrix. */
int fu_fail_eq38(fu_run *run)
{
    const int self_locking = run->accelerator.self_locking;
    return fu_fail(run, self_locking >= 0 ? FU_SELF_LOCKING : FU_MATRIX, run->next.v, self_locking);
}
