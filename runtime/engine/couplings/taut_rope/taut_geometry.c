/* Geometry of ropes without mass: their points, straight parts, lengths and ways over wheels. */
#include "bodies/model.h"
#include "couplings/taut_rope/taut_rope.h"

#include <math.h>
#include <string.h>

enum { DIM = 2, SPACE = 3, SIDES = 2 };

const fu_taut_point *fu_taut_point_of(const fu_model *model, const fu_taut_rope *rope, int place)
{
    return (const fu_taut_point *)model->couplings[rope->points[place]];
}

const fu_taut_point *fu_taut_end(const fu_model *model, const fu_taut_rope *rope, int end)
{
    return fu_taut_point_of(model, rope, end ? rope->n_points - 1 : 0);
}

int fu_taut_slips(const fu_taut_point *point, const fu_state *state)
{
    return state->flags[point->base.flags + FU_SLIPS];
}

int fu_taut_slips_at(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, int end)
{
    return fu_taut_slips(fu_taut_end(model, rope, end), state);
}

const fu_taut_rope *fu_taut_beside(const fu_model *model, const fu_taut_point *point, int side)
{
    return point->ropes[side] < 0 ? 0 : (const fu_taut_rope *)model->couplings[point->ropes[side]];
}

const fu_taut_rope *fu_taut_beyond(const fu_model *model, const fu_taut_rope *rope, int end)
{
    return fu_taut_beside(model, fu_taut_end(model, rope, end), end);
}

fu_taut_history *fu_taut_history_of(const fu_taut_rope *rope, const fu_state *state)
{
    return (fu_taut_history *)(state->numbers + rope->base.numbers);
}

int fu_touches(const fu_taut_point *point, const fu_state *state)
{
    return state->flags[point->base.flags + FU_TOUCHES];
}

int fu_next_touched(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, int place)
{
    do ++place;
    while (place < rope->n_points - 1 && !fu_touches(fu_taut_point_of(model, rope, place), state));
    return place;
}

int fu_touched_before(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, int place)
{
    do --place;
    while (place > 0 && !fu_touches(fu_taut_point_of(model, rope, place), state));
    return place;
}

int fu_is_taut(const fu_taut_rope *rope, const fu_state *state)
{
    return state->flags[rope->base.flags];
}

void fu_taut_centre(const fu_model *model, const fu_taut_point *point, const fu_state *state, fu_attachment_state *out)
{
    const fu_state moving = {.t = state->t, .q = state->q, .v = state->v ? state->v : (double *)model->zero};
    fu_attachment_at(model, &point->attachments[0], &moving, 0.0, FU_POINT | FU_AXES, out);
}

double fu_taut_carrier_angle(const fu_taut_point *point, const fu_state *state, const fu_attachment_state *at)
{
    return fu_near_angle(atan2(at->A[DIM], at->A[0]), state->numbers[point->base.numbers + 1]);
}

double fu_taut_turn(const fu_taut_point *point, const fu_state *state, const fu_attachment_state *at)
{
    const double own = point->turn < 0 ? 0.0 : state->q[point->turn];
    return point->in_space ? own : fu_taut_carrier_angle(point, state, at) + own;
}

double fu_taut_spin(const fu_model *model, const fu_taut_point *point, const fu_state *state,
                    const fu_attachment_state *at)
{
    const double *v = state->v ? state->v : model->zero;
    const double own = point->turn < 0 ? 0.0 : v[point->turn];
    return point->in_space ? own : at->omega[0] + own;
}

double fu_taut_share_of_end(const fu_model *model, const fu_taut_rope *rope, int end)
{
    const double radius = fu_taut_point_of(model, rope, end ? rope->n_points - 1 : 0)->radius;
    return end ? -radius : radius;
}

