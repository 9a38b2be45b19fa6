/* The system of eq 38, and the rows of constraints that couplings add to it: equations/acceleration.c solves it. */
#ifndef FUNICULAR_COUPLINGS_COMMON_ACCELERATOR_H
#define FUNICULAR_COUPLINGS_COMMON_ACCELERATOR_H

#include "base/common.h"
#include "couplings/common/coupling.h"
#include "linear/linear.h"

#define FU_ROW_ENTRIES (14 * FU_ROW_COORDINATES) /* of the constraints of one coupling, at most */
#define FU_ROW_ENTRIES_OF(multipliers)                                                                                 \
    ((multipliers) * FU_ROW_COORDINATES < FU_ROW_ENTRIES ? (multipliers) * FU_ROW_COORDINATES : FU_ROW_ENTRIES)

/* Constraints H q'' = W over the dofs `at`, with their residuals C, and their rate at rest: `rows` of them now, from
 * the multiplier `first` on. There are at most max_multipliers; those of the bits redundant_rows are zero. */
typedef struct {
    int first, max_multipliers, rows, redundant_rows, n, at[FU_ROW_COORDINATES];
    int slide; /* of an end of a joint, -1; by_s: derivatives by its s */
    double by_s[6];
    double *H; /* FU_ROW_ENTRIES_OF max_multipliers */
    double W[FU_MAX_FORCES], C[FU_MAX_FORCES], rate[FU_MAX_FORCES], scale[FU_MAX_FORCES];
    int is_pushed; /* the first row's multiplier acts by `column` in place of its row of H, which includes friction */
    double column[FU_ROW_COORDINATES];
    /* 1/kg: compliance of rows, acceleration for a multiplier of 1 N, so that redundant rows share it */
    double soft[FU_MAX_FORCES];
    /* null, or over the dofs `at`: the generalised force of a force `push` beside the multipliers */
    const double *by_push;
    double push;
    double opposed; /* W: part of the constraints' driving power that a force on them takes */
} fu_rows;

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
