/* Rows of constraints on the level of accelerations. */
#ifndef FUNICULAR_COUPLINGS_COMMON_CONSTRAINTS_H
#define FUNICULAR_COUPLINGS_COMMON_CONSTRAINTS_H

#include "base/common.h"

/* Constraints H q'' = W over the dofs `at`, with what is left of them C, and their rate at rest: `rows` of them now,
 * from the multiplier `first` on. They have max_multipliers at most; those of the bits redundant_rows are nil. */
typedef struct {
    int first, max_multipliers, rows, redundant_rows, n, at[FU_ROW_COORDINATES];
    int slide; /* that an end of a joint is on, -1; by_s: derivatives by its s */
    double by_s[6];
    double H[6 * FU_ROW_COORDINATES], W[6], C[6], rate[6], scale[6];
    int is_pushed; /* the first row's multiplier acts by `column` in place of its row of H: with it goes friction */
    double column[FU_ROW_COORDINATES];
    double soft[6]; /* 1/kg: accelerations that rows give way by for a multiplier of 1 N, so that rows that hold the
                       same share it */
    const double *by_push; /* null, or over the dofs `at`: what a force `push` beside the multipliers puts on them */
    double push;
    double opposed; /* W: of the constraints' driving power, what a force on them takes */
} fu_rows;

#endif
