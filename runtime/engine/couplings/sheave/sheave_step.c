/* Sheaves over a step that conserves energy (derive/couplings/sheave_step.py, in space turning_step.py): the operations
 * of the coupling. Both energies of the wrap have the mean gradient along the angles, the centre and the lengths, by
 * quadrature. */
#include "bodies/model.h"
#include "couplings/common/couplings.h"
#include "couplings/common/momenta.h"
#include "couplings/sheave/sheave.h"

#include <math.h>
#include <string.h>

/* Gauss points on (0, 1) and their weights: of the momentum along a zone. */
static const double part_of_zone[FU_ZONE_POINTS] = {0.01985507175123188, 0.10166676129318664, 0.23723379504183550,
                                                    0.40828267875217511, 0.59171732124782489, 0.76276620495816450,
                                                    0.89833323870681336, 0.98014492824876812},
                    weight_in_zone[FU_ZONE_POINTS] = {0.05061426814518813, 0.11119051722668724, 0.15685332293894364,
                                                      0.18134189168918099, 0.18134189168918099, 0.15685332293894364,
                                                      0.11119051722668724, 0.05061426814518813};

/* --- inertia ---------------------------------------------------------------------------------------------------- */

int fu_sheave_history_size(const fu_coupling *coupling)
{
    const fu_sheave *sheave = sheave_of(coupling);
    return FU_MOMENTA_HEAD + sheave->n_zones * FU_ZONE_POINTS * momentum_dim(sheave) + 1;
}

/* Computes the momentum at a point of a zone by velocities. */
static void momentum_of_velocities(const fu_sheave *sheave, const fu_sheave_state *at, int j, int g, double P[SPACE])
{
    const double part = part_of_zone[g], alpha = at->angle[j + 1] - at->angle[j];
    if (is_in_space(sheave)) {
        const fu_zone_point point = {j, part, weight_in_zone[g]};
        fu_space_momentum(sheave, at, &point, P);
        return;
    }
    sheave->wheel.kernel->momentum(
        sheave->wheel.radius, at->length[j], part, at->angle[j] + part * alpha, alpha, at->wheel.c_rate,
        at->angle_rate[j] + part * (at->angle_rate[j + 1] - at->angle_rate[j]), at->s_rate + j, P);
}

/* Adds the inertial forces of a point of a zone (null: none); computes its momentum at the end of the step. */
static void point_over_step(const fu_sheave *sheave, const fu_equations *at, const fu_sheave_over *step, int j, int g,
                            fu_sheave_step_forces *out, double P_next[SPACE])
{
    const fu_wheel *wheel = &sheave->wheel;
    const fu_momenta *known = fu_momenta_of(&wheel->base, at->now);
    const double begin = step->now.share[j], width = step->now.share[j + 1] - begin, xi = part_of_zone[g];
    const double part = begin + xi * width, wrap = step->now.phi[1] - step->now.phi[0];
    const double opening = 2.0 * (step->half[1] - step->half[0]);
    double P[SPACE], on_c[DIM], on_turn, on_alpha, on_s[ENDS];
    if (known->is_known != 0.0)
        memcpy(P, known->P + momentum_number(sheave, j, g), sizeof(double) * (size_t)momentum_dim(sheave));
    else momentum_of_velocities(sheave, &step->now, j, g, P);
    if (is_in_space(sheave)) {
        const fu_zone_point point = {j, xi, weight_in_zone[g]};
        fu_space_point_over_step(sheave, step, &point, at->h, P, out, P_next);
        return;
    }
    wheel->kernel->momentum_step(weight_in_zone[g] * wheel->rho, at->h, step->now.length[j], step->s_change + j,
                                 wheel->radius, xi, step->now.phi[0] + part * wrap,
                                 2.0 * step->half[0] + part * opening, width * wrap, width * opening, step->c_change, P,
                                 on_c, &on_turn, &on_alpha, on_s, P_next);
    if (!out) return;
    for (int d = 0; d < DIM; ++d) out->centre[d] += on_c[d];
    fu_add_turn(step, part, on_turn, out);
    fu_add_opening(step, width * on_alpha, out);
    for (int e = 0; e < ENDS; ++e) out->s[j + e] += on_s[e];
}

