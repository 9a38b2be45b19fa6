/* Algorithmic dissipation of the energy-momentum method: integrators/algorithmic_dissipation.c. */
#ifndef FUNICULAR_ALGORITHMIC_DISSIPATION_H
#define FUNICULAR_ALGORITHMIC_DISSIPATION_H

#include "common.h"

/* Of the energy-momentum method, integrators/algorithmic_dissipation.c; weight: of a change of strain in the stress, zero: there is none. */
typedef struct {
    double lag, viscosity, inertia, weight;
    double *expected; /* like the memory: what the velocities at the start of the step would change, and its energy */
} fu_algorithmic;

void fu_algorithmic_start(fu_run *run, double h);
void fu_algorithmic_forces(fu_run *run, const double *q, double *force);
double fu_algorithmic_account(fu_run *run, const double *q);

#endif
