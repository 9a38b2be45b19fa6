/* Rigid and modal bodies: bodies/bodies.c, bodies/modal.c. */
#ifndef FUNICULAR_BODIES_BODIES_H
#define FUNICULAR_BODIES_BODIES_H

#include "linear/linear.h"

/* State of a body at an instant: its part of q, of v, of the accelerations. */
typedef struct {
    const double *b, *w, *a;
} fu_instant;

/* Functions of a kind of body: bodies.c, modal.c. b, w, a and f begin with the body's entries. */
typedef struct fu_body fu_body;
typedef struct {
    int constant; /* its M is constant in body axes, and it has no K */
    void (*mass_times)(const fu_body *body, const double *b, const double *a, double *f); /* f = M a */
    /* f += force at zero accelerations */
    void (*forces)(const fu_body *body, const double *b, const double *w, double *f);
    void (*mass)(const fu_body *body, const double *b, double *M);
    void (*tangent)(const fu_body *body, const fu_instant *at, double *D, double *K);
    double (*kinetic_energy)(const fu_body *body, const double *b, const double *w);
    double (*elastic_energy)(const fu_body *body, const double *b);
    double (*potential_energy)(const fu_body *body, const double *b); /* without that of model->gravity */
    double (*dissipation)(const fu_body *body, const double *b, const double *w);
} fu_matter;
extern const fu_matter fu_rigid_matter, fu_modal_matter;

/* Modes of a body; index 0 of S and X is the undeformed position (derive/bodies/modal.py). */
typedef struct {
    const fu_modal_kernels *kernel;
    const double *S, *X;                      /* (n + 1) x dim; (n + 1) x (n + 1) x dim x dim */
    const double *mass, *stiffness, *damping; /* n x n */
    const double *zero;                       /* a zero for each dof */
    double *sums, *matrices;                  /* work space: 3 (n + 1) dim^2; 3 dofs^2 (mass_times takes the first) */
    double g[3];
} fu_shape;

/* A body with a frame: rigid, or modal with a number of modes. */
struct fu_body {
    const fu_body_kernels *kernel; /* of its frame */
    const fu_matter *matter;
    int configuration; /* first entry in q: the frame's, then the modes' */
    int dof;           /* first dof: likewise */
    int modes;
    double mass;
    double J[9];
    const fu_shape *shape; /* of the modes; null without */
};

/* A point of a modal body: its undeformed position, and displacements and rotations of the modes there. */
typedef struct {
    const double *x, *phi, *psi; /* dim; modes x dim; modes x turns */
} fu_modal_attachment;
typedef struct {
    double p[3], axes[9], velocity[3], omega[3], bias[3], omega_bias[3];
} fu_modal_point;

/* bodies.c: rigid and modal */
int fu_body_dofs(const fu_body *body);
void fu_bodies_mass_times(const fu_model *model, const double *q, const double *a, double *f);
void fu_bodies_forces(const fu_model *model, const double *q, const double *v, double *f);
void fu_bodies_matrix(const fu_model *model, const fu_state *at, const double *psi, fu_weights weights,
                      fu_system *system);
void fu_bodies_mass(const fu_model *model, const double *q, int constant, fu_system *system);
double fu_bodies_kinetic_energy(const fu_model *model, const double *q, const double *v);
double fu_bodies_elastic_energy(const fu_model *model, const double *q);
double fu_bodies_potential_energy(const fu_model *model, const double *q);
double fu_bodies_dissipation(const fu_model *model, const double *q, const double *v);

/* modal.c: points */
void fu_modal_attachment_state(const fu_body *body, const fu_modal_attachment *attachment, const double *b,
                               const double *w, fu_modal_point *out, double *P, double *T);
/* Computes K (n x n), the derivative by the body's dofs of P' f + T' m at fixed f and m, and those of the velocities at
 * fixed rates. */
void fu_modal_attachment_wrench(const fu_body *body, const fu_modal_attachment *attachment, const double *b,
                                const double *w, const double *f, const double *m, double *K, double *v_q,
                                double *omega_q);

#endif
