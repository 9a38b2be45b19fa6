/* Cost of each coupling: its terms of residual, Newton matrix and eq 38 are timed at the end of the run, which changes
 * only scratch memory, and multiplied by the number of evaluations. The solution for its unknowns is not included. */
#include "base/clock.h"
#include "equations/equations.h"
#include "equations/run.h"
#include "run/run.h"

#include <math.h>

#define BUDGET 1e-4      /* s, for all timings */
#define MAX_SHARE 0.02   /* of the time of the run that all timings may take: short runs are timed more coarsely */
#define BATCHES 4        /* of calls, of which the fastest counts, since the machine may be busy */
#define MAX_CALLS 100    /* calls in a batch */
#define MIN_CALLS 3      /* minimum of calls, each timed alone, since the machine may interrupt one */
#define MIN_SECONDS 1e-8 /* s: of a call, below the resolution of some clocks */

enum { RESIDUAL, TANGENT, ROWS, OWN_COORDINATES, WORKS };

/* Executes an operation of a coupling at `now`, with the contents of its work space. */
static void work_of(fu_run *run, const fu_coupling *c, int what)
{
    const fu_model *model = run->model;
    const fu_equations at = {.now = &run->now, .next = &run->now, .weights = {1.0, 0.0, 1.0}};
    if (what == RESIDUAL && c->type->residual) c->type->residual(model, c, &at, run->work, fu_internal_unknowns(run));
    if (what == TANGENT && c->type->tangent) c->type->tangent(model, c, &at, 0);
    if (what == ROWS && c->row >= 0) c->type->rows(model, c, &run->now, &run->accelerator);
    if (what == OWN_COORDINATES && c->type->coordinates) {
        double saved[FU_MAX_FORCES];
        for (int i = 0; i < c->n_coordinates; ++i) saved[i] = run->now.s[c->coordinate + i];
        c->type->coordinates->solve(model, c, &run->now);
        for (int i = 0; i < c->n_coordinates; ++i) run->now.s[c->coordinate + i] = saved[i];
    }
}

/* Returns the seconds of one call. If many parts share the budget, few single calls are timed. */
static double timed(fu_run *run, const fu_coupling *c, int what, double budget)
{
    double begin, fastest = INFINITY;
    for (int i = 0; i < MIN_CALLS; ++i) {
        begin = fu_clock();
        work_of(run, c, what);
        fastest = fmin(fastest, fu_clock() - begin);
    }
    const double fit = budget / (BATCHES * fmax(fastest, MIN_SECONDS));
    const int calls = fit > MAX_CALLS ? MAX_CALLS : (int)fit;
    for (int b = 0; b < BATCHES && calls; ++b) {
        begin = fu_clock();
        for (int i = 0; i < calls; ++i) work_of(run, c, what);
        fastest = fmin(fastest, (fu_clock() - begin) / calls);
    }
    return fastest;
}

/* Returns the budget of all timings, s. */
static double budget_of(const fu_statistics *s)
{
    const double taken = s->time_factor + s->time_solve + s->time_residual + s->time_step + s->time_error;
    return fmin(BUDGET, MAX_SHARE * taken);
}

/* Computes the seconds per step of each coupling. */
void fu_part_timing(fu_run *run, double *seconds)
{
    const fu_model *model = run->model;
    const fu_statistics *s = &run->statistics;
    /* methods with residuals evaluate eq 38 at outputs and starts alone, the others in each evaluation */
    const double counts[WORKS] = {s->evaluations ? 0.0 : (double)s->newton_iterations, (double)s->factorisations,
                                  (double)run->accelerator.evaluated, (double)s->evaluations};
    FU_EACH_COUPLING(c, model->couplings, model->n_couplings) {
        seconds[c->number] = 0.0;
        for (int what = 0; what < WORKS; ++what)
            if (counts[what] > 0.0 && s->steps > 0)
                seconds[c->number] += counts[what] / (double)s->steps *
                                      timed(run, c, what, budget_of(s) / (double)(model->n_couplings * WORKS));
    }
}
