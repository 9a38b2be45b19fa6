/* Eq 38: accelerations and multipliers of a state from M, H, W; and other solutions with M and H. */
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/force/force.h"
#include "equations/equations.h"

#include <math.h>
#include <string.h>

#define MAX_SWEEPS 100          /* largest number of sweeps over the couplings whose forces depend on multipliers */
#define ROUNDING_OF_FORCE 1e-15 /* change of R by a sweep, over the force: one that is rounding */
/* the same, sufficient if a sweep changes R no less than the one before */
#define FORCE_TOLERANCE 1e-7
#define DIVERGED 1e30 /* the same, of a sweep that diverges */

void fu_evaluate_rows(const fu_model *model, const fu_state *state, fu_accelerator *work)
{
    ++work->evaluated;
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active) {
        if (c->row < 0) continue;
        fu_rows *rows = &work->rows[c->row];
        rows->first = c->multiplier;
        rows->max_multipliers = rows->rows = c->n_multipliers;
        rows->redundant_rows = 0;
        rows->slide = -1;
        rows->by_push = 0;
        rows->is_pushed = 0;
        memset(rows->soft, 0, sizeof rows->soft);
        rows->opposed = 0.0;
        memcpy(rows->scale, c->scale, sizeof rows->scale);
        c->type->rows(model, c, state, work);
    }
}

/* Factors the band of M once, and solves for the constant columns of its border: those of the cables, and of rigid
 * bodies in body axes. Returns 0, or nonzero if the band is not positive definite. */
int fu_accelerator_prepare(const fu_model *model, fu_accelerator *work)
{
    fu_system *s = &work->mass;
    fu_system_release_border(s);
    s->inverted = 0;
    if (model->n_inertial) return 0; /* no part of it is constant */
    fu_system_clear(s);
    fu_dynamic_matrix(model, model->zero, model->zero, 1.0, 0.0, 0.0, s);
    fu_bodies_mass(model, model->zero, 1, s);
    memcpy(work->corner, s->D, sizeof(double) * (size_t)s->fronts->size);
    if (fu_system_factor_band(s)) return 1;
    fu_system_invert_band(s);
    fu_system_keep_border(s, model->n_border_dof);
    return !s->definite; /* otherwise it would be in K, which the Newton matrix overwrites */
}

/* Computes all of M at a state with inertia of couplings, and factors its band; returns 0, or nonzero if it is not
 * positive definite. */
static int whole(const fu_model *model, double t, const double *q, fu_accelerator *work)
{
    fu_system *s = &work->mass;
    fu_system_clear(s);
    fu_dynamic_matrix(model, q, model->zero, 1.0, 0.0, 0.0, s);
    for (int constant = 0; constant < 2; ++constant) fu_bodies_mass(model, q, constant, s);
    fu_coupling_masses(model, t, q, 1.0, s);
    return fu_system_factor_band(s) || !s->definite;
}

/* Computes the border of M, and the band if it depends on the configuration; returns 0, or nonzero if that is not
 * definite. */
static int border(const fu_model *model, double t, const double *q, fu_accelerator *work)
{
    fu_system *s = &work->mass;
    if (model->n_inertial) return whole(model, t, q, work);
    fu_system_clear_border(s);
    memcpy(s->D, work->corner, sizeof(double) * (size_t)s->fronts->size);
    fu_bodies_mass(model, q, 0, s);
    return 0;
}

