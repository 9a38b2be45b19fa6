/* Steps: their size, trial, error and events, until one is accepted. */
#include "base/clock.h"
#include "couplings/common/coupling_events.h"
#include "couplings/common/couplings.h"
#include "equations/equations.h"
#include "equations/scene_size.h"
#include "equations/step_control.h"
#include "events/events.h"
#include "events/slack_cables.h"
#include "run/run.h"

#include <math.h>

#define MIN_STEP 1e-12 /* of the duration: shortest step of a run */
/* of a step: largest part beyond the boundary of a coupling */
#define BOUNDARY_OVERSHOOT 0.1
#define MAX_REJECTIONS 10000 /* largest number of rejected steps beyond the accepted ones */
#define MAX_ERROR_RATIO 2.0  /* of the permitted error: a step with a larger error is rejected */
/* rejections of a fixed step that each accepted step compensates: largest number of divisions */
#define REJECTIONS_PER_STEP 8
/* of a coupling on one boundary before a step is accepted nevertheless: it rests there */
#define MAX_TURNS 2
/* of a step at a grazing event within it, after which it is accepted nevertheless */
#define MAX_CUTS 4
/* of the error permitted over the run: largest error of the history of friction in one step */
#define HISTORY_ERROR_SHARE 0.15
/* of the intended step: next step after one whose event was not found */
#define MISSED_EVENT_FACTOR 0.5

/* Restarts the scheme after a very short step, unless the step has left data to continue with; returns a status. The
 * interval between an event and an output time can be so short that accelerations computed over it are rounding,
 * divided by h^2. */
static int refresh(fu_run *run, double h)
{
    const int coasted = run->integrator->coasts && fu_is_short(run, h);
    run->usual = run->fixed_step > 0.0 ? run->fixed_step : run->h;
    if (!fu_is_short(run, h)) return FU_RUNNING;
    if (!coasted) return fu_start_scheme(run, !run->integrator->keeps_energy);
    fu_coordinate_rates(run->model, &run->accelerator, run->s_slope);
    return FU_RUNNING;
}

/* Returns whether the error controls the size of steps. */
static int is_adaptive(const fu_run *run)
{
    return run->fixed_step <= 0.0;
}

/* Returns the shortest step, s. */
static double shortest(const fu_run *run)
{
    return MIN_STEP * run->duration;
}

/* Returns whether couplings must keep their path segments in a step, which ends where one leaves its segment. */
static int must_keep_segments(const fu_run *run)
{
    const fu_integrator *integrator = run->integrator;
    return (!is_adaptive(run) && !integrator->defers_all) || !integrator->crosses_boundaries ||
           fu_stop_at_boundaries(run->model);
}

/* Returns whether couplings must have no deferred event in a step, which ends at one. */
static int must_keep_forces(const fu_run *run)
{
    if (run->integrator->defers_all) return 0;
    return !is_adaptive(run) || !run->last_event_deferred || !run->integrator->quadrature;
}

/* A trial step: its intended and its actual size, s; the place of a cut at a grazing event, s, else 0, and the number
 * of cuts; its error, m, and the ratio to the permitted error; the numbers of boundaries and of deferred events in it;
 * whether it has been found to have none; the event at its end; whether what may act before it acts after it
 * instead. */
typedef struct {
    double want, h, cut, error, ratio;
    int cuts, changes, deferred, refused, is_late;
    fu_event event;
} trial;

/* Chooses the size of the step; returns 0 if no size is large enough. */
static int choose_size(fu_run *run, trial *t, double remaining)
{
    t->h = t->cut > 0.0 ? fmin(t->cut, remaining) : fu_fit_step(remaining, t->want);
    if ((t->h < shortest(run) && remaining > shortest(run)) || run->net_rejections > MAX_REJECTIONS) return 0;
    if (run->keep_segments) t->h = fmin(t->h, fu_time_to_boundary(run) + BOUNDARY_OVERSHOOT * t->h);
    t->cut = 0.0;
    return 1;
}

/* Returns the clock less the seconds counted already: its growth has not been counted. */
static double uncounted(const fu_run *run)
{
    const fu_statistics *s = &run->statistics;
    return fu_clock() -
           (s->time_factor + s->time_solve + s->time_residual + s->time_output + s->time_step + s->time_error);
}

/* Computes a step; returns 0 if that was possible. */
static int make(fu_run *run, double h)
{
    const double begin = uncounted(run);
    const int failed = run->integrator->step(run, h);
    run->statistics.time_step += uncounted(run) - begin;
    return failed;
}

/* Returns the estimate of the step's error, m. */
static double error_of(fu_run *run, double h)
{
    const double begin = uncounted(run), error = fmax(fmax(run->integrator->error(run, h), fu_deferred_error(run, h)),
                                                      fu_friction_error(run, h));
    const double carried =
        fu_history_error(run->model, &run->now, &run->next) / (HISTORY_ERROR_SHARE * fu_allowed_error(run));
    run->statistics.time_error += uncounted(run) - begin;
    return fmax(error, run->allowed *
                           /* the error of the history is at least of second order in the step */
                           pow(carried, 0.5 * run->order));
}

