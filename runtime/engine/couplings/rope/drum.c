/* Drums: a tangent point at an end of a rope, the condition of winding, and the rope that is wound. Derivatives are by
 * the place and slope of the node, the centre, the rotation of the drum, and the wound length (y). */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/rope/rope.h"
#include "couplings/wheel/wheel.h"

#include <math.h>
#include <string.h>

enum { DIM = FU_GROOVE, NODE = 2 * DIM, CONDITIONS = DIM + 1, WINDING = DIM };
/* y: node; centre, rotation and place along the axis of the wheel, which does not change in the plane; wound length */
enum { SLOPE = DIM, CENTRE = NODE, TURN = CENTRE + FU_WHEEL_TURN, LENGTH = CENTRE + FU_WHEEL_FORCES, Y = LENGTH + 1 };
enum { COLUMNS = NODE + 2 + FU_ATTACHMENT_COORDINATES };
/* of the forces of the wound rope: on the rotation, the centre, the length */
enum { STORE = 2 + DIM };
static const int of_store[STORE] = {TURN, CENTRE, CENTRE + 1, LENGTH};

/* A drum at an end of a rope (derive/couplings/drum.py): a tangent point, and the rope that is wound. Its wound length
 * is direction (s - end). Its history is the drawn length over the wound one, in cells. */
typedef struct {
    fu_wheel wheel;
    int node, s; /* dofs: the first of the node; its material coordinate */
    int n_cells;
    double cell, direction, end;    /* m: stress-free length of a cell; 1 at the first end of the rope, else -1; m */
    double tangent_radius, stretch; /* m; of the rope as drawn */
} fu_drum;

typedef struct {
    double tension, force[3], torque, power, length_in_store, material_speed, normal_force, angle, residual;
} drum_output;

/* History of a drum: the last accepted state, and the drawn length over the wound one at the ends of cells. */
typedef struct {
    double is_known, u, phi, turn, carrier, drawn, stretch, profile[];
} history;
enum { HISTORY = 7 };

/* A drum at a state; u: wound length. */
typedef struct {
    fu_wheel_state wheel;
    double x[DIM], slope[DIM], x_rate[DIM], slope_rate[DIM];
    double u, u_rate, turn, carrier, phi, span_stretch, wound, winds;
} view;

static const fu_drum *drum_of(const fu_coupling *coupling)
{
    return (const fu_drum *)coupling;
}

static history *history_of(const fu_drum *drum, const fu_state *state)
{
    return (history *)(state->numbers + drum->wheel.base.numbers);
}

/* --- the wound rope --------------------------------------------------------------------------------------------- */

/* Returns the cell with the last part of a wound length. */
static int cell_of(const fu_drum *drum, double u)
{
    const double cell = ceil(u / drum->cell) - 1.0;
    return cell < 0.0 ? 0 : cell < drum->n_cells ? (int)cell : drum->n_cells - 1;
}

/* Returns the stretch of a cell, the last one of a wound length. */
static double stretch_of(const fu_drum *drum, const history *past, int cell)
{
    if (cell < cell_of(drum, past->u)) return (past->profile[cell + 1] - past->profile[cell]) / drum->cell;
    const double length = past->u - cell * drum->cell;
    return length > 0.0 ? (past->drawn - past->profile[cell]) / length : past->stretch;
}

/* Returns the drawn length of a part u of the wound rope. */
static double drawn_of(const fu_drum *drum, const history *past, double u)
{
    const int cell = cell_of(drum, u);
    return past->profile[cell] + stretch_of(drum, past, cell) * (u - cell * drum->cell);
}

/* Returns a change of an angle that is less than half a turn. */
static double turned(double from, double to)
{
    return remainder(to - from, 2.0 * acos(-1.0));
}

/* Returns the sense in which the tangent point passes over the rim as the rope is wound: that of travel, which pays out
 * at the first end, or its opposite. */
static double winding_sense(const fu_drum *drum)
{
    return drum->direction * drum->wheel.sense;
}

/* Returns the way of the tangent point on the rim since the last accepted state, m. */
static double way_of(const fu_drum *drum, const history *past, const view *at)
{
    return winding_sense(drum) * drum->wheel.radius *
           (turned(past->phi, at->phi) - turned(past->carrier, at->carrier) - (at->turn - past->turn));
}

