/* Drums: a tangent point at an end of a rope, the condition of winding, and the rope that is wound. Derivatives are by
 * the place and slope of the node, the centre, the rotation of the drum, and the wound length (y). */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/rope/rope.h"

#include <math.h>
#include <string.h>

enum { DIM = 2, NODE = 2 * DIM, CONDITIONS = DIM + 1, WINDING = DIM };
/* y, and its columns by the dofs: node, wound length, rotation, coordinates of the centre */
enum { SLOPE = DIM, CENTRE = NODE, TURN = CENTRE + DIM, LENGTH = TURN + 1, Y = LENGTH + 1 };
enum { COLUMNS = NODE + 2 + FU_ATTACHMENT_COORDINATES };
/* of the forces of the wound rope: on the rotation, the centre, the length */
enum { STORE = 2 + DIM };
static const int of_store[STORE] = {TURN, CENTRE, CENTRE + 1, LENGTH};

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
    fu_attachment_state centre;
    double x[DIM], slope[DIM], x_rate[DIM], slope_rate[DIM], c_acc[DIM];
    double u, u_rate, turn, carrier, spin, spin_acc, own_rate, phi, span_stretch, wound, winds;
} view;

static const fu_drum *drum_of(const fu_coupling *coupling)
{
    return (const fu_drum *)coupling;
}

static history *history_of(const fu_drum *drum, const fu_state *state)
{
    return (history *)(state->numbers + drum->base.numbers);
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
    return drum->direction * drum->sense;
}

