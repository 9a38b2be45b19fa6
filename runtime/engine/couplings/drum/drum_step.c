/* Drums over a step that conserves energy (derive/couplings/drum.py, in space turning_step.py).
 *
 * A moment M on the angle phi of the tangent point from its carrier, which turns by the Cayley vector theta, is the
 * moment M (dphi - dpsi)/(2 tan(dphi/2) - theta) on the node and its opposite on the carrier: their work is M (dphi -
 * dpsi), their moment zero. In space phi is from the groove, to which psi and theta are zero. The elastic force on the
 * length is that of the mean stretches over the step; the work of it that the wound rope does not store is dissipated.
 */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/drum/drum.h"

#include <math.h>
#include <string.h>

/* A drum over a step: at its start, at its end, and half-way with means of the node; changes of the angle, of the
 * rotations and of the length; part: of a moment on the angle that acts on the node, and that force along k x x~; in
 * space the groove, and the mean place of the node from the centre. */
typedef struct {
    fu_drum_state now, next, middle;
    double angle, own, turn, length, part, arm;
    fu_groove_step groove;
    double x[SPACE];
} drum_over;

/* Returns the angle between two turns by their measures 2 tan(angle/2) over the difference of these. */
static double angle_over_measure(double one, double other)
{
    const double both = 1.0 + 0.25 * one * other, d = 0.5 * (one - other) / both;
    return (fabs(d) < 1e-4 ? 1.0 - d * d / 3.0 : atan(d) / d) / both;
}

static void over_step(const fu_model *model, const fu_drum *drum, const fu_equations *at, drum_over *out)
{
    const fu_wheel *wheel = &drum->wheel;
    fu_state middle = *at->middle;
    middle.numbers = at->next->numbers;
    middle.flags = at->next->flags;
    fu_drum_at(model, drum, at->now, 0, &out->now);
    fu_drum_at(model, drum, at->next, 0, &out->next);
    fu_drum_at(model, drum, &middle, 0, &out->middle);
    const double *from = out->now.x, *to = out->next.x;
    const double size = sqrt(fu_dot(DIM, from, from) * fu_dot(DIM, to, to));
    const double half = 0.5 * atan2(from[0] * to[1] - from[1] * to[0], from[0] * to[0] + from[1] * to[1]);
    for (int d = 0; d < DIM; ++d) {
        out->middle.x[d] = 0.5 * (from[d] + to[d]);
        out->middle.slope[d] = 0.5 * (out->now.slope[d] + out->next.slope[d]);
    }
    fu_groove_over_step(model, wheel, at, &out->now.wheel, &out->next.wheel, &out->middle.wheel, &out->groove);
    const double carrier = is_in_space(drum) ? 0.0 : out->groove.theta[0];
    out->angle = 2.0 * half;
    out->own = wheel->turn < 0 ? 0.0 : at->psi[wheel->turn];
    out->turn = fu_wheel_turn(wheel, &out->groove, at);
    out->length = drum->direction * at->psi[drum->s];
    out->part = angle_over_measure(2.0 * tan(half), carrier);
    out->arm = 1.0 / (size * cos(half) * cos(half));
    if (is_in_space(drum)) fu_mean_from_centre(drum->node, at, &out->now.wheel, &out->next.wheel, out->x);
}

/* --- the wound rope --------------------------------------------------------------------------------------------- */

/* Computes the velocities of the wound rope by those of a state. */
static void by_velocities(const fu_drum *drum, const fu_drum_state *at, double V[FU_DRUM_VELOCITIES])
{
    const fu_wheel_state *wheel = &at->wheel;
    memset(V, 0, sizeof(double) * FU_DRUM_VELOCITIES);
    V[0] = drum->wheel.radius * wheel->turn_rate;
    for (int i = 0; i < FU_TILTS && drum->wheel.tilts; ++i) V[1 + i] = drum->wheel.radius * wheel->omega[i];
    if (is_in_space(drum)) memcpy(V + SPACE, wheel->centre.v, sizeof(double) * SPACE);
    else memcpy(V + 1, wheel->c_rate, sizeof(double) * DIM);
}

