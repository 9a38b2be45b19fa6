/* Inertia of the fluid around cables and bodies (derive/couplings/added_mass.py), along spans of ropes in
 * couplings/fluid/span_added_mass.c: the kinetic energy T = c w . M w/2 of
 * the added mass M and the wet part c at the velocity w = v - U relative to the fluid, and the force on the displaced
 * mass in an accelerated fluid.
 *
 * The kernels give the force on a particle, that on the slope of a cable or the moment on a body, and the external
 * power of the fluid, with T counted as kinetic energy. Those of Morison's equation have another force, with the same
 * M and the same T. M a belongs to the inertia: Newton's matrix and that of eq 38 contain M. The matrix neglects second
 * derivatives of U, and the curvature of a surface with waves: Newton's method converges without them.
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
    surroundings out;
    fu_fluid_at(model, drag, t, r, &out.flow, &out.wet);
    return out;
}

static void densities_at(const fu_model *model, const fu_drag *drag, const fu_drag_block *block, fu_drag_loop *loop,
                         double *K)
{
    fu_points left[3], on_slope[3], impulse[3], M[9];
    (void)drag;
    (void)K;
    fu_block_inertia(block, left, on_slope);
    block->constants->kernel->impulse_of_cable(block->motion.r_x, block->motion.v, block->constants->added, impulse, M);
    for (int p = 0; p < block->shapes.n; ++p, loop->rows += FU_ADDED_MASS_DENSITIES) {
        double *out = loop->rows;
        memset(out, 0, sizeof(double[FU_ADDED_MASS_DENSITIES]));
        for (int d = 0; d < model->dim; ++d) {
            out[d] = -model->load_fraction * left[d][p];
            out[3 + d] = model->load_fraction * on_slope[d][p];
        }
        for (int i = 0; i < model->dim * model->dim; ++i) out[6 + i] = block->fluid.wet[0][p] * M[i][p];
    }
}

void fu_added_mass_densities(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *out)
{
    fu_drag_loop loop = {.t = state->t, .rows = out};
    fu_drag_visit(model, (const fu_drag *)coupling, state->q, state->v, 0, densities_at, &loop, 0);
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
    (drag->is_morison ? drag->kernel->morison_of_point : drag->kernel->inertia_of_point)(
        end->A, drag->added, end->omega, drag->displaced, end->v, acceleration, of->flow.U, of->flow.rate,
        of->flow.gradient, &of->wet.part, of->wet.up, left, moment, external);
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
    (drag->is_morison ? drag->kernel->morison_of_point_tangent : drag->kernel->inertia_of_point_tangent)(
        end.A, drag->added, end.omega, drag->displaced, end.v, acceleration, of.flow.U, of.flow.rate, of.flow.gradient,
        &of.wet.part, of.wet.up, f_by, moment_by);
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
