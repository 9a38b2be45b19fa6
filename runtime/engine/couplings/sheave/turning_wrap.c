/* The wrap in a groove that turns with its body (derive/couplings/turning_wheel.py), by z. The derivatives of its
 * inertial forces by rates and places are those of a groove that does not tilt. */
#include "couplings/sheave/sheave.h"

#include <string.h>

/* Variables of a zone: angles of its ends, centre in space, rotations of the groove, s of its ends. */
enum { U_TILT = ENDS + SPACE, U_MATERIAL = U_TILT + FU_TILTS, U = U_MATERIAL + ENDS };

/* The change of a number of a zone by z: n entries. */
typedef struct {
    int n, at[ENDS];
    double value[ENDS];
} entry;

static entry entry_of(const fu_zone *of, int k)
{
    static const int of_wheel[U_MATERIAL - ENDS] = {Z_CENTRE, Z_CENTRE + 1, Z_ACROSS, Z_TILT, Z_TILT + 1};
    if (k < ENDS) return (entry){2, {0, 1}, {1.0 - of->share[k], of->share[k]}};
    if (k < U_MATERIAL) return (entry){1, {of_wheel[k - ENDS]}, {1.0}};
    return (entry){1, {Z_MATERIAL + of->first + k - U_MATERIAL}, {1.0}};
}

static void velocity_of(const fu_sheave_state *at, double out[SPACE])
{
    memcpy(out, at->wheel.c_rate, sizeof at->wheel.c_rate);
    out[DIM] = at->wheel.across_rate;
}

void fu_turning_wrap_add_inertia(const fu_sheave *sheave, const fu_sheave_state *at, double *z)
{
    const fu_wheel *wheel = &sheave->wheel;
    const double inertia[2] = {0.0, wheel->inertia},
                 acc[SPACE] = {at->wheel.c_acc[0], at->wheel.c_acc[1], at->wheel.across_acc};
    double velocity[SPACE];
    velocity_of(at, velocity);
    fu_wheel_add_ring(wheel, &at->wheel, inertia, 0.0, z + Z_CENTRE);
    for (int j = 0; j < sheave->n_zones; ++j) {
        const fu_zone of = fu_zone_at(at, j);
        double u[U];
        wheel->foot->wrap_inertia(wheel->rho, at->wheel.omega, at->wheel.omega_acc, wheel->radius, of.phi, of.l,
                                  of.phi_rate, velocity, of.s_rate, of.phi_acc, acc, of.s_acc, u);
        for (int k = 0; k < U; ++k) {
            const entry to = entry_of(&of, k);
            for (int i = 0; i < to.n; ++i) z[to.at[i]] += to.value[i] * u[k];
        }
    }
}

void fu_turning_wrap_add_mass(const fu_sheave *sheave, const fu_sheave_state *at, double factor, double (*M)[Z])
{
    const fu_wheel *wheel = &sheave->wheel;
    for (int j = 0; j < sheave->n_zones; ++j) {
        const fu_zone of = fu_zone_at(at, j);
        double M_u[U * U];
        wheel->foot->wrap_mass(wheel->rho, wheel->radius, of.phi, of.l, M_u);
        for (int k = 0; k < U; ++k) {
            const entry row = entry_of(&of, k);
            for (int l = 0; l < U; ++l) {
                const entry column = entry_of(&of, l);
                for (int a = 0; a < row.n; ++a)
                    for (int b = 0; b < column.n; ++b)
                        M[row.at[a]][column.at[b]] += factor * row.value[a] * column.value[b] * M_u[k * U + l];
            }
        }
    }
}

double fu_turning_wrap_energy(const fu_sheave *sheave, const fu_sheave_state *at)
{
    const fu_wheel *wheel = &sheave->wheel;
    double velocity[SPACE], total = 0.0, T;
    velocity_of(at, velocity);
    for (int j = 0; j < sheave->n_zones; ++j) {
        const fu_zone of = fu_zone_at(at, j);
        wheel->foot->wrap_energy(wheel->rho, at->wheel.omega, wheel->radius, of.phi, of.l, of.phi_rate, velocity,
                                 of.s_rate, &T);
        total += T;
    }
    return total;
}

/* The moments of the weight of a zone about both vectors of the groove, and their derivatives by the angles and the
 * length, and by rotations. */
typedef struct {
    double moment[FU_TILTS], M_q[FU_TILTS * (ENDS + 1)], M_turn[FU_TILTS * FU_TILTS];
} tilting_weight;

static tilting_weight weight_of(const fu_sheave *sheave, const fu_sheave_state *at, const fu_zone *of)
{
    const fu_wheel *wheel = &sheave->wheel;
    tilting_weight out;
    wheel->foot->wrap_weight(wheel->rho, at->wheel.g, wheel->radius, of->phi, of->l, out.moment, out.M_q, out.M_turn);
    return out;
}

void fu_turning_wrap_add_weight(const fu_sheave *sheave, const fu_sheave_state *at, double *z)
{
    for (int j = 0; j < sheave->n_zones; ++j) {
        const fu_zone of = fu_zone_at(at, j);
        const tilting_weight weight = weight_of(sheave, at, &of);
        for (int i = 0; i < FU_TILTS; ++i) z[Z_TILT + i] += weight.moment[i];
    }
}

void fu_turning_wrap_add_weight_matrix(const fu_sheave *sheave, const fu_sheave_state *at, double factor,
                                       double (*K)[Z])
{
    for (int j = 0; j < sheave->n_zones; ++j) {
        const fu_zone of = fu_zone_at(at, j);
        const tilting_weight weight = weight_of(sheave, at, &of);
        const int s = Z_MATERIAL + of.first;
        const entry column[ENDS + 1] = {entry_of(&of, 0), entry_of(&of, 1), {2, {s, s + 1}, {-1.0, 1.0}}};
        for (int i = 0; i < FU_TILTS; ++i) {
            for (int k = 0; k < ENDS + 1; ++k)
                for (int a = 0; a < column[k].n; ++a) {
                    const double value = factor * column[k].value[a] * weight.M_q[i * (ENDS + 1) + k];
                    K[Z_TILT + i][column[k].at[a]] += value;
                    K[column[k].at[a]][Z_TILT + i] += value;
                }
            for (int k = 0; k < FU_TILTS; ++k) K[Z_TILT + i][Z_TILT + k] += factor * weight.M_turn[i * FU_TILTS + k];
        }
    }
}

void fu_turning_wrap_add_turning(const fu_model *model, const fu_sheave *sheave, const fu_sheave_state *at,
                                 const fu_centre_moves *moves, const double y[Y], double factor, fu_system *system)
{
    fu_turning_force on_nodes[ENDS];
    for (int k = 0; k < ENDS; ++k) {
        on_nodes[k].node = sheave->nodes[k];
        for (int d = 0; d < SPACE; ++d) on_nodes[k].arm[d] = at->q[sheave->nodes[k] + d] - at->wheel.centre.p[d];
        fu_out_of_groove(&at->wheel, y + k * NODE, on_nodes[k].force);
    }
    fu_wheel_add_turning(model, &at->wheel, moves, ENDS, on_nodes, y + CENTRE, factor, system);
}
