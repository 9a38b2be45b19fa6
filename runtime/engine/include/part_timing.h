/* Time that each slide and each joint takes: run/part_timing.c. */
#ifndef FUNICULAR_PART_TIMING_H
#define FUNICULAR_PART_TIMING_H

#include "common.h"

void fu_part_timing(const fu_run *run, double *seconds);

#endif
