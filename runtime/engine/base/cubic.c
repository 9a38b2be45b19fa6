/* Values along a step by the cubic through values and rates at both ends (Hermite). */
#include "base/cubic.h"

#include <math.h>

#define GRAZING_TOLERANCE 1e-2   /* of the depth of a minimum: a predicted distance from zero that is examined */
#define ROUNDING_OF_VALUES 1e-14 /* of values and changes: smaller depths are rounding */
#define ROUNDING_OF_PART 1e-15   /* of a step */
#define MAX_ITERATIONS 50        /* of Newton's method with bisection */

void fu_vector_within(int dim, const double *from, const double *from_rate, const double *to, const double *to_rate,
                      double h, double x, double *value, double *rate)
{
    for (int d = 0; d < dim; ++d) {
        const fu_step_ends ends = {{from[d], to[d]}, {from_rate[d], to_rate[d]}};
        value[d] = fu_value_within(&ends, h, x);
        rate[d] = fu_rate_within(&ends, h, x);
    }
}

/* The rate of a cubic lies among its three control points: those at the ends, and one between them. */
double fu_longest_path(int dim, const double *from, const double *from_rate, const double *to, const double *to_rate,
                       const double *mean, double h)
{
    double squares[3] = {0.0};
    for (int d = 0; d < dim; ++d) {
        const double first = h * (from_rate[d] - mean[d]), last = h * (to_rate[d] - mean[d]);
        const double middle = 3.0 * (to[d] - from[d] - h * mean[d]) - first - last;
        squares[0] += first * first;
        squares[1] += middle * middle;
        squares[2] += last * last;
    }
    return sqrt(fmax(squares[0], fmax(squares[1], squares[2])));
}

double fu_part_to_rise(const fu_step_ends *ends, double h)
{
    double low = 0.0, high = 1.0, x = ends->value[0] / (ends->value[0] - ends->value[1]);
    for (int i = 0; i < MAX_ITERATIONS && high - low > ROUNDING_OF_PART; ++i) {
        const double value = fu_value_within(ends, h, x), slope = h * fu_rate_within(ends, h, x);
        if (value > 0.0) high = x;
        else low = x;
        const double next = x - value / slope;
        if (fabs(next - x) <= ROUNDING_OF_PART) break;
        x = slope > 0.0 && next > low && next < high ? next : 0.5 * (low + high);
    }
    return x;
}

double fu_part_of_minimum(const fu_step_ends *ends, double h)
{
    const double change = ends->value[1] - ends->value[0], first = h * ends->rate[0], last = h * ends->rate[1];
    const double a = first + last - 2.0 * change, b = 3.0 * change - 2.0 * first - last;
    const double square = b * b - 3.0 * a * first;
    if (!(square > 0.0)) return 0.0;
    return b > 0.0 ? -first / (b + sqrt(square)) : (sqrt(square) - b) / (3.0 * a);
}

double fu_grazing_time(fu_course from, fu_course to, int side, double h, double least)
{
    const fu_step_ends ends = {{fmax(side * from.value, 0.0), side * to.value}, {side * from.rate, side * to.rate}};
    const double x = fu_part_of_minimum(&ends, h);
    if (!(side * from.value >= -least && ends.value[1] >= 0.0) || !(x > 0.0 && x < 1.0)) return 0.0;
    const double bottom = fu_value_within(&ends, h, x), depth = fmin(ends.value[0], ends.value[1]) - bottom;
    const double noise =
        least + ROUNDING_OF_VALUES * (ends.value[0] + ends.value[1] + h * (fabs(from.rate) + fabs(to.rate)));
    return depth > noise && bottom < GRAZING_TOLERANCE * depth ? x * h : 0.0;
}
