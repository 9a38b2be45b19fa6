/* Slides that stick, break loose, or reach the end of their cable: events that change the constraint on s.
 *
 * mode is FU_SLIDES, FU_LOCKED (by sticking friction, or against a hard stop; contact says which) or FU_LEFT.
 * slip_direction is the direction of sliding. For friction that sticks at rest it is known, since its change is an
 * event. */
#include "couplings/joint/joint.h"
#include "couplings/rope/rope.h"
#include "couplings/slide/slide.h"
#include "equations/equations.h"
#include "equations/run.h"
#include "events/end_stops.h"
#include "events/events.h"
#include "events/sticking.h"

#include <math.h>
#include <string.h>

#define REST_SPEED 1e-12 /* of the cable over the duration: smaller speeds are zero */
#define MIN_REBOUND 1e-6 /* of the cable: a rider with a smaller rebound stays at the stop */

static int is_hard(const fu_model *model, int j, int side)
{
    return side && model->slides[j].stops[side > 0].kind == FU_END_IS_HARD;
}

/* Computes the force on the rider of a locked slide by eq 38, since that of Newton's method has the rounding of
 * positions over h^2. Returns whether it is by eq 38: then `traction` is its component along the cable without the
 * effect of moments. */
static int locked_force(const fu_run *run, const fu_state *state, int j, double *f, double *traction)
{
    const fu_model *model = run->model;
    memcpy(f, state->forces + model->slides[j].base.force, sizeof(double) * (size_t)model->dim);
    if (!run->integrator->newton && !fu_ties_a_frame(model, j)) return 0;
    const double *acceleration = fu_event_accelerations(run, state);
    fu_slide_output out;
    if (!acceleration) return 0;
    fu_slide_outputs(model, state, j, acceleration, &run->accelerator, &out);
    memcpy(f, out.force, sizeof(double) * (size_t)model->dim);
    *traction = out.traction;
    return 1;
}

/* Computes the force along the cable on a locked slide, N; returns its excess over friction and hard stop, N. */
static double excess(const fu_run *run, const fu_state *state, int j, double *pull)
{
    const fu_model *model = run->model;
    const fu_slide *slide = &model->slides[j];
    const int dim = model->dim, side = fu_slide_flags_of(model, state, j)->contact;
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
    /* friction does not carry the effect of moments along the cable */
    if (by_eq38 && fu_ties_a_frame(model, j)) along = traction;
    const double scale = fu_scale_at(model, slide->friction_scale, state->t);
    const double most = scale * slide->static_friction * sqrt(normal);
    if (side && !is_hard(model, j, side)) /* the force of the buffer */
        along += side * slide->stops[side > 0].stiffness * fu_compression(model, state, j, side) * sqrt(square);
    *pull = along;
    return (is_hard(model, j, side) ? side * along : fabs(along)) - most;
}

/* Returns a number that is positive while a slide compresses a buffer. */
double fu_buffer_margin(const fu_run *run, const fu_state *state, int j, int side)
{
    const fu_end_stop *stop = &run->model->slides[j].stops[side > 0];
    if (fu_slide_flags_of(run->model, state, j)->mode == FU_LEFT) return -1.0;
    const double x = fu_compression(run->model, state, j, side);
    const double force = stop->stiffness * x + stop->damping * side * fu_slide_rate(run->model, state, j);
    return fmin(x, force);
}

/* Unlocks a slide with the force `pull` along the cable. */
static void release(fu_run *run, int j, double pull)
{
    fu_slide_flags *flags = fu_slide_flags_of(run->model, &run->now, j);
    const int side = flags->contact, hard = is_hard(run->model, j, side);
    flags->mode = FU_SLIDES;
    flags->slip_direction = !run->model->slides[j].sticks ? 0 : hard ? -side : pull > 0.0 ? -1 : 1;
    if (hard) flags->contact = 0;
}

static fu_sticking_flags *flags_of(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    return (fu_sticking_flags *)fu_slide_flags_of(model, state, coupling->index);
}

static double rate_of(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    return fu_slide_rate(model, state, coupling->index);
}

static void lock(fu_run *run, const fu_coupling *coupling)
{
    const int j = coupling->index;
    fu_slide_numbers_of(run->model, &run->now, j)->locked_s = run->now.s[j];
}

static double excess_of(const fu_run *run, const fu_coupling *coupling, const fu_state *state, double *pull)
{
    return excess(run, state, coupling->index, pull);
}

static void release_of(fu_run *run, const fu_coupling *coupling, double pull)
{
    release(run, coupling->index, pull);
}

static const fu_sticking sticking = {flags_of, rate_of, lock, excess_of, release_of};

/* Returns a number that is negative while a slide stays locked, or slides in its direction. */
double fu_stick_margin(const fu_run *run, const fu_state *state, int j)
{
    const fu_slide *slide = &run->model->slides[j];
    const int mode = fu_slide_flags_of(run->model, state, j)->mode;
    if (mode == FU_LEFT || slide->drive >= 0 || (mode == FU_SLIDES && !slide->sticks)) return -1.0;
    return fu_sticking_margin(run, &slide->base, state, &sticking);
}

/* Returns whether a slide is at rest. */
static int is_at_rest(const fu_run *run, int j)
{
    return fabs(fu_slide_rate(run->model, &run->now, j)) * run->duration <=
           REST_SPEED * fu_length(run->model, &run->now, j);
}