/* Returns the drawn length that has been wound since then, by the mean stretch of winding. */
static double wound_since(const fu_drum *drum, const history *past, const view *at)
{
    return at->u > past->u ? 0.5 * (at->u - past->u) * (past->stretch + at->span_stretch)
                           : drawn_of(drum, past, at->u) - past->drawn;
}

/* Computes a drum at a state, with these accelerations of the dofs (null: zero). */
static void look(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const double *a, view *out)
{
    const fu_drum *drum = drum_of(coupling);
    const double *v = state->v ? state->v : model->zero;
    const fu_state moving = {.t = state->t, .q = state->q, .v = (double *)v};
    const fu_attachment_state *centre = &out->wheel.centre;
    if (!a) a = model->zero;
    fu_wheel_at(model, &drum->wheel, &moving, a, &out->wheel);
    for (int d = 0; d < DIM; ++d) {
        out->x[d] = state->q[drum->node + d] - centre->p[d];
        out->slope[d] = state->q[drum->node + SLOPE + d];
        out->x_rate[d] = v[drum->node + d] - centre->v[d];
        out->slope_rate[d] = v[drum->node + SLOPE + d];
    }
    out->u = drum->direction * (state->q[drum->s] - drum->end);
    out->u_rate = drum->direction * v[drum->s];
    out->turn = drum->wheel.turn < 0 ? 0.0 : state->q[drum->wheel.turn];
    out->carrier = atan2(centre->A[DIM], centre->A[0]);
    out->phi = atan2(out->x[1], out->x[0]);
    out->span_stretch = sqrt(fu_dot(DIM, out->slope, out->slope));
    out->wound = out->span_stretch;
    out->winds = 1.0;
    if (!state->numbers) return;
    const history *past = history_of(drum, state);
    if (!past->is_known) return;
    out->wound = stretch_of(drum, past, cell_of(drum, out->u));
    out->winds = out->u > past->u || (out->u == past->u && out->u_rate > 0.0) ? 1.0 : 0.0;
}

/* --- forces by y ------------------------------------------------------------------------------------------------ */

/* Computes the dofs of a drum and the changes of y by them, with these moves of the centre; returns their number. */
static int columns_of(const fu_drum *drum, const view *at, const fu_centre_moves *moves, fu_wheel_column *out)
{
    int n = 0;
    for (; n < NODE; ++n) out[n] = (fu_wheel_column){drum->node + n, n, 1, {1.0}};
    out[n++] = (fu_wheel_column){drum->s, LENGTH, 1, {drum->direction}};
    return n + fu_wheel_columns(&drum->wheel, &at->wheel, moves, CENTRE, out + n);
}

/* Adds forces by y to those on the dofs. */
static void scatter(const fu_drum *drum, const view *at, const double *y, double *f)
{
    for (int i = 0; i < NODE; ++i) f[drum->node + i] += y[i];
    f[drum->s] += drum->direction * y[LENGTH];
    fu_wheel_add_forces(&drum->wheel, &at->wheel, y + CENTRE, f);
}

static void store_forces(const fu_drum *drum, const view *at, double F[STORE])
{
    const fu_wheel *wheel = &drum->wheel;
    wheel->kernel->store(wheel->A, wheel->rho, wheel->radius, at->wheel.g, at->u, at->wheel.centre.p,
                         at->wheel.turn_rate, at->wheel.centre.v, at->u_rate, at->wheel.turn_acc, at->wheel.c_acc,
                         at->slope, at->winds, at->wound, F);
}

static void store_derivatives(const fu_drum *drum, const view *at, double *D, double *K)
{
    const fu_wheel *wheel = &drum->wheel;
    wheel->kernel->store_tangent(wheel->A, wheel->rho, wheel->radius, at->wheel.g, at->u, at->wheel.centre.p,
                                 at->wheel.turn_rate, at->wheel.centre.v, at->u_rate, at->wheel.turn_acc,
                                 at->wheel.c_acc, at->slope, at->winds, at->wound, D, K);
}

/* Computes the force on the tangent point, from the centre, of the height at which the rope is laid on; returns its
 * energy. */
