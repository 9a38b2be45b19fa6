/* A slide over a step that conserves energy: the constraint at the end of the step, and its discrete gradient G with
 * G psi = phi_next - phi_now. In a step the slide keeps its element; on a rope its ends flow.
 */
#include "bodies/model.h"
#include "bodies/rotation.h"
#include "bodies/unknowns.h"
#include "couplings/slide/slide.h"

/* The arguments of the kernels at an end of a step, in the element of its start. */
typedef struct {
    double length, x;
    const double *e, *b;
} step_end;

/* b: the configuration of the rider, a rigid body. */
static step_end end_of(const fu_model *model, const fu_slide *slide, const fu_equations *step, const fu_state *state)
{
    const int j = slide->base.index, element = step->now->segment[j];
    step_end out = {.b = state->q + model->bodies[slide->rider.body].configuration};
    if (slide->cable < 0) {
        const fu_span_element it = fu_span_element_at(model, &slide->on, element, state->q, 0, 0);
        out.length = it.l;
        out.x = state->s[j] - it.s[0];
        out.e = it.e;
        return out;
    }
    const fu_cable *cable = &model->cables[slide->cable];
    out.length = fu_element_length(cable, element);
    out.x = state->s[j] - fu_element_start(model, step->now, j, element);
    out.e = state->q + fu_element_entry(cable, element);
    return out;
}

/* Computes the discrete gradient G over the slide's coordinates and s. */
static void discrete_gradient(const fu_slide *slide, const fu_equations *step, const step_end *now,
                              const step_end *next, double *G)
{
    const fu_slide_kernels *kernel = slide->kernel;
    if (slide->cable < 0)
        kernel->flowing_gradient(now->length, next->length, now->x, next->x, now->e, next->e, now->b, next->b, G);
    else kernel->discrete_gradient(now->length, now->x, next->x, now->e, next->e, now->b, next->b, G);
    fu_slide_to_ends_of_span(slide, step->now->segment[slide->base.index], G, kernel->dim, kernel->coordinates + 1, 1);
}

/* Adds the force's discrete work to f, and the equations of s and of the force to `internal`. */
void fu_slide_over_step(const fu_model *model, const fu_coupling *coupling, const fu_equations *step, double *f,
                        double *internal)
{
    const fu_slide *slide = (const fu_slide *)coupling;
    const fu_state *next = step->next;
    const int j = coupling->index, s = slide->kernel->coordinates, n = s + 1;
    const double *force = next->forces + coupling->force;
    const step_end from = end_of(model, slide, step, step->now), to = end_of(model, slide, step, next);
    double G[3 * FU_MAX_COORDINATES], phi[3], unused[FU_MAX_COORDINATES], along = 0.0;
    int at[FU_SLIDE_COORDINATES + 1];
    fu_slide_coordinates(model, next, j, at);
    discrete_gradient(slide, step, &from, &to, G);
    slide->kernel->residual(to.length, to.x, to.e, to.b, slide->rider.u, force, phi, unused);
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
    const int turns = fu_slide_element_coordinates(model, j), element = step->now->segment[j];
    const step_end from = end_of(model, slide, step, step->now), to = end_of(model, slide, step, next);
    double G[3 * FU_MAX_COORDINATES], J[3 * FU_MAX_COORDINATES], K[FU_MAX_COORDINATES * FU_MAX_COORDINATES];
    int at[FU_SLIDE_COORDINATES + 1];
    fu_slide_coordinates(model, next, j, at);
    discrete_gradient(slide, step, &from, &to, G);
    slide->kernel->tangent(to.length, to.x, to.e, to.b, slide->rider.u, next->forces + coupling->force, J, K);
    fu_slide_to_ends_of_span(slide, element, J, dim, n, 1);
    fu_slide_to_ends_of_span(slide, element, K, n, n, 1);
    fu_slide_to_ends_of_span(slide, element, K, n, 1, n);
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
