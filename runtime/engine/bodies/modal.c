/* Modal bodies: loops over modes around the generated kernels (derive/bodies/modal.py has the mathematics). */
#include "bodies/bodies.h"

#include <string.h>

enum { RATES = 3 }; /* u, u', u'' */

/* Moments of the fields u, u', u''. Y[r] + k dim^2 are those of mode k with them; k = 0 is the undeformed position. */
typedef struct {
    double S[RATES][FU_SPACE], X[RATES][FU_MATRIX_ENTRIES], *Y[RATES];
} moments;

/* Fills the moments: sums over the coefficients c = (1, eta), c' = (0, eta'), c'' = (0, eta''); null stands for zero.
 */
static moments sum_of(const fu_body *body, const double *eta, const double *rate, const double *acceleration)
{
    const fu_shape *shape = body->shape;
    const int n = body->modes + 1, dim = body->kernel->dim, square = dim * dim;
    const double *coefficients[RATES] = {eta, rate, acceleration};
    moments m;
    memset(m.S, 0, sizeof m.S);
    memset(m.X, 0, sizeof m.X);
    for (int r = 0; r < RATES; ++r) {
        const double *c = coefficients[r];
        m.Y[r] = shape->sums + r * n * square;
        memset(m.Y[r], 0, sizeof(double) * (size_t)(n * square));
        if (!c) continue;
        for (int l = r ? 1 : 0; l < n; ++l) {
            const double c_l = l ? c[l - 1] : 1.0;
            for (int d = 0; d < dim; ++d) m.S[r][d] += c_l * shape->S[l * dim + d];
            for (int k = 0; k < n; ++k)
                for (int i = 0; i < square; ++i) m.Y[r][k * square + i] += c_l * shape->X[(k * n + l) * square + i];
        }
        for (int k = 0; k < n; ++k)
            for (int i = 0; i < square; ++i) m.X[r][i] += (k ? eta[k - 1] : 1.0) * m.Y[r][k * square + i];
    }
    return m;
}

static const double *eta_of(const fu_body *body, const double *b)
{
    return b + body->kernel->configuration;
}

static const double *rate_of(const fu_body *body, const double *w)
{
    return w + body->kernel->velocity;
}

/* Adds stiffness eta + damping eta' to the forces on the modes. */
static void add_elasticity(const fu_body *body, const double *eta, const double *rate, double *f)
{
    const int n = body->modes;
    for (int k = 0; k < n; ++k)
        for (int l = 0; l < n; ++l)
            f[k] += body->shape->stiffness[k * n + l] * eta[l] + body->shape->damping[k * n + l] * rate[l];
}

/* Adds the inertial forces at zero accelerations, less the weight. */
static void add_inertia(const fu_body *body, const double *b, const double *w, double *f)
{
    const fu_modal_kernels *kernel = body->shape->kernel;
    const int dim = body->kernel->dim, frame = body->kernel->velocity;
    const moments m = sum_of(body, eta_of(body, b), rate_of(body, w), 0);
    const double *a = body->shape->zero, *g = body->shape->g;
    double part[FU_FRAME_DOFS];
    kernel->inertia_force(b, w, a, g, body->mass, m.S[0], m.S[1], m.S[2], m.X[0], m.X[1], m.X[2], part);
    for (int i = 0; i < frame; ++i) f[i] += part[i];
    for (int k = 1; k <= body->modes; ++k) {
        const int of = k * dim * dim;
        kernel->mode_force(b, w, a, g, body->shape->S + k * dim, m.Y[0] + of, m.Y[1] + of, m.Y[2] + of, part);
        f[frame + k - 1] += part[0];
    }
}

/* Computes M of eq 12. */
static void mass(const fu_body *body, const double *b, double *M)
{
    const fu_shape *shape = body->shape;
    const int dim = body->kernel->dim, frame = body->kernel->velocity, modes = body->modes, n = frame + modes;
    const moments m = sum_of(body, eta_of(body, b), 0, 0);
    double of_frame[FU_FRAME_DOFS * FU_FRAME_DOFS], column[FU_FRAME_DOFS];
    shape->kernel->mass_matrix(b, body->mass, m.S[0], m.X[0], of_frame);
    for (int i = 0; i < frame; ++i)
        for (int j = 0; j < frame; ++j) M[i * n + j] = of_frame[i * frame + j];
    for (int k = 0; k < modes; ++k) {
        shape->kernel->mode_mass(b, shape->S + (k + 1) * dim, m.Y[0] + (k + 1) * dim * dim, column);
        for (int i = 0; i < frame; ++i) M[i * n + frame + k] = M[(frame + k) * n + i] = column[i];
        for (int l = 0; l < modes; ++l) M[(frame + k) * n + frame + l] = shape->mass[k * modes + l];
    }
}

