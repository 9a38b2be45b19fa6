/* Eq 38: accelerations and multipliers of a state, from M, H, W; and what else needs M and H. */
#include "engine.h"

#include <string.h>

#define MOST_SWEEPS 100
#define TRIAL 0.1     /* of the change that the law asks for: the first step, lest it turn the normal force round */
#define STEEP 0.1     /* slopes below have no secant that is worth it */
#define SETTLED 1e-15 /* change of R by a sweep, over the force */
#define NEARLY 1e-7   /* the same where rounding may rule it */

static int n_rows(const fu_model *model)
{
    return model->n_slides + model->n_joints;
}

static void evaluate(const fu_model *model, const fu_state *state, fu_accelerator *work)
{
    ++work->evaluated;
    for (int j = 0; j < model->n_slides; ++j) {
        const fu_slide *slide = &model->slides[j];
        fu_rows *rows = &work->rows[j];
        rows->first = slide->multiplier;
        rows->max_multipliers = slide->max_multipliers;
        rows->redundant_rows = 0;
        for (int c = 0; c < rows->max_multipliers; ++c) rows->scale[c] = slide->mass;
        fu_slide_terms(model, state, j, rows, &work->slide_states[j]);
    }
    for (int k = 0; k < model->n_joints; ++k) {
        const fu_joint *joint = &model->joints[k];
        fu_rows *rows = &work->rows[model->n_slides + k];
        rows->first = joint->multiplier;
        rows->max_multipliers = rows->rows = joint->kernel->rows;
        memcpy(rows->scale, joint->scale, sizeof rows->scale);
        fu_joint_terms(model, joint, state, work->slide_states, work->rows, rows);
    }
}

/* How one slide moves. */
void fu_slide_now(const fu_model *model, const fu_state *state, int j, fu_slide_state *slide_state)
{
    fu_rows unused;
    fu_slide_terms(model, state, j, &unused, slide_state);
}

/* ds/dt of one slide; zero where s is held for good */
double fu_slide_rate(const fu_model *model, const fu_state *state, int j)
{
    fu_slide_state slide_state;
    if (state->mode[j] == FU_LOCKED && model->slides[j].drive < 0) return 0.0;
    fu_slide_now(model, state, j, &slide_state);
    return slide_state.s_rate;
}

/* M is constant, that of rigid bodies by body axes: its band is factored once, and its border's columns are solved. */
int fu_accelerator_prepare(const fu_model *model, fu_accelerator *work)
{
    fu_system *s = &work->mass;
    s->constant = s->constant_columns = s->constant_rows = 0;
    fu_system_clear(s);
    fu_dynamic_matrix(model, model->zero, model->zero, 1.0, 0.0, 0.0, s);
    fu_bodies_mass(model, model->zero, 1, s);
    memcpy(work->corner, s->D, sizeof(double) * (size_t)(s->m * s->m));
    if (fu_system_factor_band(s, model->lapack)) return 1;
    fu_system_keep_border(s, model->lapack, model->n_border_dof);
    return !s->definite; /* else it would be in K, which the Newton matrix takes */
}

/* The border of M. */
static void border(const fu_model *model, const double *q, fu_accelerator *work)
{
    fu_system *s = &work->mass;
    const int n = model->n_border_dof, whole = n + model->n_multipliers;
    fu_system_clear_border(s);
    for (int k = 0; k < n; ++k)
        memcpy(s->D + (long)k * s->m, work->corner + (long)k * whole, sizeof(double) * (size_t)n);
    fu_bodies_mass(model, q, 0, s);
}

/* Border of [M H'; H 0] (eq 11) at a state whose terms are evaluated. */
static int factor_border(const fu_model *model, const fu_state *state, fu_accelerator *work)
{
    fu_system *s = &work->mass;
    border(model, state->q, work);
    for (int r = 0; r < n_rows(model); ++r) {
        const fu_rows *rows = &work->rows[r];
        for (int c = 0; c < rows->max_multipliers; ++c) {
            const int row = fu_extra(model, rows->first + c);
            if (c >= rows->rows || rows->redundant_rows >> c & 1)
                fu_add(model, s, row, row, rows->scale[c]); /* not in use: its multiplier is nil */
            else
                for (int k = 0; k < rows->n; ++k) { /* rows in kg, so that the border is of one scale */
                    fu_add(model, s, row, rows->at[k], rows->scale[c] * rows->H[c * rows->n + k]);
                    fu_add(model, s, rows->at[k], row, rows->scale[c] * rows->H[c * rows->n + k]);
                }
        }
    }
    return fu_system_factor_border(s, model->lapack);
}

