/* Inertia of the fluid around cables and bodies over a step, for the integrator that balances energy: the kinetic
 * energy T changes by the work of the force and by the external work of the fluid.
 *
 * The impulse's rate is its change over the step; on the slope of a cable acts a discrete gradient, and on a body a
 * moment of the same kind (derive/couplings/added_mass.py). Moments act along the axes in the middle of the step.
 *
 * With a wet part c, gradient and moment are multiplied by the mean of c, and the change of the impulse contains the
 * change of c times the mean impulse. T changes with c by D of added_mass.py: a vertical force D times the change of c
 * over the change of the height balances it.
 */
#include "bodies/model.h"
#include "couplings/common/attachments.h"
#include "couplings/fluid/drag.h"

#include <math.h>
#include <string.h>

/* of the extent: for a smaller rise the derivative half-way replaces the quotient of changes */
#define MIN_RISE 1e-7

/* The motion of a point relative to the fluid: w, DU/Dt of the fluid, and the wet part. */
typedef struct {
    fu_flow_state flow;
    double w[3], material[3], wet;
} relative_motion;

static relative_motion motion_in_fluid(const fu_model *model, const fu_drag *drag, double t, const double *r,
                                       const double *v)
{
    const int dim = model->dim;
    relative_motion out;
    fu_wetness wet;
    fu_fluid_at(model, drag, t, r, &out.flow, &wet);
    out.wet = wet.part;
    for (int d = 0; d < dim; ++d) {
        out.w[d] = v[d] - out.flow.U[d];
        out.material[d] = out.flow.rate[d] + fu_dot(dim, out.flow.gradient + d * dim, out.flow.U);
    }
    return out;
}

/* Computes the force on particles by an impulse p and its rate, with the sign of the left side of the equations of
 * motion, and adds its power. */
static void on_particles(const fu_model *model, const fu_drag *drag, const relative_motion *at, const double *p,
                         const double *p_rate, const double *v, double part, double left[3], fu_drag_powers *power)
{
    const int dim = model->dim;
    const double displaced = at->wet * drag->displaced;
    double strained[3] = {0.0};
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) strained[j] += at->flow.gradient[i * dim + j] * p[i];
    for (int d = 0; d < dim; ++d) left[d] = part * (p_rate[d] + strained[d] - displaced * at->material[d]);
    if (power)
        power->external += part * (displaced * fu_dot(dim, at->material, v) - fu_dot(dim, p_rate, at->flow.U) -
                                   fu_dot(dim, strained, v));
}

/* The wet part over a step: its mean, its change, and its discrete gradient by position. */
typedef struct {
    double mean, change, by_place[3];
} wet_step;

static wet_step wet_over_step(const fu_model *model, const fu_drag *drag, const double *r, const double *r_next)
{
    wet_step out = {1.0, 0.0, {0.0}};
    const double from = fu_drag_height(model, drag, 0.0, r), to = fu_drag_height(model, drag, 0.0, r_next);
    const double before = fu_wet_at_height(drag, from).part, after = fu_wet_at_height(drag, to).part;
    const double slope = fabs(to - from) > MIN_RISE * drag->extent ? (after - before) / (to - from)
                                                                   : fu_wet_at_height(drag, 0.5 * (from + to)).slope;
    out.mean = 0.5 * (before + after);
    out.change = after - before;
    for (int d = 0; d < model->dim; ++d) out.by_place[d] = slope * drag->flow.up[d];
    return out;
}

/* Includes the wet part in the change dp of an impulse over a step, and computes the force on the position; p, M:
 * impulse and mass at both ends of the step if entirely wet. */
static void take_wet_step(int dim, const wet_step *wet, const relative_motion motion[2], double p[2][3], double M[2][9],
                          double dp[3], double on_place[3])
{
    double a[3], b[3], D = 0.0;
    for (int d = 0; d < dim; ++d) {
        a[d] = 0.5 * (motion[0].w[d] + motion[1].w[d]);
        b[d] = 0.5 * (motion[1].w[d] - motion[0].w[d]);
        dp[d] = wet->mean * dp[d] + wet->change * 0.5 * (p[0][d] + p[1][d]);
    }
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) D += 0.25 * (a[i] * a[j] - b[i] * b[j]) * (M[0][i * dim + j] + M[1][i * dim + j]);
    for (int d = 0; d < dim; ++d) on_place[d] = D * wet->by_place[d];
}

/* Includes the wet part in the change of an impulse over a step, the force g on the slope, and the impulse half-way;
 * computes the force on the position. */
