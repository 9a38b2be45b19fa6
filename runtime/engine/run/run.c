/* The time loop: steps that end on output times, error control, slides that cross element boundaries. */
#include "engine.h"

#include <math.h>
#include <string.h>

#define SMALLEST_STEP 1e-12 /* of the duration */
#define AT_REST 1e-9        /* of the extent: a scene that moves less may be at rest */
#define FIRST_MOTION 1e-3   /* of the duration: until then the motion is judged by the velocities at the start */
#define BEYOND 0.1          /* of a step: how far it may go on after a slide should have reached its boundary */
#define MOST_REJECTIONS 10000 /* steps rejected beyond those taken */
#define AT_ONCE 1e-12       /* of the duration: instants that are no farther apart are one (knots.py) */
#define BEFORE 1e-15        /* of a knot: a step ends so much before it, where the signal is still that of the step */
#define ACCEPTED 2.0         /* of what is allowed: a step with a larger error is rejected */
#define DIVISIONS 8         /* of a fixed step that do not count */
#define MOST_ACTS 100       /* of slides at one instant: more is no motion */
#define MOST_TURNS 2        /* of a slide on one boundary before a step is taken all the same: it rests there */

int fu_all_finite(const double *numbers, long n)
{
    for (long i = 0; i < n; ++i)
        if (!isfinite(numbers[i])) return 0;
    return 1;
}

/* FU_SINGULAR, FU_UNSTABLE, FU_NO_CONVERGENCE for a row that is not finite, which does not count, or FU_RUNNING */
static int record_row(fu_run *run)
{
    const double begin = fu_clock();
    const fu_model *model = run->model;
    const fu_state *now = &run->now;
    fu_record *r = &run->record;
    const long row = r->n - r->first;
    double *acceleration = r->acceleration + row * model->n_dof;
    r->time[row] = now->t;
    memcpy(r->q + row * model->n_q, now->q, sizeof(double) * (size_t)model->n_q);
    memcpy(r->v + row * model->n_dof, now->v, sizeof(double) * (size_t)model->n_dof);
    memcpy(r->s + row * model->n_coordinates, now->s, sizeof(double) * (size_t)model->n_coordinates);
    const int info = fu_accelerations(model, now, &run->accelerator, acceleration,
                                      r->reaction + row * model->n_dof);
    r->kinetic[row] = fu_kinetic_energy(model, now->q, now->v);
    r->elastic[row] = fu_elastic_energy(model, now);
    r->potential[row] = fu_potential_energy(model, now->q);
    r->dissipated[row] = run->dissipated;
    r->external[row] = run->external;
    if (!info) fu_coupling_outputs(model, now, acceleration, &run->accelerator, r->output + row * model->n_outputs);
    const double energies[FU_ENERGIES] = {r->kinetic[row], r->elastic[row], r->potential[row], run->dissipated,
                                          -run->external};
    run->statistics.time_output += fu_clock() - begin;
    if (!fu_record_is_finite(model, r, row)) {
        if (info) return FU_SINGULAR;
        fu_fail(run, FU_NOT_FINITE, now->v, -1);
        return FU_NO_CONVERGENCE;
    }
    ++r->n;
    run->recorded = now->t;
    return info ? FU_SINGULAR : fu_check_energy_balance(run, energies, row == 0) ? FU_UNSTABLE : FU_RUNNING;
}

/* Start of the scheme, consistent: velocities projected on the joints where that is asked for, accelerations and forces
 * from eq 38. Starting it from zero accelerations instead makes every error fall with the first power of the step
 * (tests/benchmarks/order.py). */
static int start_scheme(fu_run *run, int project)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    if (project) {
        if (fu_project_velocities(model, now, &run->accelerator, run->before)) return FU_SINGULAR;
        for (int i = 0; i < model->n_dof; ++i) now->v[i] += run->before[i];
    }
    if (fu_complete(run, now)) return FU_SINGULAR;
    run->dissipated_power = fu_dissipated_power(run, now);
    run->external_power = fu_external_power(run, now, run->force);
    run->drive_step = -1.0;
    fu_coordinate_rates(model, &run->accelerator, run->s_slope);
    return run->integrator->start(run);
}

/* What the first evaluation needs: a state on its cables, the mass matrix. */
int fu_prepare(fu_run *run)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    fu_prescribe(model, now);
    fu_carry(model, now);
    if (fu_follow(model, now)) return FU_SINGULAR;
    if (fu_accelerator_prepare(model, &run->accelerator)) return FU_SINGULAR;
    memset(run->first, 0, sizeof(double) * (size_t)model->n_q);
    run->extent = fu_extent(model, run->first, now->q);
    run->size = fu_scene_size(model, run->first, now->q);
    return FU_RUNNING;
}

