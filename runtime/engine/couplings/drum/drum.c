/* Drums: the coupling and its results. */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/drum/drum.h"
#include "couplings/rope/rope.h"

#include <math.h>
#include <string.h>

typedef struct {
    double tension, force[3], torque, power, length_in_store, material_speed, normal_force, angle, residual,
        fleet_angle;
} drum_output;

/* Adds forces by y to those on the dofs; in space there are none on the slope. */
static void scatter(const fu_drum *drum, const fu_drum_state *at, const double *y, double *f)
{
    double on_node[SPACE];
    if (is_in_space(drum)) {
        fu_out_of_groove(&at->wheel, y, on_node);
        for (int d = 0; d < SPACE; ++d) f[drum->node + d] += on_node[d];
    } else
        for (int i = 0; i < NODE; ++i) f[drum->node + i] += y[i];
    f[drum->s] += drum->direction * y[LENGTH];
    fu_wheel_add_forces(&drum->wheel, &at->wheel, y + CENTRE, f);
}

/* Adds the moment on the body of forces on a node that is off the plane of the groove: zero on its condition. */
static void add_rise(const fu_drum *drum, const fu_drum_state *at, double y[Y])
{
    if (!drum->wheel.tilts) return;
    y[TILT] += at->rise * y[1];
    y[TILT + 1] -= at->rise * y[0];
}

/* --- inertia ---------------------------------------------------------------------------------------------------- */

static void inertial_force(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                           const double *a, double *f)
{
    (void)t;
    const fu_drum *drum = drum_of(coupling);
    const fu_state state = {.q = (double *)q};
    double M[Y][Y], acceleration[Y] = {0.0}, y[Y] = {0.0};
    fu_wheel_column columns[COLUMNS];
    fu_centre_moves moves;
    fu_drum_state at;
    fu_drum_at(model, drum, &state, 0, &at);
    fu_wheel_moves(model, &at.wheel, &moves);
    const int n = fu_drum_columns(drum, &at, &moves, columns);
    for (int j = 0; j < n; ++j)
        for (int k = 0; k < columns[j].n; ++k)
            acceleration[columns[j].row + k] += columns[j].value[k] * a[columns[j].dof];
    fu_drum_mass(drum, &at, 1.0, M);
    for (int i = 0; i < Y; ++i) y[i] = fu_dot(Y, M[i], acceleration);
    scatter(drum, &at, y, f);
}

static void mass_matrix(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double scale,
                        fu_system *system)
{
    (void)t;
    const fu_state state = {.q = (double *)q};
    double M[Y][Y];
    fu_wheel_column columns[COLUMNS];
    fu_centre_moves moves;
    fu_drum_state at;
    fu_drum_at(model, drum_of(coupling), &state, 0, &at);
    fu_drum_mass(drum_of(coupling), &at, scale, M);
    fu_wheel_moves(model, &at.wheel, &moves);
    const int n = fu_drum_columns(drum_of(coupling), &at, &moves, columns);
    fu_wheel_add_matrix(model, n, columns, columns, Y, M[0], system);
}

/* Computes the kinetic energy and that of gravity at a state. */
static void energies(const fu_model *model, const fu_coupling *coupling, const double *q, const double *v, double *T,
                     double *V)
{
    const fu_state state = {.q = (double *)q, .v = (double *)v};
    fu_drum_state at;
    fu_drum_at(model, drum_of(coupling), &state, 0, &at);
    fu_drum_energies(drum_of(coupling), &at, T, V);
}

static double kinetic_energy(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                             const double *v, int past_fluid)
{
    double T, V;
    (void)t, (void)past_fluid;
    energies(model, coupling, q, v, &T, &V);
    return T;
}

static double potential_energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_drum_history *past = fu_drum_history_of(drum_of(coupling), state);
    double T, V;
    if (past->has_left != 0.0) return past->laid;
    energies(model, coupling, state->q, 0, &T, &V);
    return V;
}

/* --- the coupling ----------------------------------------------------------------------------------------------- */

