/* Attachments of couplings: couplings/common/attachments.c; wrenches, forces f with moments m, at attachments:
 * couplings/common/wrench.c. */
#ifndef FUNICULAR_COUPLINGS_COMMON_ATTACHMENTS_H
#define FUNICULAR_COUPLINGS_COMMON_ATTACHMENTS_H

#include "bodies/bodies.h"

/* An attachment: a point with axes of the ground (cable, body and node -1), of a cable's element, of a body; a node or
 * a material point of a rope, without axes; or axes alone, of the cable or the rope at a slide. */
enum { FU_UP = -1, FU_CARRIED = -2 };
typedef struct {
    int cable, body, element, slide; /* -1 if it is not on one */
    int node;                        /* first dof of a node of a rope, or of the nodes of a span; -1 if on none */
    /* of a material point, or of the slope at a slide, in a span of a rope, else null: derive/couplings/rope_point.py
     */
    const fu_rope_point_kernels *rope;
    int span_s[2], span_elements;  /* dofs of s1, s2 */
    const double *share;           /* of the nodes in the length of the span */
    double material;               /* m: the material coordinate of the point */
    double u[3];                   /* the point: of the ground; of the body in its axes */
    double N[FU_MAX_COORDINATES];  /* shape functions at the point of the element */
    const fu_frame_kernels *frame; /* of a cable; null without axes */
    int slopes[2];                 /* its vectors: 0 1 2 for r_x r_y r_z; FU_UP; FU_CARRIED for the slide's director */
    double S[2 * FU_MAX_COORDINATES]; /* derivatives of the shape functions for both, unless on a slide */
    double up[3];
    double axes[9];            /* along those of its carrier, by columns */
    fu_modal_attachment modal; /* the point of a modal body, instead of u */
} fu_attachment;

/* State of an attachment, and its motion with its n coordinates (numbers for fu_add in `at`): dp = P dq, and axes
 * rotate by T dq about global axes; velocities, and accelerations at zero accelerations of the coordinates. */
enum {
    FU_PLACE = 1,
    FU_AXES = 2,
    FU_RATES = 4,
    FU_POINT = FU_PLACE | FU_RATES
}; /* of a point p and P, and v and bias */
typedef struct {
    int n, at[FU_ATTACHMENT_COORDINATES];
    double p[3], v[3], bias[3], P[3 * FU_ATTACHMENT_COORDINATES];
    double A[9], omega[3], alpha[3], T[3 * FU_ATTACHMENT_COORDINATES];
} fu_attachment_state;

/* Converts a rotation to a vector in space; the plane has one component. */
static inline void fu_turn_in_space(int dim, const double *turn, double out[3])
{
    for (int d = 0; d < 3; ++d) out[d] = dim == 3 ? turn[d] : d == 2 ? turn[0] : 0.0;
}

/* Does what fu_interpolate does; the compiler unrolls the loops for constant dim. */
static inline void fu_sum_over_vectors(int dim, int vectors, const double *N, const double *x, double out[3])
{
    double sum[3] = {0.0};
    for (int k = 0; k < vectors; ++k)
        for (int d = 0; d < dim; ++d) sum[d] += N[k] * x[k * dim + d];
    for (int d = 0; d < dim; ++d) out[d] = sum[d];
}

/* Computes the sum of shape functions times the vectors of an element with n coordinates x. */
static inline void fu_interpolate(int dim, int n, const double *N, const double *x, double out[3])
{
    if (dim == 2) fu_sum_over_vectors(2, n / 2, N, x, out);
    else fu_sum_over_vectors(3, n / 3, N, x, out);
}

int fu_attachment_coordinates(const fu_model *model, const fu_attachment *on, const fu_state *state, int *at);
void fu_attachment_at(const fu_model *model, const fu_attachment *on, const fu_state *state, double s_rate, int what,
                      fu_attachment_state *out);
/* couplings/common/points.c */
/* Computes the place of an attachment's point and, unless null, its velocity v and, if that is not, its acceleration
 * a. */
void fu_point_at(const fu_model *model, const fu_attachment *on, const fu_state *state, double p[3], double *v,
                 double *a);
/* Adds `factor` times the generalised force of a force on the point to f. */
void fu_add_force_at(const fu_model *model, const fu_attachment *on, const fu_state *state, const double *force,
                     double factor, double *f);
/* Computes, of an attachment on a body, P over a step: P psi is the displacement of its point. Points of cables and
 * nodes keep P. */
void fu_discrete_point(const fu_model *model, const fu_attachment *on, const fu_state *now, const fu_state *next,
                       double *P);
/* Computes, of an attachment with axes, the Cayley vector theta of their turn over a step, and T half-way such that T
 * psi is theta; from, to: the attachment at both ends, middle: half-way. */
void fu_discrete_turn(const fu_model *model, const fu_attachment *on, const fu_state *now, const fu_state *next,
                      const double *psi, const fu_attachment_state *from, const fu_attachment_state *to,
                      fu_attachment_state *middle, double theta[3]);
/* Adds `factor` times a force on a point over a step to f: its work is that on the displacement of the point. */
void fu_add_point_over_step(const fu_model *model, const fu_attachment *on, const fu_state *now, const fu_state *next,
                            const double *force, double factor, double *f);
/* Computes K (n x n), the derivative by the attachment's coordinates of P' f + T' m at a fixed force f and moment m,
 * and those of velocity and angular velocity at fixed rates, where these are known: on a body, and of the velocity on a
 * rope. All but K may be null. */
void fu_wrench_derivatives(const fu_model *model, const fu_attachment *on, const fu_state *state, const double *f,
                           const double *m, int n, double *K, double *v_q, double *omega_q);
/* Converts derivatives by an attachment's coordinates, the first of them in column `first`, to those by psi of the
 * bodies; psi null: they are equal. */
void fu_turn_attachment(const fu_model *model, const fu_attachment *on, const double *psi, double *rows, int n_rows,
                        int n_columns, int first);

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