/* Solve [M H'; H 0] with forces on the dofs and right sides of the joints; multipliers are scaled back. */
static void solve(const fu_model *model, fu_accelerator *work, const double *force, double *solution)
{
    double *x = work->rhs, *lambda = x + model->n_band + model->n_border_dof;
    fu_gather(model, force, x);
    for (int r = 0; r < n_rows(model); ++r)
        for (int c = 0; c < work->rows[r].max_multipliers; ++c) lambda[work->rows[r].first + c] *= work->rows[r].scale[c];
    fu_system_solve(&work->mass, model->lapack, x);
    fu_spread(model, x, solution);
    for (int r = 0; r < n_rows(model); ++r)
        for (int c = 0; c < work->rows[r].max_multipliers; ++c) lambda[work->rows[r].first + c] *= work->rows[r].scale[c];
}

/* -sum_k H_ck x_k: what the right sides lose to known accelerations or velocities */
static double minus_H(const fu_rows *rows, int c, const double *x)
{
    double sum = 0.0;
    for (int k = 0; k < rows->n; ++k) sum -= rows->H[c * rows->n + k] * x[rows->at[k]];
    return sum;
}

/* The force on a slide's rider. */
static void force_of(const fu_model *model, const fu_accelerator *work, int j, const double *lambda, double *f)
{
    const fu_rows *rows = &work->rows[j];
    const int dim = model->dim;
    const double *by_point = work->slide_states[j].by_point;
    for (int d = 0; d < dim; ++d) {
        f[d] = 0.0;
        for (int c = 0; c < rows->rows; ++c) f[d] -= by_point[c * dim + d] * lambda[rows->first + c];
        if (model->slides[j].resistance) f[d] += by_point[(dim - 1) * dim + d] * work->resistance[j];
    }
}

/* The force along the cable on a slide's rider that comes of joints whose frame goes with the slide, added: what their
 * moments put on s, which stands in their rows as G. */
static void add_force_of_frame(const fu_model *model, const fu_accelerator *work, int j, const double *lambda, double *f)
{
    const int dim = model->dim;
    const double *G = work->slide_states[j].by_point + (dim - 1) * dim;
    for (const fu_rows *rows = work->rows + model->n_slides; rows < work->rows + n_rows(model); ++rows)
        for (int c = 0; c < rows->rows && rows->slide == j; ++c)
            for (int d = 0; d < dim; ++d) f[d] -= G[d] * rows->by_s[c] * lambda[rows->first + c];
}

/* r_x, and the velocity along it, of a slide on its cable */
static void along(const fu_model *model, const fu_slide_state *slide_state, double *t, double *u)
{
    const int dim = model->dim;
    const double *G = slide_state->by_point + (dim - 1) * dim;
    double square = 0.0;
    for (int d = 0; d < dim; ++d) square += G[d] * G[d];
    for (int d = 0; d < dim; ++d) {
        t[d] = G[d] / square;
        u[d] = t[d] * slide_state->s_rate;
    }
}

/* By how much a slide's R should change where its law asks for `change`: by the secant of the last sweep, as what friction
 * presses on the cable or takes off it hangs on R almost linearly. */
static double towards(fu_accelerator *work, int n_slides, int j, double change)
{
    double *last = work->resistance + n_slides + 1 + 2 * j;
    const double slope = last[0] != 0.0 ? (last[1] - change) / last[0] : 0.0;
    last[0] = last[0] == 0.0 ? TRIAL * change : slope > STEEP ? change / slope : change;
    last[1] = change;
    return last[0];
}

/* R of the slides that are driven, by these multipliers: of what the force along the cable is, the part that their drives
 * do not give; and what it takes. */
