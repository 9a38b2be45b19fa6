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

#endif
