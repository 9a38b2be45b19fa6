/* Lines of a crossing come into contact, and lose it: where the penetration passes zero, where damping would turn the force
 * round, and where a closest point passes the end of its line.
 */
#include "engine.h"

#include <math.h>

static const fu_crossing *crossing_of(const fu_coupling *coupling)
{
    return (const fu_crossing *)coupling;
}

double fu_crossing_margin(const fu_model *model, const fu_crossing *crossing, const fu_state *state)
{
    fu_closest_points points;
    fu_crossing_contact contact;
    fu_find_closest(model, crossing, state, &points);
    if (!points.found) return points.apart > 0.0 ? -points.apart : NAN;
    fu_crossing_contact_at(crossing, &points, &contact);
    if (fu_crossing_swung(crossing, state, &contact)) return NAN;
    const double damping = crossing->law[FU_LAW_DAMPING];
    double margin = contact.depth[0];
    /* a length, that of a millisecond's motion */
    if (damping > 0.0) margin = fmin(margin, (1.0 / damping + contact.depth[1]) * FU_INSTANT);
    for (int line = 0; line < FU_LINES; ++line) {
        margin = fmin(margin, points.s[line] - crossing->low[line]);
        margin = fmin(margin, crossing->high[line] - points.s[line]);
    }
    return margin;
}

/* Makes a number that is below zero while contact stays as it is, the penetration or its opposite, m, and its rate; returns whether
 * the lines are closest within their ends. */
static int approach(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double value[2])
{
    const fu_crossing *crossing = crossing_of(coupling);
    fu_closest_points points;
    fu_crossing_contact contact;
    fu_find_closest(model, crossing, state, &points);
    fu_crossing_contact_at(crossing, &points, &contact);
    for (int k = 0; k < 2; ++k) value[k] = points.touches ? -contact.depth[k] : contact.depth[k];
    for (int line = 0; line < FU_LINES; ++line)
        if (!(points.s[line] >= crossing->low[line] && points.s[line] <= crossing->high[line])) return 0;
    return points.found;
}

/* Returns after which part of a step the cubic with these values and slopes at its ends, below zero there, is largest and above
 * zero; 0 where it is not. */
static double part_to_top(double low, double high, double rise, double fall)
{
    if (!(rise > 0.0 && fall < 0.0 && low <= 0.0 && high < 0.0)) return 0.0;
    const double a = 3.0 * (2.0 * (low - high) + rise + fall), b = 2.0 * (3.0 * (high - low) - 2.0 * rise - fall);
    const double x = 2.0 * rise / (-b + sqrt(b * b - 4.0 * a * rise));
    const double top = low + x * (rise + x * (0.5 * b + x * a / 3.0));
    return top > 0.0 && x > 0.0 && x < 1.0 ? x : 0.0;
}

static double time_of_dip(const fu_run *run, const fu_coupling *coupling, double h)
{
    double before[2], after[2];
    if (!approach(run->model, coupling, &run->now, before) || !(before[1] > 0.0)) return 0.0;
    if (!approach(run->model, coupling, &run->next, after)) return 0.0;
    return h * part_to_top(before[0], after[0], h * before[1], h * after[1]);
}

static int watches(const fu_coupling *coupling, fu_watch *out)
{
    (void)coupling;
    if (out) *out = (fu_watch){.which = 0, .direction = 1};
    return 1;
}

/* The value is negative while contact stays as it is. */
static double watched(const fu_run *run, const fu_coupling *coupling, const fu_state *state, int which)
{
    const double margin = fu_crossing_margin(run->model, crossing_of(coupling), state);
    (void)which;
    return run->now.flags[coupling->flags] ? -margin : margin;
}

static int sign(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int which)
{
    (void)model, (void)coupling, (void)state, (void)which;
    return -1;
}

static int act(fu_run *run, const fu_coupling *coupling, int which, int side, const char **what)
{
    int *touches = &run->now.flags[coupling->flags];
    (void)which, (void)side;
    const double stored = coupling->type->energy(run->model, coupling, &run->now);
    run->now.numbers[coupling->numbers + FU_CROSSING_LEFT_BEHIND] = *touches ? stored : 0.0;
    *touches = !*touches;
    /* a bar that comes in from beyond an end may overlap already: what that stores comes from outside */
    if (*touches) run->external += coupling->type->energy(run->model, coupling, &run->now);
    *what = *touches ? "came into contact" : "lost contact";
    return FU_RUNNING;
}

static int can_act(const fu_coupling *coupling)
{
    (void)coupling;
    return 1;
}

static int begin(fu_run *run, const fu_coupling *coupling)
{
    coupling->type->touch(run->model, coupling, &run->now);
    return FU_RUNNING;
}

const fu_coupling_events fu_crossing_events = {
    .watches = watches,
    .watched = watched,
    .sign = sign,
    .act = act,
    .time_of_dip = time_of_dip,
    .can_act = can_act,
    .begin = begin,
};
