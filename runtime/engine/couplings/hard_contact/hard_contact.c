/* Hard contact of a point with a surface: while it is closed its distance is a constraint like that of a joint, eq 38,
 * whose multiplier can only push. events/hard_contact.c detects its closing and opening, events/impact.c has the
 * actions. */
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/common/attachments.h"
#include "couplings/hard_contact/hard_contact.h"

#include <string.h>

#define CONTACT_TOLERANCE 1e-9 /* m: largest distance of a contact in statics */

static const fu_hard_contact *contact_of(const fu_coupling *coupling)
{
    return (const fu_hard_contact *)coupling;
}

static int is_closed(const fu_coupling *coupling, const fu_state *state)
{
    return fu_hard_flags_of(coupling, state)->mode == FU_CLOSED;
}

static int has_friction(const fu_coupling *coupling)
{
    return contact_of(coupling)->friction > 0.0;
}

void fu_hard_row_at(const fu_model *model, const fu_hard_contact *contact, const fu_state *state, fu_hard_row *out)
{
    const int dim = model->dim;
    fu_attachment_state point, on;
    fu_distance distance;
    double arm[3], moment[3];
    fu_attachment_at(model, contact->contact.attachments, state, 0.0, FU_POINT, &point);
    fu_surface_at(model, &contact->contact.surface, state, &on);
    fu_surface_distance(dim, &contact->contact.surface, &on, point.p, &distance);
    out->g = distance.g - contact->contact.radius;
    memcpy(out->normal, distance.n, sizeof(double) * (size_t)dim);
    memcpy(out->curvature, distance.H, sizeof out->curvature);
    out->n = point.n + on.n;
    memcpy(out->at, point.at, sizeof(int) * (size_t)point.n);
    memcpy(out->at + point.n, on.at, sizeof(int) * (size_t)on.n);
    for (int d = 0; d < dim; ++d) arm[d] = point.p[d] - on.p[d];
    fu_moment_of(dim, arm, distance.n, moment);
    fu_wrench_force(dim, &point, distance.n, 0, 1.0, out->H);
    fu_wrench_force(dim, &on, distance.n, moment, -1.0, out->H + point.n);
    contact->contact.surface.kernel->motion(distance.n, distance.H, point.p, point.v, point.bias, on.p, on.v, on.bias,
                                            on.omega, on.alpha, &out->rate, &out->bias);
}

/* Adds rows of sticking friction, or the direction of friction of a sliding point. */
static void friction_rows(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const fu_hard_row *row, fu_rows *rows)
{
    const fu_hard_contact *contact = contact_of(coupling);
    fu_hard_along along;
    fu_hard_along_at(model, contact, state, row, &along);
    if (!fu_hard_flags_of(coupling, state)->sticks) {
        rows->is_pushed = 1;
        for (int i = 0; i < row->n; ++i) rows->column[i] = row->H[i] - contact->friction * along.slip[i];
        return;
    }
    rows->rows = model->dim;
    for (int k = 1; k < model->dim; ++k) {
        memcpy(rows->H + k * row->n, along.H[k - 1], sizeof(double) * (size_t)row->n);
        rows->W[k] = -along.bias[k - 1];
        rows->C[k] = rows->rate[k] = 0.0;
        rows->soft[k] = fu_hard_softness(contact, state->forces[coupling->force]);
    }
}

static void rows(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_accelerator *work)
{
    fu_rows *rows = &work->rows[coupling->row];
    fu_hard_row row;
    rows->n = rows->rows = 0;
    if (!is_closed(coupling, state)) return;
    fu_hard_row_at(model, contact_of(coupling), state, &row);
    rows->rows = 1;
    rows->n = row.n;
    memcpy(rows->at, row.at, sizeof(int) * (size_t)row.n);
    memcpy(rows->H, row.H, sizeof(double) * (size_t)row.n);
    rows->W[0] = -row.bias;
    rows->C[0] = row.g;
    rows->rate[0] = 0.0;
    if (has_friction(coupling)) friction_rows(model, coupling, state, &row, rows);
}

/* Returns the compliance of the distance to the multiplier, m/N: in statics, else zero. */
static double compliance(const fu_coupling *coupling, fu_weights weights)
{
    return weights.inertia == 0.0 ? 1.0 / contact_of(coupling)->stiffness : 0.0;
}