static void resist(const fu_model *model, const fu_state *state, fu_accelerator *work, const double *lambda)
{
    for (int j = 0; j < model->n_slides; ++j) {
        double t[3], u[3], f[3];
        fu_resistance resistance;
        work->driven_resistance[j] = 0.0;
        if (model->slides[j].drive < 0 || !fu_has_resistance(model, state, j)) continue;
        along(model, &work->slide_states[j], t, u);
        force_of(model, work, j, lambda, f);
        fu_resistance_at(model, state, j, t, u, f, &resistance);
        work->driven_resistance[j] = resistance.R;
        work->resistance[model->n_slides] += fu_resistance_power(model, state, j, t, u, f);
    }
}

/* R of all slides by these multipliers, or null: by the forces of the state; work->work follows by G' R. Returns the
 * largest change over the force. */
static double resistance(const fu_model *model, const fu_state *state, fu_accelerator *work, const double *lambda)
{
    double largest = 0.0, *steps = work->resistance + model->n_slides + 1;
    work->resistance[model->n_slides] = 0.0;
    for (int j = 0; j < model->n_slides; ++j) {
        double t[3], u[3], f[3], size = 0.0;
        fu_resistance resistance;
        if (!lambda) work->resistance[j] = steps[2 * j] = 0.0;
        if (!model->slides[j].resistance || state->mode[j] != FU_SLIDES) continue;
        along(model, &work->slide_states[j], t, u);
        if (lambda) force_of(model, work, j, lambda, f);
        else memcpy(f, state->f + 3 * j, sizeof f);
        fu_resistance_at(model, state, j, t, u, f, &resistance);
        work->resistance[model->n_slides] += fu_resistance_power(model, state, j, t, u, f);
        const double change = resistance.R - work->resistance[j];
        const double step = lambda ? towards(work, model->n_slides, j, change) : change;
        for (int d = 0; d < model->dim; ++d) size = fmax(size, fabs(f[d]));
        size = fabs(change) / fmax(size, fabs(resistance.R));
        if (change != 0.0 && !(size <= largest)) {
            largest = size;
            work->jammed = j;
        }
        work->resistance[j] += step;
        for (int k = 0; k < work->rows[j].n; ++k)
            work->work[work->rows[j].at[k]] += work->slide_states[j].G[k] * step;
    }
    return largest;
}

/* Accelerations and multipliers, in work->rhs, by the forces in work->work; with brakes, whose friction hangs on the
 * multipliers, by sweeps. Not zero where these do not settle: where friction presses the rider on the cable by more than
 * what it comes from, there is no solution (Painleve's). */
static int settle(const fu_model *model, const fu_state *state, fu_accelerator *work, double *acceleration)
{
    double *lambda = work->rhs + model->n_band + model->n_border_dof, last = INFINITY;
    if (model->n_resistances) resistance(model, state, work, 0);
    for (int sweep = 0;; ++sweep) {
        for (int r = 0; r < n_rows(model); ++r)
            for (int c = 0; c < work->rows[r].max_multipliers; ++c)
                lambda[work->rows[r].first + c] = c < work->rows[r].rows
                    ? work->rows[r].W[c] + minus_H(&work->rows[r], c, work->prescribed) : 0.0;
        solve(model, work, work->work, acceleration);
        if (!model->n_resistances) return 0;
        const double change = resistance(model, state, work, lambda);
        if (change <= SETTLED || (change <= NEARLY && change >= last)) break;
        if (!(change < 1e30) || sweep == MOST_SWEEPS) return 1;
        last = change;
    }
    work->jammed = -1;
    return 0;
}

/* S = H M^-1 H' (multipliers x multipliers) at a state: singular where joints hold the same. */
int fu_compliance(const fu_model *model, const fu_state *state, fu_accelerator *work, double *S)
{
    fu_system *s = &work->mass;
    const int n = model->n_multipliers, whole = s->m;
    evaluate(model, state, work);
    s->m = model->n_border_dof; /* M alone */
    border(model, state->q, work);
    const int info = fu_system_factor_border(s, model->lapack);
    for (int r = 0; r < n_rows(model) && !info; ++r) {
        const fu_rows *rows = &work->rows[r];
        for (int c = 0; c < rows->rows; ++c) {
            const double *H = rows->H + c * rows->n;
            for (int i = 0; i < model->n_dof; ++i) work->work[i] = 0.0;
            for (int k = 0; k < rows->n; ++k) work->work[rows->at[k]] += H[k];
            fu_gather(model, work->work, work->rhs);
            fu_system_solve(s, model->lapack, work->rhs);
            fu_spread(model, work->rhs, work->work);
            for (int i = 0; i < n_rows(model); ++i)
                for (int d = 0; d < work->rows[i].rows; ++d)
                    S[(rows->first + c) * n + work->rows[i].first + d] = -minus_H(&work->rows[i], d, work->work);
        }
    }
    s->m = whole;
    return info;
}

