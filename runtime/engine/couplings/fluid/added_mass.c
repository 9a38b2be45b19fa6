/* Inertia of the fluid around cables and bodies (derive/couplings/added_mass.py), along spans of ropes in
 * couplings/fluid/span_added_mass.c: the kinetic energy T = c w . M w/2 of
 * the added mass M and the wet part c at the velocity w = v - U relative to the fluid, and the force on the displaced
 * mass in an accelerated fluid.
 *
 * The kernels give the force on a particle, that on the slope of a cable or the moment on a body, and the external
 * power of the fluid, with T counted as kinetic energy. M a belongs to the inertia: Newton's matrix and that of eq 38
 * contain M. The matrix neglects second derivatives of U: Newton's method converges without them.
 */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/attachments.h"
#include "couplings/fluid/drag.h"

#include <string.h>

/* The fluid at a point: its motion, and the wet part with its derivatives. */
typedef struct {
    fu_flow_state flow;
    fu_wetness wet;
} surroundings;

static surroundings surroundings_of(const fu_model *model, const fu_drag *drag, double t, const double *r)
{
    surroundings out = {.wet = fu_wet_part(model, drag, r)};
    fu_flow_at(model, &drag->flow, t, r, &out.flow);
    return out;
}

void fu_fluid_on_element(const fu_model *model, const fu_drag *drag, int first, fu_quadrature_point point,
                         const double *left, const double *on_slope, const fu_drag_sums *sums)
{
    const int dim = model->dim, n = model->cables[drag->cable].coordinates / dim;
    for (int d = 0; d < dim; ++d) {
        if (sums->total) sums->total[d] -= left[d];
        for (int k = 0; sums->f && k < n; ++k)
            sums->f[first + k * dim + d] += point.N[k] * left[d] - point.N_x[k] * on_slope[d];
    }
}

/* Computes the force on the particles of a length of cable and that on its slope, times `part`; adds the external
 * power. */
static void on_length(const fu_model *model, const fu_drag *drag, double t, const fu_drag_place *at, double part,
                      double left[3], double on_slope[3], fu_drag_powers *power)
{
    double external;
    const surroundings of = surroundings_of(model, drag, t, at->r);
    drag->kernel->inertia_of_cable(at->r_x, at->r_x_rate, drag->added, drag->displaced, at->v, at->a, of.flow.U,
                                   of.flow.rate, of.flow.gradient, &of.wet.part, drag->flow.up, left, on_slope,
                                   &external);
    for (int d = 0; d < model->dim; ++d) {
        left[d] *= part;
        on_slope[d] *= part;
    }
    if (power) power->external += part * external;
}

void fu_added_mass_at(const fu_model *model, const fu_drag *drag, const fu_drag_site *site, fu_drag_loop *loop,
                      double *K)
{
    double left[3], on_slope[3];
    (void)K;
    on_length(model, drag, loop->t, &site->at, site->point.weight * model->load_fraction, left, on_slope,
              loop->sums->power);
    fu_fluid_on_element(model, drag, site->first, site->point, left, on_slope, loop->sums);
}

static void densities_at(const fu_model *model, const fu_drag *drag, const fu_drag_site *site, fu_drag_loop *loop,
                         double *K)
{
    double left[3], p[3], M[9], *out = loop->rows;
    (void)K;
    memset(out, 0, sizeof(double[FU_ADDED_MASS_DENSITIES]));
    on_length(model, drag, loop->t, &site->at, model->load_fraction, left, out + 3, 0);
    drag->kernel->impulse_of_cable(site->at.r_x, site->at.v, drag->added, p, M);
    const double part = fu_wet_part(model, drag, site->at.r).part;
    for (int d = 0; d < model->dim; ++d) out[d] = -left[d];
    for (int i = 0; i < model->dim * model->dim; ++i) out[6 + i] = part * M[i];
    loop->rows += FU_ADDED_MASS_DENSITIES;
}

void fu_added_mass_densities(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *out)
{
    fu_drag_loop loop = {.t = state->t, .rows = out};
    fu_drag_visit(model, (const fu_drag *)coupling, state->q, state->v, 0, densities_at, &loop, 0);
}