/* Computes and factors the border of [M H'; H 0] (eq 11) at a state with evaluated terms. */
static int factor_border(const fu_model *model, const fu_state *state, fu_accelerator *work)
{
    fu_system *s = &work->mass;
    if (border(model, state->t, state->q, work)) return 1;
    for (int r = 0; r < model->n_rows; ++r) {
        const fu_rows *rows = &work->rows[r];
        for (int c = 0; c < rows->max_multipliers; ++c) {
            const int row = fu_extra(model, rows->first + c);
            if (c >= rows->rows || rows->redundant_rows >> c & 1)
                fu_add(model, s, row, row, rows->scale[c]); /* inactive: its multiplier is zero */
            else if (rows->is_pushed && !c)
                for (int k = 0; k < rows->n; ++k) {
                    fu_add(model, s, row, rows->at[k], rows->scale[c] * rows->H[k]);
                    fu_add(model, s, rows->at[k], row, rows->scale[c] * rows->column[k]);
                }
            else /* rows in kg give the border one scale */
                fu_add_row_and_column(model, s, row, rows->n, rows->at, rows->H + c * rows->n, rows->scale[c]);
            if (c < rows->rows && rows->soft[c] != 0.0)
                fu_add(model, s, row, row, -rows->soft[c] * rows->scale[c] * rows->scale[c]);
        }
    }
    return fu_system_factor_border(s, model->lapack);
}

static void scale_multipliers(const fu_model *model, const fu_accelerator *work, double *lambda)
{
    for (int r = 0; r < model->n_rows; ++r)
        for (int c = 0; c < work->rows[r].max_multipliers; ++c)
            lambda[work->rows[r].first + c] *= work->rows[r].scale[c];
}

/* Solves [M H'; H 0] with forces on the dofs and right sides of the joints; multipliers are scaled back. */
static void solve(const fu_model *model, fu_accelerator *work, const double *force, double *solution)
{
    double *x = work->rhs, *lambda = x + model->n_band + model->n_border_dof;
    fu_gather(model, force, x);
    scale_multipliers(model, work, lambda);
    fu_system_solve(&work->mass, model->lapack, x);
    fu_spread(model, x, solution);
    scale_multipliers(model, work, lambda);
}

/* Returns -sum_k H_ck x_k, the contribution of known accelerations or velocities to the right sides. */
static double minus_H(const fu_rows *rows, int c, const double *x)
{
    double sum = 0.0;
    for (int k = 0; k < rows->n; ++k) sum -= rows->H[c * rows->n + k] * x[rows->at[k]];
    return sum;
}

/* Adds the forces that depend on these multipliers to work->work; null: on those of the state. Returns the largest
 * change relative to the force, of the coupling work->self_locking. */
static double update_reaction_forces(const fu_model *model, const fu_state *state, fu_accelerator *work,
                                     const double *lambda)
{
    double largest = 0.0;
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active) {
        if (!c->type->reaction) continue;
        const double size = c->type->reaction->update(model, c, state, lambda, work);
        if (size == 0.0 || size <= largest) continue;
        largest = size;
        work->self_locking = c->number;
    }
    return largest;
}

static void solve_with_reactions(const fu_model *model, const fu_state *state, fu_accelerator *work,
                                 const double *lambda)
{
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active)
        if (c->type->reaction) c->type->reaction->accept(model, c, state, lambda, work);
}

/* Solves for accelerations and multipliers, in work->rhs, with the forces in work->work; by sweeps if friction depends
 * on the multipliers. Returns nonzero if these do not converge: if friction increases the normal force on the rider by
 * more than its own cause, there is no solution (Painleve's paradox). */
static int solve_friction(const fu_model *model, const fu_state *state, fu_accelerator *work, double *acceleration)
{
    double *lambda = work->rhs + model->n_band + model->n_border_dof, last = INFINITY;
    if (model->n_needing_reactions) update_reaction_forces(model, state, work, 0);
    for (int sweep = 0;; ++sweep) {
        for (int r = 0; r < model->n_rows; ++r)
            for (int c = 0; c < work->rows[r].max_multipliers; ++c)
                lambda[work->rows[r].first + c] =
                    c < work->rows[r].rows ? work->rows[r].W[c] + minus_H(&work->rows[r], c, work->prescribed) : 0.0;
        solve(model, work, work->work, acceleration);
        if (!model->n_needing_reactions) return 0;
        const double change = update_reaction_forces(model, state, work, lambda);
        if (change <= ROUNDING_OF_FORCE || (change <= FORCE_TOLERANCE && change >= last)) break;
        if (!(change < DIVERGED) || sweep == MAX_SWEEPS) return 1;
        last = change;
    }
    work->self_locking = -1;
    return 0;
}

