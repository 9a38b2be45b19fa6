/* A state of a run by the linear model: its coordinates, the motion of dofs and joints, exact forces, multipliers and
 * forces of supports: integrators/linear_state.c. */
#ifndef FUNICULAR_INTEGRATORS_LINEAR_STATE_H
#define FUNICULAR_INTEGRATORS_LINEAR_STATE_H

#include "integrators/linear_model.h"

/* Coordinates of the linear model, their rates, their second derivatives, and the a of the scheme. */
typedef struct {
    double *y, *rate, *second, *a;
} fu_linear_coordinates;

/* Constraints that move along cables: the multipliers in a step and at its start, zero for others; entries of
 * H, and X = psi A^-1 H', with S = H X factored; gaps, then changes of multipliers. */
typedef struct {
    double *lambda, *lambda_now, *H, *X, *S, *values;
} fu_linear_constraints;

/* Work space: coordinates at both ends of a step; over the coordinates the linear part of the residual, the residual
 * and then the change, and what the last step has left of it, of the size h_left; over the dofs the motion, and exact
 * forces; changes of determined unknowns, and values of constraints. */
typedef struct {
    fu_linear_coordinates now, next;
    double *linear, *change, *left, *left_now;
    fu_small_motion motion;
    double *force, *values, *gaps, *h_left, *h_now, *error;
    fu_linear_constraints moving;
} fu_linear_space;

/* Places the arrays in the scratch of a run, unless it is null; returns their number of doubles. */
long fu_linear_lay_out(const fu_run *run, double *scratch, fu_linear_space *w);
fu_linear_space fu_linear_space_of(const fu_run *run);
/* What a constraint says of positions, of velocities, and of accelerations. */
typedef enum { FU_OF_POSITIONS, FU_OF_VELOCITIES, FU_OF_ACCELERATIONS } fu_level;
/* Computes the values of the constraints at a level, of those that move or of the others, by the evaluated rows, for
 * these velocities or accelerations, in w->gaps. */
void fu_linear_gaps(const fu_run *run, const fu_linear_space *w, fu_level of, int moves, const double *dofs);
/* Computes `next` from its coordinates, on its joints; returns nonzero where something has left its cable. */
int fu_linear_kinematics(fu_run *run, const fu_linear_space *w);
/* Computes the forces of all but the cables and the joints at `next`, in w->force. */
void fu_linear_exact_forces(const fu_run *run, const fu_linear_space *w);
/* Computes the multipliers of the constraints at `next` from the forces on the determined unknowns, those of w->force
 * and of cables. */
void fu_linear_multipliers(fu_run *run, const fu_linear_space *w);
/* Computes the forces of supports at `next`, by the exact forces in w->force, which it overwrites: M q'' - Q + H'
 * lambda; totals: as of fu_linear_model_cable_forces. */
void fu_linear_reactions(fu_run *run, const fu_linear_space *w, double *reaction, fu_cable_totals *totals);

#endif
