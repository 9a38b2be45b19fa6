/* Forces and moments at attachments: their generalised forces, and the derivatives of these by the unknowns of a Newton
 * system. What differentiates is in the kernels of bodies (derive/bodies/kernels.py).
 */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/attachments.h"

#include <string.h>

/* Adds `factor` times the product of a vector and n_rows rows of n, three rows in a pass. */
static void add_rows(int n_rows, int n, double factor, const double *vector, const double *rows, double *restrict out)
{
    for (int d = 0; d < n_rows; d += 3) {
        const int second = d + 1 < n_rows, third = d + 2 < n_rows;
        const double *x = rows + d * n, *y = x + second * n, *z = y + third * n;
        const double a = factor * vector[d], b = second ? factor * vector[d + 1] : 0.0,
                     c = third ? factor * vector[d + 2] : 0.0;
        for (int i = 0; i < n; ++i) out[i] += a * x[i] + b * y[i] + c * z[i];
    }
}

/* Does what fu_wrench_force does; the compiler unrolls the loops for constant dim and turns. */
static inline void multiply_transposed(int dim, int turns, const fu_attachment_state *at, const double *f,
                                       const double *m, double factor, double *restrict out)
{
    const int n = at->n;
    for (int i = 0; i < n; ++i) {
        double sum = 0.0;
        for (int d = 0; d < dim; ++d) sum += at->P[d * n + i] * f[d];
        for (int k = 0; k < turns; ++k) sum += at->T[k * n + i] * m[k];
        out[i] = factor * sum;
    }
}

void fu_wrench_force(int dim, const fu_attachment_state *at, const double *f, const double *m, double factor,
                     double *out)
{
    if (dim == 3) {
        if (f && m) multiply_transposed(3, 3, at, f, m, factor, out);
        else if (f) multiply_transposed(3, 0, at, f, m, factor, out);
        else multiply_transposed(0, 3, at, f, m, factor, out);
    } else multiply_transposed(f ? 2 : 0, m ? 1 : 0, at, f, m, factor, out);
}

void fu_add_wrench(int dim, const fu_attachment_state *at, const double *f, const double *m, double factor, double *sum)
{
    double force[FU_ATTACHMENT_COORDINATES];
    fu_wrench_force(dim, at, f, m, factor, force);
    for (int i = 0; i < at->n; ++i) sum[at->at[i]] += force[i];
}

void fu_point_motion_at(const fu_model *model, const fu_attachment *on, const fu_state *state, int what,
                        const double *f, const double *m, const double *psi, double rate, fu_point_motion *out)
{
    fu_attachment_at(model, on, state, 0.0, what, &out->at);
    const int n = out->at.n, places = model->dim * n, turns = what & FU_AXES ? fu_turns(model->dim) * n : 0;
    double *velocity = out->by + places, *turn = velocity + places, *omega = turn + turns;
    out->rows = 2 * model->dim + (turns ? 2 * fu_turns(model->dim) : 0);
    out->is_stiff = on->body >= 0 || on->rope || m;
    memcpy(out->by, out->at.P, sizeof(double) * (size_t)places);
    memcpy(turn, out->at.T, sizeof(double) * (size_t)turns);
    if (on->body < 0) {
        memset(velocity, 0, sizeof(double) * (size_t)places);
        memset(omega, 0, sizeof(double) * (size_t)turns);
    }
    if (out->is_stiff) fu_wrench_derivatives(model, on, state, f, m, n, out->K, velocity, turns ? omega : 0);
    fu_turn_attachment(model, on, psi, out->by, out->rows, n, 0);
    fu_turn_attachment(model, on, psi, out->K, n, n, 0);
    for (int i = 0; i < places; ++i) velocity[i] += rate * out->at.P[i];
    for (int i = 0; i < turns; ++i) omega[i] += rate * out->at.T[i];
}

void fu_element_motion(const fu_model *model, int first, int n, const double *N, double rate, fu_point_motion *out)
{
    const int dim = model->dim;
    out->at.n = n;
    out->rows = 2 * dim;
    out->is_stiff = 0;
    memset(out->by, 0, sizeof(double) * (size_t)(2 * dim * n));
    for (int i = 0; i < n; ++i) {
        out->at.at[i] = first + i;
        out->by[i % dim * n + i] = N[i / dim];
        out->by[(dim + i % dim) * n + i] = rate * N[i / dim];
    }
    memcpy(out->at.P, out->by, sizeof(double) * (size_t)(dim * n));
}

void fu_changes(const fu_point_motion *motion, int n_values, const double *derivatives, double *changes)
{
    const int n = motion->at.n, rows = motion->rows;
    memset(changes, 0, sizeof(double) * (size_t)(n_values * n));
    for (int k = 0; k < n_values; ++k) add_rows(rows, n, 1.0, derivatives + k * rows, motion->by, changes + k * n);
}

void fu_add_wrench_tangent(const fu_model *model, const fu_attachment_state *of, const fu_attachment_state *by,
                           const double *f, const double *m, const double *K, double factor, fu_system *system)
{
    const int dim = f ? model->dim : 0, turns = m ? fu_turns(model->dim) : 0, n = by->n;
    for (int i = 0; i < of->n; ++i)
        for (int j = 0; j < n; ++j) {
            double sum = K ? K[i * n + j] : 0.0;
            for (int d = 0; d < dim; ++d) sum += of->P[d * of->n + i] * f[d * n + j];
            for (int k = 0; k < turns; ++k) sum += of->T[k * of->n + i] * m[k * n + j];
            if (sum != 0.0) fu_add(model, system, of->at[i], by->at[j], factor * sum);
        }
}
