/* Lengths of a scene that scale errors and rounding. */
#include "couplings/common/attachments.h"
#include "couplings/rope/rope.h"
#include "couplings/taut_rope/taut_rope.h"
#include "equations/run.h"
#include "equations/scene_size.h"

#include <math.h>

/* Returns the square of the distance between two positions of n coordinates, m^2. */
static double square_between(const double *from, const double *to, int n)
{
    double square = 0.0;
    for (int d = 0; d < n; ++d) square += (to[d] - from[d]) * (to[d] - from[d]);
    return square;
}

/* Returns the largest displacement of points by the dofs of ropes, m. */
static double motion_of_ropes(const fu_model *model, const double *weight, const double *from, const double *to)
{
    const fu_range ropes = fu_rope_dofs(model);
    double largest = 0.0;
    for (int i = ropes.first; i < ropes.end; ++i) largest = fmax(largest, weight[i] * fabs(to[i] - from[i]));
    return largest;
}

/* Returns the largest displacement of a node, of a rope's material, or of a body's centre, m. */
double fu_largest_motion(const fu_model *model, const double *from, const double *to)
{
    double largest = 0.0;
    FU_EACH_CABLE(cable, model) {
        FU_EACH_NODE(at, cable)
        {
            const double square = square_between(from + at, to + at, cable->kernel->dim);
            if (square > largest) largest = square;
        }
    }
    FU_EACH_BODY(body, model) {
        const double square = square_between(from + body->configuration, to + body->configuration, body->kernel->dim);
        if (square > largest) largest = square;
    }
    return fmax(sqrt(largest), motion_of_ropes(model, model->weight, from, to));
}

/* Returns the squared displacement by the dofs of a position, without those of no weight, m^2. */
static double square_moved(const double *weight, const double *from, const double *to, int n)
{
    double square = 0.0;
    for (int d = 0; d < n; ++d)
        if (weight[d] > 0.0) square += (to[d] - from[d]) * (to[d] - from[d]);
    return square;
}

/* Returns the rotation of a body as a length, m: the chord 2 sin(angle/2) of unit vectors times the weight of the
 * rotations. A quaternion turns by half the angle, so that the product of its distances from the other and from the
 * other's opposite, which is the same attitude, is this chord. */
static double turned(const fu_body *body, const double *weight, const double *from, const double *to)
{
    const fu_body_kernels *kernel = body->kernel;
    double largest = 0.0, there = 0.0, opposite = 0.0;
    for (int i = kernel->dim; i < kernel->velocity; ++i) largest = fmax(largest, weight[body->dof + i]);
    for (int i = kernel->dim; i < kernel->configuration; ++i) {
        const double a = from[body->configuration + i], b = to[body->configuration + i];
        there += (b - a) * (b - a);
        opposite += (b + a) * (b + a);
    }
    return largest * (kernel->dim == 3 ? sqrt(there * opposite) : sqrt(there));
}

/* Returns the largest displacement since the start in the error of tol, m: nodes, bodies' centres, and rotations and
 * modes if they count. */
double fu_controlled_motion(const fu_run *run)
{
    const fu_model *model = run->model;
    const double *weight = run->controlled, *from = run->first, *to = run->now.q;
    double square = 0.0, largest = 0.0;
    FU_EACH_CABLE(cable, model) FU_EACH_NODE(at, cable)
    square = fmax(square, square_moved(weight + at, from + at, to + at, cable->kernel->dim));
    FU_EACH_BODY(body, model) {
        const int at = body->configuration, mode = at + body->kernel->configuration;
        const double *of_modes = weight + body->dof + body->kernel->velocity;
        square = fmax(square, square_moved(weight + body->dof, from + at, to + at, body->kernel->dim));
        largest = fmax(largest, turned(body, weight, from, to));
        for (int i = 0; i < body->modes; ++i)
            largest = fmax(largest, of_modes[i] * fabs(to[mode + i] - from[mode + i]));
    }
    return fmax(fmax(largest, sqrt(square)), motion_of_ropes(model, weight, from, to));
}

/* Returns the scale of rounding of coordinates, m: the farthest position, or the displacement of a point by unit slopes
 * and rotations. */
double fu_extent(const fu_model *model, const double *origin, const double *q)
{
    double largest = fu_largest_motion(model, origin, q);
    FU_EACH_CABLE(cable, model)
        for (int i = cable->kernel->dim; i < cable->per_node; ++i)
            largest = fmax(largest, model->weight[cable->first + i]);
    FU_EACH_BODY(body, model)
        for (int i = body->kernel->dim; i < body->kernel->velocity; ++i)
            largest = fmax(largest, model->weight[body->dof + i]);
    return largest;
}

/* Extends a box to a position. */
static void widen(int dim, const double *r, double low[3], double high[3])
{
    for (int d = 0; d < dim; ++d) {
        low[d] = fmin(low[d], r[d]);
        high[d] = fmax(high[d], r[d]);
    }
}

/* Returns the largest side of the box around all nodes and bodies' centres, or the displacement of a point by unit
 * slopes and rotations, m. */
double fu_scene_size(const fu_model *model, const double *origin, const double *q)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    double largest = fu_extent(model, origin, origin);
    FU_EACH_CABLE(cable, model) FU_EACH_NODE(at, cable)
    widen(model->dim, q + at, low, high);
    FU_EACH_COUPLING(c, model->couplings, model->n_couplings) {
        const int nodes = c->type == &fu_span_type ? ((const fu_span_coupling *)c)->on.n_elements + 1 : 0;
        for (int k = 0; k < nodes; ++k)
            widen(model->dim, fu_span_node(&((const fu_span_coupling *)c)->on, k, q), low, high);
        const fu_attachment *on = c->type == &fu_taut_point_type ? ((const fu_taut_point *)c)->attachments : 0;
        if (on && on->body < 0) widen(model->dim, on->u, low, high);
    }
    FU_EACH_BODY(body, model) widen(model->dim, q + body->configuration, low, high);
    for (int d = 0; d < model->dim; ++d) largest = fmax(largest, high[d] - low[d]);
    return largest;
}

/* Returns the length of one item of a field, m: itself, or the distance of a point from the origin of its axes. */
static double length_of(int dim, const fu_field *field, const char *item)
{
    if (field->kind == FU_LENGTH) return fabs(*(const double *)item);
    const fu_attachment *on = (const fu_attachment *)item;
    const double *place = on->modal.x ? on->modal.x : on->u;
    return sqrt(fu_dot(dim, place, place));
}

/* Returns the longest length from which constraints compute positions, m: points in the axes of bodies and of the
 * ground, sizes of shapes. The rounding of a distance between two of them is relative to it, at any distance from the
 * origin. */
double fu_longest_lever(const fu_model *model)
{
    double longest = 0.0;
    for (int c = 0; c < model->n_couplings; ++c) {
        const char *structure = (const char *)model->couplings[c];
        if (model->couplings[c]->row < 0) continue;
        for (const fu_field *field = model->couplings[c]->type->fields; field->name; ++field) {
            if (field->kind != FU_LENGTH && field->kind != FU_ATTACHMENT) continue;
            for (int i = 0; i < field->most; ++i)
                longest =
                    fmax(longest, length_of(model->dim, field, structure + field->offset + (size_t)i * field->stride));
        }
    }
    return longest;
}
