/* Points of a contact: their positions, which may be in contact, and the forces on them. */
#include "bodies/model.h"
#include "couplings/common/attachments.h"
#include "couplings/contact/contact.h"

#include <math.h>
#include <string.h>

/* Returns the number of elements that the points are divided into; those of a body are one. */
int fu_contact_elements(const fu_contact *contact)
{
    const fu_rope_contact *rope = fu_contact_on_span(contact);
    if (rope) return rope->on.n_elements;
    return contact->cable >= 0 ? contact->n_elements : 1;
}

double fu_contact_weight(const fu_contact *contact, int element, int point)
{
    return contact->cable >= 0 ? contact->weights[(long)element * contact->stride + point] : 1.0;
}

const double *fu_contact_shapes(const fu_contact *contact, int n, int element, int point)
{
    return contact->N + ((long)element * contact->stride + point) * n;
}

fu_friction_mark *fu_contact_mark(const fu_contact *contact, const fu_state *state, int element, int point)
{
    const long number = (long)element * contact->n_points + point;
    return (fu_friction_mark *)(state->numbers + contact->base.numbers + number * FU_FRICTION_MARK);
}

/* Returns the first dof of an element. */
int fu_contact_first(const fu_model *model, const fu_contact *contact, int element)
{
    const fu_cable *cable = &model->cables[contact->cable];
    return fu_element_entry(cable, contact->first + element);
}

/* Returns whether a sphere about an element's first node, larger than necessary but cheap, is off the surface by more
 * than `beyond`. */
static int is_far(int dim, int n, const fu_contact *contact, const fu_attachment_state *on, int element,
                  const double *q, double beyond)
{
    const double *spread = contact->spread + (contact->stride ? (long)element * n : 0);
    const double *end = q + n / 2 * dim;
    double reach = 0.0;
    for (int d = 0; d < dim; ++d) reach += spread[n / 2] * fabs(end[d] - q[d]);
    for (int i = 1; i < n; ++i) {
        if (i == n / 2) continue;
        for (int d = 0; d < dim; ++d) reach += spread[i] * fabs(q[i * dim + d]);
    }
    return fu_surface_clearance(dim, &contact->surface, on, q, reach) > beyond;
}

/* Returns whether any point of an element may be nearer to the surface than the radius plus `below`. */
int fu_contact_may_be_active(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                             const fu_state *state, int element, double below)
{
    const int dim = model->dim;
    const fu_rope_contact *rope = fu_contact_on_span(contact);
    if (rope) {
        const fu_span_element it = fu_span_element_at(model, &rope->on, element, state->q, 0, 0);
        return fu_rope_contact_may_be_active(dim, rope, on, &it);
    }
    if (contact->cable < 0) {
        const double *origin = state->q + model->bodies[contact->attachments[0].body].configuration;
        return fu_surface_clearance(dim, &contact->surface, on, origin, contact->spread[0]) <= contact->radius + below;
    }
    const fu_cable *cable = &model->cables[contact->cable];
    const int n = cable->coordinates / dim;
    const double *q = state->q + fu_contact_first(model, contact, element);
    if (is_far(dim, n, contact, on, element, q, contact->radius + below)) return 0;
    double points[8 * 3], middle[3] = {0.0, 0.0, 0.0}, square = 0.0;
    for (int k = 0; k < contact->n_hull; ++k)
        for (int d = 0; d < dim; ++d) {
            double *x = points + k * 3 + d;
            *x = 0.0;
            for (int i = 0; i < n; ++i)
                *x += contact->hull[((long)(contact->stride ? element : 0) * contact->n_hull + k) * n + i] *
                      q[i * dim + d];
            middle[d] += *x / contact->n_hull;
        }
    for (int k = 0; k < contact->n_hull; ++k) {
        double sum = 0.0;
        for (int d = 0; d < dim; ++d) sum += (points[k * 3 + d] - middle[d]) * (points[k * 3 + d] - middle[d]);
        square = fmax(square, sum);
    }
    return fu_surface_clearance(dim, &contact->surface, on, middle, sqrt(square)) <= contact->radius + below;
}

