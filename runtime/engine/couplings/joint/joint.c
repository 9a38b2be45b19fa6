/* A joint as a coupling. Its internal unknowns are its multipliers; their equations are phi = 0. */
#include "base/simd.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/joint/joint.h"

#include <string.h>

/* Adds n numbers times a factor. */
FU_INLINE void add_row(int n, double factor, const double *row, double *restrict to)
{
    for (int i = 0; i < n; ++i) to[i] += row[i] * factor;
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations, double *f,
                     double *internal)
{
    const fu_joint *joint = (const fu_joint *)coupling;
    const fu_state *next = equations->next;
    const double *multipliers = next->forces + coupling->force, scale = equations->weights.stiffness;
    fu_joint_rows_at at;
    if (fu_joint_is_inactive(model, joint, next)) {
        for (int r = 0; r < joint->kernel->rows; ++r) internal[coupling->unknown + r] = -scale * multipliers[r];
        return;
    }
    fu_joint_equations(model, joint, next, &at);
    for (int r = 0; r < joint->kernel->rows; ++r) {
        if (joint->redundant_rows >> r & 1) at.phi[r] = 0.0;
        internal[coupling->unknown + r] = -fu_row_unit(equations->weights.inertia, coupling->scale[r]) * at.phi[r];
        for (int e = 0; e < 2; ++e) {
            const int n = at.n[e], last = n - 1, on_slide = joint->attachments[e].slide >= 0;
            const int apart = (joint->attachments[e].rope ? 2 : 0) + on_slide;
            if (!n) continue; /* the ground */
            const double *J = at.J[e] + r * n;
            double *on = f + at.at[e][0]; /* an attachment's coordinates are contiguous, but for the last: s of the ends
                                           * of a span, and s of a slide */
            if (n == FU_FRAME_DOFS && !on_slide)
                add_row(FU_FRAME_DOFS, multipliers[r], J, on); /* a loop without remainder */
            else add_row(n - apart, multipliers[r], J, on);
            for (int i = n - apart; i < n - on_slide; ++i) f[at.at[e][i]] += multipliers[r] * J[i];
            if (on_slide && fu_joint_moves(model, joint, next, at.at[e][last]))
                internal[at.at[e][last] - model->n_dof] -= scale * (J[last] * multipliers[r]);
        }
    }
}

/* Adds unit rows for inactive rows (bits of `which`): their multipliers are zero. */
static void unit_rows(const fu_model *model, const fu_joint *joint, int which, double inertia, fu_system *system)
{
    const int first = fu_extra(model, joint->base.unknown);
    for (int r = 0; r < joint->kernel->rows; ++r)
        if (which >> r & 1) fu_add(model, system, first + r, first + r, fu_row_unit(inertia, joint->base.scale[r]));
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations,
                    fu_system *system)
{
    const fu_joint *joint = (const fu_joint *)coupling;
    const fu_weights w = equations->weights;
    const int rows = joint->kernel->rows;
    fu_joint_derivatives by;
    int at[6];
    if (fu_joint_is_inactive(model, joint, equations->next)) {
        unit_rows(model, joint, ~0, w.inertia, system);
        return;
    }
    fu_joint_tangent(model, joint, equations->next, equations->next->forces + coupling->force, &by);
    unit_rows(model, joint, joint->redundant_rows, w.inertia, system);
    for (int r = 0; r < rows; ++r) at[r] = fu_extra(model, coupling->unknown) + r;
    const fu_side internal = {rows, at, 1};
    fu_side columns[2], moving[2]; /* those with a row of their internal: s of a locked slide has another */
    for (int e = 0; e < 2; ++e) {
        columns[e] = moving[e] = (fu_side){by.n[e], by.at[e], joint->attachments[e].body >= 0};
        if (by.n[e]) moving[e].n -= !fu_joint_moves(model, joint, equations->next, by.at[e][by.n[e] - 1]);
    }
    for (int e = 0; e < 2; ++e) {
        const int n = by.n[e];
        double *J = by.J[e], scaled[6 * FU_ATTACHMENT_COORDINATES], unit[6];
        for (int r = 0; r < rows; ++r) {
            unit[r] = joint->redundant_rows >> r & 1 ? 0.0 : fu_row_unit(w.inertia, coupling->scale[r]);
            for (int i = 0; i < n; ++i) scaled[r * n + i] = unit[r] * J[r * n + i];
        }
        fu_add_block(model, system, moving[e], internal, 1.0, scaled, 1, n);
        fu_turn_attachment(model, &joint->attachments[e], equations->psi, J, rows + by.n[0] + by.n[1], n, 0);
        for (int r = 0; r < rows; ++r)
            for (int i = 0; i < n; ++i) J[r * n + i] *= unit[r];
        fu_add_block(model, system, internal, columns[e], 1.0, J, n, 1);
        fu_add_block(model, system, moving[e], columns[e], w.stiffness, by.K[e][e], n, 1);
        /* terms between two cables would widen the band: Newton converges without them */
        if (by.across && !fu_between_cables(joint))
            fu_add_block(model, system, moving[!e], columns[e], w.stiffness, by.K[!e][e], n, 1);
    }
}

/* --- joints of points over a step that conserves energy --------------------------------------------------------- */

/* The force between both points over a step, and the change of the gap between them. */
typedef struct {
    double force[3], change[3];
} force_over_step;