static void wet_length_over_step(const fu_model *model, const fu_drag *drag, const fu_drag_place place[2],
                                 const relative_motion motion[2], const relative_motion *halfway, double dp[3],
                                 double g[3], double mean[3], double on_place[3])
{
    const wet_step wet = wet_over_step(model, drag, place[0].r, place[1].r);
    double p[2][3], M[2][9];
    for (int i = 0; i < 2; ++i) drag->kernel->impulse_of_cable(place[i].r_x, motion[i].w, drag->added, p[i], M[i]);
    take_wet_step(model->dim, &wet, motion, p, M, dp, on_place);
    for (int d = 0; d < model->dim; ++d) {
        g[d] *= wet.mean;
        mean[d] *= halfway->wet;
    }
}

/* A block of points of an element over a step: at both ends and half-way. */
typedef struct {
    fu_block_shapes shapes;
    fu_block_motion motion[3];
} block_step;

static void place_in(int dim, const fu_block_motion *block, int point, fu_drag_place *out)
{
    fu_block_vector(dim, block->r, point, out->r);
    fu_block_vector(dim, block->v, point, out->v);
    fu_block_vector(dim, block->a, point, out->a);
    fu_block_vector(dim, block->r_x, point, out->r_x);
}

/* Computes the force on particles and that on the slope at a point of a block over a step, times its weight, and adds
 * the power. */
static void on_point_in_step(const fu_model *model, const fu_drag *drag, const fu_equations *at,
                             const block_step *block, int point, double left[3], double g[3], fu_drag_powers *power)
{
    const int dim = model->dim;
    const double weight = block->shapes.weight[point], times[2] = {at->now->t, at->next->t};
    fu_drag_place place[2], middle;
    relative_motion motion[2];
    double dp[3], rate[3], mean[3], M[9], on_place[3] = {0.0};
    for (int i = 0; i < 2; ++i) {
        place_in(dim, &block->motion[i], point, &place[i]);
        motion[i] = motion_in_fluid(model, drag, times[i], place[i].r, place[i].v);
    }
    place_in(dim, &block->motion[2], point, &middle);
    const relative_motion halfway = motion_in_fluid(model, drag, at->middle->t, middle.r, middle.v);
    drag->kernel->inertia_step(place[0].r_x, place[1].r_x, motion[0].w, motion[1].w, drag->added, dp, g);
    drag->kernel->impulse_of_cable(middle.r_x, halfway.w, drag->added, mean, M);
    if (drag->wet != FU_ALL_WET) wet_length_over_step(model, drag, place, motion, &halfway, dp, g, mean, on_place);
    for (int d = 0; d < dim; ++d) rate[d] = dp[d] / at->h;
    on_particles(model, drag, &halfway, mean, rate, middle.v, weight, left, power);
    if (power) /* the change of T contains the velocities at both ends; `on_particles` has -rate . U half-way */
        for (int d = 0; d < dim; ++d)
            power->external +=
                weight * rate[d] * (0.5 * (motion[0].w[d] + motion[1].w[d]) - middle.v[d] + halfway.flow.U[d]);
    for (int d = 0; d < dim; ++d) left[d] -= weight * on_place[d];
    for (int d = 0; d < dim; ++d) g[d] *= weight;
}

static void on_cable_in_step(const fu_model *model, const fu_drag *drag, const fu_equations *at,
                             const fu_drag_sums *sums)
{
    const fu_cable *cable = &model->cables[drag->cable];
    const int dim = model->dim;
    const fu_state *states[3] = {at->now, at->next, at->middle};
    for (int e = drag->first; e < drag->first + drag->n_elements; ++e) {
        const int first = fu_element_entry(cable, e);
        fu_drag_points points;
        fu_drag_points_over(model, drag, e, at->now->q + first, at->next->q + first, &points);
        for (int from = 0; from < points.n; from += FU_BLOCK_POINTS) {
            block_step block;
            fu_points forces[2 * 3];
            memset(forces, 0, sizeof forces);
            fu_block_shapes_of(&points, from, cable->coordinates / dim, &block.shapes);
            for (int i = 0; i < 3; ++i)
                fu_block_motion_of(cable, &block.shapes, states[i]->q + first, states[i]->v + first, 0,
                                   &block.motion[i]);
            for (int p = 0; p < block.shapes.n; ++p) {
                double left[3], g[3];
                on_point_in_step(model, drag, at, &block, p, left, g, sums->power);
                for (int d = 0; d < dim; ++d) {
                    forces[d][p] = -left[d];
                    forces[dim + d][p] = g[d];
                    if (sums->total) sums->total[d] -= left[d];
                }
            }
            if (sums->f) fu_block_subtract(dim, &block.shapes, 2, forces, sums->f + first);
        }
    }
}

/* A point of a body, or of a cable, which does not turn, at both ends of a step and half-way, and its motion relative
 * to the fluid there; theta: Cayley vector of the rotation. */
typedef struct {
    fu_attachment_state ends[2], turning;
    relative_motion motion[2], halfway;
    double v[3], theta[3], change[3]; /* mean velocity of the point in the step; argument of the kernel: change of the
                                         velocity by rotation */
} body_step;

