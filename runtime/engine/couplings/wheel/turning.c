/* Wheels whose groove turns with its body: forces on tangent points that turn along, spinning wheels that tilt
 * (derive/couplings/turning_wheel.py), and steps that conserve energy (turning_step.py). */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/wheel/wheel.h"

enum { SPACE = 3, PLANE = FU_GROOVE };

/* Returns the column of a coordinate of the centre among rows in space. */
static void column_of(const double *rows, int n, int j, double out[SPACE])
{
    for (int d = 0; d < SPACE; ++d) out[d] = rows[d * n + j];
}

/* Adds to column `dof` a change of the force on the centre and of the moment about it; either may be null. */
static void add_to_centre(const fu_model *model, const fu_wheel_state *at, int dof, const double *force,
                          const double *moment, double factor, fu_system *system)
{
    double change[FU_ATTACHMENT_COORDINATES];
    fu_wrench_force(SPACE, &at->centre, force, moment, factor, change);
    for (int i = 0; i < at->centre.n; ++i)
        if (change[i] != 0.0) fu_add(model, system, at->centre.at[i], dof, change[i]);
}

/* Adds the changes with a coordinate of the centre, which moves it by `move` and turns it by `turn`. */
static void add_move(const fu_model *model, const fu_wheel_state *at, int dof, const double move[SPACE],
                     const double turn[SPACE], int n, const fu_turning_force *on_nodes, const double *forces,
                     double factor, fu_system *system)
{
    const double about = fu_dot(SPACE, at->axis, turn);
    double tilt[SPACE], on_centre[SPACE] = {0.0}, moment[SPACE], of_tilt[SPACE], axle[SPACE];
    for (int d = 0; d < SPACE; ++d) tilt[d] = turn[d] - about * at->axis[d];
    fu_out_of_groove(at, forces + FU_WHEEL_TILT, of_tilt);
    fu_cross(tilt, of_tilt, moment);
    fu_cross(turn, at->axis, axle);
    for (int d = 0; d < SPACE; ++d) moment[d] += forces[FU_WHEEL_TURN] * axle[d];
    for (int k = 0; k < n; ++k) {
        double change[SPACE], rise[SPACE], across[SPACE];
        fu_cross(tilt, on_nodes[k].force, change);
        fu_cross(on_nodes[k].arm, turn, rise);
        fu_cross(on_nodes[k].force, at->axis, across);
        const double out_of_plane = fu_dot(SPACE, at->axis, rise) - fu_dot(SPACE, at->axis, move);
        for (int d = 0; d < SPACE; ++d) {
            if (change[d] != 0.0) fu_add(model, system, on_nodes[k].node + d, dof, factor * change[d]);
            on_centre[d] -= change[d];
            moment[d] += out_of_plane * across[d];
        }
    }
    add_to_centre(model, at, dof, on_centre, moment, factor, system);
}

void fu_wheel_add_turning(const fu_model *model, const fu_wheel_state *at, const fu_centre_moves *moves, int n,
                          const fu_turning_force *on_nodes, const double *forces, double factor, fu_system *system)
{
    for (int j = 0; j < at->centre.n; ++j) {
        double move[SPACE], turn[SPACE];
        column_of(moves->P, at->centre.n, j, move);
        column_of(moves->T, at->centre.n, j, turn);
        add_move(model, at, at->centre.at[j], move, turn, n, on_nodes, forces, factor, system);
    }
    for (int k = 0; k < n; ++k) {
        double across[SPACE];
        fu_cross(on_nodes[k].force, at->axis, across);
        for (int d = 0; d < SPACE; ++d)
            add_to_centre(model, at, on_nodes[k].node + d, 0, across, factor * at->axis[d], system);
    }
}

double fu_wheel_add_ring(const fu_wheel *wheel, const fu_wheel_state *at, const double inertia[2], double growth,
                         double *forces)
{
    double energy, moment[FU_TILTS];
    wheel->foot->ring(inertia, growth, at->omega, at->omega_acc, at->turn_rate, &energy, moment);
    for (int j = 0; j < FU_TILTS; ++j) forces[FU_WHEEL_TILT + j] += moment[j];
    return energy;
}

/* --- over a step that conserves energy -------------------------------------------------------------------------- */

void fu_groove_over_step(const fu_model *model, const fu_wheel *wheel, const fu_equations *at,
                         const fu_wheel_state *now, const fu_wheel_state *next, fu_wheel_state *middle,
                         fu_groove_step *out)
{
    const fu_attachment *on = &wheel->attachments[0];
    fu_discrete_point(model, on, at->now, at->next, middle->centre.P);
    fu_discrete_turn(model, on, at->now, at->next, at->psi, &now->centre, &next->centre, &middle->centre, out->theta);
    if (!wheel->foot) return;
    for (int i = 0; i < SPACE * PLANE; ++i) out->axes[i] = 0.5 * (now->groove[i] + next->groove[i]);
    for (int d = 0; d < SPACE; ++d) {
        out->axis[d] = 0.5 * (now->axis[d] + next->axis[d]);
        out->c_change[d] = next->centre.p[d] - now->centre.p[d];
        out->gravity[d] = wheel->tilts
                              ? wheel->g[d]
                              : fu_dot(PLANE, now->groove + d * PLANE, wheel->g) + now->axis[d] * wheel->g[PLANE];
    }
    for (int i = 0; i < PLANE; ++i) out->g[i] = 0.5 * (now->g[i] + next->g[i]);
}

double fu_wheel_turn(const fu_wheel *wheel, const fu_groove_step *groove, const fu_equations *at)
{
    const double own = wheel->turn < 0 ? 0.0 : at->psi[wheel->turn];
    return own + (wheel->foot ? fu_dot(SPACE, groove->axis, groove->theta) : groove->theta[0]);
}

void fu_mean_from_centre(int node, const fu_equations *at, const fu_wheel_state *now, const fu_wheel_state *next,
                         double out[SPACE])
{
    for (int d = 0; d < SPACE; ++d)
        out[d] = 0.5 * (at->now->q[node + d] - now->centre.p[d] + at->next->q[node + d] - next->centre.p[d]);
}

double fu_wheel_add_spin(const fu_wheel *wheel, double from, double to, const fu_groove_step *groove, double h,
                         double moment[SPACE])
{
    const double gained = wheel->inertia * (to - from) / h, held = 0.5 * wheel->inertia * (from + to) / h;
    double tilt[SPACE];
    if (!wheel->foot) {
        moment[0] += gained;
        return gained;
    }
    fu_cross(groove->theta, groove->axis, tilt);
    for (int d = 0; d < SPACE; ++d) moment[d] += gained * groove->axis[d] + held * tilt[d];
    return gained;
}
