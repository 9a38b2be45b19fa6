/* Friction of a rope on a sheave, at the ends of the zones of its wrap. */
#include "couplings/sheave/sheave.h"

#include <string.h>

/* A point of friction at an end of a zone: its zones with their angles and lengths, and the tangent point that it is,
 * -1 for none. The k-th angle is that of the end of zone first + k. */
typedef struct {
    int first, zones, foot;
    const double *phi, *share;
    double l[2], phi_rate, s_rate;
} friction_point;

enum { SIDES = 2, MOST_PLACES = SIDES + 1 + SIDES };

static friction_point point_of(const fu_sheave *sheave, const fu_sheave_state *at, int j)
{
    const int n = sheave->n_zones, first = j > 0 ? j - 1 : 0, last = j < n ? j + 1 : n;
    friction_point out = {.first = first, .zones = last - first, .foot = j == 0 ? 0 : j == n ? 1 : -1};
    out.phi = at->angle + first;
    out.share = at->share + first;
    out.phi_rate = at->angle_rate[j];
    out.s_rate = at->s_rate[j];
    for (int k = 0; k < out.zones; ++k) out.l[k] = at->s[first + k + 1] - at->s[first + k];
    return out;
}

void fu_friction_at(const fu_sheave *sheave, const fu_sheave_state *at, int j, double *F, double numbers[3],
                    double *power)
{
    const friction_point p = point_of(sheave, at, j);
    const fu_wheel *wheel = &sheave->wheel;
    const fu_sheave_kernels *kernel = wheel->kernel;
    if (p.foot < 0)
        kernel->friction(wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction,
                         sheave->slip_velocity, p.phi, p.l, p.phi_rate, at->spin_below, p.s_rate, F, numbers, power);
    else
        (p.foot ? kernel->friction_off : kernel->friction_on)(
            wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction, sheave->slip_velocity,
            p.phi, p.l, at->slope[p.foot], p.phi_rate, at->spin_below, p.s_rate, F, numbers, power);
}

/* Derivatives of the forces at a point on its angle, the rotation and its s: by the angles, the lengths and the slope,
 * and by rates of the same as the forces. */
typedef struct {
    double of_place[FU_SLIDING * MOST_PLACES], of_rate[FU_SLIDING * FU_SLIDING];
} derivatives;

/* Adds the derivatives at the j-th point. */
static void scatter(const fu_sheave *sheave, const friction_point *p, int j, double factor, const derivatives *by,
                    double (*D)[Z], double (*K)[Z])
{
    const double share = (double)j / sheave->n_zones;
    const int row[FU_SLIDING] = {0, Z_TURN, Z_MATERIAL + j}, places = 2 * p->zones + 1 + (p->foot < 0 ? 0 : DIM);
    for (int i = 0; i < FU_SLIDING; ++i)
        for (int e = 0; e < (i ? 1 : ENDS); ++e) { /* a force on the angle is one on those of both tangent points */
            double *to_K = K[i ? row[i] : e], *to_D = D[i ? row[i] : e];
            const double part = factor * (i ? 1.0 : e ? share : 1.0 - share), *of = by->of_place + i * places;
            const double *of_rate = by->of_rate + i * FU_SLIDING;
            for (int k = 0; k <= p->zones; ++k) {
                to_K[0] += part * (1.0 - p->share[k]) * of[k];
                to_K[1] += part * p->share[k] * of[k];
            }
            for (int k = 0; k < p->zones; ++k) {
                to_K[Z_MATERIAL + p->first + k + 1] += part * of[p->zones + 1 + k];
                to_K[Z_MATERIAL + p->first + k] -= part * of[p->zones + 1 + k];
            }
            for (int d = 0; p->foot >= 0 && d < DIM; ++d)
                to_K[Z_SLOPE + p->foot * DIM + d] += part * of[2 * p->zones + 1 + d];
            to_D[0] += part * (1.0 - share) * of_rate[0];
            to_D[1] += part * share * of_rate[0];
            to_D[Z_TURN] += part * of_rate[1];
            to_D[Z_MATERIAL + j] += part * of_rate[2];
        }
}

