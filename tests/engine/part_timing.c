/* The cost of a coupling by a scripted clock: a call takes 4 µs, and the first one is interrupted for 56 ms. Prints the
 * seconds a step; tests/engine/test_part_timing.py.
 */
#define fu_clock scripted_clock
#include "run/part_timing.c"

#include <stdio.h>

static double now;
static int calls;

double scripted_clock(void)
{
    return now;
}

double *fu_internal_unknowns(fu_run *run)
{
    (void)run;
    return 0;
}

static void rows(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_accelerator *work)
{
    (void)model, (void)coupling, (void)state, (void)work;
    now += calls++ == 0 ? 0.056 : 4e-6;
}

int main(void)
{
    const fu_coupling_type type = {.rows = rows};
    const fu_coupling coupling = {.type = &type, .row = 0};
    const fu_coupling *couplings[] = {&coupling};
    const fu_model model = {.n_couplings = 1, .couplings = couplings};
    static fu_run run;
    double seconds;
    run.model = &model;
    run.statistics.steps = run.accelerator.evaluated = 10;
    fu_part_timing(&run, &seconds);
    printf("%.9g\n", seconds);
    return 0;
}
