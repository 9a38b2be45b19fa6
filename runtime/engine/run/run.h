/* Public: the time loop of a run: run/run.c; inputs: run/inputs.c; checkpoints: run/checkpoint.c; time of each
 * coupling: run/part_timing.c. */
#ifndef FUNICULAR_RUN_RUN_H
#define FUNICULAR_RUN_RUN_H

#include "base/common.h"
#include "equations/run.h"

/* A value since a time, s, and its rate, 1/s; is_new: it has been given since the last step. */
typedef struct {
    double since, value, rate;
    int is_new;
} fu_input;

/* factor times an input, or its integral over time */
typedef struct {
    int input, is_integral;
    double factor;
} fu_input_term;

/* A signal of one piece: a constant and `n` terms from number `first` on. drives: it prescribes a motion, or its rate
 * acts as a force: it cannot jump, and reaches its value at the end of a step. */
typedef struct {
    int signal, drives, first, n;
    double constant;
} fu_input_signal;

struct fu_inputs {
    int n, n_signals;
    fu_input *inputs;
    const fu_input_signal *signals;
    const fu_input_term *terms;
};

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

/* run/inputs.c: values of signals that are given from outside while a run goes on */
void fu_set_input(fu_run *run, int k, double value, double rate);
double fu_input_value(const fu_run *run, int k);
int fu_is_position(const fu_run *run, int k);
int fu_give_inputs(fu_run *run, double until);

/* run/part_timing.c: time of each coupling */
void fu_part_timing(fu_run *run, double *seconds);

#endif
