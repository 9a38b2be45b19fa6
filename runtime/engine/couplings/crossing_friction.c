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

void fu_crossing_grip_at(const fu_crossing *crossing, const fu_state *state, const fu_closest_points *points, double press,
                         fu_crossing_grip *out)
{
    const int dim = crossing->kernel->dim;
    const before *last = before_of(crossing, state);
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

double fu_crossing_slid(const fu_crossing *crossing, const fu_crossing_grip *grip)
{
    double sum = 0.0;
    for (int d = 0; d < crossing->kernel->dim; ++d)
        sum += 0.5 * crossing->tangential * (grip->old[d] + grip->stretch[d]) * (grip->without_sliding[d] - grip->stretch[d]);
    return sum;
}

void fu_crossing_begin_grip(const fu_crossing *crossing, const fu_closest_points *points, fu_state *state)
{
    before *last = before_of(crossing, state);
    memset(last, 0, sizeof *last);
    memcpy(last->s, points->s, sizeof last->s);
    memcpy(last->way, points->d, sizeof(double) * (size_t)crossing->kernel->dim);
}

void fu_crossing_carry_grip(const fu_crossing *crossing, const fu_closest_points *points, const fu_crossing_contact *contact,
                            fu_state *state)
{
    const int dim = crossing->kernel->dim;
    fu_crossing_grip grip;
    double across[3];
    fu_crossing_grip_at(crossing, state, points, contact->size, &grip);
    fu_crossing_begin_grip(crossing, points, state);
    before_of(crossing, state)->slid = grip.slides;
    double *stretch = before_of(crossing, state)->stretch;
    stretch[0] = fu_dot(dim, grip.along, grip.stretch);
    if (dim == 2) return;
    fu_cross(contact->normal, grip.along, across);
    stretch[1] = fu_dot(dim, across, grip.stretch);
}

void fu_crossing_reset_grip(const fu_crossing *crossing, fu_state *state)
{
    before *last = before_of(crossing, state);
    memset(last, 0, sizeof *last);
    memcpy(last->s, crossing->start, sizeof last->s);
    memcpy(last->way, crossing->way, sizeof last->way);
}
