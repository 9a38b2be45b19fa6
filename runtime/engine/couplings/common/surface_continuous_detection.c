/* Continuous collision detection of a point, with a sphere about it, and a surface, in the axes of its shape.
 *
 * A height field has only the vertical distance, G; over the root of 1 + slope^2 it is the distance at the surface
 * alone. Over a path w the slope is at most the one here plus w times the largest second derivative, and nowhere more
 * than the largest slope; with that slope, s, the point stays off the surface while G - w (1 + s^2)^(1/2) > radius (1
 * + s^2)^(1/2).
 *
 * The bound by slope and second derivative is needed for terrains alone: other shapes have a distance of slope 1.
 * Without it the largest slope would hold everywhere, and points over even ground would advance in shorter steps.
 */
#include "base/cubic.h"
#include "couplings/common/continuous_detection.h"

#include <math.h>
#include <string.h>

#define MIN_ADVANCE 1e-3 /* of a step */
#define HALVINGS 12      /* of a path */

/* A point on its path: `longest` bounds its length, m. */
typedef struct {
    int dim;
    const fu_surface *surface;
    const fu_surface_end *ends;
    double radius, h, longest;
    fu_attachment_state axes; /* the axes of the shape */
} point_path;

/* Returns the distance of a point from a terrain's table, m, 0 above it, and the nearest point of the table, beyond
 * which heights are constant. */
static double beyond_table(int dim, const fu_surface *surface, const double *y, double *inside)
{
    double beyond = 0.0;
    memcpy(inside, y, 3 * sizeof *y);
    inside[0] = fmin(fmax(y[0], surface->first[0]), surface->first[surface->n_first - 1]);
    if (dim == 3) inside[2] = fmin(fmax(y[2], surface->second[0]), surface->second[surface->n_second - 1]);
    for (int d = 0; d < dim; d += 2)
        if (inside[d] != y[d]) beyond = beyond > 0.0 ? fmin(beyond, fabs(inside[d] - y[d])) : fabs(inside[d] - y[d]);
    return beyond;
}

static double slope_of(const double *n)
{
    return sqrt(fmax(1.0 / (n[1] * n[1]) - 1.0, 0.0));
}

/* Returns the path length free of a terrain, m, at most `most`. */
static double free_over_terrain(const point_path *of, const fu_surface_end *at, double most)
{
    const fu_surface *surface = of->surface;
    const double height = (at->gap + of->radius) / at->n[1], here = slope_of(at->n);
    double inside[3], over = here, found = 0.0, path = fmin(fabs(at->gap), most);
    fu_distance edge;
    const double beyond = beyond_table(of->dim, surface, at->y, inside);
    if (beyond > 0.0) {
        fu_surface_distance(of->dim, surface, &of->axes, inside, &edge);
        over = slope_of(edge.n);
    }
    for (int i = 0; i < HALVINGS && found < path; ++i, path *= 0.5) {
        const double slope = fmin((path <= beyond ? here : over) + surface->bend * path, surface->steepest);
        const double root = sqrt(1.0 + slope * slope);
        const double off = at->gap < 0.0 ? (of->radius - height) / root : height / root - of->radius;
        found = fmax(found, fmin(off, path));
    }
    return found;
}

/* Returns the path length free of the surface from either side, m. */
static double free_path(const point_path *of, const fu_surface_end *at, double most)
{
    return of->surface->shape == FU_TERRAIN ? free_over_terrain(of, at, most) : fabs(at->gap);
}

/* Follows the point to the part x of the step. */
static fu_approach approach(const void *what, const fu_approach *near, double x)
{
    const point_path *of = what;
    const fu_surface_end *from = &of->ends[0], *to = &of->ends[1];
    fu_surface_end here;
    fu_distance at;
    (void)near;
    memset(&here, 0, sizeof here);
    fu_vector_within(of->dim, from->y, from->rate, to->y, to->rate, of->h, x, here.y, here.rate);
    fu_surface_distance(of->dim, of->surface, &of->axes, here.y, &at);
    memcpy(here.n, at.n, sizeof at.n);
    here.gap = at.g - of->radius;
    return (fu_approach){.x = x,
                         .gap = here.gap,
                         .rate = of->h * fu_dot(of->dim, here.n, here.rate),
                         .depth = -here.gap,
                         .free = free_path(of, &here, of->longest) / of->longest,
                         .known = 1};
}

double fu_surface_detect_within(int dim, const fu_surface *surface, double radius, const fu_surface_end ends[2],
                                double h, double least)
{
    static const double still[3] = {0.0};
    point_path of = {.dim = dim, .surface = surface, .ends = ends, .radius = radius, .h = h};
    if (!(ends[0].gap >= -least && ends[1].gap >= -least)) return 0.0;
    for (int d = 0; d < dim; ++d) of.axes.A[d * dim + d] = 1.0;
    of.longest = fu_longest_path(dim, ends[0].y, ends[0].rate, ends[1].y, ends[1].rate, still, h);
    const double from = free_path(&of, &ends[0], 2.0 * of.longest), to = free_path(&of, &ends[1], 2.0 * of.longest);
    if (!(from + to <= of.longest)) return 0.0;
    const fu_detection detection = {approach, &of, h, least, INFINITY, MIN_ADVANCE, 1.0};
    const fu_approach start = approach(&of, NULL, from / of.longest);
    return fu_detect_within(&detection, &start, 1.0 - to / of.longest, fmin(ends[0].gap, ends[1].gap));
}
