/* The linear model of motion about the configuration at the start: integrators/linear_model.c.
 *
 * Constraints of joints, linear there, determine some unknowns by the others, the coordinates y: dofs = S y + what
 * closes the constraints at each instant (solve/motion/linear_model.py). Cables have constant matrices over the dofs,
 * joints the stiffness of their forces at the start. Everything else is exact: bodies, springs, contacts, loads, and
 * constraints that move along cables, whose forces are unknowns of each step (integrators/linear_constraints.h). */
#ifndef FUNICULAR_INTEGRATORS_LINEAR_MODEL_H
#define FUNICULAR_INTEGRATORS_LINEAR_MODEL_H

#include "base/common.h"
#include "equations/run.h"

/* Rows of a sparse matrix, those without entries left out where they are many: row row[i] has the entries start[i] ...
 * start[i + 1] - 1. */
typedef struct {
    int rows;
    const int *row, *start, *column;
    const double *value;
} fu_sparse;

/* Matrices of mass, of damping and of stiffness. */
enum { FU_MASS, FU_DAMPING, FU_STIFFNESS, FU_MATRICES };

/* A factored matrix over the coordinates, of a step of h; used: when it was used last, in factorisations asked for. */
typedef struct {
    double h, *L;
    long used;
} fu_step_factor;
enum { FU_STEP_FACTORS = 4 }; /* kept: steps of a few sizes alternate between output times */

struct fu_linear_model {
    int n, width, stride; /* coordinates; half bandwidth of their matrices; fu_add_half_bands_times of cables */
    int n_moving;         /* multipliers of constraints that move along cables, at most */
    const int *moves;     /* n_rows: whether constraints do; they have no part in `closing` */
    int *moving_start, *moving_column; /* n_moving + 1, n_moving x n: entries of their rows over the coordinates */
    const int *dof;                    /* n: the dof that equals each coordinate; -1 for none */
    const int *mixed;                  /* the dofs that are combinations of coordinates, row by row */
    fu_sparse combinations;
    fu_sparse closing;                   /* what the constraints determine, by their rows, numbered as multipliers */
    fu_sparse held;                      /* that by the dofs, which it moves */
    fu_sparse read;                      /* coordinates by the dofs */
    fu_sparse joints;                    /* stiffness by the forces of joints, over the coordinates */
    fu_sparse exact[FU_MATRICES];        /* over the coordinates: of all that has forces of its own beside the cables */
    const double *matrices[FU_MATRICES]; /* over the coordinates: lower triangles by columns, width + 1 each */
    double *cables[FU_MATRICES];         /* over the dofs: upper halves */
    const double *weight;                /* n: displacement of a point by a unit of each coordinate, m */
    double *force;                       /* n_dof: of the cables at the start */
    double elastic;                      /* J: of cables and bodies there */
    fu_step_factor factors[FU_STEP_FACTORS], at_rest, of_mass; /* at_rest: of the stiffness */
    long asked;
    double *error; /* largest error of the linear model in a row so far, m, and its time, s; in the run's scratch */
};

/* Prepares the model at run->first, of a run over a duration; returns nonzero where a matrix is not positive
 * definite. */
int fu_linear_model_start(fu_run *run);
/* Factors a sum of the matrices; returns nonzero unless it is positive definite. */
int fu_linear_model_factor(const fu_linear_model *linear, const double weights[FU_MATRICES], double *L);
/* Returns the factor of a step, *is_known: made already. */
fu_step_factor *fu_step_factor_of(fu_linear_model *linear, double h, int *is_known);
/* Solves with a factor; x is zero before `first`. */
void fu_linear_model_solve(const fu_linear_model *linear, const double *L, int first, double *x);
/* y += factor A x */
void fu_sparse_add_times(const fu_sparse *A, double factor, const double *x, double *y);
/* Computes y = S' f of forces on the dofs. */
void fu_linear_model_project(const fu_linear_model *linear, const double *force, double *y);
/* Computes dofs = S y, of n_dof. */
void fu_linear_model_expand(const fu_linear_model *linear, int n_dof, const double *y, double *dofs);
/* The same for positions, rates and second derivatives together. */
void fu_linear_model_expand_motion(const fu_linear_model *linear, int n_dof, const double *const y[FU_MATRICES],
                                   double *const dofs[FU_MATRICES]);

/* A small motion over the dofs, with `stride` numbers more, which are finite. */
typedef struct {
    double *displacement, *velocity, *acceleration;
} fu_small_motion;
/* Of cables and bodies: their elastic energy, J, and over the dofs their forces without those of inertia. */
typedef struct {
    double elastic, *without_inertia;
} fu_cable_totals;
/* Computes the forces of cables over the dofs; totals: null, or with room for the forces. */
void fu_linear_model_cable_forces(const fu_run *run, const fu_small_motion *motion, double *force,
                                  fu_cable_totals *totals);
/* Returns the force of one dof. */
double fu_linear_model_cable_force(const fu_run *run, const fu_small_motion *motion, int dof);
/* Returns the power of the damping of cables, W. */
double fu_linear_model_dissipation(const fu_run *run, const double *velocity);

#endif