void fu_friction_add_matrices(const fu_sheave *sheave, const fu_sheave_state *at, int j, double factor, double (*D)[Z],
                              double (*K)[Z])
{
    const friction_point p = point_of(sheave, at, j);
    const fu_wheel *wheel = &sheave->wheel;
    const fu_sheave_kernels *kernel = wheel->kernel;
    derivatives by;
    if (p.foot < 0)
        kernel->friction_tangent(wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction,
                                 sheave->slip_velocity, p.phi, p.l, p.phi_rate, at->spin_below, p.s_rate, by.of_place,
                                 by.of_rate);
    else
        (p.foot ? kernel->friction_off_tangent : kernel->friction_on_tangent)(
            wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction, sheave->slip_velocity,
            p.phi, p.l, at->slope[p.foot], p.phi_rate, at->spin_below, p.s_rate, by.of_place, by.of_rate);
    scatter(sheave, &p, j, factor, &by, D, K);
}

/* --- Coulomb friction ------------------------------------------------------------------------------------------- */

void fu_coulomb_at(const fu_sheave *sheave, const fu_sheave_state *at, int j, fu_coulomb *out)
{
    const friction_point p = point_of(sheave, at, j);
    const fu_wheel *wheel = &sheave->wheel;
    const fu_sheave_kernels *kernel = wheel->kernel;
    double numbers[2];
    if (p.foot < 0)
        kernel->coulomb(wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction, p.phi, p.l,
                        p.phi_rate, at->wheel.turn_rate, p.s_rate, numbers, out->row, out->column);
    else
        (p.foot ? kernel->coulomb_off : kernel->coulomb_on)(
            wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction, p.phi, p.l,
            at->slope[p.foot], p.phi_rate, at->wheel.turn_rate, p.s_rate, numbers, out->row, out->column);
    out->w = numbers[0];
    out->limit = numbers[1];
}

void fu_coulomb_add_matrices(const fu_sheave *sheave, const fu_sheave_state *at, int j, double held, double direction,
                             double factor, double (*D)[Z], double (*K)[Z])
{
    const friction_point p = point_of(sheave, at, j);
    const fu_wheel *wheel = &sheave->wheel;
    const fu_sheave_kernels *kernel = wheel->kernel;
    derivatives by;
    if (p.foot < 0)
        kernel->coulomb_tangent(wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction, p.phi,
                                p.l, p.phi_rate, at->wheel.turn_rate, p.s_rate, held, direction, by.of_place,
                                by.of_rate);
    else
        (p.foot ? kernel->coulomb_off_tangent : kernel->coulomb_on_tangent)(
            wheel->A, wheel->sense, wheel->rho, wheel->radius, at->wheel.g, sheave->friction, p.phi, p.l,
            at->slope[p.foot], p.phi_rate, at->wheel.turn_rate, p.s_rate, held, direction, by.of_place, by.of_rate);
    scatter(sheave, &p, j, factor, &by, D, K);
}

double fu_coulomb_drift(const fu_sheave *sheave, const fu_sheave_state *at, int j)
{
    const friction_point p = point_of(sheave, at, j);
    const fu_wheel *wheel = &sheave->wheel;
    const fu_sheave_kernels *kernel = wheel->kernel;
    const double *phi_rate = at->angle_rate + p.first, *s_rate = at->s_rate + p.first;
    double l_rate[SIDES], drift;
    for (int k = 0; k < p.zones; ++k) l_rate[k] = s_rate[k + 1] - s_rate[k];
    if (p.foot < 0)
        kernel->coulomb_motion(wheel->sense, wheel->radius, p.phi, p.l, phi_rate, l_rate, p.s_rate, at->angle_acc[j],
                               &drift);
    else
        (p.foot ? kernel->coulomb_off_motion
                : kernel->coulomb_on_motion)(wheel->sense, wheel->radius, p.phi, p.l, at->slope[p.foot], phi_rate,
                                             l_rate, at->slope_rate[p.foot], p.s_rate, at->angle_acc[j], &drift);
    return drift;
}

void fu_point_by_z(const fu_sheave *sheave, int j, const double forces[FU_SLIDING], double z[Z])
{
    const double share = (double)j / sheave->n_zones;
    memset(z, 0, sizeof(double) * Z);
    z[0] = (1.0 - share) * forces[0];
    z[1] = share * forces[0];
    z[Z_TURN] = forces[1];
    z[Z_MATERIAL + j] = forces[2];
}
