/* Inertia of the fluid around cables and bodies (derive/couplings/added_mass.py): the kinetic energy T = w . M w/2 of
 * the added mass M at the velocity w = v - U relative to the fluid, and the force on the displaced mass in an
 * accelerated fluid.
 *
 * Lagrange's equations of T, with p = M w: along a cable the force p' + G' p on each particle and -g on the slope, g =
 * dT/dr_x; on a body the force p' + G' p on the point and the moment w x p. G is the gradient of U, and w' = a - dU/dt
 * - G v. M a belongs to the inertia: Newton's matrix and that of eq 38 contain M. The force on the displaced mass is
 * that of the undisturbed fluid, the mass times DU/Dt = dU/dt + G U.
 *
 * Of a partly wet section or body, T and the displaced mass are multiplied by the wet part c
 * (derive/couplings/wetness.py). The rate of the impulse then contains the rate of c, and the derivative of T by
 * position acts as an additional force.
 *
 * With T counted as kinetic energy, the fluid's external power is -p' . U - (G' p) . v. The matrix neglects second
 * derivatives of U: Newton's method converges without them.
 */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/attachments.h"
#include "couplings/fluid/drag.h"

#include <string.h>

/* Contribution of the change of the wet part: the derivative of T by position; derivatives of the force by velocity and
 * position, and of the force on the slope, or of the moment, by position. */
typedef struct {
    double pull[3], by_v[9], force_place[9], other_place[9];
} of_wet_part;

/* Results of the kernels: impulse, its rate, and their derivatives, of a cable or of a body's point. p_rate_t,
 * p_rate_turn and p_rate_w are derivatives of the rate less the pull. */
typedef struct {
    double p[3], p_rate[3], g[3], M[9], p_t[9], p_rate_t[9], p_rate_t_rate[9], p_rate_w[9], g_t[9], g_w[9];
    of_wet_part wet; /* zero if entirely wet */
} of_length;
typedef struct {
    double p[3], p_rate[3], moment[3], M[9], p_turn[9], p_rate_turn[9], moment_turn[9], p_rate_omega[9], p_rate_w[9],
        moment_w[9];
    of_wet_part wet;
} of_point;

fu_fluid_past fu_past_fluid(const fu_model *model, const fu_drag *drag, double t, const double *r, const double *v,
                            const double *a)
{
    const int dim = model->dim;
    fu_fluid_past out;
    fu_flow_at(model, &drag->flow, t, r, &out.flow);
    for (int d = 0; d < dim; ++d) {
        const double *gradient = out.flow.gradient + d * dim;
        out.w[d] = v[d] - out.flow.U[d];
        out.w_rate[d] = a[d] - out.flow.rate[d] - fu_dot(dim, gradient, v);
        out.material[d] = out.flow.rate[d] + fu_dot(dim, gradient, out.flow.U);
    }
    const fu_wetness wet =
        drag->wet == FU_ALL_WET ? (fu_wetness){1.0, 0.0, 0.0} : fu_wet_at_height(drag, fu_drag_height(model, drag, r));
    out.wet = wet.part;
    out.curvature = wet.curvature;
    for (int d = 0; d < dim; ++d) out.by_place[d] = wet.slope * drag->flow.up[d];
    return out;
}

/* Computes G' x. */
static void back(int dim, const fu_fluid_past *at, const double *x, double out[3])
{
    for (int j = 0; j < dim; ++j) {
        out[j] = 0.0;
        for (int i = 0; i < dim; ++i) out[j] += at->flow.gradient[i * dim + j] * x[i];
    }
}

