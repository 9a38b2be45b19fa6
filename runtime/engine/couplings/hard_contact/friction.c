/* Friction of hard contacts: how the point of a body that touches goes past the surface, and against what friction is. */
#include "bodies/model.h"
#include "couplings/hard_contact/hard_contact.h"

#include <math.h>
#include <string.h>

#define SLOW 1e-6  /* of the velocity below which a point comes to rest: what turns the direction of sliding */
#define SOFT 1e-10 /* m/s^2 over N: so little do points that stick give way, and share by their normal forces what holds them */
#define SLACK 1e-9 /* of the weight: so much more is held, as a point may bear nothing, and be held by rounding */
#define LEAST 1e-10 /* m/s^2: normal force over mass, below which it counts as that */

/* Makes directions across the normal: one in the plane, two in space. */
static void across(int dim, const double *n, double t[2][3])
{
    memset(t, 0, sizeof(double[2][3]));
    if (dim == 2) {
        t[0][0] = n[1];
        t[0][1] = -n[0];
        return;
    }
    double axis[3] = {0.0}, size;
    int least = 0;
    for (int d = 1; d < 3; ++d)
        if (fabs(n[d]) < 0.9 * fabs(n[least])) least = d;
    axis[least] = 1.0;
    for (int d = 0; d < 3; ++d) t[0][d] = axis[d] - n[least] * n[d];
    size = sqrt(fu_dot(3, t[0], t[0]));
    for (int d = 0; d < 3; ++d) t[0][d] /= size;
    fu_cross(n, t[0], t[1]);
}

/* Makes the direction of sliding: that of the velocity while it goes on forwards, that of the last step where it has turned. */
static void find_direction(int dim, const fu_hard_contact *contact, const fu_state *state, const double *n, const double *past, double *out)
{
    const double *last = fu_hard_numbers_of(&contact->contact.base, state)->direction, slow = SLOW * contact->rest_velocity;
    const int forwards = fu_dot(dim, last, past) > 0.0;
    double along = 0.0, square = 0.0;
    for (int d = 0; d < dim; ++d) out[d] = forwards ? past[d] + slow * last[d] : last[d];
    along = fu_dot(dim, out, n);
    for (int d = 0; d < dim; ++d) {
        out[d] -= along * n[d];
        square += out[d] * out[d];
    }
    for (int d = 0; d < dim; ++d) out[d] = square > 0.0 ? out[d] / sqrt(square) : 0.0;
}

void fu_hard_along_at(const fu_model *model, const fu_hard_contact *contact, const fu_state *state, const fu_hard_row *row,
                      fu_hard_along *out)
{
    const int dim = model->dim;
    fu_attachment_state point, on;
    double r[3], x[3] = {0.0}, x_rate[3] = {0.0}, lever_rate[3] = {0.0}, v[3], centre[3] = {0.0};
    double P[3 * FU_ATTACHMENT_COORDINATES], Q[3 * FU_ATTACHMENT_COORDINATES], omega[3], turning[3], own[3], bias[3];
    fu_attachment_at(model, contact->contact.attachments, state, 0.0, FU_POINT | FU_AXES, &point);
    fu_surface_at(model, &contact->contact.surface, state, &on);
    fu_surface_past(dim, &on, point.p, point.v, centre);
    memset(r, 0, sizeof r);
    for (int d = 0; d < dim; ++d) {
        x[d] = -contact->contact.radius * row->normal[d];
        x_rate[d] = -contact->contact.radius * fu_dot(dim, row->curvature + d * dim, centre);
        r[d] = point.p[d] + x[d];
        lever_rate[d] = point.v[d] + x_rate[d] - on.v[d];
    }
    fu_surface_motion(dim, &point, r, P);
    fu_surface_velocity(dim, &point, r, v);
    fu_surface_motion(dim, &on, r, Q);
    fu_turn_in_space(dim, point.omega, omega);
    fu_cross(omega, x_rate, turning);
    fu_turn_in_space(dim, on.omega, omega);
    fu_cross(omega, lever_rate, own);
    memset(out->past, 0, sizeof out->past);
    fu_surface_past(dim, &on, r, v, out->past);
    for (int d = 0; d < dim; ++d) bias[d] = point.bias[d] + turning[d] - (on.bias[d] + own[d]);
    const double along = fu_dot(dim, out->past, row->normal);
    for (int d = 0; d < dim; ++d) out->past[d] -= along * row->normal[d];
    across(dim, row->normal, out->t);
    find_direction(dim, contact, state, row->normal, out->past, out->direction);
    for (int k = 0; k < dim; ++k) { /* the last is the direction of sliding */
        const double *t = k < dim - 1 ? out->t[k] : out->direction;
        double *H = k < dim - 1 ? out->H[k] : out->slip;
        if (k < dim - 1) out->bias[k] = fu_dot(dim, t, bias);
        for (int i = 0; i < row->n; ++i) {
            H[i] = 0.0;
            for (int d = 0; d < dim; ++d)
                H[i] += t[d] * (i < point.n ? P[d * point.n + i] : -Q[d * on.n + i - point.n]);
        }
    }
}

/* Returns what friction can take of a point that sticks, N. */
double fu_hard_grip(const fu_hard_contact *contact, double multiplier)
{
    return contact->friction * fmax(SLACK * contact->weight - multiplier, SLACK * contact->weight);
}

double fu_hard_softness(const fu_hard_contact *contact, double multiplier)
{
    return SOFT / fmax(-multiplier, LEAST * contact->contact.base.scale[0]);
}