static double laying(const fu_drum *drum, const view *at, double F[DIM])
{
    const fu_wheel *wheel = &drum->wheel;
    double V;
    wheel->kernel->laying(wheel->rho, at->wheel.g, winding_sense(drum), wheel->radius, drum->stretch, at->x, &V, F);
    return V;
}

/* Computes all forces by y but those of the conditions; the bearing's is on the drum alone. */
static void forces_by_y(const fu_drum *drum, const view *at, double y[Y])
{
    double F[STORE];
    double laid[DIM];
    memset(y, 0, sizeof(double) * Y);
    store_forces(drum, at, F);
    for (int k = 0; k < STORE; ++k) y[of_store[k]] += F[k];
    laying(drum, at, laid);
    for (int d = 0; d < DIM; ++d) {
        y[d] += laid[d];
        y[CENTRE + d] -= laid[d];
    }
    y[TURN] += drum->wheel.inertia * at->wheel.turn_acc;
}

/* The conditions of a drum: their derivatives by y, and those of J' multipliers. */
typedef struct {
    double J[CONDITIONS][Y], K[Y][Y], phi[DIM];
} conditions;

static void add_of_x(const double *of, double factor, double *row)
{
    for (int i = 0; i < NODE; ++i) row[i] += factor * of[i];
    for (int d = 0; d < DIM; ++d) row[CENTRE + d] -= factor * of[d];
}

static void conditions_of(const fu_drum *drum, const view *at, const double *multipliers, conditions *out)
{
    const fu_wheel *wheel = &drum->wheel;
    double J[DIM * NODE], K[NODE * NODE], of_winding[NODE], K_winding[(DIM + 1) * NODE];
    memset(out, 0, sizeof *out);
    wheel->kernel->tangent_point(at->x, at->slope, drum->tangent_radius, multipliers, out->phi, J, K);
    wheel->kernel->winding(winding_sense(drum), wheel->radius, at->x, at->slope, at->winds, at->wound,
                           multipliers[WINDING], of_winding, K_winding);
    for (int r = 0; r < DIM; ++r) add_of_x(J + r * NODE, 1.0, out->J[r]);
    for (int d = 0; d < DIM; ++d) {
        out->J[WINDING][d] = of_winding[d];
        out->J[WINDING][CENTRE + d] = -of_winding[d];
    }
    out->J[WINDING][TURN] = of_winding[DIM];
    out->J[WINDING][LENGTH] = of_winding[DIM + 1];
    for (int i = 0; i < NODE; ++i) {
        double row[Y] = {0.0};
        add_of_x(K + i * NODE, 1.0, row);
        if (i < DIM) add_of_x(K_winding + i * NODE, 1.0, row);
        for (int j = 0; j < Y; ++j) {
            out->K[i][j] += row[j];
            if (i < DIM) out->K[CENTRE + i][j] -= row[j];
        }
    }
    add_of_x(K_winding + DIM * NODE, 1.0, out->K[LENGTH]);
}

static void add_multipliers(const conditions *of, const double *multipliers, double y[Y])
{
    for (int r = 0; r < CONDITIONS; ++r)
        for (int j = 0; j < Y; ++j) y[j] += of->J[r][j] * multipliers[r];
}

/* Computes the residuals of the conditions: of winding over the step since the last accepted state. */
static void residuals(const fu_drum *drum, const fu_state *state, const view *at, const conditions *of,
                      double phi[CONDITIONS])
{
    const history *past = history_of(drum, state);
    memcpy(phi, of->phi, sizeof of->phi);
    phi[WINDING] = past->is_known ? way_of(drum, past, at) - wound_since(drum, past, at) : 0.0;
}

/* --- inertia ---------------------------------------------------------------------------------------------------- */

/* Computes the mass matrix by y. */
static void mass_by_y(const fu_drum *drum, const view *at, double factor, double (*out)[Y])
{
    double M[(DIM + 1) * (DIM + 1)];
    memset(out, 0, sizeof(double) * Y * Y);
    drum->wheel.kernel->store_mass(drum->wheel.rho, drum->wheel.radius, at->u, M);
    for (int i = 0; i <= DIM; ++i)
        for (int j = 0; j <= DIM; ++j) out[of_store[i]][of_store[j]] = factor * M[i * (DIM + 1) + j];
    out[TURN][TURN] += factor * drum->wheel.inertia;
}

