/* Clearances of crossings, by bounding spheres of the elements of cables. */
#include "couplings/common/proximity.h"
#include "couplings/crossing/crossing.h"

#include <math.h>

/* Returns the distance of a point from the bar of a crossing, m: from its middle p, along its axis a. */
static double from_bar(int dim, const fu_crossing *crossing, const double *p, const double *a, const double *r)
{
    double from[3] = {0.0}, along = 0.0;
    for (int d = 0; d < dim; ++d) from[d] = r[d] - p[d];
    if (dim == 3) along = fmin(fmax(fu_dot(3, from, a), crossing->low[1]), crossing->high[1]);
    for (int d = 0; d < dim; ++d) from[d] -= along * a[d];
    return sqrt(fu_dot(dim, from, from));
}

/* Returns the least distance between spheres about the elements of two cables, m. */
static double between_cables(const fu_cable *cable, const fu_cable *other, const double *q)
{
    const int dim = cable->kernel->dim;
    double least = INFINITY;
    for (int e = 0; e < cable->n_elements; ++e) {
        double middle[3], there[3];
        const double reach = fu_sphere_about(cable, q, e, middle);
        for (int k = 0; k < other->n_elements; ++k) {
            const double beyond = reach + fu_sphere_about(other, q, k, there);
            least = fmin(least, fu_distance_between(dim, middle, there) - beyond);
        }
    }
    return least;
}

fu_clearance fu_crossing_clearance(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_crossing *crossing = (const fu_crossing *)coupling;
    const int dim = model->dim, body = crossing->cables[1] < 0 ? crossing->attachments[0].body : -1;
    const fu_cable *cable = &model->cables[crossing->cables[0]];
    fu_clearance found = {.gap = INFINITY};
    if (state->flags[coupling->flags] || !cable->share) return fu_no_clearance;
    if (crossing->cables[1] >= 0) {
        const fu_cable *other = &model->cables[crossing->cables[1]];
        if (!other->share) return fu_no_clearance;
        found.gap = between_cables(cable, other, state->q) - crossing->law[0];
        return found;
    }
    fu_attachment middle = crossing->attachments[0], beyond = middle;
    fu_attachment_state p, a;
    if (middle.cable >= 0 || (body >= 0 && !fu_place_of_body(model, state, body))) return fu_no_clearance;
    for (int d = 0; d < 3; ++d) beyond.u[d] += crossing->axis[d];
    fu_attachment_at(model, &middle, state, 0.0, FU_PLACE, &p);
    fu_attachment_at(model, &beyond, state, 0.0, FU_PLACE, &a);
    for (int d = 0; d < dim; ++d) a.p[d] -= p.p[d];
    for (int e = 0; e < cable->n_elements; ++e) {
        double r[3];
        const double reach = fu_sphere_about(cable, state->q, e, r);
        found.gap = fmin(found.gap, from_bar(dim, crossing, p.p, a.p, r) - reach - crossing->law[0]);
    }
    found.lever = sqrt(fu_dot(3, middle.u, middle.u)) + (dim == 3 ? crossing->high[1] : 0.0);
    return found;
}

void fu_crossing_between(const fu_model *model, const fu_coupling *coupling, int between[2])
{
    const fu_crossing *crossing = (const fu_crossing *)coupling;
    const int body = crossing->attachments[0].body;
    between[0] = crossing->cables[0];
    between[1] = crossing->cables[1] >= 0 ? crossing->cables[1] : body < 0 ? -1 : model->n_cables + body;
}
