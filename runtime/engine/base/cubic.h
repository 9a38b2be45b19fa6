/* Values along a step by the cubic through values and rates at both ends (Hermite): base/cubic.c. */
#ifndef FUNICULAR_BASE_CUBIC_H
#define FUNICULAR_BASE_CUBIC_H

/* Weights of the cubic at a part of a step of length 1: of the change of the value and of the rates at both ends;
 * likewise of its slope. */
typedef struct {
    double change, rates[2], slope, slope_rates[2];
} fu_cubic;
static inline fu_cubic fu_cubic_at(double x)
{
    const double rest = 1.0 - x;
    return (fu_cubic){x * x * (3.0 - 2.0 * x),
                      {rest * rest * x, -x * x * rest},
                      6.0 * x * rest,
                      {rest * (1.0 - 3.0 * x), x * (3.0 * x - 2.0)}};
}

/* A value and its rate at an instant, and at both ends of a step. */
typedef struct {
    double value, rate;
} fu_course;
typedef struct {
    double value[2], rate[2];
} fu_step_ends;

/* Return value and rate after the part x of a step of h, s; likewise of a vector. */
static inline double fu_value_within(const fu_step_ends *ends, double h, double x)
{
    const fu_cubic at = fu_cubic_at(x);
    return ends->value[0] + at.change * (ends->value[1] - ends->value[0]) +
           h * (at.rates[0] * ends->rate[0] + at.rates[1] * ends->rate[1]);
}

static inline double fu_rate_within(const fu_step_ends *ends, double h, double x)
{
    const fu_cubic at = fu_cubic_at(x);
    return at.slope * (ends->value[1] - ends->value[0]) / h + at.slope_rates[0] * ends->rate[0] +
           at.slope_rates[1] * ends->rate[1];
}

void fu_vector_within(int dim, const double *from, const double *from_rate, const double *to, const double *to_rate,
                      double h, double x, double *value, double *rate);
/* Returns an upper bound of the length of a point's path in a step, m, relative to points with the velocity `mean`. */
double fu_longest_path(int dim, const double *from, const double *from_rate, const double *to, const double *to_rate,
                       const double *mean, double h);

/* Return the part of a step at which a value that is not positive at its start and positive at its end becomes
 * positive, and the part at which the cubic has a minimum, outside of (0, 1) if it has none in the step. */
double fu_part_to_rise(const fu_step_ends *ends, double h);
double fu_part_of_minimum(const fu_step_ends *ends, double h);

/* Returns the time in s after the start of a step of h at which a value is farthest beyond zero, if it leaves the side
 * (1 or -1) of both ends by more than `least`; otherwise 0. */
double fu_grazing_time(fu_course from, fu_course to, int side, double h, double least);

#endif
