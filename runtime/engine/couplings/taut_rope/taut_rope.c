/* Ropes without mass: straight parts between points, with one tension, which is an internal unknown in a Newton
 * system. */
#include "couplings/taut_rope/taut_rope.h"
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"

#include <math.h>
#include <string.h>

enum { DIM = 2, SPACE = 3, SIDES = 2 };
/* of a point in a Newton system: place, velocity, turn, angular velocity */
enum { VELOCITY = DIM, TURN = 2 * DIM, SPIN = TURN + 1, ROWS = SPIN + 1 };

static const fu_taut_rope *rope_of(const fu_coupling *coupling)
{
    return (const fu_taut_rope *)coupling;
}

/* Computes the stress-free length, and in a chain the tension, from the geometry. */
static void find_free_length(const fu_model *model, const fu_taut_rope *rope, const fu_state *state,
                             fu_taut_lengths *out)
{
    double slack;
    if (fu_taut_slides(model, rope, state)) {
        fu_taut_chain chain;
        fu_taut_chain_at(model, rope, state, &chain);
        fu_taut_slide(&chain, state, out);
        return;
    }
    rope->kernel->free_length(out->length, out->past, &out->free, &slack);
    out->per_way = out->free / out->length[FU_DRAWN];
    if (fu_is_taut(rope, state)) return;
    out->free = slack;
    out->per_way = 1.0;
}

static void find_lengths(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, fu_taut_lengths *out)
{
    fu_taut_geometry(model, rope, state, out);
    find_free_length(model, rope, state, out);
}

/* Computes the tension of a rope of these lengths, which of one in a chain is known with them. */
static void find_tension(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, fu_taut_lengths *now)
{
    if (fu_taut_slides(model, rope, state)) return;
    rope->kernel->tension(now->length, now->past, fu_is_taut(rope, state) ? rope->EA : 0.0, rope->tau, now->rate,
                          &now->tension);
}

void fu_taut_lengths_at(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, fu_taut_lengths *out)
{
    const double at_rest[FU_LENGTHS] = {0.0, 0.0};
    find_lengths(model, rope, state, out);
    find_tension(model, rope, state, out);
    if (fu_taut_slides(model, rope, state)) return;
    rope->kernel->tension(out->length, out->past, out->length[FU_DRAWN] > out->free ? rope->EA : 0.0, rope->tau,
                          at_rest, &out->elastic);
}

/* The stress-free length per length of way: the mean over the step, and now. */
static double free_per_way(const fu_taut_lengths *now)
{
    return 0.5 * (now->past[0] / now->past[1] + now->per_way);
}

double fu_taut_held(const fu_taut_rope *rope, const fu_state *state, const fu_taut_lengths *now, int end, double *rate)
{
    const fu_taut_history *past = fu_taut_history_of(rope, state);
    const double sign = end ? 1.0 : -1.0;
    *rate = (now->way_rate[end] + sign * now->slid_rate[end]) * now->per_way;
    return past->held[end] + (now->way[end] - past->way[end] + sign * now->slid[end]) * free_per_way(now);
}

/* --- forces ----------------------------------------------------------------------------------------------------- */

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                     double *internal)
{
    const double unknown = at->next->forces[coupling->force];
    fu_taut_lengths now;
    fu_taut_walk(model, rope_of(coupling), at->next, &now, unknown, f);
    find_free_length(model, rope_of(coupling), at->next, &now);
    find_tension(model, rope_of(coupling), at->next, &now);
    internal[coupling->unknown] = -at->weights.stiffness * (unknown - now.tension);
}

static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    fu_taut_lengths now;
    fu_taut_lengths_at(model, rope_of(coupling), state, &now);
    fu_taut_walk(model, rope_of(coupling), state, &now, now.tension, f);
}

/* A side of a straight part in a Newton system: its point, and the sign of its place in d. */
typedef struct {
    const fu_taut_point *point;
    fu_point_motion motion;
    /* of its rotation in the way: as wheels get the tension, 0 where it does not hold the rope; where the rope does not
     * slip on it */
    double sign, turn_share, way_share;
} side;