/* Computes those at the start of a step. */
static void velocities_at(const fu_drum *drum, const fu_drum_history *past, const fu_drum_state *at,
                          double V[FU_DRUM_VELOCITIES])
{
    if (past->is_moving != 0.0) memcpy(V, past->V, sizeof past->V);
    else by_velocities(drum, at, V);
}

/* Returns the kinetic energy of the wound rope and of the drum. */
static double kinetic_energy(const fu_drum *drum, double u, const double V[FU_DRUM_VELOCITIES])
{
    const int about_diameters = is_in_space(drum) ? FU_TILTS : 0;
    const double spin = V[0] / drum->wheel.radius;
    return 0.5 * drum->wheel.inertia * spin * spin +
           0.5 * drum->wheel.rho * u * (fu_dot(FU_DRUM_VELOCITIES, V, V) - 0.5 * fu_dot(about_diameters, V + 1, V + 1));
}

/* Inertial forces and weight of the wound rope, and its velocities at both ends; on_drum: on its rotation on the
 * carrier, with which it turns in `moment`, too. */
typedef struct {
    double on_c[SPACE], moment[SPACE], on_drum, on_u, V_now[FU_DRUM_VELOCITIES], V[FU_DRUM_VELOCITIES];
} wound_rope;

static void find_wound_rope(const fu_drum *drum, const fu_equations *at, const drum_over *step, wound_rope *out)
{
    const fu_wheel *wheel = &drum->wheel;
    double *V = out->V_now;
    memset(out, 0, sizeof *out);
    velocities_at(drum, fu_drum_history_of(drum, at->now), &step->now, V);
    if (is_in_space(drum)) {
        const fu_groove_step *groove = &step->groove;
        wheel->foot->store_step(wheel->rho, at->h, wheel->radius, groove->gravity, step->now.u, step->length, step->own,
                                step->now.wheel.centre.p, groove->c_change, groove->axes, groove->axis, groove->theta,
                                V, out->on_c, out->moment, &out->on_drum, &out->on_u, out->V);
        return;
    }
    double change[DIM], F[2 + DIM];
    for (int d = 0; d < DIM; ++d) change[d] = step->next.wheel.c[d] - step->now.wheel.c[d];
    wheel->kernel->store_step(wheel->rho, at->h, wheel->radius, wheel->g, step->now.u, step->length, step->now.wheel.c,
                              change, step->turn, V, F, out->V);
    out->moment[0] = out->on_drum = F[0];
    memcpy(out->on_c, F + 1, sizeof(double) * DIM);
    out->on_u = F[1 + DIM];
}

void fu_drum_history_over_step(const fu_model *model, const fu_coupling *coupling, const fu_equations *at)
{
    const fu_drum *drum = drum_of(coupling);
    fu_drum_history *next = fu_drum_history_of(drum, at->next);
    wound_rope of;
    drum_over step;
    over_step(model, drum, at, &step);
    find_wound_rope(drum, at, &step, &of);
    memcpy(next->V, of.V, sizeof of.V);
    next->is_moving = 1.0;
}

void fu_drum_history_jump(const fu_model *model, const fu_coupling *coupling, fu_state *state, const double *change)
{
    const fu_drum *drum = drum_of(coupling);
    fu_drum_history *past = fu_drum_history_of(drum, state);
    fu_state jump = *state;
    double V[FU_DRUM_VELOCITIES];
    fu_drum_state at;
    if (past->is_moving == 0.0) return;
    jump.v = (double *)change;
    fu_drum_at(model, drum, &jump, 0, &at);
    by_velocities(drum, &at, V);
    for (int i = 0; i < FU_DRUM_VELOCITIES; ++i) past->V[i] += V[i];
}

double fu_drum_energy_beyond_velocities(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_drum *drum = drum_of(coupling);
    const fu_drum_history *past = fu_drum_history_of(drum, state);
    double V[FU_DRUM_VELOCITIES];
    fu_drum_state at;
    if (past->is_moving == 0.0) return 0.0;
    fu_drum_at(model, drum, state, 0, &at);
    by_velocities(drum, &at, V);
    return kinetic_energy(drum, at.u, past->V) - kinetic_energy(drum, at.u, V);
}

/* --- forces ----------------------------------------------------------------------------------------------------- */

