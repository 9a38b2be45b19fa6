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
#define _POSIX_C_SOURCE 199309L
#include "engine.h"

#include <time.h>

#define MOST_ITERATIONS 12
#define TOO_MANY_ITERATIONS 3 /* a step that took more than these has the matrix made anew for the next */

double fu_clock(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

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
    for (int i = 0; i < model->n_dof; ++i) {
        run->psi[i] = h * now->v[i] + h * h * ((0.5 - g->beta) * now->a[i] + g->beta * next->a[i]);
        next->v[i] = now->v[i] + h * ((1.0 - g->gamma) * now->a[i] + g->gamma * next->a[i]);
        next->acceleration[i] = ((1.0 - g->alpha_m) * next->a[i] + g->alpha_m * now->a[i] -
                                 g->alpha_f * now->acceleration[i]) / (1.0 - g->alpha_f);
    }
    const int n_flexible = model->n_dof - 6 * model->n_rigids;
    for (int i = 0; i < n_flexible; ++i) next->q[i] = now->q[i] + run->psi[i];
    for (int b = 0; b < model->n_rigids; ++b) {
        const fu_rigid *body = &model->rigids[b];
        fu_move_rigid(now->q + body->configuration, run->psi + body->dof, next->q + body->configuration);
    }
}

/* places of a joint's coordinates among the unknowns: element, rider, s */
static void joint_places(const fu_run *run, int j, int *place)
{
    const fu_model *model = run->model;
    const fu_joint *joint = &model->joints[j];
    const fu_cable *cable = &model->cables[joint->cable];
    const int n = cable->coordinates, at = cable->first + run->next.element[j] * cable->per_node;
    for (int i = 0; i < n; ++i) place[i] = model->place[at + i];
    for (int i = 0; i < 6; ++i) place[n + i] = model->place[model->rigids[joint->rider].dof + i];
    place[n + 6] = model->n_band + model->n_border_dof + 4 * j;
}

/* minus the scaled residual, over the unknowns */
static void residual(fu_run *run, double h)
{
    const double begin = fu_clock(), scale = sigma(&run->scheme, h);
    const fu_model *model = run->model;
    const fu_state *next = &run->next;
    double phi[3], g[FU_MAX_COORDINATES];
    fu_mass_times(model, next->acceleration, run->force);
    fu_internal_forces(model, next->q, next->v, run->force);
    fu_external_forces(model, run->force);
    for (int i = 0; i < model->n_dof; ++i)
        if (model->place[i] >= 0) run->rhs[model->place[i]] = -scale * run->force[i];
    for (int j = 0; j < model->n_joints; ++j) {
        const fu_joint *joint = &model->joints[j];
        const fu_cable *cable = &model->cables[joint->cable];
        const int at = cable->first + next->element[j] * cable->per_node;
        int place[FU_MAX_COORDINATES];
        joint_places(run, j, place);
        joint->kernel->residual(cable->length, next->s[j] - fu_element_start(model, j, next->element[j]),
                                next->q + at, next->q + model->rigids[joint->rider].configuration, joint->u,
                                next->f + 3 * j, phi, g);
        const int s = joint->kernel->coordinates;
        for (int i = 0; i < s; ++i)
            if (place[i] >= 0) run->rhs[place[i]] -= scale * g[i];
        run->rhs[place[s]] = -scale * g[s];
        for (int d = 0; d < 3; ++d) run->rhs[place[s] + 1 + d] = -joint->mass * phi[d];
    }
    run->statistics.time_residual += fu_clock() - begin;
}

/* columns of the rider's rotation: a change of psi turns the body by T dpsi */
static void turn_columns(double *rows, int n_rows, int n_columns, int first, const double T[9])
{
    for (int r = 0; r < n_rows; ++r) {
        double *p = rows + r * n_columns + first;
        const double x = p[0], y = p[1], z = p[2];
        for (int d = 0; d < 3; ++d) p[d] = x * T[d] + y * T[3 + d] + z * T[6 + d];
    }
}

