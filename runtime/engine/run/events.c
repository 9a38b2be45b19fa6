/* Events: a slide leaves its element, a quantity passes a threshold, a function of the user's changes sign. */
#include "engine.h"

#include <stdlib.h>
#include <string.h>

#define MOST_TRIALS 80
#define FEW_TRIALS 10     /* after so many every second one halves the interval */
#define LEAST_STEP 1e-13  /* of the duration */
#define FINER 1e-2        /* of Newton's tolerance: lest its noise rule where the event is */
#define PRECISE 1e-13     /* of an element, or of what a watched quantity changes by in the step */
#define LITTLE 1e-2       /* of what is allowed */
#define LARGEST_MISS 1e-6 /* of an element */
#define SMALLEST 1e-300   /* a value with a sign */

static double boundary_tolerance(const fu_run *run, int j)
{
    return 1e-11 * run->model->cables[run->model->slides[j].cable].length;
}

/* how far s lies outside its element, negative inside */
static double outside(const fu_run *run, const fu_state *state, int j, int *side)
{
    const double length = run->model->cables[run->model->slides[j].cable].length;
    const double x = state->s[j] - fu_element_start(run->model, j, state->element[j]);
    *side = x > 0.5 * length ? 1 : -1;
    return *side > 0 ? x - length : -x;
}

/* Slides of `next` on the elements that hold their s, unless they are to keep those of `now`. The matrix is of the
 * elements that it was made with. */
void fu_seat_slides(fu_run *run)
{
    if (run->keep_elements) return;
    for (int j = 0; j < run->model->n_slides; ++j) {
        const fu_cable *cable = &run->model->cables[run->model->slides[j].cable];
        int side, *element = &run->next.element[j];
        if (!(outside(run, &run->next, j, &side) > boundary_tolerance(run, j))) continue;
        const double place = fmin(fmax(run->next.s[j] / cable->length, 0.0), cable->n_elements - 1.0);
        if ((int)place != *element) run->factored = 0;
        *element = (int)place;
    }
}

/* how many boundaries the slides are across at `next` */
int fu_count_changes(const fu_run *run)
{
    int count = 0;
    for (int j = 0; j < run->model->n_slides; ++j) count += abs(run->next.element[j] - run->now.element[j]);
    return count;
}

/* Slides of `next` on the elements of `now`, which they have left. */
void fu_keep_elements(fu_run *run)
{
    memcpy(run->next.element, run->now.element, sizeof(int) * (size_t)run->model->n_slides);
}

/* s until the first of the slides reaches a boundary of its element at the speed that it has */
double fu_time_to_boundary(fu_run *run)
{
    double least = INFINITY;
    for (int j = 0; j < run->model->n_slides; ++j) {
        const double rate = fu_slide_rate(run->model, &run->now, j);
        const double end = fu_element_start(run->model, j, run->now.element[j] + (rate > 0.0));
        const double slip_direction = fabs(end - run->now.s[j]);
        if (slip_direction > boundary_tolerance(run, j)) least = fmin(least, slip_direction / fabs(rate));
    }
    return least;
}

/* How long after `now` a slide turns, by the parabola through both ends of the step, that is back at `next` from beyond a
 * boundary, or beyond one that it stood on and has left inwards; 0 where none does. */
double fu_time_of_turn(fu_run *run, double h)
{
    for (int j = 0; j < run->model->n_slides; ++j) {
        const double rise = h * fu_slide_rate(run->model, &run->now, j), slip_direction = fabs(rise);
        const double at = 0.5 * rise / (rise - (run->next.s[j] - run->now.s[j])), close = boundary_tolerance(run, j);
        const int up = rise > 0.0, element = run->now.element[j];
        const double ahead = fabs(fu_element_start(run->model, j, element + up) - run->now.s[j]);
        const double behind = fabs(fu_element_start(run->model, j, element + !up) - run->now.s[j]);
        const double gone = (up ? 1.0 : -1.0) * (run->next.s[j] - run->now.s[j]);
        if (at > 0.0 && at < 1.0 && ((0.5 * slip_direction * at > ahead + close && gone < ahead) ||
                                     (behind <= close && gone < -behind - close))) return at * h;
    }
    return 0.0;
}

/* The force on a rider along the cable, as results have it; not a number where eq 38 has no solution. */
static double traction(const fu_run *run, const fu_state *state, int slide)
{
    fu_accelerator *work = (fu_accelerator *)&run->accelerator; /* scratch: a run is never a constant */
    fu_slide_output out;
    if (fu_accelerations(run->model, state, work, run->watch_work, 0)) return NAN;
    fu_slide_outputs(run->model, state, slide, run->watch_work, work, &out);
    return out.traction;
}

