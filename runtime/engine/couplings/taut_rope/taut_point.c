/* Points of ropes without mass: what turns at them, and how the rope beside them is. */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/taut_rope/taut_rope.h"

#include <math.h>
#include <stdlib.h>

#define ROUNDING_OF_FORCE 1e-12   /* of EA: a slack rope needs no friction */
#define ROUNDING_OF_TENSION 1e-10 /* of both tensions: excess at which a rope breaks loose */
#define ROUNDING_OF_PLACE 1e-9    /* of the radius: place along the axis that is none */

enum { DIM = 2, SPACE = 3, SIDES = 2 };

static const fu_taut_point *point_of(const fu_coupling *coupling)
{
    return (const fu_taut_point *)coupling;
}

static double sense_of(const fu_taut_point *point)
{
    return point->radius < 0.0 ? -1.0 : 1.0;
}

/* A point with the straight parts and the ropes beside it: `has` those before and after it. */
typedef struct {
    int has[SIDES], touches;
    const fu_taut_rope *rope[SIDES];
    fu_taut_part part[SIDES];
    fu_taut_lengths lengths[SIDES];
} surroundings;

/* Computes the straight parts beside a point; of one that the rope does not touch, both are the one that passes it. */
static void find_parts(const fu_model *model, const fu_taut_point *point, const fu_state *state, surroundings *out)
{
    out->touches = fu_touches(point, state);
    for (int side = 0; side < SIDES; ++side) {
        const fu_taut_rope *rope = out->rope[side] = fu_taut_beside(model, point, side);
        const int place = point->places[side];
        out->has[side] = rope != 0;
        if (!rope) continue;
        const int from = side && out->touches ? place : fu_touched_before(model, rope, state, place);
        fu_taut_part_at(model, rope, state, from, fu_next_touched(model, rope, state, from), &out->part[side]);
    }
}

static void look(const fu_model *model, const fu_taut_point *point, const fu_state *state, surroundings *out)
{
    find_parts(model, point, state, out);
    for (int side = 0; side < SIDES; ++side)
        if (out->has[side]) fu_taut_lengths_at(model, out->rope[side], state, &out->lengths[side]);
}

/* Returns the wrap angle, rad. */
static double wrap_of(const fu_taut_point *point, const surroundings *at)
{
    return at->touches && at->has[0] && at->has[1]
               ? sense_of(point) * (at->part[1].angle[0] - at->part[0].angle[1] + point->closing)
               : 0.0;
}

double fu_taut_wrap(const fu_model *model, const fu_taut_point *point, const fu_state *state)
{
    surroundings at;
    find_parts(model, point, state, &at);
    return -wrap_of(point, &at);
}

void fu_taut_pass(const fu_model *model, const fu_taut_point *point, const fu_state *state, fu_taut_passage *out)
{
    const fu_taut_rope *rope = fu_taut_beside(model, point, 0);
    surroundings at;
    fu_attachment_state centre, start;
    find_parts(model, point, state, &at);
    const fu_taut_part *part = &at.part[0];
    const fu_taut_point *first = fu_taut_point_of(model, rope, part->from);
    fu_taut_centre(model, point, state, &centre);
    fu_taut_centre(model, first, state, &start);
    if (point->in_space) {
        fu_taut_pass_in_space(part, &start, &centre, point->radius, out);
        return;
    }
    /* the part begins to the right of its first centre by the radius there, with its sense */
    const double x = centre.p[0] - start.p[0] - first->radius * part->u[1];
    const double y = centre.p[1] - start.p[1] + first->radius * part->u[0];
    const double along = part->u[0] * x + part->u[1] * y, across = part->u[0] * y - part->u[1] * x;
    const double beyond = along < 0.0 ? along : along > part->l ? along - part->l : 0.0;
    *out = (fu_taut_passage){.depth = fabs(point->radius) - hypot(across, beyond),
                             .angle = state->numbers[first->base.numbers],
                             .side = across * sense_of(point) < 0.0 ? -1 : 1};
}

double fu_taut_aside(const fu_taut_point *point, double aside)
{
    return fabs(aside) > ROUNDING_OF_PLACE * fabs(point->radius) ? aside : 0.0;
}

/* The angle of a rope on the sheave is that of the straight part which met it. */
void fu_taut_touch(const fu_taut_point *point, const fu_taut_passage *at, fu_state *state)
{
    double *numbers = state->numbers + point->base.numbers;
    state->flags[point->base.flags + FU_TOUCHES] = 1;
    numbers[0] = at->angle;
    if (!point->in_space) return;
    numbers[1] = at->angle;
    numbers[FU_ASIDE] = fu_taut_aside(point, at->aside);
}

