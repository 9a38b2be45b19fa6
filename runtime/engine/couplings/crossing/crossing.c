/* Two lines in contact at their closest points (derive/couplings/crossing.py). The force is a function of the state. In
 * a Newton matrix its change and the displacements of the closest points along both lines are internal unknowns, so
 * that two cables that cross do not widen the band: the matrix is equivalent to that without them. */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/common/attachments.h"
#include "couplings/crossing/crossing.h"

#include <math.h>
#include <string.h>

static const fu_crossing *crossing_of(const fu_coupling *coupling)
{
    return (const fu_crossing *)coupling;
}

/* Computes the friction of the force; adds sticking friction. */
static void add_friction(const fu_crossing *crossing, const fu_state *state, const fu_closest_points *points,
                         fu_crossing_contact *contact)
{
    fu_crossing_stick stick;
    for (int d = 0; d < 3 && crossing->law[FU_LAW_FRICTION] > 0.0; ++d)
        contact->friction[d] = contact->force[d] - contact->size * contact->normal[d];
    if (!(crossing->friction > 0.0)) return;
    fu_crossing_stick_at(crossing, state, points, contact, &stick);
    contact->sticks = stick.sticks;
    contact->energy += stick.energy;
    for (int d = 0; d < 3; ++d) {
        contact->friction[d] = stick.force[d];
        contact->force[d] += stick.force[d];
    }
}

/* Computes the force on the first line, the closest points, and the values of the contact. NaN without such points. */
static void contact_force(const fu_model *model, const fu_crossing *crossing, const fu_state *state,
                          fu_closest_points *points, fu_crossing_contact *contact, double force[3])
{
    const int in_contact = state->flags[crossing->base.flags];
    fu_find_closest(model, crossing, state, points);
    fu_crossing_contact_at(crossing, points, contact);
    if (!points->found || fu_crossing_swung(crossing, state, contact)) contact->size = NAN;
    add_friction(crossing, state, points, contact);
    for (int d = 0; d < 3; ++d) force[d] = !in_contact ? 0.0 : isnan(contact->size) ? NAN : contact->force[d];
}

/* Adds the contact force to the left of the equations of motion. */
static void add_force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    const fu_crossing *crossing = crossing_of(coupling);
    const int dim = model->dim;
    fu_closest_points points;
    fu_crossing_contact contact;
    fu_line_moves moves;
    double force[3];
    if (!state->flags[coupling->flags]) return;
    contact_force(model, crossing, state, &points, &contact, force);
    for (int line = 0; line < FU_LINES; ++line) {
        fu_line_moves_at(model, crossing, line, state, &points.line[line], &moves);
        for (int d = 0; d < dim; ++d)
            for (int i = 0; i < moves.n; ++i)
                f[moves.at[i]] += (line ? 1.0 : -1.0) * moves.P[d * moves.n + i] * force[d];
    }
}

/* The internal unknowns are changes in a matrix alone: their equations have no residual. */
static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                     double *internal)
{
    add_force(model, coupling, at->next, f);
    for (int i = 0; i < coupling->n_forces; ++i) internal[coupling->unknown + i] = 0.0;
}

/* The force on the first line and its derivatives, and those of the arc-lengths, from the kernel. */
typedef struct {
    double F[3], F_d[9], F_t[18], F_u[9], F_w[18], F_k[18], s_d[6], s_t[12];
    fu_line_bends has_accelerations;
} derivatives;

static void add_friction_derivatives(const fu_model *model, const fu_crossing *crossing, const fu_state *state,
                                     const fu_closest_points *points, derivatives *by)
{
    const int dim = crossing->kernel->dim;
    fu_crossing_stick_changes of;
    fu_crossing_contact contact;
    fu_crossing_contact_at(crossing, points, &contact);
    fu_line_bends_at(model, crossing, state, points, &by->has_accelerations);
    fu_crossing_stick_derivatives(crossing, state, points, &by->has_accelerations, &contact, &of);
    for (int d = 0; d < dim; ++d) by->F[d] += of.F[d];
    for (int i = 0; i < dim * dim; ++i) {
        by->F_d[i] += of.F_d[i];
        by->F_u[i] += of.F_u[i];
    }
    for (int i = 0; i < dim * dim * (dim - 1); ++i) by->F_t[i] += of.F_t[i];
    memcpy(by->F_w, of.F_w, sizeof by->F_w);
    memcpy(by->F_k, of.F_k, sizeof by->F_k);
}

/* Computes the motion of a line's point: `at` has the derivatives P of the point and T of the slope, and `by` those by
 * the unknowns of place, velocity, slope, rate of the slope and, of a cable, curvature; the last two where friction
 * sticks. */