/* Returns the way of the tangent point on the rim since the last accepted state, m. */
static double way_of(const fu_drum *drum, const history *past, const view *at)
{
    return winding_sense(drum) * drum->radius *
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
    fu_attachment_state *centre = &out->centre;
    if (!a) a = model->zero;
    fu_attachment_at(model, &drum->attachments[0], &moving, 0.0, FU_POINT | FU_AXES, centre);
    memcpy(out->c_acc, centre->bias, sizeof out->c_acc);
    out->own_rate = drum->turn < 0 ? 0.0 : v[drum->turn];
    out->spin = out->own_rate + centre->omega[0];
    out->spin_acc = drum->turn < 0 ? 0.0 : a[drum->turn];
    for (int i = 0; i < centre->n; ++i) {
        for (int d = 0; d < DIM; ++d) out->c_acc[d] += centre->P[d * centre->n + i] * a[centre->at[i]];
        out->spin_acc += centre->T[i] * a[centre->at[i]];
    }
    for (int d = 0; d < DIM; ++d) {
        out->x[d] = state->q[drum->node + d] - centre->p[d];
        out->slope[d] = state->q[drum->node + SLOPE + d];
        out->x_rate[d] = v[drum->node + d] - centre->v[d];
        out->slope_rate[d] = v[drum->node + SLOPE + d];
    }
    out->u = drum->direction * (state->q[drum->s] - drum->end);
    out->u_rate = drum->direction * v[drum->s];
    out->turn = drum->turn < 0 ? 0.0 : state->q[drum->turn];
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

/* The dofs of a drum and the change of y by them (Y x n), in `by`. */
static int columns_of(const fu_drum *drum, const view *at, const double *P, int *dofs, double (*by)[COLUMNS])
{
    const int n_centre = at->centre.n;
    int n = 0;
    memset(by, 0, sizeof(double) * Y * COLUMNS);
    for (; n < NODE; ++n) {
        dofs[n] = drum->node + n;
        by[n][n] = 1.0;
    }
    dofs[n] = drum->s;
    by[LENGTH][n++] = drum->direction;
    if (drum->turn >= 0) {
        dofs[n] = drum->turn;
        by[TURN][n++] = 1.0;
    }
    for (int i = 0; i < n_centre; ++i, ++n) {
        dofs[n] = at->centre.at[i];
        for (int d = 0; d < DIM; ++d) by[CENTRE + d][n] = P[d * n_centre + i];
        by[TURN][n] = at->centre.T[i];
    }
    return n;
}

/* Adds forces by y to those on the dofs. */
static void scatter(const fu_drum *drum, const view *at, const double *y, double *f)
{
    for (int i = 0; i < NODE; ++i) f[drum->node + i] += y[i];
    f[drum->s] += drum->direction * y[LENGTH];
    if (drum->turn >= 0) f[drum->turn] += y[TURN];
    fu_add_wrench(DIM, &at->centre, y + CENTRE, y + TURN, 1.0, f);
}

static void store_forces(const fu_drum *drum, const view *at, double F[STORE])
{
    drum->kernel->store(drum->A, drum->rho, drum->radius, drum->g, at->u, at->centre.p, at->spin, at->centre.v,
                        at->u_rate, at->spin_acc, at->c_acc, at->slope, at->winds, at->wound, F);
}

static void store_derivatives(const fu_drum *drum, const view *at, double *M, double *D, double *K)
{
    drum->kernel->store_tangent(drum->A, drum->rho, drum->radius, drum->g, at->u, at->centre.p, at->spin, at->centre.v,
                                at->u_rate, at->spin_acc, at->c_acc, at->slope, at->winds, at->wound, M, D, K);
}

/* Computes all forces by y but those of the conditions; the bearing's is on the drum alone. */
static void forces_by_y(const fu_drum *drum, const view *at, double y[Y])
{
    double F[STORE];
    memset(y, 0, sizeof(double) * Y);
    store_forces(drum, at, F);
    for (int k = 0; k < STORE; ++k) y[of_store[k]] += F[k];
    y[TURN] += drum->inertia * at->spin_acc;
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
    double J[DIM * NODE], K[NODE * NODE], of_winding[NODE], K_winding[(DIM + 1) * NODE];
    memset(out, 0, sizeof *out);
    drum->kernel->tangent_point(at->x, at->slope, drum->tangent_radius, multipliers, out->phi, J, K);
    drum->kernel->winding(winding_sense(drum), drum->radius, at->x, at->slope, at->winds, at->wound,
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
    double M[STORE * (DIM + 1)], D[STORE * STORE], K[STORE * (DIM + 1 + DIM)];
    memset(out, 0, sizeof(double) * Y * Y);
    store_derivatives(drum, at, M, D, K);
    for (int i = 0; i < STORE; ++i)
        for (int j = 0; j <= DIM; ++j) out[of_store[i]][of_store[j]] = factor * M[i * (DIM + 1) + j];
    out[TURN][TURN] += factor * drum->inertia;
}

/* Adds by' K by_column of K (Y x Y) to a system. */
static void add_matrix(const fu_model *model, const fu_drum *drum, const view *at, const double *P_column,
                       double (*K)[Y], fu_system *system)
{
    double by[Y][COLUMNS], by_column[Y][COLUMNS];
    int dofs[COLUMNS];
    const int n = columns_of(drum, at, at->centre.P, dofs, by);
    columns_of(drum, at, P_column, dofs, by_column);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            double sum = 0.0;
            for (int k = 0; k < Y; ++k)
                for (int l = 0; by[k][i] != 0.0 && l < Y; ++l) sum += by[k][i] * K[k][l] * by_column[l][j];
            if (sum != 0.0) fu_add(model, system, dofs[i], dofs[j], sum);
        }
}

static void inertial_force(const fu_model *model, const fu_coupling *coupling, const double *q, const double *a,
                           double *f)
{
    const fu_drum *drum = drum_of(coupling);
    const fu_state state = {.q = (double *)q};
    double M[Y][Y], by[Y][COLUMNS], acceleration[Y] = {0.0}, y[Y] = {0.0};
    int dofs[COLUMNS];
    view at;
    look(model, coupling, &state, 0, &at);
    const int n = columns_of(drum, &at, at.centre.P, dofs, by);
    for (int i = 0; i < Y; ++i)
        for (int j = 0; j < n; ++j) acceleration[i] += by[i][j] * a[dofs[j]];
    mass_by_y(drum, &at, 1.0, M);
    for (int i = 0; i < Y; ++i) y[i] = fu_dot(Y, M[i], acceleration);
    scatter(drum, &at, y, f);
}

static void mass_matrix(const fu_model *model, const fu_coupling *coupling, const double *q, double scale,
                        fu_system *system)
{
    const fu_state state = {.q = (double *)q};
    double M[Y][Y];
    view at;
    look(model, coupling, &state, 0, &at);
    mass_by_y(drum_of(coupling), &at, scale, M);
    add_matrix(model, drum_of(coupling), &at, at.centre.P, M, system);
}

/* Computes the kinetic energy and that of gravity at a state. */
static void energies(const fu_model *model, const fu_coupling *coupling, const double *q, const double *v, double *T,
                     double *V)
{
    const fu_drum *drum = drum_of(coupling);
    const fu_state state = {.q = (double *)q, .v = (double *)v};
    view at;
    look(model, coupling, &state, 0, &at);
    drum->kernel->store_energy(drum->rho, drum->radius, drum->g, at.u, at.centre.p, at.spin, at.centre.v, T, V);
    *T += 0.5 * drum->inertia * at.spin * at.spin;
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

static void add_bearing(const fu_drum *drum, const view *at, double *f)
{
    if (drum->turn >= 0) f[drum->turn] += drum->damping * at->own_rate;
}

static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    view at;
    double y[Y];
    look(model, coupling, state, 0, &at);
    forces_by_y(drum_of(coupling), &at, y);
    scatter(drum_of(coupling), &at, y, f);
    add_bearing(drum_of(coupling), &at, f);
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
    add_bearing(drum, &at, f);
    for (int r = 0; r < CONDITIONS; ++r)
        internal[coupling->unknown + r] = -fu_row_unit(equations->weights.inertia, coupling->scale[r]) * phi[r];
}

/* Adds the rows of the conditions, and the columns of their forces. */
static void add_rows(const fu_model *model, const fu_coupling *coupling, const view *at, const conditions *of,
                     const double *by_psi, double inertia, fu_system *system)
{
    const int own = fu_extra(model, coupling->unknown);
    double by[Y][COLUMNS], by_column[Y][COLUMNS];
    int dofs[COLUMNS];
    const int n = columns_of(drum_of(coupling), at, at->centre.P, dofs, by);
    columns_of(drum_of(coupling), at, by_psi, dofs, by_column);
    for (int r = 0; r < CONDITIONS; ++r)
        for (int j = 0; j < n; ++j) {
            const double unit = fu_row_unit(inertia, coupling->scale[r]);
            double row = 0.0, column = 0.0;
            for (int i = 0; i < Y; ++i) {
                row += of->J[r][i] * by_column[i][j];
                column += of->J[r][i] * by[i][j];
            }
            if (row != 0.0) fu_add(model, system, own + r, dofs[j], unit * row);
            if (column != 0.0) fu_add(model, system, dofs[j], own + r, unit * column);
        }
}

/* Adds the change of the force and the moment on the centre with its body, at fixed ones. */
static void add_centre(const fu_model *model, const fu_drum *drum, const view *at, const fu_equations *equations,
                       const double *y, fu_system *system)
{
    const int n = at->centre.n;
    const double moment[3] = {y[TURN], 0.0, 0.0};
    double K[FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES];
    if (!n) return;
    fu_wrench_derivatives(model, &drum->attachments[0], equations->next, y + CENTRE, moment, n, K, 0, 0);
    fu_turn_attachment(model, &drum->attachments[0], equations->psi, K, n, n, 0);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            if (K[i * n + j] != 0.0)
                fu_add(model, system, at->centre.at[i], at->centre.at[j], equations->weights.stiffness * K[i * n + j]);
}

/* Adds the tangent; derivatives of the acceleration of the centre by rotations of its body are neglected. */
static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations,
                    fu_system *system)
{
    static const int of_place[DIM + 1 + DIM] = {CENTRE, CENTRE + 1, LENGTH, SLOPE, SLOPE + 1};
    const fu_drum *drum = drum_of(coupling);
    const fu_weights w = equations->weights;
    const double *multipliers = equations->next->forces + coupling->force;
    double M[STORE * (DIM + 1)], D[STORE * STORE], K[STORE * (DIM + 1 + DIM)], D_y[Y][Y], K_y[Y][Y], y[Y],
        by_psi[DIM * FU_ATTACHMENT_COORDINATES];
    view at;
    conditions of;
    look(model, coupling, equations->next, equations->next->acceleration, &at);
    conditions_of(drum, &at, multipliers, &of);
    store_derivatives(drum, &at, M, D, K);
    memset(D_y, 0, sizeof D_y);
    memset(K_y, 0, sizeof K_y);
    for (int i = 0; i < Y; ++i)
        for (int j = 0; j < Y; ++j) K_y[i][j] = w.stiffness * of.K[i][j];
    for (int i = 0; i < STORE; ++i) {
        for (int j = 0; j < STORE; ++j) D_y[of_store[i]][of_store[j]] = w.stiffness * w.rate * D[i * STORE + j];
        for (int j = 0; j < DIM + 1 + DIM; ++j)
            K_y[of_store[i]][of_place[j]] += w.stiffness * K[i * (DIM + 1 + DIM) + j];
    }
    memcpy(by_psi, at.centre.P, sizeof(double) * (size_t)(DIM * at.centre.n));
    fu_turn_attachment(model, &drum->attachments[0], equations->psi, by_psi, DIM, at.centre.n, 0);
    add_rows(model, coupling, &at, &of, by_psi, w.inertia, system);
    add_matrix(model, drum, &at, by_psi, K_y, system);
    if (w.rate != 0.0) add_matrix(model, drum, &at, at.centre.P, D_y, system);
    if (drum->turn >= 0 && drum->damping != 0.0)
        fu_add(model, system, drum->turn, drum->turn, w.stiffness * w.rate * drum->damping);
    forces_by_y(drum, &at, y);
    add_multipliers(&of, multipliers, y);
    add_centre(model, drum, &at, equations, y, system);
}

