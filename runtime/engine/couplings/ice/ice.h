/* Ice on a cable, whose thickness is a signal: couplings/ice/ice.c. */
#ifndef FUNICULAR_COUPLINGS_ICE_ICE_H
#define FUNICULAR_COUPLINGS_ICE_ICE_H

#include "couplings/common/coupling.h"

/* Ice on elements of a cable, a ring of the thickness signal times factor. */
typedef struct {
    fu_coupling base;
    int cable, first, n_elements;    /* elements of the cable */
    int signal;                      /* -1: one */
    double factor;                   /* m */
    double diameter;                 /* of the cable, m */
    double density;                  /* kg/m^3 */
    double gravity[3], length;       /* length: of the cable under ice, m */
    int stride;                      /* of the tables from one element to the next: 1, 0 for equal elements */
    const double *products, *shares; /* integrals of N N' (vectors x vectors) and N (vectors) over an element, m */
} fu_ice;
extern const fu_coupling_type fu_ice_type;

/* Returns the thickness at a time, m; computes its rate, m/s. */
double fu_ice_thickness(const fu_model *model, int signal, double factor, double t, double *rate);

#endif
