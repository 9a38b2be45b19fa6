/* Friction of a joint against the motions that it leaves free, as a coupling: forces with the rows of the Jacobian of
 * these motions, from rows' rates by the velocities. Over a speed of sliding u, rates times arms, it is
 *     (coefficient N / sqrt(u.u + v0^2) + viscous) u,
 * N the part across the axis of the joint's force, or the given normal force; with the sign of u in the place of the
 * smooth one for friction that sticks, whose motion is locked at rest by a constraint. In a Newton system the forces
 * are internal unknowns. */
#include "bodies/unknowns.h"
#include "couplings/common/accelerator.h"
#include "couplings/common/couplings.h"
#include "couplings/joint/joint.h"

#include <math.h>
#include <string.h>

#define MIN_NORMAL_FORCE 1e-30 /* N: a zero normal force has no direction */

enum { MAX_ROWS = 2 };

/* The law at a state: forces of the rows, their derivatives by the rates of rows and by the normal force, and the
 * dissipated power, W. */
typedef struct {
    double force[MAX_ROWS], by_rate[MAX_ROWS][MAX_ROWS], by_normal[MAX_ROWS], power;
} friction_law;

static const fu_joint_friction *of(const fu_coupling *coupling)
{
    return (const fu_joint_friction *)coupling;
}

/* Returns the direction opposed by friction, 0 for friction that rises smoothly with the speed. */
static int direction_of(const fu_model *model, const fu_joint_friction *friction, const fu_state *state)
{
    const fu_coupling *coupling = &friction->free.base;
    return coupling->type == &fu_joint_sticking_type ? fu_joint_sticking_flags(model, coupling, state)->slip_direction
                                                     : 0;
}

static int is_locked(const fu_coupling *coupling, const fu_state *state)
{
    return fu_joint_locked(&of(coupling)->free, state) != 0;
}

/* Returns the joint whose force presses; null for a given normal force. */
static const fu_joint *pressed_by(const fu_model *model, const fu_joint_friction *friction)
{
    return friction->pressed_by < 0 ? 0 : (const fu_joint *)model->couplings[friction->pressed_by];
}

/* Computes the part across the axis of a joint's force by its multipliers. */
static void force_across(const fu_model *model, const fu_joint_friction *friction, const fu_joint *joint,
                         const fu_state *state, const double *multipliers, double across[3])
{
    fu_joint_output out;
    fu_joint_outputs(model, joint, state, multipliers, &out);
    memcpy(across, out.force, sizeof out.force);
    if (model->dim == 2) return; /* the axis is normal to the plane, or the joint has no force along it */
    fu_attachment_state at;
    fu_attachment_at(model, &friction->free.attachments[0], state, 0.0, FU_AXES, &at);
    double along = 0.0;
    for (int d = 0; d < 3; ++d) along += at.A[3 * d + 2] * across[d];
    for (int d = 0; d < 3; ++d) across[d] -= along * at.A[3 * d + 2];
}

/* Returns the normal force by the multipliers of the joint, N, and, unless null, its derivatives by them. */
static double normal_force(const fu_model *model, const fu_joint_friction *friction, const fu_state *state,
                           const double *multipliers, double *by_multipliers)
{
    const fu_joint *joint = pressed_by(model, friction);
    double across[3], unit[6] = {0.0}, part[3];
    if (!joint) return friction->normal_force;
    force_across(model, friction, joint, state, multipliers, across);
    const double N = sqrt(fu_dot(3, across, across) + MIN_NORMAL_FORCE * MIN_NORMAL_FORCE);
    for (int r = 0; r < joint->kernel->rows && by_multipliers; ++r) {
        unit[r] = 1.0;
        force_across(model, friction, joint, state, unit, part);
        unit[r] = 0.0;
        by_multipliers[r] = fu_dot(3, across, part) / N;
    }
    return N;
}

