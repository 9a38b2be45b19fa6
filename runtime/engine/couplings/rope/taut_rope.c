/* Ropes without mass: straight parts between points, with one tension. In a Newton system the forces on both lengths
 * are internal unknowns: the tension, and where wheels hold the rope, that on the stress-free length. */
#include "couplings/rope/taut_rope.h"
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"

#include <math.h>
#include <string.h>

enum { DIM = 2, SIDES = 2 };
/* of a point in a Newton system: place, velocity, turn, angular velocity */
enum { VELOCITY = DIM, TURN = 2 * DIM, SPIN = TURN + 1, ROWS = SPIN + 1 };

static const fu_taut_rope *rope_of(const fu_coupling *coupling)
{
    return (const fu_taut_rope *)coupling;
}

const fu_taut_point *fu_taut_point_of(const fu_model *model, const fu_taut_rope *rope, int place)
{
    return (const fu_taut_point *)model->couplings[rope->points[place]];
}

int fu_touches(const fu_taut_point *point, const fu_state *state)
{
    return state->flags[point->base.flags];
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

static int is_taut(const fu_coupling *coupling, const fu_state *state)
{
    return state->flags[coupling->flags];
}

/* Returns an angle, whole turns added, near another one. */
static double near_angle(double angle, double to)
{
    return to + remainder(angle - to, 2.0 * acos(-1.0));
}

void fu_taut_centre(const fu_model *model, const fu_taut_point *point, const fu_state *state, fu_attachment_state *out)
{
    const fu_state moving = {.t = state->t, .q = state->q, .v = state->v ? state->v : (double *)model->zero};
    fu_attachment_at(model, &point->attachments[0], &moving, 0.0, FU_POINT | FU_AXES, out);
}

static double carrier_angle(const fu_taut_point *point, const fu_state *state, const fu_attachment_state *at)
{
    return near_angle(atan2(at->A[DIM], at->A[0]), state->numbers[point->base.numbers + 1]);
}

double fu_taut_turn(const fu_taut_point *point, const fu_state *state, const fu_attachment_state *at)
{
    return carrier_angle(point, state, at) + (point->turn < 0 ? 0.0 : state->q[point->turn]);
}

double fu_taut_spin(const fu_model *model, const fu_taut_point *point, const fu_state *state,
                    const fu_attachment_state *at)
{
    const double *v = state->v ? state->v : model->zero;
    return at->omega[0] + (point->turn < 0 ? 0.0 : v[point->turn]);
}

/* --- geometry --------------------------------------------------------------------------------------------------- */

/* Returns the change of the stress-free length by the angle of the first straight part, or of the last one: the wheel
 * there holds more, or less. */
static double share_of_end(const fu_model *model, const fu_taut_rope *rope, int end)
{
    const double radius = fu_taut_point_of(model, rope, end ? rope->n_points - 1 : 0)->radius;
    return (end ? radius : -radius) / rope->stretch;
}

/* Computes the straight part between two points at these places and velocities. */
static void find_part(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, int from, int to,
                      const fu_attachment_state *one, const fu_attachment_state *other, fu_taut_part *out)
{
    const fu_taut_point *start = fu_taut_point_of(model, rope, from), *end = fu_taut_point_of(model, rope, to);
    const int first = from == 0, last = to == rope->n_points - 1;
    out->from = from;
    out->to = to;
    out->rise = end->radius - start->radius;
    for (int d = 0; d < DIM; ++d) {
        out->d[d] = other->p[d] - one->p[d];
        out->d_rate[d] = other->v[d] - one->v[d];
    }
    rope->kernel->straight(out->d, out->rise, &out->l, out->u, out->l_d, out->b_d);
    out->angle = near_angle(atan2(out->u[1], out->u[0]), state->numbers[start->base.numbers]);
    out->share[FU_DRAWN] = (first ? 0.0 : start->radius) - (last ? 0.0 : end->radius);
    out->share[FU_FREE] = (first ? share_of_end(model, rope, 0) : 0.0) + (last ? share_of_end(model, rope, 1) : 0.0);
}

void fu_taut_part_at(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, int from, int to,
                     fu_taut_part *out)
{
    fu_attachment_state one, other;
    fu_taut_centre(model, fu_taut_point_of(model, rope, from), state, &one);
    fu_taut_centre(model, fu_taut_point_of(model, rope, to), state, &other);
    find_part(model, rope, state, from, to, &one, &other, out);
}

/* Adds the rotation of a wheel at an end to the stress-free length and its rate. */
static void add_turn(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, int end,
                     const fu_attachment_state *at, fu_taut_lengths *out)
{
    const fu_taut_point *point = fu_taut_point_of(model, rope, end ? rope->n_points - 1 : 0);
    const double share = share_of_end(model, rope, end);
    if (share == 0.0) return;
    out->length[FU_FREE] -= share * (fu_taut_turn(point, state, at) - rope->carriers[end]);
    out->rate[FU_FREE] -= share * fu_taut_spin(model, point, state, at);
}

/* Computes the lengths and their rates. */
static void find_lengths(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, fu_taut_lengths *out)
{
    const int last = rope->n_points - 1;
    fu_attachment_state one, other, *before = &one, *after = &other;
    memset(out, 0, sizeof *out);
    fu_taut_centre(model, fu_taut_point_of(model, rope, 0), state, before);
    add_turn(model, rope, state, 0, before, out);
    out->length[FU_FREE] += rope->free_length;
    for (int from = 0, to; from < last; from = to) {
        fu_taut_part part;
        to = fu_next_touched(model, rope, state, from);
        fu_taut_centre(model, fu_taut_point_of(model, rope, to), state, after);
        find_part(model, rope, state, from, to, before, after, &part);
        const double turning = fu_dot(DIM, part.b_d, part.d_rate);
        out->length[FU_DRAWN] += part.l + part.share[FU_DRAWN] * part.angle;
        out->rate[FU_DRAWN] += fu_dot(DIM, part.l_d, part.d_rate) + part.share[FU_DRAWN] * turning;
        for (int end = 0; end < SIDES; ++end)
            if (end ? to == last : from == 0)
                out->length[FU_FREE] += share_of_end(model, rope, end) * (part.angle - rope->angles[end]);
        out->rate[FU_FREE] += part.share[FU_FREE] * turning;
        fu_attachment_state *passed = before;
        before = after;
        after = passed;
    }
    add_turn(model, rope, state, 1, before, out);
}

void fu_taut_lengths_at(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, fu_taut_lengths *out)
{
    find_lengths(model, rope, state, out);
    rope->kernel->tension(is_taut(&rope->base, state) ? rope->EA : 0.0, rope->tau, out->length, out->rate, rope->kept,
                          out->f);
}

void fu_taut_pull(const fu_taut_part *part, const double f[FU_LENGTHS], double pull[2])
{
    const double on_angle = fu_dot(FU_LENGTHS, part->share, f);
    for (int d = 0; d < DIM; ++d) pull[d] = f[FU_DRAWN] * part->l_d[d] + on_angle * part->b_d[d];
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
        const double now = fu_dot(DIM, part.b_d, part.d_rate), share = from == place ? 0.5 : 1.0;
        if (from) {
            length += share * radius * (part.angle - angle);
            *rate += share * radius * (now - turning);
        }
        if (from == place) break;
        radius = fu_taut_point_of(model, rope, to)->radius;
        angle = part.angle;
        turning = now;
        if (to > place) { /* a sheave that the rope does not touch: its foot on the straight part */
            fu_attachment_state start, centre;
            double along = 0.0, along_rate = 0.0;
            fu_taut_centre(model, fu_taut_point_of(model, rope, from), state, &start);
            fu_taut_centre(model, fu_taut_point_of(model, rope, place), state, &centre);
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
        *rate += fu_dot(DIM, part.l_d, part.d_rate);
    }
    return length;
}

double fu_taut_held(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, int end, double *rate)
{
    const int last = rope->n_points - 1, place = end ? last : 0;
    const fu_taut_point *point = fu_taut_point_of(model, rope, place);
    const double share = -share_of_end(model, rope, end);
    fu_attachment_state at;
    fu_taut_part part;
    *rate = 0.0;
    if (share == 0.0) return 0.0;
    if (end) fu_taut_part_at(model, rope, state, fu_touched_before(model, rope, state, last), last, &part);
    else fu_taut_part_at(model, rope, state, 0, fu_next_touched(model, rope, state, 0), &part);
    fu_taut_centre(model, point, state, &at);
    *rate = share * (fu_dot(DIM, part.b_d, part.d_rate) - fu_taut_spin(model, point, state, &at));
    return share * (part.angle - rope->angles[end] - fu_taut_turn(point, state, &at) + rope->carriers[end]);
}

/* --- forces ----------------------------------------------------------------------------------------------------- */

/* Adds forces on the lengths to those on the dofs. */
static void add_forces(const fu_model *model, const fu_taut_rope *rope, const fu_state *state,
                       const double f[FU_LENGTHS], double *out)
{
    const int last = rope->n_points - 1;
    fu_attachment_state one, other, *before = &one, *after = &other;
    fu_taut_centre(model, fu_taut_point_of(model, rope, 0), state, before);
    for (int from = 0, to; from < last; from = to) {
        fu_taut_part part;
        double pull[DIM];
        to = fu_next_touched(model, rope, state, from);
        fu_taut_centre(model, fu_taut_point_of(model, rope, to), state, after);
        find_part(model, rope, state, from, to, before, after, &part);
        fu_taut_pull(&part, f, pull);
        for (int end = 0; end < SIDES; ++end) {
            const fu_taut_point *point = fu_taut_point_of(model, rope, end ? to : from);
            const int holds = end ? to == last : from == 0;
            const double moment = holds ? -share_of_end(model, rope, end) * f[FU_FREE] : 0.0, sign = end ? 1.0 : -1.0;
            const double force[DIM] = {sign * pull[0], sign * pull[1]};
            fu_add_wrench(DIM, end ? after : before, force, moment != 0.0 ? &moment : 0, 1.0, out);
            if (moment != 0.0 && point->turn >= 0) out[point->turn] += moment;
        }
        fu_attachment_state *passed = before;
        before = after;
        after = passed;
    }
}

/* Computes the forces on the lengths that are internal unknowns; that on the stress-free length has no effect without
 * wheels that hold the rope. */
static void internal_forces(const fu_coupling *coupling, const fu_state *state, double f[FU_LENGTHS])
{
    f[FU_FREE] = 0.0;
    memcpy(f, state->forces + coupling->force, sizeof(double) * (size_t)coupling->n_forces);
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                     double *internal)
{
    const fu_taut_rope *rope = rope_of(coupling);
    fu_taut_lengths now;
    double unknown[FU_LENGTHS];
    internal_forces(coupling, at->next, unknown);
    add_forces(model, rope, at->next, unknown, f);
    fu_taut_lengths_at(model, rope, at->next, &now);
    for (int r = 0; r < coupling->n_forces; ++r)
        internal[coupling->unknown + r] = -at->weights.stiffness * (unknown[r] - now.f[r]);
}

static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    fu_taut_lengths now;
    fu_taut_lengths_at(model, rope_of(coupling), state, &now);
    add_forces(model, rope_of(coupling), state, now.f, f);
}

