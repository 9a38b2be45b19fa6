/* Friction that sticks where lines touch: a spring, stretched by the way that particles of both lines have gone past each other since
 * the last step, and no longer than friction allows (derive/couplings/stretch.py).
 */
#include "engine.h"

#include <math.h>
#include <string.h>

/* What a state keeps of the last step: the closest points, the way between them, the stretch along and across the last line; not zero
 * where it has slid, as then the stretch is just what friction allows. */
typedef struct {
    double s[FU_LINES], way[3], stretch[2], slid;
} before;
_Static_assert(sizeof(before) == FU_CROSSING_GRIP * sizeof(double), "numbers of a state are doubles");

static before *before_of(const fu_crossing *crossing, const fu_state *state)
{
    return (before *)(state->numbers + crossing->base.numbers + FU_CROSSING_NUMBERS);
}

static void moved_since(const before *last, const fu_closest_points *points, double e[FU_LINES])
{
    for (int line = 0; line < FU_LINES; ++line) e[line] = points->s[line] - last->s[line];
}

static void grip_since(const fu_crossing *crossing, const before *last, const fu_closest_points *points, double press, fu_crossing_grip *out)
{
    const int dim = crossing->kernel->dim;
    double e[FU_LINES];
    memset(out, 0, sizeof *out);
    moved_since(last, points, e);
    crossing->kernel->stretch(points->d, points->t, points->k, crossing->law, e, last->way, last->stretch,
                              out->without_sliding, out->old, out->along);
    memcpy(out->stretch, out->without_sliding, sizeof out->stretch);
    out->slides = fu_limit_stretch(dim, crossing->tangential, crossing->friction * fmax(press, 0.0), out->stretch);
    for (int d = 0; d < dim; ++d) out->force[d] = -crossing->tangential * out->stretch[d];
    out->sticks = !out->slides && last->slid == 0.0;
    out->energy = 0.5 * crossing->tangential * fu_dot(dim, out->stretch, out->stretch);
}

void fu_crossing_grip_at(const fu_crossing *crossing, const fu_state *state, const fu_closest_points *points, double press,
                         fu_crossing_grip *out)
{
    grip_since(crossing, before_of(crossing, state), points, press, out);
}

void fu_crossing_grip_derivatives(const fu_crossing *crossing, const fu_state *state, const fu_closest_points *points, double press,
                                  double F[3], double F_d[9], double F_t[18], double F_u[9])
{
    const before *last = before_of(crossing, state);
    const fu_crossing_kernels *kernel = crossing->kernel;
    const double friction = press > 0.0 ? crossing->friction : 0.0;
    double e[FU_LINES];
    fu_crossing_grip grip;
    fu_crossing_grip_at(crossing, state, points, press, &grip);
    moved_since(last, points, e);
    memset(F_u, 0, sizeof(double[9]));
    if (grip.slides)
        kernel->sliding(points->d, points->t, points->k, points->w, points->u, crossing->law, friction, e, last->way, last->stretch, F, F_d,
                        F_t, F_u);
    else kernel->sticking(points->d, points->t, points->k, crossing->law, crossing->tangential, e, last->way, last->stretch,
                          F, F_d, F_t);
}

/* Returns what friction has taken since the last place, J: the mean force times the way that the spring has not stretched by. */
static double slid(const fu_crossing *crossing, const fu_crossing_grip *grip)
{
    double sum = 0.0;
    for (int d = 0; d < crossing->kernel->dim; ++d)
        sum += 0.5 * crossing->tangential * (grip->old[d] + grip->stretch[d]) * (grip->without_sliding[d] - grip->stretch[d]);
    return sum;
}

static void begin_at(const fu_crossing *crossing, const fu_closest_points *points, before *last)
{
    memset(last, 0, sizeof *last);
    memcpy(last->s, points->s, sizeof last->s);
    memcpy(last->way, points->d, sizeof(double) * (size_t)crossing->kernel->dim);
}

void fu_crossing_begin_grip(const fu_crossing *crossing, const fu_closest_points *points, fu_state *state)
{
    begin_at(crossing, points, before_of(crossing, state));
}

