/* Points of the wrap of a rope at which friction sticks, each a coupling: it slides in a direction with friction at its
 * limit, or is held by a multiplier f, with w = 0, a constraint on rates alone. events/wrap_point.c has its events. The
 * limit depends on stretches and speeds, and not on f. It vanishes with the wrap: a short one has one point, and a rope
 * that has left its sheave none. */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/sheave/sheave.h"

#include <math.h>
#include <string.h>

static const fu_wrap_point *point_of(const fu_coupling *coupling)
{
    return (const fu_wrap_point *)coupling;
}

int *fu_wrap_point_flag(const fu_coupling *coupling, const fu_state *state)
{
    return state->flags + coupling->flags;
}

int fu_place_of_point(const fu_coupling *coupling)
{
    return point_of(coupling)->place;
}

const fu_sheave *fu_sheave_of_point(const fu_model *model, const fu_coupling *coupling)
{
    return (const fu_sheave *)model->couplings[point_of(coupling)->sheave];
}

/* Returns the part of the limit at which friction is in statics: ropes are about to slide on a sheave that is held or
 * whose rotation is prescribed, see `fu_model.impending`. */
static double impending_part(const fu_model *model, const fu_sheave *sheave)
{
    const int turn = sheave->wheel.turn;
    if (turn >= 0 && model->unknown_of_dof[turn] >= 0) return 0.0;
    return model->impending / sqrt(1.0 + model->impending * model->impending);
}

static double slips_at(const fu_model *model, const fu_sheave *sheave, int mode)
{
    return mode == FU_POINT_IS_FREE ? impending_part(model, sheave) : mode == FU_STICKS ? 0.0 : (double)mode;
}

/* Returns a mode, or that of a point without friction where it does not act. */
static int acting(const fu_sheave_state *at, int j, int mode)
{
    return fu_point_acts(at, j) ? mode : FU_POINT_IS_FREE;
}

/* Computes a point at a state, with its sheave. */
static void look(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_sheave_state *at,
                 fu_coulomb *out)
{
    const fu_sheave *sheave = fu_sheave_of_point(model, coupling);
    fu_sheave_at(model, sheave, state, 0, at);
    fu_coulomb_at(sheave, at, point_of(coupling)->place, out);
}

void fu_wrap_point_at(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_coulomb *out)
{
    fu_sheave_state at;
    look(model, coupling, state, &at, out);
}

void fu_wrap_force_at(const fu_model *model, const fu_sheave *sheave, const fu_sheave_state *at, int j,
                      const fu_state *state, const double *multipliers, fu_wrap_force *out)
{
    const fu_coupling *coupling = model->couplings[sheave->wrap_points + j];
    const int mode = acting(at, j, *fu_wrap_point_flag(coupling, state));
    fu_coulomb_at(sheave, at, j, &out->at);
    out->slips = slips_at(model, sheave, mode);
    out->f = mode == FU_STICKS ? (multipliers ? multipliers[coupling->multiplier] : state->forces[coupling->force])
                               : out->slips * out->at.limit;
}

void fu_wrap_force_by_y(const fu_sheave *sheave, const fu_sheave_state *at, int j, double f,
                        const double column[FU_SLIDING], double y[Y])
{
    double F[FU_SLIDING], z[Z];
    for (int k = 0; k < FU_SLIDING; ++k) F[k] = f * column[k];
    fu_point_by_z(sheave, at, j, F, z);
    fu_sheave_add_by_angles(sheave, at, z, y);
}

/* Adds the force f of a point to those on the dofs. */
static void add_force(const fu_sheave *sheave, const fu_sheave_state *at, int j, const fu_coulomb *of, double f,
                      double *forces)
{
    double y[Y] = {0.0};
    fu_wrap_force_by_y(sheave, at, j, f, of->column, y);
    fu_sheave_scatter(sheave, at, y, forces);
}

/* The force of sliding, in eq 38. */
static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    const fu_sheave *sheave = fu_sheave_of_point(model, coupling);
    const double slips = slips_at(model, sheave, *fu_wrap_point_flag(coupling, state));
    fu_sheave_state at;
    fu_coulomb of;
    if (slips == 0.0) return;
    look(model, coupling, state, &at, &of);
    add_force(sheave, &at, point_of(coupling)->place, &of, slips * of.limit, f);
}

/* --- Newton's systems ------------------------------------------------------------------------------------------- */

static int is_static(const fu_equations *equations)
{
    return equations->weights.inertia == 0.0;
}

