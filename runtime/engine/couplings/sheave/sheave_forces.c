/* Forces of a sheave and its wrap, and their derivatives, by the places of the nodes (y). */
#include "bodies/unknowns.h"
#include "couplings/sheave/sheave.h"

#include <string.h>

/* Returns the place among y of a number of z that is not an angle. */
static int among_y(int k)
{
    return k < Z_CENTRE     ? (k - Z_SLOPE) / DIM * NODE + SLOPE + (k - Z_SLOPE) % DIM
           : k < Z_MATERIAL ? CENTRE + k - Z_CENTRE
                            : MATERIAL + k - Z_MATERIAL;
}

void fu_sheave_add_by_angles(const fu_sheave *sheave, const fu_sheave_state *at, const double *of_z, double *y)
{
    for (int k = 0; k < ENDS; ++k)
        for (int d = 0; d < DIM; ++d) {
            const double force = of_z[k] * at->phi_x[k][d];
            y[k * NODE + d] += force;
            y[CENTRE + d] -= force;
        }
    for (int k = 0; k < ENDS && is_turning(sheave); ++k) { /* zero on the condition that the node is in the groove */
        y[TILT] += of_z[k] * at->rise[k] * at->phi_x[k][1];
        y[TILT + 1] -= of_z[k] * at->rise[k] * at->phi_x[k][0];
    }
    for (int k = Z_SLOPE; k < size_of_z(sheave); ++k) y[among_y(k)] += of_z[k];
}

/* Inertia and weight of the wrap along the axis, in space, with this gravity along it. */
typedef struct {
    double T, V, f[SPACE], M[SPACE], D[SPACE * SPACE], K[SPACE * DIM];
} motion_across;

enum { OF_ACROSS = 3 };

/* Computes the places among y of w, s_a and s_b of the kernel. */
static void places_across(const fu_sheave *sheave, int at[OF_ACROSS])
{
    at[0] = ACROSS;
    at[1] = MATERIAL;
    at[2] = MATERIAL + sheave->n_zones;
}

static motion_across across_of(const fu_sheave *sheave, const fu_sheave_state *at, double gravity)
{
    const int n = sheave->n_zones;
    const double s_rate[ENDS] = {at->s_rate[0], at->s_rate[n]};
    const int moves = !is_turning(sheave); /* else it is in the kernels of turning wraps */
    motion_across out;
    sheave->wheel.foot->across(sheave->wheel.rho, wrap_length(sheave, at), at->wheel.across + at->aside, gravity,
                               moves * at->wheel.across_rate, moves * at->wheel.across_acc, s_rate, &out.T, &out.V,
                               out.f, out.M, out.D, out.K);
    return out;
}

/* Adds its forces by y. */
static void add_across(const fu_sheave *sheave, const fu_sheave_state *at, double gravity, double *y)
{
    const motion_across motion = across_of(sheave, at, gravity);
    int place[OF_ACROSS];
    places_across(sheave, place);
    for (int i = 0; i < OF_ACROSS; ++i) y[place[i]] += motion.f[i];
}

/* Adds its derivatives by y: D by rates, K by places. */
static void add_across_matrices(const fu_sheave *sheave, const fu_sheave_state *at, double factor, double (*D)[Y],
                                double (*K)[Y])
{
    const motion_across motion = across_of(sheave, at, at->wheel.g[DIM]);
    int place[OF_ACROSS];
    places_across(sheave, place);
    for (int i = 0; i < OF_ACROSS; ++i) {
        for (int j = 0; j < OF_ACROSS; ++j) D[place[i]][place[j]] += factor * motion.D[i * OF_ACROSS + j];
        K[place[i]][ACROSS] += factor * motion.K[i * DIM];
        for (int e = 0; e < ENDS; ++e) K[place[i]][place[1 + e]] += (e ? factor : -factor) * motion.K[i * DIM + 1];
    }
}

void fu_sheave_scatter(const fu_sheave *sheave, const fu_sheave_state *at, const double *y, double *f)
{
    for (int k = 0; k < ENDS && !is_in_space(sheave); ++k)
        for (int i = 0; i < NODE; ++i) f[sheave->nodes[k] + i] += y[k * NODE + i];
    for (int k = 0; k < ENDS && is_in_space(sheave); ++k)
        for (int d = 0; d < SPACE; ++d)
            f[sheave->nodes[k] + d] += fu_dot(DIM, at->wheel.groove + d * DIM, y + k * NODE);
    for (int k = 0; k < ENDS && is_in_space(sheave) && at->mode == FU_SHORT; ++k)
        for (int d = 0; d < SPACE; ++d) f[sheave->nodes[k] + SPACE + d] += y[k * NODE + SLOPE] * at->stretch[k][d];
    for (int j = 0; j <= sheave->n_zones; ++j) f[sheave->s[j]] += y[MATERIAL + j];
    fu_wheel_add_forces(&sheave->wheel, &at->wheel, y + CENTRE, f);
}

