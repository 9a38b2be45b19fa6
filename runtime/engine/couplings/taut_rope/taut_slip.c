/* Where ropes without mass stick to sheaves and slip on them: the speed of slip, and changes of what slips and of what
 * is taut. */
#include "bodies/model.h"
#include "couplings/taut_rope/taut_rope.h"

enum { START, END, SIDES };

/* Returns the way a second onto the wheel at an end that its rotation takes, where the rope sticks, m/s. */
static double way_by_wheel(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, int end)
{
    const fu_taut_point *point = fu_taut_end(model, rope, end);
    fu_attachment_state centre;
    fu_taut_centre(model, point, state, &centre);
    return (end ? point->radius : -point->radius) * fu_taut_spin(model, point, state, &centre);
}

double fu_taut_slip(const fu_model *model, const fu_taut_point *point, const fu_state *state)
{
    fu_taut_lengths after;
    if (!fu_taut_slips(point, state)) return 0.0;
    fu_taut_lengths_at(model, fu_taut_beside(model, point, 1), state, &after);
    return after.slid_rate[START] + way_by_wheel(model, fu_taut_beside(model, point, 1), state, START);
}

/* The way of an end is counted with the rotation of the wheel where the rope sticks, and without it where it slips. */
void fu_taut_set_slip(const fu_model *model, const fu_taut_point *point, fu_state *state, int direction)
{
    int *slips = state->flags + point->base.flags + FU_SLIPS;
    fu_attachment_state centre;
    fu_taut_centre(model, point, state, &centre);
    if (!*slips != !direction)
        for (int side = 0; side < SIDES; ++side) {
            const fu_taut_rope *rope = fu_taut_beside(model, point, side);
            const int end = side ? START : END;
            const double turned = fu_taut_turn(point, state, &centre) - rope->carriers[end],
                         way = (end ? point->radius : -point->radius) * turned;
            ((fu_taut_history *)(state->numbers + rope->base.numbers))->way[end] += direction ? -way : way;
        }
    *slips = direction;
}

/* Ratios around a closed rope that slips on all sheaves would have to close: those on which it slipped before stick. It
 * has no mass, so that its speed may jump. */
void fu_taut_close(const fu_model *model, const fu_taut_point *point, fu_state *state)
{
    const fu_taut_rope *first = fu_taut_beside(model, point, 1), *rope = first;
    while (fu_taut_slips_at(model, rope, state, END) && fu_taut_beyond(model, rope, END) != first)
        rope = fu_taut_beyond(model, rope, END);
    if (!fu_taut_slips_at(model, rope, state, END)) return;
    for (rope = first; fu_taut_end(model, rope, END) != point; rope = fu_taut_beyond(model, rope, END))
        fu_taut_set_slip(model, fu_taut_end(model, rope, END), state, 0);
}

void fu_taut_set_taut(const fu_model *model, const fu_taut_rope *rope, fu_state *state, int is_taut)
{
    fu_taut_chain chain;
    fu_taut_chain_at(model, rope, state, &chain);
    for (int k = 0; k < chain.n; ++k) state->flags[chain.of[k].rope->base.flags] = is_taut;
}

void fu_taut_find_taut(const fu_model *model, const fu_taut_rope *rope, fu_state *state)
{
    fu_taut_chain chain;
    fu_taut_set_taut(model, rope, state, 0);
    fu_taut_chain_at(model, rope, state, &chain);
    if (chain.x > 0.0) fu_taut_set_taut(model, rope, state, 1);
}

void fu_taut_recount(const fu_model *model, const fu_taut_point *point, fu_state *state)
{
    const fu_taut_rope *rope = fu_taut_beside(model, point, 0);
    int *taut = state->flags + rope->base.flags;
    FU_EACH_COUPLING(c, model->couplings, model->n_couplings)
        if (c->type == &fu_taut_rope_type) c->type->history->update(model, c, state);
    if (fu_taut_slides(model, rope, state)) fu_taut_find_taut(model, rope, state);
    else if (*taut) *taut = fu_taut_slack(model, rope, state) <= 0.0;
}

/* Without strain, the rope is pulled to the side on which its strain would grow faster if it stuck. */
void fu_taut_redirect(const fu_model *model, const fu_taut_rope *rope, fu_state *state)
{
    fu_taut_chain chain;
    double before = 0.0;
    fu_taut_chain_at(model, rope, state, &chain);
    for (int k = 0; k < chain.n; ++k) {
        const fu_taut_piece *at = &chain.of[k];
        double growth = at->now.growth;
        for (int end = 0; end < SIDES; ++end)
            if (fu_taut_slips_at(model, at->rope, state, end)) growth += way_by_wheel(model, at->rope, state, end);
        growth /= at->now.length[FU_DRAWN];
        if (k) fu_taut_set_slip(model, fu_taut_end(model, at->rope, START), state, growth < before ? -1 : 1);
        before = growth;
    }
}