/* Of winding the rates are the condition; a residual of places is corrected where the rope keeps its stretch. */
static void rows(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_accelerator *work)
{
    const fu_drum *drum = drum_of(coupling);
    const double none[CONDITIONS] = {0.0};
    fu_rows *out = &work->rows[coupling->row];
    double by[Y][COLUMNS], bias[CONDITIONS];
    view at;
    conditions of;
    look(model, coupling, state, 0, &at);
    conditions_of(drum, &at, none, &of);
    residuals(drum, state, &at, &of, out->C);
    if (at.winds != 0.0) out->C[WINDING] = 0.0;
    drum->kernel->tangent_point_motion(at.x, at.x_rate, at.slope_rate, bias);
    drum->kernel->winding_motion(winding_sense(drum), drum->radius, at.x, at.slope, at.winds, at.wound, at.x_rate,
                                 at.slope_rate, at.u_rate, bias + WINDING);
    out->n = columns_of(drum, &at, at.centre.P, out->at, by);
    for (int r = 0; r < CONDITIONS; ++r) {
        out->rate[r] = 0.0;
        out->W[r] = -bias[r];
        for (int d = 0; d < DIM; ++d) out->W[r] -= of.J[r][CENTRE + d] * at.centre.bias[d];
        for (int j = 0; j < out->n; ++j) {
            double value = 0.0;
            for (int i = 0; i < Y; ++i) value += of.J[r][i] * by[i][j];
            out->H[r * out->n + j] = value;
        }
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
    const history *past = history_of(drum, state);
    double total = 0.0, W, loss;
    view at;
    look(model, coupling, state, 0, &at);
    const double known = past->is_known ? fmin(at.u, past->u) : 0.0;
    const int last = cell_of(drum, known);
    for (int cell = 0; known > 0.0 && cell <= last; ++cell) {
        const double length = cell < last ? drum->cell : known - cell * drum->cell;
        drum->kernel->creep(drum->A, drum->radius, stretch_of(drum, past, cell), 1.0, &W, &loss);
        total += length * W;
    }
    drum->kernel->creep(drum->A, drum->radius, at.span_stretch, 1.0, &W, &loss);
    return total + (at.u - known) * W;
}

static double dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const fu_accelerator *work)
{
    const fu_drum *drum = drum_of(coupling);
    double W, loss;
    view at;
    (void)work;
    look(model, coupling, state, 0, &at);
    drum->kernel->creep(drum->A, drum->radius, at.wound, at.span_stretch, &W, &loss);
    return drum->damping * at.own_rate * at.own_rate + loss * fabs(at.u_rate);
}

