/* The time loop: steps that end on output times, error control, slides that cross element boundaries. */
#include "engine.h"

#include <math.h>
#include <string.h>

#define RECOVERY 1.05       /* of what steps stay below after a failure, with each step that is taken */
#define SMALLEST_STEP 1e-12 /* of the duration */
#define FIRST_PART 1e-3     /* of the duration: errors in it share one allowance */
#define SAFETY 0.5          /* what the logarithm costs */
#define BEYOND 0.1          /* of a step: how far it may go on after a slide should have reached its boundary */
#define MOST_STRUGGLE 10000 /* steps rejected beyond those taken */
#define AT_ONCE 1e-12       /* of the duration: instants that are no farther apart are one (knots.py) */
#define BEFORE 1e-15        /* of a knot: a step ends so much before it, where the signal is still that of the step */
#define DIVISIONS 8         /* of a fixed step that do not count */
#define MOST_ACTS 100       /* of slides at one instant: more is no motion */
#define MOST_TURNS 2        /* of a slide on one boundary before a step is taken all the same: it rests there */

/* largest distance that a node or a body's centre has moved, m */
static double motion(const fu_model *model, const double *from, const double *to)
{
    double largest = 0.0;
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        for (int k = 0, at = cable->first; k <= cable->n_elements; ++k, at += cable->per_node) {
            double square = 0.0;
            for (int d = 0; d < cable->kernel->dim; ++d)
                square += (to[at + d] - from[at + d]) * (to[at + d] - from[at + d]);
            if (square > largest) largest = square;
        }
    }
    for (int b = 0; b < model->n_bodies; ++b) {
        const int at = model->bodies[b].configuration;
        double square = 0.0;
        for (int d = 0; d < model->bodies[b].kernel->dim; ++d)
            square += (to[at + d] - from[at + d]) * (to[at + d] - from[at + d]);
        if (square > largest) largest = square;
    }
    return sqrt(largest);
}

/* size of what coordinates are rounded to, m: the farthest position, or what unit slopes and turns move a point by */
static double extent(const fu_model *model, const double *origin, const double *q)
{
    double largest = motion(model, origin, q);
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        for (int i = cable->kernel->dim; i < cable->per_node; ++i)
            largest = fmax(largest, model->weight[cable->first + i]);
    }
    for (int b = 0; b < model->n_bodies; ++b)
        for (int i = model->bodies[b].kernel->dim; i < model->bodies[b].kernel->velocity; ++i)
            largest = fmax(largest, model->weight[model->bodies[b].dof + i]);
    return largest;
}

/* the largest side of the box around all nodes and bodies' centres, or what unit slopes and turns move a point by, m */
static double size(const fu_model *model, const double *origin, const double *q)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    double largest = extent(model, origin, origin);
    for (int c = 0; c < model->n_cables; ++c)
        for (int k = 0, at = model->cables[c].first; k <= model->cables[c].n_elements; ++k, at += model->cables[c].per_node)
            for (int d = 0; d < model->dim; ++d) {
                low[d] = fmin(low[d], q[at + d]);
                high[d] = fmax(high[d], q[at + d]);
            }
    for (int b = 0; b < model->n_bodies; ++b)
        for (int d = 0; d < model->dim; ++d) {
            low[d] = fmin(low[d], q[model->bodies[b].configuration + d]);
            high[d] = fmax(high[d], q[model->bodies[b].configuration + d]);
        }
    for (int d = 0; d < model->dim; ++d) largest = fmax(largest, high[d] - low[d]);
    return largest;
}

int fu_all_finite(const double *numbers, long n)
{
    for (long i = 0; i < n; ++i)
        if (!isfinite(numbers[i])) return 0;
    return 1;
}

