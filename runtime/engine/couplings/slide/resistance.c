/* Friction of a sliding slide, and the buffer that it compresses: R, the force along the cable on the rider times
 * r_x, from the tangent t = r_x, the velocity u of the rider's point relative to the cable's particle and the whole
 * force f.
 *
 * R stands in the row of s, f . r_x = R (eq 30 has zero there), and in eq 38 as G' R. A locked slide needs none: the
 * force along the cable is then that of the lock. For a driven slide R is a part of that force: the drive gives the
 * rest, and R counts for the drive's power and for the dissipation. */
#include "bodies/model.h"
#include "couplings/common/accelerator.h"
#include "couplings/slide/slide.h"

#include <math.h>
#include <string.h>

/* of the change by the law: the first step of R, so that it does not reverse the normal force */
#define FIRST_STEP_SHARE 0.1
/* slope of the secant below which R changes by its law */
#define MIN_SECANT_SLOPE 0.1
#define MIN_NORMAL_FORCE 1e-30 /* N: a zero normal force has no direction */

/* Returns whether R acts on a slide in its state. */
static int has_resistance(const fu_model *model, const fu_state *state, int j)
{
    const fu_slide *slide = &model->slides[j];
    const fu_slide_flags *flags = fu_slide_flags_of(model, state, j);
    return slide->resistance && (flags->mode == FU_SLIDES || (flags->mode == FU_LOCKED && slide->drive >= 0));
}

/* Returns the direction opposed by friction, 0 for friction that rises smoothly with the speed, and for a drive at
 * rest. */
static double direction_of(const fu_model *model, const fu_state *state, int j)
{
    double rate, second;
    if (model->slides[j].drive < 0) return fu_slide_flags_of(model, state, j)->slip_direction;
    fu_slide_locked_s(model, state, j, &rate, &second);
    return model->slides[j].sticks ? (rate > 0.0) - (rate < 0.0) : 0.0;
}

/* Returns the compression of the buffer of one side by a slide, m; negative outside. */
double fu_compression(const fu_model *model, const fu_state *state, int j, int side)
{
    const fu_slide *slide = &model->slides[j];
    const double length = slide->stops[side > 0].length;
    double ends[2];
    fu_slide_ends(model, state, j, ends);
    return side > 0 ? state->s[j] - (ends[1] - length) : ends[0] + length - state->s[j];
}

/* Returns the buffer that a slide compresses, null if there is none. */
static const fu_end_stop *compressed(const fu_model *model, const fu_state *state, int j)
{
    const fu_slide_flags *flags = fu_slide_flags_of(model, state, j);
    const fu_end_stop *stop = &model->slides[j].stops[flags->contact > 0];
    return flags->contact && stop->kind == FU_END_IS_BUFFERED ? stop : 0;
}

void fu_resistance_at(const fu_model *model, const fu_state *state, int j, const double *t, const double *u,
                      const double *f, fu_resistance *resistance)
{
    const fu_slide *slide = &model->slides[j];
    const fu_end_stop *stop = compressed(model, state, j);
    const int side = fu_slide_flags_of(model, state, j)->contact;
    const double scale = fu_scale_at(model, slide->friction_scale, state->t);
    const double friction[5] = {scale * slide->friction, scale * slide->viscous, slide->velocity,
                                direction_of(model, state, j), MIN_NORMAL_FORCE};
    const double buffer[4] = {stop ? stop->stiffness : 0.0, stop ? stop->damping : 0.0,
                              stop ? fu_compression(model, state, j, side) : 0.0, side};
    double by_x;
    slide->resistance->force(t, u, f, friction, buffer, &resistance->R, resistance->by_t, resistance->by_u,
                             resistance->by_f, &by_x);
    resistance->by_s = side * by_x;
}

/* Returns the dissipated power, W: that of R without the buffer's spring, which stores its work. */
static double power_of(const fu_model *model, const fu_state *state, int j, const double *t, const double *u,
                       const double *f)
{
    const fu_end_stop *stop = compressed(model, state, j);
    const int side = fu_slide_flags_of(model, state, j)->contact;
    const double spring = stop ? -side * stop->stiffness * fu_compression(model, state, j, side) : 0.0;
    fu_resistance resistance;
    fu_resistance_at(model, state, j, t, u, f, &resistance);
    return -(resistance.R - spring) * fu_dot(model->dim, t, u) / fu_dot(model->dim, t, t);
}

