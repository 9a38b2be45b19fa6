/* Generalised-alpha, index 3, on the group of configurations (Chung & Hulbert 1993; Arnold & Bruels 2007; Bruels &
 * Cardona 2010).
 *
 *   psi = h v_n + h^2 ((1/2 - beta) a_n + beta a_n+1),   q_n+1 = q_n moved by psi
 *   v_n+1 = v_n + h ((1 - gamma) a_n + gamma a_n+1)
 *   (1 - alpha_m) a_n+1 + alpha_m a_n = (1 - alpha_f) q''_n+1 + alpha_f q''_n
 *
 * with equilibrium and constraints at t_n+1. Unknowns of the Newton iteration: psi, and per slide s and f~, where
 * the force is f = f~ mass/sigma with sigma = beta h^2 (1 - alpha_f)/(1 - alpha_m). Rows of equilibrium are multiplied
 * by sigma, constraint rows by the mass: the matrix is M + sigma K bordered by mass C_q, of one scale for any h
 * (Bottasso, Dopico & Trainelli 2008).
 */
#include "engine.h"

#include <string.h>

#define JUMP 0.25 /* of a step: from its middle to the instant of a jump, on average */

static double sigma(const fu_genalpha *g, double h)
{
    return g->beta * h * h * (1.0 - g->alpha_f) / (1.0 - g->alpha_m);
}

/* next.q, v, q'' from next.a */
static void kinematics(fu_run *run, double h)
{
    const fu_model *model = run->model;
    const fu_genalpha *g = &run->scheme;
    const fu_state *now = &run->now;
    fu_state *next = &run->next;
    const double over = 1.0 / (1.0 - g->alpha_f), slope = over * (1.0 - g->alpha_m);
    const double slope_now = over * g->alpha_m, held = over * g->alpha_f;
    const double by_now = h * h * (0.5 - g->beta), by_next = h * h * g->beta;
    const double rate_now = h * (1.0 - g->gamma), rate_next = h * g->gamma;
    const double *v = now->v, *a = now->a, *before = now->acceleration, *change = next->a;
    double *restrict psi = run->psi, *restrict velocity = next->v, *restrict acceleration = next->acceleration;
    for (int i = 0; i < model->n_dof; ++i) {
        psi[i] = h * v[i] + by_now * a[i] + by_next * change[i];
        velocity[i] = v[i] + rate_now * a[i] + rate_next * change[i];
        acceleration[i] = slope * change[i] + slope_now * a[i] - held * before[i];
    }
    memcpy(next->q, now->q, sizeof(double) * (size_t)model->n_q);
    fu_move(model, next->q, run->psi);
    if (model->n_motions) fu_prescribe(model, next);
}

/* whether the row of this s, as fu_add knows it, is equilibrium along the cable */
static int slides(const fu_model *model, const fu_state *state, int at)
{
    for (int j = 0; j < model->n_slides; ++j)
        if (fu_extra(model, model->slides[j].unknown) == at) return state->mode[j] == FU_SLIDES;
    return 0;
}

/* R of a slide that has a brake and slides; J: derivatives of phi by its coordinates and s */
static void resistance_of(const fu_model *model, const fu_state *state, int j, const double *J, fu_resistance *resistance)
{
    double t[3], u[3];
    fu_slide_motion(model, state, j, J, t, u);
    fu_resistance_at(model, state, j, t, u, state->f + 3 * j, resistance);
}