/* A side of a straight part in a Newton system: its point, and the sign of its place in d. */
typedef struct {
    const fu_taut_point *point;
    fu_point_motion motion;
    double sign, turn_share; /* of its rotation in the stress-free length, 0 where it does not hold the rope */
} side;

/* The changes of the forces on the lengths by the lengths and their rates. */
typedef struct {
    double K[FU_LENGTHS * FU_LENGTHS], D[FU_LENGTHS * FU_LENGTHS];
} law_changes;

/* Adds the entries of one side with the internal unknowns: rows of the law, columns of the forces. */
static void add_internal(const fu_model *model, const fu_coupling *coupling, const fu_taut_part *part,
                         const law_changes *law, double (*by_rate)[DIM], const side *of, fu_weights weights,
                         fu_system *system)
{
    const int row = fu_extra(model, coupling->unknown), n = of->motion.at.n;
    const double unit = fu_row_unit(weights.inertia, coupling->scale[0]);
    double by[FU_LENGTHS * ROWS], changes[FU_LENGTHS * FU_ATTACHMENT_COORDINATES];
    memset(by, 0, sizeof by);
    for (int r = 0; r < coupling->n_forces; ++r)
        for (int i = 0; i < FU_LENGTHS; ++i) {
            const double K = law->K[r * FU_LENGTHS + i], D = law->D[r * FU_LENGTHS + i];
            for (int d = 0; d < DIM; ++d) {
                const double change = of->sign * ((i == FU_DRAWN ? part->l_d[d] : 0.0) + part->share[i] * part->b_d[d]);
                by[r * ROWS + d] += K * change + D * of->sign * by_rate[i][d];
                by[r * ROWS + VELOCITY + d] += D * change;
            }
            if (i != FU_FREE) continue;
            by[r * ROWS + TURN] = K * of->turn_share;
            by[r * ROWS + SPIN] = D * of->turn_share;
        }
    fu_changes(&of->motion, coupling->n_forces, by, changes);
    for (int r = 0; r < coupling->n_forces; ++r) {
        double force[DIM];
        const double moment = r == FU_FREE ? of->turn_share : 0.0;
        for (int d = 0; d < DIM; ++d)
            force[d] = of->sign * ((r == FU_DRAWN ? part->l_d[d] : 0.0) + part->share[r] * part->b_d[d]);
        double on_point[FU_ATTACHMENT_COORDINATES];
        fu_wrench_force(DIM, &of->motion.at, force, moment != 0.0 ? &moment : 0, 1.0, on_point);
        for (int i = 0; i < n; ++i) {
            fu_add(model, system, row + r, of->motion.at.at[i], -weights.stiffness * changes[r * n + i]);
            fu_add(model, system, of->motion.at.at[i], row + r, unit * on_point[i]);
        }
        if (of->turn_share == 0.0 || of->point->turn < 0) continue;
        fu_add(model, system, row + r, of->point->turn,
               -weights.stiffness * (by[r * ROWS + TURN] + weights.rate * by[r * ROWS + SPIN]));
        if (moment != 0.0) fu_add(model, system, of->point->turn, row + r, unit * moment);
    }
}

