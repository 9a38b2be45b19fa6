/* Contact of a cable with a plane that does not move, without friction: the heights of its points are sums over those
 * of its nodal vectors, and no other part of their motion matters. */
#include "bodies/model.h"
#include "couplings/contact/contact.h"

#include <math.h>
#include <string.h>

void fu_contact_compute_heights(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                                const fu_state *state, int element, fu_contact_heights *out)
{
    const int dim = model->dim, n = model->cables[contact->cable].coordinates / dim,
              first = fu_contact_first(model, contact, element);
    double height[FU_MAX_COORDINATES], rate[FU_MAX_COORDINATES];
    fu_surface_out(dim, on, contact->surface.direction, out->normal);
    const double origin = fu_dot(dim, out->normal, on->p);
    for (int i = 0; i < n; ++i) {
        height[i] = fu_dot(dim, out->normal, state->q + first + i * dim);
        rate[i] = fu_dot(dim, out->normal, state->v + first + i * dim);
    }
    out->deepest = -INFINITY;
    for (int k = 0; k < contact->n_points; ++k) {
        const double *N = fu_contact_shapes(contact, n, element, k);
        out->depth[k] = contact->radius - (fu_dot(n, N, height) - origin);
        out->sinking[k] = -fu_dot(n, N, rate);
        out->deepest = fmax(out->deepest, out->depth[k]);
    }
}

int fu_contact_is_pressed(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, int number,
                          const fu_contact_heights *heights, fu_contact_point *point)
{
    point->mark = 0;
    point->depth = heights->depth[number];
    point->sinking = heights->sinking[number];
    if (!(point->depth > 0.0)) return 0;
    point->distance.g = contact->radius - point->depth;
    memcpy(point->distance.n, heights->normal, sizeof heights->normal);
    memset(point->distance.H, 0, sizeof point->distance.H);
    for (int d = 0; d < model->dim; ++d) point->past[d] = -point->sinking * heights->normal[d];
    fu_contact_press(model, contact, on, point);
    return 1;
}
