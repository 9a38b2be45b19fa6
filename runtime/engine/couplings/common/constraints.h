/* Rows of constraints on accelerations. */
#ifndef FUNICULAR_COUPLINGS_COMMON_CONSTRAINTS_H
#define FUNICULAR_COUPLINGS_COMMON_CONSTRAINTS_H

#include "base/common.h"

/* Constraints H q'' = W over the dofs `at`, with their residuals C, and their rate at rest: `rows` of them now, from
 * the multiplier `first` on. There are at most max_multipliers; those of the bits redundant_rows are zero. */
typedef struct {
    int first, max_multipliers, rows, redundant_rows, n, at[FU_ROW_COORDINATES];
    int slide; /* of an end of a joint, -1; by_s: derivatives by its s */
    double by_s[6];
    double H[6 * FU_ROW_COORDINATES], W[6], C[6], rate[6], scale[6];
    int is_pushed; /* the first row's multiplier acts by `column` in place of its row of H, which includes friction */
    double column[FU_ROW_COORDINATES];
    /* 1/kg: compliance of rows, acceleration for a multiplier of 1 N, so that redundant rows share it */
    double soft[6];
    /* null, or over the dofs `at`: the generalised force of a force `push` beside the multipliers */
    const double *by_push;
    double push;
    double opposed; /* W: part of the constraints' driving power that a force on them takes */
} fu_rows;

#endif
