/* Friction of a rope on a sheave: at the ends of the zones of its wrap, or in the middle of a short wrap. */
#include "couplings/sheave/sheave.h"

#include <math.h>
#include <string.h>

enum { SIDES = 2, MAX_PLACES = SIDES + 1 + SIDES * DIM };

/* The change by z of a number of a point: n entries. */
typedef struct {
    int n, at[ENDS];
    double value[ENDS];
} entry;

/* A point of friction: its zones, from `first` on, with the angles of their ends and their lengths, or both tangent
 * points of a short wrap; the spans beside it from number `span` on; the rates of its own angle and s. */
typedef struct {
    int first, zones, angles, span, spans;
    double phi[SIDES + 1], l[SIDES], phi_rate, s_rate, phi_acc, s_acc;
    entry angle, s, of_angle[SIDES + 1];
} friction_point;

/* Returns the change of an angle at a share of the wrap. */
static entry at_share(double share)
{
    return (entry){ENDS, {0, 1}, {1.0 - share, share}};
}

static friction_point middle_of_short(const fu_sheave *sheave, const fu_sheave_state *at)
{
    const int n = sheave->n_zones;
    return (friction_point){.angles = ENDS,
                            .spans = ENDS,
                            .phi = {at->phi[0], at->phi[1]},
                            .phi_rate = 0.5 * (at->phi_rate[0] + at->phi_rate[1]),
                            .s_rate = 0.5 * (at->s_rate[0] + at->s_rate[n]),
                            .phi_acc = 0.5 * (at->phi_acc[0] + at->phi_acc[1]),
                            .s_acc = 0.5 * (at->s_acc[0] + at->s_acc[n]),
                            .angle = at_share(0.5),
                            .s = {ENDS, {Z_MATERIAL, Z_MATERIAL + n}, {0.5, 0.5}},
                            .of_angle = {at_share(0.0), at_share(1.0)}};
}

static friction_point end_of_zones(const fu_sheave *sheave, const fu_sheave_state *at, int j)
{
    const int n = sheave->n_zones, first = j > 0 ? j - 1 : 0, last = j < n ? j + 1 : n;
    friction_point out = {.first = first,
                          .zones = last - first,
                          .angles = last - first + 1,
                          .span = j > 0,
                          .spans = j == 0 || j == n,
                          .phi_rate = at->angle_rate[j],
                          .s_rate = at->s_rate[j],
                          .phi_acc = at->angle_acc[j],
                          .s_acc = at->s_acc[j],
                          .angle = at_share(at->share[j]),
                          .s = {1, {Z_MATERIAL + j}, {1.0}}};
    for (int k = 0; k < out.zones; ++k) out.l[k] = at->s[first + k + 1] - at->s[first + k];
    for (int k = 0; k < out.angles; ++k) {
        out.phi[k] = at->angle[first + k];
        out.of_angle[k] = at_share(at->share[first + k]);
    }
    return out;
}

static friction_point point_of(const fu_sheave *sheave, const fu_sheave_state *at, int j)
{
    return at->mode == FU_SHORT ? middle_of_short(sheave, at) : end_of_zones(sheave, at, j);
}

void fu_friction_at(const fu_sheave *sheave, const fu_sheave_state *at, int j, double *F, double numbers[3],
                    double *power)
{
    const friction_point p = point_of(sheave, at, j);
    const fu_wheel *wheel = &sheave->wheel;
    const fu_sheave_kernels *kernel = wheel->kernel;
    if (!p.spans)
        kernel->friction(wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction,
                         sheave->slip_velocity, p.phi, p.l, p.phi_rate, at->spin_below, p.s_rate, F, numbers, power);
    else if (!p.zones)
        kernel->friction_short(wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction,
                               sheave->slip_velocity, p.phi, at->slope[0], at->slope[1], p.phi_rate, at->spin_below,
                               p.s_rate, F, numbers, power);
    else
        (p.span ? kernel->friction_off : kernel->friction_on)(
            wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction, sheave->slip_velocity,
            p.phi, p.l, at->slope[p.span], p.phi_rate, at->spin_below, p.s_rate, F, numbers, power);
}

/* Computes the changes by z of the forces of a point. */
static void rows_of(const friction_point *p, entry rows[FU_SLIDING])
{
    rows[0] = p->angle;
    rows[1] = (entry){1, {Z_TURN}, {1.0}};
    rows[2] = p->s;
}