/* what an event of the user's, or of a slide's, watches, positive where it has happened when `side` is 1 */
static double watched(const fu_run *run, const fu_state *state, int k)
{
    const fu_watch *watch = &run->watches[k];
    switch (watch->kind) {
    case FU_WATCH_Q: return state->q[watch->index] - watch->value;
    case FU_WATCH_V: return state->v[watch->index] - watch->value;
    case FU_WATCH_S: return state->s[watch->index] - watch->value;
    case FU_WATCH_RATE: return fu_slide_rate(run->model, state, watch->index) - watch->value;
    case FU_WATCH_TRACTION: return traction(run, state, watch->index) - watch->value;
    case FU_WATCH_STICK: return fu_stick_margin(run, state, watch->index);
    case FU_WATCH_BUFFER: return fu_buffer_margin(run, state, watch->index, (int)watch->value);
    default: return run->call(run->context, k, state);
    }
}

/* an event's value at a state: it happens where this reaches zero from below */
static double value(const fu_run *run, const fu_state *state, fu_event event)
{
    if (event.kind == FU_WATCHED) return event.side * watched(run, state, event.which);
    const int boundary = run->now.element[event.which] + (event.side > 0);
    return event.side * (state->s[event.which] - fu_element_start(run->model, event.which, boundary));
}

/* whether a watch passes between the value kept and this one */
static fu_event passes(const fu_run *run, int k, double after)
{
    const double before = run->watched[k];
    const int side = before < 0.0 && after >= 0.0 ? 1 : before > 0.0 && after < 0.0 ? -1 : 0;
    return side && run->watches[k].direction * side >= 0 ? (fu_event){FU_WATCHED, k, side}
                                                         : (fu_event){FU_NO_EVENT, 0, 0};
}

/* The slide of `next` that is farthest outside its element, else the first of the user's events between `now` and
 * `next`, but for one. */
fu_event fu_find_event(const fu_run *run, fu_event but)
{
    fu_event found = {FU_NO_EVENT, 0, 0};
    double worst = 0.0;
    for (int j = 0; j < run->model->n_slides; ++j) {
        int side;
        if (run->next.mode[j] == FU_LEFT) continue; /* its s stays where it was */
        const double d = outside(run, &run->next, j, &side) - boundary_tolerance(run, j);
        if (d > worst && (but.kind != FU_CROSSING || but.which != j)) {
            worst = d;
            found = (fu_event){FU_CROSSING, j, side};
        }
    }
    for (int k = 0; k < run->n_watches && !found.kind; ++k)
        if (but.kind != FU_WATCHED || but.which != k) found = passes(run, k, watched(run, &run->next, k));
    return found;
}

/* Whether a slide stands on the boundary already: then the element changes and not the time. */
int fu_stands_on_boundary(const fu_run *run, fu_event event)
{
    int side;
    return event.kind == FU_CROSSING && outside(run, &run->now, event.which, &side) >=
        -boundary_tolerance(run, event.which) && side == event.side;
}

/* The fraction of a step at which g = g_low + rate x + ... reaches zero on its way to g_high: that of the parabola. */
static double root_of_parabola(double g_low, double g_high, double rate)
{
    const double bend = g_high - g_low - rate, square = rate * rate - 4.0 * bend * g_low;
    return square > 0.0 ? -2.0 * g_low / (rate + sqrt(square)) : -g_low / (g_high - g_low);
}

/* How close to an event a step must end. A slide that goes on in the next element, a way d from the boundary, has gone
 * that way on the wrong curve, whose direction is wrong by d times the jump of r_xx: its velocity by less than rate
 * d/length for elements that bend by less than a radian. Over the step that shall be little of what is allowed. */
static double landing(const fu_run *run, fu_event event, double range)
{
    if (event.kind == FU_WATCHED) return PRECISE * range;
    const fu_cable *cable = &run->model->cables[run->model->slides[event.which].cable];
    const int next = run->now.element[event.which] + event.side;
    if (run->fixed_step > 0.0 || next < 0 || next >= cable->n_elements) return PRECISE * cable->length;
    return fmax(PRECISE, fmin(LARGEST_MISS, LITTLE * run->allowed / range)) * cable->length;
}

static int is_of_a_slide(const fu_watch *watch)
{
    return watch->kind == FU_WATCH_STICK || watch->kind == FU_WATCH_BUFFER;
}

/* An interval of steps in which g, the event's value, passes zero: g_low < 0 <= g_high. */
typedef struct {
    double low, high, g_low, g_high;
    int last; /* the side that has moved last: 1 high, -1 low */
} bracket;

static double secant(const bracket *b)
{
    return b->low + (b->high - b->low) * b->g_low / (b->g_low - b->g_high);
}

/* Narrows the bracket by g at `middle`; the value of an end that stays twice is halved (Illinois). */
static void narrow(bracket *b, double middle, double g)
{
    const int side = g >= 0.0 ? 1 : -1;
    if (side > 0) {
        b->high = middle;
        b->g_high = g;
        if (b->last > 0) b->g_low *= 0.5;
    } else {
        b->low = middle;
        b->g_low = g;
        if (b->last < 0) b->g_high *= 0.5;
    }
    b->last = side;
}

