/* Tension-only cables: the first of a cable's elements becomes slack, and all are taut again, by the axial strain in
 * the middle of each. The law is smooth: steps do not end there, and the instant is interpolated linearly between the
 * least strains at both ends of a step. */
#include "bodies/growth.h"
#include "equations/run.h"
#include "events/slack_cables.h"

#include <math.h>

/* Returns the axial strain in the middle of an element, the length of the slope less 1. */
static double strain(const fu_cable *cable, const double *q, int element)
{
    const double l = fu_element_length(cable, element), *e = q + fu_element_entry(cable, element);
    const int dim = cable->kernel->dim, n = cable->coordinates / dim;
    double N[FU_MAX_COORDINATES], N_x[FU_MAX_COORDINATES], slope[3] = {0.0, 0.0, 0.0};
    cable->kernel->on_axis(l, 0.5 * l, N, N_x);
    for (int k = 0; k < n; ++k)
        for (int d = 0; d < dim; ++d) slope[d] += N_x[k] * e[k * dim + d];
    return sqrt(fu_dot(dim, slope, slope)) / (cable->growth < 0 ? 1.0 : fu_growth(cable, element, q)) - 1.0;
}

/* Returns the least strain of a cable's elements, and its element. */
static double least_strain(const fu_cable *cable, const double *q, int *element)
{
    double least = INFINITY;
    *element = 0;
    for (int k = 0; k < cable->n_elements; ++k) {
        const double here = strain(cable, q, k);
        if (!(here < least)) continue;
        least = here;
        *element = k;
    }
    return least;
}

/* Records the state of cables at the start of a run. */
void fu_begin_slackness(fu_run *run)
{
    for (int c = 0; c < run->model->n_cables; ++c) {
        fu_slackness *of = &run->slackness[c];
        *of = (fu_slackness){0};
        if (!run->model->cables[c].tension_only) continue;
        of->least = least_strain(&run->model->cables[c], run->now.q, &of->element);
        of->is_slack = of->least < -FU_SLACK_STRAIN;
    }
}

/* Records changes between slack and taut in the step that is about to be accepted. */
void fu_note_slackness(fu_run *run, double h)
{
    for (int c = 0; c < run->model->n_cables; ++c) {
        fu_slackness *of = &run->slackness[c];
        if (!run->model->cables[c].tension_only) continue;
        int element;
        const double before = of->least, limit = of->is_slack ? 0.0 : -FU_SLACK_STRAIN;
        of->least = least_strain(&run->model->cables[c], run->next.q, &element);
        if (of->is_slack != (of->least < limit)) {
            of->is_slack = !of->is_slack;
            of->pending = of->is_slack ? 1 : -1;
            of->at = run->now.t + h * fmin(fmax((limit - before) / (of->least - before), 0.0), 1.0);
            if (of->is_slack) of->element = element;
        } else if (of->is_slack) of->element = element;
    }
}

/* Computes the earliest unreported change, if it is before an instant, the event of the run; returns 0 if there is
 * none. */
int fu_take_slackness(fu_run *run, double before)
{
    fu_slackness *first = 0;
    for (int c = 0; c < run->model->n_cables; ++c) {
        fu_slackness *of = &run->slackness[c];
        if (of->pending && of->at < (first ? first->at : before)) first = of;
    }
    if (!first) return 0;
    const char *what = first->pending > 0 ? "became slack" : "all taut again";
    run->event = (fu_event){FU_WENT_SLACK, (int)(first - run->slackness), first->element, what};
    run->event_time = first->at;
    first->pending = 0;
    return 1;
}

/* Returns whether data from a file are possible. */
int fu_possible_slackness(const fu_run *run)
{
    for (int c = 0; c < run->model->n_cables; ++c) {
        const fu_slackness *of = &run->slackness[c];
        if (!isfinite(of->least) || !isfinite(of->at) || (of->is_slack != 0 && of->is_slack != 1) || of->pending != 0 ||
            of->element < 0 || of->element >= run->model->cables[c].n_elements)
            return 0;
    }
    return 1;
}