/* the Newton matrix at `next`: derivative of the scaled residual by the unknowns */
static void newton_matrix(fu_run *run, double h)
{
    const double scale = sigma(&run->scheme, h);
    const fu_model *model = run->model;
    const fu_state *next = &run->next;
    fu_system *system = &run->newton;
    double J[3 * FU_MAX_COORDINATES], K[FU_MAX_COORDINATES * FU_MAX_COORDINATES], T[9];
    fu_system_clear(system);
    fu_dynamic_matrix(model, next->q, next->v, 1.0, run->scheme.gamma / (run->scheme.beta * h), scale, system);
    for (int j = 0; j < model->n_joints; ++j) {
        const fu_joint *joint = &model->joints[j];
        const fu_cable *cable = &model->cables[joint->cable];
        const int at = cable->first + next->element[j] * cable->per_node;
        const int s = joint->kernel->coordinates, n = s + 1;
        int place[FU_MAX_COORDINATES];
        joint_places(run, j, place);
        joint->kernel->tangent(cable->length, next->s[j] - fu_element_start(model, j, next->element[j]),
                               next->q + at, next->q + model->rigids[joint->rider].configuration, joint->u,
                               next->f + 3 * j, J, K);
        for (int i = 0; i < n; ++i)
            for (int d = 0; d < 3; ++d) fu_system_add(system, place[i], place[s] + 1 + d, joint->mass * J[d * n + i]);
        fu_exponential_tangent(run->psi + model->rigids[joint->rider].dof + 3, T);
        turn_columns(J, 3, n, s - 3, T);
        turn_columns(K, n, n, s - 3, T);
        for (int i = 0; i < n; ++i) {
            for (int d = 0; d < 3; ++d) fu_system_add(system, place[s] + 1 + d, place[i], joint->mass * J[d * n + i]);
            for (int k = 0; k < n; ++k)
                if (K[i * n + k] != 0.0) fu_system_add(system, place[i], place[k], scale * K[i * n + k]);
        }
    }
}

static int factor(fu_run *run, double h)
{
    const double begin = fu_clock();
    newton_matrix(run, h);
    int info = fu_system_factor_band(&run->newton, run->model->lapack);
    if (!info) info = fu_system_factor_border(&run->newton, run->model->lapack);
    run->factored = !info;
    run->h_factored = h;
    ++run->statistics.factorisations;
    run->statistics.time_factor += fu_clock() - begin;
    return info;
}

/* the solution in run->rhs, applied to `next`; returns its size as a length */
static double apply(fu_run *run, double h)
{
    const fu_model *model = run->model;
    const double per_psi = 1.0 / (run->scheme.beta * h * h), scale = sigma(&run->scheme, h);
    double largest = 0.0;
    for (int i = 0; i < model->n_dof; ++i) {
        if (model->place[i] < 0) continue;
        const double d = run->rhs[model->place[i]], size = fabs(d) * model->weight[i];
        run->next.a[i] += per_psi * d;
        if (!(size <= largest)) largest = size; /* keeps a NaN */
    }
    for (int j = 0; j < model->n_joints; ++j) {
        const double *d = run->rhs + model->n_band + model->n_border_dof + 4 * j;
        run->next.s[j] += d[0];
        if (!(fabs(d[0]) <= largest)) largest = fabs(d[0]);
        for (int k = 0; k < 3; ++k) {
            run->next.f[3 * j + k] += d[1 + k] * model->joints[j].mass / scale;
            if (!(fabs(d[1 + k]) <= largest)) largest = fabs(d[1 + k]);
        }
    }
    return largest;
}

static void predict(fu_run *run, double h)
{
    const fu_model *model = run->model;
    for (int i = 0; i < model->n_dof; ++i) run->next.a[i] = run->now.a[i];
    for (int j = 0; j < model->n_joints; ++j) {
        run->next.s[j] = run->now.s[j] + h * run->s_slope[j];
        run->next.element[j] = run->now.element[j];
        for (int k = 0; k < 3; ++k) {
            run->next.f[3 * j + k] = run->now.f[3 * j + k];
            run->next.director[3 * j + k] = run->now.director[3 * j + k];
        }
    }
}

