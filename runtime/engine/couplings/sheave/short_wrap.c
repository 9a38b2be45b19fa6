/* Wraps near zero, on sheaves that a rope may leave: a short wrap (derive/couplings/short_wrap.py), and a rope that has
 * left its sheave, whose two spans are joined at the point next to the centre. The zones are equal in both. */
#include "couplings/sheave/sheave.h"

#include <math.h>
#include <string.h>

#define LEAST_LENGTH 1e-7 /* of the radius: length below which inertia and weight of a short wrap are those at it */

/* Variables of a short wrap: angles of both tangent points, slopes of both spans, length. */
enum { OF_SHORT = ENDS + ENDS * DIM + 1, OF_LENGTH = OF_SHORT - 1 };

typedef struct {
    double h, U, J[OF_SHORT], F[OF_SHORT], K[OF_SHORT * OF_SHORT];
} short_wrap;

int fu_wrap_mode(const fu_sheave *sheave, const fu_sheave_state *at, const fu_state *state)
{
    if (!fu_may_leave(sheave)) return is_in_space(sheave) ? FU_CHORDED : FU_WRAPPED;
    if (state->flags && *fu_wrap_flag(sheave, state)) return *fu_wrap_flag(sheave, state);
    const double wrap = sheave->wheel.sense * (at->phi[1] - at->phi[0]);
    if (fabs(wrap_length(sheave, at)) <= sheave->no_length) return FU_LIFTED;
    if (wrap < sheave->least_wrap) return FU_SHORT;
    return is_in_space(sheave) && wrap >= FU_LEAST_CHORDED ? FU_CHORDED : FU_WRAPPED;
}

double fu_least_length(const fu_sheave *sheave)
{
    return LEAST_LENGTH * sheave->wheel.radius;
}

static short_wrap short_wrap_at(const fu_sheave *sheave, const fu_sheave_state *at)
{
    const fu_wheel *wheel = &sheave->wheel;
    short_wrap out;
    wheel->kernel->short_wrap(wheel->A, wheel->sense, wheel->radius, at->phi, at->slope[0], at->slope[1],
                              wrap_length(sheave, at), at->tension, &out.h, &out.U, out.J, out.F, out.K);
    return out;
}

double fu_short_wrap_energy(const fu_sheave *sheave, const fu_sheave_state *at)
{
    return short_wrap_at(sheave, at).U;
}

/* Adds a value by the length of the wrap to those by the material coordinates. */
static void add_by_length(const fu_sheave *sheave, double value, double *of_material)
{
    of_material[0] -= value;
    of_material[sheave->n_zones] += value;
}

void fu_short_wrap_add_forces(const fu_sheave *sheave, const fu_sheave_state *at, double *z)
{
    const short_wrap of = short_wrap_at(sheave, at);
    for (int i = 0; i < OF_LENGTH; ++i) z[i] += of.F[i] + of.J[i] * at->tension;
    add_by_length(sheave, of.F[OF_LENGTH] + of.J[OF_LENGTH] * at->tension, z + Z_MATERIAL);
}

void fu_short_wrap_add_matrix(const fu_sheave *sheave, const fu_sheave_state *at, double factor, double (*K)[Z])
{
    const short_wrap of = short_wrap_at(sheave, at);
    for (int i = 0; i < OF_SHORT; ++i) {
        double row[Z] = {0.0};
        for (int j = 0; j < OF_LENGTH; ++j) row[j] = factor * of.K[i * OF_SHORT + j];
        add_by_length(sheave, factor * of.K[i * OF_SHORT + OF_LENGTH], row + Z_MATERIAL);
        for (int j = 0; j < size_of_z(sheave); ++j) {
            if (i < OF_LENGTH) K[i][j] += row[j];
            else {
                K[Z_MATERIAL][j] -= row[j];
                K[Z_MATERIAL + sheave->n_zones][j] += row[j];
            }
        }
    }
}

double fu_short_wrap_row(const fu_sheave *sheave, const fu_sheave_state *at, double J[Y])
{
    const short_wrap of = short_wrap_at(sheave, at);
    memset(J, 0, sizeof(double) * Y);
    for (int k = 0; k < ENDS; ++k)
        for (int d = 0; d < DIM; ++d) {
            J[k * NODE + d] = of.J[k] * at->phi_x[k][d];
            J[k * NODE + SLOPE + d] = of.J[ENDS + k * DIM + d];
            J[CENTRE + d] -= J[k * NODE + d];
        }
    add_by_length(sheave, of.J[OF_LENGTH], J + MATERIAL);
    return of.h;
}

double fu_short_wrap_drift(const fu_sheave *sheave, const fu_sheave_state *at)
{
    const short_wrap of = short_wrap_at(sheave, at);
    double drift;
    sheave->wheel.kernel->short_wrap_motion(at->slope[0], at->slope[1], wrap_length(sheave, at), at->slope_rate[0],
                                            at->slope_rate[1], at->s_rate[sheave->n_zones] - at->s_rate[0], &drift);
    for (int k = 0; k < ENDS; ++k) drift += of.J[k] * at->phi_acc[k];
    return drift;
}

void fu_join_row(const fu_sheave *sheave, const fu_sheave_state *at, int r, double *phi, double J[Y])
{
    memset(J, 0, sizeof(double) * Y);
    if (r < NODE) {
        J[r] = -1.0;
        J[NODE + r] = 1.0;
        *phi = r < DIM ? at->x[1][r] - at->x[0][r] : at->slope[1][r - DIM] - at->slope[0][r - DIM];
        return;
    }
    *phi = wrap_length(sheave, at);
    add_by_length(sheave, 1.0, J + MATERIAL);
}

void fu_share_row(const fu_sheave *sheave, const fu_sheave_state *at, int j, double *phi, double J[Y])
{
    const double share = (double)j / sheave->n_zones;
    memset(J, 0, sizeof(double) * Y);
    *phi = at->s[j] - at->s[0] - share * wrap_length(sheave, at);
    J[MATERIAL + j] = 1.0;
    J[MATERIAL] = share - 1.0;
    J[MATERIAL + sheave->n_zones] = -share;
}

/* Returns the number of conditions of a mode but those of the zones. */
static int without_zones(const fu_sheave *sheave, int mode)
{
    return first_row_of_wrap(sheave, mode) + !fu_stretches(mode);
}

int fu_sheave_conditions(const fu_sheave *sheave, const fu_sheave_state *at)
{
    return without_zones(sheave, at->mode) + (fu_stretches(at->mode) ? 0 : sheave->n_zones - 1);
}

void fu_sheave_rows_of_wrap(const fu_sheave *sheave, const fu_sheave_state *at, double phi[MAX_CONDITIONS],
                            double J[MAX_CONDITIONS][Y])
{
    const int zones = without_zones(sheave, at->mode), own = first_row_of_wrap(sheave, at->mode);
    for (int r = zones; r < fu_sheave_conditions(sheave, at); ++r)
        fu_share_row(sheave, at, r - zones + 1, &phi[r], J[r]);
    if (at->mode == FU_SHORT) phi[own] = fu_short_wrap_row(sheave, at, J[own]);
    if (at->mode == FU_LIFTED) fu_join_row(sheave, at, NODE, &phi[own], J[own]);
}