/* Accelerations and multipliers (eq 38). `slides` may be null, and `reaction`: what supports give to each dof, zero to rounding where it is free. */
int fu_accelerations(const fu_model *model, const fu_state *state, fu_accelerator *work, double *acceleration,
                     fu_slide_output *slides, double *reaction)
{
    double *lambda = work->rhs + model->n_band + model->n_border_dof, *prescribed = work->prescribed;
    work->jammed = -1;
    evaluate(model, state, work);
    const int info = factor_border(model, state, work);
    if (info) return info;
    for (int i = 0; i < model->n_dof; ++i) work->force[i] = prescribed[i] = work->work[i] = 0.0;
    /* - Q_k - Q_d - Q_e (eq 9) */
    fu_internal_forces(model, state->q, state->v, work->force);
    fu_spring_forces(model, state->q, state->v, work->force);
    fu_external_forces(model, state->t, state->q, work->force);
    for (int k = 0; k < model->n_motions; ++k)
        prescribed[model->motions[k].dof] = state->acceleration[model->motions[k].dof];
    if (model->n_motions) fu_mass_times(model, state->q, prescribed, work->work);
    for (int i = 0; i < model->n_dof; ++i) work->work[i] = -work->force[i] - work->work[i];
    if (settle(model, state, work, acceleration)) return 1;
    resist(model, state, work, lambda);
    for (int i = 0; i < model->n_dof; ++i) acceleration[i] += prescribed[i];
    memcpy(work->multipliers, lambda, sizeof(double) * (size_t)model->n_multipliers);
    if (slides)
        for (int j = 0; j < model->n_slides; ++j) {
            const fu_rows *rows = &work->rows[j];
            const fu_slide_state *slide_state = &work->slide_states[j];
            const int dim = model->dim;
            fu_slide_output *out = &slides[j];
            *out = (fu_slide_output){0};
            out->s_rate = slide_state->s_rate;
            out->s_acceleration = slide_state->s_bias;
            for (int k = 0; k < rows->n; ++k) out->s_acceleration += slide_state->G[k] * acceleration[rows->at[k]];
            for (int c = 0; c < dim - 1 && c < rows->rows; ++c) out->multiplier[c] = lambda[rows->first + c];
            double pull = 0.0, square = 0.0;
            force_of(model, work, j, lambda, out->force);
            for (int d = 0; d < dim; ++d) {
                const double G = slide_state->by_point[(dim - 1) * dim + d]; /* along the tangent */
                out->residual[d] = slide_state->C[d];
                pull += G * out->force[d];
                square += G * G;
            }
            if (square > 0.0) out->traction = pull / sqrt(square);
            if (model->slides[j].drive >= 0 && state->mode[j] == FU_LOCKED)
                out->traction = -lambda[rows->first + dim - 1] - work->driven_resistance[j];
            add_force_of_frame(model, work, j, lambda, out->force);
        }
    if (reaction) {
        fu_mass_times(model, state->q, acceleration, work->work);
        for (int i = 0; i < model->n_dof; ++i) reaction[i] = work->work[i] + work->force[i]; /* M q'' - Q (eq 26) */
        for (int r = 0; r < n_rows(model); ++r) { /* + H' lambda (eq 32) */
            const fu_rows *rows = &work->rows[r];
            for (int c = 0; c < rows->rows; ++c)
                for (int k = 0; k < rows->n; ++k)
                    reaction[rows->at[k]] += rows->H[c * rows->n + k] * lambda[rows->first + c];
            if (r < model->n_slides && model->slides[r].resistance)
                for (int k = 0; k < rows->n; ++k)
                    reaction[rows->at[k]] -= work->slide_states[r].G[k] * work->resistance[r];
        }
    }
    return 0;
}