/* Adds forces on the angle of a point, the rotation and s. */
static void add_by_z(const friction_point *p, const double forces[FU_SLIDING], double *z)
{
    entry rows[FU_SLIDING];
    rows_of(p, rows);
    for (int i = 0; i < FU_SLIDING; ++i)
        for (int a = 0; a < rows[i].n; ++a) z[rows[i].at[a]] += rows[i].value[a] * forces[i];
}

void fu_friction_add_forces(const fu_sheave *sheave, const fu_sheave_state *at, int j, double *z)
{
    const friction_point p = point_of(sheave, at, j);
    double F[FU_SLIDING], numbers[3], power;
    fu_friction_at(sheave, at, j, F, numbers, &power);
    add_by_z(&p, F, z);
}

/* Computes the changes by z of the places of a point: angles, lengths, slopes. Returns their number. */
static int places_of(const friction_point *p, entry *out)
{
    const int s = Z_MATERIAL + p->first;
    int n = 0;
    for (int k = 0; k < p->angles; ++k) out[n++] = p->of_angle[k];
    for (int k = 0; k < p->zones; ++k) out[n++] = (entry){2, {s + k, s + k + 1}, {-1.0, 1.0}};
    for (int k = 0; k < p->spans; ++k)
        for (int d = 0; d < DIM; ++d) out[n++] = (entry){1, {Z_SLOPE + (p->span + k) * DIM + d}, {1.0}};
    return n;
}

/* Adds a matrix of a point (FU_SLIDING x columns) times a factor to one of z. */
static void add_matrix(const entry *rows, int columns, const entry *column, double factor, const double *from,
                       double (*A)[Z])
{
    for (int i = 0; i < FU_SLIDING; ++i)
        for (int a = 0; a < rows[i].n; ++a)
            for (int j = 0; j < columns; ++j)
                for (int b = 0; b < column[j].n; ++b)
                    A[rows[i].at[a]][column[j].at[b]] +=
                        factor * rows[i].value[a] * column[j].value[b] * from[i * columns + j];
}

/* Derivatives of the forces at a point: by its places, and by rates of the same as the forces. */
typedef struct {
    double of_place[FU_SLIDING * MAX_PLACES], of_rate[FU_SLIDING * FU_SLIDING];
} derivatives;

/* Adds the derivatives at a point. */
static void scatter(const friction_point *p, double factor, const derivatives *by, double (*D)[Z], double (*K)[Z])
{
    entry rows[FU_SLIDING], places[MAX_PLACES];
    rows_of(p, rows);
    add_matrix(rows, places_of(p, places), places, factor, by->of_place, K);
    add_matrix(rows, FU_SLIDING, rows, factor, by->of_rate, D);
}

void fu_friction_add_matrices(const fu_sheave *sheave, const fu_sheave_state *at, int j, double factor, double (*D)[Z],
                              double (*K)[Z])
{
    const friction_point p = point_of(sheave, at, j);
    const fu_wheel *wheel = &sheave->wheel;
    const fu_sheave_kernels *kernel = wheel->kernel;
    derivatives by;
    if (!p.spans)
        kernel->friction_tangent(wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction,
                                 sheave->slip_velocity, p.phi, p.l, p.phi_rate, at->spin_below, p.s_rate, by.of_place,
                                 by.of_rate);
    else if (!p.zones)
        kernel->friction_short_tangent(wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction,
                                       sheave->slip_velocity, p.phi, at->slope[0], at->slope[1], p.phi_rate,
                                       at->spin_below, p.s_rate, by.of_place, by.of_rate);
    else
        (p.span ? kernel->friction_off_tangent : kernel->friction_on_tangent)(
            wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction, sheave->slip_velocity,
            p.phi, p.l, at->slope[p.span], p.phi_rate, at->spin_below, p.s_rate, by.of_place, by.of_rate);
    scatter(&p, factor, &by, D, K);
}

/* --- Coulomb friction ------------------------------------------------------------------------------------------- */