/* Returns the mode in a system: in statics nothing sticks that is not held. */
static int mode_in(const fu_coupling *coupling, const fu_sheave_state *at, const fu_equations *equations)
{
    const fu_wrap_point *point = point_of(coupling);
    if (is_static(equations) && !point->held.is_held) return FU_POINT_IS_FREE;
    return acting(at, point->place, *fu_wrap_point_flag(coupling, equations->next));
}

/* Returns the time that turns w to a length, of the order of the step, s. */
static double time_of(fu_weights weights)
{
    return weights.rate > 0.0 ? 1.0 / weights.rate : 0.0;
}

/* Returns the sliding of a sticking point in a system, m. */
static double sliding(const fu_model *model, const fu_sheave *sheave, const fu_sheave_state *at, int j,
                      const fu_coulomb *of, const fu_equations *equations)
{
    double stretch;
    return is_static(equations) ? fu_held_slip(model, sheave, at, j, &stretch) : time_of(equations->weights) * of->w;
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations, double *f,
                     double *internal)
{
    const fu_sheave *sheave = fu_sheave_of_point(model, coupling);
    const double multiplier = equations->next->forces[coupling->force];
    fu_sheave_state at;
    fu_coulomb of;
    look(model, coupling, equations->next, &at, &of);
    const int mode = mode_in(coupling, &at, equations);
    add_force(sheave, &at, point_of(coupling)->place, &of,
              mode == FU_STICKS ? multiplier : slips_at(model, sheave, mode) * of.limit, f);
    internal[coupling->unknown] = mode == FU_STICKS
                                      ? -fu_row_unit(equations->weights.inertia, coupling->scale[0]) *
                                            sliding(model, sheave, &at, point_of(coupling)->place, &of, equations)
                                      : -equations->weights.stiffness * multiplier;
}

/* Computes the derivatives by y from those by the rates of the angle of a point, the rotation and s. */
static void by_y(const fu_sheave *sheave, const fu_sheave_state *at, int j, const double *of, double y[Y])
{
    memset(y, 0, sizeof(double) * Y);
    fu_wrap_force_by_y(sheave, at, j, 1.0, of, y);
}

/* Adds the row of w, in statics of the sliding, and the column of f. */
static void add_row_and_column(const fu_model *model, const fu_coupling *coupling, const fu_sheave_state *at,
                               const fu_coulomb *of, const fu_equations *equations, int n,
                               const fu_wheel_column *columns, const fu_wheel_column *turned, fu_system *system)
{
    const fu_sheave *sheave = fu_sheave_of_point(model, coupling);
    const int own = fu_extra(model, coupling->unknown), j = point_of(coupling)->place;
    const double unit = fu_row_unit(equations->weights.inertia, coupling->scale[0]);
    double by[FU_SLIDING] = {of->row[0], of->row[1], of->row[2]}, row[Y], column[Y];
    if (is_static(equations)) {
        fu_held_slip(model, sheave, at, j, &by[2]);
        by[2] = -by[2];
    }
    by_y(sheave, at, j, by, row);
    by_y(sheave, at, j, of->column, column);
    for (int i = 0; i < n; ++i) {
        const double by_rate = fu_by_column(&turned[i], row), by_f = fu_by_column(&columns[i], column);
        if (by_rate != 0.0) fu_add(model, system, own, turned[i].dof, unit * by_rate);
        if (by_f != 0.0) fu_add(model, system, columns[i].dof, own, unit * by_f);
    }
}

