/* Time of each coupling: run/part_timing.c. */
#ifndef FUNICULAR_RUN_PART_TIMING_H
#define FUNICULAR_RUN_PART_TIMING_H

#include "base/common.h"

void fu_part_timing(fu_run *run, double *seconds);

#endif