static void motion_of_cable(const fu_model *model, int cable, const fu_line_point *point, const double *N_xx,
                            double rate, fu_point_motion *out)
{
    const int dim = model->dim, n = model->cables[cable].coordinates,
              first = fu_element_entry(&model->cables[cable], point->element);
    fu_element_motion(model, first, n, point->N, rate, out);
    memset(out->at.T, 0, sizeof(double) * (size_t)(dim * n));
    memset(out->by + 2 * dim * n, 0, sizeof(double) * (size_t)(3 * dim * n));
    for (int i = 0; i < n; ++i) {
        const int row = i % dim;
        out->at.T[row * n + i] = out->by[(2 * dim + row) * n + i] = point->N_x[i / dim];
        out->by[(3 * dim + row) * n + i] = rate * point->N_x[i / dim];
        out->by[(4 * dim + row) * n + i] = N_xx[i / dim];
    }
    out->rows = 5 * dim;
}

/* The same of a bar. Its slope is the difference between the point one metre on and the point. */
static void motion_of_bar(const fu_model *model, const fu_crossing *crossing, const fu_equations *at,
                          const fu_line_point *point, const double *force, fu_point_motion *out)
{
    const int dim = model->dim;
    fu_attachment on = point->on;
    fu_point_motion end;
    fu_point_motion_at(model, &on, at->next, FU_POINT, force, 0, at->psi, at->weights.rate, out);
    if (dim == 2) return;
    const int n = out->at.n;
    for (int d = 0; d < dim; ++d) on.u[d] += crossing->axis[d];
    fu_point_motion_at(model, &on, at->next, FU_POINT, 0, 0, at->psi, at->weights.rate, &end);
    for (int i = 0; i < dim * n; ++i) out->at.T[i] = end.at.P[i] - out->at.P[i];
    for (int i = 0; i < 2 * dim * n; ++i) out->by[2 * dim * n + i] = end.by[i] - out->by[i];
    out->rows = 4 * dim;
}

/* Writes the derivatives of n_values values by a vector (rows of `stride`), times a factor, into columns of `by`. */
static void put(int dim, int n_values, double factor, const double *values, int stride, int rows, double *by)
{
    for (int k = 0; k < n_values; ++k)
        for (int d = 0; d < dim; ++d) by[k * rows + d] = factor * values[k * stride + d];
}

/* Adds to a system the entries of a line's coordinates in the rows and columns of the internal unknowns, the first of
 * them in `row`: dim of the force, in N, and one of each arc-length, times the stiffness, in N. */
static void add_line(const fu_model *model, const fu_crossing *crossing, int line, const fu_equations *at,
                     const fu_closest_points *points, const derivatives *by, int row, double unit, fu_system *system)
{
    const int dim = model->dim, lines = dim - 1, cable = crossing->cables[line], all = lines * dim;
    const double sign = line ? -1.0 : 1.0, stiffness = at->weights.stiffness;
    double of[(3 + FU_LINES) * FU_MOTION_ROWS], changes[(3 + FU_LINES) * FU_ATTACHMENT_COORDINATES];
    fu_point_motion motion;
    if (cable >= 0)
        motion_of_cable(model, cable, &points->line[line], by->has_accelerations.N_xx[line], at->weights.rate, &motion);
    else motion_of_bar(model, crossing, at, &points->line[line], by->F, &motion);
    if (!(crossing->friction > 0.0) && motion.rows > 3 * dim) motion.rows = 3 * dim;
    const int n = motion.at.n, rows = motion.rows;
    double *of_s = of + dim * rows;
    memset(of, 0, sizeof(double) * (size_t)((dim + lines) * rows));
    put(dim, dim, sign, by->F_d, dim, rows, of);
    put(dim, dim, sign, by->F_u, dim, rows, of + dim);
    put(dim, lines, sign, by->s_d, dim, rows, of_s);
    if (line < lines) {
        put(dim, dim, 1.0, by->F_t + line * dim, all, rows, of + 2 * dim);
        put(dim, lines, 1.0, by->s_t + line * dim, all, rows, of_s + 2 * dim);
        if (rows > 3 * dim) put(dim, dim, 1.0, by->F_w + line * dim, all, rows, of + 3 * dim);
        if (rows > 4 * dim) put(dim, dim, 1.0, by->F_k + line * dim, all, rows, of + 4 * dim);
    }
    fu_changes(&motion, dim + lines, of, changes);
    for (int i = 0; i < n; ++i) {
        const int dof = motion.at.at[i];
        double along = 0.0;
        for (int d = 0; d < dim; ++d) {
            along += line < lines ? motion.at.T[d * n + i] * by->F[d] : 0.0;
            fu_add(model, system, row + d, dof, -stiffness * changes[d * n + i]);
            fu_add(model, system, dof, row + d, -sign * unit * motion.at.P[d * n + i]);
        }
        for (int l = 0; l < lines; ++l)
            fu_add(model, system, row + dim + l, dof, -stiffness * crossing->stiffness * changes[(dim + l) * n + i]);
        if (line < lines) fu_add(model, system, dof, row + dim + line, -sign * unit * along / crossing->stiffness);
        for (int j = 0; j < n && cable < 0; ++j)
            fu_add(model, system, dof, motion.at.at[j], -sign * stiffness * motion.K[i * n + j]);
    }
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    const fu_crossing *crossing = crossing_of(coupling);
    const int row = fu_extra(model, coupling->unknown);
    const double unit = fu_row_unit(at->weights.inertia, coupling->scale[0]);
    fu_closest_points points;
    derivatives by = {.has_accelerations = {{0.0}, {0.0}, {{0.0}}}};
    for (int i = 0; i < coupling->n_forces; ++i) fu_add(model, system, row + i, row + i, unit);
    if (!at->next->flags[coupling->flags]) return;
    fu_find_closest(model, crossing, at->next, &points);
    crossing->kernel->force(points.d, points.t, points.k, points.w, points.u, crossing->law, by.F, by.F_d, by.F_t,
                            by.F_u, by.s_d, by.s_t);
    if (crossing->friction > 0.0) add_friction_derivatives(model, crossing, at->next, &points, &by);
    for (int line = 0; line < FU_LINES; ++line) add_line(model, crossing, line, at, &points, &by, row, unit, system);
}

