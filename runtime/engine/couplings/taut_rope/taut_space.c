/* Straight parts of ropes without mass in space (derive/couplings/taut_part.py): the feet on the grooves at both ends,
 * by Newton's iteration, and their derivatives. */
#include "bodies/model.h"
#include "couplings/taut_rope/taut_rope.h"

#include <math.h>
#include <string.h>

#define TURNS_OF_SEARCH 4 /* from one foot to the other, before Newton's iteration */
#define MAX_ITERATIONS 30 /* of it */
#define LAST_CHANGE 1e-9  /* rad, or over a radius: the next one is below rounding, as it has the square */
#define FLEET_RESERVE 3.0 /* of the length at which a part slides along a groove */

enum { DIM = 3, SIDES = 2, COLUMNS = FU_PART_PLACES, ANGLE = 0, REACH = 1, OF_FOOT = 2 };

/* Computes the components of a vector in the axes of a groove. */
static void in_groove(const double *frame, const double v[DIM], double out[DIM])
{
    for (int k = 0; k < DIM; ++k) out[k] = frame[k] * v[0] + frame[DIM + k] * v[1] + frame[2 * DIM + k] * v[2];
}

/* The foot on the groove of a radius with sense, and of a frame, of the part that leads to a place (way 1) or comes
 * from there (-1); arm: from the centre to the place; aside: of the wrap. It starts the iteration. Not a number where
 * there is none. */
static void start_foot(double radius, const double *frame, const double arm[DIM], double aside, int way,
                       double foot[OF_FOOT])
{
    double along[DIM];
    in_groove(frame, arm, along);
    along[2] -= aside;
    const double sense = radius < 0.0 ? -1.0 : 1.0, square = along[0] * along[0] + along[1] * along[1];
    const double beyond = square - radius * radius, lift = 2.0 * radius * along[2];
    const double root = beyond > 0.0 ? sqrt(beyond * beyond - lift * lift) : NAN;
    const double reach = sqrt(0.5 * (square + radius * radius - root));
    foot[ANGLE] = atan2(along[1], along[0]) + sense * (0.5 * acos(-1.0) - way * acos(fmin(reach / sqrt(square), 1.0)));
    foot[REACH] = sense * reach;
}

/* Computes the place of a foot from its centre. */
static void place_foot(const double *frame, const double foot[OF_FOOT], double aside, double out[DIM])
{
    for (int d = 0; d < DIM; ++d)
        out[d] = foot[REACH] * (sin(foot[ANGLE]) * frame[d * DIM] - cos(foot[ANGLE]) * frame[d * DIM + 1]) +
                 aside * frame[d * DIM + 2];
}

/* Computes feet from which Newton's iteration starts: exact for a part to an anchor. */
static void start(const fu_taut_feet *of, double z[FU_FEET])
{
    double place[SIDES][DIM] = {{0.0}};
    const int turns = of->radius[0] != 0.0 && of->radius[1] != 0.0 ? TURNS_OF_SEARCH : 1;
    for (int turn = 0; turn < turns; ++turn)
        for (int end = 0; end < SIDES; ++end) {
            double arm[DIM], *foot = z + OF_FOOT * end;
            if (of->radius[end] == 0.0) continue;
            for (int d = 0; d < DIM; ++d) arm[d] = (end ? -of->d[d] : of->d[d]) + place[!end][d];
            start_foot(of->radius[end], of->frame[end], arm, of->aside[end], end ? -1 : 1, foot);
            place_foot(of->frame[end], foot, of->aside[end], place[end]);
        }
}

/* Makes the conditions of an anchor those of no change. */
static void omit_anchors(const fu_taut_feet *of, int n_columns, double *rows)
{
    for (int k = 0; k < FU_FEET; ++k)
        if (of->radius[k / OF_FOOT] == 0.0) memset(rows + k * n_columns, 0, sizeof(double) * (size_t)n_columns);
}

/* Computes the conditions at the feet with the factors of their derivatives. */
static void evaluate(const fu_taut_part_kernels *kernel, fu_taut_feet *of, const double z[FU_FEET], double *l,
                     double u[DIM], double F_z[FU_FEET])
{
    const double angle[SIDES] = {z[0], z[2]}, reach[SIDES] = {z[1], z[3]};
    kernel->feet(of->d, angle, reach, of->aside, of->frame[0], of->frame[1], of->radius, l, u, &of->foot[0][0], F_z,
                 of->factors);
    omit_anchors(of, 1, F_z);
    omit_anchors(of, FU_FEET, of->factors);
    for (int k = 0; k < FU_FEET; ++k)
        if (of->radius[k / OF_FOOT] == 0.0) {
            for (int i = 0; i < FU_FEET; ++i) of->factors[i * FU_FEET + k] = 0.0;
            of->factors[k * FU_FEET + k] = 1.0;
        }
    if (fu_small_factor(FU_FEET, of->factors, of->pivot)) *l = NAN;
}