/* Adds the entries of one side in the row of the law of a tension, which depends on the angle of the part by by_angle
 * too. */
static void add_row(const fu_model *model, const fu_coupling *coupling, const fu_taut_part *part,
                    const fu_taut_law *law, double by_angle, double (*by_rate)[DIM], const side *of, fu_weights weights,
                    fu_system *system)
{
    const int row = fu_extra(model, coupling->unknown), n = of->motion.at.n;
    double by[ROWS] = {0.0}, changes[FU_ATTACHMENT_COORDINATES];
    for (int d = 0; d < DIM; ++d) by[d] = by_angle * of->sign * part->b_d[d];
    for (int i = 0; i < FU_LENGTHS; ++i)
        for (int d = 0; d < DIM; ++d) {
            const double change = of->sign * ((i == FU_DRAWN ? part->l_d[d] : 0.0) + part->share[i] * part->b_d[d]);
            by[d] += law->K[i] * change + law->D[i] * of->sign * by_rate[i][d];
            by[VELOCITY + d] += law->D[i] * change;
        }
    by[TURN] = law->K[FU_WAY] * of->way_share;
    by[SPIN] = law->D[FU_WAY] * of->way_share;
    fu_changes(&of->motion, 1, by, changes);
    for (int i = 0; i < n; ++i) fu_add(model, system, row, of->motion.at.at[i], -weights.stiffness * changes[i]);
    if (of->way_share == 0.0 || of->point->turn < 0) return;
    fu_add(model, system, row, of->point->turn, -weights.stiffness * (by[TURN] + weights.rate * by[SPIN]));
}

