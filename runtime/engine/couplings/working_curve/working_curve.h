/* Working curves of ropes (derive/couplings/working_curve.py): couplings/working_curve/working_curve.c. */
#ifndef FUNICULAR_COUPLINGS_WORKING_CURVE_WORKING_CURVE_H
#define FUNICULAR_COUPLINGS_WORKING_CURVE_WORKING_CURVE_H

#include "couplings/common/coupling.h"

#define FU_WORKING_CURVE_POINTS 5 /* of an element: those of the law's axial force */

/* The working curves of an element of a rope. In a state its numbers are the highest strains of the points. */
typedef struct {
    fu_coupling base;
    const fu_working_curve_kernels *kernel;
    int cable, element;
    int remembers;    /* whether the highest strains rise, as in all motions but those that search for rest */
    double permanent; /* permanent strain by the highest one */
    double highest[FU_WORKING_CURVE_POINTS]; /* highest strains before the start */
    double weights[FU_WORKING_CURVE_POINTS]; /* of the points, m */
    const double *N_x;                       /* (points x vectors of an element): derivatives of the shape functions */
    const double *first, *shape;             /* tables of first loading, N, and of the shape of the curves */
} fu_working_curve;
extern const fu_coupling_type fu_working_curve_type;

#endif
