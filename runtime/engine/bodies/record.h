/* Rows of output, one per output time: their arrays, described once. */
#ifndef FUNICULAR_BODIES_RECORD_H
#define FUNICULAR_BODIES_RECORD_H

#include "base/common.h"

/* ARRAY(name, axes: 1 for a number per row, items of a row) */
#define FU_RECORD_ARRAYS(ARRAY)                                                                                        \
    ARRAY(time, 1, 1)                                                                                                  \
    ARRAY(kinetic, 1, 1)                                                                                               \
    ARRAY(elastic, 1, 1)                                                                                               \
    ARRAY(potential, 1, 1)                                                                                             \
    ARRAY(dissipated, 1, 1)                                                                                            \
    ARRAY(q, 2, model->n_q)                                                                                            \
    ARRAY(v, 2, model->n_dof)                                                                                          \
    ARRAY(acceleration, 2, model->n_dof)                                                                               \
    ARRAY(reaction, 2, model->n_dof)                                                                                   \
    ARRAY(external, 1, 1)                                                                                              \
    ARRAY(s, 2, model->n_coordinates)                                                                                  \
    ARRAY(output, 2, model->n_outputs) /* of each coupling n_outputs of its type from `output` on */

typedef struct {
    int n;     /* rows recorded since the start */
    int first; /* the first row in the arrays: earlier ones have been removed */
    int pause; /* the number of rows at which fu_advance returns, for the caller to call fu_pause */
    int every; /* fu_advance pauses and goes on at that number and after each of these rows; 0: it returns */
#define FU_MEMBER(name, axes, items) double *name;
    FU_RECORD_ARRAYS(FU_MEMBER)
#undef FU_MEMBER
} fu_record;

enum {
#define FU_COUNT(name, axes, items) +1
    FU_N_RECORD_ARRAYS = 0 FU_RECORD_ARRAYS(FU_COUNT)
#undef FU_COUNT
};

/* bodies/state.c */
fu_array fu_record_array(const fu_model *model, const fu_record *record, int k);
void fu_record_attach(fu_record *record, int k, double *data);
int fu_record_is_finite(const fu_model *model, const fu_record *record, long row);

#endif
