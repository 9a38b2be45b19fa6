/* A slide over a step that conserves energy: the constraint at the end of the step, and its discrete gradient G with
 * G psi = phi_next - phi_now.
 */
#include "bodies/model.h"
#include "bodies/rotation.h"
#include "bodies/unknowns.h"
#include "couplings/slide/slide.h"

/* Returns the configuration of the rider, a rigid body. */
static const double *rider_at(const fu_model *model, const fu_state *state, const fu_slide *slide)
{
    return state->q + model->bodies[slide->rider.body].configuration;
}

/* Computes the discrete gradient G over the slide's coordinates and s; first: the first dof of its element. */
static void discrete_gradient(const fu_model *model, const fu_coupling *coupling, const fu_equations *step, int first,
                              double *G)
{
    const fu_slide *slide = (const fu_slide *)coupling;
    const fu_state *now = step->now, *next = step->next;
    const int j = coupling->index;
    const double start = fu_element_start(model, now, j, now->segment[j]);
    const double length = fu_element_length(&model->cables[slide->cable], now->segment[j]);
    slide->kernel->discrete_gradient(length, now->s[j] - start, next->s[j] - start, now->q + first, next->q + first,
                                     rider_at(model, now, slide), rider_at(model, next, slide), G);
}

/* Adds the force's discrete work to f, and the equations of s and of the force to `internal`. */
void fu_slide_over_step(const fu_model *model, const fu_coupling *coupling, const fu_equations *step, double *f,
                        double *internal)
{
    const fu_slide *slide = (const fu_slide *)coupling;
    const fu_state *next = step->next;
    const int j = coupling->index, s = slide->kernel->coordinates, n = s + 1;
    const double start = fu_element_start(model, step->now, j, step->now->segment[j]),
                 *force = next->forces + coupling->force;
    double G[3 * FU_MAX_COORDINATES], phi[3], unused[FU_MAX_COORDINATES], along = 0.0;
    int at[FU_SLIDE_COORDINATES + 1];
    fu_slide_coordinates(model, next, j, at);
    discrete_gradient(model, coupling, step, at[0], G);
    slide->kernel->residual(fu_element_length(&model->cables[slide->cable], step->now->segment[j]), next->s[j] - start,
                            next->q + at[0], rider_at(model, next, slide), slide->rider.u, force, phi, unused);
    internal += coupling->unknown;
    for (int d = 0; d < slide->kernel->dim; ++d) {
        for (int i = 0; i < s; ++i) f[at[i]] += force[d] * G[d * n + i];
        along += force[d] * G[d * n + s];
        internal[1 + d] = -slide->base.scale[0] * phi[d];
    }
    internal[0] = -step->weights.stiffness * along;
}

/* Adds the derivatives: rows of the constraint at the end of the step, columns of its discrete gradient, and half the
 * derivative of the force there. */
void fu_slide_over_step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *step,
                                fu_system *system)
{
    const fu_slide *slide = (const fu_slide *)coupling;
    const fu_state *next = step->next;
    const fu_body *rider = &model->bodies[slide->rider.body];
    const int j = coupling->index, s = slide->kernel->coordinates, n = s + 1, dim = slide->kernel->dim;
    const fu_cable *cable = &model->cables[slide->cable];
    const int turns = cable->coordinates;
    const double start = fu_element_start(model, step->now, j, step->now->segment[j]);
    double G[3 * FU_MAX_COORDINATES], J[3 * FU_MAX_COORDINATES], K[FU_MAX_COORDINATES * FU_MAX_COORDINATES];
    int at[FU_SLIDE_COORDINATES + 1];
    fu_slide_coordinates(model, next, j, at);
    discrete_gradient(model, coupling, step, at[0], G);
    slide->kernel->tangent(fu_element_length(cable, step->now->segment[j]), next->s[j] - start, next->q + at[0],
                           rider_at(model, next, slide), slide->rider.u, next->forces + coupling->force, J, K);
    fu_cayley_columns(rider->kernel, J, dim, n, turns, step->psi + rider->dof);
    fu_cayley_columns(rider->kernel, K, n, n, turns, step->psi + rider->dof);
    for (int i = 0; i < n; ++i) {
        for (int d = 0; d < dim; ++d) {
            fu_add(model, system, at[i], at[s] + 1 + d, slide->base.scale[0] * G[d * n + i]);
            fu_add(model, system, at[s] + 1 + d, at[i], slide->base.scale[0] * J[d * n + i]);
        }
        for (int k = 0; k < n; ++k)
            if (K[i * n + k] != 0.0) fu_add(model, system, at[i], at[k], step->weights.stiffness * K[i * n + k]);
    }
}