/* Writes the equation of the internal unknown: the residual of the distance, or that the unknown is zero. */
static void internal_residual(const fu_coupling *coupling, const fu_equations *at, double g, double *internal)
{
    const double multiplier = at->next->forces[coupling->force],
                 left = g - compliance(coupling, at->weights) * multiplier;
    if (is_closed(coupling, at->next))
        internal[coupling->unknown] = -fu_row_unit(at->weights.inertia, coupling->scale[0]) * left;
    else internal[coupling->unknown] = -at->weights.stiffness * at->next->forces[coupling->force];
}

/* Adds friction: against sliding, or the forces that keep velocities relative to the surface zero, as lengths over a
 * step. */
static void friction_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at,
                              const fu_hard_row *row, double *f, double *internal)
{
    const fu_hard_contact *contact = contact_of(coupling);
    const double *multipliers = at->next->forces + coupling->force,
                 unit = fu_row_unit(at->weights.inertia, coupling->scale[0]);
    fu_hard_along along;
    fu_hard_along_at(model, contact, at->next, row, &along);
    if (!fu_hard_flags_of(coupling, at->next)->sticks) {
        for (int i = 0; i < row->n; ++i) f[row->at[i]] -= contact->friction * along.slip[i] * multipliers[0];
        return;
    }
    const double step = 1.0 / at->weights.rate,
                 soft = step * step * fu_hard_softness(contact, at->now->forces[coupling->force]);
    for (int k = 1; k < coupling->n_forces; ++k) {
        for (int i = 0; i < row->n; ++i) f[row->at[i]] += along.H[k - 1][i] * multipliers[k];
        internal[coupling->unknown + k] =
            -unit * (step * fu_dot(model->dim, along.t[k - 1], along.past) - soft * multipliers[k]);
    }
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                     double *internal)
{
    fu_hard_row row = {.g = 0.0};
    for (int k = 1; k < coupling->n_forces; ++k)
        internal[coupling->unknown + k] = -at->weights.stiffness * at->next->forces[coupling->force + k];
    if (is_closed(coupling, at->next)) {
        fu_hard_row_at(model, contact_of(coupling), at->next, &row);
        for (int i = 0; i < row.n; ++i) f[row.at[i]] += row.H[i] * at->next->forces[coupling->force];
        if (has_friction(coupling)) friction_residual(model, coupling, at, &row, f, internal);
    }
    internal_residual(coupling, at, row.g, internal);
}

/* Adds the derivatives of friction's forces by its internal unknowns, and of its rows by velocities; the rotation of
 * both with the unknowns is neglected. */
static void friction_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at,
                             const fu_hard_row *row, fu_system *system)
{
    const fu_hard_contact *contact = contact_of(coupling);
    const fu_weights weights = at->weights;
    const double unit = fu_row_unit(weights.inertia, coupling->scale[0]),
                 step = weights.rate > 0.0 ? 1.0 / weights.rate : 0.0;
    const int first = fu_extra(model, coupling->unknown), sticks = fu_hard_flags_of(coupling, at->next)->sticks;
    fu_hard_along along;
    fu_hard_along_at(model, contact, at->next, row, &along);
    for (int k = 1; k < coupling->n_forces; ++k) {
        const double soft = step * step * fu_hard_softness(contact, at->now->forces[coupling->force]);
        fu_add(model, system, first + k, first + k, sticks ? -unit * soft * unit / weights.stiffness : unit);
        if (sticks) fu_add_row_and_column(model, system, first + k, row->n, row->at, along.H[k - 1], unit);
    }
    for (int i = 0; i < row->n && !sticks; ++i)
        fu_add(model, system, row->at[i], first, -unit * contact->friction * along.slip[i]);
}

