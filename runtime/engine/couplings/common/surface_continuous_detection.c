/* Points that go through a surface, or past its edge, within a step, and are off it again at a later time of that step.
 *
 * Between the ends a point is taken along the cubic of its places and velocities there, in the axes of the shape
 * (Hermite). As the distance from a surface changes by no more than the way, the point can go as far as it is off
 * without touching; so it is led on from one such place to the next (conservative advancement; Mirtich 1996). What is
 * taken for the distance of a height field is the vertical one, G, over the root of 1 + slope^2, which it is at the
 * surface alone: over a way w the slope is the one here and w times the largest second derivative at most, and nowhere
 * more than the largest; with that one, s, the point stays off the surface while G - w (1 + s^2)^(1/2) > radius (1 +
 * s^2)^(1/2).
 */
#include "couplings/common/surfaces.h"

#include <math.h>
#include <string.h>

/* of a step: what the point is led on by at least; what touches for less is looked at by fu_grazing_time alone */
#define MIN_ADVANCE 1e-3
#define HALVINGS 12

/* A cubic_path: Bezier's points of the cubic; the largest speed along it, m/s. */
typedef struct {
    int dim;
    const fu_surface *surface;
    double radius, h, points[4][3], speed;
    fu_attachment_state own; /* the axes of the shape */
} cubic_path;

/* Makes the point after part x of the step; of `out` all but the velocity. */
static void place_at(const cubic_path *of, double x, fu_surface_end *out)
{
    const double u = 1.0 - x, weights[4] = {u * u * u, 3.0 * u * u * x, 3.0 * u * x * x, x * x * x};
    fu_distance at;
    memset(out, 0, sizeof *out);
    for (int k = 0; k < 4; ++k)
        for (int d = 0; d < of->dim; ++d) out->y[d] += weights[k] * of->points[k][d];
    fu_surface_distance(of->dim, of->surface, &of->own, out->y, &at);
    memcpy(out->n, at.n, sizeof at.n);
    out->gap = at.g - of->radius;
}

/* Returns how far a point is beyond the edges of a terrain, m: what it can go without coming over the table. Makes the
 * nearest place of the table: beyond it heights stay. */
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

/* Returns what a point can go without passing a terrain, m: `most` at most. */
static double free_over_terrain(const cubic_path *of, const fu_surface_end *at, double most)
{
    const fu_surface *surface = of->surface;
    const double height = (at->gap + of->radius) / at->n[1], here = slope_of(at->n);
    double inside[3], over = here, found = 0.0, way = fmin(fabs(at->gap), most);
    fu_distance edge;
    const double beyond = beyond_table(of->dim, surface, at->y, inside);
    if (beyond > 0.0) {
        fu_surface_distance(of->dim, surface, &of->own, inside, &edge);
        over = slope_of(edge.n);
    }
    for (int i = 0; i < HALVINGS && found < way; ++i, way *= 0.5) {
        const double slope = fmin((way <= beyond ? here : over) + surface->bend * way, surface->steepest);
        const double root = sqrt(1.0 + slope * slope);
        const double off = at->gap < 0.0 ? (of->radius - height) / root : height / root - of->radius;
        found = fmax(found, fmin(off, way));
    }
    return found;
}

/* Returns what a point can go at least without coming to the surface, or off it where it is below, m. */
static double free_way(const cubic_path *of, const fu_surface_end *at, double most)
{
    return of->surface->shape == FU_TERRAIN ? free_over_terrain(of, at, most) : fabs(at->gap);
}

static void make_path(int dim, const fu_surface *surface, double radius, const fu_surface_end ends[2], double h,
                      cubic_path *out)
{
    memset(out, 0, sizeof *out);
    out->dim = dim;
    out->surface = surface;
    out->radius = radius;
    out->h = h;
    for (int d = 0; d < dim; ++d) {
        out->own.A[d * dim + d] = 1.0;
        out->points[0][d] = ends[0].y[d];
        out->points[1][d] = ends[0].y[d] + h * ends[0].rate[d] / 3.0;
        out->points[2][d] = ends[1].y[d] - h * ends[1].rate[d] / 3.0;
        out->points[3][d] = ends[1].y[d];
    }
    for (int k = 0; k < 3; ++k) {
        double square = 0.0;
        for (int d = 0; d < dim; ++d)
            square += (out->points[k + 1][d] - out->points[k][d]) * (out->points[k + 1][d] - out->points[k][d]);
        out->speed = fmax(out->speed, 3.0 * sqrt(square) / h);
    }
}

double fu_surface_detect_within(int dim, const fu_surface *surface, double radius, const fu_surface_end ends[2],
                                double h, double least)
{
    cubic_path of;
    fu_surface_end at;
    if (!(ends[0].gap >= 0.0 && ends[1].gap >= 0.0)) return 0.0;
    make_path(dim, surface, radius, ends, h, &of);
    const double way = h * of.speed, from = free_way(&of, &ends[0], 2.0 * way), to = free_way(&of, &ends[1], 2.0 * way);
    if (!(from + to <= way)) return 0.0;
    const double last = 1.0 - to / way;
    double first = 0.0;
    for (double x = from / way; x < last;) {
        place_at(&of, x, &at);
        if (first > 0.0 && at.gap > -least) return 0.5 * h * (first + x);
        if (first == 0.0 && at.gap < -least) first = x;
        x += fmax(free_way(&of, &at, way) / way, MIN_ADVANCE);
    }
    return first > 0.0 ? 0.5 * h * (first + last) : 0.0;
}