/* Resets couplings to their state in `now` for the rest of the step. */
static void refuse(fu_run *run, trial *t)
{
    fu_undo_deferred(run);
    t->refused = 1;
    run->last_event_deferred = 0;
}

/* Computes the step and estimates its error; returns 0 if it is rejected for a shorter one. */
static int attempt(fu_run *run, trial *t)
{
    const double allowed = fu_allow(run, t->h);
    run->failure.cause = FU_NO_FAILURE;
    run->usual = t->want;
    run->max_deferred = 0;
    if (make(run, t->h)) {
        if (run->model->n_deferring && !run->keep_forces) { /* its iteration may alternate across an event */
            refuse(run, t);
            return 0;
        }
        if (!run->failure.cause) fu_fail(run, FU_ITERATION, run->next.v, -1);
        t->want = fu_retry_step(run, t->h);
        return 0;
    }
    if (fu_has_unbounded_error(run)) {
        refuse(run, t);
        return 0;
    }
    t->error = error_of(run, t->h);
    t->ratio = t->error / allowed;
    t->changes = fu_count_changes(run);
    t->deferred = run->integrator->quadrature ? fu_count_deferred(run) : 0;
    if (is_adaptive(run) && !t->changes && !t->deferred && !(t->ratio <= MAX_ERROR_RATIO)) {
        t->want = fu_shrink_step(run, t->h, t->ratio);
        return 0;
    }
    return 1;
}

/* Returns whether the step, made without deferred events, is to be repeated with those that it leads to. Steps without
 * them are tried first if the last one had none, since iterations and stages across an event cost more. */
static int shall_go_over(fu_run *run, trial *t)
{
    if (!is_adaptive(run) || !run->integrator->quadrature || !run->keep_forces || t->refused ||
        !run->model->n_deferring)
        return 0;
    run->keep_forces = 0;
    fu_update_deferred(run, 1);
    if (fu_count_deferred(run) && fmax(t->error, fu_deferred_error(run, t->h)) <= run->allowed) return 1;
    fu_undo_deferred(run);
    return 0;
}

/* Finds the event that the step leads to. If the discontinuity of accelerations within it is too large, it shall end at
 * the boundary. */
static void find_event(fu_run *run, trial *t)
{
    if (t->deferred && is_adaptive(run) && !(t->ratio <= 1.0)) refuse(run, t);
    t->event = fu_find_event(run, fu_no_event);
    if (t->changes && (t->event.kind == FU_PATH_BOUNDARY || (is_adaptive(run) && !(t->ratio <= 1.0)))) {
        fu_restore_path_segments(run);
        t->event = fu_find_event(run, fu_no_event);
    }
}

/* Returns whether the event of a step may act before it. */
static int may_act_before(const fu_run *run, const trial *t)
{
    const fu_coupling *coupling = t->event.kind == FU_EVENT_FUNCTION ? fu_event_coupling(run, t->event.which) : 0;
    return coupling && coupling->events->keeps_velocities;
}

/* Returns whether a step that ends on an event is too short for a method that conserves energy, whose velocities would
 * be rounding over it, and the event may act before it. */
static int acts_at_once(const fu_run *run, const trial *t)
{
    return run->integrator->keeps_energy && fu_is_short(run, t->h) && may_act_before(run, t);
}

/* Shortens the step until it ends on the first of its events; returns 0 if that is not found. */
static int end_on_event(fu_run *run, trial *t)
{
    for (int i = 0; i <= run->model->n_coordinates + run->n_event_functions; ++i) {
        const fu_event earlier = i ? fu_find_event(run, t->event) : t->event;
        if (!earlier.kind) break;
        t->event = earlier;
        t->h = fu_locate(run, t->event, t->h);
        if (t->h == 0.0) {
            t->want *= MISSED_EVENT_FACTOR;
            return 0;
        }
        if (acts_at_once(run, t)) break;
    }
    return 1;
}

/* Returns whether a step that was cut at a discontinuity is accurate: its error without that was unknown before. */
static int is_accurate_without_jump(fu_run *run, trial *t)
{
    const double ratio = fu_has_unbounded_error(run) ? INFINITY : error_of(run, t->h) / fu_allow(run, t->h);
    if (ratio <= MAX_ERROR_RATIO) return 1;
    t->want = fu_shrink_step(run, t->h, ratio);
    return 0;
}

/* Returns whether an event function passes zero within the step and returns: the step is then cut there. */
static int is_cut_at_grazing(fu_run *run, trial *t)
{
    const double grazing = t->cuts < MAX_CUTS ? fu_time_of_grazing(run, t->h) : 0.0;
    if (!(grazing > shortest(run))) return 0;
    ++t->cuts;
    t->cut = grazing;
    return 1;
}

