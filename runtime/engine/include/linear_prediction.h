/* Linear prediction of a step from those before: integrators/linear_prediction.c. */
#ifndef FUNICULAR_LINEAR_PREDICTION_H
#define FUNICULAR_LINEAR_PREDICTION_H

#include "common.h"

enum { FU_BENDS = 8 }; /* second differences that one is predicted by */

/* What it knows of the last steps, all of size h; `steps` of them. `products` are those of the last second differences with each
 * other, newest first; `sums` the same over the steps, of which older ones count less. `missed` is the sum of squares by which
 * these factors were off. Whole numbers are real ones here, as work spaces have. */
typedef struct {
    double h, steps, newest, order, missed;
    double products[FU_BENDS + 1][FU_BENDS + 1], sums[FU_BENDS + 1][FU_BENDS + 1], factors[FU_BENDS];
} fu_known_steps;

/* Arrays in the work space of an integrator; each holds n values: accelerations, couplings' forces, and what the slopes of
 * couplings' own coordinates change by in a step. */
typedef struct {
    int n;
    double *last, *before;          /* of the last step and of the one before */
    double *bends[FU_BENDS + 1];    /* second differences of the last steps: a ring, from known->newest on backwards */
    double *weight;                 /* of accelerations in the sum of squares: 0 for dofs that are no unknowns */
    double *next;                   /* what is predicted */
    fu_known_steps *known;
} fu_linear_prediction;

void fu_linear_prediction_take(fu_linear_prediction *by, const fu_model *model, double *scratch, long *taken);
void fu_linear_prediction_start(const fu_linear_prediction *by, const fu_model *model);
int fu_linear_prediction_make(const fu_linear_prediction *by, double h);
void fu_linear_prediction_accept(const fu_linear_prediction *by, const fu_run *run, const double *slope_before, double h);

#endif
