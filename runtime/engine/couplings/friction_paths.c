/* What friction by springs does within a step. Its anchors follow at the ends of steps, as if a point had gone straight on between them: a
 * second way, by a place within the step, tells how far that is off, and what friction takes on the way.
 */
#include "engine.h"

#include <math.h>
#include <string.h>

/* A point at both ends of a step of h, s, with the rates of its gap, m/s; its anchor at the first end. */
typedef struct {
    double h, rates[2];
    fu_surface_end ends[2];
    double anchor[3];
} way;

/* A place on the way: the stretch of friction's spring, and the anchor that it has there, along the shape's axes, m. */
typedef struct {
    double stretch[3], anchor[3];
} grip;

/* Makes the grip of a point at y, this far off the surface, that comes from an anchor. */
static void grip_at(int dim, const fu_contact *contact, const double *y, const double *n, double gap, double rate, const double *anchor,
                    grip *out)
{
    const double most = contact->law.friction * fu_contact_press(contact, -gap, -rate);
    for (int d = 0; d < dim; ++d) out->stretch[d] = y[d] - anchor[d];
    const double along = fu_dot(dim, n, out->stretch) / fu_dot(dim, n, n);
    for (int d = 0; d < dim; ++d) out->stretch[d] -= along * n[d];
    fu_limit_stretch(dim, contact->law.tangential, most, out->stretch);
    for (int d = 0; d < dim; ++d) out->anchor[d] = y[d] - out->stretch[d];
}

static void grip_at_end(int dim, const fu_contact *contact, const way *of, int end, const double *anchor, grip *out)
{
    grip_at(dim, contact, of->ends[end].y, of->ends[end].n, of->ends[end].gap, of->rates[end], anchor, out);
}

/* Makes the grip at a part x of the step, by the cubics through places and rates at its ends (Hermite's). */
static void grip_within(int dim, const fu_contact *contact, const way *of, double x, grip *out)
{
    const fu_surface_end *a = &of->ends[0], *b = &of->ends[1];
    const double rest = 1.0 - x, to[2] = {rest * rest * (1.0 + 2.0 * x), x * x * (3.0 - 2.0 * x)};
    const double by[2] = {of->h * rest * rest * x, -of->h * x * x * rest};
    const double gap = to[0] * a->gap + to[1] * b->gap + by[0] * of->rates[0] + by[1] * of->rates[1];
    const double rate = 6.0 * x * rest * (b->gap - a->gap) / of->h + rest * (1.0 - 3.0 * x) * of->rates[0] + x * (3.0 * x - 2.0) * of->rates[1];
    double y[3], n[3];
    for (int d = 0; d < dim; ++d) {
        y[d] = to[0] * a->y[d] + to[1] * b->y[d] + by[0] * a->rate[d] + by[1] * b->rate[d];
        n[d] = rest * a->n[d] + x * b->n[d];
    }
    grip_at(dim, contact, y, n, gap, rate, of->anchor, out);
}

/* Returns how much too long the stretch at the end is, m, as the point has turned round on its way, and slid farther than its end tells. */
static double astray(int dim, const fu_contact *contact, const way *of)
{
    grip once, within, twice;
    grip_at_end(dim, contact, of, 1, of->anchor, &once);
    const double before = fu_dot(dim, once.stretch, of->ends[0].rate), after = fu_dot(dim, once.stretch, of->ends[1].rate);
    grip_within(dim, contact, of, before > 0.0 && after < 0.0 ? before / (before - after) : 0.5, &within);
    grip_at_end(dim, contact, of, 1, within.anchor, &twice);
    return fabs(sqrt(fu_dot(dim, once.stretch, once.stretch)) - sqrt(fu_dot(dim, twice.stretch, twice.stretch)));
}

/* Returns what friction takes between two places, over its stiffness: the mean stretch times the way of the anchor, m^2. */
static double taken(int dim, const grip *from, const grip *to)
{
    double sum = 0.0;
    for (int d = 0; d < dim; ++d) sum += 0.5 * (from->stretch[d] + to->stretch[d]) * (to->anchor[d] - from->anchor[d]);
    return sum;
}

static double taken_by_ends(int dim, const fu_contact *contact, const way *of)
{
    grip from, to;
    grip_at_end(dim, contact, of, 0, of->anchor, &from);
    grip_at_end(dim, contact, of, 1, of->anchor, &to);
    return taken(dim, &from, &to);
}

/* Returns what friction takes on the way over its stiffness, m^2, by one and two trapezoids (Richardson). */
static double taken_on_way(int dim, const fu_contact *contact, const way *of)
{
    grip from, within, to;
    grip_at_end(dim, contact, of, 0, of->anchor, &from);
    grip_within(dim, contact, of, 0.5, &within);
    grip_at_end(dim, contact, of, 1, of->anchor, &to);
    return (4.0 * (taken(dim, &from, &within) + taken(dim, &within, &to)) - taken(dim, &from, &to)) / 3.0;
}

typedef double visitor(int dim, const fu_contact *contact, const way *of);

/* Calls `visit` with the way of each point that touches at an end of the step; returns the largest value, or their sum by weight. */
static double visit_ways(const fu_model *model, const fu_contact *contact, const fu_state *from, const fu_state *to, visitor *visit, int largest)
{
    const int dim = model->dim;
    double found = 0.0;
    way of = {.h = to->t - from->t};
    fu_attachment_state on[2];
    if (contact->law.friction == 0.0 || !(of.h > 0.0)) return 0.0;
    fu_surface_at(model, &contact->surface, from, &on[0]);
    fu_surface_at(model, &contact->surface, to, &on[1]);
    for (int e = 0; e < fu_contact_elements(model, contact); ++e) {
        if (!fu_contact_may_touch(model, contact, &on[0], from, e, 0.0) && !fu_contact_may_touch(model, contact, &on[1], to, e, 0.0)) continue;
        for (int k = 0; k < contact->n_points; ++k) {
            const fu_friction_mark *mark = fu_contact_mark(contact, from, e, k);
            for (int d = 0; d < dim; ++d) of.anchor[d] = mark->place[d] - mark->stretch[d];
            fu_contact_gap(model, contact, &on[0], from, e, k, &of.rates[0], &of.ends[0]);
            fu_contact_gap(model, contact, &on[1], to, e, k, &of.rates[1], &of.ends[1]);
            if (!(of.ends[0].gap < 0.0) && !(of.ends[1].gap < 0.0)) continue;
            fu_contact_roll_on(model, contact, &on[0], from, from, mark, &of.ends[0]);
            fu_contact_roll_on(model, contact, &on[1], from, to, mark, &of.ends[1]);
            const double value = visit(dim, contact, &of);
            found = largest ? fmax(found, value) : found + fu_contact_weight(contact, e, k) * value;
        }
    }
    return found;
}

double fu_contact_lost(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to, int by_ends)
{
    const fu_contact *contact = (const fu_contact *)coupling;
    return contact->law.tangential * visit_ways(model, contact, from, to, by_ends ? taken_by_ends : taken_on_way, 0);
}

double fu_contact_carried_error(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to)
{
    return visit_ways(model, (const fu_contact *)coupling, from, to, astray, 1);
}
