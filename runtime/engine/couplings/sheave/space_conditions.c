/* Conditions of a sheave in space but those of its wrap alone: of both tangent points, or of a rope that has left,
 * whose spans are joined in place and slope at the point next to the centre. */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/sheave/sheave.h"

#include <string.h>

enum { VECTORS = 2 * SPACE, ACROSS_SLOPE = 1 /* of a tangent point, whose place is across the slope */ };

/* Returns the tangent point k with the multipliers of the sheave; of a rope that has left the first one, on which
 * `ACROSS_SLOPE` alone acts. */
static fu_tangent_point find_foot(const fu_sheave *sheave, const fu_sheave_state *at, int k, const double *multipliers)
{
    const fu_foot of = fu_foot_of(sheave, at, k);
    const double nearest[FU_FOOT_CONDITIONS] = {0.0, multipliers[short_row(sheave)], 0.0};
    fu_tangent_point out;
    fu_tangent_point_at(&of, &at->wheel, at->q, at->mode == FU_LIFTED ? nearest : multipliers + FU_FOOT_CONDITIONS * k,
                        &out);
    return out;
}

/* Computes the residuals of the joint of both spans. */
static void find_joint(const fu_sheave *sheave, const fu_sheave_state *at, double phi[VECTORS])
{
    for (int i = 0; i < VECTORS; ++i) phi[i] = at->q[sheave->nodes[1] + i] - at->q[sheave->nodes[0] + i];
}

/* --- forces ----------------------------------------------------------------------------------------------------- */

static void add_joint(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers, double *phi,
                      double *f)
{
    const int nearest = short_row(sheave);
    const fu_tangent_point foot = find_foot(sheave, at, 0, multipliers);
    double rows[FU_FOOT_CONDITIONS * FU_FOOT_DOFS];
    fu_tangent_point_rows(&foot, rows);
    find_joint(sheave, at, phi);
    phi[nearest] = foot.phi[ACROSS_SLOPE];
    for (int i = 0; i < VECTORS; ++i) {
        f[sheave->nodes[0] + i] -= multipliers[i];
        f[sheave->nodes[1] + i] += multipliers[i];
    }
    for (int j = 0; j < foot.n; ++j) f[foot.dofs[j]] += rows[ACROSS_SLOPE * foot.n + j] * multipliers[nearest];
}

void fu_space_add_multipliers(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers,
                              double *phi, double *f)
{
    if (at->mode == FU_LIFTED) {
        add_joint(sheave, at, multipliers, phi, f);
        return;
    }
    for (int k = 0; k < ENDS; ++k) {
        const int first = FU_FOOT_CONDITIONS * k;
        const fu_tangent_point foot = find_foot(sheave, at, k, multipliers);
        double rows[FU_FOOT_CONDITIONS * FU_FOOT_DOFS];
        fu_tangent_point_rows(&foot, rows);
        memcpy(phi + first, foot.phi, sizeof foot.phi);
        for (int r = 0; r < FU_FOOT_CONDITIONS; ++r)
            for (int j = 0; j < foot.n; ++j) f[foot.dofs[j]] += rows[r * foot.n + j] * multipliers[first + r];
    }
}

static void add_joint_by_y(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers, double *phi,
                           double *y)
{
    const int nearest = short_row(sheave);
    const double on_foot[FU_FOOT_CONDITIONS] = {0.0, multipliers[nearest], 0.0};
    const fu_tangent_point foot = find_foot(sheave, at, 0, multipliers);
    double force[DIM];
    find_joint(sheave, at, phi);
    phi[nearest] = foot.phi[ACROSS_SLOPE];
    fu_into_groove(&at->wheel, multipliers, force);
    for (int d = 0; d < DIM; ++d) {
        y[d] -= force[d];
        y[NODE + d] += force[d];
    }
    fu_tangent_point_add_forces(&at->wheel, &foot, on_foot, y, y + CENTRE);
}

void fu_space_add_multipliers_by_y(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers,
                                   double *phi, double *y)
{
    if (at->mode == FU_LIFTED) {
        add_joint_by_y(sheave, at, multipliers, phi, y);
        return;
    }
    for (int k = 0; k < ENDS; ++k) {
        const int first = FU_FOOT_CONDITIONS * k;
        const fu_tangent_point foot = find_foot(sheave, at, k, multipliers);
        memcpy(phi + first, foot.phi, sizeof foot.phi);
        fu_tangent_point_add_forces(&at->wheel, &foot, multipliers + first, y + k * NODE, y + CENTRE);
    }
}

/* --- derivatives ------------------------------------------------------------------------------------------------ */

/* Adds the derivatives of n_rows conditions of a tangent point from number `first` on; row: number of that of the
 * sheave. */
static void add_foot(const fu_model *model, const fu_coupling *coupling, const fu_sheave_state *at,
                     const fu_equations *equations, const fu_centre_moves *by_psi, int k, int first, int n_rows,
                     int row, fu_system *system)
{
    const double *multipliers = equations->next->forces + coupling->force;
    const fu_tangent_point foot = find_foot(sheave_of(coupling), at, k, multipliers);
    double of_foot[FU_FOOT_CONDITIONS] = {0.0};
    memcpy(of_foot + first, multipliers + row, sizeof(double) * (size_t)n_rows);
    fu_tangent_point_add(model, &at->wheel, &foot, by_psi, of_foot, coupling->scale + row, equations->weights, first,
                         n_rows, fu_extra(model, coupling->unknown) + row, system);
}

