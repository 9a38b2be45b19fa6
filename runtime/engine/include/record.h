/* Rows of output. */
#ifndef FUNICULAR_RECORD_H
#define FUNICULAR_RECORD_H

#include "common.h"

/* Rows of output, one an output time; output: of each coupling n_outputs of its type from `output` on. */
typedef struct {
    int n;     /* rows recorded since the start */
    int first; /* the row that stands first in the arrays: those before it were taken away */
    int pause; /* at so many rows fu_advance returns, for the caller to call fu_pause */
    double *time, *q, *v, *acceleration, *reaction, *s, *output;
    double *kinetic, *elastic, *potential, *dissipated, *external;
} fu_record;

#endif
