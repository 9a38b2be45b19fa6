/* Sheaves: two tangent points, and the wrap between them, as one coupling. */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/rope/rope.h"
#include "couplings/sheave/sheave.h"

#include <math.h>
#include <string.h>

static void inertial_force(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                           const double *a, double *f)
{
    (void)t;
    const fu_sheave *sheave = sheave_of(coupling);
    const fu_state state = {.q = (double *)q, .v = (double *)model->zero};
    fu_sheave_state at;
    double y[Y];
    fu_sheave_at(model, sheave, &state, a, &at);
    fu_sheave_inertial_forces(sheave, &at, y);
    fu_sheave_scatter(sheave, &at, y, f);
}

static void mass_matrix(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double scale,
                        fu_system *system)
{
    (void)t;
    const fu_sheave *sheave = sheave_of(coupling);
    const fu_state state = {.q = (double *)q, .v = (double *)model->zero};
    double K[Y][Y];
    fu_wheel_column columns[COLUMNS];
    fu_centre_moves moves;
    fu_sheave_state at;
    fu_sheave_at(model, sheave, &state, 0, &at);
    memset(K, 0, sizeof K);
    fu_sheave_add_mass(sheave, &at, scale, K);
    fu_wheel_moves(model, &at.wheel, &moves);
    const int n = fu_sheave_columns(sheave, &at, &moves, columns);
    fu_wheel_add_matrix(model, n, columns, columns, Y, K[0], system);
}

static double kinetic_energy(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                             const double *v, int past_fluid)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const fu_wheel *wheel = &sheave->wheel;
    const fu_state state = {.q = (double *)q, .v = (double *)v};
    fu_sheave_state at;
    (void)t, (void)past_fluid;
    fu_sheave_at(model, sheave, &state, 0, &at);
    double total = 0.5 * wheel->inertia * at.wheel.turn_rate * at.wheel.turn_rate, T, V;
    if (is_in_space(sheave)) {
        fu_sheave_energies_across(sheave, &at, &T, &V);
        total += T;
    }
    if (is_turning(sheave)) return total + fu_turning_wrap_energy(sheave, &at);
    for (int j = 0; j < sheave->n_zones; ++j) {
        const fu_zone of = fu_zone_at(&at, j);
        wheel->kernel->kinetic_energy(wheel->rho, wheel->radius, of.phi, of.l, of.phi_rate, at.wheel.c_rate, of.s_rate,
                                      &T);
        total += T;
    }
    return total;
}

static double potential_energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const fu_wheel *wheel = &sheave->wheel;
    const fu_state at_rest = {.q = state->q, .v = (double *)model->zero};
    fu_sheave_state at;
    double total = 0.0, T, V;
    fu_sheave_at(model, sheave, &at_rest, 0, &at);
    for (int j = 0; j < sheave->n_zones; ++j) {
        const fu_zone of = fu_zone_at(&at, j);
        wheel->kernel->weight(wheel->rho, at.wheel.g, wheel->radius, of.phi, at.wheel.c, of.l, &V);
        total += V;
    }
    if (is_in_space(sheave)) {
        fu_sheave_energies_across(sheave, &at, &T, &V);
        total += V;
    }
    return total;
}

/* --- the coupling ----------------------------------------------------------------------------------------------- */

static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    const fu_sheave *sheave = sheave_of(coupling);
    fu_sheave_state at;
    double y[Y];
    fu_sheave_at(model, sheave, state, 0, &at);
    fu_sheave_forces(sheave, &at, y);
    fu_sheave_scatter(sheave, &at, y, f);
    fu_wheel_add_bearing(&sheave->wheel, &at.wheel, f);
}

/* Returns the multiplier of the condition of a short wrap. */
static double multiplier_of_short(const fu_sheave *sheave, const fu_state *state)
{
    return fu_may_leave(sheave) ? state->forces[sheave->wheel.base.force + short_row(sheave)] : 0.0;
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations, double *f,
                     double *internal)
{
    const fu_sheave *sheave = sheave_of(coupling);
    fu_sheave_state at;
    double y[Y], phi[MAX_CONDITIONS];
    fu_sheave_at(model, sheave, equations->next, 0, &at);
    at.tension = multiplier_of_short(sheave, equations->next);
    fu_sheave_forces(sheave, &at, y);
    fu_sheave_add_all_multipliers(sheave, &at, equations->next->forces + coupling->force, phi, y, f);
    fu_sheave_scatter(sheave, &at, y, f);
    fu_wheel_add_bearing(&sheave->wheel, &at.wheel, f);
    const int n = fu_sheave_conditions(sheave, &at);
    for (int r = 0; r < n; ++r)
        internal[coupling->unknown + r] = -fu_row_unit(equations->weights.inertia, coupling->scale[r]) * phi[r];
    for (int r = n; r < coupling->n_forces; ++r)
        internal[coupling->unknown + r] = -equations->weights.stiffness * equations->next->forces[coupling->force + r];
}