void fu_taut_leave(const fu_taut_point *point, fu_state *state)
{
    state->flags[point->base.flags + FU_TOUCHES] = 0;
    state->numbers[point->base.numbers + FU_ASIDE] = 0.0;
}

double fu_taut_kink(const fu_model *model, const fu_taut_point *point, const fu_state *state)
{
    surroundings at;
    find_parts(model, point, state, &at);
    return fabs(at.part[0].fleet[1] + at.part[1].fleet[0]);
}

double fu_taut_fleet_margin(const fu_model *model, const fu_taut_point *point, const fu_state *state)
{
    double least = INFINITY;
    surroundings at;
    find_parts(model, point, state, &at);
    for (int side = 0; side < SIDES; ++side)
        if (at.has[side] && at.touches) least = fmin(least, fu_taut_margin_of_fleet(&at.part[side], !side));
    return least;
}

/* Returns the excess over the limit of friction that is rounding, N. */
static double rounding_of(const surroundings *at)
{
    return ROUNDING_OF_FORCE * (at->rope[0]->EA + at->rope[1]->EA) +
           ROUNDING_OF_TENSION * (at->lengths[0].elastic + at->lengths[1].elastic);
}

static double grip_of(const fu_taut_point *point, const surroundings *at)
{
    const double before = at->lengths[0].elastic, after = at->lengths[1].elastic;
    return fabs(after - before) - tanh(0.5 * point->friction * wrap_of(point, at)) * (after + before) - rounding_of(at);
}

double fu_taut_grip(const fu_model *model, const fu_taut_point *point, const fu_state *state)
{
    surroundings at;
    look(model, point, state, &at);
    return grip_of(point, &at);
}

int fu_taut_is_held(const fu_model *model, const fu_taut_point *point, const fu_state *state)
{
    surroundings at;
    look(model, point, state, &at);
    return grip_of(point, &at) < -0.5 * rounding_of(&at);
}

int fu_taut_pulled(const fu_model *model, const fu_taut_point *point, const fu_state *state)
{
    surroundings at;
    look(model, point, state, &at);
    return at.lengths[1].elastic > at.lengths[0].elastic ? 1 : -1;
}

/* Returns the power of friction of a rope that slips, W. */
static double power_of_slip(const fu_model *model, const fu_taut_point *point, const fu_state *state)
{
    surroundings at;
    look(model, point, state, &at);
    return (at.lengths[1].tension - at.lengths[0].tension) * fu_taut_slip(model, point, state);
}

double fu_taut_store(const fu_model *model, const fu_taut_point *point, const fu_state *state)
{
    const int side = point->ropes[1] >= 0 ? 1 : 0;
    const fu_taut_rope *rope = fu_taut_beside(model, point, side);
    fu_taut_lengths now;
    double rate;
    fu_taut_lengths_at(model, rope, state, &now);
    return point->store + fu_taut_held(rope, state, &now, !side, &rate);
}

/* --- what turns ------------------------------------------------------------------------------------------------- */

/* Adds the moment of the bearing, between a wheel and its carrier, and inertial forces. */
static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    const fu_taut_point *point = point_of(coupling);
    if (point->turn >= 0 && state->v) f[point->turn] += point->damping * state->v[point->turn];
    fu_taut_add_gyration(model, point, state, f);
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations, double *f,
                     double *internal)
{
    (void)internal;
    force(model, coupling, equations->next, f);
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations,
                    fu_system *system)
{
    const fu_taut_point *point = point_of(coupling);
    const fu_weights w = equations->weights;
    if (point->turn >= 0 && point->damping != 0.0)
        fu_add(model, system, point->turn, point->turn, w.stiffness * w.rate * point->damping);
    fu_taut_add_gyration_tangent(model, point, equations, system);
}

static double dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const fu_accelerator *work)
{
    const fu_taut_point *point = point_of(coupling);
    (void)work;
    const double slips = fu_taut_slips(point, state) ? power_of_slip(model, point, state) : 0.0;
    return slips + (point->turn < 0 ? 0.0 : point->damping * state->v[point->turn] * state->v[point->turn]);
}

static double drive_torque(const fu_model *model, const fu_taut_point *point, double t)
{
    const int signal = point->torque_signal;
    return point->torque * (signal < 0 ? 1.0 : fu_signal_at(&model->signals[signal], t, 0, 0));
}