/* Computes S = H M^-1 H' (n x n) at a state, of n multipliers: singular for redundant joints. at: row of S of each
 * multiplier, -1 for none. */
int fu_compliance(const fu_model *model, const fu_state *state, fu_accelerator *work, const int *at, int n, double *S)
{
    fu_system *s = &work->mass;
    const int all = model->n_multipliers;
    fu_evaluate_rows(model, state, work);
    if (border(model, state->t, state->q, work)) return 1;
    for (int k = 0; k < all; ++k)
        fu_add(model, s, fu_extra(model, k), fu_extra(model, k), 1.0); /* M alone, without multipliers */
    const int info = fu_system_factor_border(s, model->lapack);
    for (int r = 0; r < model->n_rows && !info; ++r) {
        const fu_rows *rows = &work->rows[r];
        for (int c = 0; c < rows->rows; ++c) {
            const double *H = rows->H + c * rows->n;
            if (at[rows->first + c] < 0) continue;
            for (int i = 0; i < model->n_dof; ++i) work->work[i] = 0.0;
            for (int k = 0; k < rows->n; ++k) work->work[rows->at[k]] += H[k];
            fu_gather(model, work->work, work->rhs);
            memset(work->rhs + model->n_band + model->n_border_dof, 0, sizeof(double) * (size_t)all);
            fu_system_solve(s, model->lapack, work->rhs);
            fu_spread(model, work->rhs, work->work);
            for (int i = 0; i < model->n_rows; ++i)
                for (int d = 0; d < work->rows[i].rows; ++d)
                    if (at[work->rows[i].first + d] >= 0)
                        S[(long)at[rows->first + c] * n + at[work->rows[i].first + d]] =
                            -minus_H(&work->rows[i], d, work->work);
        }
    }
    return info;
}

/* Computes the force of the supports on each dof, zero to rounding on free ones. */
static void reactions(const fu_model *model, const fu_state *state, fu_accelerator *work, const double *acceleration,
                      const double *lambda, double *reaction)
{
    fu_mass_times(model, state->t, state->q, acceleration, work->work);
    for (int i = 0; i < model->n_dof; ++i) reaction[i] = work->work[i] + work->force[i]; /* M q'' - Q (eq 26) */
    for (int r = 0; r < model->n_rows; ++r) {                                            /* + H' lambda (eq 32) */
        const fu_rows *rows = &work->rows[r];
        for (int c = 0; c < rows->rows; ++c)
            for (int k = 0; k < rows->n; ++k)
                reaction[rows->at[k]] +=
                    (rows->is_pushed && !c ? rows->column : rows->H + c * rows->n)[k] * lambda[rows->first + c];
        for (int k = 0; k < rows->n && rows->by_push; ++k) reaction[rows->at[k]] -= rows->by_push[k] * rows->push;
    }
}

/* Solves eq 38 for accelerations and multipliers, and computes the reactions of supports, unless `reaction` is null;
 * returns 0 if there is one solution. */
