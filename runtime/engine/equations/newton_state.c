/* State of Newton's method of an implicit step: its unknowns beyond the dofs, and its continuation. */
#include "couplings/common/couplings.h"
#include "equations/equations.h"
#include "equations/run.h"

#include <math.h>

/* of the motion: error of a step beyond which its iteration is unreliable */
#define COARSE_ERROR 1e-4

double *fu_internal_unknowns(fu_run *run)
{
    return run->rhs + run->model->n_band + run->model->n_border_dof;
}

/* Adds the solution in run->rhs to the couplings' coordinates and forces. */
void fu_add_solution(fu_run *run, double inertia, double scale)
{
    fu_add_internal(run->model, &run->next, fu_internal_unknowns(run), inertia, scale);
}

/* Returns whether steps continue regularly: divided or too coarse steps of fixed size do not. */
int fu_goes_on(const fu_run *run)
{
    if (run->fixed_step <= 0.0) return 1;
    return run->net_rejections <= 0 && run->last_error <= COARSE_ERROR * fmax(run->motion, run->least_motion);
}

/* Returns whether later steps compensate the remaining residual of one. Fixed steps of scenes with couplings are solved
 * to rounding instead: a gap of 1e-14 m after a step of 1 ms causes a force of 1e-8 N per kg in the next one, whose
 * vibrations decay slowly. So are fixed steps that had to be divided, or are too coarse. */
int fu_compensates_residual(const fu_run *run)
{
    const fu_newton *method = run->integrator->newton;
    if (!method || !method->note_rest || !fu_goes_on(run)) return 0;
    return run->fixed_step <= 0.0 || !run->model->n_extra;
}