/* minus the scaled residual, over the unknowns; run->force keeps the unscaled sum over the dofs */
static void residual(fu_run *run, double inertia, double scale)
{
    const double begin = fu_clock();
    const fu_model *model = run->model;
    const fu_state *next = &run->next;
    double phi[3], g[FU_SLIDE_COORDINATES], *extra = run->rhs + model->n_band + model->n_border_dof;
    int at[2 * FU_SLIDE_COORDINATES];
    if (inertia != 0.0) fu_mass_times(model, next->q, next->acceleration, run->force);
    else
        for (int i = 0; i < model->n_dof; ++i) run->force[i] = 0.0;
    fu_internal_forces(model, next->q, next->v, run->force);
    fu_external_forces(model, next->t, next->q, run->force);
    for (int j = 0; j < model->n_slides; ++j) {
        const fu_slide *slide = &model->slides[j];
        const int s = fu_slide_coordinates(model, next, j, at), mode = next->mode[j];
        const double unit = fu_row_unit(inertia, slide->mass);
        double rate, second;
        fu_slide_residual(model, next, j, phi, g);
        for (int i = 0; i < s; ++i) run->force[at[i]] += g[i];
        extra[slide->unknown] = mode == FU_SLIDES ? -scale * g[s]
            : -unit * (next->s[j] - (mode == FU_LOCKED ? fu_slide_held(model, next, j, &rate, &second) : run->now.s[j]));
        if (slide->resistance && mode == FU_SLIDES) {
            double J[3 * (FU_SLIDE_COORDINATES + 1)], K[(FU_SLIDE_COORDINATES + 1) * (FU_SLIDE_COORDINATES + 1)];
            fu_resistance resistance;
            fu_slide_tangent(model, next, j, next->f + 3 * j, J, K);
            resistance_of(model, next, j, J, &resistance);
            extra[slide->unknown] += scale * resistance.R;
        }
        for (int d = 0; d < slide->kernel->dim; ++d)
            extra[slide->unknown + 1 + d] = mode == FU_LEFT ? -scale * next->f[3 * j + d] : -unit * phi[d];
    }
    for (int k = 0; k < model->n_joints; ++k) {
        const fu_joint *joint = &model->joints[k];
        const double *multipliers = next->multipliers + 6 * k;
        double equations[6], J[6 * 2 * FU_ATTACHMENT_COORDINATES];
        if (fu_joint_is_inactive(joint, next)) {
            for (int r = 0; r < joint->kernel->rows; ++r) extra[joint->unknown + r] = -scale * multipliers[r];
            continue;
        }
        const int n = fu_joint_residual(model, joint, next, equations, at, J);
        for (int r = 0; r < joint->kernel->rows; ++r) {
            if (joint->redundant_rows >> r & 1) equations[r] = 0.0;
            extra[joint->unknown + r] = -fu_row_unit(inertia, joint->scale[r]) * equations[r];
            for (int i = 0; i < n; ++i) {
                const double pull = J[r * n + i] * multipliers[r];
                if (at[i] < model->n_dof) run->force[at[i]] += pull;
                else if (slides(model, next, at[i])) extra[at[i] - model->n_dof] -= scale * pull;
            }
        }
    }
    for (int k = 0; k < model->n_springs; ++k) {
        const fu_spring *spring = &model->springs[k];
        double force[3], by_gap[9], by_rate[9];
        fu_spring_pull(model, spring, next->q, next->spring + 3 * k, run->force);
        fu_spring_force(model, spring, next->q, next->v, force, by_gap, by_rate);
        for (int d = 0; d < spring->dim; ++d)
            extra[spring->unknown + d] = -scale * (next->spring[3 * k + d] - force[d]);
    }
    fu_gather(model, run->force, run->rhs);
    for (int i = 0; i < model->n_band + model->n_border_dof; ++i) run->rhs[i] *= -scale;
    run->statistics.time_residual += fu_clock() - begin;
}

/* Columns of an end's body, from `first` on, made those of psi; psi null: they are. */
static void turn_columns(const fu_model *model, const fu_attachment *end, const double *psi, double *rows, int n_rows,
                         int n_columns, int first)
{
    if (!psi || end->body < 0) return;
    const fu_body *body = &model->bodies[end->body];
    fu_turn_columns(body->kernel, rows, n_rows, n_columns, first, psi + body->dof);
}

/* What R adds to the row of s of a slide; J as above, by the coordinates themselves. */
static void brake_matrix(fu_run *run, int j, const double *J, fu_weights w, const double *psi)
{
    const fu_model *model = run->model;
    const fu_slide *slide = &model->slides[j];
    double by_place[FU_SLIDE_COORDINATES + 1], by_rate[FU_SLIDE_COORDINATES + 1];
    int at[FU_SLIDE_COORDINATES + 1];
    const int s = fu_slide_coordinates(model, &run->next, j, at), n = s + 1;
    fu_resistance resistance;
    resistance_of(model, &run->next, j, J, &resistance);
    fu_resistance_rows(model, &run->next, j, J, &resistance, by_place, by_rate);
    turn_columns(model, &slide->rider, psi, by_place, 1, n, model->cables[slide->cable].coordinates);
    for (int k = 0; k < n; ++k)
        fu_add(model, &run->newton, at[s], at[k], -w.stiffness * (by_place[k] + w.rate * by_rate[k]));
    for (int d = 0; d < model->dim; ++d)
        fu_add(model, &run->newton, at[s], at[s] + 1 + d, -fu_row_unit(w.inertia, slide->mass) * resistance.by_f[d]);
}