/* Sets the direction of sliding of a slide whose friction needs it. */
void fu_find_slip_direction(fu_run *run, const fu_coupling *coupling)
{
    if (run->model->slides[coupling->index].sticks) fu_set_slip_direction(run, coupling, &sticking);
}

/* Determines the buffer of a slide at the start, and whether it sticks; returns a status. */
int fu_begin_stops(fu_run *run, const fu_coupling *coupling)
{
    const fu_model *model = run->model;
    const int j = coupling->index;
    if (model->slides[j].drive >= 0) return FU_RUNNING;
    for (int side = -1; side <= 1; side += 2)
        if (model->slides[j].stops[side > 0].kind == FU_END_IS_BUFFERED &&
            fu_buffer_margin(run, &run->now, j, side) > 0.0)
            fu_slide_flags_of(run->model, &run->now, j)->contact = side;
    return model->slides[j].sticks && is_at_rest(run, j) ? fu_try_to_stick(run, coupling, &sticking) : FU_RUNNING;
}

/* Executes the impact of a slide on its hard stop, where it stays after a negligible rebound; returns a status. */
static int strike(fu_run *run, int j, int side)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    fu_slide_state slide_state;
    fu_slide_output slide;
    fu_slide_flags *flags = fu_slide_flags_of(run->model, now, j);
    flags->contact = side;
    if (side * fu_slide_rate(model, now, j) > 0.0) {
        flags->mode = FU_LOCKED;
        fu_slide_numbers_of(run->model, now, j)->locked_s = now->s[j];
        const double restitution = model->slides[j].stops[side > 0].restitution;
        fu_slide_now(model, now, j, &slide_state);
        if (fu_strike(model, now, &run->accelerator, model->slides[j].base.row, model->dim - 1,
                      restitution * slide_state.s_rate, run->work))
            return FU_SINGULAR;
        fu_impact(run, run->work, restitution);
    }
    release(run, j, 0.0);
    if (fu_complete(run, now)) return FU_SINGULAR;
    fu_slide_outputs(model, now, j, now->acceleration, &run->accelerator, &slide);
    const double back = -side * slide.s_rate, push = side * slide.s_acceleration;
    if (is_at_rest(run, j) || back * back <= 2.0 * push * MIN_REBOUND * fu_length(model, now, j)) {
        flags->contact = side;
        if (fu_try_to_stick(run, &model->slides[j].base, &sticking)) return FU_SINGULAR;
    }
    fu_update_directions(run);
    return FU_RUNNING;
}

/* Returns whether the span of a slide ends on a side at a sheave that the rope has left. */
static int ends_in_the_air(const fu_run *run, const fu_slide *slide, int side)
{
    FU_EACH_COUPLING(c, run->model->couplings, run->model->n_couplings)
        if (c->type == &fu_sheave_type && fu_wrap_is_beside_span(c, slide->on.s[side > 0]) &&
            fu_wrap_has_left(c, &run->now))
            return 1;
    return 0;
}

/* Executes the action of the end of the cable, or of the span of a rope, on a slide that moves outwards there; returns
 * a status. */
int fu_reach_end(fu_run *run, const fu_coupling *coupling, int side, const char **what)
{
    const fu_slide *slide = (const fu_slide *)coupling;
    const int j = coupling->index, kind = slide->stops[side > 0].kind;
    fu_slide_flags *flags = fu_slide_flags_of(run->model, &run->now, j);
    const int acts = slide->drive < 0 && (kind == FU_END_IS_OPEN || kind == FU_END_IS_HARD);
    if (slide->cable < 0 && (!acts || ends_in_the_air(run, slide, side)))
        return fu_leave(run, coupling, side > 0 ? FU_LEFT_BY_LAST_GRIP : FU_LEFT_BY_GRIP);
    if (kind == FU_END_IS_OPEN) {
        flags->mode = FU_LEFT;
        flags->slip_direction = flags->contact = 0;
        *what = "left";
        return FU_RUNNING;
    }
    if (kind != FU_END_IS_HARD || slide->drive >= 0) {
        run->stopped_slide = j;
        return FU_END_OF_CABLE;
    }
    const int last = is_at_rest(run, j) || slide->stops[side > 0].restitution > 0.0, status = strike(run, j, side);
    *what = last && flags->mode == FU_LOCKED ? "came to rest at the end" : "struck the end";
    return status;
}

/* Lets a slide enter the buffer of one end, or leave it. */
void fu_pass_buffer(fu_run *run, const fu_coupling *coupling, int end, int enters, const char **what)
{
    fu_slide_flags_of(run->model, &run->now, coupling->index)->contact = enters ? end : 0;
    *what = enters ? "entered the buffer" : "left the buffer";
}

/* Releases a locked slide whose force exceeds friction or stop, or locks one that has come to rest; returns a
 * status. */
int fu_release_or_stick(fu_run *run, const fu_coupling *coupling, const char **what)
{
    const int j = coupling->index;
    const fu_slide_flags *flags = fu_slide_flags_of(run->model, &run->now, j);
    if (flags->mode == FU_LOCKED) {
        double pull;
        excess(run, &run->now, j, &pull);
        *what = is_hard(run->model, j, flags->contact) ? "left the end" : "broke loose";
        release(run, j, pull);
        return FU_RUNNING;
    }
    if (flags->mode != FU_SLIDES || !run->model->slides[j].sticks) return FU_RUNNING;
    return fu_stick_or_turn(run, coupling, &sticking, what);
}
