/* The rope that is wound on a drum: its energies, inertia and weight, by y; and the update of its history. */
#include "couplings/common/couplings.h"
#include "couplings/drum/drum.h"
#include "couplings/rope/rope.h"

#include <math.h>
#include <string.h>

#define NO_STORE 1e-9 /* of the radius: wound length of a drum that a rope has left, at most */

/* of the forces of the wound rope in the plane: on the rotation, the centre, the length */
enum { STORE = 2 + DIM };
static const int of_store[STORE] = {TURN, CENTRE, CENTRE + 1, LENGTH};

/* --- forces by y ------------------------------------------------------------------------------------------------ */

static void store_forces(const fu_drum *drum, const fu_drum_state *at, double F[STORE])
{
    const fu_wheel *wheel = &drum->wheel;
    wheel->kernel->store(wheel->A, wheel->rho, wheel->radius, at->wheel.g, at->u, at->wheel.c, at->wheel.turn_rate,
                         at->wheel.c_rate, at->u_rate, at->wheel.turn_acc, at->wheel.c_acc, at->slope, at->winds,
                         at->wound, F);
}

static void store_derivatives(const fu_drum *drum, const fu_drum_state *at, double *D, double *K)
{
    const fu_wheel *wheel = &drum->wheel;
    wheel->kernel->store_tangent(wheel->A, wheel->rho, wheel->radius, at->wheel.g, at->u, at->wheel.c,
                                 at->wheel.turn_rate, at->wheel.c_rate, at->u_rate, at->wheel.turn_acc, at->wheel.c_acc,
                                 at->slope, at->winds, at->wound, D, K);
}

/* The energy of the height at which the rope is laid on, and its derivatives by the place of the tangent point from the
 * centre, in space by rotations of the groove, too. */
enum { LAID = DIM + FU_TILTS };
typedef struct {
    double V, F[LAID], K[LAID * LAID];
} laid_rope;

static laid_rope laying(const fu_drum *drum, const fu_drum_state *at)
{
    const fu_wheel *wheel = &drum->wheel;
    laid_rope out = {.V = 0.0};
    if (is_in_space(drum)) {
        const double x[SPACE] = {at->x[0], at->x[1], at->rise};
        wheel->foot->laid_weight(wheel->rho * fu_winding_sense(drum) * wheel->radius * wheel->radius / drum->stretch,
                                 at->wheel.g, x, &out.V, out.F, out.K);
    } else
        wheel->kernel->laying(wheel->rho, at->wheel.g, fu_winding_sense(drum), wheel->radius, drum->stretch, at->x,
                              &out.V, out.F);
    return out;
}

/* Motion of the wound rope along the axis, in space: of w, s_a and s_b of the kernel the first and the last are the
 * place along the axis and the wound length. */
typedef struct {
    double T, V, f[3], M[3], D[9], K[6];
} motion_across;
static const int of_across[2] = {ACROSS, LENGTH};

static motion_across across_of(const fu_drum *drum, const fu_drum_state *at)
{
    const fu_wheel *wheel = &drum->wheel;
    const double s_rate[2] = {0.0, at->u_rate};
    motion_across out;
    wheel->foot->across(wheel->rho, at->u, at->wheel.across, at->wheel.g[DIM], at->wheel.across_rate,
                        at->wheel.across_acc, s_rate, &out.T, &out.V, out.f, out.M, out.D, out.K);
    return out;
}

/* Computes the inertia of the wound rope of a length about a diameter, and of rope and drum about the axis. */
static void rings(const fu_drum *drum, double u, double out[2])
{
    const double axial = drum->wheel.rho * u * drum->wheel.radius * drum->wheel.radius;
    out[0] = 0.5 * axial;
    out[1] = axial + drum->wheel.inertia;
}

/* Adds the forces of the wound rope that moves along the axis and tilts; returns the kinetic energy of the latter. */
static double add_in_space(const fu_drum *drum, const fu_drum_state *at, double y[Y])
{
    const motion_across across = across_of(drum, at);
    double inertia[2], growth[2], none[FU_WHEEL_FORCES] = {0.0};
    y[ACROSS] += across.f[0];
    y[LENGTH] += across.f[2];
    if (!drum->wheel.tilts) return 0.0;
    rings(drum, at->u, inertia);
    rings(drum, at->u_rate, growth);
    const double tilting = fu_wheel_add_ring(&drum->wheel, &at->wheel, inertia, growth[0], y + CENTRE);
    rings(drum, 1.0, inertia);
    y[LENGTH] -= fu_wheel_add_ring(&drum->wheel, &at->wheel, inertia, 0.0, none); /* of a length */
    return tilting;
}

/* Adds the forces of the inertia of a drum that its rope has left. */
static void add_alone(const fu_drum *drum, const fu_drum_state *at, double y[Y])
{
    double inertia[2];
    y[TURN] += drum->wheel.inertia * at->wheel.turn_acc;
    if (!drum->wheel.tilts) return;
    rings(drum, 0.0, inertia);
    fu_wheel_add_ring(&drum->wheel, &at->wheel, inertia, 0.0, y + CENTRE);
}