int fu_start(fu_run *run)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    run->ceiling = run->duration;
    if (fu_prepare(run)) return FU_SINGULAR;
    if (fu_may_start_open(model, now) && fu_close(run)) return FU_SINGULAR;
    memcpy(run->first, now->q, sizeof(double) * (size_t)model->n_q);
    if (start_scheme(run, 1)) return FU_SINGULAR;
    if (fu_has_stops(model)) {
        memcpy(run->psi, run->before, sizeof(double) * (size_t)model->n_dof); /* what the start asked for, for the caller */
        if (fu_begin_stops(run) || start_scheme(run, 0)) return FU_SINGULAR;
        memcpy(run->before, run->psi, sizeof(double) * (size_t)model->n_dof);
    }
    const int recorded = record_row(run);
    if (recorded) return recorded == FU_NO_CONVERGENCE ? recorded : FU_SINGULAR;
    if (run->rest_start) {
        memset(now->acceleration, 0, sizeof(double) * (size_t)model->n_dof);
        memset(now->a, 0, sizeof(double) * (size_t)model->n_dof);
    }
    /* tolerances are relative to the largest motion: until there is one, that of a thousandth of the duration; and
     * never to less than what a scene at rest cannot help */
    run->least_motion = AT_REST * run->extent;
    for (int i = 0; i < model->n_dof; ++i) {
        const double t = fmin(run->output_step, FIRST_MOTION * run->duration);
        const double d = model->weight[i] * (fabs(now->v[i]) * t + 0.5 * fabs(now->acceleration[i]) * t * t);
        if (d > run->least_motion) run->least_motion = d;
    }
    fu_watch_now(run, (fu_event){FU_NO_EVENT, 0, 0});
    fu_watch_anew(run, -1);
    return FU_RUNNING;
}

static void accept(fu_run *run, double h, fu_event event)
{
    const fu_model *model = run->model;
    for (int i = 0; i < model->n_coordinates; ++i) run->s_slope[i] = (run->next.s[i] - run->now.s[i]) / h;
    run->integrator->account(run, h);
    if (model->n_reacting) run->dissipated += fu_lost_in_step(model, &run->now, &run->next);
    run->statistics.crossings += fu_count_changes(run);
    const fu_state state = run->now;
    run->now = run->next;
    run->next = state;
    fu_carry(model, &run->now);
    const double moved = fu_largest_motion(model, run->first, run->now.q);
    if (moved > run->motion) run->motion = moved;
    fu_watch_now(run, event);
    run->net_rejections -= run->net_rejections > 0 ? run->fixed_step > 0.0 ? DIVISIONS : 1 : 0;
    fu_statistics *s = &run->statistics;
    ++s->steps;
    if (s->steps == 1 || h < s->h_min) s->h_min = h;
    if (h > s->h_max) s->h_max = h;
}

/* A slide has done `what`: the scheme starts anew, and the caller is told. */
static int acted(fu_run *run, int j, int what)
{
    const int status = start_scheme(run, 1);
    run->acts = run->now.t - run->acted <= SMALLEST_STEP * run->duration ? run->acts + 1 : 0;
    run->acted = run->now.t;
    if (run->acts > MOST_ACTS) {
        fu_fail(run, FU_SELF_LOCKING, run->now.v, j);
        return FU_NO_CONVERGENCE;
    }
    fu_watch_anew(run, j);
    run->event = (fu_event){FU_ACTED, j, what};
    return status ? status : FU_EVENT;
}

/* Put a slide that stands on a boundary into the neighbour. Accelerations and force jump with r_xx there: the scheme
 * starts anew. Were they carried over, the short steps around a boundary would raise what the constraints left in them
 * by the ratio of the steps, crossing by crossing, and a spectral radius of 1 never lets it decay. Returns
 * FU_END_OF_CABLE where there is no neighbour. */
static int enter(fu_run *run, int j, int side)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    const int element = now->element[j] + side;
    if (element < 0 || element >= model->cables[model->slides[j].cable].n_elements) {
        int what;
        const int status = fu_reach_end(run, j, side, &what);
        return status ? status : acted(run, j, what);
    }
    if (fu_ties_a_frame(model, j)) { /* what the step left goes first, lest it be taken for a loss */
        if (fu_project_velocities(model, now, &run->accelerator, run->work)) return FU_SINGULAR;
        for (int i = 0; i < model->n_dof; ++i) now->v[i] += run->work[i];
        now->element[j] = element;
        if (fu_project_velocities(model, now, &run->accelerator, run->work)) return FU_SINGULAR;
        fu_impact(run, run->work, 0.0);
    }
    now->element[j] = element;
    ++run->statistics.crossings;
    fu_watch_now(run, (fu_event){FU_NO_EVENT, 0, 0});
    return start_scheme(run, !run->integrator->keeps_energy);
}

