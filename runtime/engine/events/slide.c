/* Events of a slide (couplings/common/coupling_events.h): it passes from element to element of its cable, sticks,
 * breaks loose, and reaches the ends. events/end_stops.c has the actions. */
#include "base/cubic.h"
#include "couplings/common/coupling_events.h"
#include "couplings/joint/joint.h"
#include "couplings/slide/slide.h"
#include "equations/equations.h"
#include "equations/run.h"
#include "events/end_stops.h"

/* Event functions of a slide: whether it stays locked, or slides in its direction; or, as the side of that end, its
 * buffer. */
enum { BUFFER_AT_START = -1, STICKING = 0, BUFFER_AT_END = 1 };

static const fu_slide *slide_of(const fu_coupling *coupling)
{
    return (const fu_slide *)coupling;
}

/* The path is a span of a rope: nodes have constant shares of its length. */
static fu_path path_of_span(const fu_span_elements *on, const fu_state *state, int n)
{
    const int first = on->s[0], last = on->s[1];
    return (fu_path){.n = n,
                     .length = 1.0 / on->n_elements,
                     .boundaries = on->share,
                     .origin = state->q[first],
                     .unit = state->q[last] - state->q[first],
                     .origin_rate = state->v[first],
                     .unit_rate = state->v[last] - state->v[first]};
}

/* The path is the cable or the span; a slide that has left it is on no element. */
static fu_path path_at(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_slide *slide = slide_of(coupling);
    const int left = fu_slide_flags_of(model, state, coupling->index)->mode == FU_LEFT;
    if (slide->cable < 0) return path_of_span(&slide->on, state, left ? 0 : slide->on.n_elements);
    const fu_cable *cable = &model->cables[slide->cable];
    return (fu_path){
        .n = left ? 0 : cable->n_elements, .length = cable->length, .boundaries = cable->nodes, .unit = 1.0};
}

static double rate(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    return fu_slide_rate(model, state, coupling->index);
}

static int can_act(const fu_coupling *coupling)
{
    const fu_slide *slide = slide_of(coupling);
    return slide->resistance || slide->stops[0].kind || slide->stops[1].kind;
}

/* A slide with events stops at each boundary; axes that a slide ties to the cable rotate suddenly where curvature is
 * discontinuous. */
static int stops_at_boundaries(const fu_model *model, const fu_coupling *coupling)
{
    return can_act(coupling) || fu_ties_a_frame(model, coupling->index);
}

/* If the rider's axes are tied to the cable they get a new angular velocity. The constraint error of the step is
 * projected away before, so that it does not count as a loss. The tangent of the neighbour differs by the jump of the
 * curvature times the distance beyond the boundary: if the axes were not rotated at once, the first short step would
 * rotate them, at a speed without a counterpart in the energies. */
static int enter(fu_run *run, const fu_coupling *coupling, int segment)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    if (!fu_ties_a_frame(model, coupling->index)) return FU_RUNNING;
    if (fu_project_velocities(model, now, &run->accelerator, run->work)) return FU_SINGULAR;
    for (int i = 0; i < model->n_dof; ++i) now->v[i] += run->work[i];
    now->segment[coupling->coordinate] = segment;
    if (fu_close(run)) return FU_NO_CONVERGENCE;
    if (fu_project_velocities(model, now, &run->accelerator, run->work)) return FU_SINGULAR;
    fu_impact(run, run->work, 0.0);
    return FU_RUNNING;
}

static int functions(const fu_coupling *coupling, fu_event_function *out)
{
    const fu_slide *slide = slide_of(coupling);
    fu_event_function found[3];
    int n = 0;
    if (slide->drive >= 0) return 0;
    if (slide->sticks || slide->stops[0].kind == FU_END_IS_HARD || slide->stops[1].kind == FU_END_IS_HARD)
        found[n++] = (fu_event_function){.which = STICKING, .direction = 1};
    for (int side = BUFFER_AT_START; side <= BUFFER_AT_END; side += 2)
        if (slide->stops[side > 0].kind == FU_END_IS_BUFFERED)
            found[n++] = (fu_event_function){.which = side, .direction = 0};
    for (int i = 0; i < n && out; ++i) out[i] = found[i];
    return n;
}

static double value_of(const fu_run *run, const fu_coupling *coupling, const fu_state *state, int which)
{
    return which == STICKING ? fu_stick_margin(run, state, coupling->index)
                             : fu_buffer_margin(run, state, coupling->index, which);
}

/* A slide enters a buffer at its end. */
static double grazing(const fu_run *run, const fu_coupling *coupling, int which, double h)
{
    const fu_model *model = run->model;
    const int j = coupling->index;
    const fu_slide_flags *flags = fu_slide_flags_of(model, &run->now, j);
    if (which == STICKING || flags->mode == FU_LEFT || flags->contact == which) return 0.0;
    const fu_course from = {fu_compression(model, &run->now, j, which), which * fu_slide_rate(model, &run->now, j)};
    const fu_course to = {fu_compression(model, &run->next, j, which), which * fu_slide_rate(model, &run->next, j)};
    return fu_grazing_time(from, to, -1, h, run->round_off);
}

static int sign(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int which)
{
    return which != STICKING && fu_slide_flags_of(model, state, coupling->index)->contact == which ? 1 : -1;
}

static int act(fu_run *run, const fu_coupling *coupling, int which, int side, const char **what)
{
    *what = 0;
    if (which == STICKING) return fu_release_or_stick(run, coupling, what);
    fu_pass_buffer(run, coupling, which, side > 0, what);
    return FU_RUNNING;
}

static const fu_path_operations path = {
    .at = path_at, .rate = rate, .stops_at_boundaries = stops_at_boundaries, .enter = enter, .reach_end = fu_reach_end};

const fu_coupling_events fu_slide_events = {
    .functions = functions,
    .value = value_of,
    .grazing = grazing,
    .sign = sign,
    .act = act,
    .update_direction = fu_find_slip_direction,
    .can_act = can_act,
    .begin = fu_begin_stops,
    .path = &path,
};
