/* Start and end of contact of lines in a crossing: the penetration passes zero, damping would reverse the force, or a
 * closest point passes the end of its line. */
#include "base/cubic.h"
#include "couplings/common/coupling_events.h"
#include "couplings/crossing/crossing.h"
#include "equations/run.h"

#define SEPARATION_ENERGY 1e-6 /* of the energy of contact: lines with less at its end had separated */

static const fu_crossing *crossing_of(const fu_coupling *coupling)
{
    return (const fu_crossing *)coupling;
}

/* Computes the gap of the lines, m, and its rate; returns whether their closest points are within their ends. */
static int gap_of(const fu_model *model, const fu_crossing *crossing, const fu_state *state, fu_course *gap)
{
    fu_closest_points points;
    fu_crossing_contact contact;
    fu_find_closest(model, crossing, state, &points);
    fu_crossing_contact_at(crossing, &points, &contact);
    *gap = (fu_course){-contact.depth[0], -contact.depth[1]};
    return points.found && fu_crossing_distance_to_ends(crossing, &points) >= 0.0;
}

/* Lines in contact may separate within a step and come into contact again; lines apart may come into contact. */
static double grazing(const fu_run *run, const fu_coupling *coupling, int which, double h)
{
    const fu_crossing *crossing = crossing_of(coupling);
    fu_course from, to;
    (void)which;
    if (!run->now.flags[coupling->flags])
        return fu_crossing_detect_within(run->model, crossing, &run->now, &run->next, h, run->round_off);
    const int within = gap_of(run->model, crossing, &run->now, &from) && gap_of(run->model, crossing, &run->next, &to);
    return within ? fu_grazing_time(from, to, -1, h, run->round_off) : 0.0;
}

/* The value is negative while the state of contact is unchanged. In motion, lines that are apart over their whole
 * length do not touch: they may become parallel, or pass round each other's ends. */
static double value_of(const fu_run *run, const fu_coupling *coupling, const fu_state *state, int which)
{
    const double margin = fu_crossing_margin(run->model, crossing_of(coupling), state);
    (void)which;
    if (run->now.flags[coupling->flags]) return -margin;
    if (margin < 0.0) return margin;
    const double gap = fu_crossing_clearance(run->model, coupling, state).gap;
    return gap > 0.0 ? -gap : margin;
}

static double depth(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double value)
{
    fu_course gap;
    (void)value;
    if (!state->flags[coupling->flags]) return 0.0;
    gap_of(model, crossing_of(coupling), state, &gap);
    return -gap.value;
}

/* Returns whether lines have passed round an end of one of them and overlap from the opposite side: their closest
 * points come within that end beyond each other's axes. There is no contact then. Lines that passed an end during
 * contact are excluded. */
static int has_come_round(const fu_run *run, const fu_crossing *crossing)
{
    const double left_behind = run->now.numbers[crossing->base.numbers + FU_CROSSING_LEFT_BEHIND];
    fu_closest_points points;
    fu_crossing_contact contact;
    fu_find_closest(run->model, crossing, &run->now, &points);
    fu_crossing_contact_at(crossing, &points, &contact);
    const int at_end =
        fu_crossing_margin_of(crossing, &points, &contact) == fu_crossing_distance_to_ends(crossing, &points);
    return at_end && contact.depth[0] > crossing->law[0] && left_behind < SEPARATION_ENERGY * contact.energy;
}

static int act(fu_run *run, const fu_coupling *coupling, int which, int side, const char **what)
{
    int *in_contact = &run->now.flags[coupling->flags];
    (void)which, (void)side;
    if (!*in_contact && has_come_round(run, crossing_of(coupling))) {
        fu_fail(run, FU_NOT_KNOWN, run->now.v, coupling->number);
        return FU_NO_CONVERGENCE;
    }
    const double stored = coupling->type->energy(run->model, coupling, &run->now);
    run->now.numbers[coupling->numbers + FU_CROSSING_LEFT_BEHIND] = *in_contact ? stored : 0.0;
    *in_contact = !*in_contact;
    if (*in_contact && crossing_of(coupling)->friction > 0.0) {
        fu_closest_points points;
        fu_find_closest(run->model, crossing_of(coupling), &run->now, &points);
        fu_crossing_begin_stick(crossing_of(coupling), &points, &run->now);
    }
    /* a bar from beyond an end may overlap already: the stored energy is external work */
    if (*in_contact) run->external += coupling->type->energy(run->model, coupling, &run->now);
    *what = *in_contact ? "came into contact" : "lost contact";
    return FU_RUNNING;
}

static int begin(fu_run *run, const fu_coupling *coupling)
{
    coupling->type->detect(run->model, coupling, &run->now);
    coupling->type->history->update(run->model, coupling, &run->now);
    return FU_RUNNING;
}

const fu_coupling_events fu_crossing_events = {
    .direction = 1,
    .value = value_of,
    .depth = depth,
    .act = act,
    .grazing = grazing,
    .begin = begin,
};
