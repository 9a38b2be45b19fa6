/* Inertia and energies of a whole scene: equations/energies.c. */
#ifndef FUNICULAR_EQUATIONS_ENERGIES_H
#define FUNICULAR_EQUATIONS_ENERGIES_H

#include "bodies/model.h"
#include "couplings/common/accelerator.h"

void fu_mass_times(const fu_model *model, const double *q, const double *a, double *f);
double fu_kinetic_energy(const fu_model *model, double t, const double *q, const double *v);
double fu_kinetic_energy_of_change(const fu_model *model, const double *q, const double *v);
double fu_elastic_energy(const fu_model *model, const fu_state *state);
double fu_dissipation(const fu_model *model, const fu_state *state, const fu_accelerator *work);

#endif