static int is_finite_row(const fu_model *model, const fu_record *r, long row)
{
    const long q = model->n_q, v = model->n_dof, slides = model->n_slides, joints = model->n_joints;
    const double energies[] = {r->kinetic[row], r->elastic[row], r->potential[row], r->dissipated[row], r->external[row]};
    return fu_all_finite(energies, sizeof energies / sizeof *energies) && fu_all_finite(r->q + row * q, q) &&
           fu_all_finite(r->v + row * v, v) && fu_all_finite(r->acceleration + row * v, v) &&
           fu_all_finite(r->reaction + row * v, v) && fu_all_finite(r->s + row * slides, slides) &&
           fu_all_finite(r->slide + row * slides * FU_SLIDE_OUTPUTS, slides * FU_SLIDE_OUTPUTS) &&
           fu_all_finite(r->joint + row * joints * FU_JOINT_OUTPUTS, joints * FU_JOINT_OUTPUTS) &&
           fu_all_finite(r->spring + 3 * row * model->n_springs, 3L * model->n_springs);
}

/* FU_SINGULAR, FU_UNSTABLE, FU_NO_CONVERGENCE for a row that is not finite, which does not count, or FU_RUNNING */
static int record_row(fu_run *run)
{
    const double begin = fu_clock();
    const fu_model *model = run->model;
    const fu_state *now = &run->now;
    fu_record *r = &run->record;
    const long row = r->n - r->first;
    fu_slide_output *slides = (fu_slide_output *)(r->slide + row * model->n_slides * FU_SLIDE_OUTPUTS);
    r->time[row] = now->t;
    memcpy(r->q + row * model->n_q, now->q, sizeof(double) * (size_t)model->n_q);
    memcpy(r->v + row * model->n_dof, now->v, sizeof(double) * (size_t)model->n_dof);
    memcpy(r->s + row * model->n_slides, now->s, sizeof(double) * (size_t)model->n_slides);
    const int info = fu_accelerations(model, now, &run->accelerator, r->acceleration + row * model->n_dof, slides,
                                      r->reaction + row * model->n_dof);
    r->kinetic[row] = fu_kinetic_energy(model, now->q, now->v);
    r->elastic[row] = fu_elastic_energy(model, now->q);
    if (model->n_resistances) r->elastic[row] += fu_buffer_energy(model, now);
    r->potential[row] = fu_potential_energy(model, now->q);
    r->dissipated[row] = run->dissipated;
    r->external[row] = run->external;
    fu_spring_forces_of(model, now, r->spring + 3 * row * model->n_springs);
    fu_joint_outputs(model, now, &run->accelerator, (fu_joint_output *)(r->joint + row * model->n_joints * FU_JOINT_OUTPUTS));
    const double energies[FU_ENERGIES] = {r->kinetic[row], r->elastic[row], r->potential[row], run->dissipated,
                                          -run->external};
    run->statistics.time_output += fu_clock() - begin;
    if (!is_finite_row(model, r, row)) {
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
    fu_slide_output *slides = (fu_slide_output *)run->accelerator.slides;
    if (project) {
        if (fu_project_velocities(model, now, &run->accelerator, run->before)) return FU_SINGULAR;
        for (int i = 0; i < model->n_dof; ++i) now->v[i] += run->before[i];
    }
    if (fu_complete(run, now)) return FU_SINGULAR;
    run->dissipated_power = fu_dissipated_power(run, now);
    run->external_power = fu_external_power(run, now, run->force);
    run->drive_step = -1.0;
    for (int j = 0; j < model->n_slides; ++j) run->s_slope[j] = slides[j].s_rate;
    return run->integrator->start(run);
}

/* whether a start can be off its joints by a small gap: bodies are put on their cables when they are drawn */
static int closes(const fu_run *run)
{
    int held = run->model->n_joints;
    for (int j = 0; j < run->model->n_slides; ++j) held |= run->now.mode[j] == FU_LOCKED || !run->model->slides[j].rider_is_rigid;
    return held;
}

/* What the first evaluation needs: a state on its cables, the mass matrix. */
int fu_prepare(fu_run *run)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    fu_prescribe(model, now);
    fu_carry_directors(model, now);
    for (int j = 0; j < model->n_slides; ++j)
        if (fu_find_arc_length(model, now, j, &now->s[j])) return FU_SINGULAR;
    if (fu_accelerator_prepare(model, &run->accelerator)) return FU_SINGULAR;
    memset(run->first, 0, sizeof(double) * (size_t)model->n_q);
    run->extent = extent(model, run->first, now->q);
    run->size = size(model, run->first, now->q);
    return FU_RUNNING;
}

