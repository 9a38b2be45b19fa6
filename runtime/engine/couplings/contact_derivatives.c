/* Derivatives of the force of contact at a point, and of its reaction on the body that the surface is on, by the coordinates of both.
 *
 * How the velocity of a surface's point changes at fixed rates of its body is left out, as Newton's method does without it.
 */
#include "engine.h"

#include <string.h>

/* How a point moves with its coordinates: P (dim x n); `moved` has it by the unknowns; `by_rate` its velocity by these at fixed rates;
 * K, if it is of a body, the derivative of P' f by them. */
typedef struct {
    int n, at[FU_ATTACHMENT_COORDINATES];
    double P[3 * FU_ATTACHMENT_COORDINATES], moved[3 * FU_ATTACHMENT_COORDINATES], by_rate[3 * FU_ATTACHMENT_COORDINATES];
    double K[FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES];
} motion;

/* Makes how a point of a body moves. */
static void motion_of_point(const fu_model *model, const fu_contact *contact, const fu_state *state, int point, const double *f,
                            const double *psi, motion *out)
{
    const fu_attachment *to = &contact->attachments[point];
    fu_attachment_state end;
    fu_attachment_at(model, to, state, 0.0, FU_POINT, &end);
    out->n = end.n;
    memcpy(out->at, end.at, sizeof out->at);
    memcpy(out->P, end.P, sizeof out->P);
    memcpy(out->moved, end.P, sizeof out->moved);
    memset(out->by_rate, 0, sizeof out->by_rate);
    fu_turn_point(model, to, state, f, psi, &end, out->moved, out->by_rate, out->K);
}

/* Makes how a point of an element moves: with so many of its coordinates as its shape functions have. */
static void motion_on_cable(const fu_model *model, const fu_contact *contact, int element, int point, motion *out)
{
    const fu_cable *cable = &model->cables[contact->cable];
    const int dim = model->dim, n = cable->coordinates / dim;
    const double *N = fu_contact_shapes(contact, n, element, point);
    out->n = cable->coordinates;
    memset(out->P, 0, sizeof out->P);
    for (int k = 0; k < n; ++k)
        for (int d = 0; d < dim; ++d) {
            out->at[k * dim + d] = fu_contact_first(model, contact, element) + k * dim + d;
            out->P[d * out->n + k * dim + d] = N[k];
        }
    memcpy(out->moved, out->P, sizeof out->moved);
    memset(out->by_rate, 0, sizeof out->by_rate);
    memset(out->K, 0, sizeof out->K);
}

/* Makes the vector product of the turn of column i of T (turns x n) and x. */
static void turn_of(int dim, const double *T, int n, int i, const double *x, double *out)
{
    if (dim == 2) {
        out[0] = -T[i] * x[1];
        out[1] = T[i] * x[0];
        return;
    }
    for (int d = 0; d < 3; ++d) {
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        out[d] = T[e * n + i] * x[f] - T[f * n + i] * x[e];
    }
}

/* Makes, of a surface on a body, how its point at r moves, and what a turn of it adds to the force on what touches it there: own
 * (dim x n). K has the derivative of P' f by the unknowns where r stays. */
static void motion_of_surface(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, const fu_state *state,
                              const fu_touch_point *point, const double *psi, motion *out, double *own)
{
    const int dim = model->dim, n = on->n;
    const double *f = point->f;
    double x[3], w[3], m[3], T[3 * FU_ATTACHMENT_COORDINATES];
    for (int d = 0; d < dim; ++d) x[d] = point->r[d] - on->p[d];
    fu_surface_past(dim, on, point->r, point->v, w);
    out->n = n;
    memcpy(out->at, on->at, sizeof out->at);
    fu_surface_motion(dim, on, point->r, out->P);
    memcpy(out->moved, out->P, sizeof out->moved);
    memcpy(T, on->T, sizeof T);
    memset(out->by_rate, 0, sizeof out->by_rate);
    memset(out->K, 0, sizeof out->K);
    if (dim == 2) m[0] = x[0] * f[1] - x[1] * f[0];
    else fu_cross(x, f, m);
    fu_geometric_stiffness(model, contact->surface.on, state, f, m, n, out->K);
    fu_turn_attachment(model, contact->surface.on, psi, out->moved, dim, n, 0);
    fu_turn_attachment(model, contact->surface.on, psi, T, dim == 3 ? 3 : 1, n, 0);
    fu_turn_attachment(model, contact->surface.on, psi, out->K, n, n, 0);
    for (int i = 0; i < n; ++i) {
        double of_force[3], of_rate[3], origin[3], moment[3];
        turn_of(dim, T, n, i, f, of_force);
        turn_of(dim, T, n, i, w, of_rate);
        for (int d = 0; d < dim; ++d) own[d * n + i] = of_force[d] - fu_dot(dim, point->by_rate + d * dim, of_rate);
        /* the lever of f is from the origin, which moves: of m alone, T' of its change */
        turn_of(dim, T, n, i, x, of_rate);
        for (int d = 0; d < dim; ++d) origin[d] = -(out->moved[d * n + i] - of_rate[d]);
        if (dim == 2) moment[0] = origin[0] * f[1] - origin[1] * f[0];
        else fu_cross(origin, f, moment);
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < (dim == 3 ? 3 : 1); ++k) out->K[j * n + i] += on->T[k * n + j] * moment[k];
    }
}

