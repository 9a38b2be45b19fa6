/* Surfaces in contact with cables and bodies: distances by the kernels of derive/couplings/surface.py, in the axes of
 * the ground. */
#include "bodies/model.h"
#include "bodies/state.h"
#include "couplings/common/surfaces.h"
#include "couplings/common/attachments.h"

#include <math.h>
#include <string.h>

#define ON_AXIS 1e-12 /* of the radius of a hollow: points nearer to its axis have no direction to its wall */

const char *const fu_surface_role[] = {"surface", 0};
const char *const fu_surface_shapes[] = {"flat", "round", "capsule", "terrain", "box", 0};

void fu_surface_at(const fu_model *model, const fu_surface *surface, const fu_state *state, fu_attachment_state *at)
{
    fu_attachment_at(model, surface->on, state, 0.0, FU_POINT | FU_AXES, at);
}

/* Computes a point from the origin along the shape's axes. */
static void local(int dim, const fu_attachment_state *at, const double *r, double *y)
{
    double from[3] = {0.0};
    for (int d = 0; d < dim; ++d) from[d] = r[d] - at->p[d];
    fu_surface_into(dim, at, from, y);
}

/* Returns the cell of x in a table's grid, and in *x its distance from the start of the cell; beyond the table it is at
 * the edge, and *inside is 0. */
static int cell_of(int n, const double *grid, double *x, int *inside)
{
    *inside = *x >= grid[0] && *x <= grid[n - 1];
    *x = fmin(fmax(*x, grid[0]), grid[n - 1]);
    const int low = fu_last_reached(grid, 0, n - 1, *x);
    *x -= grid[low];
    return low;
}

/* Computes powers of x by the order of their derivative: B[k] (4) are those of the k-th; those of a constant are
 * zero. */
static void powers_of(double x, int changes, double B[4][4])
{
    const double x2 = x * x;
    const double all[4][4] = {
        {1.0, x, x2, x2 * x}, {0.0, 1.0, 2.0 * x, 3.0 * x2}, {0.0, 0.0, 2.0, 6.0 * x}, {0.0, 0.0, 0.0, 6.0}};
    memset(B, 0, sizeof all);
    memcpy(B, all, changes ? sizeof all : sizeof all[0]);
}

/* Computes the height of a terrain and its derivatives in the order of the kernel. */
static void heights_at(int dim, const fu_surface *surface, const double *y, double *h)
{
    static const int orders[10][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}, {3, 0}, {2, 1}, {1, 2}, {0, 3}};
    double a = y[0], b = dim == 3 ? y[2] : 0.0, A[4][4], B[4][4];
    int inside;
    const int i = cell_of(surface->n_first, surface->first, &a, &inside);
    powers_of(a, inside, A);
    if (dim == 2) {
        for (int k = 0; k < 4; ++k) h[k] = fu_dot(4, A[k], surface->heights + 4 * (long)i);
        return;
    }
    const int j = cell_of(surface->n_second, surface->second, &b, &inside);
    powers_of(b, inside, B);
    const double *c = surface->heights + 16 * ((long)i * (surface->n_second - 1) + j);
    for (int k = 0; k < 10; ++k) {
        h[k] = 0.0;
        for (int m = 0; m < 4; ++m) h[k] += A[orders[k][0]][m] * fu_dot(4, B[orders[k][1]], c + 4 * m);
    }
}

/* Computes the nearest element of a box: y from it, for a corner (zero axis), an edge (its axis) or, returning 1, a
 * face (its normal); of a point inside, the nearest face. */
static int nearest_of_box(int dim, const fu_surface *surface, double *y, double *axis, double *normal)
{
    const double *half = surface->half_size;
    int outside = 0, face = 0;
    for (int d = 0; d < dim; ++d) {
        outside += fabs(y[d]) > half[d];
        if (fabs(y[d]) - half[d] > fabs(y[face]) - half[face]) face = d;
        axis[d] = normal[d] = 0.0;
    }
    for (int d = 0; d < dim; ++d) {
        const double side = copysign(1.0, y[d]), beyond = fabs(y[d]) - half[d];
        if (outside < 2 ? d == face : beyond > 0.0) y[d] = side * beyond;
        else if (outside > 1) axis[d] = 1.0;
        if (d == face) normal[d] = side;
    }
    return outside < 2;
}

/* Computes the distance from a shape from outside. */
static void from_outside(int dim, const fu_surface *surface, const fu_attachment_state *at, double y[3],
                         fu_distance *out)
{
    double n[3], H[9], heights[10], half[9], normal[3] = {0.0}, axis[3] = {0.0};
    switch (surface->shape) {
    case FU_FLAT:
        surface->kernel->flat(y, surface->direction, &out->g, n);
        fu_surface_out(dim, at, n, out->n);
        return;
    case FU_TERRAIN:
        heights_at(dim, surface, y, heights);
        surface->kernel->terrain(y, heights, &out->g, n, H);
        break;
    case FU_BOX:
        if (nearest_of_box(dim, surface, y, axis, normal)) {
            surface->kernel->flat(y, normal, &out->g, n);
            fu_surface_out(dim, at, n, out->n);
            return;
        }
        surface->kernel->rounded(y, axis, 0.0, &out->g, n, H);
        break;
    default: {
        const double along = fu_dot(dim, surface->direction, y);
        const double beyond = fabs(along) - surface->half_length;
        if (surface->shape == FU_CAPSULE && beyond > 0.0)
            for (int d = 0; d < dim; ++d) y[d] -= copysign(surface->half_length, along) * surface->direction[d];
        else memcpy(axis, surface->direction, sizeof axis);
        surface->kernel->rounded(y, axis, surface->round_radius, &out->g, n, H);
    }
    }
    fu_surface_out(dim, at, n, out->n);
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) half[i * dim + j] = fu_dot(dim, at->A + i * dim, H + j * dim);
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) out->H[i * dim + j] = fu_dot(dim, half + i * dim, at->A + j * dim);
}

