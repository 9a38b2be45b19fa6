/* The minimum of a cubic between two ends of a step: base/double_root.c. */
#ifndef FUNICULAR_BASE_DOUBLE_ROOT_H
#define FUNICULAR_BASE_DOUBLE_ROOT_H

/* A number and its rate at an end of a step. */
typedef struct {
    double value, rate;
} fu_course;

/* Returns when a number is farthest beyond zero in a step of h, s after its start, where it leaves the side (1 or -1)
 * on which it is at both ends; 0 where it is not predicted to, or not by more than `least`. */
double fu_grazing_time(fu_course from, fu_course to, int side, double h, double least);
double fu_part_of_minimum(const double y[2], const double m[2]);

#endif
