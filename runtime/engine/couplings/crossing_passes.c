/* Lines that touch within a step and not at its ends, as where they fly through each other and past an end of one of them, or so far
 * that they are apart again from end to end: the penetration and the ways of the closest points to the ends of their lines are led
 * from one end of the step to the other by the cubics through their values and rates there (Hermite's). What is least of them is
 * looked at from place to place: none of the cubics can change faster than the chords of its control points, so that from a place
 * where one is below zero the next is as far away as that one needs to come back.
 */
#include "engine.h"

#include <math.h>

#define LEAST 1e-3 /* of a step: how far apart places are at least */
enum { COURSES = 1 + 2 * FU_LINES };

/* A course over a step: the ordinates of its control points (Bezier's), and what it changes by in a step at most. */
typedef struct {
    double points[4], change;
} arc;

/* Makes the rates of the arc-lengths of the closest points, m/s. */
static void rates_of_points(const fu_crossing *crossing, const fu_closest_points *points, double rates[FU_LINES])
{
    const int dim = crossing->kernel->dim, lines = dim - 1;
    double F[3], F_d[9], F_t[18], F_u[9], s_d[6], s_t[12];
    crossing->kernel->force(points->d, points->t, points->k, points->w, points->u, crossing->law, F, F_d, F_t, F_u, s_d, s_t);
    for (int line = 0; line < FU_LINES; ++line) {
        rates[line] = 0.0;
        if (line >= lines) continue;
        rates[line] = fu_dot(dim, s_d + line * dim, points->u);
        for (int other = 0; other < lines; ++other)
            rates[line] += fu_dot(dim, s_t + (line * lines + other) * dim, points->w + other * dim);
    }
}

/* Makes the courses of a state: the penetration, and how far both closest points are within the ends of their lines, m, with rates;
 * returns whether there are such points. */
static int courses_of(const fu_model *model, const fu_crossing *crossing, const fu_state *state, fu_course out[COURSES])
{
    fu_closest_points points;
    fu_crossing_contact contact;
    double rates[FU_LINES];
    fu_find_closest(model, crossing, state, &points);
    fu_crossing_contact_at(crossing, &points, &contact);
    if (!points.found || fu_crossing_swung(crossing, state, &contact)) return 0;
    rates_of_points(crossing, &points, rates);
    out[0] = (fu_course){contact.depth[0], contact.depth[1]};
    for (int line = 0; line < FU_LINES; ++line) {
        out[1 + 2 * line] = (fu_course){points.s[line] - crossing->low[line], rates[line]};
        out[2 + 2 * line] = (fu_course){crossing->high[line] - points.s[line], -rates[line]};
    }
    return 1;
}

static arc arc_of(fu_course from, fu_course to, double h)
{
    arc out = {{from.value, from.value + h * from.rate / 3.0, to.value - h * to.rate / 3.0, to.value}, 0.0};
    for (int k = 0; k < 3; ++k) out.change = fmax(out.change, 3.0 * fabs(out.points[k + 1] - out.points[k]));
    return out;
}

static double value_at(const arc *of, double x)
{
    const double u = 1.0 - x, *p = of->points;
    return u * u * (u * p[0] + 3.0 * x * p[1]) + x * x * (3.0 * u * p[2] + x * p[3]);
}

/* Returns what is least of the courses after part x of the step; makes in *way the part of it for which one stays below zero. */
static double least_at(const arc *arcs, int n, double x, double *way)
{
    double least = INFINITY;
    *way = 0.0;
    for (int i = 0; i < n; ++i) {
        const double value = value_at(&arcs[i], x);
        least = fmin(least, value);
        if (value < 0.0) *way = fmax(*way, arcs[i].change > 0.0 ? -value / arcs[i].change : INFINITY);
    }
    return least;
}

double fu_crossing_pass(const fu_model *model, const fu_crossing *crossing, const fu_state *now, const fu_state *next, double h,
                        double least)
{
    fu_course from[COURSES], to[COURSES];
    arc arcs[COURSES];
    double way, back, first = 0.0;
    int n = 0;
    if (!courses_of(model, crossing, now, from) || !courses_of(model, crossing, next, to)) return 0.0;
    for (int i = 0; i < COURSES; ++i)
        if (from[i].value < INFINITY) arcs[n++] = arc_of(from[i], to[i], h);
    if (!(least_at(arcs, n, 0.0, &way) < 0.0)) return 0.0;
    least_at(arcs, n, 1.0, &back);
    for (double x = fmax(way, LEAST); x < 1.0 - back; x += fmax(way, LEAST)) {
        const double here = least_at(arcs, n, x, &way);
        const int has_met = value_at(&arcs[0], x) > crossing->law[0]; /* the axes of the lines have */
        if (first > 0.0 && (here < least || has_met)) return 0.5 * h * (first + x);
        if (first == 0.0 && here > least) first = x;
    }
    return first > 0.0 ? 0.5 * h * (first + 1.0 - back) : 0.0;
}
