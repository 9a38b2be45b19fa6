/* Inertia of the fluid around cables and bodies over a step, for the integrator that balances energy: the kinetic energy T changes
 * by the work of the force, and by that of the fluid, from outside.
 *
 * The impulse's rate is its change over the step; on the slope of a cable acts a discrete gradient, and on a body a moment of the
 * same kind (derive/couplings/added_mass.py). Moments act along the axes in the middle of the step.
 */
#include "engine.h"

#include <string.h>

static void on_cable_in_step(const fu_model *model, const fu_drag *drag, const fu_equations *at, const fu_drag_sums *sums)
{
    const fu_cable *cable = &model->cables[drag->cable];
    const int dim = model->dim, n = cable->coordinates / dim;
    const fu_state *ends[2] = {at->now, at->next};
    for (int e = 0; e < cable->n_elements; ++e) {
        const int first = cable->first + e * cable->per_node;
        for (int k = 0; k < drag->n_points; ++k) {
            const fu_quadrature_point point = fu_drag_point(drag, n, e, k);
            fu_drag_place place[2], middle;
            fu_fluid_past past[2];
            double dp[3], g[3], rate[3], mean[3], M[9], left[3];
            for (int i = 0; i < 2; ++i) {
                fu_drag_place_on_axis(model, drag, ends[i]->q + first, ends[i]->v + first, 0, point, &place[i]);
                past[i] = fu_past_fluid(model, drag, ends[i]->t, place[i].r, place[i].v, place[i].a);
            }
            fu_drag_place_on_axis(model, drag, at->middle->q + first, at->middle->v + first, 0, point, &middle);
            const fu_fluid_past halfway = fu_past_fluid(model, drag, at->middle->t, middle.r, middle.v, middle.a);
            drag->kernel->inertia_step(place[0].r_x, place[1].r_x, past[0].w, past[1].w, drag->added, dp, g);
            drag->kernel->impulse_of_cable(middle.r_x, halfway.w, drag->added, mean, M);
            for (int d = 0; d < dim; ++d) rate[d] = dp[d] / at->h;
            fu_fluid_on_particles(model, drag, &halfway, mean, rate, middle.v, point.weight, left, sums->power);
            if (sums->power) /* that T changes by, with the velocities at both ends; fu_fluid_on_particles has -rate . U half-way */
                for (int d = 0; d < dim; ++d)
                    sums->power->external += point.weight * rate[d] *
                                             (0.5 * (past[0].w[d] + past[1].w[d]) - middle.v[d] + halfway.flow.U[d]);
            for (int d = 0; d < dim; ++d) g[d] *= point.weight;
            fu_fluid_on_element(model, drag, first, point, left, g, sums);
        }
    }
}

/* A body's point at both ends of a step, on its way, and the fluid past it there; theta: the Cayley vector of its turn. */
typedef struct {
    fu_attachment_state ends[2], turning;
    fu_fluid_past past[2], halfway;
    double v[3], theta[3], change[3]; /* way over the step's length; change of the velocity of turning, as the kernel takes it */
} body_step;

static void body_over_step(const fu_model *model, const fu_drag *drag, const fu_equations *at, body_step *out)
{
    const fu_attachment *on = &drag->attachments[0];
    const int dim = model->dim, turns = dim == 3 ? 3 : 1, dof = model->bodies[on->body].dof;
    const fu_state *states[2] = {at->now, at->next};
    fu_attachment_state *const ends = out->ends;
    double middle[3] = {0.0}, arm[3] = {0.0}, turned[3] = {0.0};
    for (int i = 0; i < 2; ++i) {
        fu_attachment_at(model, on, states[i], 0.0, FU_POINT | FU_AXES, &ends[i]);
        out->past[i] = fu_past_fluid(model, drag, states[i]->t, ends[i].p, ends[i].v, model->zero);
    }
    fu_attachment_at(model, on, at->middle, 0.0, FU_AXES, &out->turning);
    memset(out->theta, 0, sizeof out->theta);
    for (int k = 0; k < turns; ++k)
        for (int i = 0; i < out->turning.n; ++i) out->theta[k] += out->turning.T[k * out->turning.n + i] * at->psi[dof + i];
    for (int d = 0; d < dim; ++d) {
        middle[d] = 0.5 * (ends[0].p[d] + ends[1].p[d]);
        out->v[d] = (ends[1].p[d] - ends[0].p[d]) / at->h;
        arm[d] = out->v[d] - at->psi[dof + d] / at->h;
    }
    if (dim == 3) fu_cross(out->theta, arm, turned);
    else {
        turned[0] = -out->theta[0] * arm[1];
        turned[1] = out->theta[0] * arm[0];
    }
    for (int d = 0; d < dim; ++d)
        out->change[d] = ends[1].v[d] - ends[0].v[d] - (states[1]->v[dof + d] - states[0]->v[dof + d]) - turned[d];
    out->halfway = fu_past_fluid(model, drag, at->middle->t, middle, out->v, model->zero);
}

static void on_body_in_step(const fu_model *model, const fu_drag *drag, const fu_equations *at, const fu_drag_sums *sums)
{
    const int dim = model->dim, turns = dim == 3 ? 3 : 1;
    double dp[3], mean[3], moment[3], more[3], rate[3], left[3], P[3 * FU_ATTACHMENT_COORDINATES];
    body_step of;
    body_over_step(model, drag, at, &of);
    drag->kernel->inertia_of_point_step(of.ends[0].A, of.ends[1].A, drag->added, of.past[0].w, of.past[1].w, of.theta, of.change,
                                        dp, mean, moment, more);
    for (int d = 0; d < dim; ++d) rate[d] = dp[d] / at->h;
    fu_fluid_on_particles(model, drag, &of.halfway, mean, rate, of.v, 1.0, left, sums->power);
    for (int d = 0; d < dim && sums->power; ++d) /* as along a cable */
        sums->power->external +=
            rate[d] * (0.5 * (of.past[0].w[d] + of.past[1].w[d]) - of.v[d] - more[d] + of.halfway.flow.U[d]);
    for (int d = 0; d < dim && sums->total; ++d) sums->total[d] -= left[d];
    if (!sums->f) return;
    fu_discrete_point(model, &drag->attachments[0], at->now, at->next, P);
    for (int i = 0; i < of.turning.n; ++i) {
        double sum = 0.0;
        for (int d = 0; d < dim; ++d) sum += P[d * of.turning.n + i] * left[d];
        for (int k = 0; k < turns; ++k) sum += of.turning.T[k * of.turning.n + i] * moment[k];
        sums->f[of.turning.at[i]] += sum;
    }
}

void fu_fluid_inertia_step_forces(const fu_model *model, const fu_drag *drag, const fu_equations *at, const fu_drag_sums *sums)
{
    if (drag->cable >= 0) on_cable_in_step(model, drag, at, sums);
    else on_body_in_step(model, drag, at, sums);
}
