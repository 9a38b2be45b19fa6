/* Newton's method of implicit steps: equations/newton.c. */
#ifndef FUNICULAR_EQUATIONS_NEWTON_H
#define FUNICULAR_EQUATIONS_NEWTON_H

#include "base/common.h"

#define FU_RUNS_AWAY 1e30 /* m, or m/s: an increment or a velocity of a diverged solution */
#define FU_SAME_STEP 1e-6 /* of a step: one that differs by less has the same matrix */

/* Functions of an implicit integrator. `predict` makes a first `next`; `kinematics` completes it from the unknowns;
 * `residual` computes minus the scaled residual in run->rhs, `matrix` its derivative in run->newton; `apply` adds the
 * solution in run->rhs and returns its size as a length. */

typedef struct {
    void (*predict)(fu_run *run, double h);
    void (*kinematics)(fu_run *run, double h);
    void (*residual)(fu_run *run, double h);
    void (*matrix)(fu_run *run, double h);
    double (*apply)(fu_run *run, double h);
    int most_iterations,
        to_rounding; /* the latter: continue below the rounding of positions, until increments shrink no more */
    /* Records the remaining residual in run->rhs, which later steps compensate; null: they do not, and it acts on the
     * motion like a force. */
    void (*note_rest)(fu_run *run, double h);
    /* Computes minus the scaled residual of the couplings' internal equations in run->rhs, and zero for the dofs. */
    void (*internal_residual)(fu_run *run, double h);
} fu_newton;

void fu_linearise(fu_run *run, double h, const double *change);

int fu_goes_on(const fu_run *run);
int fu_compensates_residual(const fu_run *run);
int fu_newton_step(fu_run *run, const fu_newton *method, double h);
void fu_predict_internal(fu_run *run, double h);
void fu_add_solution(fu_run *run, double inertia, double scale);
double fu_spread_size(fu_run *run);
double fu_filtered_size(fu_run *run);

#endif