static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    const fu_drum *drum = drum_of(coupling);
    fu_drum_state at;
    double y[Y];
    fu_drum_at(model, drum, state, 0, &at);
    fu_drum_forces(drum, &at, y);
    add_rise(drum, &at, y);
    scatter(drum, &at, y, f);
    fu_wheel_add_bearing(&drum->wheel, &at.wheel, f);
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations, double *f,
                     double *internal)
{
    const fu_drum *drum = drum_of(coupling);
    const double *multipliers = equations->next->forces + coupling->force;
    fu_drum_state at;
    fu_drum_conditions of;
    double y[Y];
    fu_drum_at(model, drum, equations->next, 0, &at);
    fu_drum_conditions_at(drum, &at, equations->next, multipliers, &of);
    fu_drum_forces(drum, &at, y);
    fu_drum_add_all_multipliers(&of, multipliers, y, f);
    add_rise(drum, &at, y);
    scatter(drum, &at, y, f);
    fu_wheel_add_bearing(&drum->wheel, &at.wheel, f);
    for (int r = 0; r < of.n; ++r)
        internal[coupling->unknown + r] = -fu_row_unit(equations->weights.inertia, coupling->scale[r]) * of.phi[r];
    for (int r = of.n; r < conditions_of(drum); ++r)
        internal[coupling->unknown + r] = -equations->weights.stiffness * multipliers[r];
}

/* Adds the derivatives by rotations of the groove of all forces but those of a tangent point; those on the wheel with
 * the latter. */
static void add_motion_of_wheel(const fu_model *model, const fu_drum *drum, const fu_drum_state *at,
                                const fu_drum_conditions *of, const double *multipliers, const fu_centre_moves *by_psi,
                                const fu_equations *equations, fu_system *system)
{
    const int winding = conditions_of(drum) - 1;
    double y[Y];
    fu_drum_forces(drum, at, y);
    if (drum->wheel.tilts) {
        fu_turning_force on_node = {.node = drum->node};
        double turning[Y];
        memcpy(turning, y, sizeof turning);
        for (int j = 0; j < Y; ++j) turning[j] += of->J[winding][j] * multipliers[winding];
        add_rise(drum, at, turning);
        for (int d = 0; d < SPACE; ++d) on_node.arm[d] = at->q[drum->node + d] - at->wheel.centre.p[d];
        fu_out_of_groove(&at->wheel, turning, on_node.force);
        fu_wheel_add_turning(model, &at->wheel, by_psi, 1, &on_node, turning + CENTRE, equations->weights.stiffness,
                             system);
    }
    fu_drum_add_multipliers(at, of, multipliers, y);
    fu_wheel_add_tangent(model, &drum->wheel, &at->wheel, equations, y + CENTRE, system);
}

/* Adds the tangent; derivatives of the acceleration of the centre by rotations of its body are neglected. */
static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations,
                    fu_system *system)
{
    const fu_drum *drum = drum_of(coupling);
    const fu_weights w = equations->weights;
    const double *multipliers = equations->next->forces + coupling->force;
    double D_y[Y][Y], K_y[Y][Y];
    fu_centre_moves moves, by_psi;
    fu_wheel_column columns[COLUMNS], turned[COLUMNS];
    fu_drum_state at;
    fu_drum_conditions of;
    fu_drum_at(model, drum, equations->next, equations->next->acceleration, &at);
    fu_drum_conditions_at(drum, &at, equations->next, multipliers, &of);
    memset(D_y, 0, sizeof D_y);
    for (int i = 0; i < Y; ++i)
        for (int j = 0; j < Y; ++j) K_y[i][j] = w.stiffness * of.K[i][j];
    fu_drum_add_derivatives(drum, &at, w, D_y, K_y);
    fu_wheel_by_psi(model, &drum->wheel, &at.wheel, equations->psi, &by_psi);
    fu_wheel_moves(model, &at.wheel, &moves);
    const int n = fu_drum_columns(drum, &at, &moves, columns);
    fu_drum_columns(drum, &at, &by_psi, turned);
    fu_drum_add_rows(model, coupling, &at, &of, n, columns, turned, &by_psi, equations, system);
    fu_wheel_add_matrix(model, n, columns, turned, Y, K_y[0], system);
    if (w.rate != 0.0) fu_wheel_add_matrix(model, n, columns, columns, Y, D_y[0], system);
    add_motion_of_wheel(model, drum, &at, &of, multipliers, &by_psi, equations, system);
}

/* Adds the derivatives of the equations over a step by those half-way. */
static void step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    const fu_state *next = at->next;
    fu_state middle = *at->middle;
    fu_equations half_way = *at;
    middle.acceleration = next->acceleration;
    middle.forces = next->forces;
    middle.numbers = next->numbers;
    half_way.next = &middle;
    tangent(model, coupling, &half_way, system);
}

static void take_forces(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work, fu_state *state)
{
    const int left = fu_drum_history_of(drum_of(coupling), state)->has_left != 0.0;
    (void)model;
    for (int r = 0; r < coupling->n_forces; ++r)
        state->forces[coupling->force + r] = left && r > 0 ? 0.0 : work->multipliers[coupling->multiplier + r];
}

