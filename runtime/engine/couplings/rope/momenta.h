/* Momenta of the material of a rope, over the mass of a length: history variables of steps that conserve energy. */
#ifndef FUNICULAR_COUPLINGS_ROPE_MOMENTA_H
#define FUNICULAR_COUPLINGS_ROPE_MOMENTA_H

#include "couplings/common/coupling.h"

/* Known at the time t alone: another method leaves them behind. */
typedef struct {
    double t, is_known, P[];
} fu_momenta;

enum { FU_MOMENTA_HEAD = sizeof(fu_momenta) / sizeof(double) };

static inline fu_momenta *fu_momenta_of(const fu_coupling *coupling, const fu_state *state)
{
    return (fu_momenta *)(state->numbers + coupling->numbers);
}

static inline int fu_momenta_are_known(const fu_momenta *momenta, const fu_state *state)
{
    return momenta->is_known && momenta->t == state->t;
}

static inline void fu_know_momenta(fu_momenta *momenta, const fu_state *state)
{
    momenta->t = state->t;
    momenta->is_known = 1.0;
}

#endif