/* Adds the entries of one side in the column of the forces of the tension. */
static void add_column(const fu_model *model, const fu_coupling *coupling, const fu_taut_part *part, const side *of,
                       fu_weights weights, fu_system *system)
{
    const int column = fu_extra(model, coupling->unknown), n = of->motion.at.n;
    const double unit = fu_row_unit(weights.inertia, coupling->scale[0]), moment = of->turn_share;
    double on_point[FU_ATTACHMENT_COORDINATES], pull[SPACE];
    fu_taut_pull(part, pull);
    for (int d = 0; d < DIM; ++d) pull[d] *= of->sign;
    fu_wrench_force(DIM, &of->motion.at, pull, moment != 0.0 ? &moment : 0, 1.0, on_point);
    for (int i = 0; i < n; ++i) fu_add(model, system, of->motion.at.at[i], column, unit * on_point[i]);
    if (moment != 0.0 && of->point->turn >= 0) fu_add(model, system, of->point->turn, column, unit * moment);
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

/* Adds the derivatives of a straight part of a rope: those of the tension of a coupling, and, of its own rope, those of
 * the forces. */
static void add_part(const fu_model *model, const fu_coupling *coupling, const fu_taut_rope *rope,
                     const fu_taut_part *part, const fu_taut_law *law, const fu_equations *equations, fu_system *system)
{
    if (part->dim == SPACE) {
        fu_taut_add_in_space(model, coupling, rope, part, law, equations, system);
        return;
    }
    const int own = rope == rope_of(coupling), last = rope->n_points - 1;
    const double unknown = own ? equations->next->forces[coupling->force] : 0.0;
    const double on_part[2] = {unknown, (part->share[FU_DRAWN] + part->share[FU_WAY]) * unknown};
    const double by_angle = (part->from == 0 ? law->angle[0] : 0.0) + (part->to == last ? law->angle[1] : 0.0);
    double pull[SPACE], K[DIM * DIM], by_rate[FU_LENGTHS][DIM];
    side sides[SIDES];
    fu_taut_pull(part, pull);
    for (int i = 0; i < FU_LENGTHS; ++i) {
        const double on_length[2] = {i == FU_DRAWN ? 1.0 : 0.0, part->share[i]};
        rope->kernel->straight_tangent(on_length, part->d, part->rise, K);
        for (int d = 0; d < DIM; ++d) by_rate[i][d] = fu_dot(DIM, K + d * DIM, part->d_rate);
    }
    rope->kernel->straight_tangent(on_part, part->d, part->rise, K);
    for (int end = 0; end < SIDES; ++end) {
        side *of = &sides[end];
        const int holds = end ? part->to == last : part->from == 0;
        of->point = fu_taut_point_of(model, rope, end ? part->to : part->from);
        of->sign = end ? 1.0 : -1.0;
        of->turn_share = holds ? -fu_taut_share_of_end(model, rope, end) : 0.0;
        of->way_share = holds && fu_taut_slips(of->point, equations->next) ? 0.0 : of->turn_share;
        const double moment = of->turn_share * unknown, along = of->sign * unknown;
        const double force[DIM] = {along * pull[0], along * pull[1]};
        fu_point_motion_at(model, &of->point->attachments[0], equations->next, FU_POINT | FU_AXES, force, &moment,
                           equations->psi, equations->weights.rate, &of->motion);
        add_row(model, coupling, part, law, by_angle, by_rate, of, equations->weights, system);
        if (own) add_column(model, coupling, part, of, equations->weights, system);
    }
    for (int end = 0; own && end < SIDES; ++end)
        for (int by = 0; by < SIDES; ++by)
            add_stiffness(model, K, &sides[end], &sides[by], equations->weights.stiffness, system);
}

/* Adds the derivatives of all straight parts of a rope. */
static void add_parts(const fu_model *model, const fu_coupling *coupling, const fu_taut_rope *rope,
                      const fu_taut_law *law, const fu_equations *equations, fu_system *system)
{
    for (int from = 0, to; from < rope->n_points - 1; from = to) {
        fu_taut_part part;
        to = fu_next_touched(model, rope, equations->next, from);
        fu_taut_part_at(model, rope, equations->next, from, to, &part);
        add_part(model, coupling, rope, &part, law, equations, system);
    }
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations,
                    fu_system *system)
{
    const fu_taut_rope *rope = rope_of(coupling);
    const fu_state *next = equations->next;
    const int row = fu_extra(model, coupling->unknown);
    fu_taut_law law = {.angle = {0.0, 0.0}};
    fu_add(model, system, row, row, fu_row_unit(equations->weights.inertia, coupling->scale[0]));
    if (fu_taut_slides(model, rope, next)) {
        fu_taut_chain chain;
        double by_ratios = 0.0;
        fu_taut_chain_at(model, rope, next, &chain);
        for (int k = chain.n - 1; k >= 0; --k) {
            fu_taut_slide_law(model, &chain, next, k, &by_ratios, &law);
            add_parts(model, coupling, chain.of[k].rope, &law, equations, system);
        }
        return;
    }
    fu_taut_lengths now;
    find_lengths(model, rope, next, &now);
    rope->kernel->tension_tangent(now.length, now.past, fu_is_taut(rope, next) ? rope->EA : 0.0, rope->tau, now.rate,
                                  &now.tension, law.K, law.D);
    add_parts(model, coupling, rope, &law, equations, system);
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
    *(rope_output *)out = (rope_output){now.tension + 0.0, now.length[FU_DRAWN], now.free}; /* no -0 */
}

static void take_forces(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work, fu_state *state)
{
    fu_taut_lengths now;
    (void)work;
    fu_taut_lengths_at(model, rope_of(coupling), state, &now);
    state->forces[coupling->force] = now.tension;
}

/* The elastic energy of a rope, J, that of a length, N, and the power of damping, W. */
typedef struct {
    double U, W, P;
} energies;

static energies energies_of(const fu_taut_rope *rope, double drawn, double free, double growth)
{
    energies out;
    rope->kernel->energy(drawn > free ? rope->EA : 0.0, rope->tau, drawn, free, growth, &out.U, &out.W, &out.P);
    return out;
}

static energies energies_at(const fu_taut_rope *rope, const fu_taut_lengths *now)
{
    return energies_of(rope, now->length[FU_DRAWN], now->free, now->growth);
}

/* Returns the energy of what wheels hold, J: what they have taken up in the step has the mean energy over it. */
static double energy_held(const fu_taut_rope *rope, const fu_state *state, const fu_taut_lengths *now, double W)
{
    const double before = energies_of(rope, now->past[1], now->past[0], 0.0).W;
    return fu_taut_history_of(rope, state)->energy + 0.5 * (W + before) * (now->past[0] - now->free);
}

/* Returns the elastic energy, with that of what wheels hold, J. */
static double energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_taut_rope *rope = rope_of(coupling);
    fu_taut_lengths now;
    find_lengths(model, rope, state, &now);
    const energies of = energies_at(rope, &now);
    return of.U + energy_held(rope, state, &now, of.W);
}