/* Returns whether a point is on the axis of a round shape, or at its centre, where the distance has no gradient. */
static int is_on_axis(int dim, const fu_surface *surface, const double *y)
{
    double along = fu_dot(dim, surface->direction, y), square = 0.0;
    if (surface->shape == FU_CAPSULE) along = fmin(fmax(along, -surface->half_length), surface->half_length);
    for (int d = 0; d < dim; ++d)
        square += (y[d] - along * surface->direction[d]) * (y[d] - along * surface->direction[d]);
    return square <= ON_AXIS * ON_AXIS * surface->round_radius * surface->round_radius;
}

void fu_surface_distance(int dim, const fu_surface *surface, const fu_attachment_state *at, const double *r,
                         fu_distance *out)
{
    double y[3] = {0.0, 0.0, 0.0};
    local(dim, at, r, y);
    memcpy(out->y, y, sizeof y);
    memset(out->H, 0, sizeof out->H);
    if (surface->inside && surface->shape != FU_BOX && is_on_axis(dim, surface, y)) {
        out->g = surface->round_radius;
        memset(out->n, 0, sizeof out->n);
        return;
    }
    from_outside(dim, surface, at, y, out);
    if (!surface->inside) return;
    out->g = surface->inset - out->g;
    for (int d = 0; d < dim; ++d) out->n[d] = -out->n[d];
    for (int i = 0; i < dim * dim; ++i) out->H[i] = -out->H[i];
}

void fu_surface_step_normal(int dim, const fu_surface *surface, const fu_attachment_state *at, const double *from,
                            const double *to, double rise, fu_distance *middle, double *n)
{
    double displacement[3] = {0.0}, halfway[3] = {0.0}, square = 0.0;
    for (int d = 0; d < dim; ++d) {
        halfway[d] = 0.5 * (from[d] + to[d]);
        displacement[d] = to[d] - from[d];
        square += displacement[d] * displacement[d];
    }
    fu_surface_distance(dim, surface, at, halfway, middle);
    const double beyond = square > 0.0 ? (rise - fu_dot(dim, middle->n, displacement)) / square : 0.0;
    for (int d = 0; d < dim; ++d) n[d] = middle->n[d] + beyond * displacement[d];
}

/* Returns the distance of a point from a box, m, negative inside. */
static double from_box(int dim, const double *half, const double *y)
{
    double most = -HUGE_VAL, square = 0.0;
    for (int d = 0; d < dim; ++d) {
        const double beyond = fabs(y[d]) - half[d];
        most = fmax(most, beyond);
        square += beyond > 0.0 ? beyond * beyond : 0.0;
    }
    return most > 0.0 ? sqrt(square) : most;
}

/* Returns the distance of x beyond the ends of a table, negative within. */
static double beyond_grid(int n, const double *grid, double x)
{
    return fmax(grid[0] - x, x - grid[n - 1]);
}

int fu_surface_has_ends(const fu_surface *surface)
{
    return surface->shape == FU_TERRAIN || (surface->shape == FU_ROUND && surface->half_length > 0.0);
}

double fu_surface_beyond(int dim, const fu_surface *surface, const fu_attachment_state *at, const double *r)
{
    double y[3] = {0.0, 0.0, 0.0};
    if (!fu_surface_has_ends(surface)) return -INFINITY;
    local(dim, at, r, y);
    if (surface->shape == FU_TERRAIN) {
        const double along = beyond_grid(surface->n_first, surface->first, y[0]);
        return dim == 2 ? along : fmax(along, beyond_grid(surface->n_second, surface->second, y[2]));
    }
    return fabs(fu_dot(dim, surface->direction, y)) - surface->half_length;
}

/* Returns the distance of a point, along the shape's axes, from a shape other than a terrain, m. */
static double distance_at(int dim, const fu_surface *surface, double y[3])
{
    if (surface->shape == FU_BOX) return from_box(dim, surface->half_size, y);
    double along = fu_dot(dim, surface->direction, y);
    if (surface->shape == FU_FLAT) return along;
    if (surface->shape == FU_CAPSULE) along = fmin(fmax(along, -surface->half_length), surface->half_length);
    for (int d = 0; d < dim; ++d) y[d] -= along * surface->direction[d];
    return sqrt(fu_dot(dim, y, y)) - surface->round_radius;
}

double fu_surface_clearance(int dim, const fu_surface *surface, const fu_attachment_state *at, const double *r,
                            double reach)
{
    double y[3] = {0.0, 0.0, 0.0};
    local(dim, at, r, y);
    if (surface->shape == FU_TERRAIN) {
        /* the distance is that of the tangent plane: a height over the square root of 1 + slope^2 */
        const double above = y[1] - reach - surface->highest;
        return above > 0.0 ? above / sqrt(1.0 + surface->steepest * surface->steepest) : above;
    }
    const double distance = distance_at(dim, surface, y);
    return (surface->inside ? surface->inset - distance : distance) - reach;
}

void fu_surface_velocity(int dim, const fu_attachment_state *at, const double *r, double *v)
{
    double x[3];
    for (int d = 0; d < dim; ++d) x[d] = r[d] - at->p[d];
    fu_swing(dim, at->omega, x, v);
    for (int d = 0; d < dim; ++d) v[d] += at->v[d];
}

void fu_surface_past(int dim, const fu_attachment_state *at, const double *r, const double *v, double *past)
{
    double w[3];
    fu_surface_velocity(dim, at, r, w);
    for (int d = 0; d < dim; ++d) past[d] = v[d] - w[d];
}
