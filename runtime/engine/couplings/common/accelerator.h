/* The system of eq 38, to which couplings add their rows: equations/acceleration.c solves it. */
#ifndef FUNICULAR_COUPLINGS_COMMON_ACCELERATOR_H
#define FUNICULAR_COUPLINGS_COMMON_ACCELERATOR_H

#include "couplings/common/constraints.h"
#include "linear/linear.h"

/* Eq 38 and its solution */
struct fu_accelerator {
    fu_system mass;  /* [M H'; H 0], its band factored once */
    double *corner;  /* D of M, before constraints are added and it is factored */
    double *rhs;     /* unknowns, and FU_BAND_BEYOND */
    fu_rows *rows;   /* of the couplings with constraints */
    double *scratch; /* of couplings, from `scratch` of each on: data of its type from rows to outputs */
    double *force, *work, *prescribed; /* n_dof */
    double *multipliers;               /* of the solution of eq 38 */
    int self_locking;                  /* number of the coupling whose reaction-dependent force did not converge; -1 */
    long evaluated;                    /* number of evaluations */
};

#endif
