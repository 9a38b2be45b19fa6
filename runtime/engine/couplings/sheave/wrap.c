/* The wrap of a rope on a sheave: sums over zones of equal angles, by the angles of both tangent points (z). */
#include "couplings/sheave/sheave.h"

#include <string.h>

/* Variables of a zone: angles of its ends, centre, s of its ends. */
enum { U_CENTRE = ENDS, U_MATERIAL = U_CENTRE + DIM, U = U_MATERIAL + ENDS };

/* The change of a number of a zone by z: n entries. */
typedef struct {
    int n, at[ENDS];
    double value[ENDS];
} entry;

static entry entry_of(const fu_zone *of, int k)
{
    if (k < ENDS) return (entry){2, {0, 1}, {1.0 - of->share[k], of->share[k]}};
    if (k < U_MATERIAL) return (entry){1, {Z_CENTRE + k - U_CENTRE}, {1.0}};
    return (entry){1, {Z_MATERIAL + of->first + k - U_MATERIAL}, {1.0}};
}

/* Adds n numbers of a zone, the k-th of which is number which[k], to those of z. */
static void add_zone(const fu_zone *of, int n, const int *which, const double *u, double *z)
{
    for (int k = 0; k < n; ++k) {
        const entry to = entry_of(of, which[k]);
        for (int i = 0; i < to.n; ++i) z[to.at[i]] += to.value[i] * u[k];
    }
}

/* Number of the length of a zone among its variables. */
enum { LENGTH = U };

/* Computes the changes of n numbers of a zone. */
static void entries_of(const fu_zone *of, int n, const int *which, entry *out)
{
    const int s = Z_MATERIAL + of->first;
    for (int k = 0; k < n; ++k)
        out[k] = which[k] == LENGTH ? (entry){2, {s, s + 1}, {-1.0, 1.0}} : entry_of(of, which[k]);
}

/* Adds a matrix of a zone (rows x columns) times a factor to one of z. */
static void add_zone_matrix(const fu_zone *of, int n_rows, const int *rows, int n_columns, const int *which,
                            double factor, const double *from, double (*A)[Z])
{
    entry row[U], column[U];
    entries_of(of, n_rows, rows, row);
    entries_of(of, n_columns, which, column);
    for (int i = 0; i < n_rows; ++i)
        for (int a = 0; a < row[i].n; ++a) {
            const double part = factor * row[i].value[a];
            double *to = A[row[i].at[a]];
            for (int j = 0; j < n_columns; ++j)
                for (int b = 0; b < column[j].n; ++b)
                    to[column[j].at[b]] += part * column[j].value[b] * from[i * n_columns + j];
        }
}

static const int every[U] = {0, 1, 2, 3, 4, 5}, with_length[5] = {0, 1, 2, 3, LENGTH}, of_zone[3] = {0, 1, LENGTH},
                 damped[4] = {0, 1, U_MATERIAL, U_MATERIAL + 1};

void fu_wrap_add_inertia(const fu_sheave *sheave, const fu_sheave_state *at, double *z)
{
    const fu_wheel *wheel = &sheave->wheel;
    z[Z_TURN] += wheel->inertia * at->wheel.turn_acc;
    if (is_turning(sheave)) {
        fu_turning_wrap_add_inertia(sheave, at, z);
        return;
    }
    for (int j = 0; j < sheave->n_zones; ++j) {
        const fu_zone of = fu_zone_at(at, j);
        double u[U];
        wheel->kernel->inertia(wheel->rho, wheel->radius, of.phi, of.l, of.phi_rate, at->wheel.c_rate, of.s_rate,
                               of.phi_acc, at->wheel.c_acc, of.s_acc, u);
        add_zone(&of, U, every, u, z);
    }
}

/* Returns the stiffness of zones: none in a short wrap, which has an energy of its own. */
static const double *stiffness_in(const fu_sheave *sheave, const fu_sheave_state *at)
{
    static const double none[2] = {0.0};
    return at->mode == FU_SHORT ? none : sheave->wheel.A;
}

