/* Step sizes: equations/step_control.c. */
#ifndef FUNICULAR_EQUATIONS_STEP_CONTROL_H
#define FUNICULAR_EQUATIONS_STEP_CONTROL_H

#include "base/common.h"

double fu_fit_step(double remaining, double want);
double fu_allowed_error(const fu_run *run);
double fu_allow(fu_run *run, double h);
double fu_allowed_elsewhere(const fu_run *run);
double fu_error_size(const fu_run *run, const double *error, double unnamed);
void fu_adapt_step(fu_run *run, double h, double ratio);
double fu_shrink_step(fu_run *run, double h, double ratio);
double fu_retry_step(fu_run *run, double h);

#endif
