/* Constraints of the linear model that move along cables, condensed onto their multipliers: H dy = -gaps with the
 * forces H' lambda, by H over the coordinates and X = psi A^-1 H' of the matrix A: integrators/linear_constraints.c. */
#ifndef FUNICULAR_INTEGRATORS_LINEAR_CONSTRAINTS_H
#define FUNICULAR_INTEGRATORS_LINEAR_CONSTRAINTS_H

#include "integrators/linear_state.h"

/* Places their arrays in the scratch after `taken` doubles, unless it is null; returns the number with theirs. */
long fu_linear_take_constraints(const fu_run *run, double *scratch, long taken, fu_linear_constraints *c);
/* Computes them at the evaluated rows, by a factored matrix; overwrites w->force. Returns nonzero where constraints
 * depend on each other. */
int fu_linear_condense(const fu_run *run, const fu_linear_space *w, double psi, const double *L);
/* Returns the largest gap of the constraints at the evaluated rows, m. */
double fu_linear_gap(const fu_run *run);
/* Changes the multipliers for the residual in w->left so that the next solution closes the gaps, in w->gaps, and adds
 * their forces to w->left. */
void fu_linear_change_multipliers(const fu_run *run, const fu_linear_space *w);
/* Removes from the coordinates in w->change the part that violates the constraints. */
void fu_linear_keep_constraints(const fu_run *run, const fu_linear_space *w);
/* Adds the forces of the multipliers at the evaluated rows to w->force, over the dofs. */
void fu_linear_add_constraint_forces(const fu_run *run, const fu_linear_space *w);

#endif
