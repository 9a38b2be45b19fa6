/* Conditions of a drum, of its tangent point and of winding, and their forces. */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/drum/drum.h"

#include <string.h>

static void add_of_x(const double *of, double factor, double *row)
{
    for (int i = 0; i < NODE; ++i) row[i] += factor * of[i];
    for (int d = 0; d < DIM; ++d) row[CENTRE + d] -= factor * of[d];
}

/* Adds the derivatives by y of the forces of winding, and of a tangent point in the plane (K null: none). */
static void add_stiffness(const double *K, const double *K_winding, fu_drum_conditions *out)
{
    for (int i = 0; i < NODE; ++i) {
        double row[Y] = {0.0};
        if (K) add_of_x(K + i * NODE, 1.0, row);
        if (i < DIM) add_of_x(K_winding + i * NODE, 1.0, row);
        for (int j = 0; j < Y; ++j) {
            out->K[i][j] += row[j];
            if (i < DIM) out->K[CENTRE + i][j] -= row[j];
        }
    }
    add_of_x(K_winding + DIM * NODE, 1.0, out->K[LENGTH]);
}

void fu_drum_conditions_at(const fu_drum *drum, const fu_drum_state *at, const fu_state *state,
                           const double *multipliers, fu_drum_conditions *out)
{
    const fu_wheel *wheel = &drum->wheel;
    const int winding = conditions_of(drum) - 1;
    const fu_drum_history *past = fu_drum_history_of(drum, state);
    double J[DIM * NODE], K[NODE * NODE], of_winding[NODE], K_winding[(DIM + 1) * NODE];
    memset(out->J, 0, sizeof out->J);
    memset(out->K, 0, sizeof out->K);
    out->has_foot = is_in_space(drum) && !at->has_left;
    out->n = at->has_left ? 1 : conditions_of(drum);
    if (at->has_left) {
        memset(out->phi, 0, sizeof out->phi);
        out->phi[0] = at->u;
        out->J[0][LENGTH] = 1.0;
        return;
    }
    wheel->kernel->winding(fu_winding_sense(drum), wheel->radius, at->x, at->slope, at->winds, at->wound,
                           multipliers[winding], of_winding, K_winding);
    if (out->has_foot) {
        const fu_foot foot = foot_of(drum);
        fu_tangent_point_at(&foot, &at->wheel, at->q, multipliers, &out->foot);
        memcpy(out->phi, out->foot.phi, sizeof out->foot.phi);
    } else {
        wheel->kernel->tangent_point(at->x, at->slope, drum->tangent_radius, multipliers, out->phi, J, K);
        for (int r = 0; r < DIM; ++r) add_of_x(J + r * NODE, 1.0, out->J[r]);
    }
    for (int d = 0; d < DIM; ++d) {
        out->J[winding][d] = of_winding[d];
        out->J[winding][CENTRE + d] = -of_winding[d];
    }
    out->J[winding][TURN] = of_winding[DIM];
    out->J[winding][LENGTH] = of_winding[DIM + 1];
    add_stiffness(out->has_foot ? 0 : K, K_winding, out);
    out->phi[winding] = past->is_known ? fu_drum_winding_gap(drum, past, at) : 0.0;
}

/* Adds the forces by y of all conditions in the plane, in space of winding. */
static void add_by_rows(const fu_drum_conditions *of, const double *multipliers, double y[Y])
{
    for (int r = 0; r < of->n; ++r)
        for (int j = 0; j < Y; ++j) y[j] += of->J[r][j] * multipliers[r];
}

void fu_drum_add_multipliers(const fu_drum_state *at, const fu_drum_conditions *of, const double *multipliers,
                             double y[Y])
{
    add_by_rows(of, multipliers, y);
    if (of->has_foot) fu_tangent_point_add_forces(&at->wheel, &of->foot, multipliers, y, y + CENTRE);
}

void fu_drum_add_all_multipliers(const fu_drum_conditions *of, const double *multipliers, double y[Y], double *f)
{
    double rows[FU_FOOT_CONDITIONS * FU_FOOT_DOFS];
    add_by_rows(of, multipliers, y);
    if (!of->has_foot) return;
    const int n = of->foot.n;
    fu_tangent_point_rows(&of->foot, rows);
    for (int r = 0; r < FU_FOOT_CONDITIONS; ++r)
        for (int j = 0; j < n; ++j) f[of->foot.dofs[j]] += rows[r * n + j] * multipliers[r];
}