/* Solves for the feet. */
static void solve(const fu_taut_part_kernels *kernel, fu_taut_feet *of, double z[FU_FEET], double *l, double u[DIM])
{
    double change = INFINITY, F_z[FU_FEET];
    start(of, z);
    for (int i = 0; i < MAX_ITERATIONS && change > LAST_CHANGE; ++i) {
        evaluate(kernel, of, z, l, u, F_z);
        fu_small_solve(FU_FEET, of->factors, of->pivot, F_z);
        change = 0.0;
        for (int k = 0; k < FU_FEET; ++k) {
            const double radius = fabs(of->radius[k / OF_FOOT]);
            z[k] -= F_z[k];
            if (radius > 0.0) change = fmax(change, fabs(F_z[k]) / (k % OF_FOOT == REACH ? radius : 1.0));
        }
    }
    evaluate(kernel, of, z, l, u, F_z);
    if (!(change <= LAST_CHANGE)) *l = NAN;
}

/* Computes the derivatives of the feet, and of the contributions to drawn length and way, by the places. */
static void differentiate(const fu_taut_part_kernels *kernel, const double z[FU_FEET], fu_taut_feet *of)
{
    const double angle[SIDES] = {z[0], z[2]}, reach[SIDES] = {z[1], z[3]};
    kernel->moves(of->d, angle, reach, of->aside, of->frame[0], of->frame[1], of->whole, of->z_p);
    omit_anchors(of, COLUMNS, of->z_p);
    for (int j = 0; j < COLUMNS; ++j) {
        double column[FU_FEET];
        for (int k = 0; k < FU_FEET; ++k) column[k] = -of->z_p[k * COLUMNS + j];
        fu_small_solve(FU_FEET, of->factors, of->pivot, column);
        for (int k = 0; k < FU_FEET; ++k) of->z_p[k * COLUMNS + j] = column[k];
        of->by[FU_WAY][j] = of->way_share[0] * column[0] + of->way_share[1] * column[OF_FOOT];
        of->by[FU_DRAWN][j] = of->whole[j] - of->by[FU_WAY][j];
    }
    for (int k = 0; k < FU_FEET; ++k) of->z_rate[k] = fu_dot(COLUMNS, of->z_p + k * COLUMNS, of->rate);
}

void fu_taut_part_in_space(const fu_taut_part_kernels *kernel, const fu_attachment_state *one,
                           const fu_attachment_state *other, const double near[2], fu_taut_part *out)
{
    fu_taut_feet *of = &out->feet;
    double z[FU_FEET] = {0.0};
    memcpy(of->frame[0], one->A, sizeof of->frame[0]);
    memcpy(of->frame[1], other->A, sizeof of->frame[1]);
    for (int d = 0; d < DIM; ++d) {
        of->d[d] = other->p[d] - one->p[d];
        of->rate[d] = other->v[d] - one->v[d];
        of->rate[DIM + d] = one->omega[d];
        of->rate[2 * DIM + d] = other->omega[d];
    }
    solve(kernel, of, z, &out->l, out->u);
    differentiate(kernel, z, of);
    out->growth = fu_dot(COLUMNS, of->whole, of->rate);
    out->drawn = out->l;
    for (int end = 0; end < SIDES; ++end) {
        const double *axis = of->frame[end], sign = end ? -1.0 : 1.0;
        const double share = sign * of->radius[end] - of->way_share[end];
        out->angle[end] = fu_near_angle(z[OF_FOOT * end], near[end]);
        out->turning[end] = of->z_rate[OF_FOOT * end];
        of->reach[end] = z[OF_FOOT * end + REACH];
        out->growth -= sign * of->radius[end] * out->turning[end];
        out->drawn += share * out->angle[end];
        out->fleet[end] =
            of->radius[end] == 0.0
                ? 0.0
                : sign * asin(axis[2] * out->u[0] + axis[DIM + 2] * out->u[1] + axis[2 * DIM + 2] * out->u[2]);
    }
    out->drawn_rate = fu_dot(COLUMNS, of->by[FU_DRAWN], of->rate);
}

const double *fu_taut_moment(const fu_taut_part *part, int end)
{
    return part->feet.whole + DIM * (1 + end);
}

