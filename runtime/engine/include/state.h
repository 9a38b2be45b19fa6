/* State of the motion at one instant. */
#ifndef FUNICULAR_STATE_H
#define FUNICULAR_STATE_H

#include "common.h"

/* State of the motion at one instant. */
struct fu_state {
    double t;
    double *q, *v, *acceleration;
    double *a;       /* the integrator's auxiliary acceleration */
    double *s;       /* per slide: arc-length */
    double *f;       /* per slide: force on the rider, 3 */
    double *spring;  /* per spring: force on its first end, 3 */
    double *multipliers; /* per joint: 6 */
    double *locked_s;    /* per slide: s where it is held */
    int *element;    /* per slide: element that holds s */
    int *mode;       /* per slide: FU_SLIDES and so on */
    int *slip_direction;        /* per slide: 1 or -1 where friction is against that direction whatever the speed */
    int *contact;    /* per slide: 1 or -1 where it lies against what is at the end or at the start */
    double *director; /* per slide: unit vector across the tangent, carried along with the slide */
    double *memory;  /* of algorithmic dissipation */
};

#endif
