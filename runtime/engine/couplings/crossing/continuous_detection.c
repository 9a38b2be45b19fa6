/* Lines that touch within a step and not at its ends, as where they graze, or fly through each other and past an end of
 * one of them.
 *
 * Between the ends of the step all points of the lines are taken along the cubics of their places and velocities there
 * (Hermite's). The closest points of the lines so placed are followed through the step. As their distance changes by no
 * more than the ways of points of both lines, lines can go as far as they are off without touching; so they are led on
 * from one such line_place to the next (conservative advancement; Mirtich 1996). Where they are led on by more, since
 * so little is left, the cubic of the gap through both places tells whether it dips below zero between them.
 */
#include "bodies/model.h"
#include "couplings/crossing/crossing.h"

#include <math.h>
#include <string.h>

/* of a step: lines are led on by no more, and by so much where nothing tells how far they can go */
#define MAX_ADVANCE 0.0625
#define MIN_ADVANCE 1e-4 /* of a step: lines are led on by no less */
/* of the distance at which lines touch: what points go at least from line_place to line_place */
#define ADVANCE_SHARE 0.25
#define CAUTION 0.5 /* of the way that closest points have to the ends of their lines, at their rate */
#define CORNER 1e-2 /* of a bracket: how far from its ends the bottom of a dip is looked for */
/* of a dip: how far from zero its bottom may be predicted and yet be looked at */
#define GRAZING_TOLERANCE 1e-2

enum { SECTIONS = 8 }; /* of a bracket of the bottom of a dip */

/* The contact after a part x of a step: how far lines are in contact, m; the gap and its rate by x; the part for which
 * lines do not touch; whether the closest points are known. */
typedef struct {
    double x, margin, gap, rate, free;
    int found;
} line_place;

/* What is followed through a step: the numbers of the closest points and the normal; the way that lines go at most, m.
 */
typedef struct {
    const fu_model *model;
    const fu_crossing *crossing;
    fu_moment at;
    double s[FU_LINES], normal[3], way, shortest;
} approach;

/* Makes the rates of the arc-lengths of the closest points, m/s. */
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

/* Returns the part of the step that a closest point needs at least to come within the ends of its line. */
static double part_beyond_ends(const approach *of, const fu_closest_points *points)
{
    const fu_crossing *crossing = of->crossing;
    double rates[FU_LINES], part = 0.0;
    rates_of_points(crossing, points, rates);
    for (int line = 0; line < FU_LINES; ++line) {
        const double beyond = fmax(crossing->low[line] - points->s[line], points->s[line] - crossing->high[line]);
        if (beyond > 0.0) part = fmax(part, CAUTION * beyond / (of->at.h * fabs(rates[line])));
    }
    return part;
}

/* Follows the closest points to the part x of the step. */
static line_place follow(approach *of, double x)
{
    const fu_crossing *crossing = of->crossing;
    line_place out = {.x = x, .margin = -INFINITY, .gap = NAN, .rate = NAN, .free = MAX_ADVANCE};
    fu_closest_points points;
    fu_crossing_contact contact;
    of->at.x = x;
    fu_find_closest_within(of->model, crossing, &of->at, of->s, &points);
    if (!points.found) {
        if (points.apart > 0.0) out.free = points.apart / of->way;
        return out;
    }
    fu_crossing_contact_at(crossing, &points, &contact);
    if (fu_dot(3, of->normal, contact.normal) < 0.0) return out;
    memcpy(of->s, points.s, sizeof of->s);
    memcpy(of->normal, contact.normal, sizeof of->normal);
    out.found = 1;
    out.gap = -contact.depth[0];
    out.rate = -of->at.h * contact.depth[1];
    out.margin = fu_crossing_margin_of(crossing, &points, &contact);
    out.free = out.margin > 0.0 ? out.margin / of->way : fmax(out.gap / of->way, part_beyond_ends(of, &points));
    if (!(out.free > 0.0))
        out.free = out.gap < 0.0 ? MAX_ADVANCE : of->shortest; /* damping would turn the force round */
    return out;
}

/* Returns the part of the step at which lines touch between two places of it, or nearly, as against the gap at its
 * ends; 0 where they do not: by the bottom of the gap, where its rate passes zero. */
static double touch_between(const approach *of, line_place from, line_place to, double ends, double least)
{
    if (!from.found || !to.found || !(from.gap >= 0.0 && from.rate < 0.0 && to.rate > 0.0)) return 0.0;
    for (int i = 0; i < SECTIONS; ++i) {
        approach between = *of;
        const double part = fmin(fmax(from.rate / (from.rate - to.rate), CORNER), 1.0 - CORNER);
        const line_place bottom = follow(&between, from.x + part * (to.x - from.x));
        if (!bottom.found) return 0.0;
        if (bottom.margin > least) return bottom.x;
        /* a convex gap lies above its tangent */
        const double nearly = GRAZING_TOLERANCE * (ends - bottom.gap), below = fabs(bottom.rate) * (to.x - from.x);
        if (bottom.gap - below > fmax(nearly, 0.0)) return 0.0;
        if (i == SECTIONS - 1 && bottom.gap < nearly && bottom.margin >= -bottom.gap) return bottom.x;
        *(bottom.rate < 0.0 ? &from : &to) = bottom;
    }
    return 0.0;
}

