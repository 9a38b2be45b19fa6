/* Penetration of two lines at their closest points, and the normal force there. */
#include "bodies/model.h"
#include "couplings/crossing/crossing.h"

#include <math.h>
#include <string.h>

void fu_crossing_contact_at(const fu_crossing *crossing, const fu_closest_points *points, fu_crossing_contact *out)
{
    memset(out, 0, sizeof *out);
    crossing->kernel->contact(points->d, points->t, points->u, crossing->law, out->normal, out->depth, &out->size,
                              out->force, &out->energy, &out->dissipated);
}

int fu_crossing_swung(const fu_crossing *crossing, const fu_state *state, const fu_crossing_contact *contact)
{
    return fu_dot(3, state->numbers + crossing->base.numbers + FU_CROSSING_NORMAL, contact->normal) < 0.0;
}

/* Returns the distance of the closest points from the ends of their lines, m. */
double fu_crossing_distance_to_ends(const fu_crossing *crossing, const fu_closest_points *points)
{
    double distance = INFINITY;
    for (int line = 0; line < FU_LINES; ++line)
        distance = fmin(distance, fmin(points->s[line] - crossing->low[line], crossing->high[line] - points->s[line]));
    return distance;
}

double fu_crossing_margin_of(const fu_crossing *crossing, const fu_closest_points *points,
                             const fu_crossing_contact *contact)
{
    const double damping = crossing->law[FU_LAW_DAMPING];
    double margin = contact->depth[0];
    /* a length, that of a millisecond's motion */
    if (damping > 0.0) margin = fmin(margin, (1.0 / damping + contact->depth[1]) * FU_INSTANT);
    return fmin(margin, fu_crossing_distance_to_ends(crossing, points));
}

double fu_crossing_margin(const fu_model *model, const fu_crossing *crossing, const fu_state *state)
{
    fu_closest_points points;
    fu_crossing_contact contact;
    fu_find_closest(model, crossing, state, &points);
    if (!points.found) return points.apart > 0.0 ? -points.apart : NAN;
    fu_crossing_contact_at(crossing, &points, &contact);
    if (fu_crossing_swung(crossing, state, &contact)) return NAN;
    return fu_crossing_margin_of(crossing, &points, &contact);
}