static void mass_times(const fu_body *body, const double *b, const double *a, double *f)
{
    const int n = fu_body_dofs(body);
    double *M = body->shape->matrices;
    mass(body, b, M);
    for (int i = 0; i < n; ++i) {
        f[i] = 0.0;
        for (int j = 0; j < n; ++j) f[i] += M[i * n + j] * a[j];
    }
}

static void forces(const fu_body *body, const double *b, const double *w, double *f)
{
    add_inertia(body, b, w, f);
    add_elasticity(body, eta_of(body, b), rate_of(body, w), f + body->kernel->velocity);
}

static void tangent(const fu_body *body, const fu_instant *at, double *D, double *K)
{
    const fu_shape *shape = body->shape;
    const fu_modal_kernels *kernel = shape->kernel;
    const int dim = body->kernel->dim, square = dim * dim, frame = body->kernel->velocity;
    const int modes = body->modes, n = frame + modes;
    const moments m = sum_of(body, eta_of(body, at->b), rate_of(body, at->w), rate_of(body, at->a));
    double D_frame[FU_FRAME_DOFS * FU_FRAME_DOFS], K_frame[FU_FRAME_DOFS * FU_FRAME_DOFS], D_of[FU_FRAME_DOFS],
        K_of[FU_FRAME_DOFS], D_by[FU_FRAME_DOFS], K_by[FU_FRAME_DOFS];
    kernel->inertia_tangent(at->b, at->w, at->a, shape->g, body->mass, m.S[0], m.S[1], m.S[2], m.X[0], m.X[1], m.X[2],
                            D_frame, K_frame);
    for (int i = 0; i < frame; ++i)
        for (int j = 0; j < frame; ++j) {
            D[i * n + j] = D_frame[i * frame + j];
            K[i * n + j] = K_frame[i * frame + j];
        }
    for (int k = 1; k <= modes; ++k) {
        const int of = k * square, row = frame + k - 1;
        kernel->mode_tangent(at->b, at->w, at->a, shape->g, shape->S + k * dim, m.Y[0] + of, m.Y[1] + of, m.Y[2] + of,
                             D_of, K_of, D_by, K_by);
        for (int i = 0; i < frame; ++i) {
            D[row * n + i] = D_of[i];
            K[row * n + i] = K_of[i];
            D[i * n + row] = D_by[i];
            K[i * n + row] = K_by[i];
        }
        for (int l = 1; l <= modes; ++l) {
            const int at_kl = (k - 1) * modes + l - 1, place = row * n + frame + l - 1;
            kernel->pair_tangent(at->b, at->w, at->a, shape->g, shape->X + (k * (modes + 1) + l) * square, D + place,
                                 K + place);
            D[place] += shape->damping[at_kl];
            K[place] += shape->stiffness[at_kl];
        }
    }
}

static double kinetic_energy(const fu_body *body, const double *b, const double *w)
{
    const int square = body->kernel->dim * body->kernel->dim;
    const double *rate = rate_of(body, w);
    const moments m = sum_of(body, eta_of(body, b), rate, 0);
    double rates = 0.0, energy;
    for (int k = 1; k <= body->modes; ++k)
        for (int d = 0; d < square; d += body->kernel->dim + 1) rates += rate[k - 1] * m.Y[1][k * square + d];
    body->shape->kernel->kinetic_energy(b, w, body->mass, m.S[0], m.S[1], m.X[0], m.X[1], rates, &energy);
    return energy;
}

static double elastic_energy(const fu_body *body, const double *b)
{
    const double *eta = eta_of(body, b), *K = body->shape->stiffness;
    double total = 0.0;
    for (int k = 0; k < body->modes; ++k)
        for (int l = 0; l < body->modes; ++l) total += 0.5 * eta[k] * K[k * body->modes + l] * eta[l];
    return total;
}

static double potential_energy(const fu_body *body, const double *b)
{
    const int dim = body->kernel->dim;
    const double *eta = eta_of(body, b);
    double S[FU_SPACE] = {0}, energy;
    for (int k = 0; k <= body->modes; ++k)
        for (int d = 0; d < dim; ++d) S[d] += (k ? eta[k - 1] : 1.0) * body->shape->S[k * dim + d];
    body->shape->kernel->potential_energy(b, body->shape->g, body->mass, S, &energy);
    return energy;
}

static double dissipation(const fu_body *body, const double *b, const double *w)
{
    const double *rate = rate_of(body, w), *C = body->shape->damping;
    double total = 0.0;
    (void)b;
    for (int k = 0; k < body->modes; ++k)
        for (int l = 0; l < body->modes; ++l) total += rate[k] * C[k * body->modes + l] * rate[l];
    return total;
}

const fu_matter fu_modal_matter = {
    0, mass_times, forces, mass, tangent, kinetic_energy, elastic_energy, potential_energy, dissipation};