/* The changes of z by the places of the nodes and the centre, which alone are not those of y: rows of the angles. */
static void of_angles(const double (*by_x)[DIM], double (*J)[Y])
{
    memset(J, 0, sizeof(double) * ENDS * Y);
    for (int k = 0; k < ENDS; ++k)
        for (int d = 0; d < DIM; ++d) {
            J[k][k * NODE + d] = by_x[k][d];
            J[k][CENTRE + d] = -by_x[k][d];
        }
}

/* Adds J' A to B (Y x n_columns), where rows of z beside the angles are rows of y. */
static void add_from_left(const fu_sheave *sheave, double (*J)[Y], double (*A)[Y], double (*B)[Y])
{
    for (int k = 0; k < size_of_z(sheave); ++k)
        for (int i = 0; i < (k < ENDS ? TURN : 1); ++i) {
            const int row = k < ENDS ? i : among_y(k);
            const double factor = k < ENDS ? J[k][i] : 1.0;
            for (int j = 0; factor != 0.0 && j < MATERIAL + sheave->n_zones + 1; ++j) B[row][j] += factor * A[k][j];
        }
}

/* Adds J' A B to K, of A (Z x Z), J and B the changes of the angles by y; all: B has the other changes of z, too. */
static void add_product(const fu_sheave *sheave, double (*J)[Y], double (*A)[Z], double (*B)[Y], int all,
                        double (*K)[Y])
{
    double AB[Z][Y];
    memset(AB, 0, sizeof AB);
    for (int i = 0; i < size_of_z(sheave); ++i) {
        for (int k = 0; k < ENDS; ++k)
            for (int j = 0; A[i][k] != 0.0 && j < TURN; ++j) AB[i][j] += A[i][k] * B[k][j];
        for (int k = Z_SLOPE; all && k < size_of_z(sheave); ++k) AB[i][among_y(k)] += A[i][k];
    }
    add_from_left(sheave, J, AB, K);
}

/* Adds to K the change of forces by the angles where these turn: the second derivatives of the angles by x. */
static void add_turning(const fu_sheave_state *at, double factor, const double *of_z, double (*K)[Y])
{
    for (int k = 0; k < ENDS; ++k)
        for (int i = 0; i < DIM; ++i)
            for (int j = 0; j < DIM; ++j) {
                const double value = factor * of_z[k] * at->phi_xx[k][i * DIM + j];
                K[k * NODE + i][k * NODE + j] += value;
                K[k * NODE + i][CENTRE + j] -= value;
                K[CENTRE + i][k * NODE + j] -= value;
                K[CENTRE + i][CENTRE + j] += value;
            }
}

void fu_sheave_add_turn_of_slopes(const fu_model *model, const fu_sheave *sheave, const fu_sheave_state *at,
                                  const double y[Y], double factor, fu_system *system)
{
    for (int k = 0; k < ENDS; ++k)
        for (int i = 0; i < SPACE; ++i)
            for (int j = 0; j < SPACE; ++j) {
                const double across = (i == j) - at->stretch[k][i] * at->stretch[k][j];
                const int slope = sheave->nodes[k] + SPACE;
                fu_add(model, system, slope + i, slope + j, factor * y[k * NODE + SLOPE] * across / at->slope[k][0]);
            }
}

int fu_sheave_columns(const fu_sheave *sheave, const fu_sheave_state *at, const fu_centre_moves *moves,
                      fu_wheel_column *out)
{
    const double *groove = at->wheel.groove;
    int n = 0;
    for (int k = 0; k < ENDS && !is_in_space(sheave); ++k)
        for (int i = 0; i < NODE; ++i) out[n++] = (fu_wheel_column){sheave->nodes[k] + i, k * NODE + i, 1, {1.0}};
    for (int k = 0; k < ENDS && is_in_space(sheave); ++k)
        for (int i = 0; i < 2 * SPACE; ++i) {
            const int dof = sheave->nodes[k] + i;
            if (i >= SPACE) out[n++] = (fu_wheel_column){dof, k * NODE + SLOPE, 1, {at->stretch[k][i - SPACE]}};
            else out[n++] = (fu_wheel_column){dof, k * NODE, DIM, {groove[i * DIM], groove[i * DIM + 1]}};
        }
    for (int j = 0; j <= sheave->n_zones; ++j) out[n++] = (fu_wheel_column){sheave->s[j], MATERIAL + j, 1, {1.0}};
    return n + fu_wheel_columns(&sheave->wheel, &at->wheel, moves, CENTRE, out + n);
}