void fu_drum_forces(const fu_drum *drum, const fu_drum_state *at, double y[Y])
{
    const laid_rope laid = laying(drum, at);
    double F[STORE];
    memset(y, 0, sizeof(double) * Y);
    if (at->has_left) {
        add_alone(drum, at, y);
        return;
    }
    store_forces(drum, at, F);
    for (int k = 0; k < STORE; ++k) y[of_store[k]] += F[k];
    for (int d = 0; d < DIM; ++d) {
        y[d] += laid.F[d];
        y[CENTRE + d] -= laid.F[d];
    }
    y[TURN] += drum->wheel.inertia * at->wheel.turn_acc;
    if (!is_in_space(drum)) return;
    add_in_space(drum, at, y);
    for (int d = 0; d < FU_TILTS && drum->wheel.tilts; ++d) y[TILT + d] += laid.F[DIM + d];
}

/* Adds the derivatives of the forces that there are in space alone. */
static void add_derivatives_in_space(const fu_drum *drum, const fu_drum_state *at, fu_weights w, double (*D)[Y],
                                     double (*K)[Y])
{
    const laid_rope laid = laying(drum, at);
    const motion_across across = across_of(drum, at);
    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) D[of_across[i]][of_across[j]] += w.stiffness * w.rate * across.D[2 * i * 3 + 2 * j];
        for (int j = 0; j < 2; ++j) K[of_across[i]][of_across[j]] += w.stiffness * across.K[2 * i * 2 + j];
    }
    for (int i = 0; i < LAID; ++i)
        for (int j = 0; j < LAID; ++j) {
            const double value = w.stiffness * laid.K[i * LAID + j];
            const int row = i < DIM ? i : TILT + i - DIM, column = j < DIM ? j : TILT + j - DIM;
            K[row][column] += value;
            if (j < DIM) K[row][CENTRE + j] -= value;
            if (i < DIM) K[CENTRE + i][column] -= value;
            if (i < DIM && j < DIM) K[CENTRE + i][CENTRE + j] += value;
        }
}

void fu_drum_add_derivatives(const fu_drum *drum, const fu_drum_state *at, fu_weights w, double (*D)[Y], double (*K)[Y])
{
    static const int of_place[DIM + 1 + DIM] = {CENTRE, CENTRE + 1, LENGTH, SLOPE, SLOPE + 1};
    double D_store[STORE * STORE], K_store[STORE * (DIM + 1 + DIM)];
    if (at->has_left) return;
    store_derivatives(drum, at, D_store, K_store);
    for (int i = 0; i < STORE; ++i) {
        for (int j = 0; j < STORE; ++j) D[of_store[i]][of_store[j]] += w.stiffness * w.rate * D_store[i * STORE + j];
        for (int j = 0; j < DIM + 1 + DIM; ++j)
            K[of_store[i]][of_place[j]] += w.stiffness * K_store[i * (DIM + 1 + DIM) + j];
    }
    if (is_in_space(drum)) add_derivatives_in_space(drum, at, w, D, K);
}

void fu_drum_mass(const fu_drum *drum, const fu_drum_state *at, double factor, double (*out)[Y])
{
    double M[(DIM + 1) * (DIM + 1)], inertia[2];
    memset(out, 0, sizeof(double) * Y * Y);
    drum->wheel.kernel->store_mass(drum->wheel.rho, drum->wheel.radius, at->u, M);
    for (int i = 0; i <= DIM; ++i)
        for (int j = 0; j <= DIM; ++j) out[of_store[i]][of_store[j]] = factor * M[i * (DIM + 1) + j];
    out[TURN][TURN] += factor * drum->wheel.inertia;
    if (!is_in_space(drum)) return;
    out[ACROSS][ACROSS] = factor * across_of(drum, at).M[0];
    rings(drum, at->u, inertia);
    for (int d = 0; d < FU_TILTS && drum->wheel.tilts; ++d) out[TILT + d][TILT + d] = factor * inertia[0];
}

void fu_drum_energies(const fu_drum *drum, const fu_drum_state *at, double *T, double *V)
{
    const fu_wheel *wheel = &drum->wheel;
    wheel->kernel->store_energy(wheel->rho, wheel->radius, at->wheel.g, at->u, at->wheel.c, at->wheel.turn_rate,
                                at->wheel.c_rate, T, V);
    *V += laying(drum, at).V;
    *T += 0.5 * wheel->inertia * at->wheel.turn_rate * at->wheel.turn_rate;
    if (!is_in_space(drum)) return;
    const motion_across across = across_of(drum, at);
    double none[Y] = {0.0};
    *T += across.T + add_in_space(drum, at, none);
    *V += across.V;
}

