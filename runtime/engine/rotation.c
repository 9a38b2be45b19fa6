/* Finite rotations of rigid bodies: the exponential map and its derivative, with their limits at zero. */
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

/* b = (R, quaternion) moved by (translation, rotation vector in body axes); in the plane (R, unit complex number). */
void fu_move_body(const fu_body *kernel, const double *b, const double *increment, double *moved)
{
    const int dim = kernel->dim;
    for (int i = 0; i < dim; ++i) moved[i] = b[i] + increment[i];
    const double *p = b + dim, *turn = increment + dim;
    double *m = moved + dim;
    if (dim == 2) {
        const double c = cos(turn[0]), s = sin(turn[0]), x = p[0] * c - p[1] * s, y = p[1] * c + p[0] * s;
        const double scale = 1.0 / sqrt(x * x + y * y);
        m[0] = scale * x;
        m[1] = scale * y;
        return;
    }
    const double h[3] = {0.5 * turn[0], 0.5 * turn[1], 0.5 * turn[2]};
    const double h2 = h[0] * h[0] + h[1] * h[1] + h[2] * h[2];
    double sine, versine, unused;
    coefficients(h2, &sine, &versine, &unused);
    const double w = 1.0 - versine * h2, x = sine * h[0], y = sine * h[1], z = sine * h[2];
    const double q[4] = {p[0] * w - p[1] * x - p[2] * y - p[3] * z, p[0] * x + p[1] * w + p[2] * z - p[3] * y,
                         p[0] * y - p[1] * z + p[2] * w + p[3] * x, p[0] * z + p[1] * y - p[2] * x + p[3] * w};
    const double scale = 1.0 / sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; ++i) m[i] = scale * q[i];
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
void fu_turn_columns(const fu_body *kernel, double *rows, int n_rows, int n_columns, int first, const double *psi)
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