static void inertial_force(const fu_model *model, const fu_coupling *coupling, const double *q, const double *a,
                           double *f)
{
    const fu_drum *drum = drum_of(coupling);
    const fu_state state = {.q = (double *)q};
    double M[Y][Y], acceleration[Y] = {0.0}, y[Y] = {0.0};
    fu_wheel_column columns[COLUMNS];
    fu_centre_moves moves;
    view at;
    look(model, coupling, &state, 0, &at);
    fu_wheel_moves(model, &at.wheel, &moves);
    const int n = columns_of(drum, &at, &moves, columns);
    for (int j = 0; j < n; ++j)
        for (int k = 0; k < columns[j].n; ++k)
            acceleration[columns[j].row + k] += columns[j].value[k] * a[columns[j].dof];
    mass_by_y(drum, &at, 1.0, M);
    for (int i = 0; i < Y; ++i) y[i] = fu_dot(Y, M[i], acceleration);
    scatter(drum, &at, y, f);
}

static void mass_matrix(const fu_model *model, const fu_coupling *coupling, const double *q, double scale,
                        fu_system *system)
{
    const fu_state state = {.q = (double *)q};
    double M[Y][Y];
    fu_wheel_column columns[COLUMNS];
    fu_centre_moves moves;
    view at;
    look(model, coupling, &state, 0, &at);
    mass_by_y(drum_of(coupling), &at, scale, M);
    fu_wheel_moves(model, &at.wheel, &moves);
    const int n = columns_of(drum_of(coupling), &at, &moves, columns);
    fu_wheel_add_matrix(model, n, columns, columns, Y, M[0], system);
}

/* Computes the kinetic energy and that of gravity at a state. */
static void energies(const fu_model *model, const fu_coupling *coupling, const double *q, const double *v, double *T,
                     double *V)
{
    const fu_drum *drum = drum_of(coupling);
    const fu_wheel *wheel = &drum->wheel;
    const fu_state state = {.q = (double *)q, .v = (double *)v};
    double laid[DIM];
    view at;
    look(model, coupling, &state, 0, &at);
    wheel->kernel->store_energy(wheel->rho, wheel->radius, at.wheel.g, at.u, at.wheel.centre.p, at.wheel.turn_rate,
                                at.wheel.centre.v, T, V);
    *V += laying(drum, &at, laid);
    *T += 0.5 * wheel->inertia * at.wheel.turn_rate * at.wheel.turn_rate;
}

static double kinetic_energy(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                             const double *v, int past_fluid)
{
    double T, V;
    (void)t, (void)past_fluid;
    energies(model, coupling, q, v, &T, &V);
    return T;
}

static double potential_energy(const fu_model *model, const fu_coupling *coupling, const double *q)
{
    double T, V;
    energies(model, coupling, q, 0, &T, &V);
    return V;
}

/* --- the coupling ----------------------------------------------------------------------------------------------- */

static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    view at;
    double y[Y];
    look(model, coupling, state, 0, &at);
    forces_by_y(drum_of(coupling), &at, y);
    scatter(drum_of(coupling), &at, y, f);
    fu_wheel_add_bearing(&drum_of(coupling)->wheel, &at.wheel, f);
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations, double *f,
                     double *internal)
{
    const fu_drum *drum = drum_of(coupling);
    const double *multipliers = equations->next->forces + coupling->force;
    view at;
    conditions of;
    double y[Y], phi[CONDITIONS];
    look(model, coupling, equations->next, 0, &at);
    conditions_of(drum, &at, multipliers, &of);
    residuals(drum, equations->next, &at, &of, phi);
    forces_by_y(drum, &at, y);
    add_multipliers(&of, multipliers, y);
    scatter(drum, &at, y, f);
    fu_wheel_add_bearing(&drum->wheel, &at.wheel, f);
    for (int r = 0; r < CONDITIONS; ++r)
        internal[coupling->unknown + r] = -fu_row_unit(equations->weights.inertia, coupling->scale[r]) * phi[r];
}

