/* Clearances of contacts with surfaces and of crossings: by spheres about the elements of cables and about the points of bodies. */
#include "engine.h"

#include <math.h>
#include <string.h>

/* Makes the middle of a sphere about an element; returns its radius, m. Between the element's nodes its points are off the middle by
 * half of the way between these at most, with the share of places, and by what the other vectors move them. */
static double sphere_about(const fu_cable *cable, const double *q, int element, double middle[3])
{
    const int dim = cable->kernel->dim, vectors = cable->kernel->vectors;
    const double *first = q + cable->first + element * cable->per_node, *last = first + cable->per_node;
    double square = 0.0, reach = 0.0;
    for (int d = 0; d < dim; ++d) {
        middle[d] = 0.5 * (first[d] + last[d]);
        square += (last[d] - first[d]) * (last[d] - first[d]);
    }
    reach = 0.5 * cable->share[0] * sqrt(square);
    for (int k = 1; k < vectors; ++k)
        if (cable->share[k] != 0.0)
            reach += cable->share[k] * sqrt(fmax(fu_dot(dim, first + k * dim, first + k * dim), fu_dot(dim, last + k * dim, last + k * dim)));
    return reach;
}

static double distance(int dim, const double *a, const double *b)
{
    double square = 0.0;
    for (int d = 0; d < dim; ++d) square += (a[d] - b[d]) * (a[d] - b[d]);
    return sqrt(square);
}

/* Returns the place of a body, or null where its points cannot be told by its frame alone. */
static const double *place_of(const fu_model *model, const fu_state *state, int body)
{
    return model->bodies[body].modes ? 0 : state->q + model->bodies[body].configuration;
}

static const fu_clearance none = {.gap = -INFINITY};

fu_clearance fu_contact_clearance(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_contact *contact = (const fu_contact *)coupling;
    const int dim = model->dim, body = contact->surface.on->body;
    const fu_cable *cable = contact->cable < 0 ? 0 : &model->cables[contact->cable];
    fu_clearance found = {.gap = INFINITY};
    fu_attachment_state on;
    if (state->flags[coupling->flags] || (cable ? !cable->share : !(contact->spread[0] < INFINITY))) return none;
    const double *carrier = body < 0 ? 0 : place_of(model, state, body);
    if (body >= 0 && !carrier) return none;
    fu_surface_at(model, &contact->surface, state, &on);
    for (int e = 0; e < fu_contact_elements(model, contact); ++e) {
        double middle[3] = {0.0}, reach = contact->spread[0];
        if (cable) reach = sphere_about(cable, state->q, e, middle);
        else memcpy(middle, place_of(model, state, contact->attachments[0].body), sizeof(double) * (size_t)dim);
        found.gap = fmin(found.gap, fu_surface_clearance(dim, &contact->surface, &on, middle, reach) - contact->radius);
        if (carrier) found.lever = fmax(found.lever, distance(dim, middle, carrier) + reach);
        found.radius = cable ? 0.0 : reach;
    }
    return found;
}

void fu_contact_between(const fu_model *model, const fu_coupling *coupling, int between[2])
{
    const fu_contact *contact = (const fu_contact *)coupling;
    between[0] = contact->cable >= 0 ? contact->cable : model->n_cables + contact->attachments[0].body;
    between[1] = contact->surface.on->body < 0 ? -1 : model->n_cables + contact->surface.on->body;
}

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
        const double reach = sphere_about(cable, q, e, middle);
        for (int k = 0; k < other->n_elements; ++k) {
            const double beyond = reach + sphere_about(other, q, k, there);
            least = fmin(least, distance(dim, middle, there) - beyond);
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
    if (state->flags[coupling->flags] || !cable->share) return none;
    if (crossing->cables[1] >= 0) {
        const fu_cable *other = &model->cables[crossing->cables[1]];
        if (!other->share) return none;
        found.gap = between_cables(cable, other, state->q) - crossing->law[0];
        return found;
    }
    fu_attachment middle = crossing->attachments[0], beyond = middle;
    fu_attachment_state p, a;
    if (middle.cable >= 0 || (body >= 0 && !place_of(model, state, body))) return none;
    for (int d = 0; d < 3; ++d) beyond.u[d] += crossing->axis[d];
    fu_attachment_at(model, &middle, state, 0.0, FU_PLACE, &p);
    fu_attachment_at(model, &beyond, state, 0.0, FU_PLACE, &a);
    for (int d = 0; d < dim; ++d) a.p[d] -= p.p[d];
    for (int e = 0; e < cable->n_elements; ++e) {
        double r[3];
        const double reach = sphere_about(cable, state->q, e, r);
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