/* Adds the tangent; derivatives of the acceleration of the centre by rotations of its body are neglected. */
static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations,
                    fu_system *system)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const fu_weights w = equations->weights;
    const fu_state *next = equations->next;
    double K[Y][Y], D[Y][Y], y[Y], phi[MAX_CONDITIONS];
    fu_centre_moves moves, by_psi;
    fu_wheel_column columns[COLUMNS], turned[COLUMNS];
    fu_sheave_state at;
    fu_sheave_at(model, sheave, next, next->acceleration, &at);
    at.tension = multiplier_of_short(sheave, next);
    memset(K, 0, sizeof K);
    memset(D, 0, sizeof D);
    fu_sheave_add_derivatives(sheave, &at, w, D, K);
    fu_wheel_by_psi(model, &sheave->wheel, &at.wheel, equations->psi, &by_psi);
    fu_wheel_moves(model, &at.wheel, &moves);
    const int n = fu_sheave_columns(sheave, &at, &moves, columns);
    fu_sheave_columns(sheave, &at, &by_psi, turned);
    fu_sheave_add_conditions(model, coupling, &at, equations, n, columns, turned, &by_psi, K, system);
    fu_wheel_add_matrix(model, n, columns, turned, Y, K[0], system);
    for (int i = 0; i < Y; ++i)
        for (int j = 0; j < Y; ++j) D[i][j] *= w.rate;
    if (w.rate != 0.0) fu_wheel_add_matrix(model, n, columns, columns, Y, D[0], system);
    fu_sheave_forces(sheave, &at, y);
    if (is_in_space(sheave) && at.mode == FU_SHORT)
        fu_sheave_add_turn_of_slopes(model, sheave, &at, y, w.stiffness, system);
    if (is_turning(sheave)) fu_turning_wrap_add_turning(model, sheave, &at, &by_psi, y, w.stiffness, system);
    fu_sheave_add_multipliers(sheave, &at, next->forces + coupling->force, phi, y);
    fu_wheel_add_tangent(model, &sheave->wheel, &at.wheel, equations, y + CENTRE, system);
}

/* Adds the derivatives over a step by those half-way. */
static void step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    const fu_state *next = at->next;
    fu_state middle = *at->middle;
    fu_equations half_way = *at;
    middle.acceleration = next->acceleration;
    middle.forces = next->forces;
    middle.numbers = next->numbers;
    middle.flags = next->flags;
    half_way.next = &middle;
    tangent(model, coupling, &half_way, system);
}

static void take_forces(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work, fu_state *state)
{
    fu_sheave_state at;
    fu_sheave_at(model, sheave_of(coupling), state, 0, &at);
    const int n = fu_sheave_conditions(sheave_of(coupling), &at);
    for (int r = 0; r < coupling->n_forces; ++r)
        state->forces[coupling->force + r] = r < n ? work->multipliers[coupling->multiplier + r] : 0.0;
}

static void gaps(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *phi)
{
    const fu_sheave *sheave = sheave_of(coupling);
    double y[Y] = {0.0};
    fu_sheave_state at;
    fu_sheave_at(model, sheave, state, 0, &at);
    fu_sheave_add_multipliers(sheave, &at, state->forces + coupling->force, phi, y);
}

static double energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const fu_wheel *wheel = &sheave->wheel;
    double total = 0.0;
    fu_sheave_state at;
    fu_sheave_at(model, sheave, state, 0, &at);
    if (!fu_stretches(at.mode)) return at.mode == FU_SHORT ? fu_short_wrap_energy(sheave, &at) : 0.0;
    for (int j = 0; j < sheave->n_zones; ++j) {
        const fu_zone of = fu_zone_at(&at, j);
        double stored;
        wheel->kernel->energy(wheel->A, wheel->sense, wheel->radius, of.phi, of.l, &stored);
        total += stored;
    }
    return total;
}

static double dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const fu_accelerator *work)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const fu_wheel *wheel = &sheave->wheel;
    double total = 0.0, power;
    fu_sheave_state at;
    (void)work;
    if (!coupling->is_damped) return 0.0;
    fu_sheave_at(model, sheave, state, 0, &at);
    total += wheel->damping * at.wheel.own_rate * at.wheel.own_rate;
    for (int j = 0; sheave->tau > 0.0 && fu_stretches(at.mode) && j < sheave->n_zones; ++j) {
        const fu_zone of = fu_zone_at(&at, j);
        wheel->kernel->dissipation(wheel->A, sheave->tau, wheel->radius, of.phi, of.l, of.phi_rate, of.s_rate, &power);
        total += power;
    }
    for (int j = 0; j < friction_points(sheave, &at); ++j) {
        double F[3], numbers[3];
        fu_friction_at(sheave, &at, j, F, numbers, &power);
        total += power;
    }
    return total;
}

int fu_is_in_space(const fu_coupling *sheave)
{
    return is_in_space(sheave_of(sheave));
}

