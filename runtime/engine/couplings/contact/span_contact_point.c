/* Points of contact of a span of a rope: those in contact, and the parts of the force on them. */
#include "bodies/model.h"
#include "couplings/contact/contact.h"

#include <math.h>
#include <string.h>

enum { ENDS = FU_SPAN_ENDS, CORNERS = 4 };

/* An element lies within the hull of its four Bezier points. */
int fu_rope_contact_may_be_active(int dim, const fu_rope_contact *rope, const fu_attachment_state *on,
                                  const fu_span_element *it)
{
    const double *first = it->e, *last = it->e + 2 * dim;
    double corners[CORNERS][3], middle[3] = {0.0}, square = 0.0;
    for (int d = 0; d < dim; ++d) {
        corners[0][d] = first[d];
        corners[1][d] = first[d] + it->l / 3.0 * first[dim + d];
        corners[2][d] = last[d] - it->l / 3.0 * last[dim + d];
        corners[3][d] = last[d];
        for (int k = 0; k < CORNERS; ++k) middle[d] += corners[k][d] / CORNERS;
    }
    for (int k = 0; k < CORNERS; ++k) {
        double sum = 0.0;
        for (int d = 0; d < dim; ++d) sum += (corners[k][d] - middle[d]) * (corners[k][d] - middle[d]);
        square = fmax(square, sum);
    }
    return fu_surface_clearance(dim, &rope->contact.surface, on, middle, sqrt(square)) <= rope->contact.radius;
}

double fu_rope_contact_friction(int dim, const fu_rope_contact *rope, const fu_attachment_state *on,
                                const fu_contact_point *point, double f[3], double by_place[9], double by_rate[9])
{
    double w[3];
    const fu_normal_force at = fu_normal_force_at(&rope->contact, point->depth, point->sinking, point->depth);
    const double law[3] = {at.p, at.by_depth, at.by_rate};
    fu_surface_past(dim, on, point->r, point->v, w);
    rope->contact.surface.kernel->slipping(point->distance.n, point->distance.H, w, law, rope->friction,
                                           rope->slip_velocity, f, by_place, by_rate);
    return -fu_dot(dim, f, w);
}

void fu_rope_contact_place(const fu_model *model, const fu_rope_contact *rope, const fu_state *state,
                           const fu_span_element *it, int k, fu_contact_point *point)
{
    double r_S[3];
    memset(point, 0, sizeof *point);
    rope->on.kernel->point(it->l, it->e, it->v, it->s_rate, rope->contact.arc[k], point->r, r_S, point->v);
    if (!(rope->contact.law.friction > 0.0)) return;
    const fu_span_begin *begin = fu_span_begin_of(rope, state);
    if (begin->time == FU_NO_TIME) return;
    point->mark = &point->of_material;
    point->since = state->t - begin->time;
    fu_span_mark(model, rope, state, it->number, it->s[0] + rope->contact.arc[k] * it->l, point);
}

/* Computes the contact of a point of quadrature; returns whether there is one. */
static int contact_at(const fu_model *model, const fu_rope_contact *rope, const fu_attachment_state *on,
                      const fu_state *state, const fu_span_element *it, int k, fu_contact_point *point)
{
    double by_place[9], by_rate[9], w[3];
    fu_rope_contact_place(model, rope, state, it, k, point);
    if (!fu_contact_is_active(model, &rope->contact, on, point)) return 0;
    if (point->mark) {
        fu_surface_past(model->dim, on, point->r, point->v, w);
        point->power -= fu_dot(model->dim, point->friction, w);
    }
    if (rope->friction > 0.0) {
        point->power += fu_rope_contact_friction(model->dim, rope, on, point, point->friction, by_place, by_rate);
        for (int d = 0; d < model->dim; ++d) point->f[d] += point->friction[d];
    }
    return 1;
}

void fu_rope_contact_visit(const fu_model *model, const fu_rope_contact *rope, const fu_state *state,
                           fu_rope_contact_visitor *visit, void *context)
{
    fu_attachment_state on;
    fu_surface_at(model, &rope->contact.surface, state, &on);
    for (int e = 0; e < rope->on.n_elements; ++e) {
        const fu_span_element it = fu_span_element_at(model, &rope->on, e, state->q, state->v, 0);
        int in_contact = 0;
        if (!fu_rope_contact_may_be_active(model->dim, rope, &on, &it)) continue;
        for (int k = 0; k < rope->contact.n_points; ++k) {
            fu_contact_point point;
            if (!contact_at(model, rope, &on, state, &it, k, &point)) continue;
            ++in_contact;
            visit(model, rope, &on, &it, k, &point, context);
        }
        if (in_contact) visit(model, rope, &on, &it, -1, 0, context);
    }
}

void fu_rope_contact_elastic(const fu_rope_contact *rope, const fu_contact_point *point, double F[3],
                             double by_place[9])
{
    const fu_normal_force at = fu_normal_force_at(&rope->contact, point->depth, 0.0, point->depth);
    const double none[3] = {0.0}, law[3] = {at.p, at.by_depth, 0.0};
    double by_rate[9];
    rope->contact.surface.kernel->frictionless(point->distance.n, point->distance.H, none, law, F, by_place, by_rate);
}

void fu_rope_contact_add_reaction(int dim, const fu_attachment_state *on, const fu_contact_point *point, double weight,
                                  double *f)
{
    double arm[3], moment[3];
    for (int d = 0; d < dim; ++d) arm[d] = point->r[d] - on->p[d];
    fu_moment_of(dim, arm, point->f, moment);
    fu_add_wrench(dim, on, point->f, moment, weight, f);
}

void fu_rope_contact_add_force(const fu_model *model, const fu_rope_contact *rope, const fu_attachment_state *on,
                               const fu_span_element *it, int k, const fu_contact_point *point, double *f)
{
    double of_e[FU_MAX_COORDINATES], of_ends[ENDS];
    if (on->n) fu_rope_contact_add_reaction(model->dim, on, point, rope->contact.weights[k] * it->l, f);
    rope->on.kernel->line_force(-rope->contact.weights[k], it->l, it->e, rope->contact.arc[k], point->f, of_e, of_ends);
    fu_add_span_force(&rope->on, it, of_e, of_ends, 0.0, f);
}
