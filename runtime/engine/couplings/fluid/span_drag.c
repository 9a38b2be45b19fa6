/* Drag and buoyancy on the material in a span of a rope: by its velocity at constant material coordinate, and as forces
 * on the material (derive/couplings/span_force.py). */
#include "bodies/model.h"
#include "couplings/fluid/drag.h"

#include <string.h>

enum { ENDS = FU_SPAN_ENDS, LOCAL = FU_SPAN_LOCAL };

/* Computes the place of the point of quadrature g of an element; returns its share of the length. */
static double place_on(const fu_drag *drag, const fu_span_element *it, const fu_drag_points *points, int g,
                       fu_drag_place *at)
{
    const double share = points->x[g] / it->l;
    memset(at, 0, sizeof *at);
    drag->on.kernel->point(it->l, it->e, it->v, it->s_rate, share, at->r, at->r_x, at->v);
    return share;
}

void fu_add_span_drag(const fu_model *model, const fu_drag *drag, const fu_state *state, const fu_drag_sums *sums)
{
    double force[3], of_e[FU_MAX_COORDINATES], of_ends[ENDS];
    for (int k = 0; k < drag->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &drag->on, k, state->q, state->v, 0);
        fu_drag_points points;
        fu_drag_points_on_span(model, drag, &it, &points);
        for (int g = 0; g < points.n; ++g) {
            const double weight = points.at[g].weight;
            fu_drag_place at;
            fu_drag_action a;
            const double share = place_on(drag, &it, &points, g, &at);
            fu_drag_act(model, drag, state->t, &at, 0, &a);
            fu_drag_whole_force(model, &a, force);
            if (sums->power) fu_drag_add_powers(model, &at, &a, weight, sums->power);
            for (int d = 0; d < model->dim && sums->total; ++d) sums->total[d] += weight * force[d];
            if (!sums->f) continue;
            drag->on.kernel->line_force(-weight / it.l, it.l, it.e, share, force, of_e, of_ends);
            fu_add_span_force(&drag->on, &it, of_e, of_ends, 0.0, sums->f);
        }
    }
}

void fu_add_span_drag_matrix(const fu_model *model, const fu_drag *drag, const fu_state *state, fu_weights weights,
                             fu_system *system)
{
    const int dim = model->dim, n = drag->on.kernel->coordinates, all = n + ENDS;
    double force[3], by_r[9], by_t[9], by_v[9], D[LOCAL * LOCAL], K[LOCAL * LOCAL], local[LOCAL][LOCAL];
    for (int k = 0; k < drag->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &drag->on, k, state->q, state->v, 0);
        fu_drag_points points;
        memset(local, 0, sizeof local);
        fu_drag_points_on_span(model, drag, &it, &points);
        for (int g = 0; g < points.n; ++g) {
            fu_drag_place at;
            fu_drag_action a;
            const double share = place_on(drag, &it, &points, g, &at);
            fu_drag_act(model, drag, state->t, &at, 0, &a);
            fu_drag_whole_force(model, &a, force);
            fu_drag_by_place(dim, &a, by_r);
            for (int i = 0; i < dim * dim; ++i) {
                by_r[i] *= model->load_fraction;
                by_t[i] = model->load_fraction * a.by_slope[i];
                by_v[i] = -model->load_fraction * a.by_w[i];
            }
            drag->on.kernel->line_force_tangent(-points.at[g].weight / it.l, it.l, it.e, it.v, it.s_rate, share, force,
                                                by_r, by_t, by_v, D, K);
            fu_add_by_length(all, n, weights.stiffness, K, local);
            fu_add_by_rates(all, weights.stiffness * weights.rate, D, local);
        }
        fu_add_span_matrix(model, &drag->on, &it, local, system);
    }
}
