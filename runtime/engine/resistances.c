/* Friction of a slide that slides, and the buffer that it has run into: R, the force along the cable on the rider times
 * r_x, from the tangent t = r_x, the velocity u of the rider's point over the cable's particle and the whole force f.
 *
 * R stands in the row of s, f . r_x = R (eq 30 has zero there), and in eq 38 as G' R. A slide that is held needs none: the
 * force along the cable is then what holding takes. Of a slide that is driven it is a part of that: the drive gives the
 * rest, and R counts for its power and for what goes to heat alone.
 */
#include "engine.h"

#define LEAST_NORMAL 1e-30 /* N: of a normal force of zero there is no direction */

/* whether R acts on a slide as it is */
int fu_has_resistance(const fu_model *model, const fu_state *state, int j)
{
    const fu_slide *slide = &model->slides[j];
    return slide->resistance && (state->mode[j] == FU_SLIDES || (state->mode[j] == FU_LOCKED && slide->drive >= 0));
}

/* direction that friction is against, 0 where it goes smoothly with the speed; a drive that stands needs none of it */
static double way_of(const fu_model *model, const fu_state *state, int j)
{
    double rate, second;
    if (model->slides[j].drive < 0) return state->slip_direction[j];
    fu_slide_held(model, state, j, &rate, &second);
    return model->slides[j].sticks ? (rate > 0.0) - (rate < 0.0) : 0.0;
}

/* how far a slide is in the buffer of one side, m; negative outside */
double fu_compression(const fu_model *model, const fu_state *state, int j, int side)
{
    const fu_slide *slide = &model->slides[j];
    const double length = slide->stops[side > 0].length;
    return side > 0 ? state->s[j] - (fu_length(model, j) - length) : length - state->s[j];
}

/* the buffer that a slide presses, null where it does not */
static const fu_end_stop *pressed(const fu_model *model, const fu_state *state, int j)
{
    const fu_end_stop *stop = &model->slides[j].stops[state->contact[j] > 0];
    return state->contact[j] && stop->kind == FU_END_IS_BUFFERED ? stop : 0;
}

void fu_resistance_at(const fu_model *model, const fu_state *state, int j, const double *t, const double *u, const double *f,
              fu_resistance *resistance)
{
    const fu_slide *slide = &model->slides[j];
    const fu_end_stop *stop = pressed(model, state, j);
    const int side = state->contact[j];
    const double friction[5] = {slide->friction, slide->viscous, slide->velocity, way_of(model, state, j),
                                LEAST_NORMAL};
    const double buffer[4] = {stop ? stop->stiffness : 0.0, stop ? stop->damping : 0.0,
                              stop ? fu_compression(model, state, j, side) : 0.0, side};
    double by_x;
    slide->resistance->force(t, u, f, friction, buffer, &resistance->R, resistance->by_t, resistance->by_u, resistance->by_f, &by_x);
    resistance->by_s = side * by_x;
}

/* W that go to heat: all of R but the buffer's spring, which keeps what it takes */
double fu_resistance_power(const fu_model *model, const fu_state *state, int j, const double *t, const double *u,
                      const double *f)
{
    const fu_end_stop *stop = pressed(model, state, j);
    const int side = state->contact[j];
    const double spring = stop ? -side * stop->stiffness * fu_compression(model, state, j, side) : 0.0;
    double along = 0.0, square = 0.0;
    fu_resistance resistance;
    fu_resistance_at(model, state, j, t, u, f, &resistance);
    for (int d = 0; d < model->dim; ++d) {
        along += t[d] * u[d];
        square += t[d] * t[d];
    }
    return -(resistance.R - spring) * along / square;
}

/* J in the springs of the buffers that a slide is in; those that do not touch it alone, or all */
static double buffer_energy_of(const fu_model *model, const fu_state *state, int j, int all)
{
    double energy = 0.0;
    for (int side = -1; side <= 1 && state->mode[j] != FU_LEFT; side += 2) {
        const fu_end_stop *stop = &model->slides[j].stops[side > 0];
        const double x = fu_compression(model, state, j, side);
        if (stop->kind == FU_END_IS_BUFFERED && x > 0.0 && (all || state->contact[j] != side))
            energy += 0.5 * stop->stiffness * x * x;
    }
    return energy;
}

/* J in the springs of the buffers */
double fu_buffer_energy(const fu_model *model, const fu_state *state)
{
    double energy = 0.0;
    for (int j = 0; j < model->n_slides; ++j) energy += buffer_energy_of(model, state, j, 1);
    return energy;
}

/* J that dampers of buffers have taken in a step: a slide that a damper would hold back is let go, and the spring, which
 * follows it to the buffer's beginning, gives the damper what it gives up. */
double fu_lost_in_buffers(const fu_model *model, const fu_state *from, const fu_state *to)
{
    double lost = 0.0;
    for (int j = 0; j < model->n_slides; ++j)
        if (model->slides[j].resistance)
            lost += buffer_energy_of(model, from, j, 0) - buffer_energy_of(model, to, j, 0);
    return lost;
}

/* Statics: the buffers that slides are in. */
void fu_touch_buffers(const fu_model *model, fu_state *state)
{
    for (int j = 0; j < model->n_slides; ++j) {
        state->contact[j] = 0;
        for (int side = -1; side <= 1; side += 2)
            if (model->slides[j].stops[side > 0].kind == FU_END_IS_BUFFERED && fu_compression(model, state, j, side) > 0.0)
                state->contact[j] = side;
    }
}

/* t and u from the derivatives of phi = r - p by the slide's coordinates and s */
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

/* Derivatives of R by the slide's coordinates and s, and by the rates of the former, at a fixed force: those of t and u are
 * second derivatives of phi, of which fu_slide_tangent has those along a vector. */
void fu_resistance_rows(const fu_model *model, const fu_state *state, int j, const double *J, const fu_resistance *resistance,
                   double *by_place, double *by_rate)
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
