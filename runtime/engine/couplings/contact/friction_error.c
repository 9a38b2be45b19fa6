/* Friction error estimate of contact: within a step a point comes into contact or separates, begins to slide or sticks.
 * The force is continuous there, its rate is not, and the error of an integrator's quadrature is proportional to the
 * jump of the rate. Error estimates of integrators assume smooth forces. */
#include "bodies/model.h"
#include "couplings/contact/contact.h"

#include <math.h>
#include <string.h>

#define INTERVALS 16             /* of a step, for the sum of a force by Simpson's rule */
#define ROUNDING_OF_STRETCH 1e-9 /* of a stretch: its tolerance below the bound of a sliding one */

/* A point over a step with its friction; without friction the path has no bound. */
typedef struct {
    const fu_contact *contact;
    fu_contact_point end;
    fu_friction_mark mark;
    fu_friction_path path;
    double along[3];
} step_point;

/* Computes the normal force and friction at a part of the step, N (a length). */
static void forces_at(const step_point *of, double x, double out[2])
{
    const fu_contact *contact = of->contact;
    const double depth = fu_value_within(&of->path.depth, of->path.h, x);
    out[0] =
        depth > 0.0 ? fu_normal_force_at(contact, depth, fu_rate_within(&of->path.depth, of->path.h, x), depth).p : 0.0;
    out[1] = contact->law.friction > 0.0 && x > 0.0 ? -contact->law.tangential * fu_friction_within(&of->path, x) : 0.0;
    if (contact->law.friction > 0.0 && x == 0.0)
        out[1] = -contact->law.tangential * of->path.stretch.value[0] * (of->path.from == 0.0);
}

/* Computes the error of the mean forces of a quadrature. */
static void error_of_rule(const step_point *of, int n, const double *b, const double *c, double out[2])
{
    double at[2];
    out[0] = out[1] = 0.0;
    for (int k = 0; k < n; ++k) {
        forces_at(of, c[k], at);
        for (int i = 0; i < 2; ++i) out[i] += b[k] * at[i];
    }
    for (int k = 0; k <= INTERVALS; ++k) {
        const double weight = (k == 0 || k == INTERVALS ? 1.0 : k % 2 ? 4.0 : 2.0) / (3.0 * INTERVALS);
        forces_at(of, (double)k / INTERVALS, at);
        for (int i = 0; i < 2; ++i) out[i] -= weight * at[i];
    }
}

/* Returns whether friction slides forwards, 1, backwards, -1, or not, at a part of the step. */
static int slides_at(const step_point *of, double x)
{
    double at[2];
    forces_at(of, x, at);
    return fabs(at[1]) >= (1.0 - ROUNDING_OF_STRETCH) * of->contact->law.friction * at[0]
               ? (at[1] < 0.0) - (at[1] > 0.0)
               : 0;
}

/* Returns whether the rate of the force is discontinuous: the point is in contact at one end alone, or neither sticks
 * nor slides one path during the whole step. */
static int is_nonsmooth(const step_point *of)
{
    double at[2][2];
    for (int e = 0; e < 2; ++e) forces_at(of, e, at[e]);
    if ((at[0][0] > 0.0) != (at[1][0] > 0.0)) return 1;
    if (of->contact->law.friction == 0.0 || at[0][0] == 0.0) return 0;
    const int begin = slides_at(of, 0.0), end = slides_at(of, 1.0);
    return begin != end || (end ? slides_at(of, 0.5) != end : of->end.friction_end.slid);
}

/* Computes the point over the step; returns whether it is in contact at one of the ends. */
static int point_over_step(const fu_model *model, const fu_contact *contact, const fu_attachment_state on[2],
                           const fu_state *from, const fu_state *to, int element, int number, step_point *out)
{
    fu_contact_point begin;
    out->contact = contact;
    fu_contact_place(model, contact, &on[1], to, element, number, &out->end);
    const int in_contact = fu_contact_is_active(model, contact, &on[1], &out->end);
    if (contact->law.friction > 0.0) out->mark = *out->end.mark;
    else {
        fu_contact_place(model, contact, &on[0], from, element, number, &begin);
        fu_contact_slip(model, contact, &on[0], &begin);
        out->mark.gap = -begin.depth;
        out->mark.gap_rate = -begin.sinking;
    }
    if (!in_contact && !(out->mark.gap < 0.0)) return 0;
    out->path.h = to->t - from->t;
    out->path.depth = (fu_step_ends){{-out->mark.gap, out->end.depth}, {-out->mark.gap_rate, out->end.sinking}};
    memset(out->along, 0, sizeof out->along);
    if (contact->law.friction > 0.0) fu_contact_path(model, contact, &on[1], &out->end, &out->path, out->along);
    return 1;
}

int fu_contact_quadrature_error(const fu_model *model, const fu_coupling *coupling, const fu_state *from,
                                const fu_state *to, int n, const double *b, const double *c, double *f)
{
    const fu_contact *contact = (const fu_contact *)coupling;
    const int dim = model->dim;
    int found = 0;
    fu_attachment_state on[2];
    step_point of;
    if (fu_contact_on_span(contact) && contact->law.friction == 0.0) return 0;
    fu_surface_at(model, &contact->surface, from, &on[0]);
    fu_surface_at(model, &contact->surface, to, &on[1]);
    for (int e = 0; e < fu_contact_elements(contact); ++e) {
        if (!fu_contact_may_be_active(model, contact, &on[0], from, e, 0.0) &&
            !fu_contact_may_be_active(model, contact, &on[1], to, e, 0.0))
            continue;
        for (int k = 0; k < contact->n_points; ++k) {
            double off[2], along[3];
            if (!point_over_step(model, contact, on, from, to, e, k, &of) || !is_nonsmooth(&of)) continue;
            error_of_rule(&of, n, b, c, off);
            fu_surface_out(dim, &on[1], of.along, along);
            for (int d = 0; d < dim; ++d) of.end.f[d] = off[0] * of.end.distance.n[d] + off[1] * along[d];
            fu_contact_add_force(model, contact, to, &on[1], e, k, &of.end, f);
            found = 1;
        }
    }
    return found;
}
