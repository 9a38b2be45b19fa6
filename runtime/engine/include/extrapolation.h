/* Prediction of a step from the steps before: integrators/extrapolation.c. */
#ifndef FUNICULAR_EXTRAPOLATION_H
#define FUNICULAR_EXTRAPOLATION_H

#include "common.h"

enum {
    FU_PAST = 4,        /* steps before `now` of which accelerations and forces are known */
    FU_LONGER_PAST = 6, /* and own coordinates, which take two more */
    FU_WAYS = 7         /* to predict */
};

/* Of the last steps: their sizes, s, the last one first; how many there were; how many of them, up to the last, were of one
 * size; by which way the next one is predicted; and mean squares of what each way would have missed, 0 where that is not
 * known. Whole numbers are real ones here, as work spaces have. */
typedef struct {
    double h[FU_LONGER_PAST], steps, equal, way, missed[FU_WAYS];
} fu_last_steps;

/* What an integrator keeps of the last steps, in its work space. The step before `now` comes first in each list. */
typedef struct {
    double *accelerations[FU_PAST];       /* n_dof: its own */
    double *forces[FU_PAST];              /* of the couplings */
    double *coordinates[FU_LONGER_PAST];  /* of the couplings */
    double *weight;                       /* n_dof: model->weight of the dofs that are unknowns, 0 of the others */
    fu_last_steps *last;
} fu_extrapolation;

/* What an integrator does without the past: vibrations far beyond its step alternate, each acceleration -alternating times
 * the one before; with `rest` times the last acceleration it goes on with its velocities. */
typedef struct {
    double rest, alternating;
} fu_own_motion;

void fu_extrapolation_take(fu_extrapolation *past, const fu_model *model, double *scratch, long *taken);
void fu_extrapolation_start(const fu_extrapolation *past, const fu_model *model);
void fu_extrapolate(const fu_extrapolation *past, fu_run *run, fu_own_motion own, double h);
void fu_extrapolation_accept(const fu_extrapolation *past, const fu_run *run, fu_own_motion own, double h);

#endif