/* What follows from an event that `now` stands on. */
static int happened(fu_run *run, fu_event event)
{
    if (event.kind == FU_CROSSING) return enter(run, event.which, event.side);
    const fu_watch *watch = &run->watches[event.which];
    if (watch->kind == FU_WATCH_STICK || watch->kind == FU_WATCH_BUFFER) {
        int what;
        const int status = fu_act(run, watch, event.side, &what);
        return status || what == FU_NOTHING ? status : acted(run, watch->index, what);
    }
    run->event = event;
    return FU_EVENT;
}

/* What is left between an event and an output time can be so short that the rounding of psi, over h^2, is all there is
 * in its accelerations: they must not go on. */
static int refresh(fu_run *run, double h)
{
    run->usual = run->fixed_step > 0.0 ? run->fixed_step : run->h;
    return fu_is_short(run, h)
               ? start_scheme(run, !run->integrator->keeps_energy) : FU_RUNNING;
}

static int is_adaptive(const fu_run *run)
{
    return run->fixed_step <= 0.0;
}

/* The shortest step, s. */
static double shortest(const fu_run *run)
{
    return SMALLEST_STEP * run->duration;
}

/* A step that is tried: the size that is wanted and the one that is taken, s; its error, m, and that over what is allowed;
 * how many slides have left their elements in it; the event that it ends on. */
typedef struct {
    double want, h, error, ratio;
    int changes;
    fu_event event;
} trial;

static const fu_event no_event = {FU_NO_EVENT, 0, 0};

/* Whether slides must keep their elements in a step, which ends where one of them leaves its element. */
static int must_keep_elements(const fu_run *run)
{
    return !is_adaptive(run) || !run->integrator->crosses_boundaries || fu_has_stops(run->model) ||
           fu_ties_a_frame(run->model, -1);
}

/* Chooses the size of the step; returns 0 where there is none that is large enough. */
static int choose_size(fu_run *run, trial *t, double remaining)
{
    t->h = fu_fit_step(remaining, t->want);
    if ((t->h < shortest(run) && remaining > shortest(run)) || run->net_rejections > MOST_REJECTIONS) return 0;
    if (run->keep_elements) t->h = fmin(t->h, fu_time_to_boundary(run) + BEYOND * t->h);
    return 1;
}

/* Makes the step and estimates its error; returns 0 where it is rejected, and a shorter one is wanted. */
static int attempt(fu_run *run, trial *t)
{
    const double allowed = fu_allow(run, t->h);
    run->failure.cause = FU_NO_FAILURE;
    run->usual = t->want;
    if (run->integrator->step(run, t->h)) {
        if (!run->failure.cause) fu_fail(run, FU_ITERATION, run->next.v, -1);
        t->want = fu_retry_step(run, t->h);
        return 0;
    }
    t->error = run->integrator->error(run, t->h);
    t->ratio = t->error / allowed;
    t->changes = fu_count_changes(run);
    if (is_adaptive(run) && !t->changes && !(t->ratio <= ACCEPTED)) {
        t->want = fu_shrink_step(run, t->h, t->ratio);
        return 0;
    }
    return 1;
}

/* Finds the event that the step leads to. Where accelerations jump by too much within it, it shall end at the boundary. */
static void find_event(fu_run *run, trial *t)
{
    t->event = fu_find_event(run, no_event);
    if (t->changes && (t->event.kind == FU_CROSSING || !(t->ratio <= 1.0))) {
        fu_keep_elements(run);
        t->event = fu_find_event(run, no_event);
    }
}

/* Shortens the step until it ends on the first of its events; returns 0 where that is not found. */
static int end_on_event(fu_run *run, trial *t)
{
    for (int i = 0; i <= run->model->n_slides + run->n_watches; ++i) {
        const fu_event earlier = i ? fu_find_event(run, t->event) : t->event;
        if (!earlier.kind) break;
        t->event = earlier;
        t->h = fu_locate(run, t->event, t->h);
        if (t->h == 0.0) {
            t->want *= 0.5;
            return 0;
        }
    }
    return 1;
}

/* Whether a step that was cut at a jump is accurate: its error without the jump was not known before. */
static int is_accurate_without_jump(fu_run *run, trial *t)
{
    const double ratio = run->integrator->error(run, t->h) / fu_allow(run, t->h);
    if (ratio <= ACCEPTED) return 1;
    t->want = fu_shrink_step(run, t->h, ratio);
    return 0;
}

/* Takes a step that ends on no event. */
static int take_step(fu_run *run, const trial *t)
{
    accept(run, t->h, t->event);
    run->turned = 0;
    run->statistics.error_sum += t->error;
    run->last_error = t->error;
    if (is_adaptive(run)) fu_adapt_step(run, t->h, t->ratio);
    return refresh(run, t->h);
}

