/* A tow: a wheel on a cable runs on a circular rail, and a spring of no length draws it to a point that moves at a
 * constant velocity. The spring breaks at a force. The kernels of one law give the spring's energy U(moving - p), and,
 * with the factor 1/radius, the equation of the rail phi = U(centre - p) = 0; its multiplier is an own force.
 * The flag of a state: whether the spring has broken; the number: the energy that it stored then, J.
 */
#include "base/event.h"
#include "bodies/unknowns.h"
#include "couplings/common/attachments.h"
#include "couplings/common/coupling_events.h"
#include "couplings/common/couplings.h"

#include <math.h>

typedef struct {
    fu_coupling base;
    const fu_point_law_kernels *law;
    fu_attachment attachments[1];
    double start[3], velocity[3], centre[3], spring[2], rail[2], strength; /* spring, rail: parameters of the law */
} fu_tow;

typedef struct {
    double force[3], reaction[3], position[3], stretch; /* on the wheel; of the rail alone; moving point; distance */
} fu_tow_output;

static const double no_rate[3] = {0.0, 0.0, 0.0};

static const fu_tow *tow_of(const fu_coupling *coupling)
{
    return (const fu_tow *)coupling;
}

/* Makes the motion of the wheel, and the gaps to the moving point and to the centre of the rail; returns the distance
 * to the moving point, m. */
static double gaps_at(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                      fu_attachment_state *at, double gap[3], double spoke[3])
{
    const fu_tow *tow = tow_of(coupling);
    double square = 0.0;
    fu_attachment_at(model, &tow->attachments[0], state, 0.0, FU_POINT, at);
    for (int d = 0; d < 3; ++d) {
        gap[d] = tow->start[d] + tow->velocity[d] * state->t - at->p[d];
        spoke[d] = tow->centre[d] - at->p[d];
        square += gap[d] * gap[d];
    }
    return sqrt(square);
}

static int is_broken(const fu_coupling *coupling, const fu_state *state)
{
    return state->flags[coupling->flags];
}

/* Makes the force of the spring, and of the rail for a multiplier of one, both on the wheel; returns phi, m. */
static double forces_at(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                        fu_attachment_state *at, double pull[3], double guide[3])
{
    const fu_tow *tow = tow_of(coupling);
    double gap[3], spoke[3], phi;
    gaps_at(model, coupling, state, at, gap, spoke);
    for (int d = 0; d < 3; ++d) pull[d] = guide[d] = 0.0;
    if (!is_broken(coupling, state)) tow->law->force(tow->spring, gap, no_rate, pull);
    tow->law->force(tow->rail, spoke, no_rate, guide);
    tow->law->energy(tow->rail, spoke, &phi);
    return phi;
}

/* Adds a force on the wheel, times a factor, to the left of the equations of motion. */
static void add(const fu_model *model, const fu_attachment_state *at, double factor, const double *force, double *f)
{
    for (int i = 0; i < at->n; ++i)
        for (int d = 0; d < model->dim; ++d) f[at->at[i]] -= factor * at->P[d * at->n + i] * force[d];
}

static double unit_of(const fu_coupling *coupling, const fu_equations *at)
{
    return fu_row_unit(at->weights.inertia, coupling->scale[0]);
}

static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    fu_attachment_state at;
    double pull[3], guide[3];
    forces_at(model, coupling, state, &at, pull, guide);
    add(model, &at, 1.0, pull, f);
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f, double *own)
{
    fu_attachment_state on;
    double pull[3], guide[3];
    own[coupling->unknown] = -unit_of(coupling, at) * forces_at(model, coupling, at->next, &on, pull, guide);
    add(model, &on, 1.0, pull, f);
    add(model, &on, at->next->forces[coupling->force], guide, f);
}

/* Makes the forces over a step, as forces_at has them: their work is the change of U and of phi. */
static void step_forces(const fu_model *model, const fu_coupling *coupling, const fu_equations *at,
                        fu_attachment_state *on, double pull[3], double guide[3])
{
    const fu_tow *tow = tow_of(coupling);
    double gap[3], spoke[3], gap_next[3], spoke_next[3], unused;
    gaps_at(model, coupling, at->now, on, gap, spoke);
    gaps_at(model, coupling, at->next, on, gap_next, spoke_next);
    for (int d = 0; d < 3; ++d) pull[d] = guide[d] = 0.0;
    if (!is_broken(coupling, at->now)) tow->law->discrete_force(tow->spring, at->h, gap, gap_next, pull, &unused);
    tow->law->discrete_force(tow->rail, at->h, spoke, spoke_next, guide, &unused);
}

