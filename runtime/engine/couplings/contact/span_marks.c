/* History of sticking friction on a span. The stretch of friction's spring belongs to the material, and the material
 * flows past the points of contact. The stretch of the material at a point, as it was at the last step, follows by a
 * cubic from those of the points then, with slopes by parabolas; its place and motion follow from the configuration of
 * the span then. Beyond the last points the stretch falls linearly to zero at the end of the span: material that comes
 * from a wheel has none. */
#include "bodies/model.h"
#include "couplings/contact/contact.h"

#include <math.h>

enum { ENDS = FU_SPAN_ENDS };

fu_span_begin *fu_span_begin_of(const fu_rope_contact *rope, const fu_state *state)
{
    const fu_coupling *base = &rope->contact.base;
    return (fu_span_begin *)(state->numbers + base->numbers + base->n_numbers) - 1;
}

double *fu_span_stretch_of(const fu_rope_contact *rope, const fu_state *state)
{
    return state->numbers + rope->contact.base.numbers;
}

double *fu_span_nodes_of(const fu_rope_contact *rope, const fu_state *state)
{
    return fu_span_stretch_of(rope, state) + FU_SPAN_STRETCH * rope->on.n_elements * rope->contact.n_points;
}

/* Returns the share of the j-th point in the length of the span. */
static double share_of(const fu_rope_contact *rope, int j)
{
    const double *share = rope->on.share + j / rope->contact.n_points;
    return share[0] + (share[1] - share[0]) * rope->contact.arc[j % rope->contact.n_points];
}

/* Computes the slope of the parabola through three values at its i-th place. */
static void slope_at(int dim, const double x[3], const double *values, int i, double slope[3])
{
    const double before = x[1] - x[0], after = x[2] - x[1], whole = x[2] - x[0];
    for (int d = 0; d < dim; ++d) {
        const double first = (values[3 + d] - values[d]) / before, last = (values[6 + d] - values[3 + d]) / after;
        slope[d] = first + (last - first) * ((x[i] - x[0]) + (x[i] - x[1])) / whole;
    }
}

/* Computes the stretch at a share of the span's length, beside the e-th element, and its change by the share. */
static void stretch_at(int dim, const fu_rope_contact *rope, const double *stretch, int e, double share,
                       double value[3], double change[3])
{
    const int last = rope->on.n_elements * rope->contact.n_points - 1;
    int j = e * rope->contact.n_points - 1;
    while (j < last && share_of(rope, j + 1) <= share) ++j;
    if (j < 0 || j == last) { /* beyond the points */
        const int end = j < 0 ? 0 : last;
        const double edge = j < 0 ? 0.0 : 1.0, width = share_of(rope, end) - edge;
        const double part = fmax((share - edge) / width, 0.0);
        for (int d = 0; d < dim; ++d) {
            value[d] = part * stretch[3 * end + d];
            change[d] = part > 0.0 ? stretch[3 * end + d] / width : 0.0;
        }
        return;
    }
    double slopes[2][3];
    for (int i = 0; i < 2; ++i) {
        const int from = j + i == 0 ? 0 : j + i == last ? last - 2 : j + i - 1;
        const double x[3] = {share_of(rope, from), share_of(rope, from + 1), share_of(rope, from + 2)};
        slope_at(dim, x, stretch + 3 * from, j + i - from, slopes[i]);
    }
    const double begin = share_of(rope, j), width = share_of(rope, j + 1) - begin, x = (share - begin) / width;
    for (int d = 0; d < dim; ++d) {
        const fu_step_ends ends = {{stretch[3 * j + d], stretch[3 * (j + 1) + d]}, {slopes[0][d], slopes[1][d]}};
        value[d] = fu_value_within(&ends, width, x);
        change[d] = fu_rate_within(&ends, width, x);
    }
}

/* Returns the part of the step after which the material at S entered the span at one of its ends, by the cubic through
 * the end's material coordinates and their rates. */
static double entry(const fu_rope_contact *rope, const fu_state *state, const fu_span_begin *begin, int end, double S)
{
    const double sign = end ? -1.0 : 1.0, h = state->t - begin->time;
    const int s = rope->on.s[end];
    const fu_step_ends within = {{sign * (S - begin->s[end]), sign * (S - state->q[s])},
                                 {-sign * begin->s_rate[end], -sign * state->v[s]}};
    return h > 0.0 && within.value[0] < 0.0 && within.value[1] > 0.0 ? fu_part_to_rise(&within, h) : 0.0;
}

void fu_span_mark(const fu_model *model, const fu_rope_contact *rope, const fu_state *state, int e, double S,
                  fu_contact_point *of)
{
    const int dim = model->dim, per_node = 2 * dim;
    const fu_span_begin *begin = fu_span_begin_of(rope, state);
    const double *q = fu_span_nodes_of(rope, state), *v = q + (rope->on.n_elements + 1) * per_node;
    const double *share = rope->on.share, length = begin->s[1] - begin->s[0], at = (S - begin->s[0]) / length;
    fu_attachment_state on;
    fu_friction_mark *mark = &of->of_material;
    fu_contact_point point = {.mark = mark};
    double r_S[3], s_rate[ENDS];
    while (e > 0 && at < share[e]) --e;
    while (e < rope->on.n_elements - 1 && at > share[e + 1]) ++e;
    const double part = (at - share[e]) / (share[e + 1] - share[e]), within = fmin(fmax(part, 0.0), 1.0);
    const double l = (share[e + 1] - share[e]) * length;
    for (int i = 0; i < ENDS; ++i) s_rate[i] = begin->s_rate[0] + share[e + i] * (begin->s_rate[1] - begin->s_rate[0]);
    rope->on.kernel->point(l, q + e * per_node, v + e * per_node, s_rate, within, point.r, r_S, point.v);
    for (int d = 0; d < dim; ++d) { /* material that was on a wheel, along the tangent */
        point.r[d] += (part - within) * l * r_S[d];
        on.p[d] = begin->p[d];
        on.v[d] = begin->v[d];
    }
    for (int i = 0; i < 9; ++i) on.A[i] = begin->A[i];
    for (int i = 0; i < 3; ++i) on.omega[i] = begin->omega[i];
    fu_contact_slip(model, &rope->contact, &on, &point);
    fu_contact_note(dim, &on, &point, mark);
    stretch_at(dim, rope, fu_span_stretch_of(rope, state), e, at, mark->stretch, of->stretch_by_S);
    for (int d = 0; d < dim; ++d) of->stretch_by_S[d] /= length;
    fu_surface_into(dim, &on, r_S, of->place_by_S);
    if (part != within) of->entered = entry(rope, state, begin, part < 0.0 ? 0 : 1, S);
}