void fu_sheave_history_over_step(const fu_model *model, const fu_coupling *coupling, const fu_equations *at)
{
    const fu_sheave *sheave = sheave_of(coupling);
    fu_momenta *next = fu_momenta_of(coupling, at->next);
    fu_sheave_over step;
    fu_sheave_over_step(model, sheave, at, &step);
    for (int j = 0; j < sheave->n_zones; ++j)
        for (int g = 0; g < FU_ZONE_POINTS; ++g)
            point_over_step(sheave, at, &step, j, g, 0, next->P + momentum_number(sheave, j, g));
    next->P[momentum_number(sheave, sheave->n_zones, 0)] = step.spin[1];
    next->is_known = 1.0;
}

void fu_sheave_velocities(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double since)
{
    const fu_sheave *sheave = sheave_of(coupling);
    (void)model;
    for (int j = 0; j <= sheave->n_zones; ++j) fu_velocity_of_step(at, since, sheave->s[j]);
}

void fu_sheave_history_jump(const fu_model *model, const fu_coupling *coupling, fu_state *state, const double *change)
{
    const fu_sheave *sheave = sheave_of(coupling);
    fu_momenta *known = fu_momenta_of(coupling, state);
    fu_state jump = *state;
    fu_sheave_state at;
    if (known->is_known == 0.0) return;
    jump.v = (double *)change;
    fu_sheave_at(model, sheave, &jump, 0, &at);
    known->P[momentum_number(sheave, sheave->n_zones, 0)] += at.wheel.turn_rate;
    for (int j = 0; j < sheave->n_zones; ++j)
        for (int g = 0; g < FU_ZONE_POINTS; ++g) {
            double P[SPACE];
            momentum_of_velocities(sheave, &at, j, g, P);
            for (int d = 0; d < momentum_dim(sheave); ++d) known->P[momentum_number(sheave, j, g) + d] += P[d];
        }
}

double fu_sheave_energy_beyond_velocities(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const fu_wheel *wheel = &sheave->wheel;
    const fu_momenta *known = fu_momenta_of(coupling, state);
    fu_sheave_state at;
    double total = 0.0, T;
    if (known->is_known == 0.0) return 0.0;
    fu_sheave_at(model, sheave, state, 0, &at);
    const double spin = fu_sheave_spin(sheave, &at, state), rate = at.wheel.turn_rate;
    total += 0.5 * wheel->inertia * (spin * spin - rate * rate);
    if (is_in_space(sheave)) total -= fu_space_wrap_energy(sheave, &at);
    for (int j = 0; j < sheave->n_zones; ++j) {
        const fu_zone of = fu_zone_at(&at, j);
        if (!is_in_space(sheave)) {
            wheel->kernel->kinetic_energy(wheel->rho, wheel->radius, of.phi, of.l, of.phi_rate, at.wheel.c_rate,
                                          of.s_rate, &T);
            total -= T;
        }
        for (int g = 0; g < FU_ZONE_POINTS; ++g) {
            const double *P = known->P + momentum_number(sheave, j, g), mass = weight_in_zone[g] * wheel->rho;
            if (is_in_space(sheave)) wheel->foot->momentum_energy(mass, of.l, P, &T);
            else wheel->kernel->momentum_energy(mass, of.l, P, &T);
            total += T;
        }
    }
    return total;
}

/* --- forces ----------------------------------------------------------------------------------------------------- */

/* Computes the derivatives by the angles of the ends of a zone, the centre and the length along the step. */
static void mean_gradient(const fu_sheave *sheave, const fu_sheave_over *step, int j, const double *A, const double *g,
                          double mean[DIM + 3])
{
    const fu_wheel *wheel = &sheave->wheel;
    const double *share = step->now.share + j, opening = step->half[1] - step->half[0];
    memset(mean, 0, sizeof(double) * (DIM + 3));
    for (int k = 0; k < FU_STEP_POINTS; ++k) {
        const double t = fu_part_of_step[k];
        double phi[ENDS], c[DIM], f[DIM + 3];
        for (int e = 0; e < ENDS; ++e) phi[e] = step->now.angle[j + e] + t * 2.0 * (step->half[0] + share[e] * opening);
        for (int d = 0; d < DIM; ++d) c[d] = step->c[d] + t * step->c_change[d];
        wheel->kernel->force(A, wheel->sense, wheel->rho, g, wheel->radius, phi, c,
                             step->now.length[j] + t * (step->next.length[j] - step->now.length[j]), f);
        for (int i = 0; i < DIM + 3; ++i) mean[i] += fu_weight_in_step[k] * f[i];
    }
}