void fu_fluid_on_particles(const fu_model *model, const fu_drag *drag, const fu_fluid_past *at, const double *p,
                           const double *p_rate, const double *v, double part, double left[3], fu_drag_powers *power)
{
    const int dim = model->dim;
    const double displaced = at->wet * drag->displaced;
    double strained[3];
    back(dim, at, p, strained);
    for (int d = 0; d < dim; ++d) left[d] = part * (p_rate[d] + strained[d] - displaced * at->material[d]);
    if (power)
        power->external += part * (displaced * fu_dot(dim, at->material, v) - fu_dot(dim, p_rate, at->flow.U) -
                                   fu_dot(dim, strained, v));
}

static void add_to(int n, const double *x, double *sum)
{
    for (int i = 0; i < n; ++i) sum[i] += x[i];
}

/* Multiplies n numbers by the wet part. */
static void take_part(int n, const fu_fluid_past *past, double *x)
{
    for (int i = 0; i < n; ++i) x[i] *= past->wet;
}

/* Computes the derivatives, by position through the wet part, of the force and of n other quantities, given as those of
 * full wetting. */
static void by_wet_part(int dim, const fu_drag *drag, const fu_fluid_past *past, const double *p, const double *p_rate,
                        int n, const double *other, of_wet_part *out)
{
    double strained[3];
    back(dim, past, p, strained);
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
            out->force_place[i * dim + j] =
                (p_rate[i] + strained[i] - drag->displaced * past->material[i]) * past->by_place[j];
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < dim; ++j) out->other_place[i * dim + j] = other[i] * past->by_place[j];
}

/* Adds to the derivative of the force by position the contribution of the second derivative of the wet part along the
 * vertical; f_n: derivative of the force by the gradient of the wet part. */
static void by_curvature(int dim, const fu_drag *drag, const fu_fluid_past *past, const double *f_n, of_wet_part *out)
{
    const double *up = drag->flow.up;
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
            out->force_place[i * dim + j] += past->curvature * fu_dot(dim, f_n + i * dim, up) * up[j];
}

/* Multiplies the terms of a length by the wet part and adds those of its change. */
static void wet_length(const fu_model *model, const fu_drag *drag, const fu_drag_place *at, const fu_fluid_past *past,
                       of_length *out)
{
    const int dim = model->dim;
    double p_rate[3], f_t[9], f_w[9], f_n[9];
    by_wet_part(dim, drag, past, out->p, out->p_rate, dim, out->g, &out->wet);
    take_part((int)(offsetof(of_length, wet) / sizeof(double)), past, (double *)out);
    drag->kernel->entry_of_cable(at->r_x, drag->added, past->w, at->v, past->by_place, p_rate, out->wet.pull, f_t, f_w,
                                 out->wet.by_v, f_n);
    by_curvature(dim, drag, past, f_n, &out->wet);
    add_to(dim, p_rate, out->p_rate);
    add_to(dim * dim, f_t, out->p_rate_t);
    add_to(dim * dim, f_w, out->p_rate_w);
}

/* The same for a body's point. */
static void wet_point(const fu_model *model, const fu_drag *drag, const fu_attachment_state *end,
                      const fu_fluid_past *past, of_point *out)
{
    const int dim = model->dim, turns = fu_turns(dim);
    double p_rate[3], f_turn[9], f_w[9], f_n[9];
    by_wet_part(dim, drag, past, out->p, out->p_rate, turns, out->moment, &out->wet);
    take_part((int)(offsetof(of_point, wet) / sizeof(double)), past, (double *)out);
    drag->kernel->entry_of_point(end->A, drag->added, past->w, end->v, past->by_place, p_rate, out->wet.pull, f_turn,
                                 f_w, out->wet.by_v, f_n);
    by_curvature(dim, drag, past, f_n, &out->wet);
    add_to(dim, p_rate, out->p_rate);
    add_to(dim * turns, f_turn, out->p_rate_turn);
    add_to(dim * dim, f_w, out->p_rate_w);
}

