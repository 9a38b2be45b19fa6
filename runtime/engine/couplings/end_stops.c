/* Slides that stick, break loose, or come to what waits at an end of their cable: events that change what holds s.
 *
 * mode is FU_SLIDES, FU_LOCKED (where it stands: by friction that sticks, or against a hard stop, contact then tells which),
 * FU_LEFT. way is the direction of sliding where friction sticks at rest: known then, as a change of it is an event.
 */
#include "engine.h"

#include <string.h>

#define AT_REST 1e-12 /* of the cable over the duration: speeds below are none */
#define BOUNCE 1e-6   /* of the cable: a stop holds what would come no farther back */

static int is_hard(const fu_model *model, int j, int side)
{
    return side && model->slides[j].stops[side > 0].kind == FU_END_IS_HARD;
}

/* whether such events can happen: steps then end where a slide passes a boundary, so that none is passed unseen */
int fu_has_stops(const fu_model *model)
{
    for (int j = 0; j < model->n_slides; ++j) {
        const fu_slide *slide = &model->slides[j];
        if (slide->resistance || slide->stops[0].kind || slide->stops[1].kind) return 1;
    }
    return 0;
}

/* The force on the rider of a slide that is held: by eq 38, as a Newton method's has the rounding of positions over h^2. */
static const double *held_force(const fu_run *run, const fu_state *state, int j)
{
    fu_slide_output *slides = (fu_slide_output *)run->accelerator.slides;
    if (!run->integrator->newton && !fu_ties_a_frame(run->model, j)) return state->f + 3 * j;
    fu_accelerator work = run->accelerator;
    return fu_accelerations(run->model, state, &work, run->work, slides, 0) ? state->f + 3 * j : slides[j].force;
}

/* Force along the cable that must be held where a slide is held, and how much of it friction and a hard stop do not. */
static double excess(const fu_run *run, const fu_state *state, int j, double *pull)
{
    const fu_model *model = run->model;
    const fu_slide *slide = &model->slides[j];
    const int dim = model->dim, side = state->contact[j];
    const double *f = held_force(run, state, j);
    double square = 0.0, along = 0.0, normal = 0.0;
    fu_slide_state slide_state;
    fu_slide_now(model, state, j, &slide_state);
    const double *G = slide_state.by_point + (dim - 1) * dim; /* i/|r_x| */
    for (int d = 0; d < dim; ++d) square += G[d] * G[d];
    for (int d = 0; d < dim; ++d) along += f[d] * G[d] / sqrt(square);
    for (int d = 0; d < dim; ++d) {
        const double across = f[d] - along * G[d] / sqrt(square);
        normal += across * across;
    }
    /* what moments put along the cable is not held by friction */
    if (fu_ties_a_frame(model, j)) along = ((const fu_slide_output *)run->accelerator.slides)[j].traction;
    const double grip = slide->static_friction * sqrt(normal);
    if (side && !is_hard(model, j, side)) /* the buffer's part */
        along += side * slide->stops[side > 0].stiffness * fu_compression(model, state, j, side) * sqrt(square);
    *pull = along;
    return (is_hard(model, j, side) ? side * along : fabs(along)) - grip;
}

/* What is watched: negative as long as a slide stays held, or goes on its way. */
double fu_stick_margin(const fu_run *run, const fu_state *state, int j)
{
    const fu_slide *slide = &run->model->slides[j];
    double pull;
    if (state->mode[j] == FU_LEFT || slide->drive >= 0) return -1.0;
    if (state->mode[j] == FU_LOCKED) return excess(run, state, j, &pull);
    return slide->sticks ? -state->slip_direction[j] * fu_slide_rate(run->model, state, j) : -1.0;
}

/* What is watched: positive where a slide is in a buffer that pushes. */
double fu_buffer_margin(const fu_run *run, const fu_state *state, int j, int side)
{
    const fu_end_stop *stop = &run->model->slides[j].stops[side > 0];
    if (state->mode[j] == FU_LEFT) return -1.0;
    const double x = fu_compression(run->model, state, j, side);
    const double force = stop->stiffness * x + stop->damping * side * fu_slide_rate(run->model, state, j);
    return fmin(x, force);
}

/* Let go of a slide that is held, against which `pull` was needed. */
static void release(fu_run *run, int j, double pull)
{
    fu_state *now = &run->now;
    const int side = now->contact[j], hard = is_hard(run->model, j, side);
    now->mode[j] = FU_SLIDES;
    now->slip_direction[j] = !run->model->slides[j].sticks ? 0 : hard ? -side : pull > 0.0 ? -1 : 1;
    if (hard) now->contact[j] = 0;
}

