/* Finite rotations of bodies: the exponential map and its derivative, with their limits at zero. */
#include "engine.h"

/* sin(a)/a, (1 - cos a)/a^2, (a - sin a)/a^3: series where the quotients lose digits */
static void coefficients(double a2, double *s, double *c, double *d)
{
    if (a2 < 1e-2) {
        *s = 1.0 - a2 / 6.0 * (1.0 - a2 / 20.0 * (1.0 - a2 / 42.0 * (1.0 - a2 / 72.0 * (1.0 - a2 / 110.0))));
        *c = 0.5 * (1.0 - a2 / 12.0 * (1.0 - a2 / 30.0 * (1.0 - a2 / 56.0 * (1.0 - a2 / 90.0))));
        *d = (1.0 - a2 / 20.0 * (1.0 - a2 / 42.0 * (1.0 - a2 / 72.0 * (1.0 - a2 / 110.0)))) / 6.0;
        return;
    }
    const double a = sqrt(a2);
    *s = sin(a) / a;
    *c = (1.0 - cos(a)) / a2;
    *d = (1.0 - *s) / a2;
}

static void normalised(const double *p, int n, double *unit)
{
    double square = 0.0;
    for (int i = 0; i < n; ++i) square += p[i] * p[i];
    const double scale = 1.0 / sqrt(square);
    for (int i = 0; i < n; ++i) unit[i] = scale * p[i];
}

/* quaternion product p (w, x, y, z) */
static void times(const double *p, double w, double x, double y, double z, double q[4])
{
    q[0] = p[0] * w - p[1] * x - p[2] * y - p[3] * z;
    q[1] = p[0] * x + p[1] * w + p[2] * z - p[3] * y;
    q[2] = p[0] * y - p[1] * z + p[2] * w + p[3] * x;
    q[3] = p[0] * z + p[1] * y - p[2] * x + p[3] * w;
}

/* Coordinates that a body has beyond its frame's: increments add to them. */
static void move_modes(const fu_body *body, double *q, const double *dofs)
{
    double *eta = q + body->configuration + body->kernel->configuration;
    const double *increment = dofs + body->dof + body->kernel->velocity;
    for (int k = 0; k < body->modes; ++k) eta[k] += increment[k];
}

/* b = (R, quaternion) moves by (translation, rotation vector in body axes); in the plane (R, unit complex number). */
static void move_body(const fu_body_kernels *kernel, double *b, const double *increment)
{
    const int dim = kernel->dim;
    for (int i = 0; i < dim; ++i) b[i] += increment[i];
    const double *turn = increment + dim;
    double *p = b + dim;
    if (dim == 2) {
        const double c = cos(turn[0]), s = sin(turn[0]), x = p[0] * c - p[1] * s, y = p[1] * c + p[0] * s;
        const double scale = 1.0 / sqrt(x * x + y * y);
        p[0] = scale * x;
        p[1] = scale * y;
        return;
    }
    const double h[3] = {0.5 * turn[0], 0.5 * turn[1], 0.5 * turn[2]};
    const double h2 = h[0] * h[0] + h[1] * h[1] + h[2] * h[2];
    double sine, versine, unused;
    coefficients(h2, &sine, &versine, &unused);
    double q[4];
    times(p, 1.0 - versine * h2, sine * h[0], sine * h[1], sine * h[2], q);
    const double scale = 1.0 / sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; ++i) p[i] = scale * q[i];
}

/* Configuration moved by increments of the dofs. */
void fu_move(const fu_model *model, double *q, const double *dofs)
{
    const int n_flexible = model->n_bodies ? model->bodies[0].dof : model->n_dof;
    for (int i = 0; i < n_flexible; ++i) q[i] += dofs[i];
    for (int b = 0; b < model->n_bodies; ++b) {
        const fu_body *body = &model->bodies[b];
        move_body(body->kernel, q + body->configuration, dofs + body->dof);
        move_modes(body, q, dofs);
    }
}

/* Configuration moved by a step psi: translation, and Theta in body axes with A_next = A cay(Theta). In the plane Theta is
 * twice the tangent of half the angle. */
void fu_cayley_move(const fu_model *model, double *q, const double *psi)
{
    const int n_flexible = model->n_bodies ? model->bodies[0].dof : model->n_dof;
    for (int i = 0; i < n_flexible; ++i) q[i] += psi[i];
    for (int b = 0; b < model->n_bodies; ++b) {
        const fu_body *body = &model->bodies[b];
        const int dim = body->kernel->dim;
        double *at = q + body->configuration, *p = at + dim, moved[4];
        const double *step = psi + body->dof, *turn = step + dim;
        for (int i = 0; i < dim; ++i) at[i] += step[i];
        if (dim == 2) {
            const double t = 0.5 * turn[0], c = 1.0 - t * t, s = 2.0 * t;
            moved[0] = p[0] * c - p[1] * s;
            moved[1] = p[1] * c + p[0] * s;
        } else times(p, 1.0, 0.5 * turn[0], 0.5 * turn[1], 0.5 * turn[2], moved);
        normalised(moved, dim == 2 ? 2 : 4, p);
        move_modes(body, q, psi);
    }
}