void fu_coulomb_at(const fu_sheave *sheave, const fu_sheave_state *at, int j, fu_coulomb *out)
{
    memset(out, 0, sizeof *out);
    if (!fu_point_acts(at, j)) return;
    const friction_point p = point_of(sheave, at, j);
    const fu_wheel *wheel = &sheave->wheel;
    const fu_sheave_kernels *kernel = wheel->kernel;
    const double rates[FU_SLIDING] = {p.phi_rate, at->wheel.turn_rate, p.s_rate};
    double numbers[2];
    memcpy(out->rate, rates, sizeof rates);
    if (!p.spans)
        kernel->coulomb(wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction, p.phi, p.l,
                        p.phi_rate, at->wheel.turn_rate, p.s_rate, numbers, out->row, out->column);
    else if (!p.zones)
        kernel->coulomb_short(wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction, p.phi,
                              at->slope[0], at->slope[1], p.phi_rate, at->wheel.turn_rate, p.s_rate, numbers, out->row,
                              out->column);
    else
        (p.span ? kernel->coulomb_off : kernel->coulomb_on)(
            wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction, p.phi, p.l,
            at->slope[p.span], p.phi_rate, at->wheel.turn_rate, p.s_rate, numbers, out->row, out->column);
    out->w = numbers[0];
    out->limit = numbers[1];
}

void fu_coulomb_add_matrices(const fu_sheave *sheave, const fu_sheave_state *at, int j, double held, double direction,
                             double factor, double (*D)[Z], double (*K)[Z])
{
    if (!fu_point_acts(at, j)) return;
    const friction_point p = point_of(sheave, at, j);
    const fu_wheel *wheel = &sheave->wheel;
    const fu_sheave_kernels *kernel = wheel->kernel;
    derivatives by;
    if (!p.spans)
        kernel->coulomb_tangent(wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction, p.phi,
                                p.l, p.phi_rate, at->wheel.turn_rate, p.s_rate, held, direction, by.of_place,
                                by.of_rate);
    else if (!p.zones)
        kernel->coulomb_short_tangent(wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction,
                                      p.phi, at->slope[0], at->slope[1], p.phi_rate, at->wheel.turn_rate, p.s_rate,
                                      held, direction, by.of_place, by.of_rate);
    else
        (p.span ? kernel->coulomb_off_tangent : kernel->coulomb_on_tangent)(
            wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction, p.phi, p.l,
            at->slope[p.span], p.phi_rate, at->wheel.turn_rate, p.s_rate, held, direction, by.of_place, by.of_rate);
    scatter(&p, factor, &by, D, K);
}

/* Returns the rate of w at the accelerations of `at`, without those of the sheave's rotation and of s. */
static double drift_of(const fu_sheave *sheave, const fu_sheave_state *at, const friction_point *p)
{
    const fu_wheel *wheel = &sheave->wheel;
    const fu_sheave_kernels *kernel = wheel->kernel;
    const double *phi_rate = at->angle_rate + p->first, *s_rate = at->s_rate + p->first;
    double l_rate[SIDES], drift;
    for (int k = 0; k < p->zones; ++k) l_rate[k] = s_rate[k + 1] - s_rate[k];
    if (!p->spans)
        kernel->coulomb_motion(wheel->sense, wheel->radius, p->phi, p->l, phi_rate, l_rate, p->s_rate, p->phi_acc,
                               &drift);
    else if (!p->zones)
        kernel->coulomb_short_motion(wheel->sense, wheel->radius, at->slope[0], at->slope[1], at->slope_rate[0],
                                     at->slope_rate[1], p->s_rate, p->phi_acc, &drift);
    else
        (p->span ? kernel->coulomb_off_motion
                 : kernel->coulomb_on_motion)(wheel->sense, wheel->radius, p->phi, p->l, at->slope[p->span], phi_rate,
                                              l_rate, at->slope_rate[p->span], p->s_rate, p->phi_acc, &drift);
    return drift;
}

double fu_coulomb_rate(const fu_sheave *sheave, const fu_sheave_state *at, int j, const fu_coulomb *of, double *size)
{
    const friction_point p = point_of(sheave, at, j);
    const double parts[] = {drift_of(sheave, at, &p), of->row[1] * at->wheel.turn_acc, of->row[2] * p.s_acc};
    *size = fabs(parts[0]) + fabs(parts[1]) + fabs(parts[2]);
    return parts[0] + parts[1] + parts[2];
}

void fu_point_by_z(const fu_sheave *sheave, const fu_sheave_state *at, int j, const double forces[FU_SLIDING],
                   double z[Z])
{
    const friction_point p = point_of(sheave, at, j);
    memset(z, 0, sizeof(double) * Z);
    add_by_z(&p, forces, z);
}
