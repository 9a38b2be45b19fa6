/* Dissipation of friction springs within a step, by the cubics through positions and velocities at its ends, and the
 * error of the stretch at its end. */
#include "bodies/model.h"
#include "couplings/contact/contact.h"

#include <math.h>
#include <string.h>

/* A point that may be in contact within a step: at its end, the change of its position and the stretch there. */
typedef struct {
    fu_contact_point end;
    fu_attachment_state on;
    double change[3], stretch[3];
} step_point;

static fu_friction_travel travel_of(int dim, const step_point *of)
{
    fu_friction_travel travel = {{0.0}, {0.0}, {{0.0}}};
    const size_t size = sizeof(double) * (size_t)dim;
    memcpy(travel.stretch, of->end.mark->stretch, size);
    memcpy(travel.change, of->change, size);
    memcpy(travel.rates[0], of->end.mark->rate, size);
    memcpy(travel.rates[1], of->end.slip, size);
    return travel;
}

static double dissipated(const fu_model *model, const fu_contact *contact, const step_point *of, int by_ends)
{
    const fu_friction_travel travel = travel_of(model->dim, of);
    const fu_friction_path path = fu_contact_normal_path(contact, &of->end);
    return fu_dissipated_by_friction(model->dim, &travel, &path, of->stretch, by_ends);
}

static double dissipated_by_ends(const fu_model *model, const fu_contact *contact, step_point *of)
{
    return dissipated(model, contact, of, 1);
}

static double dissipated_within_step(const fu_model *model, const fu_contact *contact, step_point *of)
{
    return dissipated(model, contact, of, 0);
}

/* Returns the largest error of the stretch at the end, m: the difference to another path, the parabola without the
 * velocities at the beginning, plus the error by the intervals of the sum of its direction. */
static double stretch_error(const fu_model *model, const fu_contact *contact, step_point *of)
{
    const int dim = model->dim;
    fu_friction_mark other = *of->end.mark;
    fu_contact_point end = of->end;
    double square = 0.0;
    if (!(end.depth > 0.0)) return 0.0;
    const double turned = fu_contact_turn_error(model, contact, &of->on, &end);
    for (int d = 0; d < dim; ++d) other.rate[d] = 2.0 * of->change[d] / end.since - end.slip[d];
    other.gap_rate = -2.0 * (end.depth + other.gap) / end.since + end.sinking;
    end.mark = &other;
    fu_contact_stretch(model, contact, &of->on, &end);
    for (int d = 0; d < dim; ++d) square += (end.stretch[d] - of->stretch[d]) * (end.stretch[d] - of->stretch[d]);
    return turned + sqrt(square);
}

typedef double visitor(const fu_model *model, const fu_contact *contact, step_point *of);

/* Computes the point over the step; returns whether it is in contact at one of the ends. */
static int point_over_step(const fu_model *model, const fu_contact *contact, const fu_state *to, int element,
                           int number, step_point *out)
{
    const int dim = model->dim;
    fu_contact_point *end = &out->end;
    double normal[3];
    fu_contact_place(model, contact, &out->on, to, element, number, end);
    const int in_contact = fu_contact_is_active(model, contact, &out->on, end);
    if (!in_contact && !(end->mark->gap < 0.0)) return 0;
    fu_surface_into(dim, &out->on, end->distance.n, normal);
    fu_contact_change(dim, contact, end, normal, out->change);
    memset(out->stretch, 0, sizeof out->stretch);
    for (int d = 0; d < dim && in_contact; ++d) out->stretch[d] = end->stretch[d];
    return 1;
}

/* Calls `visit` with each point in contact at an end of the step; returns the largest value, or their weighted sum. */
static double visit_points(const fu_model *model, const fu_contact *contact, const fu_state *from, const fu_state *to,
                           visitor *visit, int largest)
{
    double found = 0.0;
    step_point of;
    fu_attachment_state before;
    if (contact->law.friction == 0.0 || !(to->t > from->t)) return 0.0;
    fu_surface_at(model, &contact->surface, from, &before);
    fu_surface_at(model, &contact->surface, to, &of.on);
    for (int e = 0; e < fu_contact_elements(contact); ++e) {
        if (!fu_contact_may_be_active(model, contact, &before, from, e, 0.0) &&
            !fu_contact_may_be_active(model, contact, &of.on, to, e, 0.0))
            continue;
        for (int k = 0; k < contact->n_points; ++k) {
            if (!point_over_step(model, contact, to, e, k, &of)) continue;
            const double value = visit(model, contact, &of);
            found = largest ? fmax(found, value) : found + fu_contact_weight(contact, e, k) * value;
        }
    }
    return found;
}

double fu_contact_lost(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                       int by_ends)
{
    const fu_contact *contact = (const fu_contact *)coupling;
    return contact->law.tangential *
           visit_points(model, contact, from, to, by_ends ? dissipated_by_ends : dissipated_within_step, 0);
}

double fu_contact_history_error(const fu_model *model, const fu_coupling *coupling, const fu_state *from,
                                const fu_state *to)
{
    return visit_points(model, (const fu_contact *)coupling, from, to, stretch_error, 1);
}