static void terms_of_length(const fu_model *model, const fu_drag *drag, const fu_drag_place *at,
                            const fu_fluid_past *past, of_length *out)
{
    drag->kernel->inertia_of_cable(at->r_x, at->r_x_rate, past->w, past->w_rate, drag->added, out->p, out->p_rate,
                                   out->g, out->M, out->p_t, out->p_rate_t, out->p_rate_t_rate, out->p_rate_w, out->g_t,
                                   out->g_w);
    if (drag->wet == FU_ALL_WET) memset(&out->wet, 0, sizeof out->wet);
    else wet_length(model, drag, at, past, out);
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

static fu_fluid_past terms_at(const fu_model *model, const fu_drag *drag, double t, const fu_drag_place *at,
                              of_length *terms)
{
    const fu_fluid_past past = fu_past_fluid(model, drag, t, at->r, at->v, at->a);
    terms_of_length(model, drag, at, &past, terms);
    return past;
}

static void add_at(const fu_model *model, const fu_drag *drag, const fu_drag_site *site, fu_drag_loop *loop, double *K)
{
    const double part = site->point.weight * model->load_fraction;
    double left[3];
    of_length terms;
    (void)K;
    const fu_fluid_past past = terms_at(model, drag, loop->t, &site->at, &terms);
    fu_fluid_on_particles(model, drag, &past, terms.p, terms.p_rate, site->at.v, part, left, loop->sums->power);
    for (int d = 0; d < model->dim; ++d) {
        left[d] -= part * terms.wet.pull[d];
        terms.g[d] *= part;
    }
    fu_fluid_on_element(model, drag, site->first, site->point, left, terms.g, loop->sums);
}

static void densities_at(const fu_model *model, const fu_drag *drag, const fu_drag_site *site, fu_drag_loop *loop,
                         double *K)
{
    double left[3], *out = loop->rows;
    of_length terms;
    (void)K;
    const fu_fluid_past past = terms_at(model, drag, loop->t, &site->at, &terms);
    fu_fluid_on_particles(model, drag, &past, terms.p, terms.p_rate, site->at.v, model->load_fraction, left, 0);
    memset(out, 0, sizeof(double[FU_ADDED_MASS_DENSITIES]));
    for (int d = 0; d < model->dim; ++d) {
        out[d] = model->load_fraction * terms.wet.pull[d] - left[d];
        out[3 + d] = model->load_fraction * terms.g[d];
    }
    memcpy(out + 6, terms.M, sizeof(double) * (size_t)(model->dim * model->dim));
    loop->rows += FU_ADDED_MASS_DENSITIES;
}

void fu_added_mass_densities(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *out)
{
    fu_drag_loop loop = {.t = state->t, .rows = out};
    fu_drag_visit(model, (const fu_drag *)coupling, state->q, state->v, 0, densities_at, &loop, 0);
}

/* Adds the product of two matrices (dim x dim), times a factor. */
static void add_product(int dim, double factor, const double *A, const double *B, double *sum)
{
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
            for (int k = 0; k < dim; ++k) sum[i * dim + j] += factor * A[i * dim + k] * B[k * dim + j];
}

/* Computes the derivatives of the force on particles by position and velocity (dim x dim each): dw/dr = -G, dw/dv = 1,
 * dw'/dv = -G. */
static void particle_derivatives(const fu_drag *drag, int dim, const fu_fluid_past *past, const double *M,
                                 const double *p_rate_w, const of_wet_part *wet, double by_place[9],
                                 double by_velocity[9])
{
    const double *G = past->flow.gradient;
    double by_w[9], G_transposed[9];
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) G_transposed[i * dim + j] = G[j * dim + i];
    memcpy(by_w, p_rate_w, sizeof by_w);
    add_product(dim, 1.0, G_transposed, M, by_w);
    memcpy(by_place, wet->force_place, sizeof wet->force_place);
    add_product(dim, -1.0, by_w, G, by_place);
    add_product(dim, -past->wet * drag->displaced, G, G, by_place);
    for (int i = 0; i < dim * dim; ++i) by_velocity[i] = by_w[i] + wet->by_v[i];
    add_product(dim, -1.0, M, G, by_velocity);
}

