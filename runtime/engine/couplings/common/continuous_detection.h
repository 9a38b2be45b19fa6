/* Continuous collision detection, contact within a step between objects that are apart at both ends of it:
 * couplings/common/continuous_detection.c. */
#ifndef FUNICULAR_COUPLINGS_COMMON_CONTINUOUS_DETECTION_H
#define FUNICULAR_COUPLINGS_COMMON_CONTINUOUS_DETECTION_H

#include "couplings/common/surfaces.h"

/* Two objects after the part x of a step: their gap, m, and its change per step; their penetration in contact, m,
 * negative without contact; the part of the step for which they stay apart; whether gap and rate are known. s, normal:
 * start of the search for the closest points of two lines. */
typedef struct {
    double x, gap, rate, depth, free, s[2], normal[3];
    int known;
} fu_approach;

/* Two objects in a step of h, s. The penetration of a contact exceeds `least`, m; beyond `deepest` the objects have
 * passed through each other. Advances are parts of the step. */
typedef struct {
    fu_approach (*approach)(const void *of, const fu_approach *near, double x);
    const void *of;
    double h, least, deepest, min_advance, max_advance;
} fu_detection;

/* Returns the time at which objects touch that are apart at the part from->x and at the part `end` of a step: half-way
 * from the first contact to the last, or where they graze, s after the start of the step; 0 if they do not. ends: the
 * smaller gap at both ends of the step, m. */
double fu_detect_within(const fu_detection *detection, const fu_approach *from, double end, double ends);

/* A point at an end of a step, along the axes of a surface's shape: its position, m, its velocity relative to the
 * surface, m/s, the gradient of its distance, its gap, m, and the rate of that, m/s. */
typedef struct {
    double y[3], rate[3], n[3], gap, gap_rate;
} fu_surface_end;
/* The same for a point with a sphere and a surface: couplings/common/surface_continuous_detection.c. */
double fu_surface_detect_within(int dim, const fu_surface *surface, double radius, const fu_surface_end ends[2],
                                double h, double least);

#endif
