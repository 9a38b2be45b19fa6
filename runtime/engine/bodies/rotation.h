/* Finite rotations of bodies: bodies/rotation.c. */
#ifndef FUNICULAR_BODIES_ROTATION_H
#define FUNICULAR_BODIES_ROTATION_H

#include "base/common.h"

void fu_move(const fu_model *model, double *q, const double *dofs);
void fu_cayley_move(const fu_model *model, double *q, const double *psi);
void fu_cayley_columns(const fu_body_kernels *kernel, double *rows, int n_rows, int n_columns, int first,
                       const double *psi);
void fu_between(const fu_model *model, const double *q, const double *q_next, double *between);
void fu_turn_columns(const fu_body_kernels *kernel, double *rows, int n_rows, int n_columns, int first,
                     const double *psi);

#endif