/* Adds G' p of the derivatives of an impulse by `columns` quantities. */
static void add_strained(int dim, int columns, const fu_fluid_past *past, const double *p_by, double *sum)
{
    for (int i = 0; i < dim; ++i)
        for (int k = 0; k < dim; ++k)
            for (int j = 0; j < columns; ++j)
                sum[i * columns + j] += past->flow.gradient[k * dim + i] * p_by[k * columns + j];
}

/* Computes the derivatives of a force on particles of a cable by the slope and by position, and that of g by position
 * (dim x dim each); rate: derivative of velocities by positions. */
static void derivatives(const fu_drag *drag, int dim, const of_length *of, const fu_fluid_past *past, double rate,
                        double by_slope[9], double by_place[9], double g_place[9])
{
    double by_velocity[9];
    particle_derivatives(drag, dim, past, of->M, of->p_rate_w, &of->wet, by_place, by_velocity);
    for (int i = 0; i < dim * dim; ++i) {
        by_place[i] += rate * by_velocity[i];
        by_slope[i] = of->p_rate_t[i] + rate * of->p_rate_t_rate[i];
        g_place[i] = of->wet.other_place[i] + rate * of->g_w[i];
    }
    add_strained(dim, dim, past, of->p_t, by_slope);
    add_product(dim, -1.0, of->g_w, past->flow.gradient, g_place);
}

static void tangent_at(const fu_model *model, const fu_drag *drag, const fu_drag_site *site, fu_drag_loop *loop,
                       double *K)
{
    const int dim = model->dim, all = model->cables[drag->cable].coordinates;
    const double part = loop->weights.stiffness * model->load_fraction * site->point.weight;
    const double *N = site->point.N, *N_x = site->point.N_x;
    double by_slope[9], by_place[9], g_place[9];
    of_length terms;
    const fu_fluid_past past = terms_at(model, drag, loop->t, &site->at, &terms);
    derivatives(drag, dim, &terms, &past, loop->weights.rate, by_slope, by_place, g_place);
    fu_add_element_product(dim, all, part, N, N_x, by_slope, K);
    fu_add_element_product(dim, all, part, N, N, by_place, K);
    fu_add_element_product(dim, all, -part, N_x, N_x, terms.g_t, K);
    fu_add_element_product(dim, all, -part, N_x, N, g_place, K);
}

/* Computes the state of a body's point with its axes, its motion relative to the fluid, and the kernel's terms there.
 */
static fu_fluid_past at_body(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *a,
                             fu_attachment_state *end, of_point *out)
{
    const int dim = model->dim;
    double acceleration[3];
    fu_attachment_at(model, &drag->attachments[0], state, 0.0, FU_POINT | FU_AXES, end);
    memcpy(acceleration, end->bias, sizeof acceleration);
    for (int d = 0; d < dim && a; ++d)
        for (int i = 0; i < end->n; ++i) acceleration[d] += end->P[d * end->n + i] * a[end->at[i]];
    const fu_fluid_past past = fu_past_fluid(model, drag, state->t, end->p, end->v, acceleration);
    drag->kernel->inertia_of_point(end->A, drag->added, end->omega, past.w, past.w_rate, out->p, out->p_rate,
                                   out->moment, out->M, out->p_turn, out->p_rate_turn, out->moment_turn,
                                   out->p_rate_omega, out->p_rate_w, out->moment_w);
    if (drag->wet == FU_ALL_WET) memset(&out->wet, 0, sizeof out->wet);
    else wet_point(model, drag, end, &past, out);
    return past;
}

