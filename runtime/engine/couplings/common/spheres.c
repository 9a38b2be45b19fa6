/* Bounding spheres of the elements of cables and the points of bodies, for clearances. */
#include "couplings/common/proximity.h"

#include <math.h>

const fu_clearance fu_no_clearance = {.gap = -INFINITY};

/* Computes the centre of a sphere about an element; returns its radius, m. Between the element's nodes its points
 * are within half of their distance from the centre, by the share of positions, plus the displacement by the other
 * vectors. */
double fu_sphere_about(const fu_cable *cable, const double *q, int element, double middle[3])
{
    const int dim = cable->kernel->dim, vectors = cable->kernel->vectors;
    const double *first = q + fu_element_entry(cable, element), *last = first + cable->per_node;
    double square = 0.0, reach = 0.0;
    for (int d = 0; d < dim; ++d) {
        middle[d] = 0.5 * (first[d] + last[d]);
        square += (last[d] - first[d]) * (last[d] - first[d]);
    }
    reach = 0.5 * cable->share[0] * sqrt(square);
    for (int k = 1; k < vectors; ++k)
        if (cable->share[k] != 0.0)
            reach += cable->share[k] * sqrt(fmax(fu_dot(dim, first + k * dim, first + k * dim),
                                                 fu_dot(dim, last + k * dim, last + k * dim)));
    return reach;
}

double fu_distance_between(int dim, const double *a, const double *b)
{
    double square = 0.0;
    for (int d = 0; d < dim; ++d) square += (a[d] - b[d]) * (a[d] - b[d]);
    return sqrt(square);
}

/* Returns the position of a body, or null if its frame alone does not bound its points. */
const double *fu_place_of_body(const fu_model *model, const fu_state *state, int body)
{
    return model->bodies[body].modes ? 0 : state->q + model->bodies[body].configuration;
}