static force_over_step find_force(const fu_model *model, const fu_joint *joint, const fu_equations *equations)
{
    const int rows = joint->kernel->rows, dim = model->dim;
    const double *multipliers = equations->next->forces + joint->base.force;
    double gaps[2][3] = {{0.0}}, J[3 * 3];
    force_over_step out = {.force = {0.0}};
    for (int e = 0; e < 2; ++e) {
        const fu_state *states[2] = {equations->now, equations->next};
        for (int k = 0; k < 2; ++k) {
            fu_attachment_state end;
            fu_attachment_at(model, &joint->attachments[e], states[k], 0.0, FU_PLACE, &end);
            for (int d = 0; d < dim; ++d) gaps[k][d] += e ? end.p[d] : -end.p[d];
        }
    }
    joint->kernel->discrete(gaps[0], gaps[1], J);
    for (int d = 0; d < dim; ++d) {
        for (int r = 0; r < rows; ++r) out.force[d] += J[r * dim + d] * multipliers[r];
        out.change[d] = gaps[1][d] - gaps[0][d];
    }
    return out;
}

/* The equations at the end of the step. Their change is the discrete Jacobian by the gap times the change of the gap,
 * which has the discrete derivatives of the places: multipliers do the work of the drive alone. */
static void step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations, double *f,
                          double *internal)
{
    const fu_joint *joint = (const fu_joint *)coupling;
    const force_over_step of = find_force(model, joint, equations);
    fu_joint_rows_at at;
    for (int e = 0; e < 2; ++e)
        fu_add_point_over_step(model, &joint->attachments[e], equations->now, equations->next, of.force, e ? 1.0 : -1.0,
                               f);
    fu_joint_equations(model, joint, equations->next, &at);
    for (int r = 0; r < joint->kernel->rows; ++r)
        internal[coupling->unknown + r] = -fu_row_unit(equations->weights.inertia, coupling->scale[r]) *
                                          (joint->redundant_rows >> r & 1 ? 0.0 : at.phi[r]);
}

/* Adds the derivatives by those half-way. */
static void step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations,
                         fu_system *system)
{
    fu_state middle = *equations->middle;
    fu_equations half_way = *equations;
    middle.forces = equations->next->forces;
    half_way.next = &middle;
    tangent(model, coupling, &half_way, system);
}

/* Returns the work of the drive, which changes the gap. */
static double step_work(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations)
{
    const fu_joint *joint = (const fu_joint *)coupling;
    if (joint->signal < 0) return 0.0;
    const force_over_step of = find_force(model, joint, equations);
    return -fu_dot(model->dim, of.force, of.change);
}

/* Returns whether the joint has equations over a step. */
static int has_step(const fu_coupling *coupling)
{
    return ((const fu_joint *)coupling)->kernel->discrete != 0;
}

static void gaps(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *phi)
{
    fu_joint_rows_at at;
    fu_joint_equations(model, (const fu_joint *)coupling, state, &at);
    memcpy(phi, at.phi, sizeof(double) * (size_t)coupling->n_forces);
}

static int may_be_open(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    (void)model, (void)coupling, (void)state;
    return 1;
}

static void take_forces(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work, fu_state *state)
{
    (void)model;
    memcpy(state->forces + coupling->force, work->multipliers + coupling->multiplier,
           sizeof(double) * (size_t)coupling->n_forces);
}

static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    const double *multipliers =
        work ? work->multipliers + coupling->multiplier : state->forces + coupling->force; /* in equilibrium */
    (void)acceleration;
    fu_joint_outputs(model, (const fu_joint *)coupling, state, multipliers, (fu_joint_output *)out);
}

/* Returns whether a slide, or any for `which` -1, ties its rider's axes to the cable: their rotation is discontinuous
 * with the curvature. */
int fu_ties_a_frame(const fu_model *model, int which)
{
    FU_EACH_COUPLING(c, model->couplings, model->n_couplings) {
        if (c->type != &fu_joint_type) continue;
        const fu_joint *joint = (const fu_joint *)c;
        for (int e = 0; e < 2; ++e) {
            const int slide = joint->attachments[e].slide;
            if (slide >= 0 && (which < 0 || slide == which)) return 1;
        }
    }
    return 0;
}

static const char *const role[] = {"joint", 0};
static const fu_field fields[] = {
    FU_FIELD(fu_joint, kernel, FU_KERNELS, role),       FU_FIELD_ARRAY(fu_joint, attachments, FU_ATTACHMENT),
    FU_FIELD_AS("drive", fu_joint, signal, FU_INTEGER), FU_FIELD(fu_joint, of_points, FU_INTEGER, 0),
    FU_FIELD_AS("base", fu_joint, c0, FU_REAL),         {0},
};

static const fu_output output_fields[] = {
    FU_OUTPUT(fu_joint_output, force, "N", "direction"),
    FU_OUTPUT(fu_joint_output, moment, "N m", "direction"),
    FU_OUTPUT(fu_joint_output, residual, "m", NULL),
    FU_LAST_OUTPUT(fu_joint_output),
};

static const fu_start_operations start = {.may_be_open = may_be_open};
static const fu_supply_operations supply = {.step_work = step_work};

#define TYPE(kind)                                                                                                     \
    {.name = kind,                                                                                                     \
     .size = sizeof(fu_joint),                                                                                         \
     .fields = fields,                                                                                                 \
     .output_fields = output_fields,                                                                                   \
     .residual = residual,                                                                                             \
     .tangent = tangent,                                                                                               \
     .rows = fu_joint_rows,                                                                                            \
     .take_forces = take_forces,                                                                                       \
     .outputs = outputs,                                                                                               \
     .gaps = gaps,                                                                                                     \
     .start = &start,                                                                                                  \
     .supply = &supply,                                                                                                \
     .step_residual = step_residual,                                                                                   \
     .step_tangent = step_tangent,                                                                                     \
     .has_step = has_step}

const fu_coupling_type fu_joint_type = TYPE("joint");
const fu_coupling_type fu_anchor_type = TYPE("anchor"); /* between the end of a rope and a body */