/* One accepted step towards `target`, or a change of a slide's element. */
static int step_towards(fu_run *run, double target)
{
    const fu_event late = fu_late_event(run);
    trial t = {.want = is_adaptive(run) ? run->h : run->fixed_step};
    if (late.kind) return happened(run, late);
    run->keep_elements = must_keep_elements(run);
    for (;;) {
        if (!choose_size(run, &t, target - run->now.t)) return FU_NO_CONVERGENCE;
        if (!attempt(run, &t)) continue;
        find_event(run, &t);
        const double turn = run->keep_elements ? fu_time_of_turn(run, t.h) : 0.0;
        if (turn > shortest(run) && run->turned < MOST_TURNS) {
            t.want = turn;
            continue;
        }
        if (t.event.kind == FU_CROSSING && run->turned >= MOST_TURNS) t.event = no_event;
        if (fu_stands_on_boundary(run, t.event)) {
            ++run->turned;
            return happened(run, t.event);
        }
        if (!t.event.kind) return take_step(run, &t);
        if (!end_on_event(run, &t)) {
            if (t.want < shortest(run)) return FU_NO_CONVERGENCE;
            continue;
        }
        if (t.changes && !is_accurate_without_jump(run, &t)) continue;
        accept(run, t.h, t.event);
        const int status = t.event.kind == FU_CROSSING ? FU_RUNNING : refresh(run, t.h);
        return status ? status : happened(run, t.event);
    }
}

/* Record where the run has stopped, if that is not done already. */
int fu_stop(fu_run *run)
{
    const int recorded = run->now.t > run->recorded ? record_row(run) : FU_RUNNING;
    return recorded ? recorded : FU_EVENT;
}

/* The first knot after `now` at which steps end, until `latest`; null where there is none. */
static const fu_knot *next_knot(const fu_run *run, double latest)
{
    const double close = AT_ONCE * run->duration;
    int low = 0, high = run->n_knots;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (run->knots[middle].t > run->now.t + close) high = middle;
        else low = middle + 1;
    }
    for (; low < run->n_knots && run->knots[low].t <= latest + close; ++low)
        if (run->fixed_step <= 0.0 || run->knots[low].jumps == FU_RATE_JUMPS) return &run->knots[low];
    return 0;
}

/* On from a knot that `now` has reached. What jumps there starts the scheme anew. Where a rate jumps, all that joints tie
 * to it jumps, too, and what drives it does the work of that; a drive that turned within an instant would lose none. */
static int pass_knot(fu_run *run, const fu_knot *knot, int event)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    now->t = knot->t;
    run->drive_step = fmin(run->drive_step, 0.0); /* powers before do not tell how it changes from here */
    if (knot->jumps == FU_HIGHER_JUMPS) return FU_RUNNING;
    if (knot->jumps == FU_RATE_JUMPS) {
        const double before = fu_kinetic_energy(model, now->q, now->v);
        fu_prescribe(model, now);
        if (fu_project_velocities(model, now, &run->accelerator, run->work)) return FU_SINGULAR;
        for (int i = 0; i < model->n_dof; ++i) now->v[i] += run->work[i];
        run->external += fu_kinetic_energy(model, now->q, now->v) - before;
    }
    fu_prescribe(model, now);
    if (!event) fu_watch_now(run, (fu_event){FU_NO_EVENT, 0, 0});
    return start_scheme(run, 0);
}

/* Steps towards an output time, until the first knot on the way there. */
static int approach(fu_run *run, double target)
{
    const fu_knot *knot = run->n_knots ? next_knot(run, target) : 0;
    if (!knot) return step_towards(run, target);
    const int status = step_towards(run, knot->t * (1.0 - BEFORE));
    if ((status && status != FU_EVENT) || run->now.t < knot->t - AT_ONCE * run->duration) return status;
    const int passed = pass_knot(run, knot, status == FU_EVENT);
    return passed ? passed : status;
}

/* Go on for about so many seconds, or to the pause; the status tells whether there is more to do. */
int fu_advance(fu_run *run, double seconds)
{
    const double until = fu_clock() + seconds;
    for (;;) {
        double target = run->record.n * run->output_step;
        if (target > run->duration * (1.0 - AT_ONCE)) target = run->duration;
        if (run->now.t >= target - AT_ONCE * run->duration) {
            run->now.t = target;
            const int recorded = record_row(run);
            if (recorded) return recorded;
            if (target == run->duration) return FU_DONE;
            if (run->record.n == run->record.pause || fu_clock() > until) return FU_RUNNING;
        } else {
            const int status = approach(run, target);
            if (status == FU_EVENT) return status;
            if (status) {
                const int stopped = fu_stop(run);
                return stopped == FU_EVENT ? status : stopped;
            }
            if (fu_clock() > until) return FU_RUNNING;
        }
    }
}
