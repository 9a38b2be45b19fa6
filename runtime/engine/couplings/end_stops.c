/* Slides that stick, break loose, or come to what waits at an end of their cable: events that change what locks s.
 *
 * mode is FU_SLIDES, FU_LOCKED (where it is: by friction that sticks, or against a hard stop, contact then tells which) or
 * FU_LEFT. slip_direction is that of sliding where friction sticks at rest: known then, as a change of it is an event.
 */
#include "engine.h"

#include <string.h>

#define AT_REST 1e-12 /* of the cable over the duration: speeds below are none */
#define BOUNCE 1e-6   /* of the cable: what would come no farther back stays at the stop */

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

/* The force on the rider of a slide that is locked: by eq 38, as a Newton method's has the rounding of positions over h^2.
 * Returns whether it is by eq 38: then `traction` is what of it is along the cable, without what moments put there. */
static int locked_force(const fu_run *run, const fu_state *state, int j, double *f, double *traction)
{
    const fu_model *model = run->model;
    memcpy(f, state->forces + model->slides[j].base.force, sizeof(double) * (size_t)model->dim);
    if (!run->integrator->newton && !fu_ties_a_frame(model, j)) return 0;
    fu_accelerator work = run->accelerator;
    fu_slide_output out;
    if (fu_accelerations(model, state, &work, run->work, 0)) return 0;
    fu_slide_outputs(model, state, j, run->work, &work, &out);
    memcpy(f, out.force, sizeof(double) * (size_t)model->dim);
    *traction = out.traction;
    return 1;
}

/* Force along the cable on a locked slide, and how much of it neither friction nor a hard stop can take. */
static double excess(const fu_run *run, const fu_state *state, int j, double *pull)
{
    const fu_model *model = run->model;
    const fu_slide *slide = &model->slides[j];
    const int dim = model->dim, side = state->contact[j];
    double f[3], square = 0.0, along = 0.0, normal = 0.0, traction = 0.0;
    const int by_eq38 = locked_force(run, state, j, f, &traction);
    fu_slide_state slide_state;
    fu_slide_now(model, state, j, &slide_state);
    const double *G = slide_state.by_point + (dim - 1) * dim; /* i/|r_x| */
    for (int d = 0; d < dim; ++d) square += G[d] * G[d];
    for (int d = 0; d < dim; ++d) along += f[d] * G[d] / sqrt(square);
    for (int d = 0; d < dim; ++d) {
        const double across = f[d] - along * G[d] / sqrt(square);
        normal += across * across;
    }
    /* friction does not take what moments put along the cable */
    if (by_eq38 && fu_ties_a_frame(model, j)) along = traction;
    const double most = slide->static_friction * sqrt(normal);
    if (side && !is_hard(model, j, side)) /* the buffer's part */
        along += side * slide->stops[side > 0].stiffness * fu_compression(model, state, j, side) * sqrt(square);
    *pull = along;
    return (is_hard(model, j, side) ? side * along : fabs(along)) - most;
}

/* What is watched: negative as long as a slide stays locked, or slides on in its direction. */
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

/* Unlock a slide, on which there was the force `pull` along the cable. */
static void release(fu_run *run, int j, double pull)
{
    fu_state *now = &run->now;
    const int side = now->contact[j], hard = is_hard(run->model, j, side);
    now->mode[j] = FU_SLIDES;
    now->slip_direction[j] = !run->model->slides[j].sticks ? 0 : hard ? -side : pull > 0.0 ? -1 : 1;
    if (hard) now->contact[j] = 0;
}

/* Lock a slide that is at rest, if friction or its stop can take the force on it, else let it slide on; the status. */
static int try_to_stick(fu_run *run, int j)
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

/* the direction of sliding of each slide whose friction needs it */
static void find_slip_directions(fu_run *run)
{
    fu_state *now = &run->now;
    for (int j = 0; j < run->model->n_slides; ++j) {
        const double rate = fu_slide_rate(run->model, now, j);
        if (run->model->slides[j].sticks && now->mode[j] == FU_SLIDES && rate != 0.0)
            now->slip_direction[j] = rate > 0.0 ? 1 : -1;
    }
}

/* At the start: which slides are in a buffer, and which stick. */
int fu_begin_stops(fu_run *run)
{
    const fu_model *model = run->model;
    find_slip_directions(run);
    for (int j = 0; j < model->n_slides; ++j) {
        if (model->slides[j].drive >= 0) continue;
        for (int side = -1; side <= 1; side += 2)
            if (model->slides[j].stops[side > 0].kind == FU_END_IS_BUFFERED &&
                fu_buffer_margin(run, &run->now, j, side) > 0.0)
                run->now.contact[j] = side;
        if (model->slides[j].sticks && is_at_rest(run, j) && try_to_stick(run, j)) return FU_SINGULAR;
    }
    return FU_RUNNING;
}

/* A slide comes to its hard stop; it stays there where it would come back no farther than counts. */
static int strike(fu_run *run, int j, int side)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    fu_slide_state slide_state;
    fu_slide_output slide;
    now->contact[j] = side;
    if (side * fu_slide_rate(model, now, j) > 0.0) {
        now->mode[j] = FU_LOCKED;
        now->locked_s[j] = now->s[j];
        const double restitution = model->slides[j].stops[side > 0].restitution;
        fu_slide_now(model, now, j, &slide_state);
        if (fu_strike(model, now, &run->accelerator, model->slides[j].base.row, model->dim - 1,
                      restitution * slide_state.s_rate, run->work)) return FU_SINGULAR;
        fu_impact(run, run->work, restitution);
    }
    release(run, j, 0.0);
    if (fu_complete(run, now)) return FU_SINGULAR;
    fu_slide_outputs(model, now, j, now->acceleration, &run->accelerator, &slide);
    const double back = -side * slide.s_rate, push = side * slide.s_acceleration;
    if (is_at_rest(run, j) || back * back <= 2.0 * push * BOUNCE * fu_length(model, j)) {
        now->contact[j] = side;
        if (try_to_stick(run, j)) return FU_SINGULAR;
    }
    find_slip_directions(run);
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
        run->stopped_slide = j;
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
    const int status = try_to_stick(run, j);
    *what = now->mode[j] == FU_LOCKED ? FU_STUCK : FU_TURNED;
    return status;
}