/* Adds, for a closed contact, the derivatives of its distance and of its multiplier's force by the unknowns. */
static void tangent_of_closed(const fu_model *model, const fu_coupling *coupling, const fu_equations *at,
                              const fu_hard_row *row, fu_system *system)
{
    const fu_hard_contact *contact = contact_of(coupling);
    const int dim = model->dim, internal = fu_extra(model, coupling->unknown);
    const double *psi = at->psi, multiplier = at->next->forces[coupling->force];
    const double unit = fu_row_unit(at->weights.inertia, coupling->scale[0]);
    fu_attachment_state on;
    fu_contact_point point = {.depth = 0.0};
    double turned[2 * FU_ATTACHMENT_COORDINATES];
    memcpy(turned, row->H, sizeof turned);
    fu_surface_at(model, &contact->contact.surface, at->next, &on);
    fu_turn_attachment(model, contact->contact.attachments, psi, turned, 1, row->n - on.n, 0);
    fu_turn_attachment(model, contact->contact.surface.on, psi, turned + row->n - on.n, 1, on.n, 0);
    for (int i = 0; i < row->n; ++i) {
        fu_add(model, system, row->at[i], internal, unit * row->H[i]);
        fu_add(model, system, internal, row->at[i], unit * turned[i]);
    }
    if (has_friction(coupling)) friction_tangent(model, coupling, at, row, system);
    fu_add(model, system, internal, internal, -unit * compliance(coupling, at->weights) / at->weights.stiffness);
    fu_contact_place(model, &contact->contact, &on, at->next, 0, 0, &point);
    for (int d = 0; d < dim; ++d) point.f[d] = -multiplier * row->normal[d];
    for (int i = 0; i < dim * dim; ++i) point.by_place[i] = -multiplier * row->curvature[i];
    fu_contact_add_derivatives(model, &contact->contact, &on, at->next, 0, 0, &point, psi, at->weights, system);
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    const int internal = fu_extra(model, coupling->unknown);
    fu_hard_row row;
    if (!is_closed(coupling, at->next)) {
        for (int k = 0; k < coupling->n_forces; ++k)
            fu_add(model, system, internal + k, internal + k, fu_row_unit(at->weights.inertia, coupling->scale[0]));
        return;
    }
    fu_hard_row_at(model, contact_of(coupling), at->next, &row);
    tangent_of_closed(model, coupling, at, &row, system);
}

/* Computes the row over a step: H psi is the change of the distance. */
static void step_row(const fu_model *model, const fu_hard_contact *contact, const fu_equations *at, fu_hard_row *out)
{
    const int dim = model->dim;
    const fu_surface *surface = &contact->contact.surface;
    const fu_attachment *to = contact->contact.attachments;
    fu_attachment_state point[2], on;
    fu_distance distance, middle;
    double g[2];
    const fu_state *states[2] = {at->now, at->next};
    fu_surface_at(model, surface, at->next, &on); /* it does not move */
    for (int e = 0; e < 2; ++e) {
        fu_attachment_at(model, to, states[e], 0.0, FU_POINT, &point[e]);
        fu_surface_distance(dim, surface, &on, point[e].p, &distance);
        g[e] = distance.g - contact->contact.radius;
    }
    fu_surface_step_normal(dim, surface, &on, point[0].p, point[1].p, g[1] - g[0], &middle, out->normal);
    fu_discrete_point(model, to, at->now, at->next, point[0].P);
    out->n = point[0].n;
    memcpy(out->at, point[0].at, sizeof(int) * (size_t)out->n);
    fu_wrench_force(dim, &point[0], out->normal, 0, 1.0, out->H);
    out->g = g[1];
}

static void step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                          double *internal)
{
    fu_hard_row row = {.g = 0.0};
    if (is_closed(coupling, at->next)) {
        step_row(model, contact_of(coupling), at, &row);
        for (int i = 0; i < row.n; ++i) f[row.at[i]] += row.H[i] * at->next->forces[coupling->force];
    }
    internal_residual(coupling, at, row.g, internal);
}

static void step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    const int internal = fu_extra(model, coupling->unknown);
    const double unit = fu_row_unit(at->weights.inertia, coupling->scale[0]);
    fu_hard_row row;
    if (!is_closed(coupling, at->next)) {
        fu_add(model, system, internal, internal, unit);
        return;
    }
    step_row(model, contact_of(coupling), at, &row);
    fu_add_row_and_column(model, system, internal, row.n, row.at, row.H, unit);
}

static void take_forces(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work, fu_state *state)
{
    (void)model;
    const int closed = is_closed(coupling, state);
    for (int k = 0; k < coupling->n_forces; ++k)
        state->forces[coupling->force + k] = closed ? work->multipliers[coupling->multiplier + k] : 0.0;
}

static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    fu_hard_contact_output *numbers = (fu_hard_contact_output *)out;
    const double *multiplier =
        work ? work->multipliers + coupling->multiplier : state->forces + coupling->force; /* or of statics */
    const double normal_force = is_closed(coupling, state) ? -*multiplier : 0.0;
    fu_hard_along along;
    fu_hard_row row;
    (void)acceleration;
    *numbers = (fu_hard_contact_output){.gap = 0.0};
    fu_hard_row_at(model, contact_of(coupling), state, &row);
    for (int d = 0; d < model->dim; ++d) numbers->force[d] = normal_force * row.normal[d];
    if (has_friction(coupling) && normal_force != 0.0) {
        fu_hard_along_at(model, contact_of(coupling), state, &row, &along);
        for (int d = 0; d < model->dim; ++d) {
            if (fu_hard_flags_of(coupling, state)->sticks)
                for (int k = 1; k < model->dim; ++k) numbers->friction_force[d] -= multiplier[k] * along.t[k - 1][d];
            else numbers->friction_force[d] = -contact_of(coupling)->friction * normal_force * along.direction[d];
            numbers->force[d] += numbers->friction_force[d];
        }
    }
    numbers->gap = row.g;
}