void fu_space_add_conditions(const fu_model *model, const fu_coupling *coupling, const fu_sheave_state *at,
                             const fu_equations *equations, const fu_centre_moves *by_psi, fu_system *system)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const int own = fu_extra(model, coupling->unknown);
    for (int k = 0; k < ENDS && at->mode != FU_LIFTED; ++k)
        add_foot(model, coupling, at, equations, by_psi, k, 0, FU_FOOT_CONDITIONS, FU_FOOT_CONDITIONS * k, system);
    if (at->mode != FU_LIFTED) return;
    add_foot(model, coupling, at, equations, by_psi, 0, ACROSS_SLOPE, 1, short_row(sheave), system);
    for (int i = 0; i < VECTORS; ++i)
        for (int k = 0; k < ENDS; ++k) {
            const double unit = (k ? 1.0 : -1.0) * fu_row_unit(equations->weights.inertia, coupling->scale[i]);
            fu_add(model, system, own + i, sheave->nodes[k] + i, unit);
            fu_add(model, system, sheave->nodes[k] + i, own + i, unit);
        }
}

/* --- eq 38 ------------------------------------------------------------------------------------------------------ */

/* Returns the number of a dof among those of rows, to which it adds a new one. */
static int number_of(int dof, fu_rows *out)
{
    for (int i = 0; i < out->n; ++i)
        if (out->at[i] == dof) return i;
    out->at[out->n] = dof;
    return out->n++;
}

/* Adds the dofs on which the conditions of the wrap alone depend; computes the numbers of the columns, -1 for none. */
static void find_columns(int n, const fu_wheel_column *columns, int first, int end, double (*J)[Y], int *number,
                         fu_rows *out)
{
    for (int j = 0; j < n; ++j) {
        int counts = 0;
        for (int r = first; r < end; ++r) counts |= fu_by_column(&columns[j], J[r]) != 0.0;
        number[j] = counts ? number_of(columns[j].dof, out) : -1;
    }
}

/* Computes the rows of n_rows conditions of a tangent point from number `first` on, whose dofs begin at number `dofs`;
 * row: number of the first of them. */
static void rows_of_foot(const fu_sheave *sheave, const fu_sheave_state *at, const fu_state *state, int k,
                         const fu_tangent_point *foot, int dofs, int first, int n_rows, int row, fu_rows *out)
{
    const fu_foot of = fu_foot_of(sheave, at, k);
    double rows[FU_FOOT_CONDITIONS * FU_FOOT_DOFS], bias[FU_FOOT_CONDITIONS];
    fu_tangent_point_rows(foot, rows);
    fu_tangent_point_bias(&of, foot, &at->wheel, state->q, state->v, bias);
    for (int r = 0; r < n_rows; ++r) {
        out->C[row + r] = foot->phi[first + r];
        out->W[row + r] = -bias[first + r];
        memcpy(out->H + (row + r) * out->n + dofs, rows + (first + r) * foot->n, sizeof(double) * (size_t)foot->n);
    }
}

static void rows_of_joint(const fu_sheave *sheave, const fu_sheave_state *at, int other, fu_rows *out)
{
    find_joint(sheave, at, out->C);
    for (int i = 0; i < VECTORS; ++i) { /* the node is at the start of the dofs of its tangent point */
        out->H[i * out->n + i] = -1.0;
        out->H[i * out->n + other + i] = 1.0;
    }
}

void fu_space_rows(const fu_model *model, const fu_sheave *sheave, const fu_state *state, fu_rows *out)
{
    const double none[MAX_CONDITIONS] = {0.0};
    double phi[MAX_CONDITIONS], J[MAX_CONDITIONS][Y];
    fu_tangent_point feet[ENDS];
    fu_wheel_column columns[COLUMNS];
    fu_centre_moves moves;
    fu_sheave_state at;
    int number[COLUMNS], begin[ENDS];
    fu_sheave_at(model, sheave, state, 0, &at);
    const int has_left = at.mode == FU_LIFTED, first = first_row_of_wrap(sheave, at.mode);
    out->rows = fu_sheave_conditions(sheave, &at);
    out->n = 0;
    for (int k = 0; k < ENDS; ++k) {
        const int n = k && has_left ? VECTORS : 0;
        feet[k] = find_foot(sheave, &at, k, none);
        begin[k] = out->n;
        memcpy(out->at + out->n, feet[k].dofs, sizeof(int) * (size_t)(n ? n : feet[k].n));
        out->n += n ? n : feet[k].n;
    }
    fu_wheel_moves(model, &at.wheel, &moves);
    const int n = fu_stretches(at.mode) ? 0 : fu_sheave_columns(sheave, &at, &moves, columns);
    fu_sheave_rows_of_wrap(sheave, &at, phi, J);
    find_columns(n, columns, first, out->rows, J, number, out);
    memset(out->H, 0, sizeof(double) * (size_t)(out->rows * out->n));
    memset(out->rate, 0, sizeof(double) * (size_t)out->rows);
    memset(out->W, 0, sizeof(double) * (size_t)out->rows);
    for (int k = 0; k < ENDS && !has_left; ++k)
        rows_of_foot(sheave, &at, state, k, &feet[k], begin[k], 0, FU_FOOT_CONDITIONS, FU_FOOT_CONDITIONS * k, out);
    if (has_left) {
        rows_of_joint(sheave, &at, begin[1], out);
        rows_of_foot(sheave, &at, state, 0, &feet[0], 0, ACROSS_SLOPE, 1, short_row(sheave), out);
    }
    for (int r = first; r < out->rows; ++r) {
        out->C[r] = phi[r];
        for (int j = 0; j < n; ++j)
            if (number[j] >= 0) out->H[r * out->n + number[j]] += fu_by_column(&columns[j], J[r]);
    }
    if (at.mode == FU_SHORT) out->W[first] = -fu_short_wrap_drift(sheave, &at);
}
