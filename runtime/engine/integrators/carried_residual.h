/* What Newton's method leaves of the equations of motion, carried into the next steps: integrators/carried_residual.c.
 */
#ifndef FUNICULAR_INTEGRATORS_CARRIED_RESIDUAL_H
#define FUNICULAR_INTEGRATORS_CARRIED_RESIDUAL_H

#include "base/common.h"

/* Arrays over the unknowns, in the work space of an integrator. */
typedef struct {
    double *impulse; /* of what has been left until `now`, N s */
    double *moment;  /* sum of steps times impulses, N s^2: what has been left moves positions by this over the mass */
    double *correction; /* force of the step to come that makes up for both, N */
    double *left;       /* residual of the step just made, N */
    double *span;       /* s: over which they were made up for last; 0 where they never were */
} fu_carried_residual;

void fu_carried_residual_take(fu_carried_residual *carried, const fu_model *model, double *scratch, long *taken);
void fu_carried_residual_start(const fu_carried_residual *carried, const fu_model *model);
void fu_carried_residual_correct(const fu_carried_residual *carried, const fu_model *model, double h);
void fu_carried_residual_note_none(const fu_carried_residual *carried, const fu_model *model);
void fu_carried_residual_add(const fu_carried_residual *carried, fu_run *run, double scale);
void fu_carried_residual_note(const fu_carried_residual *carried, const fu_run *run, double scale);
void fu_carried_residual_accept(const fu_carried_residual *carried, const fu_model *model, double h);

#endif