/* The middle moves by half of psi, which is in weights.stiffness; the law's mean force is approximated by that of the
 * middle. */
static void step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    const fu_state middle = fu_crossing_middle(at);
    fu_equations halfway = *at;
    halfway.next = &middle;
    halfway.psi = 0;
    tangent(model, coupling, &halfway, system);
}

static void take_forces(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work, fu_state *state)
{
    (void)model, (void)work;
    for (int i = 0; i < coupling->n_forces; ++i) state->forces[coupling->force + i] = 0.0;
}

/* The force on the first line and its size along the normal; the penetration of the lines; arc-lengths of the closest
 * points, and the one on the first line's axis; the friction of the force, and whether it sticks. */
typedef struct {
    double force[3], normal_force, penetration, s, s_b, position[3], friction_force[3], sticking;
} fu_crossing_output;

static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    fu_crossing_output *numbers = (fu_crossing_output *)out;
    fu_closest_points points;
    fu_crossing_contact contact;
    (void)acceleration, (void)work;
    contact_force(model, crossing_of(coupling), state, &points, &contact, numbers->force);
    numbers->normal_force = state->flags[coupling->flags] ? contact.size : 0.0;
    numbers->penetration = contact.depth[0];
    numbers->s = points.s[0];
    numbers->s_b = points.s[1];
    memcpy(numbers->position, points.line[0].r, sizeof points.line[0].r);
    for (int d = 0; d < 3; ++d) numbers->friction_force[d] = state->flags[coupling->flags] ? contact.friction[d] : 0.0;
    numbers->sticking = state->flags[coupling->flags] ? contact.sticks : 0.0;
}

static double energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    fu_closest_points points;
    fu_crossing_contact contact;
    double force[3];
    if (!state->flags[coupling->flags]) return state->numbers[coupling->numbers + FU_CROSSING_LEFT_BEHIND];
    contact_force(model, crossing_of(coupling), state, &points, &contact, force);
    return contact.energy;
}

static double dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const fu_accelerator *work)
{
    fu_closest_points points;
    fu_crossing_contact contact;
    double force[3];
    (void)work;
    if (!coupling->is_damped || !state->flags[coupling->flags]) return 0.0;
    contact_force(model, crossing_of(coupling), state, &points, &contact, force);
    return contact.dissipated;
}

/* Returns the dissipation of sticking friction by sliding. The energy stored by contact at its end is dissipated in the
 * step after. */
static double lost_in_step(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                           int by_ends)
{
    if (!from->flags[coupling->flags]) return from->numbers[coupling->numbers + FU_CROSSING_LEFT_BEHIND];
    return crossing_of(coupling)->friction > 0.0
               ? fu_crossing_slip_work(model, crossing_of(coupling), from, to, by_ends)
               : 0.0;
}

