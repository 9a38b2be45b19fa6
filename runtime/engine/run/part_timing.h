/* Time that each coupling takes: run/part_timing.c. */
#ifndef FUNICULAR_PART_TIMING_H
#define FUNICULAR_PART_TIMING_H

#include "common.h"

void fu_part_timing(fu_run *run, double *seconds);

#endif