/* Computes the law at a state with the derivatives of the free motions there, for a normal force in N. */
static void find_law(const fu_model *model, const fu_joint_friction *friction, const fu_state *state,
                     const fu_joint_rows_at *at, double N, friction_law *law)
{
    const int rows = friction->free.kernel->rows;
    const double scale = fu_scale_at(model, friction->scale, state->t), *arms = friction->arms;
    double u[MAX_ROWS] = {0.0};
    for (int r = 0; r < rows; ++r)
        for (int e = 0; e < 2; ++e)
            for (int i = 0; i < at->n[e]; ++i) u[r] += arms[r] * at->J[e][r * at->n[e] + i] * state->v[at->at[e][i]];
    const int direction = direction_of(model, friction, state);
    if (direction) {
        const double limit = scale * friction->coefficient * direction, viscous = scale * friction->viscous;
        law->force[0] = arms[0] * (limit * N + viscous * u[0]);
        law->by_normal[0] = arms[0] * limit;
        law->by_rate[0][0] = arms[0] * arms[0] * viscous;
        law->power = (limit * N + viscous * u[0]) * u[0];
        return;
    }
    const double square = fu_dot(rows, u, u), size = sqrt(square + friction->velocity * friction->velocity);
    const double slope = scale * friction->coefficient / size, drag = slope * N + scale * friction->viscous;
    for (int r = 0; r < rows; ++r) {
        law->force[r] = arms[r] * drag * u[r];
        law->by_normal[r] = arms[r] * slope * u[r];
        for (int k = 0; k < rows; ++k)
            law->by_rate[r][k] = arms[r] * arms[k] * ((r == k) * drag - slope * N * u[r] * u[k] / (size * size));
    }
    law->power = drag * square;
}

/* Sets the law of locked friction: the force of its constraint, without power. */
static void hold(const fu_coupling *coupling, const fu_state *state, const double *lambda, friction_law *law)
{
    *law = (friction_law){.force = {lambda ? lambda[coupling->multiplier] : state->forces[coupling->force]}};
}

/* Computes the free motions and the law at a state, by these multipliers of all couplings with constraints. */
static void look(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const double *lambda,
                 fu_joint_rows_at *at, friction_law *law)
{
    const fu_joint_friction *friction = of(coupling);
    const fu_joint *joint = pressed_by(model, friction);
    const double *multipliers = !joint   ? 0
                                : lambda ? lambda + joint->base.multiplier
                                         : state->forces + joint->base.force;
    fu_joint_equations(model, &friction->free, state, at);
    if (is_locked(coupling, state)) hold(coupling, state, lambda, law);
    else find_law(model, friction, state, at, normal_force(model, friction, state, multipliers, 0), law);
}

/* Adds the generalised forces of rows, times a factor. */
static void add_forces(const fu_joint_friction *friction, const fu_joint_rows_at *at, const double *force,
                       double factor, double *f)
{
    for (int r = 0; r < friction->free.kernel->rows; ++r)
        for (int e = 0; e < 2; ++e)
            for (int i = 0; i < at->n[e]; ++i) f[at->at[e][i]] += factor * force[r] * at->J[e][r * at->n[e] + i];
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations, double *f,
                     double *internal)
{
    const fu_state *next = equations->next;
    const double *force = next->forces + coupling->force;
    fu_joint_rows_at at;
    friction_law law;
    look(model, coupling, next, 0, &at, &law);
    add_forces(of(coupling), &at, force, 1.0, f);
    for (int r = 0; r < coupling->n_forces; ++r)
        internal[coupling->unknown + r] = is_locked(coupling, next)
                                              ? -fu_row_unit(equations->weights.inertia, coupling->scale[r]) * at.phi[r]
                                              : -equations->weights.stiffness * (force[r] - law.force[r]);
}

/* Adds the derivatives of the law by the velocities, whose rows J (rows x n, over the coordinates) belong to an
 * attachment, and by the multipliers of the joint. */
static void add_law(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations,
                    const fu_joint_rows_at *at, fu_system *system)
{
    const fu_joint_friction *friction = of(coupling);
    const fu_joint *joint = pressed_by(model, friction);
    const fu_weights w = equations->weights;
    const int rows = coupling->n_forces, first = fu_extra(model, coupling->unknown);
    double by_multipliers[6];
    friction_law law;
    const double N = normal_force(model, friction, equations->next,
                                  joint ? equations->next->forces + joint->base.force : 0, by_multipliers);
    find_law(model, friction, equations->next, at, N, &law);
    for (int r = 0; r < rows; ++r) {
        fu_add(model, system, first + r, first + r, fu_row_unit(w.inertia, coupling->scale[r]));
        for (int e = 0; e < 2; ++e)
            for (int i = 0; i < at->n[e]; ++i) {
                double by = 0.0;
                for (int k = 0; k < rows; ++k) by += law.by_rate[r][k] * at->J[e][k * at->n[e] + i];
                fu_add(model, system, first + r, at->at[e][i], -w.stiffness * w.rate * by);
            }
        for (int k = 0; joint && k < joint->kernel->rows; ++k)
            fu_add(model, system, first + r, fu_extra(model, joint->base.unknown) + k,
                   -fu_row_unit(w.inertia, joint->base.scale[k]) * law.by_normal[r] * by_multipliers[k]);
    }
}