/* Computes the straight part between two points at these places and velocities. */
static void find_part(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, int from, int to,
                      const fu_attachment_state *one, const fu_attachment_state *other, fu_taut_part *out)
{
    const fu_taut_point *start = fu_taut_point_of(model, rope, from), *end = fu_taut_point_of(model, rope, to);
    const int first = from == 0, last = to == rope->n_points - 1;
    out->from = from;
    out->to = to;
    out->dim = model->dim;
    if (rope->part) {
        /* the angle before a point is its second number */
        const double near[SIDES] = {state->numbers[start->base.numbers], state->numbers[end->base.numbers + 1]};
        out->feet.radius[0] = start->radius;
        out->feet.radius[1] = end->radius;
        out->feet.aside[0] = state->numbers[start->base.numbers + FU_ASIDE];
        out->feet.aside[1] = state->numbers[end->base.numbers + FU_ASIDE];
        out->feet.way_share[0] = first ? fu_taut_share_of_end(model, rope, 0) : 0.0;
        out->feet.way_share[1] = last ? fu_taut_share_of_end(model, rope, 1) : 0.0;
        fu_taut_part_in_space(rope->part, one, other, near, out);
        return;
    }
    out->rise = end->radius - start->radius;
    for (int d = 0; d < DIM; ++d) {
        out->d[d] = other->p[d] - one->p[d];
        out->d_rate[d] = other->v[d] - one->v[d];
    }
    rope->kernel->straight(out->d, out->rise, &out->l, out->u, out->l_d, out->b_d);
    const double angle = fu_near_angle(atan2(out->u[1], out->u[0]), state->numbers[start->base.numbers]),
                 turning = fu_dot(DIM, out->b_d, out->d_rate);
    out->share[FU_DRAWN] = (first ? 0.0 : start->radius) - (last ? 0.0 : end->radius);
    out->share[FU_WAY] =
        (first ? fu_taut_share_of_end(model, rope, 0) : 0.0) + (last ? fu_taut_share_of_end(model, rope, 1) : 0.0);
    out->growth = fu_dot(DIM, out->l_d, out->d_rate);
    out->drawn = out->l + out->share[FU_DRAWN] * angle;
    out->drawn_rate = out->growth + out->share[FU_DRAWN] * turning;
    for (int k = 0; k < SIDES; ++k) {
        out->angle[k] = angle;
        out->turning[k] = turning;
        out->fleet[k] = 0.0;
    }
}

void fu_taut_part_at(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, int from, int to,
                     fu_taut_part *out)
{
    fu_attachment_state one, other;
    fu_taut_centre(model, fu_taut_point_of(model, rope, from), state, &one);
    fu_taut_centre(model, fu_taut_point_of(model, rope, to), state, &other);
    find_part(model, rope, state, from, to, &one, &other, out);
}

/* Adds the way of an end onto its wheel by an angle of the straight part there, or by a rotation of the wheel. */
static void add_way(int end, double share, double angle, double rate, fu_taut_lengths *out)
{
    out->way[end] += share * angle;
    out->way_rate[end] += share * rate;
}

/* Subtracts the rotation of the wheel at an end, unless the rope slips there. */
static void subtract_turn(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, int end,
                          const fu_attachment_state *at, fu_taut_lengths *out)
{
    const fu_taut_point *point = fu_taut_point_of(model, rope, end ? rope->n_points - 1 : 0);
    const double share = fu_taut_share_of_end(model, rope, end);
    if (share != 0.0 && !fu_taut_slips(point, state))
        add_way(end, -share, fu_taut_turn(point, state, at) - rope->carriers[end],
                fu_taut_spin(model, point, state, at), out);
}

void fu_taut_pull(const fu_taut_part *part, double pull[3])
{
    if (part->dim == SPACE) {
        memcpy(pull, part->u, sizeof part->u);
        return;
    }
    const double on_angle = part->share[FU_DRAWN] + part->share[FU_WAY];
    for (int d = 0; d < DIM; ++d) pull[d] = part->l_d[d] + on_angle * part->b_d[d];
}

/* Adds the forces of a part under a tension to those on the dofs, from the states of its points. */
static void add_forces_of_part(const fu_model *model, const fu_taut_rope *rope, const fu_taut_part *part,
                               const fu_attachment_state *before, const fu_attachment_state *after, double tension,
                               double *f)
{
    const int last = rope->n_points - 1, in_space = part->dim == SPACE;
    double pull[SPACE];
    fu_taut_pull(part, pull);
    for (int end = 0; end < SIDES; ++end) {
        const fu_taut_point *point = fu_taut_point_of(model, rope, end ? part->to : part->from);
        const int holds = end ? part->to == last : part->from == 0;
        const double moment = holds ? -fu_taut_share_of_end(model, rope, end) * tension : 0.0;
        const double along = end ? tension : -tension;
        if (in_space) {
            double force[SPACE], of_force[SPACE];
            for (int d = 0; d < SPACE; ++d) {
                force[d] = along * pull[d];
                of_force[d] = tension * fu_taut_moment(part, end)[d];
            }
            fu_add_wrench(SPACE, end ? after : before, force, of_force, 1.0, f);
        } else {
            const double force[DIM] = {along * pull[0], along * pull[1]};
            fu_add_wrench(DIM, end ? after : before, force, moment != 0.0 ? &moment : 0, 1.0, f);
        }
        if (moment != 0.0 && point->turn >= 0) f[point->turn] += moment;
    }
}

