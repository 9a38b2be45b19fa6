/* Attachments of couplings: couplings/common/attachments.c. */
#ifndef FUNICULAR_COUPLINGS_COMMON_ATTACHMENTS_H
#define FUNICULAR_COUPLINGS_COMMON_ATTACHMENTS_H

#include "bodies/bodies.h"

/* An attachment: a point with axes of the ground (cable and body -1), of a cable's element, of a body; or axes alone,
 * of the cable at a slide. */
enum { FU_UP = -1, FU_CARRIED = -2 };
typedef struct {
    int cable, body, element, slide; /* -1 if it is not on one */
    double u[3];                     /* the point: of the ground; of the body in its axes */
    double N[FU_MAX_COORDINATES];    /* shape functions at the point of the element */
    const fu_frame_kernels *frame;   /* of a cable; null without axes */
    int slopes[2]; /* its vectors: 0 1 2 for r_x r_y r_z; FU_UP; FU_CARRIED for the slide's director */
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

int fu_attachment_coordinates(const fu_model *model, const fu_attachment *on, const fu_state *state, int *at);
void fu_attachment_at(const fu_model *model, const fu_attachment *on, const fu_state *state, double s_rate, int what,
                      fu_attachment_state *out);
/* Computes, of an attachment on a body, P over a step: P psi is the displacement of its point. Other points keep P. */
void fu_discrete_point(const fu_model *model, const fu_attachment *on, const fu_state *now, const fu_state *next,
                       double *P);
/* Computes K (n x n), the derivative by the attachment's coordinates of P' f + T' m at a fixed force f and moment m,
 * and those of velocity and angular velocity at fixed rates, where these are known: on a body. All but K may be null.
 */
void fu_wrench_derivatives(const fu_model *model, const fu_attachment *on, const fu_state *state, const double *f,
                           const double *m, int n, double *K, double *v_q, double *omega_q);
/* Converts derivatives by an attachment's coordinates, the first of them in column `first`, to those by psi of the
 * bodies; psi null: they are equal. */
void fu_turn_attachment(const fu_model *model, const fu_attachment *on, const double *psi, double *rows, int n_rows,
                        int n_columns, int first);

#endif