static void step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                          double *own)
{
    fu_attachment_state on;
    double pull[3], guide[3];
    own[coupling->unknown] = -unit_of(coupling, at) * forces_at(model, coupling, at->next, &on, pull, guide);
    step_forces(model, coupling, at, &on, pull, guide);
    add(model, &on, 1.0, pull, f);
    add(model, &on, at->next->forces[coupling->force], guide, f);
}

/* Adds the derivatives; by_multiplier: the force of the rail in the equations of motion. The law is quadratic in the
 * gap: its stiffness does not depend on the state. */
static void add_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at,
                        const double by_multiplier[3], fu_system *system)
{
    const fu_tow *tow = tow_of(coupling);
    const int broken = is_broken(coupling, at->next), dim = model->dim, own = fu_extra(model, coupling->unknown);
    fu_attachment_state on;
    double pull[3], guide[3], K[9], K_rail[9], D[9], unused[3];
    forces_at(model, coupling, at->next, &on, pull, guide);
    tow->law->tangent(tow->spring, no_rate, no_rate, unused, K, D);
    tow->law->tangent(tow->rail, no_rate, no_rate, unused, K_rail, D);
    for (int k = 0; k < dim * dim; ++k) K[k] = (broken ? 0.0 : K[k]) + at->next->forces[coupling->force] * K_rail[k];
    for (int i = 0; i < on.n; ++i) {
        double row = 0.0, column = 0.0;
        for (int d = 0; d < dim; ++d) {
            row -= on.P[d * on.n + i] * guide[d];
            column -= on.P[d * on.n + i] * by_multiplier[d];
        }
        fu_add(model, system, own, on.at[i], unit_of(coupling, at) * row);
        fu_add(model, system, on.at[i], own, unit_of(coupling, at) * column);
        for (int j = 0; j < on.n; ++j) {
            double sum = 0.0;
            for (int d = 0; d < dim; ++d)
                for (int k = 0; k < dim; ++k) sum += on.P[d * on.n + i] * K[d * dim + k] * on.P[k * on.n + j];
            if (sum != 0.0) fu_add(model, system, on.at[i], on.at[j], at->weights.stiffness * sum);
        }
    }
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    fu_attachment_state on;
    double pull[3], guide[3];
    forces_at(model, coupling, at->next, &on, pull, guide);
    add_tangent(model, coupling, at, guide, system);
}

static void step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    fu_attachment_state on;
    double pull[3], guide[3];
    step_forces(model, coupling, at, &on, pull, guide);
    add_tangent(model, coupling, at, guide, system);
}

/* Makes the row of eq 38: phi'' = phi_q q'' + phi_p . bias + v . phi_pp v = 0. */
static void rows_of(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_accelerator *work)
{
    const fu_tow *tow = tow_of(coupling);
    fu_rows *rows = &work->rows[coupling->row];
    fu_attachment_state on;
    double pull[3], guide[3], K[9], D[9], unused[3];
    const int dim = model->dim;
    rows->C[0] = forces_at(model, coupling, state, &on, pull, guide);
    tow->law->tangent(tow->rail, no_rate, no_rate, unused, K, D);
    rows->rate[0] = rows->W[0] = 0.0;
    for (int d = 0; d < dim; ++d) {
        rows->W[0] += guide[d] * on.bias[d];
        for (int k = 0; k < dim; ++k) rows->W[0] -= on.v[d] * K[d * dim + k] * on.v[k];
    }
    rows->n = on.n;
    for (int i = 0; i < on.n; ++i) {
        rows->at[i] = on.at[i];
        rows->H[i] = 0.0;
        for (int d = 0; d < dim; ++d) rows->H[i] -= on.P[d * on.n + i] * guide[d];
    }
}

static void take_forces(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work, fu_state *state)
{
    (void)model;
    state->forces[coupling->force] = work->multipliers[coupling->multiplier];
}

static void gaps(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *phi)
{
    fu_attachment_state at;
    double pull[3], guide[3];
    phi[0] = forces_at(model, coupling, state, &at, pull, guide);
}

