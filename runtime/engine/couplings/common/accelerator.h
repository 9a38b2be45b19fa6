/* The system of eq 38, to which couplings add their rows: equations/acceleration.c solves it. */
#ifndef FUNICULAR_COUPLINGS_COMMON_ACCELERATOR_H
#define FUNICULAR_COUPLINGS_COMMON_ACCELERATOR_H

#include "couplings/common/constraints.h"
#include "linear/linear.h"

/* Eq 38 and what comes out of it */
struct fu_accelerator {
    fu_system mass;  /* [M H'; H 0], its band factored once */
    double *corner;  /* D of M, before constraints are added and it is factored */
    double *rhs;     /* unknowns, and FU_BAND_BEYOND */
    fu_rows *rows;   /* of the couplings that have constraints */
    double *scratch; /* of couplings, from `scratch` of each on: what its type keeps from rows to outputs */
    double *force, *work, *prescribed; /* n_dof */
    double *multipliers;               /* as eq 38 gives them */
    int self_locking;                  /* coupling whose reaction to the multipliers was not found, by its number; -1 */
    long evaluated;                    /* how often it was */
};

#endif