/* Computes position and velocity of a point, its mark, and the rotation since then. */
void fu_contact_place(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                      const fu_state *state, int element, int point, fu_contact_point *out)
{
    const int dim = model->dim;
    const fu_rope_contact *rope = fu_contact_on_span(contact);
    if (rope) {
        const fu_span_element it = fu_span_element_at(model, &rope->on, element, state->q, state->v, 0);
        fu_rope_contact_place(model, rope, state, &it, point, out);
        return;
    }
    out->entered = 0.0;
    out->mark = contact->law.friction > 0.0 ? fu_contact_mark(contact, state, element, point) : 0;
    memset(out->r, 0, sizeof out->r);
    memset(out->v, 0, sizeof out->v);
    memset(out->arm, 0, sizeof out->arm);
    if (out->mark) out->since = state->t - fu_contact_begin_of(contact, state)->time;
    if (fu_contact_rolls(contact)) fu_contact_turning(model, contact, on, state, out);
    if (contact->cable < 0) {
        fu_attachment_state end;
        fu_attachment_at(model, &contact->attachments[point], state, 0.0, FU_POINT, &end);
        memcpy(out->r, end.p, sizeof out->r);
        memcpy(out->v, end.v, sizeof out->v);
        return;
    }
    const fu_cable *cable = &model->cables[contact->cable];
    const int all = cable->coordinates, first = fu_contact_first(model, contact, element);
    const double *N = fu_contact_shapes(contact, all / dim, element, point);
    fu_interpolate(dim, all, N, state->q + first, out->r);
    fu_interpolate(dim, all, N, state->v + first, out->v);
}

/* Adds a force on a point of a cable, times its weight, to the left side of the equations of motion. */
void fu_contact_add_on_cable(const fu_model *model, const fu_contact *contact, int element, int number,
                             const double *force, double *f)
{
    const int dim = model->dim, n = model->cables[contact->cable].coordinates / dim;
    const int first = fu_contact_first(model, contact, element);
    const double *N = fu_contact_shapes(contact, n, element, number),
                 weight = fu_contact_weight(contact, element, number);
    for (int k = 0; k < n; ++k)
        for (int d = 0; d < dim; ++d) f[first + k * dim + d] -= weight * N[k] * force[d];
}

/* Adds the force at a point of contact, and its reaction on the body of the surface, to the left side of the
 * equations. */
void fu_contact_add_force(const fu_model *model, const fu_contact *contact, const fu_state *state,
                          const fu_attachment_state *on, int element, int number, const fu_contact_point *point,
                          double *f)
{
    const int dim = model->dim, rolls = fu_contact_rolls(contact);
    const double weight = fu_contact_weight(contact, element, number), *force = point->f;
    double arm[3], moment[3];
    const fu_rope_contact *rope = fu_contact_on_span(contact);
    if (rope) {
        const fu_span_element it = fu_span_element_at(model, &rope->on, element, state->q, state->v, 0);
        fu_rope_contact_add_force(model, rope, on, &it, number, point, f);
        return;
    }
    if (on->n) {
        for (int d = 0; d < dim; ++d) arm[d] = point->r[d] + point->arm[d] - on->p[d];
        fu_moment_of(dim, arm, force, moment);
        fu_add_wrench(dim, on, force, moment, weight, f);
    }
    if (contact->cable >= 0) {
        fu_contact_add_on_cable(model, contact, element, number, force, f);
        return;
    }
    fu_attachment_state end;
    fu_attachment_at(model, &contact->attachments[number], state, 0.0, rolls ? FU_PLACE | FU_AXES : FU_PLACE, &end);
    fu_moment_of(dim, point->arm, force, moment);
    fu_add_wrench(dim, &end, force, rolls ? moment : 0, -weight, f);
}

void fu_contact_visit(const fu_model *model, const fu_contact *contact, const fu_state *state,
                      fu_contact_visitor *visit, void *context)
{
    fu_attachment_state on;
    fu_surface_at(model, &contact->surface, state, &on);
    for (int e = 0; e < fu_contact_elements(contact); ++e) {
        fu_contact_heights heights;
        if (!fu_contact_begin_element(model, contact, &on, state, e, &heights)) continue;
        for (int k = 0; k < contact->n_points; ++k) {
            fu_contact_point point;
            if (fu_contact_is_active_at(model, contact, &on, state, e, k, &heights, &point))
                visit(model, contact, &on, e, k, &point, context);
        }
    }
}
