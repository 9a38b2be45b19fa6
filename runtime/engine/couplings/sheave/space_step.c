/* Sheaves in space over a step that conserves energy (derive/couplings/turning_step.py): places and forces of the wrap
 * from the groove, whose body rotates by Cayley's map. Along the columns of A (1 + Theta~/2) a moment in space is that
 * on the turn of the body. */
#include "bodies/model.h"
#include "couplings/common/couplings.h"
#include "couplings/sheave/sheave.h"

#include <string.h>

/* --- inertia ---------------------------------------------------------------------------------------------------- */

void fu_space_momentum(const fu_sheave *sheave, const fu_sheave_state *at, const fu_zone_point *point, double P[SPACE])
{
    const fu_wheel_state *wheel = &at->wheel;
    const int j = point->zone;
    const double alpha = at->angle[j + 1] - at->angle[j], about = fu_dot(SPACE, wheel->axis, wheel->centre.omega);
    sheave->wheel.foot->momentum(sheave->wheel.radius, at->length[j], point->xi, at->angle[j] + point->xi * alpha,
                                 alpha, wheel->groove, wheel->centre.v, wheel->centre.omega,
                                 at->angle_rate[j] + point->xi * (at->angle_rate[j + 1] - at->angle_rate[j]) - about,
                                 at->s_rate + j, P);
}

void fu_space_point_over_step(const fu_sheave *sheave, const fu_sheave_over *step, const fu_zone_point *point, double h,
                              const double P[SPACE], fu_sheave_step_forces *out, double P_next[SPACE])
{
    const fu_wheel *wheel = &sheave->wheel;
    const int j = point->zone;
    const double begin = step->now.share[j], width = step->now.share[j + 1] - begin;
    const double part = begin + point->xi * width, wrap = step->now.phi[1] - step->now.phi[0];
    const double opening = 2.0 * (step->half[1] - step->half[0]);
    double on_c[SPACE], moment[SPACE], on_turn, on_alpha, on_s[ENDS];
    wheel->foot->momentum_step(point->weight * wheel->rho, h, step->now.length[j], step->s_change + j, wheel->radius,
                               point->xi, step->now.phi[0] + part * wrap, 2.0 * step->half[0] + part * opening,
                               width * wrap, width * opening, step->groove.c_change, step->groove.axes,
                               step->groove.theta, P, on_c, moment, &on_turn, &on_alpha, on_s, P_next);
    if (!out) return;
    for (int d = 0; d < SPACE; ++d) {
        out->force[d] += on_c[d];
        out->moment[d] += moment[d];
    }
    fu_add_turn(step, part, on_turn, out);
    fu_add_opening(step, width * on_alpha, out);
    for (int e = 0; e < ENDS; ++e) out->s[j + e] += on_s[e];
}

double fu_space_wrap_energy(const fu_sheave *sheave, const fu_sheave_state *at)
{
    const fu_wheel *wheel = &sheave->wheel;
    double total = 0.0, T;
    if (is_turning(sheave)) return fu_turning_wrap_energy(sheave, at);
    for (int j = 0; j < sheave->n_zones; ++j) {
        const fu_zone of = fu_zone_at(at, j);
        wheel->kernel->kinetic_energy(wheel->rho, wheel->radius, of.phi, of.l, of.phi_rate, at->wheel.c_rate, of.s_rate,
                                      &T);
        total += T;
    }
    return total;
}

/* --- weight ----------------------------------------------------------------------------------------------------- */

/* Adds the first moment of mass of a zone about the centre, in the groove, times a factor. */
static void add_first_moment(const fu_sheave *sheave, const fu_sheave_state *at, int j, double factor, double out[DIM])
{
    static const double along_axis[SPACE] = {0.0, 0.0, 1.0};
    const fu_wheel *wheel = &sheave->wheel;
    const fu_zone of = fu_zone_at(at, j);
    double moment[FU_TILTS], by_q[FU_TILTS * (ENDS + 1)], by_turn[FU_TILTS * FU_TILTS];
    wheel->foot->wrap_weight(wheel->rho, along_axis, wheel->radius, of.phi, of.l, moment, by_q, by_turn);
    out[0] += factor * moment[1];
    out[1] -= factor * moment[0];
}

