/* Prediction of a step from earlier ones: integrators/extrapolation.c. */
#ifndef FUNICULAR_INTEGRATORS_EXTRAPOLATION_H
#define FUNICULAR_INTEGRATORS_EXTRAPOLATION_H

#include "base/common.h"

/* Of the last steps: sizes of the last one and of the one before, s; their number; the degree of the polynomial that
 * would have predicted the last one best, -1: none. Integers are stored as real numbers, as in work spaces. */
typedef struct {
    double h, h_before, steps, degree;
} fu_last_steps;

/* The history of an integrator in its work space. */
typedef struct {
    double *before, *earlier;             /* n_dof: its accelerations one and two steps before `now` */
    double *slope, *slope_before;         /* of the couplings' coordinates in the last step, and in the one before */
    double *force_before, *force_earlier; /* of the couplings, one and two steps before `now` */
    fu_last_steps *last;
} fu_extrapolation;

void fu_extrapolation_take(fu_extrapolation *past, const fu_model *model, double *scratch, long *taken);
void fu_extrapolation_start(const fu_extrapolation *past);
void fu_extrapolate(const fu_extrapolation *past, fu_run *run, double rest, double h);
void fu_extrapolation_accept(const fu_extrapolation *past, const fu_run *run, double rest, double h);

#endif
