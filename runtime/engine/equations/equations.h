/* Equations of motion at an instant: equations/equations.c. */
#ifndef FUNICULAR_EQUATIONS_EQUATIONS_H
#define FUNICULAR_EQUATIONS_EQUATIONS_H

#include "couplings/common/coupling.h"

/* The unknowns beyond the dofs in run->rhs. */
double *fu_internal_unknowns(fu_run *run);
void fu_scale_residual(fu_run *run, double scale);
void fu_residual(fu_run *run, const fu_equations *at);
void fu_matrix(fu_run *run, const fu_equations *at);
void fu_matrix_of_weights(fu_run *run, fu_weights weights);
void fu_matrix_of_cables(fu_run *run, fu_weights weights);
void fu_add_matrix_without_cables(fu_run *run, fu_weights weights);
void fu_static_move(fu_run *run, const double *change);
void fu_static_residual(fu_run *run);

#endif
