/* Conditions of the two tangent points of a sheave, and their forces. */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/sheave/sheave.h"

#include <string.h>

/* Computes the conditions of both tangent points, their derivatives by x and slope (2 x 4 each), and those of J'
 * multipliers (4 x 4 each). */
static void conditions(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers, double *phi,
                       double (*J)[DIM * NODE], double (*K)[NODE * NODE])
{
    for (int k = 0; k < ENDS; ++k)
        sheave->wheel.kernel->tangent_point(at->x[k], at->slope[k], sheave->tangent_radius[k], multipliers + DIM * k,
                                            phi + DIM * k, J[k], K[k]);
}

/* Adds the forces of the tangent points on the dofs, in space. */
static void add_multipliers_in_space(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers,
                                     double *phi, double *f)
{
    for (int k = 0; k < ENDS; ++k, multipliers += FU_FOOT_CONDITIONS, phi += FU_FOOT_CONDITIONS) {
        double rows[FU_FOOT_CONDITIONS * FU_FOOT_DOFS];
        fu_tangent_point foot;
        fu_tangent_point_at(sheave, k, &at->wheel.centre, at->q, multipliers, &foot);
        fu_tangent_point_rows(&foot, rows);
        memcpy(phi, foot.phi, sizeof foot.phi);
        for (int r = 0; r < FU_FOOT_CONDITIONS; ++r)
            for (int j = 0; j < foot.n; ++j) f[foot.dofs[j]] += rows[r * foot.n + j] * multipliers[r];
    }
}

/* The same by y, without the forces on the chords: those on the nodes, and their opposites on the centre. */
static void add_multipliers_on_nodes(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers,
                                     double *phi, double *y)
{
    for (int k = 0; k < ENDS; ++k, multipliers += FU_FOOT_CONDITIONS, phi += FU_FOOT_CONDITIONS) {
        double on_node[SPACE] = {0.0}, in_groove[DIM];
        fu_tangent_point foot;
        fu_tangent_point_at(sheave, k, &at->wheel.centre, at->q, multipliers, &foot);
        memcpy(phi, foot.phi, sizeof foot.phi);
        for (int r = 0; r < FU_FOOT_CONDITIONS; ++r)
            for (int d = 0; d < SPACE; ++d) on_node[d] += foot.J[r * FU_FOOT_VECTORS + d] * multipliers[r];
        fu_into_groove(&sheave->wheel, on_node, in_groove);
        y[ACROSS] -= fu_dot(SPACE, sheave->wheel.axis, on_node);
        for (int d = 0; d < DIM; ++d) {
            y[k * NODE + d] += in_groove[d];
            y[CENTRE + d] -= in_groove[d];
        }
    }
}

/* Adds the forces of the tangent points by y, in the plane. */
static void add_multipliers_in_plane(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers,
                                     double *phi, double *y)
{
    double J[ENDS][DIM * NODE], K[ENDS][NODE * NODE];
    conditions(sheave, at, multipliers, phi, J, K);
    for (int k = 0; k < ENDS; ++k)
        for (int r = 0; r < DIM; ++r)
            for (int i = 0; i < NODE; ++i) {
                const double force = J[k][r * NODE + i] * multipliers[DIM * k + r];
                y[k * NODE + i] += force;
                if (i < DIM) y[CENTRE + i] -= force;
            }
}

void fu_sheave_add_multipliers(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers,
                               double *phi, double *y)
{
    (is_in_space(sheave) ? add_multipliers_on_nodes : add_multipliers_in_plane)(sheave, at, multipliers, phi, y);
}

void fu_sheave_add_all_multipliers(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers,
                                   double *phi, double *y, double *f)
{
    if (is_in_space(sheave)) add_multipliers_in_space(sheave, at, multipliers, phi, f);
    else add_multipliers_in_plane(sheave, at, multipliers, phi, y);
}

/* --- derivatives ------------------------------------------------------------------------------------------------ */

