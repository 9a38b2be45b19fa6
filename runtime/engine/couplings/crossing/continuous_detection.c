/* Continuous collision detection of two lines within one step: grazing contact, and lines that pass through each other
 * near an end of one of them. Their closest points are followed through the step.
 */
#include "base/cubic.h"
#include "bodies/model.h"
#include "couplings/common/continuous_detection.h"
#include "couplings/crossing/crossing.h"

#include <math.h>
#include <string.h>

#define MAX_ADVANCE 0.0625 /* of a step: also the advance without a bound */
#define MIN_ADVANCE 1e-4   /* of a step */
#define ADVANCE_SHARE 0.25 /* of the distance of contact: the shortest path of points from advance to advance */
#define SAFETY 0.5         /* of the path of closest points to the ends of their lines, at their rate */

/* The lines in a step, and the longest path of points of both lines in it, m. */
typedef struct {
    const fu_model *model;
    const fu_crossing *crossing;
    const fu_state *now, *next;
    double h, path, min_advance;
} line_approach;

/* Computes the rates of the arc-lengths of the closest points, m/s. */
static void rates_of_points(const fu_crossing *crossing, const fu_closest_points *points, double rates[FU_LINES])
{
    const int dim = crossing->kernel->dim, lines = dim - 1;
    double F[3], F_d[9], F_t[18], F_u[9], s_d[6], s_t[12];
    crossing->kernel->force(points->d, points->t, points->k, points->w, points->u, crossing->law, F, F_d, F_t, F_u, s_d,
                            s_t);
    for (int line = 0; line < FU_LINES; ++line) {
        rates[line] = 0.0;
        if (line >= lines) continue;
        rates[line] = fu_dot(dim, s_d + line * dim, points->u);
        for (int other = 0; other < lines; ++other)
            rates[line] += fu_dot(dim, s_t + (line * lines + other) * dim, points->w + other * dim);
    }
}

/* Returns a lower bound of the part of the step in which a closest point comes within the ends of its line. */
static double part_beyond_ends(const line_approach *of, const fu_closest_points *points)
{
    const fu_crossing *crossing = of->crossing;
    double rates[FU_LINES], part = 0.0;
    rates_of_points(crossing, points, rates);
    for (int line = 0; line < FU_LINES; ++line) {
        const double beyond = fmax(crossing->low[line] - points->s[line], points->s[line] - crossing->high[line]);
        if (beyond > 0.0) part = fmax(part, SAFETY * beyond / (of->h * fabs(rates[line])));
    }
    return part;
}

/* Follows the closest points to the part x of the step. */
static fu_approach approach(const void *what, const fu_approach *near, double x)
{
    const line_approach *of = what;
    const fu_crossing *crossing = of->crossing;
    const fu_moment moment = {of->now, of->next, of->h, x};
    fu_approach out = {.x = x, .gap = NAN, .rate = NAN, .depth = -INFINITY, .free = MAX_ADVANCE};
    fu_closest_points points;
    fu_crossing_contact contact;
    memcpy(out.s, near->s, sizeof out.s);
    memcpy(out.normal, near->normal, sizeof out.normal);
    fu_find_closest_within(of->model, crossing, &moment, near->s, &points);
    if (!points.found) {
        if (points.apart > 0.0) out.free = points.apart / of->path;
        return out;
    }
    fu_crossing_contact_at(crossing, &points, &contact);
    if (fu_dot(3, near->normal, contact.normal) < 0.0) return out;
    memcpy(out.s, points.s, sizeof out.s);
    memcpy(out.normal, contact.normal, sizeof out.normal);
    out.known = 1;
    out.gap = -contact.depth[0];
    out.rate = -of->h * contact.depth[1];
    out.depth = fu_crossing_margin_of(crossing, &points, &contact);
    out.free = out.depth > 0.0 ? out.depth / of->path : fmax(out.gap / of->path, part_beyond_ends(of, &points));
    if (!(out.free > 0.0))
        out.free = out.gap < 0.0 ? MAX_ADVANCE : of->min_advance; /* damping would reverse the force */
    return out;
}

/* Returns the longest path of points of a line in the step, relative to points that move at the mean velocity, m. */
static double path_of_line(const line_approach *of, int line, const double *mean)
{
    static const double still[3] = {0.0};
    const fu_crossing *crossing = of->crossing;
    const fu_state *now = of->now, *next = of->next;
    const int dim = of->model->dim;
    double sum = 0.0;
    if (crossing->cables[line] < 0) {
        for (int end = 0; end < 2; ++end) {
            const double s = dim == 2 ? 0.0 : end ? crossing->high[line] : crossing->low[line];
            fu_line_point from, to;
            fu_line_point_of(of->model, crossing, line, now, s, &from);
            fu_line_point_of(of->model, crossing, line, next, s, &to);
            sum = fmax(sum, fu_longest_path(dim, from.r, from.v, to.r, to.v, mean, of->h));
        }
        return sum;
    }
    const fu_cable *cable = &of->model->cables[crossing->cables[line]];
    for (int k = 0; k < cable->kernel->vectors; ++k) {
        const double share = cable->share ? cable->share[k] : k ? cable->length : 1.0;
        double most = 0.0;
        if (share == 0.0) continue;
        FU_EACH_NODE(node, cable)
        {
            const int at = node + k * dim;
            most = fmax(most, fu_longest_path(dim, now->q + at, now->v + at, next->q + at, next->v + at,
                                              k ? still : mean, of->h));
        }
        sum += share * most;
    }
    return sum;
}

/* Returns the mean velocity of the nodes of the first line at the start of the step, m/s, in `mean`. */
static void mean_velocity(const line_approach *of, double mean[3])
{
    const fu_cable *cable = &of->model->cables[of->crossing->cables[0]];
    for (int d = 0; d < of->model->dim; ++d) FU_EACH_NODE(node, cable) mean[d] += of->now->v[node + d] / cable->n_nodes;
}

double fu_crossing_detect_within(const fu_model *model, const fu_crossing *crossing, const fu_state *now,
                                 const fu_state *next, double h, double least)
{
    const double *numbers = now->numbers + crossing->base.numbers;
    double mean[3] = {0.0};
    line_approach of = {model, crossing, now, next, h, 0.0, 0.0};
    fu_approach start = {.x = 0.0};
    mean_velocity(&of, mean);
    of.path = path_of_line(&of, 0, mean) + path_of_line(&of, 1, mean);
    of.min_advance = fmin(fmax(ADVANCE_SHARE * crossing->law[0] / of.path, MIN_ADVANCE), MAX_ADVANCE);
    memcpy(start.s, numbers + FU_CROSSING_S, sizeof start.s);
    memcpy(start.normal, numbers + FU_CROSSING_NORMAL, sizeof start.normal);
    start = approach(&of, &start, 0.0);
    if (start.depth > 0.0 || (start.known && start.free > 1.0)) return 0.0;
    const fu_approach end = approach(&of, &start, 1.0);
    const fu_detection detection = {approach, &of, h, least, crossing->law[0], of.min_advance, MAX_ADVANCE};
    return fu_detect_within(&detection, &start, 1.0, fmin(start.gap, end.gap));
}