static void gaps(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *phi)
{
    const fu_drum *drum = drum_of(coupling);
    fu_drum_state at;
    fu_drum_conditions of;
    fu_drum_at(model, drum, state, 0, &at);
    fu_drum_conditions_at(drum, &at, state, state->forces + coupling->force, &of);
    memcpy(phi, of.phi, sizeof(double) * (size_t)coupling->n_forces);
}

double fu_drum_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_drum *drum = drum_of(coupling);
    (void)model;
    if (fu_drum_history_of(drum, state)->has_left != 0.0) return 1.0;
    return drum->direction * (state->q[drum->s] - drum->end);
}

int fu_drum_leaves(const fu_coupling *coupling)
{
    return drum_of(coupling)->leaves;
}

int fu_drum_is_in_space(const fu_coupling *drum)
{
    return is_in_space(drum_of(drum));
}

/* Returns the fleet angle, in space. */
static double fleet_angle(const fu_drum *drum, const fu_drum_state *at)
{
    const fu_foot foot = foot_of(drum);
    return fu_fleet_angle(&foot, at->q, at->wheel.axis);
}

double fu_drum_fleet_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_drum *drum = drum_of(coupling);
    fu_drum_state at;
    fu_drum_at(model, drum, state, 0, &at);
    if (at.has_left) return 1.0;
    return fu_span_fleet_margin(state->q[drum->span_s[1]] - state->q[drum->span_s[0]], drum->wheel.radius,
                                fleet_angle(drum, &at));
}

/* Returns the stretch of the span along the groove. */
static double stretch_along(const fu_drum *drum, const fu_drum_state *at, const double t[DIM])
{
    return is_in_space(drum) ? at->slope[0] : fu_dot(DIM, t, at->slope);
}

/* Computes the speed of the material on the tangent of the groove, past the centre. */
static double speed_of(const fu_drum *drum, const fu_drum_state *at, double t[DIM])
{
    const fu_wheel *wheel = &drum->wheel;
    t[0] = -wheel->sense * sin(at->phi);
    t[1] = wheel->sense * cos(at->phi);
    return fu_dot(DIM, t, at->x_rate) - stretch_along(drum, at, t) * drum->direction * at->u_rate;
}

/* Returns the normal force on an angle at the tangent point, by the elastic tension of the span there. */
static double pressure(const fu_drum *drum, const fu_drum_state *at)
{
    double t[DIM];
    const double speed = speed_of(drum, at, t), tension = drum->wheel.A[0] * (stretch_along(drum, at, t) - 1.0);
    return fu_wheel_pressure(&drum->wheel, &at->wheel, at->phi, tension, speed, at->span_stretch);
}

double fu_drum_pressure(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    fu_drum_state at;
    fu_drum_at(model, drum_of(coupling), state, state->acceleration, &at);
    return at.has_left ? 1.0 : pressure(drum_of(coupling), &at);
}

/* Returns the arm of a force along the groove over that of the tension, see sheave_output.c. */
static double arm_over_radius(const fu_drum *drum, const fu_drum_state *at)
{
    return is_in_space(drum) ? sqrt(fu_dot(DIM, at->x, at->x)) / drum->tangent_radius : 1.0;
}

/* The tension is that at the node by the balance of its momentum, see sheave_output.c. */
static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    const fu_drum *drum = drum_of(coupling);
    const fu_wheel *wheel = &drum->wheel;
    const double *multipliers = work ? work->multipliers + coupling->multiplier : state->forces + coupling->force;
    drum_output *numbers = (drum_output *)out;
    double y[Y], t[DIM], on_centre[SPACE];
    fu_drum_state at;
    fu_drum_conditions of;
    fu_drum_at(model, drum, state, acceleration, &at);
    fu_drum_conditions_at(drum, &at, state, multipliers, &of);
    fu_drum_forces(drum, &at, y);
    fu_drum_add_multipliers(&at, &of, multipliers, y);
    const double speed = speed_of(drum, &at, t), s_rate = drum->direction * at.u_rate;
    const double velocity = speed + fu_dot(DIM, t, at.wheel.c_rate);
    *numbers = (drum_output){.length_in_store = at.u, .material_speed = -s_rate, .angle = at.turn};
    numbers->tension =
        drum->direction * arm_over_radius(drum, &at) * fu_dot(DIM, t, y) - wheel->rho * s_rate * velocity;
    numbers->normal_force = at.has_left ? 0.0 : pressure(drum, &at);
    numbers->torque = y[TURN] + wheel->damping * at.wheel.own_rate;
    numbers->power = numbers->torque * at.wheel.own_rate;
    fu_wheel_force(wheel, &at.wheel, y + CENTRE, on_centre);
    for (int d = 0; d < SPACE; ++d) numbers->force[d] = d < DIM || is_in_space(drum) ? -on_centre[d] : 0.0;
    for (int r = 0; r < conditions_of(drum) - 1; ++r) numbers->residual = fmax(numbers->residual, fabs(of.phi[r]));
    numbers->fleet_angle = of.has_foot ? fleet_angle(drum, &at) : 0.0;
}

