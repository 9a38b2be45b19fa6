/* What each slide and each joint costs by itself: its terms of residual, Newton matrix and eq 38 are timed where the run
 * has stopped, which changes nothing of it, and multiplied by how often the run made them. Solving for its unknowns is not
 * in it.
 */
#include "engine.h"

#define BUDGET 5e-4 /* s, for all that is timed */
#define BATCHES 4   /* the fastest counts: the machine may be busy */
#define MOST 100    /* calls in a batch */

enum { RESIDUAL, TANGENT, TERMS, ARC_LENGTH, WORKS };

static void work_of_slide(const fu_run *run, int j, int what)
{
    const fu_model *model = run->model;
    const fu_state *now = &run->now;
    double phi[3], J[3 * (FU_SLIDE_COORDINATES + 1)], K[(FU_SLIDE_COORDINATES + 1) * (FU_SLIDE_COORDINATES + 1)];
    double s = now->s[j];
    fu_slide_state slide_state;
    if (what == RESIDUAL) {
        fu_slide_residual(model, now, j, phi, K);
        if (model->slides[j].resistance && now->mode[j] == FU_SLIDES) fu_slide_tangent(model, now, j, now->f + 3 * j, J, K);
    } else if (what == TANGENT) fu_slide_tangent(model, now, j, now->f + 3 * j, J, K);
    else if (what == TERMS) fu_slide_now(model, now, j, &slide_state);
    else fu_find_arc_length(model, now, j, &s);
}

static void work_of_link(const fu_run *run, int k, int what)
{
    const fu_joint *joint = &run->model->joints[k];
    double phi[6], J[6 * 2 * FU_ATTACHMENT_COORDINATES], K[4 * FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES];
    int at[2 * FU_SLIDE_COORDINATES];
    fu_rows rows;
    if (what == RESIDUAL) fu_joint_residual(run->model, joint, &run->now, phi, at, J);
    else if (what == TANGENT) fu_joint_tangent(run->model, joint, &run->now, at, J, K);
    else if (what == TERMS)
        fu_joint_terms(run->model, joint, &run->now, run->accelerator.slide_states, run->accelerator.rows, &rows);
}

/* seconds of one call; of many parts each has little time, and the first call tells */
static double timed(const fu_run *run, void (*work)(const fu_run *, int, int), int k, int what, double budget)
{
    double begin = fu_clock();
    work(run, k, what);
    double fastest = fu_clock() - begin;
    const double fit = budget / (BATCHES * fmax(fastest, 1e-8));
    const int calls = fit > MOST ? MOST : (int)fit;
    for (int b = 0; b < BATCHES && calls; ++b) {
        begin = fu_clock();
        for (int i = 0; i < calls; ++i) work(run, k, what);
        fastest = fmin(fastest, (fu_clock() - begin) / calls);
    }
    return fastest;
}

/* seconds a step: of each slide, then of each joint between ends */
void fu_part_timing(const fu_run *run, double *seconds)
{
    const fu_model *model = run->model;
    const fu_statistics *s = &run->statistics;
    const long n = model->n_slides + model->n_joints;
    /* methods that iterate on residuals make eq 38 at outputs and at starts alone, the others in each evaluation */
    const double counts[WORKS] = {s->evaluations ? 0.0 : (double)s->newton_iterations, (double)s->factorisations,
                                  (double)run->accelerator.evaluated, (double)s->evaluations};
    for (int k = 0; k < n; ++k) {
        const int slide = k < model->n_slides;
        seconds[k] = 0.0;
        for (int what = 0; what < WORKS; ++what)
            if (counts[what] > 0.0 && s->steps > 0)
                seconds[k] += counts[what] / (double)s->steps
                              * timed(run, slide ? work_of_slide : work_of_link, slide ? k : k - model->n_slides, what,
                                      BUDGET / (double)(n * WORKS));
    }
}