/* Derivative at `next` of the scaled residual by the unknowns; psi: what moved the bodies there, or null where the
 * unknowns move them from there. */
static void matrix(fu_run *run, fu_weights w, const double *psi)
{
    const fu_model *model = run->model;
    const fu_state *next = &run->next;
    fu_system *system = &run->newton;
    double J[6 * 2 * FU_ATTACHMENT_COORDINATES], K[4 * FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES];
    int at[2 * FU_SLIDE_COORDINATES];
    fu_system_clear(system);
    fu_dynamic_matrix(model, next->q, next->v, w.inertia, w.rate, w.stiffness, system);
    fu_bodies_matrix(model, next, psi, w, system);
    if (w.stiffness == 0.0) return;
    fu_loads_matrix(model, next->t, next->q, psi, w.stiffness, system);
    for (int j = 0; j < model->n_slides; ++j) {
        const fu_slide *slide = &model->slides[j];
        const double mass = fu_row_unit(w.inertia, slide->mass);
        const int s = fu_slide_coordinates(model, next, j, at), n = s + 1, dim = slide->kernel->dim;
        const int row = at[s], force = row + 1;
        fu_slide_tangent(model, next, j, next->f + 3 * j, J, K);
        if (slide->resistance && next->mode[j] == FU_SLIDES) brake_matrix(run, j, J, w, psi);
        for (int i = 0; i < n; ++i)
            for (int d = 0; d < dim; ++d)
                if (i < s || next->mode[j] == FU_SLIDES) fu_add(model, system, at[i], force + d, mass * J[d * n + i]);
        turn_columns(model, &slide->rider, psi, J, dim, n, model->cables[slide->cable].coordinates);
        turn_columns(model, &slide->rider, psi, K, n, n, model->cables[slide->cable].coordinates);
        if (next->mode[j] != FU_SLIDES) fu_add(model, system, row, row, mass);
        for (int i = 0; i < n; ++i) {
            for (int d = 0; d < dim; ++d) {
                if (next->mode[j] != FU_LEFT) fu_add(model, system, force + d, at[i], mass * J[d * n + i]);
                else if (i == 0) fu_add(model, system, force + d, force + d, mass);
            }
            if (i == s && next->mode[j] != FU_SLIDES) continue;
            for (int k = 0; k < n; ++k)
                if (K[i * n + k] != 0.0) fu_add(model, system, at[i], at[k], w.stiffness * K[i * n + k]);
        }
    }
    for (int k = 0; k < model->n_joints; ++k) {
        const fu_joint *joint = &model->joints[k];
        const int n = fu_joint_tangent(model, joint, next, at, J, K), rows = joint->kernel->rows, first = fu_extra(model, joint->unknown);
        int from[2] = {0, 0}, unused[FU_ATTACHMENT_COORDINATES];
        if (fu_joint_is_inactive(joint, next)) {
            for (int r = 0; r < rows; ++r)
                fu_add(model, system, first + r, first + r, fu_row_unit(w.inertia, joint->scale[r]));
            continue;
        }
        from[1] = fu_attachment_coordinates(model, &joint->ends[0], next, unused);
        for (int r = 0; r < rows; ++r) {
            if (!(joint->redundant_rows >> r & 1)) continue;
            memset(J + r * n, 0, sizeof(double) * (size_t)n);
            fu_add(model, system, first + r, first + r, fu_row_unit(w.inertia, joint->scale[r]));
        }
        for (int r = 0; r < rows; ++r)
            for (int i = 0; i < n; ++i)
                if (at[i] < model->n_dof || slides(model, next, at[i]))
                    fu_add(model, system, at[i], first + r, fu_row_unit(w.inertia, joint->scale[r]) * J[r * n + i]);
        for (int e = 0; e < 2; ++e) {
            turn_columns(model, &joint->ends[e], psi, J, rows, n, from[e]);
            turn_columns(model, &joint->ends[e], psi, K, n, n, from[e]);
        }
        for (int i = 0; i < n; ++i) {
            for (int r = 0; r < rows; ++r)
                fu_add(model, system, first + r, at[i], fu_row_unit(w.inertia, joint->scale[r]) * J[r * n + i]);
            if (at[i] >= model->n_dof && !slides(model, next, at[i])) continue;
            for (int m = 0; m < n; ++m) {
                /* what is between two cables would widen the band: Newton converges without */
                if (K[i * n + m] == 0.0 || (fu_between_cables(joint) && (i < from[1]) != (m < from[1]))) continue;
                fu_add(model, system, at[i], at[m], w.stiffness * K[i * n + m]);
            }
        }
    }
    for (int k = 0; k < model->n_springs; ++k)
        fu_spring_matrix(model, &model->springs[k], next, psi, w.rate, w.stiffness,
                         fu_row_unit(w.inertia, model->springs[k].mass), system);
}