void fu_space_add_weight(const fu_sheave *sheave, const fu_sheave_over *step, fu_sheave_step_forces *out)
{
    const double *g = step->groove.gravity, rho = sheave->wheel.rho;
    double first[DIM] = {0.0}, arm[SPACE], moment[SPACE], height = 0.0;
    const double mass = 0.5 * rho * (wrap_length(sheave, &step->now) + wrap_length(sheave, &step->next));
    for (int j = 0; j < sheave->n_zones; ++j) {
        add_first_moment(sheave, &step->now, j, 0.5, first);
        add_first_moment(sheave, &step->next, j, 0.5, first);
    }
    for (int d = 0; d < SPACE; ++d) {
        arm[d] = fu_dot(DIM, step->groove.axes + d * DIM, first);
        height += 0.5 * g[d] * (step->now.wheel.centre.p[d] + step->next.wheel.centre.p[d]);
        out->force[d] -= mass * g[d];
    }
    fu_cross(arm, g, moment);
    for (int d = 0; d < SPACE; ++d) out->moment[d] -= moment[d];
    out->s[0] += rho * height;
    out->s[sheave->n_zones] -= rho * height;
}

/* --- forces on the dofs ------------------------------------------------------------------------------------------ */

/* Adds the moments on the turns of both tangent points. */
static void add_turns(const fu_sheave *sheave, const fu_sheave_over *step, const fu_sheave_step_forces *of, double *f,
                      double force[SPACE], double moment[SPACE])
{
    for (int k = 0; k < ENDS; ++k) {
        const double *x = step->middle.x[k], size = of->turn[k] * step->arm[k],
                     parts[DIM] = {-size * x[1], size * x[0]};
        double on_node[SPACE], turn[SPACE];
        for (int d = 0; d < SPACE; ++d) on_node[d] = fu_dot(DIM, step->groove.axes + d * DIM, parts);
        fu_cross(on_node, step->x[k], turn);
        for (int d = 0; d < SPACE; ++d) {
            f[sheave->nodes[k] + d] += on_node[d];
            force[d] -= on_node[d];
            moment[d] += turn[d];
        }
    }
}

/* Adds the forces of the conditions. */
static void add_conditions(const fu_sheave *sheave, const fu_sheave_over *step, const fu_equations *at,
                           const double *multipliers, double *phi, double *f, double force[SPACE], double moment[SPACE])
{
    const fu_foot_step over = {.q = {at->now->q, at->next->q},
                               .centre = {step->now.wheel.centre.p, step->next.wheel.centre.p},
                               .axis = {step->now.wheel.axis, step->next.wheel.axis}};
    for (int k = 0; k < ENDS; ++k, multipliers += FU_FOOT_CONDITIONS, phi += FU_FOOT_CONDITIONS) {
        const fu_foot of = fu_foot_of(sheave, &step->next, k);
        fu_tangent_point next;
        fu_tangent_point_at(&of, &step->next.wheel, at->next->q, multipliers, &next);
        memcpy(phi, next.phi, sizeof next.phi);
        fu_tangent_point_over_step(&of, &over, multipliers, f, force, moment);
    }
}

void fu_space_add_step_forces(const fu_sheave *sheave, const fu_sheave_over *step, const fu_sheave_step_forces *of,
                              double *f)
{
    const fu_wheel *wheel = &sheave->wheel;
    double force[SPACE], moment[SPACE];
    memcpy(force, of->force, sizeof force);
    memcpy(moment, of->moment, sizeof moment);
    add_turns(sheave, step, of, f, force, moment);
    if (wheel->turn >= 0) f[wheel->turn] += of->wheel;
    for (int j = 0; j <= sheave->n_zones; ++j) f[sheave->s[j]] += of->s[j];
    fu_add_wrench(SPACE, &step->middle.wheel.centre, force, moment, 1.0, f);
}

void fu_space_over_step(const fu_sheave *sheave, const fu_sheave_over *step, const fu_equations *at,
                        const fu_sheave_step_forces *of, const double *multipliers, double *phi, double *f)
{
    fu_sheave_step_forces all = *of;
    add_conditions(sheave, step, at, multipliers, phi, f, all.force, all.moment);
    fu_wheel_add_spin(&sheave->wheel, step->spin[0], step->spin[1], &step->groove, at->h, all.moment);
    fu_space_add_step_forces(sheave, step, &all, f);
}