/* Returns the elastic force on the wound length. */
static double elastic_force(const fu_drum *drum, const drum_over *step, double passing)
{
    const double span = 0.5 * (step->now.span_stretch + step->next.span_stretch);
    double W, loss;
    drum->wheel.kernel->creep(drum->wheel.A, drum->wheel.radius, passing, span, &W, &loss);
    return W - loss;
}

/* Forces over a step: on the node and its slope, the latter in the plane alone; on the centre and on turns of the
 * carrier; on the rotation of the drum on it; on the wound length. */
typedef struct {
    double node[SPACE], slope[DIM], centre[SPACE], moment[SPACE], on_drum, on_u;
} forces;

/* Adds a force on the node and its opposite on the carrier, in the plane with its moment about the centre. */
static void add_on_node(const fu_drum *drum, const drum_over *step, const double parts[DIM], double moment, forces *out)
{
    double force[SPACE] = {parts[0], parts[1], 0.0}, turn[SPACE] = {-moment, 0.0, 0.0};
    if (is_in_space(drum)) {
        for (int d = 0; d < SPACE; ++d) force[d] = fu_dot(DIM, step->groove.axes + d * DIM, parts);
        fu_cross(force, step->x, turn);
    }
    for (int d = 0; d < SPACE; ++d) {
        out->node[d] += force[d];
        out->centre[d] -= force[d];
        out->moment[d] += turn[d];
    }
}

/* Adds a moment on the turn of the tangent point, by its measure. */
static void add_on_turn(const fu_drum *drum, const drum_over *step, double moment, forces *out)
{
    const double size = moment * step->arm, parts[DIM] = {-size * step->middle.x[1], size * step->middle.x[0]};
    add_on_node(drum, step, parts, moment, out);
}

/* Adds the forces of the height at which the rope is laid on, in the plane linear in the place of the node. */
static void add_laying(const fu_drum *drum, const drum_over *step, forces *out)
{
    const fu_wheel *wheel = &drum->wheel;
    const double sense = fu_winding_sense(drum);
    double V, F[DIM], on_turn, moment[SPACE];
    if (is_in_space(drum)) {
        wheel->foot->laid_step(wheel->rho * sense * wheel->radius * wheel->radius / drum->stretch, step->groove.gravity,
                               step->groove.axes, step->now.phi, step->angle, &on_turn, moment);
        add_on_turn(drum, step, on_turn, out);
        for (int d = 0; d < SPACE; ++d) out->moment[d] += moment[d];
        return;
    }
    wheel->kernel->laying(wheel->rho, wheel->g, sense, wheel->radius, drum->stretch, step->middle.x, &V, F);
    add_on_node(drum, step, F, 0.0, out);
}

/* Adds the forces of the tangent point in the plane, |x| and the product of x and the slope, whose derivatives by the
 * mean vectors are discrete ones; computes the residuals. */
static void add_tangent_point(const fu_drum *drum, const drum_over *step, const double *multipliers, double phi[DIM],
                              forces *out)
{
    double J[DIM * NODE], unused[DIM * NODE], half_way[DIM], K[NODE * NODE];
    drum->wheel.kernel->tangent_point(step->next.x, step->next.slope, drum->tangent_radius, multipliers, phi, unused,
                                      K);
    drum->wheel.kernel->tangent_point(step->middle.x, step->middle.slope, drum->tangent_radius, multipliers, half_way,
                                      J, K);
    for (int r = 0; r < DIM; ++r) {
        const double *row = J + r * NODE, on_node[DIM] = {row[0] * multipliers[r], row[1] * multipliers[r]};
        add_on_node(drum, step, on_node, 0.0, out);
        for (int d = 0; d < DIM; ++d) out->slope[d] += row[SLOPE + d] * multipliers[r];
    }
}

