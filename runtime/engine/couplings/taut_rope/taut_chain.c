/* Ropes without mass that slip on sheaves. Ropes of one tension between which the whole slips are a chain: each tension
 * is e^(mu theta) times that of its neighbour, and the strain of the first one follows from the stress-free length of
 * all (derive/couplings/taut_rope.py). The elastic tensions obey this law; the damping of the material acts on the
 * strain of the first rope. A chain without strain has no tension, and its stress-free length is anywhere: its
 * compression is the same all over. */
#include "bodies/model.h"
#include "couplings/taut_rope/taut_rope.h"

#include <math.h>
#include <string.h>

#define MAX_ITERATIONS 100
#define ROUNDING_OF_STRAIN 4e-16 /* of the stretch */

enum { START, END, SIDES };

int fu_taut_slides(const fu_model *model, const fu_taut_rope *rope, const fu_state *state)
{
    return fu_taut_slips_at(model, rope, state, START) || fu_taut_slips_at(model, rope, state, END);
}

/* Returns the first rope of a chain; of a closed one any. */
static const fu_taut_rope *first_of(const fu_model *model, const fu_taut_rope *rope, const fu_state *state)
{
    const fu_taut_rope *first = rope;
    while (fu_taut_slips_at(model, first, state, START) && fu_taut_beyond(model, first, START) != rope)
        first = fu_taut_beyond(model, first, START);
    return first;
}

/* Computes the sums over a chain at its strain. */
static void add_up(fu_taut_chain *chain)
{
    memset(chain->sums, 0, sizeof chain->sums);
    memset(chain->sums_x, 0, sizeof chain->sums_x);
    for (int k = 0; k < chain->n; ++k) {
        fu_taut_piece *at = &chain->of[k];
        at->rope->kernel->slide(at->now.length, at->now.past, exp(at->log_ratio), chain->x, at->sums, at->sums_x);
        for (int i = 0; i < FU_SUMS; ++i) {
            chain->sums[i] += at->sums[i];
            chain->sums_x[i] += at->sums_x[i];
        }
    }
}

/* Solves for the strain of the first rope. The excess decreases with it and is convex, so that Newton's iteration
 * converges from below. */
static void solve(fu_taut_chain *chain)
{
    for (int i = 0; i < MAX_ITERATIONS; ++i) {
        const double change = -chain->sums[FU_EXCESS] / chain->sums_x[FU_EXCESS];
        chain->x += change;
        add_up(chain);
        if (!(fabs(change) > ROUNDING_OF_STRAIN * (1.0 + fabs(chain->x)))) return;
    }
}

/* Computes the strain of a chain without tension, which runs onto wheels without stretch, and its sums. */
static void slacken(fu_taut_chain *chain)
{
    double drawn = 0.0, free = 0.0, taut;
    for (int k = 0; k < chain->n; ++k) {
        fu_taut_piece *at = &chain->of[k];
        at->log_ratio = at->log_ratio_rate = 0.0;
        at->rope->kernel->free_length(at->now.length, at->now.past, &taut, &at->now.free);
        drawn += at->now.length[FU_DRAWN];
        free += at->now.free;
    }
    const double stretch = drawn / free;
    chain->x = stretch - 1.0;
    chain->sums[FU_BY_RATE] = 0.0;
    for (int k = 0; k < chain->n; ++k) {
        fu_taut_piece *at = &chain->of[k];
        at->now.growth = at->now.rate[FU_DRAWN] / stretch + at->now.rate[FU_WAY];
        at->sums[FU_EXCESS] = at->now.length[FU_DRAWN] / stretch - at->now.free;
        at->sums[FU_BY_RATE] = at->now.length[FU_DRAWN] / (stretch * stretch);
        chain->sums[FU_BY_RATE] += at->sums[FU_BY_RATE];
    }
}

/* Returns the growth of a rope at the rate of the strain. */
static double growth_of(const fu_taut_chain *chain, int k)
{
    return chain->of[k].sums[FU_BY_RATE] * (chain->x_rate + chain->of[k].log_ratio_rate * chain->x);
}

/* Returns the change of the logarithm of the ratio by the angle of the wrap at a point; 0 where the rope sticks. */
static double by_wrap(const fu_taut_point *point, const fu_state *state)
{
    return fu_taut_slips(point, state) * point->friction * (point->radius < 0.0 ? -1.0 : 1.0);
}