/* The law's derivative by places at fixed velocities is left out: it is zero at rest, and where the axis stands. */
static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations,
                    fu_system *system)
{
    const fu_joint *joint = &of(coupling)->free;
    const fu_weights w = equations->weights;
    const int rows = coupling->n_forces;
    fu_joint_derivatives by;
    fu_joint_rows_at at;
    fu_joint_equations(model, joint, equations->next, &at);
    const int locked = is_locked(coupling, equations->next);
    if (!locked) add_law(model, coupling, equations, &at, system);
    fu_joint_tangent(model, joint, equations->next, equations->next->forces + coupling->force, &by);
    int internal[MAX_ROWS];
    for (int r = 0; r < rows; ++r) internal[r] = fu_extra(model, coupling->unknown) + r;
    for (int e = 0; e < 2; ++e) {
        const int n = by.n[e];
        const fu_side columns = {n, by.at[e], joint->attachments[e].body >= 0};
        const fu_side other = {by.n[!e], by.at[!e], joint->attachments[!e].body >= 0};
        double scaled[MAX_ROWS * FU_ATTACHMENT_COORDINATES];
        for (int r = 0; r < rows; ++r)
            for (int i = 0; i < n; ++i)
                scaled[r * n + i] = fu_row_unit(w.inertia, coupling->scale[r]) * at.J[e][r * n + i];
        fu_add_block(model, system, columns, (fu_side){rows, internal, 1}, 1.0, scaled, 1, n);
        fu_turn_attachment(model, &joint->attachments[e], equations->psi, by.J[e], rows + by.n[0] + by.n[1], n, 0);
        for (int i = 0; i < rows * n && locked; ++i)
            scaled[i] = fu_row_unit(w.inertia, coupling->scale[i / n]) * by.J[e][i];
        if (locked) fu_add_block(model, system, (fu_side){rows, internal, 1}, columns, 1.0, scaled, n, 1);
        fu_add_block(model, system, columns, columns, w.stiffness, by.K[e][e], n, 1);
        /* terms between two cables would widen the band: Newton converges without them */
        if (by.across && !fu_between_cables(joint))
            fu_add_block(model, system, other, columns, w.stiffness, by.K[!e][e], n, 1);
    }
}

/* Adds the force of a given normal force; that of a joint's force follows from the multipliers. */
static void add_force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    fu_joint_rows_at at;
    friction_law law;
    if (coupling->needs_reactions || is_locked(coupling, state)) return;
    look(model, coupling, state, 0, &at, &law);
    add_forces(of(coupling), &at, law.force, 1.0, f);
}

static double update(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const double *lambda,
                     fu_accelerator *work)
{
    fu_joint_rows_at at;
    friction_law law;
    double *known = work->scratch + coupling->scratch, change[MAX_ROWS], largest = 0.0, size = 0.0;
    if (!coupling->needs_reactions || is_locked(coupling, state)) return 0.0;
    look(model, coupling, state, lambda, &at, &law);
    for (int r = 0; r < coupling->n_forces; ++r) {
        change[r] = law.force[r] - (lambda ? known[r] : 0.0);
        known[r] = law.force[r];
        largest = fmax(largest, fabs(change[r]));
        size = fmax(size, fabs(law.force[r]));
    }
    add_forces(of(coupling), &at, change, -1.0, work->work);
    return largest > 0.0 ? largest / fmax(size, largest) : 0.0;
}

/* Friction is no reaction of the supports. */
static void accept(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const double *lambda,
                   fu_accelerator *work)
{
    fu_joint_rows_at at;
    friction_law law;
    if (!coupling->needs_reactions || is_locked(coupling, state)) return;
    look(model, coupling, state, lambda, &at, &law);
    add_forces(of(coupling), &at, law.force, 1.0, work->force);
}

static void take_forces(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work, fu_state *state)
{
    fu_joint_rows_at at;
    friction_law law;
    look(model, coupling, state, work->multipliers, &at, &law);
    memcpy(state->forces + coupling->force, law.force, sizeof(double) * (size_t)coupling->n_forces);
}

static double dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const fu_accelerator *work)
{
    fu_joint_rows_at at;
    friction_law law;
    look(model, coupling, state, work ? work->multipliers : 0, &at, &law);
    return law.power;
}