/* Newton from the prediction with the matrix at hand; 0 when it converged */
static int iterate(fu_run *run, double h)
{
    double last = 0.0;
    for (int i = 0; i < MOST_ITERATIONS; ++i) {
        kinematics(run, h);
        residual(run, h);
        if (!run->factored) {
            if (factor(run, h)) return 1;
            run->contraction = 0.5; /* nothing is known yet: do not stop after one iteration */
        }
        const double begin = fu_clock();
        fu_system_solve(&run->newton, run->model->lapack, run->rhs);
        run->statistics.time_solve += fu_clock() - begin;
        const double size = apply(run, h);
        ++run->statistics.newton_iterations;
        if (!(size < 1e30)) return 1;
        if (i > 0) {
            const double ratio = size / last;
            if (ratio >= 1.0 && size > 100.0 * run->round_off) return 1;
            run->contraction = ratio < 1e-3 ? 1e-3 : ratio > 0.9 ? 0.9 : ratio;
        }
        if (size * run->contraction / (1.0 - run->contraction) <= run->newton_tolerance || size <= run->round_off) {
            kinematics(run, h);
            if (i + 1 > TOO_MANY_ITERATIONS) run->factored = 0;
            return 0;
        }
        last = size;
    }
    return 1;
}

/* For tests of the matrix: the residual after moving the predicted step by `change` (unknowns), in run->rhs with
 * its sign turned, and the unfactored matrix there in run->newton. */
void fu_linearise(fu_run *run, double h, const double *change)
{
    predict(run, h);
    for (int i = 0; i < run->model->n_band + run->model->n_border_dof + 4 * run->model->n_joints; ++i)
        run->rhs[i] = change[i];
    apply(run, h);
    kinematics(run, h);
    newton_matrix(run, h);
    residual(run, h);
    run->factored = 0;
}

/* One step of size h from `now` to `next`; 0 when the Newton iteration converged. */
int fu_step(fu_run *run, double h)
{
    if (fabs(h - run->h_factored) > 1e-6 * h) run->factored = 0;
    const int stale = run->factored;
    predict(run, h);
    if (!iterate(run, h)) return 0;
    if (stale) { /* the matrix was of an earlier step: make it here before giving up */
        run->factored = 0;
        predict(run, h);
        if (!iterate(run, h)) return 0;
    }
    run->factored = 0;
    ++run->statistics.newton_failures;
    return 1;
}

/* Local error of positions, m: h^2 |beta + (alpha_m - alpha_f)/2 - 1/6| (q''_n+1 - q''_n), passed through
 * (M + sigma K)^-1 M on the constraints' tangent space so that vibrations that the step does not resolve count by
 * their amplitude and not by their acceleration. */
double fu_step_error(fu_run *run, double h)
{
    const fu_model *model = run->model;
    const fu_genalpha *g = &run->scheme;
    const double factor = h * h * fabs(g->beta + 0.5 * (g->alpha_m - g->alpha_f) - 1.0 / 6.0);
    for (int i = 0; i < model->n_dof; ++i)
        run->work[i] = factor * (run->next.acceleration[i] - run->now.acceleration[i]);
    fu_mass_times(model, run->work, run->force);
    for (int i = 0; i < model->n_dof; ++i)
        if (model->place[i] >= 0) run->rhs[model->place[i]] = run->force[i];
    for (int i = 0; i < 4 * model->n_joints; ++i) run->rhs[model->n_band + model->n_border_dof + i] = 0.0;
    const double begin = fu_clock();
    fu_system_solve(&run->newton, model->lapack, run->rhs);
    run->statistics.time_solve += fu_clock() - begin;
    double largest = 0.0;
    for (int i = 0; i < model->n_dof; ++i)
        if (model->place[i] >= 0 && fabs(run->rhs[model->place[i]]) * model->weight[i] > largest)
            largest = fabs(run->rhs[model->place[i]]) * model->weight[i];
    return largest;
}