static void on_body(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *a,
                    const fu_drag_sums *sums)
{
    const int dim = model->dim, turns = fu_turns(dim);
    double left[3];
    fu_attachment_state end;
    of_point terms;
    const fu_fluid_past past = at_body(model, drag, state, a, &end, &terms);
    fu_fluid_on_particles(model, drag, &past, terms.p, terms.p_rate, end.v, model->load_fraction, left, sums->power);
    for (int d = 0; d < dim; ++d) left[d] -= model->load_fraction * terms.wet.pull[d];
    for (int d = 0; d < dim && sums->total; ++d) sums->total[d] -= left[d];
    for (int k = 0; k < turns; ++k) terms.moment[k] *= model->load_fraction;
    if (sums->f) fu_add_wrench(dim, &end, left, terms.moment, 1.0, sums->f);
}

/* Adds the derivatives of the force and moment on a body, without the derivative of the point's acceleration by
 * position. */
static void tangent_of_body(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *a,
                            const double *psi, fu_weights weights, fu_system *system)
{
    const int dim = model->dim, turns = fu_turns(dim), rows = 2 * (dim + turns);
    double f_by[3 * 12], m_by[3 * 12] = {0.0}, left[3], by_place[9], by_velocity[9];
    double f[3 * FU_ATTACHMENT_COORDINATES], m[3 * FU_ATTACHMENT_COORDINATES];
    fu_attachment_state end;
    fu_point_motion motion;
    of_point of;
    const fu_fluid_past past = at_body(model, drag, state, a, &end, &of);
    fu_fluid_on_particles(model, drag, &past, of.p, of.p_rate, end.v, 1.0, left, 0);
    for (int d = 0; d < dim; ++d) left[d] -= of.wet.pull[d];
    particle_derivatives(drag, dim, &past, of.M, of.p_rate_w, &of.wet, by_place, by_velocity);
    add_strained(dim, turns, &past, of.p_turn, of.p_rate_turn);
    for (int d = 0; d < dim; ++d) {
        double *row = f_by + d * rows;
        memcpy(row, by_place + d * dim, sizeof(double) * (size_t)dim);
        memcpy(row + dim, by_velocity + d * dim, sizeof(double) * (size_t)dim);
        memcpy(row + 2 * dim, of.p_rate_turn + d * turns, sizeof(double) * (size_t)turns);
        memcpy(row + 2 * dim + turns, of.p_rate_omega + d * turns, sizeof(double) * (size_t)turns);
    }
    for (int k = 0; k < turns; ++k) {
        double *row = m_by + k * rows;
        for (int d = 0; d < dim; ++d) {
            row[d] = of.wet.other_place[k * dim + d];
            row[dim + d] = of.moment_w[k * dim + d];
            for (int e = 0; e < dim; ++e) row[d] -= of.moment_w[k * dim + e] * past.flow.gradient[e * dim + d];
        }
        memcpy(row + 2 * dim, of.moment_turn + k * turns, sizeof(double) * (size_t)turns);
    }
    fu_point_motion_at(model, &drag->attachments[0], state, FU_POINT | FU_AXES, left, of.moment, psi, weights.rate,
                       &motion);
    fu_changes(&motion, dim, f_by, f);
    fu_changes(&motion, turns, m_by, m);
    fu_add_wrench_tangent(model, &motion.at, &motion.at, f, m, fu_stiffness_of(&motion),
                          weights.stiffness * model->load_fraction, system);
}

void fu_added_mass_forces(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *a,
                          const fu_drag_sums *sums)
{
    fu_drag_loop loop = {.t = state->t, .sums = sums};
    if (drag->cable >= 0) fu_drag_visit(model, drag, state->q, state->v, a, add_at, &loop, 0);
    else on_body(model, drag, state, a, sums);
}

void fu_added_mass_tangent(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *a,
                           const double *psi, fu_weights weights, fu_system *system)
{
    fu_drag_loop loop = {.t = state->t, .has_matrix = 1, .weights = weights};
    if (drag->cable >= 0) fu_drag_visit(model, drag, state->q, state->v, a, tangent_at, &loop, system);
    else tangent_of_body(model, drag, state, a, psi, weights, system);
}
