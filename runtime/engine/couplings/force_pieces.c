/* Forces between two points whose law differs by pieces of their distance: springs that pull alone, free play, tables.
 *
 * Within a step the force follows the law of one piece, the flag of the state, so that each step is smooth. A piece that
 * pulls alone, or pushes alone, is left where its force, the damper's part of it included, turns round; it is entered where
 * the points are on it and its force has its sense. Steps end where the force passes from piece to piece.
 *
 * A force that is gone over follows the law of the piece that its points' distance is on, within a step too: no step has to
 * end there. Over steps that conserve energy all forces keep to their pieces.
 */
#include "engine.h"

#include <math.h>

static const fu_point_force *force_of(const fu_coupling *coupling)
{
    return (const fu_point_force *)coupling;
}

/* Returns the piece whose law the force follows. */
int fu_force_piece(const fu_point_force *between, const fu_state *state)
{
    return state->flags[between->base.flags];
}

const double *fu_piece_parameters(const fu_point_force *between, int piece)
{
    return between->parameters + (long)piece * between->n_parameters;
}

static double norm(int dim, const double *gap)
{
    return sqrt(fu_dot(dim, gap, gap));
}

static int piece_at_distance(const fu_point_force *between, double distance)
{
    int piece = 0;
    while (piece < between->n_pieces - 1 && distance > between->bounds[piece]) ++piece;
    return piece;
}

/* Returns the piece that the distance of the points is on. */
int fu_piece_at(const fu_model *model, const fu_point_force *between, const fu_state *state)
{
    double gap[3], rate[3];
    if (between->n_pieces == 1) return 0;
    fu_gap(model, between, state->q, model->zero, gap, rate);
    return piece_at_distance(between, norm(between->dim, gap));
}

/* Returns the piece whose law the force follows at an instant. */
int fu_piece_now(const fu_model *model, const fu_point_force *between, const fu_state *state)
{
    return between->is_gone_over ? fu_piece_at(model, between, state) : fu_force_piece(between, state);
}

/* In statics the force follows from the positions. */
void fu_touch_piece(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    state->flags[coupling->flags] = fu_piece_at(model, force_of(coupling), state);
}

/* Returns how far the force of a piece is on the right side of nil, m; infinity where it may pull and push. */
static double margin_of_sense(const fu_point_force *between, int piece, const double *gap, const double *rate, double distance)
{
    const int sense = between->senses[piece];
    double force[3];
    if (sense != FU_PULLS_ALONE && sense != FU_PUSHES_ALONE) return INFINITY;
    between->law->force(fu_piece_parameters(between, piece), gap, rate, force);
    return sense * between->compliance * fu_dot(between->dim, force, gap) / distance;
}

/* How the force may pass from its piece to another: `margin` is negative while it stays, m. */
typedef struct {
    double margin;
    int piece;
} passage;

static passage farther(passage a, passage b)
{
    return b.margin > a.margin ? b : a;
}

/* Returns the nearest piece without force towards the distances at which a piece's own force is nil. */
static int free_beside(const fu_point_force *between, int piece)
{
    const int step = -between->senses[piece];
    while (between->senses[piece] != FU_HAS_NO_FORCE) piece += step;
    return piece;
}

/* Returns the passage of the force to a piece with a force on one side of a piece without: where the points are on it, and its
 * force has its sense. */
static passage entering(const fu_point_force *between, int piece, int side, const double *gap, const double *rate,
                        double distance)
{
    const double beyond = side * (distance - between->bounds[piece - (side < 0)]);
    int entered = piece_at_distance(between, distance);
    if (side * (entered - piece) < 1) entered = piece + side;
    return (passage){fmin(beyond, margin_of_sense(between, entered, gap, rate, distance)), entered};
}