void fu_added_mass_tangent_at(const fu_model *model, const fu_drag *drag, const fu_drag_site *site, fu_drag_loop *loop,
                              double *K)
{
    const fu_drag_place *at = &site->at;
    const surroundings of = surroundings_of(model, drag, loop->t, at->r);
    const int dim = model->dim, all = model->cables[drag->cable].coordinates;
    const double part = loop->weights.stiffness * model->load_fraction * site->point.weight, rate = loop->weights.rate;
    const double *N = site->point.N, *N_x = site->point.N_x;
    double f_t[9], f_t_rate[9], f_r[9], f_v[9], g_t[9], g_r[9], g_v[9];
    drag->kernel->inertia_of_cable_tangent(at->r_x, at->r_x_rate, drag->added, drag->displaced, at->v, at->a, of.flow.U,
                                           of.flow.rate, of.flow.gradient, &of.wet.part, drag->flow.up, f_t, f_t_rate,
                                           f_r, f_v, g_t, g_r, g_v);
    for (int i = 0; i < dim * dim; ++i) {
        f_t[i] += rate * f_t_rate[i];
        f_r[i] += rate * f_v[i];
        g_r[i] += rate * g_v[i];
    }
    fu_add_field_matrix(dim, all, part, N, &(fu_field_change){f_t, N_x, f_r, N}, K);
    fu_add_field_matrix(dim, all, -part, N_x, &(fu_field_change){g_t, N_x, g_r, N}, K);
}

/* Computes the state of a body's point with its axes, the fluid there, and the acceleration of the point at those of
 * the dofs, `a` (null: zero). */
static surroundings at_body(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *a,
                            fu_attachment_state *end, double acceleration[3])
{
    fu_attachment_at(model, &drag->attachments[0], state, 0.0, FU_POINT | FU_AXES, end);
    memcpy(acceleration, end->bias, sizeof(double[3]));
    for (int d = 0; d < model->dim && a; ++d)
        for (int i = 0; i < end->n; ++i) acceleration[d] += end->P[d * end->n + i] * a[end->at[i]];
    return surroundings_of(model, drag, state->t, end->p);
}

/* Computes force and moment on a body at a point, and the external power. */
static void on_point(const fu_drag *drag, const fu_attachment_state *end, const double *acceleration,
                     const surroundings *of, double left[3], double moment[3], double *external)
{
    drag->kernel->inertia_of_point(end->A, drag->added, end->omega, drag->displaced, end->v, acceleration, of->flow.U,
                                   of->flow.rate, of->flow.gradient, &of->wet.part, drag->flow.up, left, moment,
                                   external);
}

static void on_body(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *a,
                    const fu_drag_sums *sums)
{
    const double part = model->load_fraction;
    double left[3], moment[3], acceleration[3], external;
    fu_attachment_state end;
    const surroundings of = at_body(model, drag, state, a, &end, acceleration);
    on_point(drag, &end, acceleration, &of, left, moment, &external);
    if (sums->power) sums->power->external += part * external;
    for (int d = 0; d < model->dim && sums->total; ++d) sums->total[d] -= part * left[d];
    if (sums->f) fu_add_wrench(model->dim, &end, left, moment, part, sums->f);
}

/* Adds the derivatives of the same, except those of the acceleration of the point by the place. */
static void tangent_of_body(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *a,
                            const double *psi, fu_weights weights, fu_system *system)
{
    const int dim = model->dim;
    double left[3], moment[3], acceleration[3], external, f_by[3 * 12], moment_by[3 * 12];
    double f[3 * FU_ATTACHMENT_COORDINATES], m[3 * FU_ATTACHMENT_COORDINATES];
    fu_attachment_state end;
    fu_point_motion motion;
    const surroundings of = at_body(model, drag, state, a, &end, acceleration);
    on_point(drag, &end, acceleration, &of, left, moment, &external);
    drag->kernel->inertia_of_point_tangent(end.A, drag->added, end.omega, drag->displaced, end.v, acceleration,
                                           of.flow.U, of.flow.rate, of.flow.gradient, &of.wet.part, drag->flow.up, f_by,
                                           moment_by);
    fu_point_motion_at(model, &drag->attachments[0], state, FU_POINT | FU_AXES, left, moment, psi, weights.rate,
                       &motion);
    fu_changes(&motion, dim, f_by, f);
    fu_changes(&motion, fu_turns(dim), moment_by, m);
    fu_add_wrench_tangent(model, &motion.at, &motion.at, f, m, fu_stiffness_of(&motion),
                          weights.stiffness * model->load_fraction, system);
}

void fu_added_mass_forces(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *a,
                          const fu_drag_sums *sums)
{
    if (drag->on.kernel) fu_span_added_mass_forces(model, drag, state, a, sums);
    else on_body(model, drag, state, a, sums);
}

void fu_added_mass_tangent(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *a,
                           const double *psi, fu_weights weights, fu_system *system)
{
    if (drag->on.kernel) fu_span_added_mass_tangent(model, drag, state, a, weights, system);
    else tangent_of_body(model, drag, state, a, psi, weights, system);
}
