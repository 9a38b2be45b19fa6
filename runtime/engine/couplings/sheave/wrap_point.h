/* Points of the wrap of a rope at which friction sticks: couplings/sheave/wrap_point.c. */
#ifndef FUNICULAR_COUPLINGS_SHEAVE_WRAP_POINT_H
#define FUNICULAR_COUPLINGS_SHEAVE_WRAP_POINT_H

#include "couplings/sheave/sheave.h"

/* The end of a zone of a sheave: the number of the sheave among all couplings; its place in the wrap. Its flag is its
 * mode. */
typedef struct {
    fu_coupling base;
    int sheave, place;
} fu_wrap_point;
extern const fu_coupling_type fu_wrap_point_type;

/* Modes of a point: without friction, as in statics where no rope is about to slide; others are directions. */
enum { FU_SLIDES_BACKWARDS = -1, FU_POINT_IS_FREE, FU_SLIDES_FORWARDS, FU_STICKS };

int *fu_wrap_point_flag(const fu_coupling *coupling, const fu_state *state);
/* Return the place of a point in its wrap; its sheave. */
int fu_place_of_point(const fu_coupling *coupling);
const fu_sheave *fu_sheave_of_point(const fu_model *model, const fu_coupling *coupling);
/* Computes Coulomb friction at a point in a state. */
void fu_wrap_point_at(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_coulomb *out);

#endif