/* Adds the rows of the conditions, and the columns of their forces. */
static void add_rows(const fu_model *model, const fu_coupling *coupling, const conditions *of, int n,
                     const fu_wheel_column *rows, const fu_wheel_column *columns, double inertia, fu_system *system)
{
    const int own = fu_extra(model, coupling->unknown);
    for (int r = 0; r < CONDITIONS; ++r)
        for (int j = 0; j < n; ++j) {
            const double unit = fu_row_unit(inertia, coupling->scale[r]);
            const double row = fu_by_column(&columns[j], of->J[r]), column = fu_by_column(&rows[j], of->J[r]);
            if (row != 0.0) fu_add(model, system, own + r, columns[j].dof, unit * row);
            if (column != 0.0) fu_add(model, system, rows[j].dof, own + r, unit * column);
        }
}

/* Adds the tangent; derivatives of the acceleration of the centre by rotations of its body are neglected. */
static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations,
                    fu_system *system)
{
    static const int of_place[DIM + 1 + DIM] = {CENTRE, CENTRE + 1, LENGTH, SLOPE, SLOPE + 1};
    const fu_drum *drum = drum_of(coupling);
    const fu_weights w = equations->weights;
    const double *multipliers = equations->next->forces + coupling->force;
    double D[STORE * STORE], K[STORE * (DIM + 1 + DIM)], D_y[Y][Y], K_y[Y][Y], y[Y];
    fu_centre_moves moves, by_psi;
    fu_wheel_column columns[COLUMNS], turned[COLUMNS];
    view at;
    conditions of;
    look(model, coupling, equations->next, equations->next->acceleration, &at);
    conditions_of(drum, &at, multipliers, &of);
    store_derivatives(drum, &at, D, K);
    memset(D_y, 0, sizeof D_y);
    memset(K_y, 0, sizeof K_y);
    for (int i = 0; i < Y; ++i)
        for (int j = 0; j < Y; ++j) K_y[i][j] = w.stiffness * of.K[i][j];
    for (int i = 0; i < STORE; ++i) {
        for (int j = 0; j < STORE; ++j) D_y[of_store[i]][of_store[j]] = w.stiffness * w.rate * D[i * STORE + j];
        for (int j = 0; j < DIM + 1 + DIM; ++j)
            K_y[of_store[i]][of_place[j]] += w.stiffness * K[i * (DIM + 1 + DIM) + j];
    }
    fu_wheel_by_psi(model, &drum->wheel, &at.wheel, equations->psi, &by_psi);
    fu_wheel_moves(model, &at.wheel, &moves);
    const int n = columns_of(drum, &at, &moves, columns);
    columns_of(drum, &at, &by_psi, turned);
    add_rows(model, coupling, &of, n, columns, turned, w.inertia, system);
    fu_wheel_add_matrix(model, n, columns, turned, Y, K_y[0], system);
    if (w.rate != 0.0) fu_wheel_add_matrix(model, n, columns, columns, Y, D_y[0], system);
    forces_by_y(drum, &at, y);
    add_multipliers(&of, multipliers, y);
    fu_wheel_add_tangent(model, &drum->wheel, &at.wheel, equations, y + CENTRE, system);
}

/* Of winding the rates are the condition; a residual of places is corrected where the rope keeps its stretch. */
static void rows(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_accelerator *work)
{
    const fu_drum *drum = drum_of(coupling);
    const fu_wheel *wheel = &drum->wheel;
    const double none[CONDITIONS] = {0.0};
    fu_rows *out = &work->rows[coupling->row];
    double bias[CONDITIONS];
    fu_wheel_column columns[COLUMNS];
    fu_centre_moves moves;
    view at;
    conditions of;
    look(model, coupling, state, 0, &at);
    conditions_of(drum, &at, none, &of);
    residuals(drum, state, &at, &of, out->C);
    if (at.winds != 0.0) out->C[WINDING] = 0.0;
    wheel->kernel->tangent_point_motion(at.x, at.x_rate, at.slope_rate, bias);
    wheel->kernel->winding_motion(winding_sense(drum), wheel->radius, at.x, at.slope, at.winds, at.wound, at.x_rate,
                                  at.slope_rate, at.u_rate, bias + WINDING);
    fu_wheel_moves(model, &at.wheel, &moves);
    out->n = columns_of(drum, &at, &moves, columns);
    for (int j = 0; j < out->n; ++j) out->at[j] = columns[j].dof;
    for (int r = 0; r < CONDITIONS; ++r) {
        out->rate[r] = 0.0;
        out->W[r] = -bias[r];
        for (int d = 0; d < DIM; ++d) out->W[r] -= of.J[r][CENTRE + d] * at.wheel.centre.bias[d];
        for (int j = 0; j < out->n; ++j) out->H[r * out->n + j] = fu_by_column(&columns[j], of.J[r]);
    }
}