/* Hold a slide that stands still, if what holds it is enough, else let it go on; the status. */
static int settle(fu_run *run, int j)
{
    fu_state *now = &run->now;
    double pull;
    now->mode[j] = FU_LOCKED;
    now->locked_s[j] = now->s[j];
    if (fu_project_velocities(run->model, now, &run->accelerator, run->work)) return FU_SINGULAR;
    fu_impact(run, run->work, 0.0);
    if (fu_complete(run, now)) return FU_SINGULAR;
    if (excess(run, now, j, &pull) > 0.0) release(run, j, pull);
    return FU_RUNNING;
}

static int is_at_rest(const fu_run *run, int j)
{
    return fabs(fu_slide_rate(run->model, &run->now, j)) * run->duration <= AT_REST * fu_length(run->model, j);
}

/* the way that each slide goes whose friction needs it */
static void find_ways(fu_run *run)
{
    fu_state *now = &run->now;
    for (int j = 0; j < run->model->n_slides; ++j) {
        const double rate = fu_slide_rate(run->model, now, j);
        if (run->model->slides[j].sticks && now->mode[j] == FU_SLIDES && rate != 0.0) now->slip_direction[j] = rate > 0.0 ? 1 : -1;
    }
}

/* At the start: which slides are in a buffer, and which stick. */
int fu_begin_stops(fu_run *run)
{
    const fu_model *model = run->model;
    find_ways(run);
    for (int j = 0; j < model->n_slides; ++j) {
        if (model->slides[j].drive >= 0) continue;
        for (int side = -1; side <= 1; side += 2)
            if (model->slides[j].stops[side > 0].kind == FU_END_IS_BUFFERED && fu_buffer_margin(run, &run->now, j, side) > 0.0)
                run->now.contact[j] = side;
        if (model->slides[j].sticks && is_at_rest(run, j) && settle(run, j)) return FU_SINGULAR;
    }
    return FU_RUNNING;
}

/* A slide comes to its hard stop; it stays there where it would come back no farther than counts. */
static int strike(fu_run *run, int j, int side)
{
    const fu_model *model = run->model;
    const fu_slide_output *slide = (const fu_slide_output *)run->accelerator.slides + j;
    fu_state *now = &run->now;
    now->contact[j] = side;
    if (side * fu_slide_rate(model, now, j) > 0.0) {
        now->mode[j] = FU_LOCKED;
        now->locked_s[j] = now->s[j];
        if (fu_strike(model, now, &run->accelerator, j, run->work)) return FU_SINGULAR;
        fu_impact(run, run->work, model->slides[j].stops[side > 0].restitution);
    }
    release(run, j, 0.0);
    if (fu_complete(run, now)) return FU_SINGULAR;
    const double back = -side * slide->s_rate, push = side * slide->s_acceleration;
    if (is_at_rest(run, j) || back * back <= 2.0 * push * BOUNCE * fu_length(model, j)) {
        now->contact[j] = side;
        if (settle(run, j)) return FU_SINGULAR;
    }
    find_ways(run);
    return FU_RUNNING;
}

/* A slide that stands at an end of its cable goes on outwards; *what it does there. */
int fu_reach_end(fu_run *run, int j, int side, int *what)
{
    const fu_slide *slide = &run->model->slides[j];
    fu_state *now = &run->now;
    const int kind = slide->stops[side > 0].kind;
    if (kind == FU_END_IS_OPEN) {
        now->mode[j] = FU_LEFT;
        now->slip_direction[j] = now->contact[j] = 0;
        *what = FU_FLEW;
        return FU_RUNNING;
    }
    if (kind != FU_END_IS_HARD || slide->drive >= 0) {
        run->stopped_joint = j;
        return FU_END_OF_CABLE;
    }
    const int last = is_at_rest(run, j) || slide->stops[side > 0].restitution > 0.0, status = strike(run, j, side);
    *what = last && now->mode[j] == FU_LOCKED ? FU_RESTS : FU_STRUCK;
    return status;
}

/* What follows from a watch's passing to a side, and *what it is. */
int fu_act(fu_run *run, const fu_watch *watch, int side, int *what)
{
    fu_state *now = &run->now;
    const int j = watch->index;
    *what = FU_NOTHING;
    if (watch->kind == FU_WATCH_BUFFER) {
        now->contact[j] = side > 0 ? (int)watch->value : 0;
        *what = side > 0 ? FU_ENTERED : FU_CAME_OUT;
        return FU_RUNNING;
    }
    if (now->mode[j] == FU_LOCKED) {
        double pull;
        excess(run, now, j, &pull);
        *what = is_hard(run->model, j, now->contact[j]) ? FU_FREED : FU_BROKE_LOOSE;
        release(run, j, pull);
        return FU_RUNNING;
    }
    if (now->mode[j] != FU_SLIDES || !run->model->slides[j].sticks) return FU_RUNNING;
    const int status = settle(run, j);
    *what = now->mode[j] == FU_LOCKED ? FU_STUCK : FU_TURNED;
    return status;
}