/* Adds the changes of the force of a part on one side by the other one, or by itself. */
static void add_stiffness(const fu_model *model, const double *K, const side *of, const side *by, double stiffness,
                          fu_system *system)
{
    double of_place[DIM * ROWS], changes[DIM * FU_ATTACHMENT_COORDINATES];
    memset(of_place, 0, sizeof of_place);
    for (int i = 0; i < DIM; ++i)
        for (int j = 0; j < DIM; ++j) of_place[i * ROWS + j] = of->sign * by->sign * K[i * DIM + j];
    fu_changes(&by->motion, DIM, of_place, changes);
    fu_add_wrench_tangent(model, &of->motion.at, &by->motion.at, changes, 0,
                          of == by ? fu_stiffness_of(&by->motion) : 0, stiffness, system);
}

/* Adds the derivatives of a straight part. */
static void add_part(const fu_model *model, const fu_coupling *coupling, const fu_taut_part *part,
                     const law_changes *law, const double unknown[FU_LENGTHS], const fu_equations *equations,
                     fu_system *system)
{
    const fu_taut_rope *rope = rope_of(coupling);
    const double on_part[2] = {unknown[FU_DRAWN], fu_dot(FU_LENGTHS, part->share, unknown)};
    double pull[DIM], K[DIM * DIM], by_rate[FU_LENGTHS][DIM];
    side sides[SIDES];
    fu_taut_pull(part, unknown, pull);
    for (int i = 0; i < FU_LENGTHS; ++i) {
        const double on_length[2] = {i == FU_DRAWN ? 1.0 : 0.0, part->share[i]};
        rope->kernel->straight_tangent(on_length, part->d, part->rise, K);
        for (int d = 0; d < DIM; ++d) by_rate[i][d] = fu_dot(DIM, K + d * DIM, part->d_rate);
    }
    rope->kernel->straight_tangent(on_part, part->d, part->rise, K);
    for (int end = 0; end < SIDES; ++end) {
        side *of = &sides[end];
        const int holds = end ? part->to == rope->n_points - 1 : part->from == 0;
        of->point = fu_taut_point_of(model, rope, end ? part->to : part->from);
        of->sign = end ? 1.0 : -1.0;
        of->turn_share = holds ? -share_of_end(model, rope, end) : 0.0;
        const double moment = of->turn_share * unknown[FU_FREE], force[DIM] = {of->sign * pull[0], of->sign * pull[1]};
        fu_point_motion_at(model, &of->point->attachments[0], equations->next, FU_POINT | FU_AXES, force, &moment,
                           equations->psi, equations->weights.rate, &of->motion);
        add_internal(model, coupling, part, law, by_rate, of, equations->weights, system);
    }
    for (int end = 0; end < SIDES; ++end)
        for (int by = 0; by < SIDES; ++by)
            add_stiffness(model, K, &sides[end], &sides[by], equations->weights.stiffness, system);
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations,
                    fu_system *system)
{
    const fu_taut_rope *rope = rope_of(coupling);
    const fu_state *next = equations->next;
    const int row = fu_extra(model, coupling->unknown);
    fu_taut_lengths now;
    law_changes law;
    double unknown[FU_LENGTHS];
    find_lengths(model, rope, next, &now);
    rope->kernel->tension_tangent(is_taut(coupling, next) ? rope->EA : 0.0, rope->tau, now.length, now.rate, rope->kept,
                                  now.f, law.K, law.D);
    internal_forces(coupling, next, unknown);
    for (int r = 0; r < coupling->n_forces; ++r)
        fu_add(model, system, row + r, row + r, fu_row_unit(equations->weights.inertia, coupling->scale[0]));
    for (int from = 0, to; from < rope->n_points - 1; from = to) {
        fu_taut_part part;
        to = fu_next_touched(model, rope, next, from);
        fu_taut_part_at(model, rope, next, from, to, &part);
        add_part(model, coupling, &part, &law, unknown, equations, system);
    }
}