/* Subtracts the torque of the drive. */
static void drive(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double *f)
{
    const fu_drum *drum = drum_of(coupling);
    const int signal = drum->torque_signal;
    (void)q;
    if (drum->turn < 0 || drum->torque == 0.0) return;
    f[drum->turn] -=
        model->load_fraction * drum->torque * (signal < 0 ? 1.0 : fu_signal_at(&model->signals[signal], t, 0, 0));
}

static int may_be_open(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    (void)model, (void)coupling, (void)state;
    return 1;
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
    t[0] = -drum->sense * sin(at->phi);
    t[1] = drum->sense * cos(at->phi);
    return fu_dot(DIM, t, at->x_rate) - fu_dot(DIM, t, at->slope) * drum->direction * at->u_rate;
}

/* Returns the normal force on an angle at the tangent point, by the elastic tension of the span there. */
static double pressure(const fu_drum *drum, const view *at)
{
    double t[DIM];
    const double speed = speed_of(drum, at, t), tension = drum->A[0] * (fu_dot(DIM, t, at->slope) - 1.0);
    const double outwards = (drum->g[0] - at->c_acc[0]) * cos(at->phi) + (drum->g[1] - at->c_acc[1]) * sin(at->phi);
    return tension - drum->rho / at->span_stretch * (speed * speed + drum->radius * outwards);
}

