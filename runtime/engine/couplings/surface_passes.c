/* Points that go through a surface, or past its edge, within a step, and are off it at both of its ends.
 *
 * Between the ends a point is taken along the cubic of its places and velocities there, in the axes of the shape (Hermite). As the
 * distance from a surface changes by no more than the way, the point can go as far as it is off without touching; so it is led on
 * from one such place to the next (conservative advancement; Mirtich 1996). That holds for all shapes but height fields: what is
 * taken for the distance there is the vertical one over the root of 1 + slope^2, which it is at the surface alone. Beside a ridge that
 * is narrow and steep a point is led on too far, and can miss it.
 */
#include "engine.h"

#include <math.h>
#include <string.h>

#define LEAST 1e-3 /* of a step: what the point is led on by at least; what touches for less is looked at by fu_dip alone */

/* A path: Bezier's points of the cubic; the largest speed along it, m/s. */
typedef struct {
    int dim;
    const fu_surface *surface;
    double radius, h, points[4][3], speed;
    fu_attachment_state own; /* the axes of the shape */
} path;

/* Returns how far the point is off the surface after part x of the step, m. */
static double gap_at(const path *of, double x)
{
    const double u = 1.0 - x, weights[4] = {u * u * u, 3.0 * u * u * x, 3.0 * u * x * x, x * x * x};
    double y[3] = {0.0};
    fu_distance at;
    for (int k = 0; k < 4; ++k)
        for (int d = 0; d < of->dim; ++d) y[d] += weights[k] * of->points[k][d];
    fu_surface_distance(of->dim, of->surface, &of->own, y, &at);
    return at.g - of->radius;
}

static void make_path(int dim, const fu_surface *surface, double radius, const fu_surface_end ends[2], double h, path *out)
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
        for (int d = 0; d < dim; ++d) square += (out->points[k + 1][d] - out->points[k][d]) * (out->points[k + 1][d] - out->points[k][d]);
        out->speed = fmax(out->speed, 3.0 * sqrt(square) / h);
    }
}

double fu_surface_pass(int dim, const fu_surface *surface, double radius, const fu_surface_end ends[2], double h, double least)
{
    path of;
    if (!(ends[0].gap >= 0.0 && ends[1].gap >= 0.0)) return 0.0;
    make_path(dim, surface, radius, ends, h, &of);
    const double way = h * of.speed;
    if (!(ends[0].gap + ends[1].gap <= way)) return 0.0;
    const double last = 1.0 - ends[1].gap / way;
    double first = 0.0;
    for (double x = ends[0].gap / way; x < last; ) {
        const double gap = gap_at(&of, x);
        if (first > 0.0 && gap > -least) return 0.5 * h * (first + x);
        if (first == 0.0 && gap < -least) first = x;
        x += fmax(fabs(gap) / way, LEAST);
    }
    return first > 0.0 ? 0.5 * h * (first + last) : 0.0;
}
