/* What friction by springs takes within a step, by the cubics through places and velocities at its ends; and how far off the stretch is
 * that the spring has at its end.
 */
#include "engine.h"

#include <math.h>
#include <string.h>

#define PARTS 8 /* of a step: those that friction's work is summed over */

/* A point that may touch within a step: at its end, the change of its place and the stretch there. */
typedef struct {
    fu_touch_point end;
    fu_attachment_state on;
    double change[3], stretch[3], normal[3];
} step_point;

/* Makes the spring's way to a part of the step: the place, the bound of the stretch, m. */
static double place_within(int dim, const fu_contact *contact, const step_point *of, double x, double place[3])
{
    const fu_friction_mark *mark = of->end.mark;
    const double h = of->end.since;
    const fu_step_ends gap = {{-mark->gap, of->end.depth}, {-mark->gap_rate, of->end.sinking}};
    const double depth = fu_value_within(&gap, h, x), rate = fu_rate_within(&gap, h, x);
    for (int d = 0; d < dim; ++d) {
        const fu_step_ends ends = {{0.0, of->change[d]}, {mark->rate[d], of->end.slip[d]}};
        place[d] = fu_value_within(&ends, h, x);
    }
    return depth > 0.0 ? contact->law.friction * fu_press_at(contact, depth, rate, depth).p / contact->law.tangential : 0.0;
}

/* Returns what friction takes over its stiffness, m^2, summed over equal parts of the step. */
static double taken(int dim, const fu_contact *contact, const step_point *of, int parts)
{
    double sum = 0.0, stretch[3] = {0.0}, last[3] = {0.0}, place[3];
    memcpy(stretch, of->end.mark->stretch, sizeof(double) * (size_t)dim);
    for (int i = 1; i <= parts; ++i) {
        double without[3], across = 0.0;
        const double most = place_within(dim, contact, of, (double)i / parts, place);
        for (int d = 0; d < dim; ++d) without[d] = stretch[d] + place[d] - last[d];
        across = fu_dot(dim, of->normal, without) / fu_dot(dim, of->normal, of->normal);
        for (int d = 0; d < dim; ++d) without[d] -= across * of->normal[d];
        double next[3];
        memcpy(next, without, sizeof next);
        fu_limit_stretch(dim, 1.0, most, next);
        for (int d = 0; d < dim; ++d) {
            sum += 0.5 * (stretch[d] + next[d]) * (without[d] - next[d]);
            stretch[d] = next[d];
            last[d] = place[d];
        }
    }
    return sum + 0.5 * (fu_dot(dim, stretch, stretch) - fu_dot(dim, of->stretch, of->stretch));
}

static double taken_by_ends(const fu_model *model, const fu_contact *contact, step_point *of)
{
    return taken(model->dim, contact, of, 1);
}

/* Returns the same by two sums, as the error falls with the square of the parts (Richardson). */
static double taken_on_way(const fu_model *model, const fu_contact *contact, step_point *of)
{
    return (4.0 * taken(model->dim, contact, of, PARTS) - taken(model->dim, contact, of, PARTS / 2)) / 3.0;
}

/* Returns how far off the stretch may be at the end, m: by how much another way leads elsewhere, the parabola without the velocities at
 * the beginning. */
static double astray(const fu_model *model, const fu_contact *contact, step_point *of)
{
    const int dim = model->dim;
    fu_friction_mark other = *of->end.mark;
    fu_touch_point end = of->end;
    double square = 0.0;
    if (!(end.depth > 0.0)) return 0.0;
    for (int d = 0; d < dim; ++d) other.rate[d] = 2.0 * of->change[d] / end.since - end.slip[d];
    other.gap_rate = -2.0 * (end.depth + other.gap) / end.since + end.sinking;
    end.mark = &other;
    fu_contact_stretch(model, contact, &of->on, &end);
    for (int d = 0; d < dim; ++d) square += (end.stretch[d] - of->stretch[d]) * (end.stretch[d] - of->stretch[d]);
    return sqrt(square);
}

typedef double visitor(const fu_model *model, const fu_contact *contact, step_point *of);

/* Makes a point over the step; returns whether it touches at one of the ends. */
static int point_over_step(const fu_model *model, const fu_contact *contact, const fu_state *to, int element, int number, step_point *out)
{
    const int dim = model->dim;
    fu_touch_point *end = &out->end;
    fu_contact_place(model, contact, &out->on, to, element, number, end);
    const int touches = fu_contact_touches(model, contact, &out->on, end);
    if (!touches && !(end->mark->gap < 0.0)) return 0;
    fu_surface_into(dim, &out->on, end->distance.n, out->normal);
    fu_contact_change(dim, contact, end, out->normal, out->change);
    memset(out->stretch, 0, sizeof out->stretch);
    for (int d = 0; d < dim && touches; ++d) out->stretch[d] = end->stretch[d];
    return 1;
}

/* Calls `visit` with each point that touches at an end of the step; returns the largest value, or their sum by weight. */
static double visit_points(const fu_model *model, const fu_contact *contact, const fu_state *from, const fu_state *to, visitor *visit, int largest)
{
    double found = 0.0;
    step_point of;
    fu_attachment_state before;
    if (contact->law.friction == 0.0 || !(to->t > from->t)) return 0.0;
    fu_surface_at(model, &contact->surface, from, &before);
    fu_surface_at(model, &contact->surface, to, &of.on);
    for (int e = 0; e < fu_contact_elements(model, contact); ++e) {
        if (!fu_contact_may_touch(model, contact, &before, from, e, 0.0) && !fu_contact_may_touch(model, contact, &of.on, to, e, 0.0)) continue;
        for (int k = 0; k < contact->n_points; ++k) {
            if (!point_over_step(model, contact, to, e, k, &of)) continue;
            const double value = visit(model, contact, &of);
            found = largest ? fmax(found, value) : found + fu_contact_weight(contact, e, k) * value;
        }
    }
    return found;
}

double fu_contact_lost(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to, int by_ends)
{
    const fu_contact *contact = (const fu_contact *)coupling;
    return contact->law.tangential * visit_points(model, contact, from, to, by_ends ? taken_by_ends : taken_on_way, 0);
}

double fu_contact_carried_error(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to)
{
    return visit_points(model, (const fu_contact *)coupling, from, to, astray, 1);
}