/* Computes displacement and rotation of a point from its modes, or their rates. */
static void point_of(const fu_body *body, const fu_modal_attachment *attachment, const double *c, int is_rate,
                     double u[FU_SPACE], double theta[FU_SPACE])
{
    const int dim = body->kernel->dim, turns = body->kernel->velocity - dim;
    for (int d = 0; d < dim; ++d) u[d] = is_rate ? 0.0 : attachment->x[d];
    for (int d = 0; d < turns; ++d) theta[d] = 0.0;
    for (int k = 0; k < body->modes; ++k) {
        for (int d = 0; d < dim; ++d) u[d] += c[k] * attachment->phi[k * dim + d];
        for (int d = 0; d < turns; ++d) theta[d] += c[k] * attachment->psi[k * turns + d];
    }
}

/* Computes the state of a point of a modal body with its axes: P (dim x n) and T (rotations x n) are over all its
 * dofs. */
void fu_modal_attachment_state(const fu_body *body, const fu_modal_attachment *attachment, const double *b,
                               const double *w, fu_modal_point *out, double *P, double *T)
{
    const fu_modal_kernels *kernel = body->shape->kernel;
    const int dim = body->kernel->dim, frame = body->kernel->velocity, turns = frame - dim, n = fu_body_dofs(body);
    double u[FU_SPACE], u1[3], theta[FU_SPACE], theta1[3], frame_P[18], frame_T[18], column[3], turn[3];
    point_of(body, attachment, eta_of(body, b), 0, u, theta);
    point_of(body, attachment, rate_of(body, w), 1, u1, theta1);
    kernel->attachment(b, u, theta, w, u1, theta1, out->p, out->axes, frame_P, frame_T, out->velocity, out->omega,
                       out->bias, out->omega_bias);
    for (int j = 0; j < frame; ++j) {
        for (int d = 0; d < dim; ++d) P[d * n + j] = frame_P[d * frame + j];
        for (int d = 0; d < turns; ++d) T[d * n + j] = frame_T[d * frame + j];
    }
    for (int k = 0; k < body->modes; ++k) {
        kernel->attachment_mode(b, u, theta, attachment->phi + k * dim, attachment->psi + k * turns, column, turn);
        for (int d = 0; d < dim; ++d) P[d * n + frame + k] = column[d];
        for (int d = 0; d < turns; ++d) T[d * n + frame + k] = turn[d];
    }
}

void fu_modal_attachment_wrench(const fu_body *body, const fu_modal_attachment *attachment, const double *b,
                                const double *w, const double *f, const double *m, double *K, double *v_q,
                                double *omega_q)
{
    const fu_modal_kernels *kernel = body->shape->kernel;
    const int dim = body->kernel->dim, frame = body->kernel->velocity, turns = frame - dim, n = fu_body_dofs(body);
    double u[FU_SPACE], theta[FU_SPACE], u1[FU_SPACE], theta1[FU_SPACE], K_frame[FU_FRAME_DOFS * FU_FRAME_DOFS],
        v_frame[18], omega_frame[18], row[FU_FRAME_DOFS], column[FU_FRAME_DOFS], v[FU_SPACE], omega[FU_SPACE];
    point_of(body, attachment, eta_of(body, b), 0, u, theta);
    point_of(body, attachment, rate_of(body, w), 1, u1, theta1);
    kernel->attachment_wrench(b, u, theta, f, m, w, u1, theta1, K_frame, v_frame, omega_frame);
    for (int j = 0; j < frame; ++j) {
        for (int i = 0; i < frame; ++i) K[i * n + j] = K_frame[i * frame + j];
        for (int d = 0; d < dim; ++d) v_q[d * n + j] = v_frame[d * frame + j];
        for (int d = 0; d < turns; ++d) omega_q[d * n + j] = omega_frame[d * frame + j];
    }
    for (int k = 0; k < body->modes; ++k) {
        const double *phi = attachment->phi + k * dim, *psi = attachment->psi + k * turns;
        const int mode = frame + k;
        kernel->attachment_mode_wrench(b, u, theta, phi, psi, f, m, w, u1, theta1, row, column, v, omega);
        for (int i = 0; i < frame; ++i) {
            K[mode * n + i] = row[i];
            K[i * n + mode] = column[i];
        }
        for (int d = 0; d < dim; ++d) v_q[d * n + mode] = v[d];
        for (int d = 0; d < turns; ++d) omega_q[d * n + mode] = omega[d];
        for (int l = 0; l < body->modes; ++l)
            kernel->attachment_pair_wrench(b, u, theta, phi, psi, attachment->phi + l * dim,
                                           attachment->psi + l * turns, f, m, K + mode * n + frame + l);
    }
}
