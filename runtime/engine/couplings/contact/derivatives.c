/* Derivatives of the force of contact at a point, and of its reaction on the body that the surface is on, by the
 * coordinates of both.
 *
 * How the velocity of a surface's point changes at fixed rates of its body is left out, as Newton's method does without
 * it.
 */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/contact/contact.h"
#include "couplings/force/point_force.h"

#include <string.h>

/* How a point moves with its coordinates, and turns, if it rolls: P (dim x n) that of where it touches, T; `moved` and
 * `turned` have the point and the turn by the unknowns; `by_rate` its velocity by these at fixed rates; K, if it is of
 * a body, the derivative of P' f by them at fixed arms of the force. */
typedef struct {
    int n, at[FU_ATTACHMENT_COORDINATES];
    double P[3 * FU_ATTACHMENT_COORDINATES], T[3 * FU_ATTACHMENT_COORDINATES], moved[3 * FU_ATTACHMENT_COORDINATES],
        turned[3 * FU_ATTACHMENT_COORDINATES], by_rate[3 * FU_ATTACHMENT_COORDINATES];
    double K[FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES];
} motion;

static void moment_of(int dim, const double *x, const double *f, double m[3])
{
    m[0] = x[0] * f[1] - x[1] * f[0];
    if (dim == 3) fu_cross(x, f, m);
}

/* Makes how a point of a body moves, and where it touches. */
static void motion_of_point(const fu_model *model, const fu_contact *contact, const fu_state *state, int number,
                            const fu_contact_point *point, const double *psi, motion *out)
{
    const fu_attachment *to = &contact->attachments[number];
    const int dim = model->dim, rolls = fu_contact_rolls(contact);
    double r[3], m[3], K[FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES] = {0.0};
    fu_attachment_state end;
    fu_attachment_at(model, to, state, 0.0, rolls ? FU_POINT | FU_AXES : FU_POINT, &end);
    out->n = end.n;
    memcpy(out->at, end.at, sizeof out->at);
    memcpy(out->P, end.P, sizeof out->P);
    memcpy(out->moved, end.P, sizeof out->moved);
    memset(out->by_rate, 0, sizeof out->by_rate);
    fu_turn_point(model, to, state, point->f, psi, &end, out->moved, out->by_rate, out->K);
    if (!rolls) return;
    for (int d = 0; d < dim; ++d) r[d] = end.p[d] + point->arm[d];
    fu_surface_motion(dim, &end, r, out->P);
    memcpy(out->T, end.T, sizeof out->T);
    memcpy(out->turned, end.T, sizeof out->turned);
    moment_of(dim, point->arm, point->f, m);
    fu_geometric_stiffness(model, to, state, 0, m, end.n, K);
    fu_turn_attachment(model, to, psi, out->turned, dim == 3 ? 3 : 1, end.n, 0);
    fu_turn_attachment(model, to, psi, K, end.n, end.n, 0);
    for (int i = 0; i < end.n * end.n; ++i) out->K[i] += K[i];
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

/* Makes, of a surface on a body, how its point at r moves, and where the force acts, and what a turn of it adds to the
 * force on what touches it there: own (dim x n). K has the derivative of P' f by the unknowns where r and the arm stay.
 */
static void motion_of_surface(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                              const fu_state *state, const fu_contact_point *point, const double *psi, motion *out,
                              double *own)
{
    const int dim = model->dim, n = on->n;
    const double *f = point->f, *T = out->turned;
    double x[3], w[3], m[3], r[3];
    for (int d = 0; d < dim; ++d) {
        x[d] = point->r[d] - on->p[d];
        r[d] = point->r[d] + point->arm[d];
    }
    fu_surface_past(dim, on, point->r, point->v, w);
    out->n = n;
    memcpy(out->at, on->at, sizeof out->at);
    fu_surface_motion(dim, on, r, out->P);
    fu_surface_motion(dim, on, point->r, out->moved);
    memcpy(out->T, on->T, sizeof out->T);
    memcpy(out->turned, on->T, sizeof out->turned);
    memset(out->by_rate, 0, sizeof out->by_rate);
    memset(out->K, 0, sizeof out->K);
    for (int d = 0; d < dim; ++d) r[d] -= on->p[d];
    moment_of(dim, r, f, m);
    fu_geometric_stiffness(model, contact->surface.on, state, f, m, n, out->K);
    fu_turn_attachment(model, contact->surface.on, psi, out->moved, dim, n, 0);
    fu_turn_attachment(model, contact->surface.on, psi, out->turned, dim == 3 ? 3 : 1, n, 0);
    fu_turn_attachment(model, contact->surface.on, psi, out->K, n, n, 0);
    for (int i = 0; i < n; ++i) {
        double of_force[3], of_rate[3], origin[3] = {0.0}, moment[3];
        turn_of(dim, T, n, i, f, of_force);
        turn_of(dim, T, n, i, w, of_rate);
        for (int d = 0; d < dim; ++d) own[d * n + i] = of_force[d] - fu_dot(dim, point->by_rate + d * dim, of_rate);
        /* the lever of f is from the origin, which moves: of m alone, T' of its change */
        turn_of(dim, T, n, i, x, of_rate);
        for (int d = 0; d < dim; ++d) origin[d] = -(out->moved[d * n + i] - of_rate[d]);
        moment_of(dim, origin, f, moment);
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < (dim == 3 ? 3 : 1); ++k) out->K[j * n + i] += on->T[k * n + j] * moment[k];
    }
}

/* The changes of what a motion changes by each of its coordinates i, column i of all (dim x n): the force, and where it
 * acts less where the point is. */
