/* Transitions of forces between two points from segment to segment of their law (couplings/force/segments.c): the
 * distance passes a bound, or the force reverses. */
#include "base/cubic.h"
#include "couplings/common/coupling_events.h"
#include "couplings/force/force.h"
#include "equations/run.h"

#include <math.h>

#define BISECTIONS 40 /* of a step: for the instant at a bound, to rounding */

static const fu_point_force *force_of(const fu_coupling *coupling)
{
    return (const fu_point_force *)coupling;
}

static double norm(int dim, const double *gap)
{
    return sqrt(fu_dot(dim, gap, gap));
}

/* Returns the margin of the force of a segment on its permitted side of zero, m; infinity if it may pull and push. */
static double margin_of_sense(const fu_point_force *between, const double *q, int segment, const double *gap,
                              const double *rate, double distance)
{
    const int sense = between->senses[segment];
    double force[3], scaled[FU_MAX_LAW_PARAMETERS];
    if (sense != FU_PULLS_ALONE && sense != FU_PUSHES_ALONE) return INFINITY;
    between->law->force(fu_segment_parameters(between, q, segment, scaled), gap, rate, force);
    return sense * between->compliance * fu_dot(between->dim, force, gap) / distance;
}

/* A transition of the force from its segment to another: `margin` is negative before it, m. */
typedef struct {
    double margin;
    int segment;
} transition;

static transition farther(transition a, transition b)
{
    return b.margin > a.margin ? b : a;
}

/* Returns the nearest segment without force, towards the distances at which the segment's force is zero. */
static int free_beside(const fu_point_force *between, int segment)
{
    const int step = -between->senses[segment];
    while (between->senses[segment] != FU_HAS_NO_FORCE) segment += step;
    return segment;
}

/* Returns the transition to a segment with a force on one side of a segment without: the distance is in it, and its
 * force has the permitted sense. */
static transition entering(const fu_point_force *between, const double *q, int segment, int side, const double *gap,
                           const double *rate, double distance)
{
    const double beyond = side * (distance - between->bounds[segment - (side < 0)]);
    int entered = fu_segment_at_distance(between, distance);
    if (side * (entered - segment) < 1) entered = segment + side;
    return (transition){fmin(beyond, margin_of_sense(between, q, entered, gap, rate, distance)), entered};
}

/* Returns the nearest transition from a segment, or one that has happened. */
static transition transition_from(const fu_model *model, const fu_point_force *between, const fu_state *state,
                                  int segment)
{
    transition found = {-INFINITY, segment};
    double gap[3], rate[3];
    fu_gap(model, between, state, gap, rate);
    const double distance = norm(between->dim, gap);
    const double sense = margin_of_sense(between, state->q, segment, gap, rate, distance);
    if (sense < INFINITY) found = (transition){-sense, free_beside(between, segment)};
    for (int side = -1; side <= 1; side += 2) {
        const int beside = segment + side;
        if (beside < 0 || beside >= between->n_segments) continue;
        if (between->senses[segment] == FU_HAS_NO_FORCE)
            found = farther(found, entering(between, state->q, segment, side, gap, rate, distance));
        else found = farther(found, (transition){side * (distance - between->bounds[segment - (side < 0)]), beside});
    }
    return found;
}

static transition next_transition(const fu_model *model, const fu_point_force *between, const fu_state *state)
{
    return transition_from(model, between, state, fu_force_segment(between, state));
}

/* Transitions follow from the positions of the points; each leads from segment to segment. */
static int update_flags(const fu_model *model, const fu_coupling *coupling, const fu_state *from, fu_state *to)
{
    const fu_point_force *between = force_of(coupling);
    int *segment = &to->flags[coupling->flags];
    const int before = *segment;
    *segment = from->flags[coupling->flags];
    for (int i = 0; i < between->n_segments; ++i) {
        const transition next = next_transition(model, between, to);
        if (!(next.margin > 0.0)) break;
        *segment = next.segment;
    }
    return *segment != before;
}

/* The event of a transition from segment to segment in words; null at a corner of a table. */
static const char *words(const fu_point_force *between, int before, int after)
{
    const int was_free = between->senses[before] == FU_HAS_NO_FORCE,
              is_free = between->senses[after] == FU_HAS_NO_FORCE;
    return is_free ? "became slack" : !was_free ? "" : after > before ? "became taut" : "came into contact";
}

/* The distance of the points at a state, and quantities of the force: the gap, its rate, its acceleration. */
typedef struct {
    double distance, gap[3], rate[3], acceleration[3];
} gap_motion;

