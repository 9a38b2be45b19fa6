/* Accelerations by eq 38: equations/acceleration.c. */
#ifndef FUNICULAR_EQUATIONS_ACCELERATION_H
#define FUNICULAR_EQUATIONS_ACCELERATION_H

#include "couplings/common/accelerator.h"

int fu_accelerator_prepare(const fu_model *model, fu_accelerator *work);
int fu_accelerations(const fu_model *model, const fu_state *state, fu_accelerator *work, double *acceleration,
                     double *reaction);
int fu_compliance(const fu_model *model, const fu_state *state, fu_accelerator *work, const int *at, int n, double *S);
int fu_project_positions(const fu_model *model, const fu_state *state, fu_accelerator *work, double *change);
int fu_project_velocities(const fu_model *model, const fu_state *state, fu_accelerator *work, double *change);
int fu_prepare_response(const fu_model *model, const fu_state *state, fu_accelerator *work);
void fu_response(const fu_model *model, fu_accelerator *work, const double *force, double *change);
int fu_strike(const fu_model *model, const fu_state *state, fu_accelerator *work, int row, int constraint, double rate,
              double *change);

#endif