/* For an event that has just happened, and whose value leaves its zero anew: moves the low end to where it is off that zero
 * again. Returns 1 where it is found, 0 where there is none, -1 where a step fails. */
static int leave_zero(fu_run *run, fu_event event, bracket *b, double least, double close)
{
    for (b->low = 0.5 * b->high; b->low > least; b->low *= 0.5) {
        if (run->integrator->step(run, b->low)) return -1;
        b->g_low = value(run, &run->next, event);
        if (b->g_low < -close) return 1;
        b->high = b->low;
        b->g_high = b->g_low;
    }
    return 0;
}

/* Shortens the step until it ends where the event happens; returns the step, 0 on failure. `next` is there then. */
static double search(fu_run *run, fu_event event, bracket b, double middle, double least, double close)
{
    for (int i = 0; i < MOST_TRIALS; ++i) {
        /* rounding may rule g */
        if (!(middle > b.low && middle < b.high) || (i > FEW_TRIALS && i % 2)) middle = 0.5 * (b.low + b.high);
        if (run->integrator->step(run, middle)) return 0.0;
        const double g = value(run, &run->next, event);
        if (fabs(g) <= close || (g >= 0.0 && middle - b.low <= least)) return middle;
        narrow(&b, middle, g);
        if (g < 0.0 && b.high - b.low <= least) return run->integrator->step(run, b.high) ? 0.0 : b.high;
        middle = secant(&b);
    }
    return 0.0;
}

/* The same from the step h, which leads beyond the event. */
static double locate(fu_run *run, fu_event event, double h)
{
    bracket b = {0.0, h, 0.0, value(run, &run->next, event), 0};
    b.g_low = event.kind == FU_WATCHED ? event.side * run->watched[event.which] : value(run, &run->now, event);
    const double least = LEAST_STEP * run->duration, close = landing(run, event, b.g_high - b.g_low);
    double middle = h * b.g_low / (b.g_low - b.g_high);
    if (event.kind == FU_CROSSING) {
        const double rate = event.side * fu_slide_rate(run->model, &run->now, event.which);
        middle = h * root_of_parabola(b.g_low, b.g_high, h * rate);
    }
    if (b.g_high <= close) return h;
    if (event.kind == FU_WATCHED && is_of_a_slide(&run->watches[event.which]) && fabs(b.g_low) <= close) {
        const int found = leave_zero(run, event, &b, least, close);
        if (found < 0) return 0.0;
        if (!found) return b.high < h || !run->integrator->step(run, b.high) ? b.high : 0.0;
        middle = secant(&b);
    }
    return search(run, event, b, middle, least, close);
}

/* The same, with slides that keep their elements until one of them leaves it. */
double fu_locate(fu_run *run, fu_event event, double h)
{
    const int kept = run->keep_elements;
    run->keep_elements |= event.kind == FU_CROSSING;
    run->newton_tolerance *= FINER;
    const double found = locate(run, event, h);
    run->keep_elements = kept;
    return found;
}

/* Values of the user's events at `now`; none of those that have just passed, or rounding would let them pass again.
 * `late` tells which did together with the one that the step was for. */
void fu_watch_now(fu_run *run, fu_event event)
{
    for (int k = 0; k < run->n_watches; ++k) {
        const int expected = event.kind == FU_WATCHED && event.which == k;
        const double value = expected ? 0.0 : watched(run, &run->now, k);
        const fu_event late = passes(run, k, value);
        if (expected || late.kind) run->watched[k] = 0.0;
        else if (value != 0.0) run->watched[k] = value;
        if (!expected && late.kind) run->late[k] = late.side;
    }
}

/* The side on which a slide's watches stand now that a slide has another state, and has just had their value zero. */
void fu_watch_anew(fu_run *run, int slide)
{
    for (int k = 0; k < run->n_watches; ++k) {
        const fu_watch *watch = &run->watches[k];
        if (!is_of_a_slide(watch)) continue;
        if (watch->index == slide) run->late[k] = 0;
        if (run->late[k]) continue;
        const int side = watch->kind == FU_WATCH_BUFFER && run->now.contact[watch->index] == (int)watch->value ? 1 : -1;
        run->watched[k] = side * fmax(side * watched(run, &run->now, k), SMALLEST);
    }
}

/* An event of the user's that passed together with another one. */
fu_event fu_late_event(fu_run *run)
{
    for (int k = 0; k < run->n_watches; ++k)
        if (run->late[k]) {
            const fu_event event = {FU_WATCHED, k, run->late[k]};
            run->late[k] = 0;
            return event;
        }
    return (fu_event){FU_NO_EVENT, 0, 0};
}