void fu_drum_add_rows(const fu_model *model, const fu_coupling *coupling, const fu_drum_state *at,
                      const fu_drum_conditions *of, int n, const fu_wheel_column *rows, const fu_wheel_column *columns,
                      const fu_centre_moves *by_psi, const fu_equations *equations, fu_system *system)
{
    const double inertia = equations->weights.inertia;
    const int own = fu_extra(model, coupling->unknown);
    if (of->has_foot)
        fu_tangent_point_add(model, &at->wheel, &of->foot, by_psi, equations->next->forces + coupling->force,
                             coupling->scale, equations->weights, 0, FU_FOOT_CONDITIONS, own, system);
    for (int r = of->has_foot ? FU_FOOT_CONDITIONS : 0; r < of->n; ++r)
        for (int j = 0; j < n; ++j) {
            const double unit = fu_row_unit(inertia, coupling->scale[r]);
            const double row = fu_by_column(&columns[j], of->J[r]), column = fu_by_column(&rows[j], of->J[r]);
            if (row != 0.0) fu_add(model, system, own + r, columns[j].dof, unit * row);
            if (column != 0.0) fu_add(model, system, rows[j].dof, own + r, unit * column);
        }
    for (int r = of->n; r < conditions_of(drum_of(coupling)); ++r) /* left out: the multiplier is zero */
        fu_add(model, system, own + r, own + r, fu_row_unit(inertia, coupling->scale[r]));
}

/* Computes the rows of conditions from number `first` on, of n dofs from column `at` on. */
static void set_rows(const fu_drum_conditions *of, int first, int last, int n, int at, const fu_wheel_column *columns,
                     fu_rows *out)
{
    for (int j = 0; j < n; ++j) out->at[at + j] = columns[j].dof;
    for (int r = first; r < last; ++r)
        for (int j = 0; j < n; ++j) out->H[r * out->n + at + j] = fu_by_column(&columns[j], of->J[r]);
}

/* Computes the rows of the tangent point in space, and the second rates of its conditions. */
static void set_foot(const fu_drum *drum, const fu_drum_state *at, const fu_drum_conditions *of, const double *v,
                     fu_rows *out, double *bias)
{
    const fu_foot foot = foot_of(drum);
    const int n = of->foot.n;
    double rows[FU_FOOT_CONDITIONS * FU_FOOT_DOFS];
    fu_tangent_point_rows(&of->foot, rows);
    fu_tangent_point_bias(&foot, &of->foot, &at->wheel, at->q, v, bias);
    memcpy(out->at, of->foot.dofs, sizeof(int) * (size_t)n);
    for (int r = 0; r < FU_FOOT_CONDITIONS; ++r) memcpy(out->H + r * out->n, rows + r * n, sizeof(double) * (size_t)n);
}

/* Computes the second rates of the conditions but those of a tangent point in space. */
static void set_bias(const fu_drum *drum, const fu_drum_state *at, const fu_drum_conditions *of, double *bias)
{
    const fu_wheel *wheel = &drum->wheel;
    if (at->has_left) {
        bias[0] = 0.0;
        return;
    }
    if (!of->has_foot) wheel->kernel->tangent_point_motion(at->x, at->x_rate, at->slope_rate, bias);
    wheel->kernel->winding_motion(fu_winding_sense(drum), wheel->radius, at->x, at->slope, at->winds, at->wound,
                                  at->x_rate, at->slope_rate, at->u_rate, bias + of->n - 1);
}

/* Of winding the rates are the condition; a residual of places is corrected where the rope keeps its stretch. */
void fu_drum_rows(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_accelerator *work)
{
    const fu_drum *drum = drum_of(coupling);
    const double none[MAX_CONDITIONS] = {0.0};
    fu_rows *out = &work->rows[coupling->row];
    double bias[MAX_CONDITIONS];
    fu_wheel_column columns[COLUMNS];
    fu_centre_moves moves;
    fu_drum_state at;
    fu_drum_conditions of;
    fu_drum_at(model, drum, state, 0, &at);
    fu_drum_conditions_at(drum, &at, state, none, &of);
    out->rows = of.n;
    memcpy(out->C, of.phi, sizeof(double) * (size_t)of.n);
    if (at.winds != 0.0 && !at.has_left) out->C[of.n - 1] = 0.0;
    fu_wheel_moves(model, &at.wheel, &moves);
    const int n = fu_drum_columns(drum, &at, &moves, columns), foot = of.has_foot ? of.foot.n : 0;
    out->n = foot + n;
    memset(out->H, 0, sizeof(double) * (size_t)(of.n * out->n));
    if (of.has_foot) set_foot(drum, &at, &of, state->v, out, bias);
    set_bias(drum, &at, &of, bias);
    set_rows(&of, of.has_foot ? FU_FOOT_CONDITIONS : 0, of.n, n, foot, columns, out);
    for (int r = 0; r < of.n; ++r) {
        out->rate[r] = 0.0;
        out->W[r] = -bias[r];
        for (int d = 0; d < DIM; ++d) out->W[r] -= of.J[r][CENTRE + d] * at.wheel.c_bias[d];
    }
}