/* Makes them those that the law takes. Their speed across is that of the points, about a shorter distance. */
static void shorten(const fu_point_force *between, const fu_state *state, gap_motion *l)
{
    if (between->length_dof < 0) return;
    const double square = fu_dot(3, l->gap, l->gap), along = fu_dot(3, l->gap, l->rate);
    const double across = fu_dot(3, l->rate, l->rate) - along * along / square;
    const double ratio = fu_shorten_gap(between, state, l->gap, l->rate);
    const double bend = across * (1.0 - 1.0 / ratio) / square - state->acceleration[between->length_dof] / sqrt(square);
    for (int d = 0; d < between->dim; ++d) l->acceleration[d] += bend * l->gap[d] / ratio;
}

static gap_motion look_at(const fu_model *model, const fu_point_force *between, const fu_state *state)
{
    gap_motion l = {.distance = 0.0};
    for (int e = 0; e < 2; ++e) {
        double p[3], v[3], a[3];
        fu_point_at(model, &between->attachments[e], state, p, v, a);
        for (int d = 0; d < between->dim; ++d) {
            l.gap[d] += e ? p[d] : -p[d];
            l.rate[d] += e ? v[d] : -v[d];
            l.acceleration[d] += e ? a[d] : -a[d];
        }
    }
    shorten(between, state, &l);
    l.distance = norm(between->dim, l.gap);
    return l;
}

/* Returns the distance of the points less the bound of a segment, m, and its rate. */
static fu_course from_bound(const fu_model *model, const fu_point_force *between, const fu_state *state, int bound)
{
    double gap[3], gap_rate[3];
    fu_gap(model, between, state, gap, gap_rate);
    const double distance = norm(between->dim, gap);
    return (fu_course){distance - between->bounds[bound], fu_dot(between->dim, gap, gap_rate) / distance};
}

/* The distance of the points at an end of a step less the bound of a segment, and its derivatives by the part of the
 * step, m. */
typedef struct {
    double value, rate, bend;
} end_course;

static end_course end_of(const fu_model *model, const fu_point_force *between, const fu_state *state, int bound,
                         double h)
{
    const int dim = between->dim;
    const gap_motion l = look_at(model, between, state);
    const double rate = fu_dot(dim, l.gap, l.rate) / l.distance;
    const double bend = (fu_dot(dim, l.rate, l.rate) + fu_dot(dim, l.gap, l.acceleration) - rate * rate) / l.distance;
    return (end_course){l.distance - between->bounds[bound], h * rate, h * h * bend};
}

/* Returns the polynomial at a part of the step: of degree 3 without second derivatives at its ends, else of degree
 * 5. */
static double between_ends(end_course a, end_course b, int has_accelerations, double x)
{
    const double y = 1.0 - x;
    const fu_step_ends ends = {{a.value, b.value}, {a.rate, b.rate}};
    if (!has_accelerations) return fu_value_within(&ends, 1.0, x);
    return y * y * y * ((1.0 + 3.0 * x + 6.0 * x * x) * a.value + x * (1.0 + 3.0 * x) * a.rate + 0.5 * x * x * a.bend) +
           x * x * x * ((1.0 + 3.0 * y + 6.0 * y * y) * b.value - y * (1.0 + 3.0 * y) * b.rate + 0.5 * y * y * b.bend);
}

/* By the polynomial of the distance through both ends of the step (Hermite); where a damper reverses the force, by the
 * line of its margins. */
static double part_of_step(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                           double h, int has_accelerations, const char **what)
{
    const fu_point_force *between = force_of(coupling);
    const int before = fu_force_segment(between, from), there = fu_force_segment(between, to);
    const int after = there == before ? transition_from(model, between, to, before).segment : there,
              up = after > before;
    double low = 0.0, high = 1.0;
    *what = words(between, before, after);
    if (coupling->is_damped) {
        const double a = transition_from(model, between, from, before).margin,
                     b = transition_from(model, between, to, before).margin;
        return a < 0.0 && b > 0.0 ? a / (a - b) : 1.0;
    }
    const int bound = up ? before : before - 1;
    const end_course a = end_of(model, between, from, bound, h), b = end_of(model, between, to, bound, h);
    for (int i = 0; i < BISECTIONS; ++i) {
        const double x = 0.5 * (low + high), value = between_ends(a, b, has_accelerations, x);
        if ((up ? value : -value) < 0.0) low = x;
        else high = x;
    }
    return high;
}

static double since(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_point_force *between = force_of(coupling);
    const int before = fu_force_segment(between, state), up = next_transition(model, between, state).segment > before;
    if (coupling->is_damped) return NAN;
    const fu_course course = from_bound(model, between, state, up ? before : before - 1);
    return course.value / course.rate;
}

