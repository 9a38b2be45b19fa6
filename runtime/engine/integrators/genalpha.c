/* Generalised-alpha, index 3, on the group of configurations (Chung & Hulbert 1993; Arnold & Bruels 2007; Bruels &
 * Cardona 2010).
 *     psi = h v_n + h^2 ((1/2 - beta) a_n + beta a_n+1),   q_n+1 = q_n moved by psi,
 *     v_n+1 = v_n + h ((1 - gamma) a_n + gamma a_n+1),
 *     (1 - alpha_m) a_n+1 + alpha_m a_n = (1 - alpha_f) q''_n+1 + alpha_f q''_n,
 * with equilibrium and constraints at t_n+1.
 *
 * Unknowns of the Newton iteration: psi, and per slide s and f~, with the force f = f~ mass/sigma and sigma = beta
 * h^2 (1 - alpha_f)/(1 - alpha_m). Rows of equilibrium are multiplied by sigma, constraint rows by the mass: the
 * matrix is M + sigma K bordered by mass C_q, of one scale for any h (Bottasso, Dopico & Trainelli 2008). Later
 * steps compensate Newton's remaining residual (carried_residual.c).
 *
 * In vibrations that steps do not resolve, h a_n has the size of velocities for any h. If a step is much shorter
 * than the next one, such as one between an event and an output time, its a_n+1 would change the next one by the
 * ratio of both, and vibrations would grow from event to event, the more so the stiffer a cable is. After such a
 * step its initial a_n continues, without a restart of the scheme by a_n = q''_n, which contains the full
 * acceleration of vibrations. */
#include "base/simd.h"
#include "base/workspace.h"
#include "bodies/rotation.h"
#include "couplings/common/couplings.h"
#include "equations/equations.h"
#include "equations/run.h"
#include "equations/step_control.h"
#include "events/events.h"
#include "integrators/carried_residual.h"
#include "integrators/extrapolation.h"
#include "integrators/generalised_alpha.h"

#include <math.h>
#include <string.h>

/* of the usual step: a shorter one keeps a_n, with an error below that of the usual step */
#define SHORT_STEP_SHARE 0.1

/* The integrator's work space. */
typedef struct {
    fu_carried_residual carried;
    fu_extrapolation past;
} workspace;

/* Places its arrays in the scratch, unless it is null; returns their number of doubles. */
static long lay_out(const fu_run *run, double *scratch, workspace *w)
{
    long taken = 0;
    fu_carried_residual_take(&w->carried, run->model, scratch, &taken);
    fu_extrapolation_take(&w->past, run->model, scratch, &taken);
    return taken;
}

static long n_scratch(const fu_run *run)
{
    workspace unused;
    return lay_out(run, NULL, &unused);
}

static workspace space(const fu_run *run)
{
    workspace w;
    lay_out(run, run->scratch, &w);
    return w;
}

/* Kinematics that threads share. */
typedef struct {
    fu_run *run;
    double h;
} share;

FU_INLINE void take_steps(const fu_run *run, double h, int first, int end)
{
    const fu_alpha_scheme *g = fu_alpha_scheme_of(run);
    const fu_state *now = &run->now, *next = &run->next;
    const double over = 1.0 / (1.0 - g->alpha_f), slope = over * (1.0 - g->alpha_m);
    const double slope_now = over * g->alpha_m, share_before = over * g->alpha_f;
    const double by_now = h * h * (0.5 - g->beta), by_next = h * h * g->beta;
    const double rate_now = h * (1.0 - g->gamma), rate_next = h * g->gamma;
    const double *v = now->v, *a = now->a, *before = now->acceleration, *change = next->a;
    double *restrict psi = run->psi, *restrict velocity = next->v, *restrict acceleration = next->acceleration;
    int i = first;
    for (; i + FU_SIMD_WIDTH <= end; i += FU_SIMD_WIDTH) {
        const fu_simd_block vi = *(const fu_simd_block *)(v + i), ai = *(const fu_simd_block *)(a + i),
                            ci = *(const fu_simd_block *)(change + i), bi = *(const fu_simd_block *)(before + i);
        *(fu_simd_block *)(psi + i) = h * vi + by_now * ai + by_next * ci;
        *(fu_simd_block *)(velocity + i) = vi + rate_now * ai + rate_next * ci;
        *(fu_simd_block *)(acceleration + i) = slope * ci + slope_now * ai - share_before * bi;
    }
    for (; i < end; ++i) {
        psi[i] = h * v[i] + by_now * a[i] + by_next * change[i];
        velocity[i] = v[i] + rate_now * a[i] + rate_next * change[i];
        acceleration[i] = slope * change[i] + slope_now * a[i] - share_before * before[i];
    }
}

/* Computes psi, v and q'' of the dofs [first, end). */
static void step_dofs(const fu_run *run, double h, int first, int end);
FU_SIMD_FUNCTION(step_dofs, take_steps, (const fu_run *run, double h, int first, int end), (run, h, first, end))

/* Computes psi, v and q'' of a part of the dofs, and q before it is moved. */
static void kinematics_part(const void *what, int part, int parts)
{
    const share *job = what;
    const fu_run *run = job->run;
    const fu_range range = fu_part_of(run->model->n_dof, FU_DOFS_APART, part, parts);
    const int end = part + 1 < parts ? range.end : run->model->n_q; /* coordinates of cables are dofs, and come first */
    step_dofs(run, job->h, range.first, range.end);
    memcpy(run->next.q + range.first, run->now.q + range.first, sizeof(double) * (size_t)(end - range.first));
}

