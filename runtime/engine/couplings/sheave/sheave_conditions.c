/* Conditions of the two tangent points of a sheave, and their forces. */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/sheave/sheave.h"

#include <string.h>

/* Conditions in the plane: the residuals, their derivatives by y, and the derivatives by x and the slope of the forces
 * of both tangent points (4 x 4 each). */
typedef struct {
    int n;
    double phi[MAX_CONDITIONS], J[MAX_CONDITIONS][Y], K[ENDS][NODE * NODE];
} conditions;

/* Computes derivatives by y from those of a tangent point by x and the slope. */
static void by_y(int k, const double of[NODE], double y[Y])
{
    memset(y, 0, sizeof(double) * Y);
    memcpy(y + k * NODE, of, sizeof(double) * NODE);
    for (int d = 0; d < DIM; ++d) y[CENTRE + d] = -of[d];
}

/* Computes those of a rope that has left: both spans are joined where the slope is across the direction to the
 * centre, the second condition of a tangent point. */
static void join(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers, conditions *out)
{
    const int nearest = short_row(sheave);
    const double force[DIM] = {0.0, multipliers[nearest]};
    double phi[DIM], J[DIM * NODE];
    memset(out->K, 0, sizeof out->K);
    for (int r = 0; r < nearest; ++r) fu_join_row(sheave, at, r, &out->phi[r], out->J[r]);
    sheave->wheel.kernel->tangent_point(at->x[0], at->slope[0], sheave->tangent_radius[0], force, phi, J, out->K[0]);
    out->phi[nearest] = phi[1];
    by_y(0, J + NODE, out->J[nearest]);
}

static void find_conditions(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers,
                            conditions *out)
{
    out->n = fu_sheave_conditions(sheave, at);
    fu_sheave_rows_of_wrap(sheave, at, out->phi, out->J);
    if (at->mode == FU_LIFTED) {
        join(sheave, at, multipliers, out);
        return;
    }
    for (int k = 0; k < ENDS; ++k) {
        double J[DIM * NODE];
        sheave->wheel.kernel->tangent_point(at->x[k], at->slope[k], sheave->tangent_radius[k], multipliers + DIM * k,
                                            out->phi + DIM * k, J, out->K[k]);
        for (int r = 0; r < DIM; ++r) by_y(k, J + r * NODE, out->J[DIM * k + r]);
    }
}

/* Adds the forces of conditions from number `first` on by y; that of a short wrap is among those of its wrap. */
static void add_forces(const fu_sheave *sheave, const fu_sheave_state *at, int first, double (*J)[Y],
                       const double *multipliers, double *y)
{
    for (int r = first; r < fu_sheave_conditions(sheave, at); ++r)
        for (int i = 0; i <= MATERIAL + sheave->n_zones && (r != short_row(sheave) || at->mode != FU_SHORT); ++i)
            y[i] += J[r][i] * multipliers[r];
}

/* Adds the forces of the conditions of the wrap alone; computes all residuals of these. */
static void add_forces_of_wrap(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers,
                               double *phi, double *y)
{
    double J[MAX_CONDITIONS][Y];
    memset(phi, 0, sizeof(double) * (size_t)sheave->wheel.base.n_forces);
    fu_sheave_rows_of_wrap(sheave, at, phi, J);
    add_forces(sheave, at, first_row_of_wrap(sheave, at->mode), J, multipliers, y);
}

/* Adds the forces of the conditions by y, in the plane. */
static void add_multipliers_in_plane(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers,
                                     double *phi, double *y)
{
    conditions of;
    find_conditions(sheave, at, multipliers, &of);
    memset(phi, 0, sizeof(double) * (size_t)sheave->wheel.base.n_forces);
    memcpy(phi, of.phi, sizeof(double) * (size_t)of.n);
    add_forces(sheave, at, 0, of.J, multipliers, y);
}

void fu_sheave_add_multipliers(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers,
                               double *phi, double *y)
{
    if (!is_in_space(sheave)) {
        add_multipliers_in_plane(sheave, at, multipliers, phi, y);
        return;
    }
    add_forces_of_wrap(sheave, at, multipliers, phi, y);
    fu_space_add_multipliers_by_y(sheave, at, multipliers, phi, y);
}

void fu_sheave_add_all_multipliers(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers,
                                   double *phi, double *y, double *f)
{
    if (!is_in_space(sheave)) {
        add_multipliers_in_plane(sheave, at, multipliers, phi, y);
        return;
    }
    add_forces_of_wrap(sheave, at, multipliers, phi, y);
    fu_space_add_multipliers(sheave, at, multipliers, phi, f);
}

