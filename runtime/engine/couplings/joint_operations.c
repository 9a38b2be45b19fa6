/* What a joint does as a coupling. Its own unknowns are its multipliers; their equations are phi = 0. */
#include "engine.h"

#include <string.h>

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations, double *f,
                     double *own)
{
    const fu_joint *joint = (const fu_joint *)coupling;
    const fu_state *next = equations->next;
    const double *multipliers = next->forces + coupling->force, scale = equations->weights.stiffness;
    double phi[6], J[6 * 2 * FU_ATTACHMENT_COORDINATES];
    int at[2 * FU_ATTACHMENT_COORDINATES];
    if (fu_joint_is_inactive(model, joint, next)) {
        for (int r = 0; r < joint->kernel->rows; ++r) own[coupling->unknown + r] = -scale * multipliers[r];
        return;
    }
    const int n = fu_joint_equations(model, joint, next, phi, at, J);
    for (int r = 0; r < joint->kernel->rows; ++r) {
        if (joint->redundant_rows >> r & 1) phi[r] = 0.0;
        own[coupling->unknown + r] = -fu_row_unit(equations->weights.inertia, coupling->scale[r]) * phi[r];
        for (int i = 0; i < n; ++i) {
            const double pull = J[r * n + i] * multipliers[r];
            if (at[i] < model->n_dof) f[at[i]] += pull;
            else if (fu_joint_moves(model, joint, next, at[i])) own[at[i] - model->n_dof] -= scale * pull;
        }
    }
}

/* Adds unit rows where rows (bits of `which`) are not in use: their multipliers are nil. */
static void unit_rows(const fu_model *model, const fu_joint *joint, int which, double inertia, fu_system *system)
{
    const int first = fu_extra(model, joint->base.unknown);
    for (int r = 0; r < joint->kernel->rows; ++r)
        if (which >> r & 1) fu_add(model, system, first + r, first + r, fu_row_unit(inertia, joint->base.scale[r]));
}

/* Makes derivatives by the coordinates of both attachments those by psi. */
static void turn_ends(const fu_model *model, const fu_joint *joint, const double *psi, double *rows, int n_rows, int n,
                      int n_first)
{
    for (int e = 0; e < 2; ++e) fu_turn_attachment(model, &joint->attachments[e], psi, rows, n_rows, n, e ? n_first : 0);
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations, fu_system *system)
{
    const fu_joint *joint = (const fu_joint *)coupling;
    const fu_state *next = equations->next;
    const fu_weights w = equations->weights;
    const int rows = joint->kernel->rows, first = fu_extra(model, coupling->unknown);
    double J[6 * 2 * FU_ATTACHMENT_COORDINATES], K[4 * FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES], unit[6];
    int at[2 * FU_ATTACHMENT_COORDINATES], unused[FU_ATTACHMENT_COORDINATES];
    if (fu_joint_is_inactive(model, joint, next)) {
        unit_rows(model, joint, ~0, w.inertia, system);
        return;
    }
    const int n = fu_joint_tangent(model, joint, next, at, J, K);
    const int n_first = fu_attachment_coordinates(model, &joint->attachments[0], next, unused);
    for (int r = 0; r < rows; ++r)
        if (joint->redundant_rows >> r & 1) memset(J + r * n, 0, sizeof(double) * (size_t)n);
    unit_rows(model, joint, joint->redundant_rows, w.inertia, system);
    for (int r = 0; r < rows; ++r) unit[r] = fu_row_unit(w.inertia, coupling->scale[r]);
    for (int r = 0; r < rows; ++r)
        for (int i = 0; i < n; ++i)
            if (J[r * n + i] != 0.0 && fu_joint_moves(model, joint, next, at[i]))
                fu_add(model, system, at[i], first + r, unit[r] * J[r * n + i]);
    turn_ends(model, joint, equations->psi, J, rows, n, n_first);
    turn_ends(model, joint, equations->psi, K, n, n, n_first);
    for (int i = 0; i < n; ++i) {
        for (int r = 0; r < rows; ++r)
            if (J[r * n + i] != 0.0) fu_add(model, system, first + r, at[i], unit[r] * J[r * n + i]);
        if (!fu_joint_moves(model, joint, next, at[i])) continue;
        for (int m = 0; m < n; ++m) {
            /* what is between two cables would widen the band: Newton converges without */
            if (K[i * n + m] == 0.0 || (fu_between_cables(joint) && (i < n_first) != (m < n_first))) continue;
            fu_add(model, system, at[i], at[m], w.stiffness * K[i * n + m]);
        }
    }
}

static void gaps(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *phi)
{
    double J[6 * 2 * FU_ATTACHMENT_COORDINATES];
    int at[2 * FU_ATTACHMENT_COORDINATES];
    fu_joint_equations(model, (const fu_joint *)coupling, state, phi, at, J);
}

static int may_start_open(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
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

static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const double *acceleration,
                    const fu_accelerator *work, double *out)
{
    (void)acceleration;
    fu_joint_outputs(model, (const fu_joint *)coupling, state, work->multipliers + coupling->multiplier,
                     (fu_joint_output *)out);
}

static const fu_field fields[] = {
    FU_FIELD(fu_joint, kernel, FU_KERNELS, 0),
    FU_FIELD_ARRAY(fu_joint, attachments, FU_ATTACHMENT),
    FU_FIELD_AS("drive", fu_joint, signal, FU_INTEGER),
    FU_FIELD(fu_joint, of_points, FU_INTEGER, 0),
    FU_FIELD_AS("base", fu_joint, c0, FU_REAL),
    {0},
};

const fu_coupling_type fu_joint_type = {
    .name = "joint",
    .size = sizeof(fu_joint),
    .fields = fields,
    .n_outputs = (int)(sizeof(fu_joint_output) / sizeof(double)),
    .residual = residual,
    .tangent = tangent,
    .rows = fu_joint_rows,
    .take_forces = take_forces,
    .outputs = outputs,
    .gaps = gaps,
    .may_start_open = may_start_open,
};
