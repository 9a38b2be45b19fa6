/* Algorithmic dissipation of the energy-momentum method: integrators/algorithmic_dissipation.c. */
#ifndef FUNICULAR_INTEGRATORS_ALGORITHMIC_DISSIPATION_H
#define FUNICULAR_INTEGRATORS_ALGORITHMIC_DISSIPATION_H

#include "base/common.h"

/* The parameters of the energy-momentum method. weight: of a change of strain in the stress; zero without algorithmic
 * dissipation. */
typedef struct {
    double lag, viscosity, inertia, weight;
} fu_algorithmic;
_Static_assert(sizeof(fu_algorithmic) == 4 * sizeof(double), "parameters are an array of doubles");

const fu_algorithmic *fu_algorithmic_of(const fu_run *run);
long fu_algorithmic_state(const fu_run *run);
void fu_algorithmic_start(fu_run *run, double h);
void fu_algorithmic_forces(fu_run *run, const double *q, double *force);
double fu_algorithmic_account(fu_run *run, const double *q);

#endif