/* Records the closest points in the state, unless the lines have been parallel. */
static void note(const fu_coupling *coupling, const fu_closest_points *points, fu_state *state)
{
    fu_crossing_contact contact;
    double *numbers = state->numbers + coupling->numbers;
    fu_crossing_contact_at(crossing_of(coupling), points, &contact);
    if (points->found && !fu_crossing_swung(crossing_of(coupling), state, &contact)) {
        memcpy(numbers + FU_CROSSING_S, points->s, sizeof points->s);
        memcpy(numbers + FU_CROSSING_NORMAL, contact.normal, sizeof contact.normal);
    }
    numbers[FU_CROSSING_LEFT_BEHIND] = 0.0;
}

static void update_history(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    fu_closest_points points;
    fu_find_closest(model, crossing_of(coupling), state, &points);
    if (crossing_of(coupling)->friction > 0.0 && state->flags[coupling->flags] && points.found) {
        fu_crossing_contact contact;
        fu_crossing_contact_at(crossing_of(coupling), &points, &contact);
        fu_crossing_update_stick(crossing_of(coupling), &points, &contact, state);
    }
    note(coupling, &points, state);
}

static void reset(const fu_coupling *coupling, fu_state *state)
{
    const fu_crossing *crossing = crossing_of(coupling);
    memcpy(state->numbers + coupling->numbers + FU_CROSSING_S, crossing->start, sizeof crossing->start);
    if (crossing->friction > 0.0) fu_crossing_reset_stick(crossing, state);
}

/* In statics lines are in contact if they penetrate; without closest points the force is unknown. */
static void detect_contact(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    fu_closest_points points;
    fu_find_closest_anew(model, crossing_of(coupling), state, &points);
    note(coupling, &points, state);
    state->flags[coupling->flags] = !(fu_crossing_margin(model, crossing_of(coupling), state) <= 0.0);
}

static const char *const role[] = {"crossing", 0};
static const fu_field fields[] = {
    FU_FIELD(fu_crossing, kernel, FU_KERNELS, role),
    FU_FIELD_ARRAY(fu_crossing, cables, FU_INTEGER),
    FU_FIELD_ARRAY(fu_crossing, attachments, FU_ATTACHMENT),
    FU_FIELD_ARRAY(fu_crossing, axis, FU_REAL),
    FU_FIELD_ARRAY(fu_crossing, low, FU_REAL),
    FU_FIELD_ARRAY(fu_crossing, high, FU_REAL),
    FU_FIELD_ARRAY(fu_crossing, law, FU_REAL),
    FU_FIELD_ARRAY(fu_crossing, start, FU_REAL),
    FU_FIELD_ARRAY(fu_crossing, separation, FU_REAL),
    FU_FIELD_ARRAY(fu_crossing, slopes, FU_REAL),
    FU_FIELD(fu_crossing, friction, FU_REAL, 0),
    FU_FIELD(fu_crossing, tangential, FU_REAL, 0),
    FU_FIELD(fu_crossing, stiffness, FU_REAL, 0),
    {0},
};

static const fu_proximity_operations proximity_of_lines = {.clearance = fu_crossing_clearance,
                                                           .between = fu_crossing_between};
static const fu_start_operations start = {.reset = reset};
static const fu_history_operations history = {.update = update_history, .error = fu_crossing_history_error};

static const fu_output output_fields[] = {
    FU_OUTPUT(fu_crossing_output, force, "N", "direction"),
    FU_OUTPUT(fu_crossing_output, normal_force, "N", NULL),
    FU_OUTPUT(fu_crossing_output, penetration, "m", NULL),
    FU_OUTPUT(fu_crossing_output, s, "m", NULL),
    FU_OUTPUT(fu_crossing_output, s_b, "m", NULL),
    FU_OUTPUT(fu_crossing_output, position, "m", "point"),
    FU_OUTPUT(fu_crossing_output, friction_force, "N", "direction"),
    FU_OUTPUT(fu_crossing_output, sticking, "1", NULL),
    FU_LAST_OUTPUT(fu_crossing_output),
};

const fu_coupling_type fu_crossing_type = {
    .name = "crossing",
    .size = sizeof(fu_crossing),
    .fields = fields,
    .output_fields = output_fields,
    .n_numbers = FU_CROSSING_NUMBERS,
    .n_flags = 1,
    .residual = residual,
    .tangent = tangent,
    .step_residual = fu_crossing_step_residual,
    .step_tangent = step_tangent,
    .step_dissipation = fu_crossing_step_dissipation,
    .force = add_force,
    .take_forces = take_forces,
    .outputs = outputs,
    .energy = energy,
    .dissipation = dissipation,
    .lost_in_step = lost_in_step,
    .detect = detect_contact,
    .proximity = &proximity_of_lines,
    .history = &history,
    .start = &start,
};