/* Subtracts the torque of the drive. */
static void drive(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double *f)
{
    const fu_taut_point *point = point_of(coupling);
    (void)q;
    if (point->turn >= 0 && point->torque != 0.0)
        f[point->turn] -= model->load_fraction * drive_torque(model, point, t);
}

/* --- the coupling ----------------------------------------------------------------------------------------------- */

typedef struct {
    double tension_on, tension_off, wrap_angle, force[3], material_speed, normal_force, torque, drive, power,
        length_in_store, angle, angle_on, angle_off, touches, slip, slip_angle, fleet_angle_on, fleet_angle_off, aside;
} point_output;

/* Returns the stress-free length a second that passes a point in the rope's order: of a wheel that holds the rope, the
 * mean of both sides. */
static double speed_of(const fu_model *model, const fu_taut_point *point, const fu_state *state, const surroundings *at)
{
    double speed = 0.0, rate;
    if (at->rope[0] != at->rope[1] || point->places[0] != point->places[1]) {
        for (int side = 0; side < SIDES; ++side) {
            if (!at->has[side]) continue;
            fu_taut_held(at->rope[side], state, &at->lengths[side], !side, &rate);
            speed += side ? -rate : rate;
        }
        return at->has[0] && at->has[1] ? 0.5 * speed : speed;
    }
    const fu_taut_lengths *now = &at->lengths[0];
    const double stretch = now->length[FU_DRAWN] / now->free, growth = now->growth / now->free;
    const double length = fu_taut_length_to(model, at->rope[0], state, point->places[0], &rate);
    double held;
    fu_taut_held(at->rope[0], state, now, 0, &held);
    return length * growth / (stretch * stretch) - rate / stretch - held;
}

static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    const fu_taut_point *point = point_of(coupling);
    const double *a = acceleration ? acceleration : model->zero;
    point_output *numbers = (point_output *)out;
    surroundings at;
    double on_wheel = 0.0;
    (void)work;
    look(model, point, state, &at);
    *numbers = (point_output){.touches = at.touches,
                              .wrap_angle = wrap_of(point, &at),
                              .aside = state->numbers[coupling->numbers + FU_ASIDE]};
    numbers->slip = fu_taut_slip(model, point, state);
    numbers->slip_angle = fu_taut_slips(point, state) ? numbers->wrap_angle : 0.0;
    for (int side = 0; side < SIDES; ++side) {
        if (!at.has[side]) continue;
        const double tension = at.lengths[side].tension + 0.0; /* no -0 */
        double pull[SPACE] = {0.0};
        *(side ? &numbers->tension_off : &numbers->tension_on) = tension;
        *(side ? &numbers->angle_off : &numbers->angle_on) = at.part[side].angle[!side];
        if (at.has[!side] && !at.touches) continue;
        *(side ? &numbers->fleet_angle_off : &numbers->fleet_angle_on) = at.part[side].fleet[!side];
        fu_taut_pull(&at.part[side], pull);
        for (int d = 0; d < model->dim; ++d) numbers->force[d] += (side ? tension : -tension) * pull[d];
        const int holds = side ? point->places[1] == 0 : point->places[0] == at.rope[0]->n_points - 1;
        if (holds) on_wheel += (side ? tension : -tension) * point->radius;
    }
    numbers->normal_force = !at.touches              ? 0.0
                            : at.has[0] && at.has[1] ? fmin(numbers->tension_on, numbers->tension_off)
                                                     : numbers->tension_on + numbers->tension_off;
    numbers->material_speed = speed_of(model, point, state, &at);
    numbers->torque = on_wheel;
    if (point->radius != 0.0 && (point->places[1] == 0 || point->ropes[1] < 0))
        numbers->length_in_store = fu_taut_store(model, point, state);
    numbers->drive = -on_wheel;
    if (point->turn < 0) return;
    const double rate = state->v ? state->v[point->turn] : 0.0;
    numbers->drive += point->inertia * fu_taut_spinning_up(model, point, state, a) + point->damping * rate;
    numbers->power = numbers->drive * rate;
    numbers->angle = state->q[point->turn];
}

/* In statics the positions determine which sheaves without friction a rope touches. */
static void detect(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    const fu_taut_point *point = point_of(coupling);
    const fu_taut_rope *rope = fu_taut_beside(model, point, 0);
    if (!rope || point->places[0] == rope->n_points - 1) return;
    if (fu_touches(point, state)) {
        if (!(fu_taut_wrap(model, point, state) <= 0.0)) fu_taut_leave(point, state);
        return;
    }
    fu_taut_passage at;
    fu_taut_pass(model, point, state, &at);
    if (at.depth > 0.0 && at.side > 0 && fabs(at.aside) <= point->mouth) fu_taut_touch(point, &at, state);
}

