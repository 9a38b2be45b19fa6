/* The bottom of a cubic between two places of a step. */
#include "base/double_root.h"

#include <math.h>

/* of a dip: how far from zero its end may be predicted and yet be looked at */
#define GRAZING_TOLERANCE 1e-2
#define ROUNDING_OF_VALUES 1e-14 /* of what a watch is of, and of its values: dips less deep are rounding */

/* Returns the part of a step at which the cubic with the values y and the slopes m at its ends has a minimum; not
 * within 0 and 1 where it has none there. */
double fu_part_of_minimum(const double y[2], const double m[2])
{
    const double a = 2.0 * (y[0] - y[1]) + m[0] + m[1], b = 3.0 * (y[1] - y[0]) - 2.0 * m[0] - m[1];
    const double square = b * b - 3.0 * a * m[0];
    if (!(square > 0.0)) return 0.0;
    return b > 0.0 ? -m[0] / (b + sqrt(square)) : (sqrt(square) - b) / (3.0 * a);
}

static double cubic(const double y[2], const double m[2], double x)
{
    const double rest = 1.0 - x;
    return rest * rest * ((1.0 + 2.0 * x) * y[0] + x * m[0]) + x * x * ((3.0 - 2.0 * x) * y[1] - rest * m[1]);
}

double fu_grazing_time(fu_course from, fu_course to, int side, double h, double least)
{
    const double y[2] = {fmax(side * from.value, 0.0), side * to.value},
                 m[2] = {side * h * from.rate, side * h * to.rate};
    const double x = fu_part_of_minimum(y, m);
    if (!(side * from.value >= -least && y[1] >= 0.0) || !(x > 0.0 && x < 1.0)) return 0.0;
    const double bottom = cubic(y, m, x), depth = fmin(y[0], y[1]) - bottom;
    const double noise = least + ROUNDING_OF_VALUES * (y[0] + y[1] + fabs(m[0]) + fabs(m[1]));
    return depth > noise && bottom < GRAZING_TOLERANCE * depth ? x * h : 0.0;
}