/* --- stretch ---------------------------------------------------------------------------------------------------- */

/* Returns the elastic energy of the wound rope: cell by cell, and of what has been wound since with the span's
 * stretch. */
double fu_drum_energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_drum *drum = drum_of(coupling);
    const fu_wheel *wheel = &drum->wheel;
    const fu_drum_history *past = fu_drum_history_of(drum, state);
    double total = 0.0, W, loss;
    fu_drum_state at;
    fu_drum_at(model, drum, state, 0, &at);
    const double known = past->is_known ? fmin(at.u, past->u) : 0.0;
    const int last = fu_drum_cell(drum, known);
    for (int cell = 0; known > 0.0 && cell <= last; ++cell) {
        const double length = cell < last ? drum->cell : known - cell * drum->cell;
        wheel->kernel->creep(wheel->A, wheel->radius, fu_drum_cell_stretch(drum, past, cell), 1.0, &W, &loss);
        total += length * W;
    }
    wheel->kernel->creep(wheel->A, wheel->radius, at.span_stretch, 1.0, &W, &loss);
    return total + (at.u - known) * W;
}

/* Returns the elastic energy of a wound length. */
static double energy_of(const fu_drum *drum, double length, double stretch)
{
    double W, loss;
    drum->wheel.kernel->creep(drum->wheel.A, drum->wheel.radius, stretch, 1.0, &W, &loss);
    return length * W;
}

/* What is wound shares the stretch of the cell in which it is. */
double fu_drum_stored(const fu_drum *drum, const fu_drum_history *past, const fu_drum_state *at)
{
    const int last = fu_drum_cell(drum, past->u);
    const double in_cell = past->u - last * drum->cell;
    double total = 0.0;
    if (at->u > past->u) {
        const double passing = fu_drum_passing(drum, past, at), wound = at->u - past->u;
        const double here = last < drum->n_cells - 1 ? fmin(wound, drum->cell - in_cell) : wound;
        const double drawn = past->drawn - past->profile[last];
        return energy_of(drum, in_cell + here, (drawn + here * passing) / (in_cell + here)) +
               energy_of(drum, wound - here, passing) -
               energy_of(drum, in_cell, fu_drum_cell_stretch(drum, past, last));
    }
    for (int cell = fu_drum_cell(drum, at->u); cell <= last; ++cell) {
        const double from = fmax(at->u, cell * drum->cell), to = cell < last ? (cell + 1) * drum->cell : past->u;
        total -= energy_of(drum, to - from, fu_drum_cell_stretch(drum, past, cell));
    }
    return total;
}

double fu_drum_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                           const fu_accelerator *work)
{
    const fu_drum *drum = drum_of(coupling);
    const fu_wheel *wheel = &drum->wheel;
    double W, loss;
    fu_drum_state at;
    (void)work;
    fu_drum_at(model, drum, state, 0, &at);
    wheel->kernel->creep(wheel->A, wheel->radius, at.wound, at.span_stretch, &W, &loss);
    return wheel->damping * at.wheel.own_rate * at.wheel.own_rate + loss * fabs(at.u_rate);
}

void fu_drum_leave(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    fu_drum_history *past = fu_drum_history_of(drum_of(coupling), state);
    fu_drum_state at;
    fu_drum_at(model, drum_of(coupling), state, 0, &at);
    past->laid = laying(drum_of(coupling), &at).V;
    past->has_left = 1.0;
    memset(state->forces + coupling->force, 0, sizeof(double) * (size_t)coupling->n_forces);
}

/* Updates the profile of the wound rope: what is wound has the mean stretch of its way on the rim. */
void fu_drum_update(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    const fu_drum *drum = drum_of(coupling);
    fu_drum_history *past = fu_drum_history_of(drum, state);
    fu_drum_state at;
    if (past->has_left != 0.0) return;
    fu_drum_at(model, drum, state, 0, &at);
    if (!past->is_known && drum->leaves && at.u <= NO_STORE * drum->wheel.radius) {
        fu_drum_leave(model, coupling, state); /* as of a run whose rope has left */
        return;
    }
    if (!past->is_known) {
        for (int cell = 0; cell <= drum->n_cells; ++cell)
            past->profile[cell] = at.span_stretch * fmin(at.u, cell * drum->cell);
        past->drawn = at.span_stretch * at.u;
        past->is_known = 1.0;
    } else if (at.u > past->u) {
        const double way = fu_drum_way(drum, past, &at);
        for (int cell = fu_drum_cell(drum, past->u) + 1; cell <= fu_drum_cell(drum, at.u); ++cell)
            past->profile[cell] = past->drawn + way * (cell * drum->cell - past->u) / (at.u - past->u);
        past->drawn += way;
    } else past->drawn = fu_drum_drawn_length(drum, past, at.u);
    past->u = at.u;
    past->phi = at.phi;
    past->turn = at.turn;
    past->carrier = at.carrier;
    past->stretch = at.span_stretch;
}