/* The derivatives of w by places are neglected beside those by rates. */
static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations,
                    fu_system *system)
{
    const fu_sheave *sheave = fu_sheave_of_point(model, coupling);
    const int own = fu_extra(model, coupling->unknown), j = point_of(coupling)->place;
    const fu_weights w = equations->weights;
    double F[FU_SLIDING], z[Z], D_z[Z][Z], K_z[Z][Z], D[Y][Y], K[Y][Y], y[Y] = {0.0};
    fu_centre_moves moves, by_psi;
    fu_wheel_column columns[COLUMNS], turned[COLUMNS];
    fu_sheave_state at;
    fu_coulomb of;
    look(model, coupling, equations->next, &at, &of);
    const int mode = mode_in(coupling, &at, equations);
    const double held = mode == FU_STICKS ? equations->next->forces[coupling->force] : 0.0,
                 slips = slips_at(model, sheave, mode);
    fu_wheel_by_psi(model, &sheave->wheel, &at.wheel, equations->psi, &by_psi);
    fu_wheel_moves(model, &at.wheel, &moves);
    const int n = fu_sheave_columns(sheave, &at, &moves, columns);
    fu_sheave_columns(sheave, &at, &by_psi, turned);
    if (mode == FU_STICKS) add_row_and_column(model, coupling, &at, &of, equations, n, columns, turned, system);
    else fu_add(model, system, own, own, fu_row_unit(w.inertia, coupling->scale[0]));
    if (!fu_point_acts(&at, j) || (held == 0.0 && slips == 0.0)) return;
    memset(D_z, 0, sizeof D_z);
    memset(K_z, 0, sizeof K_z);
    memset(D, 0, sizeof D);
    memset(K, 0, sizeof K);
    fu_coulomb_add_matrices(sheave, &at, j, held, slips, w.stiffness, D_z, K_z);
    for (int k = 0; k < FU_SLIDING; ++k) F[k] = (held + slips * of.limit) * of.column[k];
    fu_point_by_z(sheave, &at, j, F, z);
    fu_sheave_add_matrices(sheave, &at, w.stiffness, z, D_z, K_z, D, K);
    fu_wheel_add_matrix(model, n, columns, turned, Y, K[0], system);
    for (int i = 0; i < Y; ++i)
        for (int k = 0; k < Y; ++k) D[i][k] *= w.rate;
    if (w.rate != 0.0) fu_wheel_add_matrix(model, n, columns, columns, Y, D[0], system);
    fu_sheave_add_by_angles(sheave, &at, z, y);
    if (is_turning(sheave)) fu_turning_wrap_add_turning(model, sheave, &at, &by_psi, y, w.stiffness, system);
    fu_wheel_add_carried(model, &sheave->wheel, &at.wheel, equations, y + CENTRE, system);
}

/* --- over a step that conserves energy -------------------------------------------------------------------------- */

/* A point over a step: its sheave, Coulomb friction half-way, the force and its parts. */
typedef struct {
    fu_sheave_over step;
    fu_coulomb friction;
    fu_sheave_step_forces force;
} point_over_step;

static void look_over_step(const fu_model *model, const fu_coupling *coupling, const fu_equations *at,
                           point_over_step *out)
{
    const fu_sheave *sheave = fu_sheave_of_point(model, coupling);
    const int j = point_of(coupling)->place, mode = *fu_wrap_point_flag(coupling, at->next);
    fu_sheave_over_step(model, sheave, at, &out->step);
    fu_coulomb_at(sheave, &out->step.middle, j, &out->friction);
    const double f =
        mode == FU_STICKS ? at->next->forces[coupling->force] : slips_at(model, sheave, mode) * out->friction.limit;
    const double share = out->step.middle.share[j];
    memset(&out->force, 0, sizeof out->force);
    out->force.turn[0] = (1.0 - share) * f * out->friction.column[0];
    out->force.turn[1] = share * f * out->friction.column[0];
    out->force.wheel = f * out->friction.column[1];
    out->force.s[j] = f * out->friction.column[2];
}

/* Returns the sliding over the step, m. */
static double slide_of_step(const fu_model *model, const fu_coupling *coupling, const fu_equations *at,
                            const point_over_step *of)
{
    const fu_sheave *sheave = fu_sheave_of_point(model, coupling);
    const int j = point_of(coupling)->place;
    const double share = of->step.middle.share[j], *half = of->step.half, *row = of->friction.row;
    return row[0] * 2.0 * ((1.0 - share) * half[0] + share * half[1]) +
           row[1] * fu_turn_of_wheel(sheave, &of->step, at) + row[2] * of->step.s_change[j];
}

static void step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                          double *internal)
{
    const int sticks_here = *fu_wrap_point_flag(coupling, at->next) == FU_STICKS;
    point_over_step of;
    look_over_step(model, coupling, at, &of);
    fu_sheave_add_step_forces(fu_sheave_of_point(model, coupling), &of.step, &of.force, f);
    internal[coupling->unknown] =
        sticks_here ? -fu_row_unit(at->weights.inertia, coupling->scale[0]) * slide_of_step(model, coupling, at, &of)
                    : -at->weights.stiffness * at->next->forces[coupling->force];
}

/* Adds the derivatives by those half-way. */
static void step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    fu_state middle = *at->middle;
    fu_equations half_way = *at;
    middle.forces = at->next->forces;
    middle.numbers = at->next->numbers;
    middle.flags = at->next->flags;
    half_way.next = &middle;
    tangent(model, coupling, &half_way, system);
}