static void reset(const fu_coupling *coupling, fu_state *state)
{
    const fu_taut_point *point = point_of(coupling);
    state->numbers[coupling->numbers] = point->angle;
    state->numbers[coupling->numbers + 1] = point->carrier;
    state->numbers[coupling->numbers + FU_ASIDE] = 0.0;
    state->flags[coupling->flags + FU_TOUCHES] = point->touches;
    state->flags[coupling->flags + FU_SLIPS] = 0;
}

static int is_possible(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    (void)model;
    return abs(fu_taut_slips(point_of(coupling), state)) <= 1;
}

static const char *const wheel_role[] = {"taut_part", 0};

static const fu_field fields[] = {
    FU_FIELD(fu_taut_point, wheel, FU_KERNELS, wheel_role),
    FU_FIELD_ARRAY(fu_taut_point, attachments, FU_ATTACHMENT),
    FU_FIELD(fu_taut_point, turn, FU_INTEGER, 0),
    FU_FIELD(fu_taut_point, radius, FU_REAL, 0),
    FU_FIELD(fu_taut_point, inertia, FU_REAL, 0),
    FU_FIELD(fu_taut_point, damping, FU_REAL, 0),
    FU_FIELD(fu_taut_point, torque_signal, FU_INTEGER, 0),
    FU_FIELD(fu_taut_point, torque, FU_REAL, 0),
    FU_FIELD(fu_taut_point, friction, FU_REAL, 0),
    FU_FIELD(fu_taut_point, store, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_taut_point, ropes, FU_INTEGER),
    FU_FIELD_ARRAY(fu_taut_point, places, FU_INTEGER),
    FU_FIELD(fu_taut_point, angle, FU_REAL, 0),
    FU_FIELD(fu_taut_point, carrier, FU_REAL, 0),
    FU_FIELD(fu_taut_point, closing, FU_REAL, 0),
    FU_FIELD(fu_taut_point, mouth, FU_REAL, 0),
    FU_FIELD(fu_taut_point, kink, FU_REAL, 0),
    FU_FIELD(fu_taut_point, touches, FU_INTEGER, 0),
    FU_FIELD(fu_taut_point, in_space, FU_INTEGER, 0),
    {0},
};

static const fu_output output_fields[] = {
    FU_OUTPUT(point_output, tension_on, "N", NULL),
    FU_OUTPUT(point_output, tension_off, "N", NULL),
    FU_OUTPUT(point_output, wrap_angle, "rad", NULL),
    FU_OUTPUT(point_output, force, "N", "direction"),
    FU_OUTPUT(point_output, material_speed, "m/s", NULL),
    FU_OUTPUT(point_output, normal_force, "N", NULL),
    FU_OUTPUT(point_output, torque, "N m", NULL),
    FU_OUTPUT(point_output, drive, "N m", NULL),
    FU_OUTPUT(point_output, power, "W", NULL),
    FU_OUTPUT(point_output, length_in_store, "m", NULL),
    FU_OUTPUT(point_output, angle, "rad", NULL),
    FU_OUTPUT(point_output, angle_on, "rad", NULL),
    FU_OUTPUT(point_output, angle_off, "rad", NULL),
    FU_OUTPUT(point_output, touches, "1", NULL),
    FU_OUTPUT(point_output, slip, "m/s", NULL),
    FU_OUTPUT(point_output, slip_angle, "rad", NULL),
    FU_OUTPUT(point_output, fleet_angle_on, "rad", NULL),
    FU_OUTPUT(point_output, fleet_angle_off, "rad", NULL),
    FU_OUTPUT(point_output, aside, "m", NULL),
    FU_LAST_OUTPUT(point_output),
};

static const fu_supply_operations supply = {.force = drive};
static const fu_start_operations start = {.reset = reset, .is_possible = is_possible};

const fu_coupling_type fu_taut_point_type = {
    .name = "taut_point",
    .size = sizeof(fu_taut_point),
    .fields = fields,
    .output_fields = output_fields,
    .n_numbers = FU_POINT_NUMBERS,
    .n_flags = FU_POINT_FLAGS,
    .inertia = &fu_taut_wheel_inertia,
    .supply = &supply,
    .start = &start,
    .residual = residual,
    .tangent = tangent,
    .force = force,
    .outputs = outputs,
    .dissipation = dissipation,
    .detect = detect,
};
