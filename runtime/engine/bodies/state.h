/* State of the motion at one instant: its arrays, described once. */
#ifndef FUNICULAR_BODIES_STATE_H
#define FUNICULAR_BODIES_STATE_H

#include "base/common.h"

/* The couplings' part of a state, which the first guess of a step copies: ARRAY(type, name, items of a model). */
#define FU_STATE_OF_COUPLINGS(ARRAY)                                                                                   \
    /* internal forces of couplings: on the rider of a slide, multipliers of a joint, on a spring's first end */       \
    ARRAY(double, forces, model->n_forces)                                                                             \
    ARRAY(int, segment, model->n_coordinates) /* per coordinate of a coupling: its path segment (coupling_events.h) */ \
    /* private data of a coupling's type, n_numbers and n_flags of it */                                               \
    ARRAY(double, numbers, model->n_numbers)                                                                           \
    ARRAY(int, flags, model->n_flags)

/* All arrays of a state. */
#define FU_STATE_ARRAYS(ARRAY)                                                                                         \
    ARRAY(double, q, model->n_q)                                                                                       \
    ARRAY(double, v, model->n_dof)                                                                                     \
    ARRAY(double, acceleration, model->n_dof)                                                                          \
    ARRAY(double, a, model->n_dof)         /* the integrator's auxiliary acceleration */                               \
    ARRAY(double, s, model->n_coordinates) /* coordinates of couplings: of each slide the arc-length, m */             \
    FU_STATE_OF_COUPLINGS(ARRAY)                                                                                       \
    /* of algorithmic dissipation (integrators/algorithmic_dissipation.c) */                                           \
    ARRAY(double, dissipation_state, model->n_dissipation_state)

struct fu_state {
    double t; /* s */
#define FU_MEMBER(type, name, items) type *name;
    FU_STATE_ARRAYS(FU_MEMBER)
#undef FU_MEMBER
};

enum {
#define FU_COUNT(type, name, items) +1
    FU_N_STATE_ARRAYS = 0 FU_STATE_ARRAYS(FU_COUNT)
#undef FU_COUNT
};

/* bodies/state.c */
fu_array fu_state_array(const fu_model *model, const fu_state *state, int k);
void fu_state_attach(fu_state *state, int k, void *data);
int fu_all_finite(const double *numbers, long n);
void fu_state_take_couplings(const fu_model *model, fu_state *to, const fu_state *from);

#endif