int fu_start(fu_run *run)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    run->ceiling = run->duration;
    if (fu_prepare(run)) return FU_SINGULAR;
    if (closes(run) && fu_close(run)) return FU_SINGULAR;
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
    run->least_motion = 1e-9 * run->extent;
    for (int i = 0; i < model->n_dof; ++i) {
        const double t = fmin(run->output_step, 1e-3 * run->duration);
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
    for (int j = 0; j < model->n_slides; ++j) run->s_slope[j] = (run->next.s[j] - run->now.s[j]) / h;
    run->integrator->book(run, h);
    if (model->n_resistances) run->dissipated += fu_lost_in_buffers(model, &run->now, &run->next);
    run->statistics.crossings += fu_count_changes(run);
    const fu_state state = run->now;
    run->now = run->next;
    run->next = state;
    fu_carry_directors(model, &run->now);
    const double moved = motion(model, run->first, run->now.q);
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
        fu_fail(run, FU_JAM, run->now.v, j);
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
    return start_scheme(run, !run->integrator->conserves);
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
               ? start_scheme(run, !run->integrator->conserves) : FU_RUNNING;
}

/* The step that ends at the target, or one of equal steps to there, none larger than wanted. */
static double fitted(double remaining, double want)
{
    const double pieces = ceil(remaining / want * (1.0 - 1e-9));
    return pieces <= 1.0 ? remaining : remaining / pieces;
}

/* Tolerances of a step: of its error, of Newton, and where rounding begins. Returns the first, m. */
static double allow(fu_run *run, double h)
{
    run->round_off = 4e-16 * fmax(run->extent, run->motion);
    const double scale = fmax(run->motion, run->least_motion);
    /* Of what is allowed until t, relative to the motion until then, a step gets the part h/t: local errors then add up
     * to tol times the logarithm of the times at most. With h/duration the first instants, in which hardly anything has
     * moved yet, would take most of the steps. */
    const double share = SAFETY * h / fmax(run->now.t + h, FIRST_PART * run->duration);
    const double allowed = fmax(run->tol * scale * fmin(1.0, run->error_overestimate * share), run->round_off);
    /* what Newton leaves has the same sign step after step and acts like a force: it counts (T/h)^2 times in
     * positions, the local error T/h times; a fixed step is solved as well as it can be, whatever its error */
    const double extent = fmax(run->extent, scale);
    run->newton_tolerance = run->fixed_step > 0.0 ? fmin(1e-2 * h / run->duration * run->last_error, 1e-14 * extent)
                                                  : fmin(0.1 * h / run->duration * allowed, 1e-10 * extent);
    return run->allowed = allowed;
}

/* The next step by the last one's error over what is allowed: the error falls with the power order + 1 of the step,
 * what is allowed with the first. Small changes are not worth a new factorisation. After a step that failed the next ones
 * stay below it for a while. */
static void adapt(fu_run *run, double h, double ratio)
{
    const double factor = fmin(2.0, 0.8 * pow(fmax(ratio, 1e-12), -1.0 / run->order));
    run->ceiling = fmin(RECOVERY * run->ceiling, run->duration);
    const double larger = fmin(h * factor, run->ceiling);
    if (larger > 1.4 * h) run->h = fmax(run->h, larger);
    else if (factor < 0.8) run->h = h * factor;
}