/* --- the coupling ----------------------------------------------------------------------------------------------- */

typedef struct {
    double tension, drawn_length, free_length;
} rope_output;

static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    fu_taut_lengths now;
    (void)acceleration, (void)work;
    fu_taut_lengths_at(model, rope_of(coupling), state, &now);
    *(rope_output *)out = (rope_output){now.f[FU_DRAWN], now.length[FU_DRAWN], now.length[FU_FREE]};
}

static void take_forces(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work, fu_state *state)
{
    fu_taut_lengths now;
    (void)work;
    fu_taut_lengths_at(model, rope_of(coupling), state, &now);
    memcpy(state->forces + coupling->force, now.f, sizeof(double) * (size_t)coupling->n_forces);
}

/* Returns the elastic energy of a rope of these lengths, J. */
static double stored(const fu_taut_rope *rope, const fu_taut_lengths *now)
{
    double U;
    rope->kernel->energy(now->length[FU_DRAWN] > now->length[FU_FREE] ? rope->EA : 0.0, now->length, &U);
    return U;
}

/* Returns the elastic energy, with that of what wheels hold, J. */
static double energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_taut_rope *rope = rope_of(coupling);
    fu_taut_lengths now;
    find_lengths(model, rope, state, &now);
    return stored(rope, &now) + rope->kept * (rope->held + rope->free_length - now.length[FU_FREE]);
}