/* Adds the derivatives of the conditions of a tangent point, and of their forces, in space. */
static void add_foot(const fu_model *model, const fu_coupling *coupling, const fu_tangent_point *foot, int first,
                     const double *by_psi, const fu_equations *equations, fu_system *system)
{
    const int own = fu_extra(model, coupling->unknown) + first, n = foot->n;
    const double *multipliers = equations->next->forces + coupling->force + first;
    double rows[FU_FOOT_CONDITIONS * FU_FOOT_DOFS], columns[FU_FOOT_CONDITIONS * FU_FOOT_DOFS],
        K[FU_FOOT_DOFS * FU_FOOT_DOFS];
    fu_tangent_point turned = *foot;
    fu_tangent_point_turn(by_psi, &turned);
    fu_tangent_point_rows(&turned, rows);
    fu_tangent_point_rows(foot, columns);
    fu_tangent_point_stiffness(foot, &turned, multipliers, K);
    for (int j = 0; j < n; ++j) {
        for (int r = 0; r < FU_FOOT_CONDITIONS; ++r) {
            const double unit = fu_row_unit(equations->weights.inertia, coupling->scale[first + r]);
            if (rows[r * n + j] != 0.0) fu_add(model, system, own + r, foot->dofs[j], unit * rows[r * n + j]);
            if (columns[r * n + j] != 0.0) fu_add(model, system, foot->dofs[j], own + r, unit * columns[r * n + j]);
        }
        for (int i = 0; i < n; ++i)
            if (K[i * n + j] != 0.0)
                fu_add(model, system, foot->dofs[i], foot->dofs[j], equations->weights.stiffness * K[i * n + j]);
    }
}

static void add_conditions_in_space(const fu_model *model, const fu_coupling *coupling, const fu_sheave_state *at,
                                    const fu_equations *equations, const double *by_psi, fu_system *system)
{
    for (int k = 0; k < ENDS; ++k) {
        const int first = FU_FOOT_CONDITIONS * k;
        fu_tangent_point foot;
        fu_tangent_point_at(sheave_of(coupling), k, &at->wheel.centre, at->q,
                            equations->next->forces + coupling->force + first, &foot);
        add_foot(model, coupling, &foot, first, by_psi, equations, system);
    }
}

/* Computes derivatives by y from those of a tangent point by x and the slope. */
static void by_y(int k, const double of[NODE], double y[Y])
{
    memset(y, 0, sizeof(double) * Y);
    memcpy(y + k * NODE, of, sizeof(double) * NODE);
    for (int d = 0; d < DIM; ++d) y[CENTRE + d] = -of[d];
}

/* Adds the derivatives of the forces of a tangent point by y. */
static void add_stiffness_of_foot(int k, double factor, const double K[NODE * NODE], double (*K_y)[Y])
{
    for (int i = 0; i < NODE; ++i)
        for (int j = 0; j < NODE; ++j) {
            const double value = factor * K[i * NODE + j];
            K_y[k * NODE + i][k * NODE + j] += value;
            if (j < DIM) K_y[k * NODE + i][CENTRE + j] -= value;
            if (i < DIM) K_y[CENTRE + i][k * NODE + j] -= value;
            if (i < DIM && j < DIM) K_y[CENTRE + i][CENTRE + j] += value;
        }
}