/* Adds the changes of derivatives by the feet to those at given feet. */
void fu_taut_second(const fu_taut_rope *rope, const fu_taut_part *part, double *K, double (*by_rate)[FU_PART_PLACES])
{
    const fu_taut_feet *of = &part->feet;
    double Q_z[FU_FEET * FU_FEET], Q_p[FU_FEET * COLUMNS], whole[COLUMNS], F_zp[FU_FEET * COLUMNS];
    rope->part->moves(of->d, part->angle, of->reach, of->aside, of->frame[0], of->frame[1], whole, F_zp);
    rope->part->tangent(of->d, part->angle, of->reach, of->aside, of->frame[0], of->frame[1], of->z_rate, of->rate, K,
                        Q_z, Q_p);
    omit_anchors(of, COLUMNS, F_zp);
    for (int i = 0; i < COLUMNS; ++i)
        for (int j = 0; j < COLUMNS; ++j)
            for (int k = 0; k < FU_FEET; ++k) K[i * COLUMNS + j] += F_zp[k * COLUMNS + i] * of->z_p[k * COLUMNS + j];
    for (int j = 0; j < COLUMNS; ++j) {
        double column[FU_FEET], of_whole = 0.0;
        for (int k = 0; k < FU_FEET; ++k) {
            column[k] = -Q_p[k * COLUMNS + j];
            for (int i = 0; i < FU_FEET; ++i) column[k] -= Q_z[k * FU_FEET + i] * of->z_p[i * COLUMNS + j];
        }
        omit_anchors(of, 1, column);
        fu_small_solve(FU_FEET, of->factors, of->pivot, column);
        for (int i = 0; i < COLUMNS; ++i) of_whole += of->rate[i] * K[i * COLUMNS + j];
        by_rate[FU_WAY][j] = of->way_share[0] * column[0] + of->way_share[1] * column[OF_FOOT];
        by_rate[FU_DRAWN][j] = of_whole - by_rate[FU_WAY][j];
    }
}

/* A part is a minimum of the length while it is longer, along the groove, than R tan f: else its foot runs away along
 * the groove. The margin has a reserve. */
double fu_taut_margin_of_fleet(const fu_taut_part *part, int end)
{
    const double fleet = fabs(part->fleet[end]);
    return part->l * cos(fleet) - FLEET_RESERVE * fabs(part->feet.radius[end]) * tan(fleet);
}

void fu_taut_pass_in_space(const fu_taut_part *part, const fu_attachment_state *first,
                           const fu_attachment_state *groove, double radius, fu_taut_passage *out)
{
    double from[DIM], start[DIM], along[DIM];
    for (int d = 0; d < DIM; ++d) from[d] = first->p[d] + part->feet.foot[0][d] - groove->p[d];
    in_groove(groove->A, from, start);
    in_groove(groove->A, part->u, along);
    const double cosine = hypot(along[0], along[1]);
    /* in the plane of the groove: the part has the direction `along` over the cosine */
    const double way = -(along[0] * start[0] + along[1] * start[1]) / cosine, last = part->l * cosine;
    const double across = (along[1] * start[0] - along[0] * start[1]) / cosine;
    const double beyond = way < 0.0 ? way : way > last ? way - last : 0.0;
    out->depth = fabs(radius) / cosine - hypot(across, beyond);
    out->aside = start[2] + (way - beyond) / cosine * along[2];
    out->angle = atan2(along[1], along[0]);
    out->side = across * radius < 0.0 ? -1 : 1;
}

double fu_taut_along(const fu_taut_part *part, const fu_attachment_state *first, const fu_attachment_state *groove,
                     double *rate)
{
    const fu_taut_feet *of = &part->feet;
    double feet[SIDES][DIM], to[DIM], to_rate[DIM], between[DIM];
    for (int end = 0; end < SIDES; ++end) {
        const double *A = of->frame[end], *omega = of->rate + DIM * (1 + end);
        const double cosine = cos(part->angle[end]), sine = sin(part->angle[end]);
        const double turning = of->z_rate[OF_FOOT * end], reaching = of->z_rate[OF_FOOT * end + REACH];
        for (int d = 0; d < DIM; ++d) {
            const int e = (d + 1) % DIM, g = (d + 2) % DIM;
            feet[end][d] = omega[e] * of->foot[end][g] - omega[g] * of->foot[end][e] +
                           (reaching * sine + of->reach[end] * turning * cosine) * A[d * DIM] -
                           (reaching * cosine - of->reach[end] * turning * sine) * A[d * DIM + 1];
        }
    }
    for (int d = 0; d < DIM; ++d) {
        to[d] = groove->p[d] - first->p[d] - of->foot[0][d];
        to_rate[d] = groove->v[d] - first->v[d] - feet[0][d];
        between[d] = of->rate[d] + feet[1][d] - feet[0][d];
    }
    const double along = fu_dot(DIM, part->u, to), growth = fu_dot(DIM, part->u, between);
    *rate = fu_dot(DIM, part->u, to_rate) + (fu_dot(DIM, between, to) - growth * along) / part->l;
    return along;
}