void fu_contact_add_derivatives(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, const fu_state *state,
                                int element, int number, const fu_touch_point *point, const double *psi, fu_weights weights,
                                fu_system *system)
{
    const int dim = model->dim, nb = on->n;
    const double scale = weights.stiffness * fu_contact_weight(contact, element, number);
    double change_a[3 * FU_ATTACHMENT_COORDINATES], change_b[3 * FU_ATTACHMENT_COORDINATES], own[3 * FU_ATTACHMENT_COORDINATES];
    motion of_point, b;
    const motion *a = &of_point;
    if (contact->cable >= 0) motion_on_cable(model, contact, element, number, &of_point);
    else motion_of_point(model, contact, state, number, point->f, psi, &of_point);
    b.n = 0;
    if (nb) motion_of_surface(model, contact, on, state, point, psi, &b, own);
    for (int d = 0; d < dim; ++d) {
        for (int i = 0; i < a->n; ++i) {
            double sum = 0.0;
            for (int c = 0; c < dim; ++c)
                sum += point->by_place[d * dim + c] * a->moved[c * a->n + i] +
                       point->by_rate[d * dim + c] * (weights.rate * a->P[c * a->n + i] + a->by_rate[c * a->n + i]);
            change_a[d * a->n + i] = sum;
        }
        for (int i = 0; i < nb; ++i) {
            double sum = own[d * nb + i];
            for (int c = 0; c < dim; ++c)
                sum -= point->by_place[d * dim + c] * b.moved[c * nb + i] + point->by_rate[d * dim + c] * weights.rate * b.P[c * nb + i];
            change_b[d * nb + i] = sum;
        }
    }
    for (int i = 0; i < a->n; ++i) {
        double force_by[FU_ATTACHMENT_COORDINATES];
        for (int j = 0; j < a->n; ++j) {
            double sum = a->K[i * a->n + j];
            for (int d = 0; d < dim; ++d) sum += a->P[d * a->n + i] * change_a[d * a->n + j];
            if (sum != 0.0) fu_add(model, system, a->at[i], a->at[j], -scale * sum);
        }
        for (int j = 0; j < nb; ++j) {
            force_by[j] = 0.0;
            for (int d = 0; d < dim; ++d) force_by[j] += a->P[d * a->n + i] * change_b[d * nb + j];
            if (force_by[j] != 0.0) fu_add(model, system, a->at[i], b.at[j], -scale * force_by[j]);
        }
    }
    for (int i = 0; i < nb; ++i) {
        for (int j = 0; j < a->n; ++j) {
            double sum = 0.0, lever[3], r[3];
            for (int d = 0; d < dim; ++d) {
                sum += b.P[d * nb + i] * change_a[d * a->n + j];
                r[d] = a->moved[d * a->n + j];
            }
            turn_of(dim, on->T, nb, i, r, lever); /* the point itself moves on the surface */
            sum += fu_dot(dim, lever, point->f);
            if (sum != 0.0) fu_add(model, system, b.at[i], a->at[j], scale * sum);
        }
        for (int j = 0; j < nb; ++j) {
            double sum = b.K[i * nb + j];
            for (int d = 0; d < dim; ++d) sum += b.P[d * nb + i] * change_b[d * nb + j];
            fu_add(model, system, b.at[i], b.at[j], scale * sum);
        }
    }
}
