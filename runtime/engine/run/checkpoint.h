/* All data on which later steps depend: run/checkpoint.c. */
#ifndef FUNICULAR_RUN_CHECKPOINT_H
#define FUNICULAR_RUN_CHECKPOINT_H

#include "base/common.h"

void fu_pause(fu_run *run);
long fu_save(const fu_run *run, char *bytes);
int fu_restore(fu_run *run, const char *bytes, int rows);

#endif
