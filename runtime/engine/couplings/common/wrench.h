/* Wrenches, forces f with moments m, at attachments: couplings/common/wrench.c. */
#ifndef FUNICULAR_COUPLINGS_COMMON_WRENCH_H
#define FUNICULAR_COUPLINGS_COMMON_WRENCH_H

#include "couplings/common/attachments.h"

enum { FU_MOTION_ROWS = 15 }; /* four vectors, and one that a crossing adds */

/* The motion of an attachment by the n unknowns of its coordinates in a Newton system. `by` (rows x n): derivatives of
 * place, velocity and, where the attachment has axes, turn and angular velocity. K (n x n): derivative of P' f + T' m
 * at a fixed wrench; computed where is_stiff, else zero. */
typedef struct {
    fu_attachment_state at;
    int rows, is_stiff;
    double by[FU_MOTION_ROWS * FU_ATTACHMENT_COORDINATES], K[FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES];
} fu_point_motion;

/* Returns K, null where it is zero. */
static inline const double *fu_stiffness_of(const fu_point_motion *motion)
{
    return motion->is_stiff ? motion->K : 0;
}

/* Returns the number of rotations of a frame. */
static inline int fu_turns(int dim)
{
    return dim == 3 ? 3 : 1;
}

/* Computes the moment of a force on an arm; in the plane one component. */
static inline void fu_moment_of(int dim, const double *arm, const double *f, double *m)
{
    if (dim == 3) fu_cross(arm, f, m);
    else m[0] = arm[0] * f[1] - arm[1] * f[0];
}

/* Computes the change of a vector x by a turn; in the plane the turn has one component. */
static inline void fu_swing(int dim, const double *turn, const double *x, double *out)
{
    if (dim == 3) fu_cross(turn, x, out);
    else {
        out[0] = -turn[0] * x[1];
        out[1] = turn[0] * x[0];
    }
}

/* Computes `factor` times the generalised force P' f + T' m (n); f or m may be null. */
void fu_wrench_force(int dim, const fu_attachment_state *at, const double *f, const double *m, double factor,
                     double *out);
/* Adds the same to `sum`, over all dofs. */
void fu_add_wrench(int dim, const fu_attachment_state *at, const double *f, const double *m, double factor,
                   double *sum);
/* Computes the motion of an attachment, of its point alone or with its axes (`what`). psi as in fu_equations; rate:
 * that of velocities by places. f or m may be null. */
void fu_point_motion_at(const fu_model *model, const fu_attachment *on, const fu_state *state, int what,
                        const double *f, const double *m, const double *psi, double rate, fu_point_motion *out);
/* Computes the motion of a point with the shape functions N of an element whose first dof is `first`. */
void fu_element_motion(const fu_model *model, int first, int n, const double *N, double rate, fu_point_motion *out);
/* Computes changes (n_values x n) by the unknowns of values with these derivatives (n_values x motion->rows). */
void fu_changes(const fu_point_motion *motion, int n_values, const double *derivatives, double *changes);
/* Adds to a system `factor` times the derivative of P' f + T' m of one attachment by the unknowns of another, or of
 * itself: from the changes of f (dim x n) and of m (turns x n), and K at a fixed wrench. Each may be null. */
void fu_add_wrench_tangent(const fu_model *model, const fu_attachment_state *of, const fu_attachment_state *by,
                           const double *f, const double *m, const double *K, double factor, fu_system *system);

#endif
