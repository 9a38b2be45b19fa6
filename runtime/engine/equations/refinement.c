/* Eq 38 by refinement: accelerations that nearly satisfy it, as those of a Newton method do, from its residual and the
 * mass matrix that was factored last, of another state. Each correction reduces the error by the ratio of the change of
 * M since then, and costs a substitution and a product with M in place of all forces and a factorisation. */
#include "bodies/unknowns.h"
#include "equations/equations.h"

#include <math.h>

#define MAX_CORRECTIONS 2
#define RESIDUAL_TOLERANCE 1e-9 /* of the largest force of inertia, loads and supports: that of the equations */

static double largest(int n, const double *x)
{
    double most = 0.0;
    for (int i = 0; i < n; ++i) most = fmax(most, fabs(x[i]));
    return most;
}

int fu_refine_accelerations(const fu_model *model, double t, const double *q, fu_accelerator *work,
                            double *acceleration, double *reaction)
{
    const int n = model->n_band + model->n_border_dof;
    if (model->n_rows || model->n_extra) return 1;
    const double enough = RESIDUAL_TOLERANCE * largest(model->n_dof, reaction);
    for (int corrections = 0;; ++corrections) {
        fu_gather(model, reaction, work->rhs);
        if (largest(n, work->rhs) <= enough) break;
        if (corrections == MAX_CORRECTIONS) return 1;
        for (int i = 0; i < n; ++i) work->rhs[i] = -work->rhs[i];
        fu_system_solve(&work->mass, model->lapack, work->rhs);
        fu_spread(model, work->rhs, work->work);
        fu_mass_times(model, t, q, work->work, work->force);
        for (int i = 0; i < model->n_dof; ++i) {
            acceleration[i] += work->work[i];
            reaction[i] += work->force[i];
        }
    }
    for (int i = 0; i < model->n_dof; ++i) { /* no support holds a dof whose force alone is that on its unknown */
        const int unknown = model->unknown_of_dof[i];
        if (unknown >= 0 && reaction[i] == work->rhs[unknown]) reaction[i] = 0.0;
    }
    return 0;
}