void fu_wrap_add_forces(const fu_sheave *sheave, const fu_sheave_state *at, double *z)
{
    const fu_wheel *wheel = &sheave->wheel;
    const double *A = stiffness_in(sheave, at);
    if (at->mode == FU_SHORT) fu_short_wrap_add_forces(sheave, at, z);
    for (int j = 0; at->mode != FU_LIFTED && j < sheave->n_zones; ++j) {
        const fu_zone of = fu_zone_at(at, j);
        double f[U_MATERIAL + 1], u[U], damping[4];
        wheel->kernel->force(A, wheel->sense, wheel->rho, at->wheel.g, wheel->radius, of.phi, at->wheel.c, of.l, f);
        memcpy(u, f, sizeof(double) * U_MATERIAL);
        u[U_MATERIAL] = -f[U_MATERIAL];
        u[U_MATERIAL + 1] = f[U_MATERIAL];
        add_zone(&of, U, every, u, z);
        if (sheave->tau == 0.0 || at->mode == FU_SHORT) continue;
        wheel->kernel->damping_force(wheel->A, sheave->tau, wheel->radius, of.phi, of.l, of.phi_rate, of.s_rate,
                                     damping);
        add_zone(&of, 4, damped, damping, z);
    }
    if (is_turning(sheave)) fu_turning_wrap_add_weight(sheave, at, z);
    for (int j = 0; j < friction_points(sheave, at); ++j) fu_friction_add_forces(sheave, at, j, z);
}

void fu_wrap_add_mass(const fu_sheave *sheave, const fu_sheave_state *at, double factor, double (*M)[Z])
{
    const fu_wheel *wheel = &sheave->wheel;
    M[Z_TURN][Z_TURN] += factor * wheel->inertia;
    if (is_turning(sheave)) {
        fu_turning_wrap_add_mass(sheave, at, factor, M);
        return;
    }
    for (int j = 0; j < sheave->n_zones; ++j) {
        const fu_zone of = fu_zone_at(at, j);
        double M_u[U * U];
        wheel->kernel->mass_matrix(wheel->rho, wheel->radius, of.phi, of.l, M_u);
        add_zone_matrix(&of, U, every, U, every, factor, M_u, M);
    }
}

void fu_wrap_add_inertia_matrices(const fu_sheave *sheave, const fu_sheave_state *at, double factor, double (*D)[Z],
                                  double (*K)[Z])
{
    const fu_wheel *wheel = &sheave->wheel;
    for (int j = 0; j < sheave->n_zones; ++j) {
        const fu_zone of = fu_zone_at(at, j);
        double D_u[U * U], K_u[U * 3];
        wheel->kernel->inertia_tangent(wheel->rho, wheel->radius, of.phi, of.l, of.phi_rate, at->wheel.c_rate,
                                       of.s_rate, of.phi_acc, at->wheel.c_acc, of.s_acc, D_u, K_u);
        add_zone_matrix(&of, U, every, U, every, factor, D_u, D);
        add_zone_matrix(&of, U, every, 3, of_zone, factor, K_u, K);
    }
}

void fu_wrap_add_matrices(const fu_sheave *sheave, const fu_sheave_state *at, double factor, double (*D)[Z],
                          double (*K)[Z])
{
    const fu_wheel *wheel = &sheave->wheel;
    const double *A = stiffness_in(sheave, at);
    if (at->mode == FU_SHORT) fu_short_wrap_add_matrix(sheave, at, factor, K);
    for (int j = 0; at->mode != FU_LIFTED && j < sheave->n_zones; ++j) {
        const fu_zone of = fu_zone_at(at, j);
        double K_u[5 * 5], D_4[4 * 4], K_4[4 * 3];
        wheel->kernel->tangent(A, wheel->sense, wheel->rho, at->wheel.g, wheel->radius, of.phi, at->wheel.c, of.l, K_u);
        add_zone_matrix(&of, 5, with_length, 5, with_length, factor, K_u, K);
        if (sheave->tau == 0.0 || at->mode == FU_SHORT) continue;
        wheel->kernel->damping_tangent(wheel->A, sheave->tau, wheel->radius, of.phi, of.l, of.phi_rate, of.s_rate, D_4,
                                       K_4);
        add_zone_matrix(&of, 4, damped, 3, of_zone, factor, K_4, K);
        add_zone_matrix(&of, 4, damped, 4, damped, factor, D_4, D);
    }
    if (is_turning(sheave)) fu_turning_wrap_add_weight_matrix(sheave, at, factor, K);
    for (int j = 0; j < friction_points(sheave, at); ++j) fu_friction_add_matrices(sheave, at, j, factor, D, K);
}