/* Returns the energy of the springs of the buffers around a slide, J: of those that it does not compress alone, or of
 * all. */
static double energy_in_buffers(const fu_model *model, const fu_state *state, int j, int all)
{
    double energy = 0.0;
    const fu_slide_flags *flags = fu_slide_flags_of(model, state, j);
    for (int side = -1; side <= 1 && flags->mode != FU_LEFT; side += 2) {
        const fu_end_stop *stop = &model->slides[j].stops[side > 0];
        const double x = fu_compression(model, state, j, side);
        if (stop->kind == FU_END_IS_BUFFERED && x > 0.0 && (all || flags->contact != side))
            energy += 0.5 * stop->stiffness * x * x;
    }
    return energy;
}

double fu_buffer_energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    return energy_in_buffers(model, state, coupling->index, 1);
}

double fu_lost_in_buffers(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                          int by_ends)
{
    const int j = coupling->index;
    (void)by_ends;
    if (!model->slides[j].resistance) return 0.0;
    return energy_in_buffers(model, from, j, 0) - energy_in_buffers(model, to, j, 0);
}

void fu_detect_buffers(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    const int j = coupling->index;
    if (!model->slides[j].resistance) return;
    fu_slide_flags *flags = fu_slide_flags_of(model, state, j);
    flags->contact = 0;
    for (int side = -1; side <= 1; side += 2)
        if (model->slides[j].stops[side > 0].kind == FU_END_IS_BUFFERED && fu_compression(model, state, j, side) > 0.0)
            flags->contact = side;
}

/* Computes t and u from the derivatives of phi = r - p by the slide's coordinates and s. */
void fu_slide_motion(const fu_model *model, const fu_state *state, int j, const double *J, double *t, double *u)
{
    int at[FU_SLIDE_COORDINATES + 1];
    const int s = fu_slide_coordinates(model, state, j, at), n = s + 1;
    for (int d = 0; d < model->dim; ++d) {
        t[d] = J[d * n + s];
        u[d] = 0.0;
        for (int i = 0; i < s; ++i) u[d] -= J[d * n + i] * state->v[at[i]];
    }
}

/* Computes the derivatives of R by the slide's coordinates and s, and by the rates of the former, at a fixed force:
 * those of t and u are second derivatives of phi, of which fu_slide_tangent has those along a vector. */
void fu_resistance_rows(const fu_model *model, const fu_state *state, int j, const double *J,
                        const fu_resistance *resistance, double *by_place, double *by_rate)
{
    double unused[3 * (FU_SLIDE_COORDINATES + 1)], K[(FU_SLIDE_COORDINATES + 1) * (FU_SLIDE_COORDINATES + 1)];
    int at[FU_SLIDE_COORDINATES + 1];
    const int s = fu_slide_coordinates(model, state, j, at), n = s + 1;
    fu_slide_tangent(model, state, j, resistance->by_t, unused, K);
    for (int k = 0; k < n; ++k) by_place[k] = K[s * n + k];
    fu_slide_tangent(model, state, j, resistance->by_u, unused, K);
    for (int k = 0; k < n; ++k) {
        by_rate[k] = 0.0;
        for (int i = 0; i < s; ++i) by_place[k] -= state->v[at[i]] * K[i * n + k];
        for (int d = 0; d < model->dim; ++d) by_rate[k] -= resistance->by_u[d] * J[d * n + k];
    }
    by_place[s] += resistance->by_s;
    by_rate[s] = 0.0;
}

/* Computes t = r_x, and the velocity u along it, of a slide in eq 38. */
static void along(const fu_model *model, const fu_slide_state *slide_state, double *t, double *u)
{
    const int dim = model->dim;
    const double *G = slide_state->by_point + (dim - 1) * dim;
    const double square = fu_dot(dim, G, G);
    for (int d = 0; d < dim; ++d) {
        t[d] = G[d] / square;
        u[d] = t[d] * slide_state->s_rate;
    }
}

/* Returns the change of R for the change by its law: by the secant of the last sweep, since the normal force depends on
 * R almost linearly. */