static double energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_tow *tow = tow_of(coupling);
    fu_attachment_state at;
    double gap[3], spoke[3], U;
    if (is_broken(coupling, state)) return state->numbers[coupling->numbers];
    gaps_at(model, coupling, state, &at, gap, spoke);
    tow->law->energy(tow->spring, gap, &U);
    return U;
}

static double power(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    fu_attachment_state at;
    double pull[3], guide[3], sum = 0.0;
    forces_at(model, coupling, state, &at, pull, guide);
    for (int d = 0; d < 3; ++d) sum += pull[d] * tow_of(coupling)->velocity[d];
    return sum;
}

static double step_work(const fu_model *model, const fu_coupling *coupling, const fu_equations *at)
{
    fu_attachment_state on;
    double pull[3], guide[3], sum = 0.0;
    step_forces(model, coupling, at, &on, pull, guide);
    for (int d = 0; d < 3; ++d) sum += at->h * pull[d] * tow_of(coupling)->velocity[d];
    return sum;
}

static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    fu_tow_output *numbers = (fu_tow_output *)out;
    const double multiplier = work ? work->multipliers[coupling->multiplier] : state->forces[coupling->force];
    fu_attachment_state at;
    double pull[3], guide[3], gap[3], spoke[3];
    (void)acceleration;
    forces_at(model, coupling, state, &at, pull, guide);
    numbers->stretch = gaps_at(model, coupling, state, &at, gap, spoke);
    for (int d = 0; d < 3; ++d) {
        numbers->reaction[d] = multiplier * guide[d];
        numbers->force[d] = pull[d] + numbers->reaction[d];
        numbers->position[d] = tow_of(coupling)->start[d] + tow_of(coupling)->velocity[d] * state->t;
    }
}

static double value_of(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int which)
{
    fu_attachment_state at;
    double gap[3], spoke[3];
    (void)which;
    if (is_broken(coupling, state)) return -1.0;
    return tow_of(coupling)->spring[0] * gaps_at(model, coupling, state, &at, gap, spoke) - tow_of(coupling)->strength;
}

static const char *change(const fu_model *model, const fu_coupling *coupling, fu_state *now, int which, int side)
{
    (void)which, (void)side;
    now->numbers[coupling->numbers] = energy(model, coupling, now);
    now->flags[coupling->flags] = 1;
    return "broke";
}

static const char *const role[] = {"point_law", 0};
static const fu_field fields[] = {
    FU_FIELD(fu_tow, law, FU_KERNELS, role),
    FU_FIELD_ARRAY(fu_tow, attachments, FU_ATTACHMENT),
    FU_FIELD_ARRAY(fu_tow, start, FU_REAL),
    FU_FIELD_ARRAY(fu_tow, velocity, FU_REAL),
    FU_FIELD_ARRAY(fu_tow, centre, FU_REAL),
    FU_FIELD_ARRAY(fu_tow, spring, FU_REAL),
    FU_FIELD_ARRAY(fu_tow, rail, FU_REAL),
    FU_FIELD(fu_tow, strength, FU_REAL, 0),
    {0},
};

static const fu_output output_fields[] = {
    FU_OUTPUT(fu_tow_output, force, "N", "direction"),
    FU_OUTPUT(fu_tow_output, reaction, "N", "direction"),
    FU_OUTPUT(fu_tow_output, position, "m", "point"),
    FU_OUTPUT(fu_tow_output, stretch, "m", NULL),
    FU_LAST_OUTPUT(fu_tow_output),
};

static const fu_supply_operations supply = {.power = power, .step_work = step_work};

const fu_coupling_type fu_tow_type = {.name = "tow",
                                      .size = sizeof(fu_tow),
                                      .fields = fields,
                                      .output_fields = output_fields,
                                      .n_numbers = 1,
                                      .n_flags = 1,
                                      .residual = residual,
                                      .tangent = tangent,
                                      .step_residual = step_residual,
                                      .step_tangent = step_tangent,
                                      .rows = rows_of,
                                      .force = force,
                                      .take_forces = take_forces,
                                      .outputs = outputs,
                                      .gaps = gaps,
                                      .energy = energy,
                                      .supply = &supply};

static const fu_state_event_operations of_state = {.value = value_of, .change = change};

const fu_coupling_events fu_tow_events = {.of_state = &of_state, .direction = 1};
