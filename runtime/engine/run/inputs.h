/* Public: inputs, values of signals that are given from outside while a run goes on: run/inputs.c. */
#ifndef FUNICULAR_RUN_INPUTS_H
#define FUNICULAR_RUN_INPUTS_H

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

void fu_set_input(fu_run *run, int k, double value, double rate);
double fu_input_value(const fu_run *run, int k);
int fu_is_position(const fu_run *run, int k);
int fu_give_inputs(fu_run *run, double until);

#endif