void fu_sheave_forces(const fu_sheave *sheave, const fu_sheave_state *at, double y[Y])
{
    double z[Z] = {0.0};
    memset(y, 0, sizeof(double) * Y);
    fu_wrap_add_inertia(sheave, at, z);
    fu_wrap_add_forces(sheave, at, z);
    fu_sheave_add_by_angles(sheave, at, z, y);
    if (is_in_space(sheave)) add_across(sheave, at, at->wheel.g[DIM], y);
}

void fu_sheave_inertial_forces(const fu_sheave *sheave, const fu_sheave_state *at, double y[Y])
{
    double z[Z] = {0.0};
    memset(y, 0, sizeof(double) * Y);
    fu_wrap_add_inertia(sheave, at, z);
    fu_sheave_add_by_angles(sheave, at, z, y);
    if (is_in_space(sheave) && !is_turning(sheave)) add_across(sheave, at, 0.0, y);
}

void fu_sheave_add_mass(const fu_sheave *sheave, const fu_sheave_state *at, double factor, double (*K)[Y])
{
    double M[Z][Z], J[ENDS][Y];
    memset(M, 0, sizeof M);
    fu_wrap_add_mass(sheave, at, factor, M);
    of_angles(at->phi_x, J);
    add_product(sheave, J, M, J, 1, K);
    if (is_in_space(sheave) && !is_turning(sheave)) K[ACROSS][ACROSS] += factor * across_of(sheave, at, 0.0).M[0];
}

void fu_sheave_add_derivatives(const fu_sheave *sheave, const fu_sheave_state *at, fu_weights w, double (*D)[Y],
                               double (*K)[Y])
{
    double M_z[Z][Z], D_z[Z][Z], K_z[Z][Z], J[ENDS][Y], by[ENDS][Y], z[Z] = {0.0};
    memset(M_z, 0, sizeof M_z);
    memset(D_z, 0, sizeof D_z);
    memset(K_z, 0, sizeof K_z);
    if (w.inertia != 0.0 || w.rate != 0.0) {
        fu_wrap_add_mass(sheave, at, w.stiffness, M_z);
        fu_wrap_add_inertia_matrices(sheave, at, w.stiffness, D_z, K_z);
    }
    fu_wrap_add_matrices(sheave, at, w.stiffness, D_z, K_z);
    of_angles(at->phi_x, J);
    add_product(sheave, J, K_z, J, 1, K);
    of_angles(at->rate_x, by);
    add_product(sheave, J, D_z, by, 0, K);
    of_angles(at->acc_x, by);
    add_product(sheave, J, M_z, by, 0, K);
    add_product(sheave, J, D_z, J, 1, D);
    of_angles(at->acc_v, by);
    add_product(sheave, J, M_z, by, 0, D);
    fu_wrap_add_inertia(sheave, at, z);
    fu_wrap_add_forces(sheave, at, z);
    add_turning(at, w.stiffness, z, K);
    if (is_in_space(sheave)) add_across_matrices(sheave, at, w.stiffness, D, K);
}

void fu_sheave_add_matrices(const fu_sheave *sheave, const fu_sheave_state *at, double factor, const double *of_z,
                            double (*D_z)[Z], double (*K_z)[Z], double (*D)[Y], double (*K)[Y])
{
    double J[ENDS][Y], by[ENDS][Y];
    of_angles(at->phi_x, J);
    of_angles(at->rate_x, by);
    add_product(sheave, J, K_z, J, 1, K);
    add_product(sheave, J, D_z, by, 0, K);
    add_product(sheave, J, D_z, J, 1, D);
    add_turning(at, factor, of_z, K);
}

void fu_sheave_energies_across(const fu_sheave *sheave, const fu_sheave_state *at, double *T, double *V)
{
    const motion_across motion = across_of(sheave, at, at->wheel.g[DIM]);
    *T = motion.T;
    *V = motion.V;
}
