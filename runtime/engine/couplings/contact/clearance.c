/* Clearances of contacts with surfaces, by bounding spheres of the elements of cables and the points of bodies. */
#include "couplings/common/proximity.h"
#include "couplings/contact/contact.h"

#include <math.h>
#include <string.h>

fu_clearance fu_contact_clearance(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_contact *contact = (const fu_contact *)coupling;
    const int dim = model->dim, body = contact->surface.on->body;
    const fu_cable *cable = contact->cable < 0 ? 0 : &model->cables[contact->cable];
    fu_clearance found = {.gap = INFINITY};
    fu_attachment_state on;
    if (state->flags[coupling->flags] || (cable ? !cable->share : !(contact->spread[0] < INFINITY)))
        return fu_no_clearance;
    const double *carrier = body < 0 ? 0 : fu_place_of_body(model, state, body);
    if (body >= 0 && !carrier) return fu_no_clearance;
    fu_surface_at(model, &contact->surface, state, &on);
    for (int e = 0; e < fu_contact_elements(contact); ++e) {
        double middle[3] = {0.0}, reach = contact->spread[0];
        if (cable) reach = fu_sphere_about(cable, state->q, contact->first + e, middle);
        else memcpy(middle, fu_place_of_body(model, state, contact->attachments[0].body), sizeof(double) * (size_t)dim);
        found.gap = fmin(found.gap, fu_surface_clearance(dim, &contact->surface, &on, middle, reach) - contact->radius);
        if (carrier) found.lever = fmax(found.lever, fu_distance_between(dim, middle, carrier) + reach);
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