/* The step after one whose error was too large. */
static double smaller(fu_run *run, double h, double ratio)
{
    double want = h * fmax(0.2, 0.8 * pow(ratio, -1.0 / run->order));
    if (!(want > 0.0)) want = 0.2 * h;
    fu_fail(run, FU_ERROR, run->work, -1);
    ++run->statistics.rejected;
    ++run->net_rejections;
    return run->h = want;
}

/* One accepted step towards `target`, or a change of a slide's element. */
static int step_towards(fu_run *run, double target)
{
    const fu_model *model = run->model;
    const double smallest = SMALLEST_STEP * run->duration;
    const int adaptive = run->fixed_step <= 0.0;
    const fu_event none = {FU_NO_EVENT, 0, 0}, late = fu_late_event(run);
    double want = adaptive ? run->h : run->fixed_step;
    if (late.kind) return happened(run, late);
    run->holds = !adaptive || !run->integrator->straddles || fu_has_stops(model) ||
                 fu_ties_a_frame(model, -1);
    for (;;) {
        const double remaining = target - run->now.t;
        double h = fitted(remaining, want);
        if ((h < smallest && remaining > smallest) || run->net_rejections > MOST_STRUGGLE) return FU_NO_CONVERGENCE;
        if (run->holds) h = fmin(h, fu_time_to_boundary(run) + BEYOND * h);
        const double allowed = allow(run, h);
        run->failure.cause = FU_NO_FAILURE;
        run->usual = want;
        if (run->integrator->step(run, h)) {
            if (!run->failure.cause) fu_fail(run, FU_ITERATION, run->next.v, -1);
            want = 0.5 * h;
            if (adaptive && run->retry_factor > 0.0) {
                run->h = want;
                run->ceiling = run->retry_factor * h;
            }
            ++run->statistics.rejected;
            ++run->net_rejections;
            continue;
        }
        const double error = run->integrator->error(run, h), ratio = error / allowed;
        const int changes = fu_count_changes(run);
        if (adaptive && !changes && !(ratio <= 2.0)) {
            want = smaller(run, h, ratio);
            continue;
        }
        fu_event event = fu_find_event(run, none);
        if (changes && (event.kind == FU_CROSSING || !(ratio <= 1.0))) { /* a jump too large for the step: end it there */
            fu_keep_elements(run);
            event = fu_find_event(run, none);
        }
        const double turn = run->holds ? fu_time_of_turn(run, h) : 0.0;
        if (turn > smallest && run->turned < MOST_TURNS) {
            want = turn;
            continue;
        }
        if (event.kind == FU_CROSSING && run->turned >= MOST_TURNS) event = none;
        if (fu_stands_on_boundary(run, event)) {
            ++run->turned;
            return happened(run, event);
        }
        if (event.kind) {
            for (int i = 0; i <= model->n_slides + run->n_watches; ++i) { /* the first of several */
                const fu_event earlier = i ? fu_find_event(run, event) : event;
                if (!earlier.kind) break;
                event = earlier;
                h = fu_locate(run, event, h);
                if (h == 0.0) break;
            }
            if (h == 0.0) {
                want *= 0.5;
                if (want < smallest) return FU_NO_CONVERGENCE;
                continue;
            }
            if (changes) { /* what the error was without the jump is not known yet */
                const double cut = run->integrator->error(run, h) / allow(run, h);
                if (!(cut <= 2.0)) {
                    want = smaller(run, h, cut);
                    continue;
                }
            }
            accept(run, h, event);
            const int status = event.kind == FU_CROSSING ? FU_RUNNING : refresh(run, h);
            return status ? status : happened(run, event);
        }
        accept(run, h, event);
        run->turned = 0;
        run->statistics.error_sum += error;
        run->last_error = error;
        if (adaptive) adapt(run, h, ratio);
        return refresh(run, h);
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
        if (target > run->duration * (1.0 - 1e-12)) target = run->duration;
        if (run->now.t >= target - 1e-12 * run->duration) {
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
