/* Momenta of the material of a rope, over the mass of a length: history variables of steps that conserve energy. */
#ifndef FUNICULAR_COUPLINGS_COMMON_MOMENTA_H
#define FUNICULAR_COUPLINGS_COMMON_MOMENTA_H

#include "couplings/common/coupling.h"

/* Known after a step that conserves energy; before, they are those of the velocities. */
typedef struct {
    double is_known, P[];
} fu_momenta;

enum { FU_MOMENTA_HEAD = sizeof(fu_momenta) / sizeof(double) };

static inline fu_momenta *fu_momenta_of(const fu_coupling *coupling, const fu_state *state)
{
    return (fu_momenta *)(state->numbers + coupling->numbers);
}

/* Computes the velocity of a dof after a step, whose momentum is not known by it, and its acceleration: linear through
 * the displacements over the last step and this one, each over its time. Velocities whose mean over a step is its
 * displacement keep an error with alternating signs, of which the estimate of errors would make short steps. */
static inline void fu_velocity_of_step(const fu_equations *at, double since, int dof)
{
    const double mean = at->psi[dof] / at->h, before = at->now->v[dof] - since * at->now->acceleration[dof];
    const double slope = (mean - before) / (0.5 * at->h + since);
    at->next->v[dof] = mean + 0.5 * at->h * slope;
    at->next->acceleration[dof] = slope;
}

#endif