/* work: null in equilibrium. */
static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    fu_joint_rows_at at;
    friction_law law;
    (void)acceleration;
    look(model, coupling, state, work ? work->multipliers : 0, &at, &law);
    if (!work && coupling->n_multipliers) hold(coupling, state, 0, &law); /* the force that a search for rest found */
    fu_joint_outputs(model, &of(coupling)->free, state, law.force, (fu_joint_output *)out);
}

/* --- friction that sticks ---------------------------------------------------------------------------------------- */

void fu_joint_lock(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    double c[3];
    fu_joint_free_place(model, &of(coupling)->free, state, c);
    memcpy(fu_joint_sticking_numbers_of(coupling, state)->locked, c, sizeof c);
}

double fu_joint_free_rate(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    fu_joint_rows_at at;
    double rate = 0.0;
    fu_joint_equations(model, &of(coupling)->free, state, &at);
    for (int e = 0; e < 2; ++e)
        for (int i = 0; i < at.n[e]; ++i) rate += at.J[e][i] * state->v[at.at[e][i]];
    return rate;
}

double fu_joint_excess(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const double *lambda,
                       double *pull)
{
    const fu_joint_friction *friction = of(coupling);
    const fu_joint *joint = pressed_by(model, friction);
    const double *multipliers = !joint   ? 0
                                : lambda ? lambda + joint->base.multiplier
                                         : state->forces + joint->base.force;
    const double scale = fu_scale_at(model, friction->scale, state->t);
    *pull = lambda ? lambda[coupling->multiplier] : state->forces[coupling->force];
    return fabs(*pull) / friction->arms[0] -
           scale * friction->static_coefficient * normal_force(model, friction, state, multipliers, 0);
}

static int is_possible(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_sticking_flags *flags = fu_joint_sticking_flags(model, coupling, state);
    return (flags->mode == FU_SLIDES || flags->mode == FU_LOCKED) && flags->slip_direction >= -1 &&
           flags->slip_direction <= 1;
}

static const char *const role[] = {"joint", 0};
static const fu_field fields[] = {
    {"kernel", FU_KERNELS, offsetof(fu_joint_friction, free.kernel), 1, 0, role},
    {"attachments", FU_ATTACHMENT, offsetof(fu_joint_friction, free.attachments), 2, sizeof(fu_attachment), NULL},
    FU_FIELD_AS("drive", fu_joint_friction, free.signal, FU_INTEGER),
    FU_FIELD_AS("is_free", fu_joint_friction, free.is_free, FU_INTEGER),
    FU_FIELD(fu_joint_friction, pressed_by, FU_INTEGER, 0),
    FU_FIELD(fu_joint_friction, normal_force, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_joint_friction, arms, FU_REAL),
    FU_FIELD(fu_joint_friction, coefficient, FU_REAL, 0),
    FU_FIELD(fu_joint_friction, static_coefficient, FU_REAL, 0),
    FU_FIELD(fu_joint_friction, viscous, FU_REAL, 0),
    FU_FIELD(fu_joint_friction, velocity, FU_REAL, 0),
    FU_FIELD_AS("friction_scale", fu_joint_friction, scale, FU_INTEGER),
    {0},
};

static const fu_output output_fields[] = {
    FU_OUTPUT(fu_joint_output, force, "N", "direction"),
    FU_OUTPUT(fu_joint_output, moment, "N m", "direction"),
    FU_OUTPUT(fu_joint_output, residual, "m", NULL),
    FU_LAST_OUTPUT(fu_joint_output),
};

static const fu_reaction_operations reaction = {.update = update, .accept = accept};

static const fu_start_operations start = {.is_possible = is_possible};

#define TYPE(kind, ...)                                                                                                \
    {.name = kind,                                                                                                     \
     .size = sizeof(fu_joint_friction),                                                                                \
     .fields = fields,                                                                                                 \
     .output_fields = output_fields,                                                                                   \
     .n_scratch = MAX_ROWS,                                                                                            \
     .residual = residual,                                                                                             \
     .tangent = tangent,                                                                                               \
     .force = add_force,                                                                                               \
     .take_forces = take_forces,                                                                                       \
     .outputs = outputs,                                                                                               \
     .dissipation = dissipation,                                                                                       \
     .reaction = &reaction,                                                                                            \
     __VA_ARGS__}

const fu_coupling_type fu_joint_friction_type = TYPE("joint_friction", .start = 0);
const fu_coupling_type fu_joint_sticking_type =
    TYPE("joint_sticking", .start = &start, .rows = fu_joint_rows,
         .n_numbers = (int)(sizeof(fu_joint_sticking_numbers) / sizeof(double)),
         .n_flags = (int)(sizeof(fu_sticking_flags) / sizeof(int)));