/* Adds the forces of the elastic energy, which a turn of the whole wrap does not change. */
static void add_elastic(const fu_sheave *sheave, const fu_sheave_over *step, int j, fu_sheave_step_forces *out)
{
    static const double none[3] = {0.0};
    double f[DIM + 3];
    mean_gradient(sheave, step, j, sheave->wheel.A, none, f);
    fu_add_opening(step, (step->now.share[j + 1] - step->now.share[j]) * f[1], out);
    out->s[j] -= f[DIM + 2];
    out->s[j + 1] += f[DIM + 2];
}

/* Adds the forces of the weight. */
static void add_weight(const fu_sheave *sheave, const fu_sheave_over *step, int j, fu_sheave_step_forces *out)
{
    static const double none[2] = {0.0};
    double f[DIM + 3], on_angle[ENDS] = {0.0};
    mean_gradient(sheave, step, j, none, is_in_space(sheave) ? step->groove.g : sheave->wheel.g, f);
    for (int e = 0; e < ENDS; ++e) {
        on_angle[0] += (1.0 - step->now.share[j + e]) * f[e];
        on_angle[1] += step->now.share[j + e] * f[e];
    }
    for (int k = 0; k < ENDS; ++k) out->turn[k] += on_angle[k] * cos(step->half[k]) * fu_over_sine(step->half[k]);
    for (int d = 0; d < DIM; ++d) out->centre[d] += f[ENDS + d];
    out->s[j] -= f[DIM + 2];
    out->s[j + 1] += f[DIM + 2];
}

/* Adds the forces half-way that dissipate energy: damping, friction, and the bearing. */
static void add_losses(const fu_sheave *sheave, const fu_sheave_over *step, fu_sheave_step_forces *out)
{
    const fu_wheel *wheel = &sheave->wheel;
    const fu_sheave_state *at = &step->middle;
    for (int j = 0; sheave->tau > 0.0 && j < sheave->n_zones; ++j) {
        const fu_zone of = fu_zone_at(at, j);
        double d[2 * ENDS];
        wheel->kernel->damping_force(wheel->A, sheave->tau, wheel->radius, of.phi, of.l, of.phi_rate, of.s_rate, d);
        for (int e = 0; e < ENDS; ++e) {
            out->turn[0] += (1.0 - of.share[e]) * d[e];
            out->turn[1] += of.share[e] * d[e];
            out->s[j + e] += d[ENDS + e];
        }
    }
    for (int j = 0; j < friction_points(sheave, at); ++j) {
        double F[3], numbers[3], power;
        fu_friction_at(sheave, at, j, F, numbers, &power);
        out->turn[0] += (1.0 - at->share[j]) * F[0];
        out->turn[1] += at->share[j] * F[0];
        out->wheel += F[1];
        out->s[j] += F[2];
    }
}

/* Adds forces over a step by y. */
static void into_y(const fu_sheave *sheave, const fu_sheave_over *step, const fu_sheave_step_forces *of, double y[Y])
{
    for (int k = 0; k < ENDS; ++k) {
        const double *x = step->middle.x[k], arm = of->turn[k] * step->arm[k], force[DIM] = {-arm * x[1], arm * x[0]};
        for (int d = 0; d < DIM; ++d) {
            y[k * NODE + d] += force[d];
            y[CENTRE + d] -= force[d];
        }
    }
    for (int d = 0; d < DIM; ++d) y[CENTRE + d] += of->centre[d];
    y[TURN] += of->wheel;
    for (int j = 0; j <= sheave->n_zones; ++j) y[MATERIAL + j] += of->s[j];
}

/* Adds the forces of the conditions in the plane, |x| and the product of x and the slope, by y: their derivatives by
 * the mean vectors are discrete ones. Computes the residuals. */