/* Returns in words what exceeds the limits of the engine. */
static const char *excess(const fu_coupling *coupling)
{
    return sheave_of(coupling)->n_zones > MAX_ZONES ? "zones" : 0;
}

/* Determines the mode where it is not known yet, and where a rope lies beside the plane of its groove. */
static void update_mode(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    const double rounding = 1e-9; /* of the radius */
    const fu_sheave *sheave = sheave_of(coupling);
    fu_place_in_groove *place = fu_place_in(sheave, state);
    fu_sheave_state at;
    if (!fu_may_leave(sheave) || (*fu_wrap_flag(sheave, state) && place->is_known != 0.0)) return;
    fu_sheave_at(model, sheave, state, 0, &at);
    *fu_wrap_flag(sheave, state) = at.mode;
    place->is_known = 1.0;
    if (!is_in_space(sheave) || at.mode == FU_LIFTED) return;
    const double aside = 0.5 * (at.rise[0] + at.rise[1]);
    place->aside = fabs(aside) > rounding * sheave->wheel.radius && fabs(aside) <= sheave->mouth ? aside : 0.0;
}

static int is_possible(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    (void)model;
    const int mode = *fu_wrap_flag(sheave_of(coupling), state);
    return mode >= 0 && mode <= FU_CHORDED;
}

static const char *const foot_role[] = {"tangent_point", 0};

static const fu_field fields[] = {
    FU_FIELD(fu_wheel, kernel, FU_KERNELS, 0),
    FU_FIELD(fu_wheel, foot, FU_KERNELS, foot_role),
    FU_WHEEL_FIELDS_IN_SPACE,
    FU_WHEEL_FIELDS,
    FU_FIELD_ARRAY(fu_sheave, weight, FU_REAL),
    FU_FIELD(fu_sheave, limit, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_sheave, chord, FU_REAL),
    FU_FIELD_ARRAY(fu_sheave, span_first, FU_INTEGER),
    FU_FIELD_ARRAY(fu_sheave, span_elements, FU_INTEGER),
    FU_FIELD_ARRAY(fu_sheave, span_reach, FU_INTEGER),
    FU_FIELD_ARRAY(fu_sheave, span_s, FU_INTEGER),
    FU_FIELD(fu_sheave, share_before, FU_REALS, 0),
    FU_FIELD(fu_sheave, share_after, FU_REALS, 0),
    FU_FIELD_ARRAY(fu_sheave, nodes, FU_INTEGER),
    FU_FIELD(fu_sheave, s, FU_INTEGERS, 0),
    FU_FIELD(fu_sheave, n_zones, FU_INTEGER, 0),
    FU_FIELD(fu_sheave, friction, FU_REAL, 0),
    FU_FIELD(fu_sheave, slip_velocity, FU_REAL, 0),
    FU_FIELD(fu_sheave, wrap_points, FU_INTEGER, 0),
    FU_FIELD(fu_sheave, least_wrap, FU_REAL, 0),
    FU_FIELD(fu_sheave, no_length, FU_REAL, 0),
    FU_FIELD(fu_sheave, mouth, FU_REAL, 0),
    FU_FIELD(fu_sheave, kink, FU_REAL, 0),
    FU_FIELD(fu_sheave, closing, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_sheave, tangent_radius, FU_REAL),
    FU_FIELD(fu_sheave, tau, FU_REAL, 0),
    {0},
};

static const fu_inertia_operations inertia = {.force = inertial_force,
                                              .matrix = mass_matrix,
                                              .kinetic_energy = kinetic_energy,
                                              .potential_energy = potential_energy,
                                              .beyond_velocities = fu_sheave_energy_beyond_velocities};
static const fu_start_operations start = {
    .excess = excess, .may_be_open = fu_wheel_may_be_open, .is_possible = is_possible};
static const fu_history_operations history = {.size = fu_sheave_history_size,
                                              .over_step = fu_sheave_history_over_step,
                                              .jump = fu_sheave_history_jump,
                                              .update = update_mode,
                                              .velocities = fu_sheave_velocities};

const fu_coupling_type fu_sheave_type = {
    .name = "sheave",
    .size = sizeof(fu_sheave),
    .fields = fields,
    .output_fields = fu_sheave_output_fields,
    .n_numbers = FU_SHEAVE_NUMBERS,
    .n_flags = 1,
    .history = &history,
    .inertia = &inertia,
    .supply = &fu_wheel_supply,
    .start = &start,
    .residual = residual,
    .tangent = tangent,
    .step_residual = fu_sheave_step_residual,
    .step_tangent = step_tangent,
    .step_dissipation = fu_sheave_step_dissipation,
    .rows = fu_sheave_rows,
    .force = force,
    .take_forces = take_forces,
    .outputs = fu_sheave_outputs,
    .gaps = gaps,
    .energy = energy,
    .dissipation = dissipation,
};