/* Takes the stretch of a grip along to where it is. */
static void take_along(const fu_crossing *crossing, const fu_closest_points *points, const fu_crossing_contact *contact,
                       const fu_crossing_grip *grip, before *last)
{
    const int dim = crossing->kernel->dim;
    double across[3];
    begin_at(crossing, points, last);
    last->slid = grip->slides;
    last->stretch[0] = fu_dot(dim, grip->along, grip->stretch);
    if (dim == 2) return;
    fu_cross(contact->normal, grip->along, across);
    last->stretch[1] = fu_dot(dim, across, grip->stretch);
}

void fu_crossing_carry_grip(const fu_crossing *crossing, const fu_closest_points *points, const fu_crossing_contact *contact,
                            fu_state *state)
{
    fu_crossing_grip grip;
    fu_crossing_grip_at(crossing, state, points, contact->size, &grip);
    take_along(crossing, points, contact, &grip, before_of(crossing, state));
}

/* Grips on the way through a step: that at its end at once, that at a place within it, that at the end by this place. */
typedef struct {
    fu_crossing_grip once, within, twice;
} way;

/* Makes the grips from one state to another; the place within is where particles turn round on their way past each other, if `at_turn` is
 * not zero, or half-way. Returns not zero where lines that touch have no closest points. */
static int go_on_way(const fu_model *model, const fu_crossing *crossing, const fu_state *from, const fu_state *to, int at_turn, way *out)
{
    const int dim = crossing->kernel->dim;
    fu_moment moment = {.now = from, .next = to, .h = to->t - from->t, .x = 0.5};
    fu_closest_points begin, within, end;
    fu_crossing_contact contact;
    before last = *before_of(crossing, from);
    double s[FU_LINES];
    fu_find_closest(model, crossing, to, &end);
    if (!end.found || !(moment.h > 0.0)) return 1;
    fu_crossing_contact_at(crossing, &end, &contact);
    const double press = contact.size;
    grip_since(crossing, &last, &end, press, &out->once);
    fu_find_closest(model, crossing, from, &begin);
    if (!begin.found) return 1;
    const double before = fu_dot(dim, out->once.stretch, begin.u), after = fu_dot(dim, out->once.stretch, end.u);
    if (at_turn && before * after < 0.0) moment.x = before / (before - after);
    for (int line = 0; line < FU_LINES; ++line) s[line] = begin.s[line] + moment.x * (end.s[line] - begin.s[line]);
    fu_find_closest_within(model, crossing, &moment, s, &within);
    if (!within.found) return 1;
    fu_crossing_contact_at(crossing, &within, &contact);
    grip_since(crossing, &last, &within, contact.size, &out->within);
    take_along(crossing, &within, &contact, &out->within, &last);
    grip_since(crossing, &last, &end, press, &out->twice);
    return 0;
}

double fu_crossing_carried_error(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to)
{
    const fu_crossing *crossing = (const fu_crossing *)coupling;
    way grips;
    if (!(crossing->friction > 0.0) || !from->flags[coupling->flags] || go_on_way(model, crossing, from, to, 1, &grips)) return 0.0;
    return fabs(sqrt(fu_dot(model->dim, grips.once.stretch, grips.once.stretch)) -
                sqrt(fu_dot(model->dim, grips.twice.stretch, grips.twice.stretch)));
}

double fu_crossing_slid_on_way(const fu_model *model, const fu_crossing *crossing, const fu_state *from, const fu_state *to, int by_ends)
{
    way grips;
    if (go_on_way(model, crossing, from, to, 0, &grips)) return 0.0;
    const double once = slid(crossing, &grips.once);
    const double twice = slid(crossing, &grips.within) + slid(crossing, &grips.twice);
    return by_ends ? once : (4.0 * twice - once) / 3.0;
}

void fu_crossing_reset_grip(const fu_crossing *crossing, fu_state *state)
{
    before *last = before_of(crossing, state);
    memset(last, 0, sizeof *last);
    memcpy(last->s, crossing->start, sizeof last->s);
    memcpy(last->way, crossing->way, sizeof last->way);
}