static double dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const fu_accelerator *work)
{
    const fu_taut_rope *rope = rope_of(coupling);
    fu_taut_lengths now;
    (void)work;
    if (!coupling->is_damped || !fu_is_taut(rope, state)) return 0.0;
    if (fu_taut_slides(model, rope, state)) { /* damped by another rate than that of its own strain */
        fu_taut_lengths_at(model, rope, state, &now);
        return (now.tension - now.elastic) * now.growth;
    }
    find_lengths(model, rope, state, &now);
    double U, W, P;
    rope->kernel->energy(rope->EA, rope->tau, now.length[FU_DRAWN], now.free, now.growth, &U, &W, &P);
    return P;
}

/* Returns the stored energy that is dissipated, J: of a rope whose damping would push, so that it is slack. */
static double energy_without_force(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    fu_taut_lengths now;
    if (fu_is_taut(rope_of(coupling), state)) return 0.0;
    find_lengths(model, rope_of(coupling), state, &now);
    return energies_at(rope_of(coupling), &now).U;
}

static double lost_in_step(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                           int by_ends)
{
    (void)by_ends;
    if (!coupling->is_damped) return 0.0;
    return energy_without_force(model, coupling, from) - energy_without_force(model, coupling, to);
}

/* Stores the angles of parts and, in the plane, of what carries the points, from which later ones are counted. */
static void update_angles(const fu_model *model, const fu_taut_rope *rope, fu_state *state)
{
    for (int from = 0, to; from < rope->n_points; from = to) {
        const fu_taut_point *point = fu_taut_point_of(model, rope, from);
        double *numbers = state->numbers + point->base.numbers;
        if (!rope->part) {
            fu_attachment_state at;
            fu_taut_centre(model, point, state, &at);
            numbers[1] = fu_taut_carrier_angle(point, state, &at);
        }
        if (from == rope->n_points - 1) return;
        fu_taut_part part;
        to = fu_next_touched(model, rope, state, from);
        fu_taut_part_at(model, rope, state, from, to, &part);
        numbers[0] = part.angle[0];
        if (rope->part) state->numbers[fu_taut_point_of(model, rope, to)->base.numbers + 1] = part.angle[1];
    }
}

/* Stores the lengths of a rope, from which those of the next step are counted. */
static void store_lengths(const fu_taut_rope *rope, const fu_taut_lengths *now, fu_state *state)
{
    fu_taut_history *past = fu_taut_history_of(rope, state);
    double rate;
    const double held[SIDES] = {fu_taut_held(rope, state, now, 0, &rate), fu_taut_held(rope, state, now, 1, &rate)};
    past->energy = energy_held(rope, state, now, energies_at(rope, now).W);
    past->free = now->free;
    past->drawn = fu_is_taut(rope, state) ? now->length[FU_DRAWN] : now->free;
    for (int end = 0; end < SIDES; ++end) {
        past->held[end] = held[end];
        past->way[end] = now->way[end];
    }
}