static double secant_step(fu_slide_state *last, double change)
{
    const double slope = last->step != 0.0 ? (last->change - change) / last->step : 0.0;
    last->step = last->step == 0.0 ? FIRST_STEP_SHARE * change : slope > MIN_SECANT_SLOPE ? change / slope : change;
    last->change = change;
    return last->step;
}

double fu_resistance_update(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                            const double *lambda, fu_accelerator *work)
{
    const int j = coupling->index, dim = model->dim;
    fu_slide_state *slide_state = fu_slide_state_of(model, work, j);
    fu_rows *rows = &work->rows[coupling->row];
    double t[3], u[3], f[3], size = 0.0;
    fu_resistance resistance;
    slide_state->power = 0.0;
    if (!lambda) slide_state->R = slide_state->step = 0.0;
    if (!model->slides[j].resistance || fu_slide_flags_of(model, state, j)->mode != FU_SLIDES) return 0.0;
    along(model, slide_state, t, u);
    if (lambda) fu_slide_force(model, work, j, lambda, f);
    else memcpy(f, state->forces + coupling->force, sizeof(double) * (size_t)dim);
    fu_resistance_at(model, state, j, t, u, f, &resistance);
    slide_state->power = power_of(model, state, j, t, u, f);
    const double change = resistance.R - slide_state->R, step = lambda ? secant_step(slide_state, change) : change;
    for (int d = 0; d < dim; ++d) size = fmax(size, fabs(f[d]));
    size = fmax(size, fabs(resistance.R));
    slide_state->R += step;
    rows->by_push = slide_state->G;
    rows->push = slide_state->R;
    for (int k = 0; k < rows->n; ++k) work->work[rows->at[k]] += slide_state->G[k] * step;
    return change != 0.0 ? fabs(change) / size : 0.0;
}

/* Computes, for a driven slide, the part of the force along the cable that the drive does not give, and its power. */
void fu_resistance_accept(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const double *lambda, fu_accelerator *work)
{
    const int j = coupling->index;
    fu_slide_state *slide_state = fu_slide_state_of(model, work, j);
    double t[3], u[3], f[3];
    fu_resistance resistance;
    slide_state->driven_R = 0.0;
    if (model->slides[j].drive < 0 || !has_resistance(model, state, j)) return;
    along(model, slide_state, t, u);
    fu_slide_force(model, work, j, lambda, f);
    fu_resistance_at(model, state, j, t, u, f, &resistance);
    slide_state->driven_R = resistance.R;
    slide_state->power = power_of(model, state, j, t, u, f);
    work->rows[coupling->row].opposed = resistance.R * slide_state->s_rate;
}

double fu_resistance_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                                 const fu_accelerator *work)
{
    const int j = coupling->index;
    const double *f = state->forces + coupling->force;
    double J[3 * (FU_SLIDE_COORDINATES + 1)], K[(FU_SLIDE_COORDINATES + 1) * (FU_SLIDE_COORDINATES + 1)], t[3], u[3];
    if (!model->slides[j].resistance) return 0.0;
    if (work) return fu_slide_state_of(model, work, j)->power;
    if (!has_resistance(model, state, j)) return 0.0;
    fu_slide_tangent(model, state, j, f, J, K);
    fu_slide_motion(model, state, j, J, t, u);
    return power_of(model, state, j, t, u, f);
}

/* If the normal force reverses within a step, friction has a kink, and no quadrature over the step is accurate: the
 * friction of the mean normal force differs from the mean friction by at least the error. The rider's speed keeps the
 * error, and its position differs by that times the remaining time. */
double fu_resistance_friction_error(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int n,
                                    const double *weights, const double *multipliers, double square)
{
    const fu_slide *slide = (const fu_slide *)coupling;
    double mean[2] = {0.0, 0.0}, all = 0.0;
    if (!slide->resistance || fu_slide_flags_of(model, state, coupling->index)->mode != FU_SLIDES) return 0.0;
    for (int k = 0; k < n; ++k) {
        const double *N = multipliers + (long)k * model->n_multipliers + coupling->multiplier;
        const double normal[2] = {N[0], model->dim == 3 ? N[1] : 0.0};
        for (int d = 0; d < 2; ++d) mean[d] += weights[k] * normal[d];
        all += weights[k] * hypot(normal[0], normal[1]);
    }
    return square * fu_scale_at(model, slide->friction_scale, state->t) * slide->friction *
           (all - hypot(mean[0], mean[1])) / coupling->scale[0];
}
