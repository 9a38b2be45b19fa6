/* Failures of steps: equations/failure.c. */
#ifndef FUNICULAR_EQUATIONS_FAILURE_H
#define FUNICULAR_EQUATIONS_FAILURE_H

#include "base/common.h"

/* Cause of a failed step, and its place: a dof, and the number of a coupling or -1. */
enum {
    FU_NO_FAILURE = 0,
    FU_ITERATION,
    FU_MATRIX,
    FU_ERROR,
    FU_LOST_RIDER,
    FU_NOT_FINITE,
    FU_SELF_LOCKING,
    FU_NOT_KNOWN
};
typedef struct {
    int cause, dof, coupling;
} fu_failure;

int fu_fail(fu_run *run, int cause, const double *dofs, int coupling);
int fu_fail_at(fu_run *run, int cause, int unknown);
int fu_fail_eq38(fu_run *run);

#endif