typedef struct {
    double force[3 * FU_ATTACHMENT_COORDINATES], arm[3 * FU_ATTACHMENT_COORDINATES];
} changes;

/* Adds what depends on where a sphere touches: the arm follows the normal, and the stretch the turn past the surface;
 * sign: 1 of the sphere, -1 of the surface, which takes the normal and the arm along as it turns. */
static void add_rolling(int dim, const fu_contact *contact, const fu_attachment_state *on,
                        const fu_contact_point *point, const motion *of, double sign, changes *out)
{
    const int n = of->n;
    const double share =
        fu_dot(dim, point->mark->normal, point->mark->normal) > 0.0 ? 0.5 : 1.0; /* of this normal in the mean one */
    double about[3] = {0.0, 0.0, point->turn[2]};
    if (dim == 3) fu_surface_out(dim, on, point->turn, about);
    for (int i = 0; i < n; ++i) {
        double by_normal[3] = {0.0}, by_turn[3] = {0.0}, angle[3] = {0.0, 0.0, of->turned[i]}, half[3], rolled[3],
               stretch[3];
        for (int d = 0; d < 3 && dim == 3; ++d) angle[d] = of->turned[d * n + i];
        for (int d = 0; d < dim; ++d)
            for (int c = 0; c < dim; ++c)
                by_normal[d] -= sign * contact->radius * point->distance.H[d * dim + c] * of->moved[c * n + i];
        fu_cross(angle, point->arm, by_turn);
        fu_cross(about, angle,
                 half); /* of a turn that has been, the vector of it changes by so much less (to first order) */
        for (int d = 0; d < 3; ++d) angle[d] -= 0.5 * half[d];
        fu_cross(angle, point->arm, rolled);
        fu_cross(about, by_normal, stretch);
        for (int d = 0; d < dim; ++d) {
            out->arm[d * n + i] = by_normal[d] + (sign < 0.0 ? by_turn[d] : 0.0);
            stretch[d] = sign * rolled[d] + share * stretch[d];
        }
        for (int d = 0; d < dim; ++d) out->force[d * n + i] += fu_dot(dim, point->by_stretch + d * dim, stretch);
    }
}

/* Makes the changes of the force by the coordinates of what touches, or of the surface, which adds its own. */
static void changes_by(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                       const fu_contact_point *point, fu_weights weights, const motion *of, double sign,
                       const double *own, changes *out)
{
    const int dim = model->dim, n = of->n;
    memset(out->arm, 0, sizeof(double) * (size_t)(dim * n));
    for (int d = 0; d < dim; ++d)
        for (int i = 0; i < n; ++i) {
            double sum = own ? own[d * n + i] : 0.0;
            for (int c = 0; c < dim; ++c)
                sum +=
                    sign * (point->by_place[d * dim + c] * of->moved[c * n + i] +
                            point->by_rate[d * dim + c] * (weights.rate * of->P[c * n + i] + of->by_rate[c * n + i]));
            out->force[d * n + i] = sum;
        }
    if (fu_contact_rolls(contact)) add_rolling(dim, contact, on, point, of, sign, out);
}

/* Adds to a system how the force along the motion `of` changes by the coordinates `by`; lever: what the place that it
 * acts at changes by, null where it has no moment; K: what changes at fixed forces and arms, or null. */
static void add_block(const fu_model *model, const motion *of, const motion *by, const double *f, const double *force,
                      const double *lever, const double *K, double scale, fu_system *system)
{
    const int dim = model->dim, n = by->n;
    for (int i = 0; i < of->n; ++i)
        for (int j = 0; j < n; ++j) {
            double sum = K ? K[i * n + j] : 0.0, r[3], moment[3];
            for (int d = 0; d < dim; ++d) sum += of->P[d * of->n + i] * force[d * n + j];
            for (int d = 0; d < dim && lever; ++d) r[d] = lever[d * n + j];
            if (lever) {
                turn_of(dim, of->T, of->n, i, r, moment);
                sum += fu_dot(dim, moment, f);
            }
            if (sum != 0.0) fu_add(model, system, of->at[i], by->at[j], scale * sum);
        }
}

void fu_contact_add_derivatives(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                                const fu_state *state, int element, int number, const fu_contact_point *point,
                                const double *psi, fu_weights weights, fu_system *system)
{
    const int dim = model->dim, rolls = fu_contact_rolls(contact);
    const double scale = weights.stiffness * fu_contact_weight(contact, element, number), *f = point->f;
    double own[3 * FU_ATTACHMENT_COORDINATES];
    motion a, b;
    changes by_a, by_b;
    if (contact->cable >= 0) motion_on_cable(model, contact, element, number, &a);
    else motion_of_point(model, contact, state, number, point, psi, &a);
    changes_by(model, contact, on, point, weights, &a, 1.0, 0, &by_a);
    add_block(model, &a, &a, f, by_a.force, rolls ? by_a.arm : 0, a.K, -scale, system);
    if (!on->n) return;
    motion_of_surface(model, contact, on, state, point, psi, &b, own);
    changes_by(model, contact, on, point, weights, &b, -1.0, own, &by_b);
    add_block(model, &a, &b, f, by_b.force, rolls ? by_b.arm : 0, 0, -scale, system);
    for (int i = 0; i < dim * a.n; ++i) by_a.arm[i] += a.moved[i]; /* the point itself moves on the surface */
    add_block(model, &b, &a, f, by_a.force, by_a.arm, 0, scale, system);
    add_block(model, &b, &b, f, by_b.force, by_b.arm, b.K, scale, system);
}