/* change = the smallest (in the mass norm) change of the dofs with H change = -C_m, or, of velocities, -H v; of these the
 * slide `struck` comes back with the restitution of the stop that it has come to */
static int project(const fu_model *model, const fu_state *state, fu_accelerator *work, int of_velocities, int struck,
                   double *change)
{
    double *lambda = work->rhs + model->n_band + model->n_border_dof;
    evaluate(model, state, work);
    const int info = factor_border(model, state, work);
    if (info) return info;
    if (struck >= 0)
        work->rows[struck].rate[model->dim - 1] =
            model->slides[struck].stops[state->contact[struck] > 0].restitution * work->slide_states[struck].s_rate;
    for (int i = 0; i < model->n_dof; ++i) work->work[i] = 0.0;
    for (int r = 0; r < n_rows(model); ++r) {
        const fu_rows *rows = &work->rows[r];
        for (int c = rows->rows; c < rows->max_multipliers; ++c) lambda[rows->first + c] = 0.0;
        for (int c = 0; c < rows->rows; ++c)
            lambda[rows->first + c] = of_velocities ? minus_H(rows, c, state->v) - rows->rate[c] : -rows->C[c];
    }
    solve(model, work, work->work, change);
    return 0;
}

/* change = an increment of the dofs that makes constraints zero, to first order */
int fu_project_positions(const fu_model *model, const fu_state *state, fu_accelerator *work, double *change)
{
    return project(model, state, work, 0, -1, change);
}

/* change = a change of v that makes H v = 0, or minus what drives them */
int fu_project_velocities(const fu_model *model, const fu_state *state, fu_accelerator *work, double *change)
{
    return project(model, state, work, 1, -1, change);
}

/* change = that of v where a slide, which the state holds for that, strikes its stop: M change + H' L + G' P = 0, so that
 * momentum changes by what the stop gives alone */
int fu_strike(const fu_model *model, const fu_state *state, fu_accelerator *work, int slide, double *change)
{
    return project(model, state, work, 1, slide, change);
}

/* Newton step for s of a joint where it stands with this s, and the tangent */
static double evaluate_constraint(const fu_model *model, const fu_state *state, int j, double s, double i[3])
{
    const int dim = model->dim;
    double A_t[9];
    const double step = fu_slide_step(model, state, j, s, A_t);
    for (int d = 0; d < dim; ++d) i[d] = A_t[d * dim];
    return step;
}

/* Newton for C_l(s) = 0, see eq 21, on the curve of the element that holds s; 0 when it converged. */
int fu_find_arc_length(const fu_model *model, const fu_state *state, int j, double *s)
{
    const double length = model->cables[model->slides[j].cable].length;
    double step = 0.0, tangent[3];
    for (int i = 0; i < 50; ++i) {
        step = evaluate_constraint(model, state, j, *s, tangent);
        *s += step;
        if (fabs(step) <= 1e-15 * (length + fabs(*s))) return 0;
    }
    return fabs(step) <= 1e-12 * length ? 0 : 1;
}

/* Turn each director that no element gives with the tangent: the part of it across the tangent, of unit length. Where
 * the tangent has swung onto it, the axis least along the tangent takes over. */
void fu_carry_directors(const fu_model *model, fu_state *state)
{
    for (int j = 0; j < model->n_slides; ++j) {
        if (!model->slides[j].carries_director) continue;
        double *d = state->director + 3 * j, i[3];
        evaluate_constraint(model, state, j, state->s[j], i);
        double along = i[0] * d[0] + i[1] * d[1] + i[2] * d[2];
        if (!(fabs(along) < 0.99)) {
            const double x = fabs(i[0]), y = fabs(i[1]), z = fabs(i[2]);
            const int least = x <= y && x <= z ? 0 : y <= z ? 1 : 2;
            for (int k = 0; k < 3; ++k) d[k] = k == least;
            along = i[least];
        }
        double square = 0.0;
        for (int k = 0; k < 3; ++k) d[k] -= along * i[k];
        for (int k = 0; k < 3; ++k) square += d[k] * d[k];
        for (int k = 0; k < 3; ++k) d[k] /= sqrt(square);
    }
}