void fu_sheave_rows_at(const fu_sheave *sheave, const fu_sheave_state *at, double J[MAX_CONDITIONS][Y],
                       double phi[MAX_CONDITIONS])
{
    const double none[MAX_CONDITIONS] = {0.0};
    conditions of;
    find_conditions(sheave, at, none, &of);
    memcpy(J, of.J, sizeof of.J);
    memcpy(phi, of.phi, sizeof of.phi);
}

/* --- derivatives ------------------------------------------------------------------------------------------------ */

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
                              const fu_wheel_column *columns, const fu_centre_moves *by_psi, double (*K_y)[Y],
                              fu_system *system)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const int own = fu_extra(model, coupling->unknown);
    const int first = is_in_space(sheave) ? first_row_of_wrap(sheave, at->mode) : 0;
    conditions of;
    if (is_in_space(sheave)) {
        of.n = fu_sheave_conditions(sheave, at);
        fu_sheave_rows_of_wrap(sheave, at, of.phi, of.J);
        fu_space_add_conditions(model, coupling, at, equations, by_psi, system);
    } else {
        find_conditions(sheave, at, equations->next->forces + coupling->force, &of);
        for (int k = 0; k < ENDS; ++k) add_stiffness_of_foot(k, equations->weights.stiffness, of.K[k], K_y);
    }
    for (int r = first; r < of.n; ++r) {
        const double unit = fu_row_unit(equations->weights.inertia, coupling->scale[r]);
        for (int j = 0; j < n; ++j) {
            const double row = fu_by_column(&columns[j], of.J[r]), column = fu_by_column(&rows[j], of.J[r]);
            if (row != 0.0) fu_add(model, system, own + r, columns[j].dof, unit * row);
            if (column != 0.0) fu_add(model, system, rows[j].dof, own + r, unit * column);
        }
    }
    for (int r = of.n; r < coupling->n_forces; ++r) /* left out: the multiplier is zero */
        fu_add(model, system, own + r, own + r, fu_row_unit(equations->weights.inertia, coupling->scale[r]));
}

/* --- eq 38 ------------------------------------------------------------------------------------------------------ */

/* Computes the second rates of the conditions at zero accelerations of the dofs, in the plane. */
static void find_drift(const fu_sheave *sheave, const fu_sheave_state *at, const conditions *of, double *drift)
{
    const int nearest = short_row(sheave);
    memset(drift, 0, sizeof(double) * (size_t)sheave->wheel.base.n_forces);
    for (int k = 0; k < ENDS; ++k) {
        double foot[DIM];
        sheave->wheel.kernel->tangent_point_motion(at->x[k], at->x_rate[k], at->slope_rate[k], foot);
        if (at->mode == FU_LIFTED) drift[nearest] = k ? drift[nearest] : foot[1];
        else memcpy(drift + DIM * k, foot, sizeof foot);
    }
    for (int r = 0; r < of->n; ++r)
        for (int d = 0; d < DIM; ++d) drift[r] += of->J[r][CENTRE + d] * at->wheel.centre.bias[d];
    if (at->mode == FU_SHORT) drift[short_row(sheave)] = fu_short_wrap_drift(sheave, at);
}

static void rows_in_plane(const fu_model *model, const fu_sheave *sheave, const fu_state *state, fu_rows *out)
{
    const double none[MAX_CONDITIONS] = {0.0};
    double drift[MAX_CONDITIONS];
    conditions of;
    fu_wheel_column columns[COLUMNS];
    fu_centre_moves moves;
    fu_sheave_state at;
    fu_sheave_at(model, sheave, state, 0, &at);
    find_conditions(sheave, &at, none, &of);
    find_drift(sheave, &at, &of, drift);
    out->rows = of.n;
    fu_wheel_moves(model, &at.wheel, &moves);
    out->n = fu_sheave_columns(sheave, &at, &moves, columns);
    for (int j = 0; j < out->n; ++j) out->at[j] = columns[j].dof;
    for (int r = 0; r < of.n; ++r) {
        out->C[r] = of.phi[r];
        out->rate[r] = 0.0;
        out->W[r] = -drift[r];
        for (int j = 0; j < out->n; ++j) out->H[r * out->n + j] = fu_by_column(&columns[j], of.J[r]);
    }
}

void fu_sheave_rows(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_accelerator *work)
{
    const fu_sheave *sheave = sheave_of(coupling);
    (is_in_space(sheave) ? fu_space_rows : rows_in_plane)(model, sheave, state, &work->rows[coupling->row]);
}