void fu_taut_chain_at(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, fu_taut_chain *out)
{
    const fu_taut_rope *next = first_of(model, rope, state);
    double log_ratio = 0.0, log_ratio_rate = 0.0, growth = 0.0, by_ratios = 0.0;
    out->n = out->own = 0;
    out->x = 0.0;
    for (;;) {
        fu_taut_piece *at = &out->of[out->n];
        at->rope = next;
        fu_taut_geometry(model, next, state, &at->now);
        if (out->n) { /* the sheave between the last rope and this one */
            const fu_taut_point *point = fu_taut_end(model, next, START);
            const fu_taut_lengths *one = &at[-1].now, *other = &at->now;
            const double share = by_wrap(point, state);
            log_ratio += share * (other->angle[START] - one->angle[END] + point->closing);
            log_ratio_rate += share * (other->turning[START] - one->turning[END]);
        }
        at->log_ratio = log_ratio;
        at->log_ratio_rate = log_ratio_rate;
        if (next == rope) out->own = out->n;
        ++out->n;
        if (!fu_taut_slips_at(model, next, state, END) || out->n == FU_MAX_PIECES) break;
        next = fu_taut_beyond(model, next, END);
        if (next == out->of[0].rope) break;
    }
    add_up(out); /* without strain */
    if (fu_is_taut(out->of[0].rope, state) || out->sums[FU_EXCESS] > 0.0) solve(out);
    else slacken(out);
    for (int k = 0; k < out->n; ++k) {
        growth += out->of[k].now.growth;
        by_ratios += out->of[k].sums[FU_BY_RATE] * out->of[k].log_ratio_rate * out->x;
    }
    out->x_rate_alone = growth / out->sums[FU_BY_RATE];
    out->x_rate = (growth - by_ratios) / out->sums[FU_BY_RATE];
}

/* Returns the rate of the strain of the first rope at constant ratios, times the retardation time. */
static double damped_strain(const fu_taut_chain *chain)
{
    return chain->of[0].rope->tau * chain->x_rate_alone;
}

static double first_tension(const fu_taut_chain *chain)
{
    return chain->of[0].rope->EA * (chain->x + damped_strain(chain));
}

double fu_taut_chain_slack(const fu_model *model, const fu_taut_rope *rope, const fu_state *state)
{
    fu_taut_chain chain;
    fu_taut_chain_at(model, rope, state, &chain);
    return chain.own ? NAN : -(chain.x + fmin(0.0, damped_strain(&chain))) * chain.of[0].now.length[FU_DRAWN];
}

void fu_taut_slide(const fu_taut_chain *chain, const fu_state *state, fu_taut_lengths *out)
{
    const fu_taut_piece *own = &chain->of[chain->own];
    const double ratio = exp(own->log_ratio), strain = ratio * chain->x;
    const int taut = fu_is_taut(own->rope, state);
    double slid = 0.0, slid_rate = 0.0;
    for (int k = 0; k <= chain->own; ++k) {
        out->slid[START] = slid;
        out->slid_rate[START] = slid_rate;
        slid -= chain->of[k].sums[FU_EXCESS];
        slid_rate += growth_of(chain, k) - chain->of[k].now.growth;
    }
    out->slid[END] = slid;
    out->slid_rate[END] = slid_rate;
    out->free = out->length[FU_DRAWN] / (1.0 + strain);
    out->per_way = taut ? 1.0 / (1.0 + strain) : 1.0;
    out->elastic = fmax(own->rope->EA * strain, 0.0);
    out->tension = taut ? ratio * first_tension(chain) : 0.0;
    out->growth = growth_of(chain, chain->own);
}

/* Returns the change of the logarithm of the ratio at an end by the angle of the part there; 0 where the rope sticks.
 */
static double share_of_angle(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, int end)
{
    const fu_taut_point *point = fu_taut_end(model, rope, end);
    const double share = by_wrap(point, state);
    return end ? -share : share;
}

/* Implicit differentiation of the strain x by the excess, whose sum is zero. */
void fu_taut_slide_law(const fu_model *model, const fu_taut_chain *chain, const fu_state *state, int of,
                       double *by_ratios, fu_taut_law *out)
{
    const fu_taut_piece *at = &chain->of[of];
    const fu_taut_rope *rope = at->rope;
    const double own = fu_is_taut(chain->of[chain->own].rope, state) ? exp(chain->of[chain->own].log_ratio) : 0.0;
    const double EA = own * rope->EA, rate = rope->tau / chain->sums[FU_BY_RATE], by_rate = -rate * chain->x_rate_alone;
    const double by_x = 1.0 + by_rate * chain->sums_x[FU_BY_RATE];
    const double weights[FU_SUMS] = {-EA * by_x / chain->sums_x[FU_EXCESS], EA * by_rate}, next = *by_ratios;
    double by_ratio;
    rope->kernel->slide_tangent(weights, at->now.length, at->now.past, exp(at->log_ratio), chain->x, out->K, &by_ratio);
    *by_ratios += by_ratio + (of == chain->own ? own * first_tension(chain) : 0.0);
    out->D[FU_DRAWN] = out->D[FU_WAY] = EA * rate;
    out->angle[START] = *by_ratios * share_of_angle(model, rope, state, START);
    out->angle[END] = next * share_of_angle(model, rope, state, END);
}