static double dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const fu_accelerator *work)
{
    const fu_taut_rope *rope = rope_of(coupling);
    fu_taut_lengths now;
    double power;
    (void)work;
    if (!coupling->is_damped || !is_taut(coupling, state)) return 0.0;
    find_lengths(model, rope, state, &now);
    rope->kernel->dissipation(rope->EA, rope->tau, now.length, now.rate, &power);
    return power;
}

/* Returns the stored energy that is dissipated, J: of a rope whose damping would push, so that it is slack. */
static double energy_without_force(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    fu_taut_lengths now;
    if (is_taut(coupling, state)) return 0.0;
    find_lengths(model, rope_of(coupling), state, &now);
    return stored(rope_of(coupling), &now);
}

static double lost_in_step(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                           int by_ends)
{
    (void)by_ends;
    if (!coupling->is_damped) return 0.0;
    return energy_without_force(model, coupling, from) - energy_without_force(model, coupling, to);
}

/* Stores the angles of parts and of what carries the points, from which later ones are counted. */
static void update_history(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    const fu_taut_rope *rope = rope_of(coupling);
    for (int from = 0, to; from < rope->n_points; from = to) {
        const fu_taut_point *point = fu_taut_point_of(model, rope, from);
        double *numbers = state->numbers + point->base.numbers;
        fu_attachment_state at;
        fu_taut_centre(model, point, state, &at);
        numbers[1] = carrier_angle(point, state, &at);
        to = from + 1;
        if (from == rope->n_points - 1) return;
        fu_taut_part part;
        to = fu_next_touched(model, rope, state, from);
        fu_taut_part_at(model, rope, state, from, to, &part);
        numbers[0] = part.angle;
    }
}