static double step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at)
{
    point_over_step of;
    look_over_step(model, coupling, at, &of);
    return fu_sheave_step_power(fu_sheave_of_point(model, coupling), &of.step, at, &of.force);
}

/* The material at a sticking point moves with the rim at the end of a step, too: its momentum is not known by its
 * velocity. */
static void velocities(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double since)
{
    const int s = fu_sheave_of_point(model, coupling)->s[point_of(coupling)->place];
    fu_coulomb of;
    (void)since;
    if (*fu_wrap_point_flag(coupling, at->next) != FU_STICKS) return;
    fu_wrap_point_at(model, coupling, at->next, &of);
    at->next->v[s] -= of.w / of.row[2];
    at->next->acceleration[s] = 2.0 / at->h * (at->next->v[s] - at->psi[s] / at->h);
}

/* --- eq 38 ------------------------------------------------------------------------------------------------------ */

static void rows(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_accelerator *work)
{
    const fu_sheave *sheave = fu_sheave_of_point(model, coupling);
    const int j = point_of(coupling)->place;
    fu_rows *out = &work->rows[coupling->row];
    double row[Y], column[Y], size;
    fu_wheel_column columns[COLUMNS];
    fu_centre_moves moves;
    fu_sheave_state at;
    fu_coulomb of;
    out->n = out->rows = 0;
    if (*fu_wrap_point_flag(coupling, state) != FU_STICKS) return;
    look(model, coupling, state, &at, &of);
    if (!fu_point_acts(&at, j)) return;
    by_y(sheave, &at, j, of.row, row);
    by_y(sheave, &at, j, of.column, column);
    fu_wheel_moves(model, &at.wheel, &moves);
    const int n = fu_sheave_columns(sheave, &at, &moves, columns);
    for (int i = 0; i < n; ++i) {
        const double by_rate = fu_by_column(&columns[i], row), by_f = fu_by_column(&columns[i], column);
        if (by_rate == 0.0 && by_f == 0.0) continue;
        out->at[out->n] = columns[i].dof;
        out->H[out->n] = by_rate;
        out->column[out->n++] = by_f;
    }
    out->rows = out->is_pushed = 1;
    out->W[0] = -fu_coulomb_rate(sheave, &at, j, &of, &size);
    out->C[0] = out->rate[0] = 0.0;
}

static void take_forces(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work, fu_state *state)
{
    (void)model;
    const int sticks = *fu_wrap_point_flag(coupling, state) == FU_STICKS;
    state->forces[coupling->force] = sticks ? work->multipliers[coupling->multiplier] : 0.0;
}

/* A sticking point through which material passes takes power where the stretch differs on its sides. */
static double dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const fu_accelerator *work)
{
    const fu_sheave *sheave = fu_sheave_of_point(model, coupling);
    const int j = point_of(coupling)->place;
    fu_sheave_state at;
    fu_wrap_force of;
    fu_sheave_at(model, sheave, state, 0, &at);
    fu_wrap_force_at(model, sheave, &at, j, state, work ? work->multipliers : 0, &of);
    return of.f * fu_dot(FU_SLIDING, of.at.column, of.at.rate);
}

static void gaps(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *out)
{
    (void)model, (void)coupling, (void)state;
    out[0] = 0.0;
}

static int is_possible(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    (void)model;
    const int mode = *fu_wrap_point_flag(coupling, state);
    return mode >= FU_SLIDES_BACKWARDS && mode <= FU_STICKS;
}

static const fu_field fields[] = {
    FU_FIELD(fu_wrap_point, sheave, FU_INTEGER, 0),
    FU_FIELD(fu_wrap_point, place, FU_INTEGER, 0),
    {0},
};

static const fu_start_operations start = {.is_possible = is_possible};
static const fu_history_operations history = {.velocities = velocities};

const fu_coupling_type fu_wrap_point_type = {
    .name = "wrap_point",
    .size = sizeof(fu_wrap_point),
    .fields = fields,
    .n_flags = 1,
    .history = &history,
    .start = &start,
    .residual = residual,
    .tangent = tangent,
    .step_residual = step_residual,
    .step_tangent = step_tangent,
    .step_dissipation = step_dissipation,
    .rows = rows,
    .force = force,
    .take_forces = take_forces,
    .gaps = gaps,
    .dissipation = dissipation,
};