/* Returns the largest size of points of a line's cubic by differences, m in a step: of three numbers, the velocities at
 * its ends and that between them that its control points give. */
static double largest_way(int dim, const double *a, const double *b, const double *v, const double *w,
                          const double *mean, double h)
{
    double squares[3] = {0.0};
    for (int d = 0; d < dim; ++d) {
        const double first = h * (v[d] - mean[d]), last = h * (w[d] - mean[d]);
        const double middle = 3.0 * (b[d] - a[d] - h * mean[d]) - first - last;
        squares[0] += first * first;
        squares[1] += middle * middle;
        squares[2] += last * last;
    }
    return sqrt(fmax(squares[0], fmax(squares[1], squares[2])));
}

/* Returns how far points of a line go in the step at most, as against points that go at the mean velocity, m. */
static double way_of_line(const approach *of, int line, const double *mean)
{
    static const double still[3] = {0.0};
    const fu_crossing *crossing = of->crossing;
    const fu_state *now = of->at.now, *next = of->at.next;
    const int dim = of->model->dim;
    double sum = 0.0;
    if (crossing->cables[line] < 0) {
        for (int end = 0; end < 2; ++end) {
            const double s = dim == 2 ? 0.0 : end ? crossing->high[line] : crossing->low[line];
            fu_line_point from, to;
            fu_line_point_of(of->model, crossing, line, now, s, &from);
            fu_line_point_of(of->model, crossing, line, next, s, &to);
            sum = fmax(sum, largest_way(dim, from.r, to.r, from.v, to.v, mean, of->at.h));
        }
        return sum;
    }
    const fu_cable *cable = &of->model->cables[crossing->cables[line]];
    for (int k = 0; k < cable->kernel->vectors; ++k) {
        const double share = cable->share ? cable->share[k] : k ? cable->length : 1.0;
        double most = 0.0;
        for (int node = 0; node <= cable->n_elements && share != 0.0; ++node) {
            const int at = cable->first + node * cable->per_node + k * dim;
            most = fmax(most, largest_way(dim, now->q + at, next->q + at, now->v + at, next->v + at, k ? still : mean,
                                          of->at.h));
        }
        sum += share * most;
    }
    return sum;
}

/* Returns how far points of both lines can come nearer in the step at most, m. */
static double most_way(const approach *of)
{
    const fu_cable *cable = &of->model->cables[of->crossing->cables[0]];
    double mean[3] = {0.0};
    for (int d = 0; d < of->model->dim; ++d)
        for (int node = 0; node <= cable->n_elements; ++node)
            mean[d] += of->at.now->v[cable->first + node * cable->per_node + d] / (cable->n_elements + 1);
    return way_of_line(of, 0, mean) + way_of_line(of, 1, mean);
}

static void begin(approach *of)
{
    const double *numbers = of->at.now->numbers + of->crossing->base.numbers;
    memcpy(of->s, numbers + FU_CROSSING_S, sizeof of->s);
    memcpy(of->normal, numbers + FU_CROSSING_NORMAL, sizeof of->normal);
    of->way = most_way(of);
    of->shortest = fmin(fmax(ADVANCE_SHARE * of->crossing->law[0] / of->way, MIN_ADVANCE), MAX_ADVANCE);
}

double fu_crossing_detect_within(const fu_model *model, const fu_crossing *crossing, const fu_state *now,
                                 const fu_state *next, double h, double least)
{
    approach of = {.model = model, .crossing = crossing, .at = {now, next, h, 0.0}};
    double first = 0.0;
    begin(&of);
    line_place from = follow(&of, 0.0);
    if (from.margin > 0.0 || (from.found && from.free > 1.0)) return 0.0;
    approach beyond = of;
    const line_place end = follow(&beyond, 1.0);
    const double ends = fmin(from.gap, end.gap);
    while (from.x < 1.0) {
        const double x = fmin(from.x + fmin(fmax(from.free, of.shortest), MAX_ADVANCE), 1.0);
        const line_place to = follow(&of, x);
        if (first > 0.0 && (!(to.margin > least) || -to.gap > crossing->law[0])) return 0.5 * h * (first + x);
        if (first == 0.0 && to.margin > least && x < 1.0) first = x;
        if (first == 0.0) {
            const double dip = touch_between(&of, from, to, ends, least);
            if (dip > 0.0) return h * dip;
        }
        from = to;
    }
    return 0.0;
}
