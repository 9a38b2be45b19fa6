/* The mass that fluids add to cables and bodies, and its kinetic energy: M of T = w . M w/2
 * (couplings/fluid/added_mass.c). */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/attachments.h"
#include "couplings/fluid/drag.h"

#include <string.h>

/* Computes the impulse M w and M at a point of the velocity at->v relative to the fluid; A: axes of the body. */
static void impulse(const fu_model *model, const fu_drag *drag, const fu_drag_place *at, const double *A, double p[3],
                    double M[9])
{
    if (drag->cable >= 0) drag->kernel->impulse_of_cable(at->r_x, at->v, drag->added, p, M);
    else drag->kernel->impulse_of_point(A, drag->added, at->v, p, M);
    const double part = fu_wet_part(model, drag, at->r).part;
    for (int i = 0; i < model->dim; ++i) p[i] *= part;
    for (int i = 0; i < model->dim * model->dim; ++i) M[i] *= part;
}

/* Computes position and velocity of a body's point. */
static void place_on_body(const fu_model *model, const fu_drag *drag, const double *q, const double *v,
                          fu_attachment_state *end, fu_drag_place *at)
{
    const fu_state state = {.q = (double *)q, .v = (double *)v};
    fu_attachment_at(model, &drag->attachments[0], &state, 0.0, FU_POINT | FU_AXES, end);
    memset(at, 0, sizeof *at);
    memcpy(at->r, end->p, sizeof at->r);
    memcpy(at->v, end->v, sizeof at->v);
}

/* Adds M a to f; the rates at the site are the accelerations. */
static void add_force(const fu_model *model, const fu_drag *drag, const fu_drag_site *site, fu_drag_loop *loop,
                      double *K)
{
    const int dim = model->dim, n = model->cables[drag->cable].coordinates / dim;
    double *f = loop->sums->f, p[3], M[9];
    (void)K;
    impulse(model, drag, &site->at, 0, p, M);
    for (int k = 0; k < n; ++k)
        for (int d = 0; d < dim; ++d) f[site->first + k * dim + d] += site->point.weight * site->point.N[k] * p[d];
}

void fu_added_mass_force(const fu_model *model, const fu_coupling *coupling, const double *q, const double *a,
                         double *f)
{
    const fu_drag *drag = (const fu_drag *)coupling;
    if (drag->cable >= 0) {
        const fu_drag_sums sums = {.f = f};
        fu_drag_loop loop = {.sums = &sums};
        fu_drag_visit(model, drag, q, a, 0, add_force, &loop, 0);
        return;
    }
    if (drag->on.kernel) {
        fu_span_added_mass_force(model, drag, q, a, f);
        return;
    }
    double p[3], M[9];
    fu_attachment_state end;
    fu_drag_place at;
    place_on_body(model, drag, q, model->zero, &end, &at);
    for (int d = 0; d < model->dim; ++d)
        for (int i = 0; i < end.n; ++i) at.v[d] += end.P[d * end.n + i] * a[end.at[i]];
    impulse(model, drag, &at, end.A, p, M);
    fu_add_wrench(model->dim, &end, p, 0, 1.0, f);
}

static void add_mass(const fu_model *model, const fu_drag *drag, const fu_drag_site *site, fu_drag_loop *loop,
                     double *K)
{
    const double *N = site->point.N, scale = loop->weights.stiffness * site->point.weight;
    double p[3], M[9];
    impulse(model, drag, &site->at, 0, p, M);
    fu_add_element_product(model->dim, model->cables[drag->cable].coordinates, scale, N, N, M, K);
}

void fu_added_mass_matrix(const fu_model *model, const fu_coupling *coupling, const double *q, double scale,
                          fu_system *system)
{
    const fu_drag *drag = (const fu_drag *)coupling;
    const int dim = model->dim;
    if (drag->cable >= 0) {
        fu_drag_loop loop = {.has_matrix = 1, .weights = {.stiffness = scale}};
        fu_drag_visit(model, drag, q, model->zero, 0, add_mass, &loop, system);
        return;
    }
    if (drag->on.kernel) {
        fu_span_added_mass_matrix(model, drag, q, scale, system);
        return;
    }
    double p[3], M[9], changes[3 * FU_ATTACHMENT_COORDINATES] = {0.0};
    fu_attachment_state end;
    fu_drag_place at;
    place_on_body(model, drag, q, model->zero, &end, &at);
    impulse(model, drag, &at, end.A, p, M);
    for (int c = 0; c < dim; ++c)
        for (int d = 0; d < dim; ++d)
            for (int i = 0; i < end.n; ++i) changes[c * end.n + i] += M[c * dim + d] * end.P[d * end.n + i];
    fu_add_wrench_tangent(model, &end, &end, changes, 0, 0, scale, system);
}

/* Returns the kinetic energy at a point, J/m or J. */
static double energy_at(const fu_model *model, const fu_drag *drag, const fu_drag_loop *loop, const double *A,
                        fu_drag_place at)
{
    double p[3], M[9];
    fu_flow_state flow = {{0.0}, {0.0}, {0.0}};
    if (loop->past_fluid) fu_flow_at(model, &drag->flow, loop->t, at.r, &flow);
    for (int d = 0; d < model->dim; ++d) at.v[d] -= flow.U[d];
    impulse(model, drag, &at, A, p, M);
    return 0.5 * fu_dot(model->dim, p, at.v);
}

static void add_energy(const fu_model *model, const fu_drag *drag, const fu_drag_site *site, fu_drag_loop *loop,
                       double *K)
{
    (void)K;
    loop->energy += site->point.weight * energy_at(model, drag, loop, 0, site->at);
}

double fu_added_mass_kinetic_energy(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                                    const double *v, int past_fluid)
{
    const fu_drag *drag = (const fu_drag *)coupling;
    fu_drag_loop loop = {.t = t, .past_fluid = past_fluid};
    if (drag->cable >= 0) {
        fu_drag_visit(model, drag, q, v, 0, add_energy, &loop, 0);
        return loop.energy;
    }
    if (drag->on.kernel) return fu_span_added_mass_kinetic_energy(model, drag, t, q, v, past_fluid);
    fu_attachment_state end;
    fu_drag_place at;
    place_on_body(model, drag, q, v, &end, &at);
    return energy_at(model, drag, &loop, end.A, at);
}
