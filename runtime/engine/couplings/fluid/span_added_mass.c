/* Inertia of the fluid along a span of a rope: Lagrange's equations of the kinetic energy that the fluid has by the
 * velocity of the material, at points of quadrature that move past it (derive/couplings/span_kinetic.py). */
#include "bodies/model.h"
#include "couplings/fluid/drag.h"

#include <string.h>

enum { ENDS = FU_SPAN_ENDS, LOCAL = FU_SPAN_LOCAL };

/* A point of quadrature: its part of the length, and share of it; motion of the material at a constant share; the fluid
 * there. */
typedef struct {
    double part, share, slope_rate[3], place_rate[3], growth;
    fu_drag_place at; /* a: rate of the velocity */
    fu_flow_state flow;
    fu_wetness wet;
} moving_point;

/* The kinetic energy of the fluid a length there, with its derivatives by place, slope and velocity, and the rate of
 * the last. */
typedef struct {
    double T_r[3], T_t[3], T_v[3], rate[3], T, power;
} energy_of_fluid;

static moving_point point_of(const fu_model *model, const fu_drag *drag, double t, const fu_span_element *it,
                             const fu_drag_points *points, int g)
{
    moving_point of = {.part = points->at[g].weight / it->l, .share = points->x[g] / it->l};
    drag->on.kernel->motion(it->l, it->e, it->v, it->s_rate, of.share, it->a, it->s_acc, of.at.r, of.at.r_x, of.at.v,
                            of.slope_rate, of.place_rate, of.at.a, &of.growth);
    fu_fluid_at(model, drag, t, of.at.r, &of.flow, &of.wet);
    return of;
}

static energy_of_fluid energy_of(const fu_drag *drag, const moving_point *of)
{
    energy_of_fluid out;
    drag->kernel->inertia_of_span(of->growth, of->at.r_x, of->slope_rate, drag->added, drag->displaced, of->at.v,
                                  of->place_rate, of->at.a, of->flow.U, of->flow.rate, of->flow.gradient, &of->wet.part,
                                  drag->flow.up, out.T_r, out.T_t, out.T_v, out.rate, &out.T, &out.power);
    return out;
}

void fu_span_added_mass_forces(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *a,
                               const fu_drag_sums *sums)
{
    double of_e[FU_MAX_COORDINATES], of_ends[ENDS];
    for (int k = 0; k < drag->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &drag->on, k, state->q, state->v, a);
        fu_drag_points points;
        fu_drag_points_on_span(model, drag, &it, &points);
        for (int g = 0; g < points.n; ++g) {
            const moving_point of = point_of(model, drag, state->t, &it, &points, g);
            const energy_of_fluid fluid = energy_of(drag, &of);
            const double part = model->load_fraction * of.part, weight = part * it.l;
            if (sums->power) sums->power->external += weight * fluid.power;
            for (int d = 0; d < model->dim && sums->total; ++d)
                sums->total[d] -= weight * (fluid.rate[d] - fluid.T_r[d]);
            if (!sums->f) continue;
            drag->on.kernel->kinetic_force(it.l, it.e, it.v, it.s_rate, of.share, part, fluid.T_r, fluid.T_t, fluid.T_v,
                                           fluid.rate, fluid.T, of_e, of_ends);
            fu_add_span_force(&drag->on, &it, of_e, of_ends, 0.0, sums->f);
        }
    }
}

void fu_span_added_mass_tangent(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *a,
                                fu_weights weights, fu_system *system)
{
    const int n = drag->on.kernel->coordinates, all = n + ENDS;
    double second[81], rate_by[54], D[LOCAL * LOCAL], K[LOCAL * LOCAL], local[LOCAL][LOCAL];
    for (int k = 0; k < drag->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &drag->on, k, state->q, state->v, a);
        fu_drag_points points;
        memset(local, 0, sizeof local);
        fu_drag_points_on_span(model, drag, &it, &points);
        for (int g = 0; g < points.n; ++g) {
            const moving_point of = point_of(model, drag, state->t, &it, &points, g);
            const energy_of_fluid fluid = energy_of(drag, &of);
            drag->kernel->inertia_of_span_tangent(of.growth, of.at.r_x, of.slope_rate, drag->added, drag->displaced,
                                                  of.at.v, of.place_rate, of.at.a, of.flow.U, of.flow.rate,
                                                  of.flow.gradient, &of.wet.part, drag->flow.up, second, rate_by);
            drag->on.kernel->kinetic_force_tangent(it.l, it.e, it.v, it.s_rate, of.share, it.a, it.s_acc,
                                                   model->load_fraction * of.part, fluid.T_r, fluid.T_t, fluid.T_v,
                                                   fluid.rate, second, rate_by, D, K);
            fu_add_by_length(all, n, weights.stiffness, K, local);
            fu_add_by_rates(all, weights.stiffness * weights.rate, D, local);
        }
        fu_add_span_matrix(model, &drag->on, &it, local, system);
    }
}