static void take_forces(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work, fu_state *state)
{
    (void)model;
    memcpy(state->forces + coupling->force, work->multipliers + coupling->multiplier, sizeof(double) * CONDITIONS);
}

static void gaps(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *phi)
{
    view at;
    conditions of;
    look(model, coupling, state, 0, &at);
    conditions_of(drum_of(coupling), &at, state->forces + coupling->force, &of);
    residuals(drum_of(coupling), state, &at, &of, phi);
}

/* Returns the elastic energy of the wound rope: cell by cell, and of what has been wound since with the span's
 * stretch. */
static double energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_drum *drum = drum_of(coupling);
    const fu_wheel *wheel = &drum->wheel;
    const history *past = history_of(drum, state);
    double total = 0.0, W, loss;
    view at;
    look(model, coupling, state, 0, &at);
    const double known = past->is_known ? fmin(at.u, past->u) : 0.0;
    const int last = cell_of(drum, known);
    for (int cell = 0; known > 0.0 && cell <= last; ++cell) {
        const double length = cell < last ? drum->cell : known - cell * drum->cell;
        wheel->kernel->creep(wheel->A, wheel->radius, stretch_of(drum, past, cell), 1.0, &W, &loss);
        total += length * W;
    }
    wheel->kernel->creep(wheel->A, wheel->radius, at.span_stretch, 1.0, &W, &loss);
    return total + (at.u - known) * W;
}

static double dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const fu_accelerator *work)
{
    const fu_drum *drum = drum_of(coupling);
    const fu_wheel *wheel = &drum->wheel;
    double W, loss;
    view at;
    (void)work;
    look(model, coupling, state, 0, &at);
    wheel->kernel->creep(wheel->A, wheel->radius, at.wound, at.span_stretch, &W, &loss);
    return wheel->damping * at.wheel.own_rate * at.wheel.own_rate + loss * fabs(at.u_rate);
}

/* Updates the profile of the wound rope: what is wound has the mean stretch of its way on the rim. */
static void update_history(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    const fu_drum *drum = drum_of(coupling);
    history *past = history_of(drum, state);
    view at;
    look(model, coupling, state, 0, &at);
    if (!past->is_known) {
        for (int cell = 0; cell <= drum->n_cells; ++cell)
            past->profile[cell] = at.span_stretch * fmin(at.u, cell * drum->cell);
        past->drawn = at.span_stretch * at.u;
        past->is_known = 1.0;
    } else if (at.u > past->u) {
        const double way = way_of(drum, past, &at);
        for (int cell = cell_of(drum, past->u) + 1; cell <= cell_of(drum, at.u); ++cell)
            past->profile[cell] = past->drawn + way * (cell * drum->cell - past->u) / (at.u - past->u);
        past->drawn += way;
    } else past->drawn = drawn_of(drum, past, at.u);
    past->u = at.u;
    past->phi = at.phi;
    past->turn = at.turn;
    past->carrier = at.carrier;
    past->stretch = at.span_stretch;
}

double fu_drum_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_drum *drum = drum_of(coupling);
    (void)model;
    return drum->direction * (state->q[drum->s] - drum->end);
}

/* Computes the speed of the material on the tangent of the groove, past the centre. */
static double speed_of(const fu_drum *drum, const view *at, double t[DIM])
{
    const fu_wheel *wheel = &drum->wheel;
    t[0] = -wheel->sense * sin(at->phi);
    t[1] = wheel->sense * cos(at->phi);
    return fu_dot(DIM, t, at->x_rate) - fu_dot(DIM, t, at->slope) * drum->direction * at->u_rate;
}

/* Returns the normal force on an angle at the tangent point, by the elastic tension of the span there. */
static double pressure(const fu_drum *drum, const view *at)
{
    double t[DIM];
    const double speed = speed_of(drum, at, t), tension = drum->wheel.A[0] * (fu_dot(DIM, t, at->slope) - 1.0);
    return fu_wheel_pressure(&drum->wheel, &at->wheel, at->phi, tension, speed, at->span_stretch);
}

