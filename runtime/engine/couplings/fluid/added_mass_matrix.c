/* The mass that fluids add to cables and bodies, and its kinetic energy: M of T = w . M w/2
 * (couplings/fluid/added_mass.c). */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/wrench.h"
#include "couplings/fluid/drag.h"

#include <string.h>

/* Takes the wet part at a place of an impulse and its mass. */
static void wet_impulse(const fu_model *model, const fu_drag *drag, const double *r, double p[3], double M[9])
{
    if (drag->wet == FU_ALL_WET) return;
    const double part = fu_wet_at_height(drag, fu_drag_height(model, drag, r)).part;
    for (int i = 0; i < model->dim; ++i) p[i] *= part;
    for (int i = 0; i < model->dim * model->dim; ++i) M[i] *= part;
}

/* Makes the impulse M w of a length of cable at a point of quadrature, with M. */
static void impulse(const fu_model *model, const fu_drag *drag, const double *q, const double *v,
                    fu_quadrature_point point, double w[3], double p[3], double M[9])
{
    fu_drag_place at;
    fu_drag_place_on_axis(model, drag, q, v, 0, point, &at);
    memcpy(w, at.v, sizeof at.v);
    drag->kernel->impulse_of_cable(at.r_x, w, drag->added, p, M);
    wet_impulse(model, drag, at.r, p, M);
}

void fu_added_mass_force(const fu_model *model, const fu_coupling *coupling, const double *q, const double *a,
                         double *f)
{
    const fu_drag *drag = (const fu_drag *)coupling;
    const int dim = model->dim;
    double w[3] = {0.0}, p[3], M[9];
    if (drag->cable < 0) {
        const fu_state state = {.q = (double *)q, .v = (double *)model->zero};
        fu_attachment_state end;
        fu_attachment_at(model, &drag->attachments[0], &state, 0.0, FU_POINT | FU_AXES, &end);
        for (int d = 0; d < dim; ++d)
            for (int i = 0; i < end.n; ++i) w[d] += end.P[d * end.n + i] * a[end.at[i]];
        drag->kernel->impulse_of_point(end.A, drag->added, w, p, M);
        wet_impulse(model, drag, end.p, p, M);
        fu_add_wrench(dim, &end, p, 0, 1.0, f);
        return;
    }
    const fu_cable *cable = &model->cables[drag->cable];
    const int n = cable->coordinates / dim;
    for (int e = 0; e < cable->n_elements; ++e) {
        const int first = cable->first + e * cable->per_node;
        fu_drag_points points;
        fu_drag_points_on(model, drag, e, q + first, &points);
        for (int g = 0; g < points.n; ++g) {
            const fu_quadrature_point point = points.at[g];
            impulse(model, drag, q + first, a + first, point, w, p, M);
            for (int k = 0; k < n; ++k)
                for (int d = 0; d < dim; ++d) f[first + k * dim + d] += point.weight * point.N[k] * p[d];
        }
    }
}

void fu_added_mass_matrix(const fu_model *model, const fu_coupling *coupling, const double *q, double scale,
                          fu_system *system)
{
    const fu_drag *drag = (const fu_drag *)coupling;
    const int dim = model->dim;
    double w[3] = {0.0}, p[3], M[9];
    if (drag->cable < 0) {
        const fu_state state = {.q = (double *)q, .v = (double *)model->zero};
        fu_attachment_state end;
        fu_attachment_at(model, &drag->attachments[0], &state, 0.0, FU_POINT | FU_AXES, &end);
        drag->kernel->impulse_of_point(end.A, drag->added, w, p, M);
        wet_impulse(model, drag, end.p, p, M);
        for (int i = 0; i < end.n; ++i)
            for (int j = 0; j < end.n; ++j) {
                double sum = 0.0;
                for (int c = 0; c < dim; ++c)
                    for (int d = 0; d < dim; ++d) sum += end.P[c * end.n + i] * M[c * dim + d] * end.P[d * end.n + j];
                fu_add(model, system, end.at[i], end.at[j], scale * sum);
            }
        return;
    }
    const fu_cable *cable = &model->cables[drag->cable];
    const int all = cable->coordinates;
    double K[FU_MAX_COORDINATES * FU_MAX_COORDINATES];
    for (int e = 0; e < cable->n_elements; ++e) {
        const int first = cable->first + e * cable->per_node;
        fu_drag_points points;
        memset(K, 0, sizeof(double) * (size_t)(all * all));
        fu_drag_points_on(model, drag, e, q + first, &points);
        for (int g = 0; g < points.n; ++g) {
            const fu_quadrature_point point = points.at[g];
            impulse(model, drag, q + first, model->zero, point, w, p, M);
            fu_add_element_product(dim, all, scale * point.weight, point.N, point.N, M, K);
        }
        fu_add_element_matrix(model, first, all, K, system);
    }
}

double fu_added_mass_kinetic_energy(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                                    const double *v, int past_fluid)
{
    const fu_drag *drag = (const fu_drag *)coupling;
    const int dim = model->dim;
    double total = 0.0, p[3], M[9];
    fu_flow_state flow = {{0.0}, {0.0}, {0.0}};
    if (drag->cable < 0) {
        const fu_state state = {.t = t, .q = (double *)q, .v = (double *)v};
        fu_attachment_state end;
        fu_attachment_at(model, &drag->attachments[0], &state, 0.0, FU_POINT | FU_AXES, &end);
        if (past_fluid) fu_flow_at(model, &drag->flow, t, end.p, &flow);
        for (int d = 0; d < dim; ++d) end.v[d] -= flow.U[d];
        drag->kernel->impulse_of_point(end.A, drag->added, end.v, p, M);
        wet_impulse(model, drag, end.p, p, M);
        return 0.5 * fu_dot(dim, p, end.v);
    }
    const fu_cable *cable = &model->cables[drag->cable];
    for (int e = 0; e < cable->n_elements; ++e) {
        const int first = cable->first + e * cable->per_node;
        fu_drag_points points;
        fu_drag_points_on(model, drag, e, q + first, &points);
        for (int g = 0; g < points.n; ++g) {
            const fu_quadrature_point point = points.at[g];
            fu_drag_place at;
            fu_drag_place_on_axis(model, drag, q + first, v + first, 0, point, &at);
            if (past_fluid) fu_flow_at(model, &drag->flow, t, at.r, &flow);
            for (int d = 0; d < dim; ++d) at.v[d] -= flow.U[d];
            drag->kernel->impulse_of_cable(at.r_x, at.v, drag->added, p, M);
            wet_impulse(model, drag, at.r, p, M);
            total += 0.5 * point.weight * fu_dot(dim, p, at.v);
        }
    }
    return total;
}
