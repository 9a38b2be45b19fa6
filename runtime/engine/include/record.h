/* Rows of output. */
#ifndef FUNICULAR_RECORD_H
#define FUNICULAR_RECORD_H

#include "common.h"

/* Rows of output, one an output time; joint: FU_SLIDE_OUTPUTS numbers a joint in the order of fu_slide_output. */
#define FU_SLIDE_OUTPUTS 11
#define FU_JOINT_OUTPUTS 7
typedef struct {
    int n;     /* rows recorded since the start */
    int first; /* the row that stands first in the arrays: those before it were taken away */
    int pause; /* at so many rows fu_advance returns, for the caller to call fu_pause */
    double *time, *q, *v, *acceleration, *reaction, *s, *slide, *joint;
    double *kinetic, *elastic, *potential, *dissipated, *external, *spring;
} fu_record;

#endif