static void reset(const fu_coupling *coupling, fu_state *state)
{
    state->flags[coupling->flags] = 1;
}

double fu_taut_slack(const fu_model *model, const fu_taut_rope *rope, const fu_state *state)
{
    fu_taut_lengths now;
    find_lengths(model, rope, state, &now);
    const double stretch = now.length[FU_DRAWN] / now.length[FU_FREE];
    const double growth = (now.rate[FU_DRAWN] - stretch * now.rate[FU_FREE]) * rope->tau;
    return -fmin(0.0, growth) - (now.length[FU_DRAWN] - now.length[FU_FREE]);
}

double fu_taut_margin(const fu_model *model, const fu_taut_rope *rope, const fu_state *state)
{
    double least = INFINITY;
    for (int from = 0, to; from < rope->n_points - 1; from = to) {
        fu_taut_part part;
        to = fu_next_touched(model, rope, state, from);
        fu_taut_part_at(model, rope, state, from, to, &part);
        if (!(part.l >= least)) least = part.l; /* NaN where two circles overlap */
    }
    return isnan(least) ? -1.0 : least - rope->least_length;
}

static const char *const role[] = {"taut_rope", 0};

static const fu_field fields[] = {
    FU_FIELD(fu_taut_rope, kernel, FU_KERNELS, role),
    FU_FIELD(fu_taut_rope, n_points, FU_INTEGER, 0),
    FU_FIELD(fu_taut_rope, points, FU_INTEGERS, 0),
    FU_FIELD(fu_taut_rope, EA, FU_REAL, 0),
    FU_FIELD(fu_taut_rope, tau, FU_REAL, 0),
    FU_FIELD(fu_taut_rope, free_length, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_taut_rope, angles, FU_REAL),
    FU_FIELD_ARRAY(fu_taut_rope, carriers, FU_REAL),
    FU_FIELD(fu_taut_rope, stretch, FU_REAL, 0),
    FU_FIELD(fu_taut_rope, kept, FU_REAL, 0),
    FU_FIELD(fu_taut_rope, held, FU_REAL, 0),
    FU_FIELD(fu_taut_rope, least_length, FU_REAL, 0),
    {0},
};

static const fu_output output_fields[] = {
    FU_OUTPUT(rope_output, tension, "N", NULL),
    FU_OUTPUT(rope_output, drawn_length, "m", NULL),
    FU_OUTPUT(rope_output, free_length, "m", NULL),
    FU_LAST_OUTPUT(rope_output),
};

static const fu_start_operations start = {.reset = reset};
static const fu_history_operations of_history = {.update = update_history};

const fu_coupling_type fu_taut_rope_type = {
    .name = "taut_rope",
    .size = sizeof(fu_taut_rope),
    .fields = fields,
    .output_fields = output_fields,
    .n_flags = 1,
    .start = &start,
    .history = &of_history,
    .residual = residual,
    .tangent = tangent,
    .force = force,
    .take_forces = take_forces,
    .outputs = outputs,
    .energy = energy,
    .dissipation = dissipation,
    .lost_in_step = lost_in_step,
};
