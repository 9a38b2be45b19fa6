/* Finite rotations of bodies: configurations moved by steps, and derivatives converted to derivatives by steps. The
 * kernels of derive/bodies/moves.py have the motion of a body's frame. */
#include "bodies/model.h"
#include "bodies/rotation.h"

#include <string.h>

/* A configuration that threads move. */
typedef struct {
    double *q;
    const double *step;
    int n;
} move;

static void move_part(const void *what, int part, int parts)
{
    const move *job = what;
    const fu_range range = fu_part_of(job->n, FU_DOFS_APART, part, parts);
    for (int i = range.first; i < range.end; ++i) job->q[i] += job->step[i];
}

/* Moves a configuration by a step of the dofs; `cayley`: by Cayley vectors, otherwise by rotation vectors. */
static void move_all(const fu_model *model, double *q, const double *step, int cayley)
{
    const int n_flexible = model->n_bodies ? model->bodies[0].dof : model->n_dof;
    const move job = {q, step, n_flexible};
    fu_share(model->threads, n_flexible, move_part, &job);
    FU_EACH_BODY(body, model) {
        const fu_body_kernels *kernel = body->kernel;
        double *b = q + body->configuration, *eta = b + kernel->configuration, moved[FU_FRAME_ENTRIES];
        const double *of_body = step + body->dof;
        (cayley ? kernel->cayley_move : kernel->move)(b, of_body, moved);
        memcpy(b, moved, sizeof(double) * (size_t)kernel->configuration);
        for (int j = 0; j < body->modes; ++j) eta[j] += of_body[kernel->velocity + j];
    }
}

/* Moves a configuration by increments of the dofs: translations, and rotation vectors in body axes. */
void fu_move(const fu_model *model, double *q, const double *dofs)
{
    move_all(model, q, dofs, 0);
}

/* Moves a configuration by a step psi: a translation, and Theta in body axes with A_next = A cay(Theta). In the plane
 * Theta is twice the tangent of half the angle. */
void fu_cayley_move(const fu_model *model, double *q, const double *psi)
{
    move_all(model, q, psi, 1);
}

/* Computes the configuration half-way between two; bodies have rotated by half of the rotation. */
void fu_between(const fu_model *model, const double *q, const double *q_next, double *between)
{
    const int n_flexible = model->n_bodies ? model->bodies[0].configuration : model->n_q;
    for (int i = 0; i < n_flexible; ++i) between[i] = 0.5 * (q[i] + q_next[i]);
    FU_EACH_BODY(body, model) {
        const int at = body->configuration, eta = at + body->kernel->configuration;
        body->kernel->halfway(q + at, q_next + at, between + at);
        for (int i = eta; i < eta + body->modes; ++i) between[i] = 0.5 * (q[i] + q_next[i]);
    }
}

/* Multiplies rows by T in the columns of a body's rotations. */
static inline void turn_columns(const fu_body_kernels *kernel, double *rows, int n_rows, int n_columns, int first,
                                const double *T)
{
    double *p = rows + first + kernel->dim;
    if (kernel->dim == 2) {
        for (int r = 0; r < n_rows; ++r) p[r * n_columns] *= T[0];
        return;
    }
    const double xx = T[0], xy = T[1], xz = T[2], yx = T[3], yy = T[4], yz = T[5], zx = T[6], zy = T[7], zz = T[8];
    for (int r = 0; r < n_rows; ++r, p += n_columns) {
        const double x = p[0], y = p[1], z = p[2];
        p[0] = x * xx + y * yx + z * zx;
        p[1] = x * xy + y * yy + z * zy;
        p[2] = x * xz + y * yz + z * zz;
    }
}

/* Converts derivatives by a body's dofs, the first of them in column `first`, to those by psi of `fu_move`. In the
 * plane they are equal. */
void fu_turn_columns(const fu_body_kernels *kernel, double *rows, int n_rows, int n_columns, int first,
                     const double *psi)
{
    double T[FU_MATRIX_ENTRIES];
    if (kernel->dim == 2) return;
    kernel->move_tangent(psi, T);
    turn_columns(kernel, rows, n_rows, n_columns, first, T);
}

/* The same for psi of `fu_cayley_move`. */
void fu_cayley_columns(const fu_body_kernels *kernel, double *rows, int n_rows, int n_columns, int first,
                       const double *psi)
{
    double T[FU_MATRIX_ENTRIES];
    kernel->cayley_tangent(psi, T);
    turn_columns(kernel, rows, n_rows, n_columns, first, T);
}
