/* Remaining residuals of Newton's method, compensated by later steps: integrators/carried_residual.c. */
#ifndef FUNICULAR_INTEGRATORS_CARRIED_RESIDUAL_H
#define FUNICULAR_INTEGRATORS_CARRIED_RESIDUAL_H

#include "base/common.h"

/* Arrays over the unknowns, in the work space of an integrator. */
typedef struct {
    double *impulse;    /* of the residuals until `now`, N s */
    double *moment;     /* sum of steps times impulses, N s^2: displacement by the residuals times the mass */
    double *correction; /* force of the next step that compensates both, N */
    double *left;       /* residual of the last step, N */
    double *span;       /* s: time of the last compensation; 0 before any */
} fu_carried_residual;

void fu_carried_residual_take(fu_carried_residual *carried, const fu_model *model, double *scratch, long *taken);
void fu_carried_residual_start(const fu_carried_residual *carried, const fu_model *model);
void fu_carried_residual_correct(const fu_carried_residual *carried, const fu_model *model, double h);
void fu_carried_residual_note_none(const fu_carried_residual *carried, const fu_model *model);
void fu_carried_residual_add(const fu_carried_residual *carried, fu_run *run, double scale);
void fu_carried_residual_note(const fu_carried_residual *carried, const fu_run *run, double scale);
void fu_carried_residual_accept(const fu_carried_residual *carried, const fu_model *model, double h);

#endif
