/* Spans over their elements: span.c, and span_step.c over a step that conserves energy. */
#ifndef FUNICULAR_COUPLINGS_ROPE_SPAN_H
#define FUNICULAR_COUPLINGS_ROPE_SPAN_H

#include "couplings/rope/rope.h"

enum { FU_SPAN_ENDS = 2 };

static inline const fu_span_coupling *fu_span_of(const fu_coupling *coupling)
{
    return (const fu_span_coupling *)coupling;
}

/* An element at a configuration q, and its motion with the rates v and accelerations a of the dofs; null: zero. */
typedef struct {
    int at; /* first dof */
    double l;
    const double *e, *v, *a;
    double s_rate[FU_SPAN_ENDS], s_acc[FU_SPAN_ENDS];
} fu_span_element;

fu_span_element fu_span_element_at(const fu_model *model, const fu_span_coupling *span, int k, const double *q,
                                   const double *v, const double *a);
/* Computes numbers of the ends of an element from those of the ends of the span. */
void fu_span_at_ends(const fu_span_coupling *span, int k, const double *dofs, double out[FU_SPAN_ENDS]);
/* Adds forces on an element, and on its ends (null: none) and its length, to those on the dofs. */
void fu_span_add_force(const fu_span_coupling *span, int k, int at, const double *of_e, const double *of_ends,
                       double of_length, double *f);

/* --- span_step.c --- */

int fu_span_history_size(const fu_coupling *coupling);
void fu_span_history_over_step(const fu_model *model, const fu_coupling *coupling, const fu_equations *at);
void fu_span_history_jump(const fu_model *model, const fu_coupling *coupling, fu_state *state, const double *change);
double fu_span_energy_beyond_velocities(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
void fu_span_step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                           double *internal);
double fu_span_step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at);

#endif
