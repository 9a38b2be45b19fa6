/* History of a drum: the stretch of what is wound, in cells, and its way since the last accepted state. */
#include "couplings/drum/drum.h"

#include <math.h>

int fu_drum_cell(const fu_drum *drum, double u)
{
    const double cell = ceil(u / drum->cell) - 1.0;
    return cell < 0.0 ? 0 : cell < drum->n_cells ? (int)cell : drum->n_cells - 1;
}

double fu_drum_cell_stretch(const fu_drum *drum, const fu_drum_history *past, int cell)
{
    if (cell < fu_drum_cell(drum, past->u)) return (past->profile[cell + 1] - past->profile[cell]) / drum->cell;
    const double length = past->u - cell * drum->cell;
    return length > 0.0 ? (past->drawn - past->profile[cell]) / length : past->stretch;
}

double fu_drum_wound_stretch(const fu_drum *drum, const fu_drum_history *past, double u)
{
    return fu_drum_cell_stretch(drum, past, fu_drum_cell(drum, u));
}

double fu_drum_drawn_length(const fu_drum *drum, const fu_drum_history *past, double u)
{
    const int cell = fu_drum_cell(drum, u);
    return past->profile[cell] + fu_drum_cell_stretch(drum, past, cell) * (u - cell * drum->cell);
}

/* Returns a change of an angle that is less than half a turn. */
static double turned(double from, double to)
{
    return remainder(to - from, 2.0 * acos(-1.0));
}

/* It is that of travel, which pays out at the first end, or its opposite. */
double fu_winding_sense(const fu_drum *drum)
{
    return drum->direction * drum->wheel.sense;
}

double fu_drum_way(const fu_drum *drum, const fu_drum_history *past, const fu_drum_state *at)
{
    return fu_winding_sense(drum) * drum->wheel.radius *
           (turned(past->phi, at->phi) - turned(past->carrier, at->carrier) - (at->turn - past->turn));
}

/* Returns the drawn length that has been wound since then, by the mean stretch of winding. */
static double wound_since(const fu_drum *drum, const fu_drum_history *past, const fu_drum_state *at)
{
    return at->u > past->u ? 0.5 * (at->u - past->u) * (past->stretch + at->span_stretch)
                           : fu_drum_drawn_length(drum, past, at->u) - past->drawn;
}

double fu_drum_passing(const fu_drum *drum, const fu_drum_history *past, const fu_drum_state *at)
{
    if (at->u > past->u) return 0.5 * (past->stretch + at->span_stretch);
    if (fu_drum_cell(drum, at->u) == fu_drum_cell(drum, past->u)) return fu_drum_wound_stretch(drum, past, at->u);
    return wound_since(drum, past, at) / (at->u - past->u);
}

double fu_drum_winding_gap(const fu_drum *drum, const fu_drum_history *past, const fu_drum_state *at)
{
    return fu_drum_way(drum, past, at) - wound_since(drum, past, at);
}