void fu_taut_walk(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, fu_taut_lengths *out,
                  double tension, double *f)
{
    const int last = rope->n_points - 1;
    const fu_taut_history *past = fu_taut_history_of(rope, state);
    fu_attachment_state one, other, *before = &one, *after = &other;
    memset(out, 0, sizeof *out);
    fu_taut_centre(model, fu_taut_point_of(model, rope, 0), state, before);
    subtract_turn(model, rope, state, 0, before, out);
    for (int from = 0, to; from < last; from = to) {
        fu_taut_part part;
        to = fu_next_touched(model, rope, state, from);
        fu_taut_centre(model, fu_taut_point_of(model, rope, to), state, after);
        find_part(model, rope, state, from, to, before, after, &part);
        out->length[FU_DRAWN] += part.drawn;
        out->rate[FU_DRAWN] += part.drawn_rate;
        for (int end = 0; end < SIDES; ++end)
            if (end ? to == last : from == 0) {
                add_way(end, fu_taut_share_of_end(model, rope, end), part.angle[end] - rope->angles[end],
                        part.turning[end], out);
                out->angle[end] = part.angle[end];
                out->turning[end] = part.turning[end];
            }
        if (f) add_forces_of_part(model, rope, &part, before, after, tension, f);
        fu_attachment_state *passed = before;
        before = after;
        after = passed;
    }
    subtract_turn(model, rope, state, 1, before, out);
    for (int end = 0; end < SIDES; ++end) {
        out->length[FU_WAY] += out->way[end] - past->way[end];
        out->rate[FU_WAY] += out->way_rate[end];
    }
    out->growth = out->rate[FU_DRAWN] + out->rate[FU_WAY];
    out->past[0] = past->free;
    out->past[1] = past->drawn;
}

void fu_taut_geometry(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, fu_taut_lengths *out)
{
    fu_taut_walk(model, rope, state, out, 0.0, 0);
}

double fu_taut_length_to(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, int place,
                         double *rate)
{
    double length = 0.0, radius = 0.0, angle = 0.0, turning = 0.0;
    *rate = 0.0;
    for (int from = 0, to; from <= place && from < rope->n_points - 1; from = to) {
        fu_taut_part part;
        to = fu_next_touched(model, rope, state, from);
        fu_taut_part_at(model, rope, state, from, to, &part);
        const double now = part.turning[0], share = from == place ? 0.5 : 1.0;
        if (from) {
            length += share * radius * (part.angle[0] - angle);
            *rate += share * radius * (now - turning);
        }
        if (from == place) break;
        radius = fu_taut_point_of(model, rope, to)->radius;
        angle = part.angle[1];
        turning = part.turning[1];
        if (to > place) { /* a sheave that the rope does not touch: its foot on the straight part */
            fu_attachment_state start, centre;
            double along = 0.0, along_rate = 0.0;
            fu_taut_centre(model, fu_taut_point_of(model, rope, from), state, &start);
            fu_taut_centre(model, fu_taut_point_of(model, rope, place), state, &centre);
            if (rope->part) {
                along = fu_taut_along(&part, &start, &centre, &along_rate);
                length += along;
                *rate += along_rate;
                break;
            }
            for (int d = 0; d < DIM; ++d) {
                along += part.u[d] * (centre.p[d] - start.p[d]);
                along_rate += part.u[d] * (centre.v[d] - start.v[d]);
            }
            along_rate += now * (part.u[0] * (centre.p[1] - start.p[1]) - part.u[1] * (centre.p[0] - start.p[0]));
            length += along;
            *rate += along_rate;
            break;
        }
        length += part.l;
        *rate += part.growth;
    }
    return length;
}