/* Half-way between two configurations; bodies have turned half of the way. */
void fu_between(const fu_model *model, const double *q, const double *q_next, double *between)
{
    for (int i = 0; i < model->n_q; ++i) between[i] = 0.5 * (q[i] + q_next[i]);
    for (int b = 0; b < model->n_bodies; ++b) {
        const fu_body *body = &model->bodies[b];
        double *p = between + body->configuration + body->kernel->dim;
        normalised(p, body->kernel->dim == 2 ? 2 : 4, p);
    }
}

/* Rates of the entries of b by the velocity w: translation, and rotation about body axes. */
void fu_body_rate(const fu_body_kernels *kernel, const double *b, const double *w, double *rate)
{
    const int dim = kernel->dim;
    for (int i = 0; i < dim; ++i) rate[i] = w[i];
    if (dim == 2) {
        rate[2] = -w[2] * b[3];
        rate[3] = w[2] * b[2];
    } else times(b + 3, 0.0, 0.5 * w[3], 0.5 * w[4], 0.5 * w[5], rate + 3);
}

/* A small change of the entries of b as an increment of its dofs: undoes `fu_body_rate`. */
void fu_body_increment(const fu_body_kernels *kernel, const double *b, const double *change, double *increment)
{
    const int dim = kernel->dim;
    for (int i = 0; i < dim; ++i) increment[i] = change[i];
    if (dim == 2) {
        increment[2] = b[2] * change[3] - b[3] * change[2];
        return;
    }
    const double back[4] = {b[3], -b[4], -b[5], -b[6]};
    double turn[4];
    times(back, change[3], change[4], change[5], change[6], turn);
    for (int i = 0; i < 3; ++i) increment[3 + i] = 2.0 * turn[1 + i];
}

/* T with exp(psi + T^-1 dtheta) = exp(psi) exp(dtheta): a change of psi turns the body by T dpsi (body axes). */
static void exponential_tangent(const double *psi, double T[9])
{
    const double x = psi[0], y = psi[1], z = psi[2], a2 = x * x + y * y + z * z;
    double s, c, d;
    coefficients(a2, &s, &c, &d);
    T[0] = 1.0 - d * (y * y + z * z);
    T[1] = c * z + d * x * y;
    T[2] = -c * y + d * x * z;
    T[3] = -c * z + d * x * y;
    T[4] = 1.0 - d * (x * x + z * z);
    T[5] = c * x + d * y * z;
    T[6] = c * y + d * x * z;
    T[7] = -c * x + d * y * z;
    T[8] = 1.0 - d * (x * x + y * y);
}

/* Derivatives by a body's dofs, the first of them in column `first`, made derivatives by psi: in the plane they are. */
void fu_turn_columns(const fu_body_kernels *kernel, double *rows, int n_rows, int n_columns, int first, const double *psi)
{
    if (kernel->dim == 2) return;
    double T[9];
    exponential_tangent(psi + 3, T);
    for (int r = 0; r < n_rows; ++r) {
        double *p = rows + r * n_columns + first + 3;
        const double x = p[0], y = p[1], z = p[2];
        for (int d = 0; d < 3; ++d) p[d] = x * T[d] + y * T[3 + d] + z * T[6 + d];
    }
}

/* The same for psi of `fu_cayley_move`: a change of Theta turns the body by (1 - Theta~/2)/(1 + Theta^2/4) of it. */
void fu_cayley_columns(const fu_body_kernels *kernel, double *rows, int n_rows, int n_columns, int first, const double *psi)
{
    const int dim = kernel->dim;
    const double x = 0.5 * psi[dim], y = dim == 3 ? 0.5 * psi[4] : 0.0, z = dim == 3 ? 0.5 * psi[5] : 0.0;
    const double scale = 1.0 / (1.0 + x * x + y * y + z * z);
    for (int r = 0; r < n_rows; ++r) {
        double *p = rows + r * n_columns + first + dim;
        if (dim == 2) {
            p[0] *= scale;
            continue;
        }
        const double a = p[0], b = p[1], c = p[2];
        p[0] = scale * (a - b * z + c * y);
        p[1] = scale * (b - c * x + a * z);
        p[2] = scale * (c - a * y + b * x);
    }
}