static const char *const role[] = {"sheave", 0}, *const foot_role[] = {"tangent_point", 0};

static const fu_field fields[] = {
    FU_FIELD(fu_wheel, kernel, FU_KERNELS, role),
    FU_FIELD(fu_wheel, foot, FU_KERNELS, foot_role),
    FU_WHEEL_FIELDS_IN_SPACE,
    FU_WHEEL_FIELDS,
    FU_FIELD_ARRAY(fu_drum, weight, FU_REAL),
    FU_FIELD(fu_drum, limit, FU_REAL, 0),
    FU_FIELD(fu_drum, chord, FU_REAL, 0),
    FU_FIELD(fu_drum, span_first, FU_INTEGER, 0),
    FU_FIELD(fu_drum, span_elements, FU_INTEGER, 0),
    FU_FIELD(fu_drum, span_reach, FU_INTEGER, 0),
    FU_FIELD_ARRAY(fu_drum, span_s, FU_INTEGER),
    FU_FIELD(fu_drum, share, FU_REALS, 0),
    FU_FIELD(fu_drum, node, FU_INTEGER, 0),
    FU_FIELD(fu_drum, s, FU_INTEGER, 0),
    FU_FIELD(fu_drum, n_cells, FU_INTEGER, 0),
    FU_FIELD(fu_drum, leaves, FU_INTEGER, 0),
    FU_FIELD(fu_drum, cell, FU_REAL, 0),
    FU_FIELD(fu_drum, direction, FU_REAL, 0),
    FU_FIELD(fu_drum, end, FU_REAL, 0),
    FU_FIELD(fu_drum, tangent_radius, FU_REAL, 0),
    FU_FIELD(fu_drum, stretch, FU_REAL, 0),
    {0},
};

static const fu_output output_fields[] = {
    FU_OUTPUT(drum_output, tension, "N", NULL),
    FU_OUTPUT(drum_output, force, "N", "direction"),
    FU_OUTPUT(drum_output, torque, "N m", NULL),
    FU_OUTPUT(drum_output, power, "W", NULL),
    FU_OUTPUT(drum_output, length_in_store, "m", NULL),
    FU_OUTPUT(drum_output, material_speed, "m/s", NULL),
    FU_OUTPUT(drum_output, normal_force, "N", NULL),
    FU_OUTPUT(drum_output, angle, "rad", NULL),
    FU_OUTPUT(drum_output, residual, "m", NULL),
    FU_OUTPUT(drum_output, fleet_angle, "rad", NULL),
    FU_LAST_OUTPUT(drum_output),
};

static const fu_inertia_operations inertia = {.force = inertial_force,
                                              .matrix = mass_matrix,
                                              .kinetic_energy = kinetic_energy,
                                              .potential_energy = potential_energy,
                                              .beyond_velocities = fu_drum_energy_beyond_velocities};
static const fu_start_operations start = {.may_be_open = fu_wheel_may_be_open};
static const fu_history_operations of_history = {
    .over_step = fu_drum_history_over_step, .jump = fu_drum_history_jump, .update = fu_drum_update};

const fu_coupling_type fu_drum_type = {
    .name = "drum",
    .size = sizeof(fu_drum),
    .fields = fields,
    .output_fields = output_fields,
    .n_numbers = FU_DRUM_HISTORY,
    .inertia = &inertia,
    .supply = &fu_wheel_supply,
    .start = &start,
    .history = &of_history,
    .residual = residual,
    .tangent = tangent,
    .step_residual = fu_drum_step_residual,
    .step_tangent = step_tangent,
    .step_dissipation = fu_drum_step_dissipation,
    .rows = fu_drum_rows,
    .force = force,
    .take_forces = take_forces,
    .outputs = outputs,
    .gaps = gaps,
    .energy = fu_drum_energy,
    .dissipation = fu_drum_dissipation,
};
