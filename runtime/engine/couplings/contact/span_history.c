/* History of sticking friction on a span over a step: couplings/contact/span_marks.c. */
#include "bodies/model.h"
#include "couplings/contact/contact.h"

#include <string.h>

enum { ENDS = FU_SPAN_ENDS };

static const fu_rope_contact *of(const fu_coupling *coupling)
{
    return (const fu_rope_contact *)coupling;
}

void fu_rope_contact_reset(const fu_coupling *coupling, fu_state *state)
{
    if (coupling->n_numbers) fu_span_begin_of(of(coupling), state)->time = FU_NO_TIME;
}

/* Computes the stretch of all points at the end of a step, beside those at its beginning: returns them. */
static const double *stretch_at_end(const fu_model *model, const fu_rope_contact *rope, const fu_attachment_state *on,
                                    const fu_state *state)
{
    const int n = rope->contact.n_points, dim = model->dim;
    double *found = fu_span_stretch_of(rope, state) + 3 * rope->on.n_elements * n;
    for (int e = 0; e < rope->on.n_elements; ++e) {
        const fu_span_element it = fu_span_element_at(model, &rope->on, e, state->q, state->v, 0);
        for (int k = 0; k < n; ++k) {
            fu_contact_point point;
            double *stretch = found + 3 * (e * n + k);
            memset(stretch, 0, sizeof(double[3]));
            fu_rope_contact_place(model, rope, state, &it, k, &point);
            if (point.mark && fu_contact_is_active(model, &rope->contact, on, &point))
                memcpy(stretch, point.stretch, sizeof(double) * (size_t)dim);
        }
    }
    return found;
}

void fu_rope_contact_update_history(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    const fu_rope_contact *rope = of(coupling);
    const int dim = model->dim, points = rope->on.n_elements * rope->contact.n_points;
    const int dofs = (rope->on.n_elements + 1) * 2 * dim;
    fu_attachment_state on;
    if (!coupling->n_numbers) return;
    fu_surface_at(model, &rope->contact.surface, state, &on);
    memcpy(fu_span_stretch_of(rope, state), stretch_at_end(model, rope, &on, state),
           sizeof(double[3]) * (size_t)points);
    double *nodes = fu_span_nodes_of(rope, state);
    memcpy(nodes, state->q + rope->on.first, sizeof(double) * (size_t)dofs);
    memcpy(nodes + dofs, state->v + rope->on.first, sizeof(double) * (size_t)dofs);
    fu_span_begin *begin = fu_span_begin_of(rope, state);
    memset(begin, 0, sizeof *begin);
    memcpy(begin->p, on.p, sizeof(double) * (size_t)dim);
    memcpy(begin->v, on.v, sizeof(double) * (size_t)dim);
    memcpy(begin->A, on.A, sizeof(double) * (size_t)(dim * dim));
    memcpy(begin->omega, on.omega, sizeof(double) * (size_t)fu_turns(dim));
    for (int i = 0; i < ENDS; ++i) {
        begin->s[i] = state->q[rope->on.s[i]];
        begin->s_rate[i] = state->v[rope->on.s[i]];
    }
    begin->time = state->t;
}

static void add_spring(const fu_model *model, const fu_rope_contact *rope, const fu_attachment_state *on,
                       const fu_span_element *it, int k, fu_contact_point *point, void *context)
{
    (void)model, (void)on;
    if (point) *(double *)context += rope->contact.weights[k] * it->l * point->spring_energy;
}

/* Returns the decrease of the energy of friction's springs in a step, J. What friction takes from the rope is
 * dissipated power, springs included: this is the part of it that was stored, and the energy of material that leaves
 * the contact or the span, and of the interpolation. */
double fu_rope_contact_released(const fu_model *model, const fu_coupling *coupling, const fu_state *from,
                                const fu_state *to, int by_ends)
{
    double before = 0.0, after = 0.0;
    (void)by_ends;
    if (!coupling->n_numbers) return 0.0;
    fu_rope_contact_visit(model, of(coupling), from, add_spring, &before);
    fu_rope_contact_visit(model, of(coupling), to, add_spring, &after);
    return before - after;
}