static void force_change(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                         double factor, double *f)
{
    fu_add_force_change(model, force_of(coupling), to, fu_force_segment(force_of(coupling), from), factor, f);
}

static int functions(const fu_coupling *coupling, fu_event_function *out)
{
    if (force_of(coupling)->n_segments == 1) return 0;
    if (out) *out = (fu_event_function){.which = 0, .direction = 1};
    return 1;
}

static double value_of(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int which)
{
    (void)which;
    return next_transition(model, force_of(coupling), state).margin;
}

/* Returns the distance beyond a bound to a side, m, and its rate. */
static fu_course beyond(const fu_point_force *between, int bound, int side, const gap_motion *l)
{
    const double rate = fu_dot(between->dim, l->gap, l->rate) / l->distance;
    return (fu_course){side * (l->distance - between->bounds[bound]), side * rate};
}

/* Returns the distance of a segment's force on the wrong side of zero, m, and its rate. */
static fu_course wrong_sense(const fu_point_force *between, const double *q, int segment, const gap_motion *l)
{
    const int dim = between->dim;
    double force[3], by_gap[9], by_rate[9], change = 0.0, scaled[FU_MAX_LAW_PARAMETERS];
    between->law->tangent(fu_segment_parameters(between, q, segment, scaled), l->gap, l->rate, force, by_gap, by_rate);
    for (int i = 0; i < dim; ++i)
        for (int k = 0; k < dim; ++k)
            change += l->gap[i] * (by_gap[i * dim + k] * l->rate[k] + by_rate[i * dim + k] * l->acceleration[k]);
    const double along = fu_dot(dim, force, l->gap) / l->distance, rate = fu_dot(dim, l->gap, l->rate) / l->distance;
    const double slope = (change + fu_dot(dim, force, l->rate) - along * rate) / l->distance;
    const double unit = -between->senses[segment] * between->compliance;
    return (fu_course){unit * along, unit * slope};
}

/* Each transition alone is smooth. A segment with a force is entered at its bound first, where its damper has the
 * permitted sense. */
static double grazing(const fu_run *run, const fu_coupling *coupling, int which, double h)
{
    const fu_point_force *between = force_of(coupling);
    const int segment = fu_force_segment(between, &run->now), sense = between->senses[segment];
    const gap_motion from = look_at(run->model, between, &run->now), to = look_at(run->model, between, &run->next);
    double first = 0.0;
    (void)which;
    for (int side = -1; side <= 1; ++side) {
        const int bound = segment - (side < 0), by_sense = side == 0;
        if (by_sense ? sense != FU_PULLS_ALONE && sense != FU_PUSHES_ALONE
                     : bound < 0 || bound >= between->n_segments - 1)
            continue;
        const double found =
            by_sense ? fu_grazing_time(wrong_sense(between, run->now.q, segment, &from),
                                       wrong_sense(between, run->next.q, segment, &to), -1, h, run->round_off)
                     : fu_grazing_time(beyond(between, bound, side, &from), beyond(between, bound, side, &to), -1, h,
                                       run->round_off);
        if (found > 0.0 && (first == 0.0 || found < first)) first = found;
    }
    return first;
}

static const char *change(const fu_model *model, const fu_coupling *coupling, fu_state *now, int which, int side)
{
    const fu_point_force *between = force_of(coupling);
    const int before = fu_force_segment(between, now), after = next_transition(model, between, now).segment;
    (void)which, (void)side;
    now->flags[coupling->flags] = after;
    return words(between, before, after);
}

static int can_act(const fu_coupling *coupling)
{
    return force_of(coupling)->n_segments > 1;
}

/* A force that the damper would reverse at the start is zero. */
static void begin(const fu_model *model, const fu_coupling *coupling, fu_state *now)
{
    const fu_point_force *between = force_of(coupling);
    if (between->n_segments == 1) return;
    fu_detect_segment(model, coupling, now);
    const transition next = next_transition(model, between, now);
    if (next.margin > 0.0) now->flags[coupling->flags] = next.segment;
}

static const fu_state_event_operations of_state = {.value = value_of, .change = change, .begin = begin};
static const fu_deferred_operations deferred = {
    .update_flags = update_flags, .part = part_of_step, .since = since, .force_change = force_change};

const fu_coupling_events fu_point_force_events = {
    .of_state = &of_state,
    .functions = functions,
    .grazing = grazing,
    .can_act = can_act,
    .deferred = &deferred,
};