static void body_over_step(const fu_model *model, const fu_drag *drag, const fu_equations *at, body_step *out)
{
    const fu_attachment *on = &drag->attachments[0];
    const int dim = model->dim, turns = fu_turns(dim);
    const fu_state *states[2] = {at->now, at->next};
    fu_attachment_state *const ends = out->ends;
    double middle[3] = {0.0}, arm[3] = {0.0}, turned[3];
    for (int i = 0; i < 2; ++i) {
        fu_attachment_at(model, on, states[i], 0.0, FU_POINT | FU_AXES, &ends[i]);
        out->motion[i] = motion_in_fluid(model, drag, states[i]->t, ends[i].p, ends[i].v);
    }
    fu_attachment_at(model, on, at->middle, 0.0, FU_PLACE | FU_AXES, &out->turning);
    memset(out->theta, 0, sizeof out->theta);
    memset(out->change, 0, sizeof out->change);
    for (int d = 0; d < dim; ++d) {
        middle[d] = 0.5 * (ends[0].p[d] + ends[1].p[d]);
        out->v[d] = (ends[1].p[d] - ends[0].p[d]) / at->h;
    }
    out->halfway = motion_in_fluid(model, drag, at->middle->t, middle, out->v);
    if (on->body < 0) return;
    const int dof = model->bodies[on->body].dof;
    for (int k = 0; k < turns; ++k)
        for (int i = 0; i < out->turning.n; ++i)
            out->theta[k] += out->turning.T[k * out->turning.n + i] * at->psi[dof + i];
    for (int d = 0; d < dim; ++d) arm[d] = out->v[d] - at->psi[dof + d] / at->h;
    fu_swing(dim, out->theta, arm, turned);
    for (int d = 0; d < dim; ++d)
        out->change[d] = ends[1].v[d] - ends[0].v[d] - (states[1]->v[dof + d] - states[0]->v[dof + d]) - turned[d];
}

/* The same for a body: its moment also balances the work of the impulse's change by rotation. */
static void wet_body_over_step(const fu_model *model, const fu_drag *drag, const body_step *of, double dp[3],
                               double mean[3], double moment[3], double on_place[3])
{
    const int dim = model->dim, turns = fu_turns(dim);
    const wet_step wet = wet_over_step(model, drag, of->ends[0].p, of->ends[1].p);
    double p[2][3], M[2][9], more[3], with[3];
    for (int i = 0; i < 2; ++i) drag->kernel->impulse_of_point(of->ends[i].A, drag->added, of->motion[i].w, p[i], M[i]);
    take_wet_step(dim, &wet, of->motion, p, M, dp, on_place);
    for (int d = 0; d < dim; ++d) {
        more[d] = 0.25 * wet.change * 0.5 * (p[0][d] + p[1][d]);
        mean[d] *= of->halfway.wet;
    }
    fu_moment_of(dim, of->change, more, with);
    for (int k = 0; k < turns; ++k) moment[k] = wet.mean * moment[k] + with[k];
}

static void on_body_in_step(const fu_model *model, const fu_drag *drag, const fu_equations *at,
                            const fu_drag_sums *sums)
{
    const int dim = model->dim;
    double dp[3], mean[3], moment[3], more[3], rate[3] = {0.0}, left[3], on_place[3] = {0.0};
    body_step of;
    body_over_step(model, drag, at, &of);
    drag->kernel->inertia_of_point_step(of.ends[0].A, of.ends[1].A, drag->added, of.motion[0].w, of.motion[1].w,
                                        of.theta, of.change, dp, mean, moment, more);
    if (drag->wet != FU_ALL_WET) wet_body_over_step(model, drag, &of, dp, mean, moment, on_place);
    for (int d = 0; d < dim; ++d) rate[d] = dp[d] / at->h;
    on_particles(model, drag, &of.halfway, mean, rate, of.v, 1.0, left, sums->power);
    for (int d = 0; d < dim; ++d) left[d] -= on_place[d];
    for (int d = 0; d < dim && sums->power; ++d) /* as along a cable */
        sums->power->external +=
            rate[d] * (0.5 * (of.motion[0].w[d] + of.motion[1].w[d]) - of.v[d] - more[d] + of.halfway.flow.U[d]);
    for (int d = 0; d < dim && sums->total; ++d) sums->total[d] -= left[d];
    if (!sums->f) return;
    fu_discrete_point(model, &drag->attachments[0], at->now, at->next, of.turning.P);
    fu_add_wrench(dim, &of.turning, left, moment, 1.0, sums->f);
}

void fu_added_mass_step_forces(const fu_model *model, const fu_drag *drag, const fu_equations *at,
                               const fu_drag_sums *sums)
{
    if (drag->cable >= 0) on_cable_in_step(model, drag, at, sums);
    else on_body_in_step(model, drag, at, sums);
}