double fu_drum_pressure(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    view at;
    look(model, coupling, state, state->acceleration, &at);
    return pressure(drum_of(coupling), &at);
}

/* The tension is that at the node by the balance of its momentum, see sheave_output.c. */
static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    const fu_drum *drum = drum_of(coupling);
    const fu_wheel *wheel = &drum->wheel;
    const double *multipliers = work ? work->multipliers + coupling->multiplier : state->forces + coupling->force;
    drum_output *numbers = (drum_output *)out;
    double y[Y], t[DIM], phi[CONDITIONS];
    view at;
    conditions of;
    look(model, coupling, state, acceleration, &at);
    conditions_of(drum, &at, multipliers, &of);
    residuals(drum, state, &at, &of, phi);
    forces_by_y(drum, &at, y);
    add_multipliers(&of, multipliers, y);
    const double speed = speed_of(drum, &at, t), s_rate = drum->direction * at.u_rate;
    const double velocity = speed + fu_dot(DIM, t, at.wheel.centre.v);
    *numbers = (drum_output){.length_in_store = at.u, .material_speed = -s_rate, .angle = at.turn};
    numbers->tension = drum->direction * fu_dot(DIM, t, y) - wheel->rho * s_rate * velocity;
    numbers->normal_force = pressure(drum, &at);
    numbers->torque = y[TURN] + wheel->damping * at.wheel.own_rate;
    numbers->power = numbers->torque * at.wheel.own_rate;
    for (int d = 0; d < DIM; ++d) numbers->force[d] = -y[CENTRE + d];
    for (int r = 0; r < DIM; ++r) numbers->residual = fmax(numbers->residual, fabs(phi[r]));
}

static const char *const role[] = {"sheave", 0};

static const fu_field fields[] = {
    FU_FIELD(fu_wheel, kernel, FU_KERNELS, role),
    FU_WHEEL_FIELDS,
    FU_FIELD(fu_drum, node, FU_INTEGER, 0),
    FU_FIELD(fu_drum, s, FU_INTEGER, 0),
    FU_FIELD(fu_drum, n_cells, FU_INTEGER, 0),
    FU_FIELD(fu_drum, cell, FU_REAL, 0),
    FU_FIELD(fu_drum, direction, FU_REAL, 0),
    FU_FIELD(fu_drum, end, FU_REAL, 0),
    FU_FIELD(fu_drum, tangent_radius, FU_REAL, 0),
    FU_FIELD(fu_drum, stretch, FU_REAL, 0),
    {0},
};

static const fu_output output_fields[] = {
    FU_OUTPUT(drum_output, tension, "N", NULL),         FU_OUTPUT(drum_output, force, "N", "direction"),
    FU_OUTPUT(drum_output, torque, "N m", NULL),        FU_OUTPUT(drum_output, power, "W", NULL),
    FU_OUTPUT(drum_output, length_in_store, "m", NULL), FU_OUTPUT(drum_output, material_speed, "m/s", NULL),
    FU_OUTPUT(drum_output, normal_force, "N", NULL),    FU_OUTPUT(drum_output, angle, "rad", NULL),
    FU_OUTPUT(drum_output, residual, "m", NULL),        FU_LAST_OUTPUT(drum_output),
};

static const fu_inertia_operations inertia = {inertial_force, mass_matrix, kinetic_energy, potential_energy};
static const fu_start_operations start = {.may_be_open = fu_wheel_may_be_open};
static const fu_history_operations of_history = {.update = update_history};

const fu_coupling_type fu_drum_type = {
    .name = "drum",
    .size = sizeof(fu_drum),
    .fields = fields,
    .output_fields = output_fields,
    .n_numbers = HISTORY,
    .inertia = &inertia,
    .supply = &fu_wheel_supply,
    .start = &start,
    .history = &of_history,
    .residual = residual,
    .tangent = tangent,
    .rows = rows,
    .force = force,
    .take_forces = take_forces,
    .outputs = outputs,
    .gaps = gaps,
    .energy = energy,
    .dissipation = dissipation,
};