double fu_drum_pressure(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    view at;
    look(model, coupling, state, state->acceleration, &at);
    return pressure(drum_of(coupling), &at);
}

/* The tension is that at the node by the balance of its momentum, see sheave.c. */
static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    const fu_drum *drum = drum_of(coupling);
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
    const double velocity = speed + fu_dot(DIM, t, at.centre.v);
    *numbers = (drum_output){.length_in_store = at.u, .material_speed = -s_rate, .angle = at.turn};
    numbers->tension = drum->direction * fu_dot(DIM, t, y) - drum->rho * s_rate * velocity;
    numbers->normal_force = pressure(drum, &at);
    numbers->torque = y[TURN] + drum->damping * at.own_rate;
    numbers->power = numbers->torque * at.own_rate;
    for (int d = 0; d < DIM; ++d) numbers->force[d] = -y[CENTRE + d];
    for (int r = 0; r < DIM; ++r) numbers->residual = fmax(numbers->residual, fabs(phi[r]));
}

static const char *const role[] = {"sheave", 0};

static const fu_field fields[] = {
    FU_FIELD(fu_drum, kernel, FU_KERNELS, role),
    FU_FIELD_ARRAY(fu_drum, attachments, FU_ATTACHMENT),
    FU_FIELD(fu_drum, node, FU_INTEGER, 0),
    FU_FIELD(fu_drum, s, FU_INTEGER, 0),
    FU_FIELD(fu_drum, turn, FU_INTEGER, 0),
    FU_FIELD(fu_drum, n_cells, FU_INTEGER, 0),
    FU_FIELD(fu_drum, cell, FU_REAL, 0),
    FU_FIELD(fu_drum, direction, FU_REAL, 0),
    FU_FIELD(fu_drum, end, FU_REAL, 0),
    FU_FIELD(fu_drum, inertia, FU_REAL, 0),
    FU_FIELD(fu_drum, torque_signal, FU_INTEGER, 0),
    FU_FIELD(fu_drum, torque, FU_REAL, 0),
    FU_FIELD(fu_drum, damping, FU_REAL, 0),
    FU_FIELD(fu_drum, radius, FU_REAL, 0),
    FU_FIELD(fu_drum, tangent_radius, FU_REAL, 0),
    FU_FIELD(fu_drum, sense, FU_REAL, 0),
    FU_FIELD(fu_drum, rho, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_drum, g, FU_REAL),
    FU_FIELD_ARRAY(fu_drum, A, FU_REAL),
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
static const fu_supply_operations supply = {.force = drive};
static const fu_start_operations start = {.may_be_open = may_be_open};
static const fu_history_operations of_history = {.update = update_history};

const fu_coupling_type fu_drum_type = {
    .name = "drum",
    .size = sizeof(fu_drum),
    .fields = fields,
    .output_fields = output_fields,
    .n_numbers = HISTORY,
    .inertia = &inertia,
    .supply = &supply,
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