/* Computes q, v and q'' of `next` from its a. */
static void kinematics(fu_run *run, double h)
{
    const fu_model *model = run->model;
    fu_state *next = &run->next;
    const share job = {run, h};
    fu_share(model->threads, model->n_dof, kinematics_part, &job);
    fu_move(model, next->q, run->psi);
    if (model->n_motions) fu_prescribe(model, next);
    if (fu_update_deferred(run, 1)) run->factored = 0; /* the matrix belongs to the flags with which it was computed */
}

/* Returns the equations at the end of a step. */
static fu_equations equations(const fu_run *run, double h)
{
    const fu_alpha_scheme *g = fu_alpha_scheme_of(run);
    return (fu_equations){&run->now, &run->next, 0, run->psi, h, {1.0, g->gamma / (g->beta * h), fu_alpha_sigma(g, h)}};
}

static void matrix(fu_run *run, double h)
{
    const fu_equations at = equations(run, h);
    fu_matrix(run, &at);
}

/* Applies the solution in run->rhs to `next`; returns its size as a length. */
static double apply(fu_run *run, double h)
{
    const double per_psi = 1.0 / (fu_alpha_scheme_of(run)->beta * h * h), size = fu_spread_size(run);
    fu_add_times(run->model->threads, run->model->n_dof, per_psi, run->work, run->next.a);
    fu_add_solution(run, 1.0, fu_alpha_sigma(fu_alpha_scheme_of(run), h));
    fu_choose_path_segments(run);
    return size;
}

/* Returns the factor of a_n in a_n+1 for psi = h v. */
static double of_velocities(const fu_run *run)
{
    return 1.0 - 0.5 / fu_alpha_scheme_of(run)->beta;
}

static void predict(fu_run *run, double h)
{
    const workspace w = space(run);
    fu_extrapolate(&w.past, run, of_velocities(run), h);
    fu_choose_path_segments(run);
    fu_carried_residual_correct(&w.carried, run->model, h);
}

static void residual(fu_run *run, double h)
{
    const fu_equations at = equations(run, h);
    fu_residual(run, &at);
    const workspace w = space(run);
    fu_carried_residual_add(&w.carried, run, at.weights.stiffness);
}

/* Computes minus the residual of the couplings' internal equations, and zero for the dofs. */
static void internal_residual(fu_run *run, double h)
{
    const fu_equations at = equations(run, h);
    fu_coupling_residuals(run->model, &at, run->force, fu_internal_unknowns(run));
    memset(run->rhs, 0, sizeof(double) * (size_t)(run->model->n_band + run->model->n_border_dof));
}

static void note_rest(fu_run *run, double h)
{
    const workspace w = space(run);
    fu_carried_residual_note(&w.carried, run, fu_alpha_sigma(fu_alpha_scheme_of(run), h));
}

static const fu_newton newton = {predict, kinematics, residual, matrix, apply, 12, 0, note_rest, internal_residual};

static int step(fu_run *run, double h)
{
    if (!fu_is_short(run, h)) return fu_newton_step(run, &newton, h);
    const workspace w = space(run);
    fu_carried_residual_note_none(&w.carried, run->model);
    memcpy(run->next.a, run->now.a, sizeof(double) * (size_t)run->model->n_dof);
    return fu_coast(run, h);
}

/* Returns the local error of positions, m. */
static double error(fu_run *run, double h)
{
    const double factor = h * h * fu_alpha_error_factor(run);
    fu_set_difference(run->model->threads, run->model->n_dof, factor, run->next.acceleration, run->now.acceleration,
                      run->work);
    return fu_is_short(run, h) ? fu_error_size(run, run->work, fu_allowed_elsewhere(run)) : fu_filtered_size(run);
}

/* Deferred events do not need the change of the trapezoidal rule by the spectral radius. */
static void account(fu_run *run, double h)
{
    const workspace w = space(run);
    fu_carried_residual_accept(&w.carried, run->model, h);
    if (run->is_remainder && h < SHORT_STEP_SHARE * run->usual)
        memcpy(run->next.a, run->now.a, sizeof(double) * (size_t)run->model->n_dof);
    else if (fu_goes_on(run)) fu_extrapolation_accept(&w.past, run, of_velocities(run), h);
    else fu_extrapolation_start(&w.past);
    fu_account_trapezoid(run, h);
}

static int start(fu_run *run)
{
    const workspace w = space(run);
    if (run->statistics.steps == 0) fu_carried_residual_start(&w.carried, run->model);
    fu_extrapolation_start(&w.past);
    memcpy(run->now.a, run->now.acceleration, sizeof(double) * (size_t)run->model->n_dof);
    run->factored = 0;
    return FU_RUNNING;
}

const fu_integrator fu_genalpha = {.name = "genalpha",
                                   .n_parameters = fu_alpha_parameters,
                                   .n_scratch = n_scratch,
                                   .start = start,
                                   .step = step,
                                   .error = error,
                                   .quadrature = fu_alpha_quadrature,
                                   .account = account,
                                   .has_matrix = 1,
                                   .crosses_boundaries = 1,
                                   .keeps_scratch = 1,
                                   .coasts = 1,
                                   .newton = &newton};
