/* Spans over their elements: span.c, and span_step.c over a step that conserves energy. */
#ifndef FUNICULAR_COUPLINGS_ROPE_SPAN_H
#define FUNICULAR_COUPLINGS_ROPE_SPAN_H

#include "couplings/rope/rope.h"

static inline const fu_span_coupling *fu_span_of(const fu_coupling *coupling)
{
    return (const fu_span_coupling *)coupling;
}

/* --- span_step.c --- */

int fu_span_history_size(const fu_coupling *coupling);
void fu_span_history_over_step(const fu_model *model, const fu_coupling *coupling, const fu_equations *at);
void fu_span_history_jump(const fu_model *model, const fu_coupling *coupling, fu_state *state, const double *change);
double fu_span_energy_beyond_velocities(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
void fu_span_step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                           double *internal);
double fu_span_step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at);

#endif