static void newton_matrix(fu_run *run, double h)
{
    matrix(run, (fu_weights){1.0, run->scheme.gamma / (run->scheme.beta * h), sigma(&run->scheme, h)}, run->psi);
}

/* the solution in run->rhs, applied to `next`; returns its size as a length */
static double apply(fu_run *run, double h)
{
    const double per_psi = 1.0 / (run->scheme.beta * h * h), size = fu_spread_size(run);
    for (int i = 0; i < run->model->n_dof; ++i) run->next.a[i] += per_psi * run->work[i];
    fu_apply_extra(run, 1.0, sigma(&run->scheme, h));
    fu_seat_slides(run);
    return size;
}

/* psi = h v: accelerations hold vibrations that the step does not resolve, and do not predict where they lead. */
static void predict(fu_run *run, double h)
{
    const double held = 1.0 - 0.5 / run->scheme.beta;
    for (int i = 0; i < run->model->n_dof; ++i) run->next.a[i] = held * run->now.a[i];
    fu_predict_extra(run, h);
    fu_seat_slides(run);
}

static void step_residual(fu_run *run, double h)
{
    residual(run, 1.0, sigma(&run->scheme, h));
}

static const fu_newton newton = {predict, kinematics, step_residual, newton_matrix, apply, 12, 0};

static int step(fu_run *run, double h)
{
    return fu_is_short(run, h) ? fu_coast(run, h) : fu_newton_step(run, &newton, h);
}

/* Local error of positions, m: h^2 |beta + (alpha_m - alpha_f)/2 - 1/6| (q''_n+1 - q''_n). Where a slide has changed its
 * element the accelerations have jumped at some instant of the step, and velocities are wrong by the part of h that lies
 * between it and the middle, times the jump. That counts as over one step: what is allowed is h/t of the whole. */
static double error(fu_run *run, double h)
{
    const fu_genalpha *g = &run->scheme;
    const double smooth = fabs(g->beta + 0.5 * (g->alpha_m - g->alpha_f) - 1.0 / 6.0);
    const double factor = h * h * (fu_count_changes(run) ? JUMP : smooth);
    for (int i = 0; i < run->model->n_dof; ++i)
        run->work[i] = factor * (run->next.acceleration[i] - run->now.acceleration[i]);
    return fu_is_short(run, h) ? fu_size(run->model, run->work) : fu_filtered_size(run);
}

static int start(fu_run *run)
{
    memcpy(run->now.a, run->now.acceleration, sizeof(double) * (size_t)run->model->n_dof);
    run->factored = 0;
    return FU_RUNNING;
}

const fu_integrator fu_genalpha_method = {"genalpha", start, step, error, fu_account_trapezoid, 0, 1, &newton};

/* Statics: unknowns move `next`, from where it is. */
void fu_static_move(fu_run *run, const double *change)
{
    const fu_model *model = run->model;
    for (int i = 0; i < run->newton.n + run->newton.m; ++i) run->rhs[i] = change[i];
    fu_spread(model, run->rhs, run->work);
    fu_move(model, run->next.q, run->work);
    fu_apply_extra(run, 0.0, 1.0);
    if (model->n_resistances) fu_touch_buffers(model, &run->next);
}

/* minus the sum of forces and the joints' residuals, in run->rhs */
void fu_static_residual(fu_run *run)
{
    residual(run, 0.0, 1.0);
}

/* the matrix of these weights at `next`, unfactored, in run->newton; unknowns move bodies from there */
void fu_matrix(fu_run *run, fu_weights weights)
{
    matrix(run, weights, 0);
    run->factored = 0;
}