/* Returns the passage that is nearest, or has happened. */
static passage next_passage(const fu_model *model, const fu_point_force *between, const fu_state *state)
{
    const int piece = fu_force_piece(between, state);
    passage found = {-INFINITY, piece};
    double gap[3], rate[3];
    fu_gap(model, between, state->q, state->v, gap, rate);
    const double distance = norm(between->dim, gap);
    const double sense = margin_of_sense(between, piece, gap, rate, distance);
    if (sense < INFINITY) found = (passage){-sense, free_beside(between, piece)};
    for (int side = -1; side <= 1; side += 2) {
        const int beside = piece + side;
        if (beside < 0 || beside >= between->n_pieces) continue;
        if (between->senses[piece] == FU_HAS_NO_FORCE)
            found = farther(found, entering(between, piece, side, gap, rate, distance));
        else
            found = farther(found, (passage){side * (distance - between->bounds[piece - (side < 0)]), beside});
    }
    return found;
}

/* Returns whether steps go over the passages of a force. */
static int goes_over(const fu_run *run, const fu_coupling *coupling)
{
    return force_of(coupling)->is_gone_over && !run->integrator->keeps_energy;
}

static int watches(const fu_coupling *coupling, fu_watch *out)
{
    if (force_of(coupling)->n_pieces == 1) return 0;
    if (out) *out = (fu_watch){.which = 0, .direction = 1};
    return 1;
}

static double watched(const fu_run *run, const fu_coupling *coupling, const fu_state *state, int which)
{
    (void)which;
    if (goes_over(run, coupling)) return -1.0;
    return next_passage(run->model, force_of(coupling), state).margin;
}

static int sign(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int which)
{
    (void)model, (void)coupling, (void)state, (void)which;
    return -1;
}

/* Puts the force on a piece, of which the run is told. */
static void pass(const fu_coupling *coupling, fu_state *state, int piece)
{
    state->flags[coupling->flags] = state->flags[coupling->flags + 1] = piece;
}

/* Returns what a passage from one piece to another is called. */
static const char *words(const fu_point_force *between, int before, int after)
{
    const int was_free = between->senses[before] == FU_HAS_NO_FORCE, is_free = between->senses[after] == FU_HAS_NO_FORCE;
    return is_free ? "became slack" : !was_free ? "" : after > before ? "became taut" : "came into contact";
}

static int act(fu_run *run, const fu_coupling *coupling, int which, int side, const char **what)
{
    const fu_point_force *between = force_of(coupling);
    const int before = fu_force_piece(between, &run->now), after = next_passage(run->model, between, &run->now).piece;
    (void)which, (void)side;
    pass(coupling, &run->now, after);
    *what = words(between, before, after);
    return FU_RUNNING;
}

static int is_gone_over(const fu_coupling *coupling)
{
    return force_of(coupling)->is_gone_over;
}

static int announce(fu_run *run, const fu_coupling *coupling, const char **what)
{
    const fu_point_force *between = force_of(coupling);
    if (!goes_over(run, coupling)) return 0;
    fu_touch_piece(run->model, coupling, &run->now);
    const int *flags = run->now.flags + coupling->flags, before = flags[1], after = flags[0];
    if (before == after) return 0;
    pass(coupling, &run->now, after);
    *what = words(between, before, after);
    return 1;
}

static int can_act(const fu_coupling *coupling)
{
    return force_of(coupling)->n_pieces > 1;
}

/* A force that the damper would turn round at the start is none. */
static int begin(fu_run *run, const fu_coupling *coupling)
{
    const fu_point_force *between = force_of(coupling);
    fu_state *now = &run->now;
    if (between->n_pieces == 1) return FU_RUNNING;
    fu_touch_piece(run->model, coupling, now);
    const passage next = next_passage(run->model, between, now);
    pass(coupling, now, next.margin > 0.0 && !between->is_gone_over ? next.piece : fu_force_piece(between, now));
    return FU_RUNNING;
}

const fu_coupling_events fu_point_force_events = {
    .watches = watches,
    .watched = watched,
    .sign = sign,
    .act = act,
    .announce = announce,
    .is_gone_over = is_gone_over,
    .can_act = can_act,
    .begin = begin,
};