static void add_conditions_in_plane(const fu_sheave *sheave, const fu_sheave_over *step, const double *multipliers,
                                    double *phi, double y[Y])
{
    double J[MAX_CONDITIONS][Y], unused[MAX_CONDITIONS][Y], half_way[MAX_CONDITIONS];
    fu_sheave_rows_at(sheave, &step->middle, J, half_way);
    fu_sheave_rows_at(sheave, &step->next, unused, phi);
    for (int r = 0; r < ENDS * DIM; ++r)
        for (int i = 0; i < Y; ++i) y[i] += J[r][i] * multipliers[r];
}

void fu_sheave_add_step_forces(const fu_sheave *sheave, const fu_sheave_over *step, const fu_sheave_step_forces *of,
                               double *f)
{
    double y[Y] = {0.0};
    if (is_in_space(sheave)) {
        fu_space_add_step_forces(sheave, step, of, f);
        return;
    }
    into_y(sheave, step, of, y);
    fu_sheave_scatter(sheave, &step->middle, y, f);
}

static void over_step_in_plane(const fu_sheave *sheave, const fu_sheave_over *step, const fu_sheave_step_forces *of,
                               const double *multipliers, double *phi, double *f)
{
    double y[Y] = {0.0};
    into_y(sheave, step, of, y);
    add_conditions_in_plane(sheave, step, multipliers, phi, y);
    fu_sheave_scatter(sheave, &step->middle, y, f);
}

void fu_sheave_step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                             double *internal)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const double *multipliers = at->next->forces + coupling->force;
    const int n = ENDS * conditions_of(sheave);
    double phi[MAX_CONDITIONS];
    fu_sheave_step_forces of = {.wheel = 0.0};
    fu_sheave_over step;
    fu_sheave_over_step(model, sheave, at, &step);
    of.wheel = sheave->wheel.inertia * (step.spin[1] - step.spin[0]) / at->h;
    for (int j = 0; j < sheave->n_zones; ++j) {
        double P[SPACE];
        for (int g = 0; g < FU_ZONE_POINTS; ++g) point_over_step(sheave, at, &step, j, g, &of, P);
        add_elastic(sheave, &step, j, &of);
        add_weight(sheave, &step, j, &of);
    }
    add_losses(sheave, &step, &of);
    if (is_in_space(sheave)) {
        fu_space_add_weight(sheave, &step, &of);
        fu_space_over_step(sheave, &step, at, &of, multipliers, phi, f);
    } else over_step_in_plane(sheave, &step, &of, multipliers, phi, f);
    fu_wheel_add_bearing(&sheave->wheel, &step.middle.wheel, f);
    for (int r = 0; r < n; ++r)
        internal[coupling->unknown + r] = -fu_row_unit(at->weights.inertia, coupling->scale[r]) * phi[r];
    for (int r = n; r < coupling->n_forces; ++r)
        internal[coupling->unknown + r] = -at->weights.stiffness * multipliers[r];
}

double fu_turn_of_wheel(const fu_sheave *sheave, const fu_sheave_over *step, const fu_equations *at)
{
    if (!is_in_space(sheave)) return fu_wheel_turn(&sheave->wheel, &step->groove, at);
    return sheave->wheel.turn < 0 ? 0.0 : at->psi[sheave->wheel.turn];
}

double fu_sheave_step_power(const fu_sheave *sheave, const fu_sheave_over *step, const fu_equations *at,
                            const fu_sheave_step_forces *of)
{
    double total = of->wheel * fu_turn_of_wheel(sheave, step, at);
    for (int k = 0; k < ENDS; ++k) total += of->turn[k] * 2.0 * tan(step->half[k]);
    for (int j = 0; j <= sheave->n_zones; ++j) total += of->s[j] * step->s_change[j];
    return total;
}

double fu_sheave_step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at)
{
    const fu_sheave *sheave = sheave_of(coupling);
    fu_sheave_step_forces of = {.wheel = 0.0};
    fu_sheave_over step;
    if (!coupling->is_damped) return 0.0;
    fu_sheave_over_step(model, sheave, at, &step);
    add_losses(sheave, &step, &of);
    const double own = step.middle.wheel.own_rate;
    return fu_sheave_step_power(sheave, &step, at, &of) + at->h * sheave->wheel.damping * own * own;
}