static void gaps(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *out)
{
    fu_hard_row row;
    fu_hard_row_at(model, contact_of(coupling), state, &row);
    for (int k = 0; k < coupling->n_forces; ++k) out[k] = 0.0;
    if (is_closed(coupling, state)) out[0] = row.g;
}

static double dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const fu_accelerator *work)
{
    const double normal_force = -(work ? work->multipliers + coupling->multiplier : state->forces + coupling->force)[0];
    fu_hard_row row;
    fu_hard_along along;
    if (!has_friction(coupling) || !is_closed(coupling, state) || fu_hard_flags_of(coupling, state)->sticks) return 0.0;
    fu_hard_row_at(model, contact_of(coupling), state, &row);
    fu_hard_along_at(model, contact_of(coupling), state, &row, &along);
    return contact_of(coupling)->friction * normal_force * fu_dot(model->dim, along.direction, along.past);
}

/* The direction of sliding is the history variable. */
static void update_history(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    fu_hard_row row;
    fu_hard_along along;
    if (!has_friction(coupling) || !is_closed(coupling, state) || fu_hard_flags_of(coupling, state)->sticks) return;
    fu_hard_row_at(model, contact_of(coupling), state, &row);
    fu_hard_along_at(model, contact_of(coupling), state, &row, &along);
    memcpy(fu_hard_numbers_of(coupling, state)->direction, along.direction, sizeof(double) * (size_t)model->dim);
}

/* In statics a point is in contact if its multiplier pushes, or if it is nearer than that: the active set follows from
 * both (Hintermueller). */
static void detect_contact(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    const fu_hard_contact *contact = contact_of(coupling);
    fu_hard_row row;
    fu_hard_row_at(model, contact, state, &row);
    const double normal_force = -state->forces[coupling->force];
    fu_hard_flags_of(coupling, state)->mode =
        normal_force > contact->stiffness * (row.g - CONTACT_TOLERANCE) ? FU_CLOSED : FU_APART;
}

static int is_possible(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    (void)model;
    const int mode = fu_hard_flags_of(coupling, state)->mode;
    return mode == FU_APART || mode == FU_CLOSED || mode == FU_IMPLIED;
}

static const fu_field fields[] = {
    FU_SURFACE_FIELDS(fu_contact),
    FU_FIELD(fu_contact, cable, FU_INTEGER, 0),
    FU_FIELD(fu_contact, radius, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_contact, attachments, FU_ATTACHMENT),
    FU_FIELD(fu_hard_contact, restitution, FU_REAL, 0),
    FU_FIELD(fu_hard_contact, rest_velocity, FU_REAL, 0),
    FU_FIELD_AS("sliding", fu_hard_contact, friction, FU_REAL),
    FU_FIELD(fu_hard_contact, weight, FU_REAL, 0),
    FU_FIELD_AS("static_stiffness", fu_hard_contact, stiffness, FU_REAL),
    {0},
};

static const fu_start_operations start = {.is_possible = is_possible};
static const fu_history_operations history = {.update = update_history};

static const fu_output output_fields[] = {
    FU_OUTPUT(fu_hard_contact_output, force, "N", "direction"),
    FU_OUTPUT(fu_hard_contact_output, friction_force, "N", "direction"),
    FU_OUTPUT(fu_hard_contact_output, gap, "m", NULL),
    FU_LAST_OUTPUT(fu_hard_contact_output),
};

const fu_coupling_type fu_hard_contact_type = {
    .name = "hard_contact",
    .size = sizeof(fu_hard_contact),
    .fields = fields,
    .output_fields = output_fields,
    .n_flags = (int)(sizeof(fu_hard_flags) / sizeof(int)),
    .n_numbers = (int)(sizeof(fu_hard_numbers) / sizeof(double)),
    .residual = residual,
    .tangent = tangent,
    .step_residual = step_residual,
    .step_tangent = step_tangent,
    .rows = rows,
    .take_forces = take_forces,
    .outputs = outputs,
    .gaps = gaps,
    .dissipation = dissipation,
    .detect = detect_contact,
    .history = &history,
    .start = &start,
};
