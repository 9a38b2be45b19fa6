/* Spheres about the elements of cables and the points of bodies, by which clearances are told. */
#include "couplings/common/spheres.h"

#include <math.h>

const fu_clearance fu_no_clearance = {.gap = -INFINITY};

/* Computes the middle of a sphere about an element; returns its radius, m. Between the element's nodes its points are
 * off the middle by half of the way between these at most, with the share of places, and by what the other vectors move
 * them. */
double fu_sphere_about(const fu_cable *cable, const double *q, int element, double middle[3])
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

/* Returns the place of a body, or null where its points cannot be told by its frame alone. */
const double *fu_place_of_body(const fu_model *model, const fu_state *state, int body)
{
    return model->bodies[body].modes ? 0 : state->q + model->bodies[body].configuration;
}