int fu_accelerations(const fu_model *model, const fu_state *state, fu_accelerator *work, double *acceleration,
                     double *reaction)
{
    double *lambda = work->rhs + model->n_band + model->n_border_dof, *prescribed = work->prescribed;
    work->self_locking = -1;
    fu_evaluate_rows(model, state, work);
    const int info = factor_border(model, state, work);
    if (info) return info;
    for (int i = 0; i < model->n_dof; ++i) work->force[i] = prescribed[i] = work->work[i] = 0.0;
    /* - Q_k - Q_d - Q_e (eq 9) */
    fu_internal_forces(model, state->q, state->v, work->force);
    fu_coupling_forces(model, state, work->force);
    fu_external_forces(model, state->t, state->q, work->force);
    int accelerated = 0;
    for (int k = 0; k < model->n_motions; ++k) {
        const int dof = model->motions[k].dof;
        prescribed[dof] = state->acceleration[dof];
        accelerated |= prescribed[dof] != 0.0;
    }
    if (accelerated) fu_mass_times(model, state->t, state->q, prescribed, work->work);
    for (int i = 0; i < model->n_dof; ++i) work->work[i] = -work->force[i] - work->work[i];
    if (solve_friction(model, state, work, acceleration)) return 1;
    solve_with_reactions(model, state, work, lambda);
    for (int i = 0; i < model->n_dof; ++i) acceleration[i] += prescribed[i];
    memcpy(work->multipliers, lambda, sizeof(double) * (size_t)model->n_multipliers);
    if (reaction) reactions(model, state, work, acceleration, lambda, reaction);
    return 0;
}

/* Prepares fu_response at a state; returns 0 if there is one solution. */
int fu_prepare_response(const fu_model *model, const fu_state *state, fu_accelerator *work)
{
    fu_evaluate_rows(model, state, work);
    return factor_border(model, state, work);
}

/* Computes `change`, the jump of velocities (or the accelerations) by impulses (or forces) on the dofs at unchanged
 * constraints. */
void fu_response(const fu_model *model, fu_accelerator *work, const double *force, double *change)
{
    double *lambda = work->rhs + model->n_band + model->n_border_dof;
    memset(lambda, 0, sizeof(double) * (size_t)model->n_multipliers);
    solve(model, work, force, change);
}

/* A constraint under impact, and its rate of separation. */
typedef struct {
    int row, constraint;
    double rate;
} strike;

/* Computes `change`, the smallest change of the dofs in the mass norm with H change = -C_m, or, for velocities, -H v;
 * the constraint under impact, `struck`, which may be null, gets its rate */
static int project(const fu_model *model, const fu_state *state, fu_accelerator *work, int of_velocities,
                   const strike *struck, double *change)
{
    double *lambda = work->rhs + model->n_band + model->n_border_dof;
    fu_evaluate_rows(model, state, work);
    const int info = factor_border(model, state, work);
    if (info) return info;
    if (struck) work->rows[struck->row].rate[struck->constraint] = struck->rate;
    for (int i = 0; i < model->n_dof; ++i) work->work[i] = 0.0;
    for (int r = 0; r < model->n_rows; ++r) {
        const fu_rows *rows = &work->rows[r];
        for (int c = rows->rows; c < rows->max_multipliers; ++c) lambda[rows->first + c] = 0.0;
        for (int c = 0; c < rows->rows; ++c)
            lambda[rows->first + c] = of_velocities ? minus_H(rows, c, state->v) - rows->rate[c] : -rows->C[c];
    }
    solve(model, work, work->work, change);
    return 0;
}

/* Computes `change`, an increment of the dofs that makes constraints zero to first order */
int fu_project_positions(const fu_model *model, const fu_state *state, fu_accelerator *work, double *change)
{
    return project(model, state, work, 0, 0, change);
}

/* Computes `change`, a change of v with H v = 0, or minus the rate of their drives */
int fu_project_velocities(const fu_model *model, const fu_state *state, fu_accelerator *work, double *change)
{
    return project(model, state, work, 1, 0, change);
}

/* Computes `change` of v by an impact of a constraint: M change + H' L = 0, so that the impulses of constraints alone
 * change the momentum; minus `rate` is the rate of that constraint afterwards */
int fu_strike(const fu_model *model, const fu_state *state, fu_accelerator *work, int row, int constraint, double rate,
              double *change)
{
    const strike struck = {row, constraint, rate};
    return project(model, state, work, 1, &struck, change);
}
