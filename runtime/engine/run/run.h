/* Public: the time loop of a run: run/run.c; checkpoints: run/checkpoint.c; time of each coupling:
 * run/part_timing.c. */
#ifndef FUNICULAR_RUN_RUN_H
#define FUNICULAR_RUN_RUN_H

#include "base/common.h"
#include "equations/run.h"

/* run/record.c */
int fu_record_row(fu_run *run);
int fu_stop(fu_run *run);

/* run/start.c */
int fu_prepare(fu_run *run);
int fu_start(fu_run *run);
int fu_start_scheme(fu_run *run, int project);

/* run/event_handling.c */
int fu_handle_event(fu_run *run, fu_event event);

/* run/breakpoints.c */
const fu_breakpoint *fu_next_breakpoint(const fu_run *run, double latest);
int fu_pass_breakpoint(fu_run *run, const fu_breakpoint *breakpoint, int event);

/* run/steps.c */
int fu_step_towards(fu_run *run, double target);

/* run/run.c: the time loop */
int fu_has_worked(const fu_run *run);
int fu_advance(fu_run *run, double seconds);
int fu_reach(fu_run *run, double time, double seconds);

/* run/checkpoint.c: all data on which later steps depend */
void fu_pause(fu_run *run);
long fu_save(const fu_run *run, char *bytes);
int fu_restore(fu_run *run, const char *bytes, int rows, int between);

/* run/part_timing.c: time of each coupling */
void fu_part_timing(fu_run *run, double *seconds);

#endif