/* The first rope of a chain stores the lengths of all of its ropes, which depend on those after the last step. */
static void update_history(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    const fu_taut_rope *rope = rope_of(coupling);
    fu_taut_lengths now;
    update_angles(model, rope, state);
    if (fu_taut_slides(model, rope, state)) {
        fu_taut_chain chain;
        fu_taut_chain_at(model, rope, state, &chain);
        if (chain.own) return;
        for (; chain.own < chain.n; ++chain.own) {
            fu_taut_piece *own = &chain.of[chain.own];
            fu_taut_slide(&chain, state, &own->now);
            store_lengths(own->rope, &own->now, state);
        }
        return;
    }
    find_lengths(model, rope, state, &now);
    store_lengths(rope, &now, state);
}

static void reset(const fu_coupling *coupling, fu_state *state)
{
    const fu_taut_rope *rope = rope_of(coupling);
    state->flags[coupling->flags] = 1;
    *fu_taut_history_of(rope, state) =
        (fu_taut_history){.free = rope->free_length,
                          .drawn = rope->drawn_length,
                          .energy = rope->held * energies_of(rope, rope->drawn_length, rope->free_length, 0.0).W};
}

/* In statics the positions determine whether a rope is taut. */
static void detect(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    const fu_taut_rope *rope = rope_of(coupling);
    fu_taut_lengths now;
    find_lengths(model, rope, state, &now);
    state->flags[coupling->flags] = now.length[FU_DRAWN] >= now.free;
    update_angles(model, rope, state);
}

double fu_taut_slack(const fu_model *model, const fu_taut_rope *rope, const fu_state *state)
{
    fu_taut_lengths now;
    if (fu_taut_slides(model, rope, state)) return fu_taut_chain_slack(model, rope, state);
    find_lengths(model, rope, state, &now);
    const double growth = now.growth * rope->tau;
    return -fmin(0.0, growth) - (now.length[FU_DRAWN] - now.free);
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

static const char *const role[] = {"taut_rope", 0}, *const part_role[] = {"taut_part", 0};

static const fu_field fields[] = {
    FU_FIELD(fu_taut_rope, kernel, FU_KERNELS, role), FU_FIELD(fu_taut_rope, part, FU_KERNELS, part_role),
    FU_FIELD(fu_taut_rope, n_points, FU_INTEGER, 0),  FU_FIELD(fu_taut_rope, points, FU_INTEGERS, 0),
    FU_FIELD(fu_taut_rope, EA, FU_REAL, 0),           FU_FIELD(fu_taut_rope, tau, FU_REAL, 0),
    FU_FIELD(fu_taut_rope, drawn_length, FU_REAL, 0), FU_FIELD(fu_taut_rope, free_length, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_taut_rope, angles, FU_REAL),    FU_FIELD_ARRAY(fu_taut_rope, carriers, FU_REAL),
    FU_FIELD(fu_taut_rope, held, FU_REAL, 0),         FU_FIELD(fu_taut_rope, least_length, FU_REAL, 0),
    FU_FIELD(fu_taut_rope, n_pieces, FU_INTEGER, 0),  {0},
};

static const fu_output output_fields[] = {
    FU_OUTPUT(rope_output, tension, "N", NULL),
    FU_OUTPUT(rope_output, drawn_length, "m", NULL),
    FU_OUTPUT(rope_output, free_length, "m", NULL),
    FU_LAST_OUTPUT(rope_output),
};

static const char *excess(const fu_coupling *coupling)
{
    return rope_of(coupling)->n_pieces > FU_MAX_PIECES ? "sheaves with friction" : 0;
}

static const fu_start_operations start = {.reset = reset, .excess = excess};
static const fu_history_operations of_history = {.update = update_history};

const fu_coupling_type fu_taut_rope_type = {
    .name = "taut_rope",
    .size = sizeof(fu_taut_rope),
    .fields = fields,
    .output_fields = output_fields,
    .n_numbers = sizeof(fu_taut_history) / sizeof(double),
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
    .detect = detect,
};