/* Accepts the step just made: `next` becomes `now`. */
static void accept(fu_run *run, const trial *t)
{
    const fu_model *model = run->model;
    const double h = t->h;
    run->is_remainder = !t->cuts && (!t->event.kind || t->event.kind == FU_PATH_BOUNDARY);
    for (int i = 0; i < model->n_coordinates; ++i) run->s_slope[i] = (run->next.s[i] - run->now.s[i]) / h;
    run->integrator->account(run, h);
    fu_record_deferred(run, h);
    fu_note_slackness(run, h);
    run->dissipated += fu_lost_in_step(model, &run->now, &run->next, run->order <= 2);
    run->statistics.node_passages += fu_count_changes(run);
    const fu_state state = run->now;
    run->now = run->next;
    run->next = state;
    fu_update_history(model, &run->now);
    fu_search_near_pairs(run, h, 0);
    const double moved = fu_largest_motion(model, run->first, run->now.q);
    if (moved > run->motion) run->motion = moved;
    run->controlled_motion =
        run->controlled == model->weight ? run->motion : fmax(run->controlled_motion, fu_controlled_motion(run));
    fu_evaluate_event_functions(run, t->event, h);
    fu_record_penetrations(run);
    run->net_rejections -= run->net_rejections > 0 ? run->fixed_step > 0.0 ? REJECTIONS_PER_STEP : 1 : 0;
    fu_statistics *s = &run->statistics;
    ++s->steps;
    if (s->steps == 1 || h < s->h_min) s->h_min = h;
    if (h > s->h_max) s->h_max = h;
}

/* Accepts a step that ends on no event; returns a status. */
static int take_step(fu_run *run, const trial *t)
{
    if (t->deferred) run->last_event_deferred = 1;
    accept(run, t);
    if (fu_has_lost_an_event(run)) return FU_NO_CONVERGENCE;
    run->turned = 0;
    run->statistics.error_sum += t->error;
    run->last_error = t->error;
    if (is_adaptive(run)) fu_adapt_step(run, t->h, t->ratio);
    return refresh(run, t->h);
}

/* Handles an event before the short step that leads to it; returns a status, and whether a coupling has changed. */
static int act_before(fu_run *run, const trial *t, int *has_acted)
{
    const int acts = run->acts;
    const double acted = run->acted;
    fu_evaluate_event_functions(run, t->event, 0.0);
    const int status = fu_handle_event(run, t->event);
    *has_acted = run->acts != acts || run->acted != acted;
    return status;
}

/* Computes and accepts one step towards `target`, or executes the action of an event at `now`; returns a status. */
int fu_step_towards(fu_run *run, double target)
{
    const fu_event late = fu_late_event(run);
    trial t = {.want = is_adaptive(run) ? run->h : run->fixed_step};
    if (fu_has_lost_an_event(run)) return FU_NO_CONVERGENCE;
    if (late.kind) return fu_handle_event(run, late);
    run->keep_segments = must_keep_segments(run);
    run->keep_forces = must_keep_forces(run);
    for (;;) {
        if (!choose_size(run, &t, target - run->now.t)) return FU_NO_CONVERGENCE;
        if (!attempt(run, &t) || shall_go_over(run, &t)) continue;
        find_event(run, &t);
        if (t.is_late && may_act_before(run, &t)) t.event = fu_no_event;
        const double turn = run->keep_segments ? fu_time_of_turn(run, t.h) : 0.0;
        if (turn > shortest(run) && run->turned < MAX_TURNS) {
            t.want = turn;
            continue;
        }
        if (run->n_event_functions && is_cut_at_grazing(run, &t)) continue;
        if (t.event.kind == FU_PATH_BOUNDARY && run->turned >= MAX_TURNS) t.event = fu_no_event;
        if (fu_stands_on_boundary(run, t.event)) {
            ++run->turned;
            return fu_handle_event(run, t.event);
        }
        if (!t.event.kind) return take_step(run, &t);
        if (!end_on_event(run, &t)) {
            if (t.want < shortest(run)) return FU_NO_CONVERGENCE;
            continue;
        }
        if ((t.changes || t.deferred) && !is_accurate_without_jump(run, &t)) continue;
        if (run->n_event_functions && is_cut_at_grazing(run, &t)) continue;
        if (acts_at_once(run, &t)) {
            int has_acted;
            const int status = act_before(run, &t, &has_acted);
            if (status || has_acted) return status;
            t.is_late = 1; /* it is at its limit only beyond the start */
            continue;
        }
        accept(run, &t);
        const int status = t.event.kind == FU_PATH_BOUNDARY ? FU_RUNNING : refresh(run, t.h);
        return status ? status : fu_handle_event(run, t.event);
    }
}
