/* Numbers along a step, by the cubic through their values and rates at both ends (Hermite): base/cubic.c. */
#ifndef FUNICULAR_BASE_CUBIC_H
#define FUNICULAR_BASE_CUBIC_H

/* Weights of the cubic at a part of a step of length 1: of the change of the value, of the rates at both ends; the same
 * for its slope. */
typedef struct {
    double change, rates[2], slope, slope_rates[2];
} fu_cubic;
fu_cubic fu_cubic_at(double x);

/* A number and its rate, at an instant; at both ends of a step. */
typedef struct {
    double value, rate;
} fu_course;
typedef struct {
    double value[2], rate[2];
} fu_step_ends;

/* Value and rate after the part x of a step of h, s; the same of a vector. */
double fu_value_within(const fu_step_ends *ends, double h, double x);
double fu_rate_within(const fu_step_ends *ends, double h, double x);
void fu_vector_within(int dim, const double *from, const double *from_rate, const double *to, const double *to_rate,
                      double h, double x, double *value, double *rate);
/* An upper bound of the length of a point's path in a step, m, relative to points that move at the velocity `mean`. */
double fu_longest_path(int dim, const double *from, const double *from_rate, const double *to, const double *to_rate,
                       const double *mean, double h);

/* The part of a step at which a value becomes positive that is not at its start and is at its end; the part at which
 * the cubic has a minimum, outside of (0, 1) where it has none in the step. */
double fu_part_to_rise(const fu_step_ends *ends, double h);
double fu_part_of_minimum(const fu_step_ends *ends, double h);

/* Returns when a number is farthest beyond zero in a step of h, s after its start, where it leaves the side (1 or -1)
 * on which it is at both ends; 0 where it is not predicted to, or not by more than `least`. */
double fu_grazing_time(fu_course from, fu_course to, int side, double h, double least);

#endif