void fu_sheave_add_conditions(const fu_model *model, const fu_coupling *coupling, const fu_sheave_state *at,
                              const fu_equations *equations, int n, const fu_wheel_column *rows,
                              const fu_wheel_column *columns, const double *by_psi, double (*K_y)[Y], fu_system *system)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const int own = fu_extra(model, coupling->unknown);
    double phi[MAX_CONDITIONS], J[ENDS][DIM * NODE], K[ENDS][NODE * NODE], of[Y];
    if (is_in_space(sheave)) {
        add_conditions_in_space(model, coupling, at, equations, by_psi, system);
        return;
    }
    conditions(sheave, at, equations->next->forces + coupling->force, phi, J, K);
    for (int k = 0; k < ENDS; ++k) {
        add_stiffness_of_foot(k, equations->weights.stiffness, K[k], K_y);
        for (int r = 0; r < DIM; ++r) {
            const double unit = fu_row_unit(equations->weights.inertia, coupling->scale[DIM * k + r]);
            by_y(k, J[k] + r * NODE, of);
            for (int j = 0; j < n; ++j) {
                const double row = fu_by_column(&columns[j], of), column = fu_by_column(&rows[j], of);
                if (row != 0.0) fu_add(model, system, own + DIM * k + r, columns[j].dof, unit * row);
                if (column != 0.0) fu_add(model, system, rows[j].dof, own + DIM * k + r, unit * column);
            }
        }
    }
}

/* --- eq 38 ------------------------------------------------------------------------------------------------------ */

static void rows_in_space(const fu_model *model, const fu_sheave *sheave, const fu_state *state, fu_rows *out)
{
    const double none[FU_FOOT_CONDITIONS] = {0.0};
    fu_attachment_state centre;
    fu_attachment_at(model, &sheave->wheel.attachments[0], state, 0.0, FU_POINT, &centre);
    for (int k = 0; k < ENDS; ++k) {
        double rows[FU_FOOT_CONDITIONS * FU_FOOT_DOFS], bias[FU_FOOT_CONDITIONS];
        fu_tangent_point foot;
        fu_tangent_point_at(sheave, k, &centre, state->q, none, &foot);
        fu_tangent_point_rows(&foot, rows);
        fu_tangent_point_bias(sheave, k, &foot, &centre, state->q, state->v, bias);
        out->n = ENDS * foot.n;
        memcpy(out->at + k * foot.n, foot.dofs, sizeof(int) * (size_t)foot.n);
        for (int r = 0; r < FU_FOOT_CONDITIONS; ++r) {
            const int row = FU_FOOT_CONDITIONS * k + r;
            double *H = out->H + row * out->n;
            out->C[row] = foot.phi[r];
            out->rate[row] = 0.0;
            out->W[row] = -bias[r];
            memset(H, 0, sizeof(double) * (size_t)out->n);
            memcpy(H + k * foot.n, rows + r * foot.n, sizeof(double) * (size_t)foot.n);
        }
    }
}

static void rows_in_plane(const fu_model *model, const fu_sheave *sheave, const fu_state *state, fu_rows *out)
{
    const double none[MAX_CONDITIONS] = {0.0};
    double J[ENDS][DIM * NODE], K[ENDS][NODE * NODE], of[Y];
    fu_wheel_column columns[COLUMNS];
    fu_sheave_state at;
    fu_sheave_at(model, sheave, state, 0, &at);
    conditions(sheave, &at, none, out->C, J, K);
    out->n = fu_sheave_columns(sheave, &at, at.wheel.centre.P, columns);
    for (int j = 0; j < out->n; ++j) out->at[j] = columns[j].dof;
    for (int k = 0; k < ENDS; ++k) {
        double bias[DIM];
        sheave->wheel.kernel->tangent_point_motion(at.x[k], at.x_rate[k], at.slope_rate[k], bias);
        for (int r = 0; r < DIM; ++r) {
            const int row = DIM * k + r;
            by_y(k, J[k] + r * NODE, of);
            out->rate[row] = 0.0;
            out->W[row] = -bias[r];
            for (int d = 0; d < DIM; ++d) out->W[row] += of[k * NODE + d] * at.wheel.centre.bias[d];
            for (int j = 0; j < out->n; ++j) out->H[row * out->n + j] = fu_by_column(&columns[j], of);
        }
    }
}

void fu_sheave_rows(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_accelerator *work)
{
    const fu_sheave *sheave = sheave_of(coupling);
    (is_in_space(sheave) ? rows_in_space : rows_in_plane)(model, sheave, state, &work->rows[coupling->row]);
}