/* Adds those in space: to the dofs of the span, too. */
static void add_foot(const fu_drum *drum, const fu_equations *at, const drum_over *step, const double *multipliers,
                     double phi[FU_FOOT_CONDITIONS], double *f, forces *out)
{
    const fu_wheel_state *now = &step->now.wheel, *next = &step->next.wheel;
    const fu_foot_step over = {
        .q = {at->now->q, at->next->q}, .centre = {now->centre.p, next->centre.p}, .axis = {now->axis, next->axis}};
    const fu_foot foot = foot_of(drum);
    fu_tangent_point end;
    fu_tangent_point_at(&foot, next, at->next->q, multipliers, &end);
    memcpy(phi, end.phi, sizeof end.phi);
    fu_tangent_point_over_step(&foot, &over, multipliers, f, out->centre, out->moment);
}

/* Adds all forces of a drum with its rope; computes the residuals of its conditions. */
static void add_rope(const fu_drum *drum, const fu_equations *at, const drum_over *step, const wound_rope *of,
                     const double *multipliers, double *phi, double *f, forces *out)
{
    const fu_drum_history *past = fu_drum_history_of(drum, at->next);
    const int winding = conditions_of(drum) - 1;
    const double passing = fu_drum_passing(drum, past, &step->next),
                 moment = fu_winding_sense(drum) * drum->wheel.radius * multipliers[winding];
    for (int d = 0; d < SPACE; ++d) {
        out->centre[d] += of->on_c[d];
        out->moment[d] += of->moment[d];
    }
    out->on_drum += of->on_drum - moment;
    out->on_u += of->on_u + elastic_force(drum, step, passing) - passing * multipliers[winding];
    add_laying(drum, step, out);
    add_on_turn(drum, step, step->part * moment, out);
    if (is_in_space(drum)) add_foot(drum, at, step, multipliers, phi, f, out);
    else add_tangent_point(drum, step, multipliers, phi, out);
    phi[winding] = fu_drum_winding_gap(drum, past, &step->next);
}

static void scatter(const fu_drum *drum, const drum_over *step, const forces *of, double *f)
{
    const int dim = is_in_space(drum) ? SPACE : DIM;
    for (int d = 0; d < dim; ++d) f[drum->node + d] += of->node[d];
    for (int d = 0; d < DIM && !is_in_space(drum); ++d) f[drum->node + SLOPE + d] += of->slope[d];
    f[drum->s] += drum->direction * of->on_u;
    if (drum->wheel.turn >= 0) f[drum->wheel.turn] += of->on_drum;
    fu_add_wrench(dim, &step->middle.wheel.centre, of->centre, of->moment, 1.0, f);
    fu_wheel_add_bearing(&drum->wheel, &step->middle.wheel, f);
}

void fu_drum_step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                           double *internal)
{
    const fu_drum *drum = drum_of(coupling);
    const double *multipliers = at->next->forces + coupling->force;
    double phi[MAX_CONDITIONS] = {0.0};
    forces of = {.on_u = 0.0};
    wound_rope rope;
    drum_over step;
    over_step(model, drum, at, &step);
    find_wound_rope(drum, at, &step, &rope);
    const int n = step.next.has_left ? 1 : conditions_of(drum);
    if (step.next.has_left) {
        phi[0] = step.next.u;
        of.on_u = multipliers[0];
    } else add_rope(drum, at, &step, &rope, multipliers, phi, f, &of);
    const double R = drum->wheel.radius, from = rope.V_now[0] / R, to = rope.V[0] / R;
    of.on_drum += fu_wheel_add_spin(&drum->wheel, from, to, &step.groove, at->h, of.moment);
    scatter(drum, &step, &of, f);
    for (int r = 0; r < n; ++r)
        internal[coupling->unknown + r] = -fu_row_unit(at->weights.inertia, coupling->scale[r]) * phi[r];
    for (int r = n; r < conditions_of(drum); ++r)
        internal[coupling->unknown + r] = -at->weights.stiffness * multipliers[r];
}

double fu_drum_step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at)
{
    const fu_drum *drum = drum_of(coupling);
    const fu_drum_history *past = fu_drum_history_of(drum, at->next);
    drum_over step;
    over_step(model, drum, at, &step);
    const double own = step.middle.wheel.own_rate, bearing = at->h * drum->wheel.damping * own * own;
    if (step.next.has_left) return bearing;
    const double force = elastic_force(drum, &step, fu_drum_passing(drum, past, &step.next));
    return bearing + force * step.length - fu_drum_stored(drum, past, &step.next);
}
