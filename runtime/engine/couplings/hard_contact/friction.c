/* Friction of hard contacts: the motion of a body's point along the surface, and the direction of friction. */
#include "bodies/model.h"
#include "couplings/common/attachments.h"
#include "couplings/hard_contact/hard_contact.h"

#include <math.h>
#include <string.h>

/* of the velocity below which a point comes to rest: least speed that rotates the direction of sliding */
#define SLIDING_SPEED 1e-6
/* m/s^2 per N: compliance of sticking points, which share the tangential force by their normal forces */
#define STICKING_COMPLIANCE 1e-10
/* of the weight: added to the friction limit, since a point may bear nothing, and stick by rounding */
#define WEIGHT_TOLERANCE 1e-9
#define MIN_ACCELERATION 1e-10 /* m/s^2: least normal force over mass */

/* Computes directions normal to n: one in the plane, two in space. */
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

/* Computes the direction of sliding: that of the velocity for forward sliding, that of the last step after a
 * reversal. */
static void find_direction(int dim, const fu_hard_contact *contact, const fu_state *state, const double *n,
                           const double *past, double *out)
{
    const double *last = fu_hard_numbers_of(&contact->contact.base, state)->direction,
                 slow = SLIDING_SPEED * contact->rest_velocity;
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

void fu_hard_along_at(const fu_model *model, const fu_hard_contact *contact, const fu_state *state,
                      const fu_hard_row *row, fu_hard_along *out)
{
    const int dim = model->dim;
    fu_attachment_state point, on;
    double arm[3], lever[3], moment[3], bias[3];
    fu_attachment_at(model, contact->contact.attachments, state, 0.0, FU_POINT | FU_AXES, &point);
    fu_surface_at(model, &contact->contact.surface, state, &on);
    for (int d = 0; d < dim; ++d) {
        arm[d] = -contact->contact.radius * row->normal[d];
        lever[d] = point.p[d] + arm[d] - on.p[d];
    }
    memset(out->past, 0, sizeof out->past);
    contact->contact.surface.kernel->slip(row->normal, row->curvature, point.p, point.v, point.bias, on.p, on.v,
                                          on.bias, on.omega, on.alpha, contact->contact.radius, point.omega,
                                          point.alpha, out->past, bias);
    const double along = fu_dot(dim, out->past, row->normal);
    for (int d = 0; d < dim; ++d) out->past[d] -= along * row->normal[d];
    across(dim, row->normal, out->t);
    find_direction(dim, contact, state, row->normal, out->past, out->direction);
    for (int k = 0; k < dim; ++k) { /* the last is the direction of sliding */
        const double *t = k < dim - 1 ? out->t[k] : out->direction;
        double *H = k < dim - 1 ? out->H[k] : out->slip;
        if (k < dim - 1) out->bias[k] = fu_dot(dim, t, bias);
        fu_moment_of(dim, arm, t, moment);
        fu_wrench_force(dim, &point, t, moment, 1.0, H);
        fu_moment_of(dim, lever, t, moment);
        fu_wrench_force(dim, &on, t, moment, -1.0, H + point.n);
    }
}

/* Returns the friction limit of a sticking point, N. */
double fu_hard_friction_limit(const fu_hard_contact *contact, double multiplier)
{
    return contact->friction *
           fmax(WEIGHT_TOLERANCE * contact->weight - multiplier, WEIGHT_TOLERANCE * contact->weight);
}

double fu_hard_softness(const fu_hard_contact *contact, double multiplier)
{
    return STICKING_COMPLIANCE / fmax(-multiplier, MIN_ACCELERATION * contact->contact.base.scale[0]);
}