/* --- mass and kinetic energy ------------------------------------------------------------------------------------ */

/* Computes the wet part's impulse M w and M at a point of the velocity at->v; returns its share of the length. */
static double impulse_at(const fu_model *model, const fu_drag *drag, const fu_span_element *it,
                         const fu_drag_points *points, int g, const double *U, fu_drag_place *at, double p[3],
                         double M[9])
{
    const double share = points->x[g] / it->l;
    memset(at, 0, sizeof *at);
    drag->on.kernel->point(it->l, it->e, it->v, it->s_rate, share, at->r, at->r_x, at->v);
    for (int d = 0; U && d < model->dim; ++d) at->v[d] -= U[d];
    drag->kernel->impulse_of_cable(at->r_x, at->v, drag->added, p, M);
    fu_wetness wet;
    fu_fluid_at(model, drag, 0.0, at->r, 0, &wet);
    for (int d = 0; d < model->dim; ++d) p[d] *= wet.part;
    for (int i = 0; i < model->dim * model->dim; ++i) M[i] *= wet.part;
    return share;
}

void fu_span_added_mass_force(const fu_model *model, const fu_drag *drag, const double *q, const double *a, double *f)
{
    double p[3], M[9], of_e[FU_MAX_COORDINATES], of_ends[ENDS];
    for (int k = 0; k < drag->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &drag->on, k, q, a, 0); /* rates: the accelerations */
        fu_drag_points points;
        fu_drag_place at;
        fu_drag_points_on_span(model, drag, &it, &points);
        for (int g = 0; g < points.n; ++g) {
            const double share = impulse_at(model, drag, &it, &points, g, 0, &at, p, M);
            drag->on.kernel->line_force(points.at[g].weight / it.l, it.l, it.e, share, p, of_e, of_ends);
            fu_add_span_force(&drag->on, &it, of_e, of_ends, 0.0, f);
        }
    }
}

void fu_span_added_mass_matrix(const fu_model *model, const fu_drag *drag, const double *q, double scale,
                               fu_system *system)
{
    const int dim = model->dim, n = drag->on.kernel->coordinates, all = n + ENDS;
    double p[3], M[9], r_q[3 * LOCAL], v_q[3 * LOCAL], v_v[3 * LOCAL], Mv[3 * LOCAL], local[LOCAL][LOCAL];
    for (int k = 0; k < drag->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &drag->on, k, q, 0, 0);
        fu_drag_points points;
        fu_drag_place at;
        memset(local, 0, sizeof local);
        fu_drag_points_on_span(model, drag, &it, &points);
        for (int g = 0; g < points.n; ++g) {
            const double share = impulse_at(model, drag, &it, &points, g, 0, &at, p, M);
            drag->on.kernel->point_tangent(it.l, it.e, it.v, it.s_rate, share, r_q, v_q, v_v);
            for (int d = 0; d < dim; ++d)
                for (int j = 0; j < all; ++j) {
                    Mv[d * all + j] = 0.0;
                    for (int i = 0; i < dim; ++i) Mv[d * all + j] += M[d * dim + i] * v_v[i * all + j];
                }
            for (int i = 0; i < all; ++i)
                for (int j = 0; j < all; ++j)
                    for (int d = 0; d < dim; ++d)
                        local[i][j] += scale * points.at[g].weight * v_v[d * all + i] * Mv[d * all + j];
        }
        fu_add_span_matrix(model, &drag->on, &it, local, system);
    }
}

double fu_span_added_mass_kinetic_energy(const fu_model *model, const fu_drag *drag, double t, const double *q,
                                         const double *v, int past_fluid)
{
    double p[3], M[9], total = 0.0;
    for (int k = 0; k < drag->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &drag->on, k, q, v, 0);
        fu_drag_points points;
        fu_drag_points_on_span(model, drag, &it, &points);
        for (int g = 0; g < points.n; ++g) {
            fu_drag_place at;
            fu_flow_state flow = {{0.0}, {0.0}, {0.0}};
            if (past_fluid) {
                const double share = points.x[g] / it.l;
                drag->on.kernel->point(it.l, it.e, it.v, it.s_rate, share, at.r, at.r_x, at.v);
                fu_fluid_at(model, drag, t, at.r, &flow, 0);
            }
            impulse_at(model, drag, &it, &points, g, flow.U, &at, p, M);
            total += 0.5 * points.at[g].weight * fu_dot(model->dim, p, at.v);
        }
    }
    return total;
}
