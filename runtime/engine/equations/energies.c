/* Inertia and energies of a whole scene: of cables and bodies, and of couplings. */
#include "couplings/common/couplings.h"
#include "equations/equations.h"

/* Computes f = M a. */
void fu_mass_times(const fu_model *model, double t, const double *q, const double *a, double *f)
{
    fu_constant_mass_times(model, q, a, f);
    fu_coupling_inertia(model, t, q, a, f);
}

/* Returns the kinetic energy at the velocities v, J, with that of added mass. */
double fu_kinetic_energy(const fu_model *model, double t, const double *q, const double *v)
{
    return fu_constant_kinetic_energy(model, q, v) + fu_coupling_kinetic_energy(model, t, q, v, 1);
}

/* Returns the kinetic energy of a state, J, with that of momenta which are history variables. */
double fu_kinetic_energy_at(const fu_model *model, const fu_state *state)
{
    return fu_kinetic_energy(model, state->t, state->q, state->v) + fu_kinetic_energy_beyond_velocities(model, state);
}

/* Returns v' M v/2 of a change v of velocities, J. */
double fu_kinetic_energy_of_change(const fu_model *model, double t, const double *q, const double *v)
{
    return fu_constant_kinetic_energy(model, q, v) + fu_coupling_kinetic_energy(model, t, q, v, 0);
}

/* Returns the power dissipated by damping and friction, W; work: see `dissipation` in coupling.h. */
double fu_dissipation(const fu_model *model, const fu_state *state, const fu_accelerator *work)
{
    return fu_internal_dissipation(model, state->q, state->v) + fu_coupling_dissipation(model, state, work);
}

/* Returns the energy stored in cables, bodies and couplings, J. */
double fu_elastic_energy(const fu_model *model, const fu_state *state)
{
    return fu_constant_elastic_energy(model, state->q) + fu_coupling_energy(model, state);
}
