/* Continuous collision detection by conservative advancement (Mirtich 1996).
 *
 * Between the ends of a step all points move along the cubics of their positions and velocities there (Hermite). The
 * distance of two objects changes by at most the paths of their points: they stay apart for the part of the step in
 * which their paths are shorter than the distance, and are evaluated again where that part ends. Advances have a lower
 * bound. If it is longer than that part, and the gap has a minimum between two evaluations, the minimum decides.
 *
 * It serves distances of points to surfaces and of lines to lines. A cubic of the gap through both ends of a step, as
 * in events/grazing.c, would be shorter, but it misses passages: the gap is not smooth where the closest point changes
 * its element, face or edge, and a thin body may pass through a surface between two positive gaps. Bounded advances
 * find each of them.
 */
#include "couplings/common/continuous_detection.h"

#include <math.h>

#define BRACKET_MARGIN 1e-2 /* of a bracket of the minimum: the least distance of the next evaluation from its ends */
#define GRAZING_TOLERANCE 1e-2 /* of the depth of a minimum: a predicted distance from zero that is examined */

enum { SECTIONS = 8 }; /* of a bracket of the minimum */

/* Returns the part of the step at which objects touch or graze between two evaluations, by the minimum of their gap; 0
 * where they do not. */
static double grazing_between(const fu_detection *of, fu_approach from, fu_approach to, double ends)
{
    const fu_approach near = to;
    if (!from.known || !to.known || !(from.gap >= 0.0 && from.rate < 0.0 && to.rate > 0.0)) return 0.0;
    for (int i = 0; i < SECTIONS; ++i) {
        const double part = fmin(fmax(from.rate / (from.rate - to.rate), BRACKET_MARGIN), 1.0 - BRACKET_MARGIN);
        const fu_approach bottom = of->approach(of->of, &near, from.x + part * (to.x - from.x));
        if (!bottom.known) return 0.0;
        if (bottom.depth > of->least) return bottom.x;
        /* a convex gap lies above its tangent */
        const double tolerance = GRAZING_TOLERANCE * (ends - bottom.gap), below = fabs(bottom.rate) * (to.x - from.x);
        if (bottom.gap - below > fmax(tolerance, 0.0)) return 0.0;
        if (i == SECTIONS - 1 && bottom.gap < tolerance && bottom.depth >= -bottom.gap) return bottom.x;
        *(bottom.rate < 0.0 ? &from : &to) = bottom;
    }
    return 0.0;
}

double fu_detect_within(const fu_detection *of, const fu_approach *start, double end, double ends)
{
    fu_approach from = *start;
    double first = 0.0;
    while (from.x < end) {
        const double advance = fmin(fmax(from.free, of->min_advance), of->max_advance);
        const fu_approach to = of->approach(of->of, &from, fmin(from.x + advance, end));
        const int in_contact = to.depth > of->least;
        if (first > 0.0 && (!in_contact || -to.gap > of->deepest)) return 0.5 * of->h * (first + to.x);
        if (first == 0.0 && in_contact && to.x < end) first = to.x;
        if (first == 0.0) {
            const double grazing = grazing_between(of, from, to, ends);
            if (grazing > 0.0) return of->h * grazing;
        }
        from = to;
    }
    return 0.0;
}
