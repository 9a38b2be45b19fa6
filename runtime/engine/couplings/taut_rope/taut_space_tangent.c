/* Straight parts of ropes without mass in space in a Newton system. */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/taut_rope/taut_rope.h"

#include <string.h>

enum { DIM = 3, SIDES = 2 };
/* of a point in a Newton system: place, velocity, turn, angular velocity */
enum { VELOCITY = DIM, TURN = 2 * DIM, SPIN = 3 * DIM, ROWS = 4 * DIM };

/* An end of a straight part: its point, and the shares of the rotation of its wheel in the moment and in the way. */
typedef struct {
    const fu_taut_point *point;
    fu_point_motion motion;
    double turn_share, way_share;
} point_side;

/* Computes, from the derivatives by the places of a part, those by place and turn of the point at an end. */
static void of_end(int end, const double *by_places, double *place, double *turn)
{
    for (int d = 0; d < DIM; ++d) {
        place[d] = (end ? 1.0 : -1.0) * by_places[d];
        turn[d] = by_places[DIM * (1 + end) + d];
    }
}

/* Adds the entries of one side in the row of the law of a tension. */
static void add_row(const fu_model *model, const fu_coupling *coupling, const fu_taut_part *part, int end,
                    const fu_taut_law *law, const double by_angle[SIDES], const double (*by_rate)[FU_PART_PLACES],
                    const point_side *of, fu_weights weights, fu_system *system)
{
    const fu_taut_feet *feet = &part->feet;
    const int row = fu_extra(model, coupling->unknown), n = of->motion.at.n, angles = FU_FEET / SIDES;
    double at[FU_PART_PLACES], moving[FU_PART_PLACES], by[ROWS], changes[FU_ATTACHMENT_COORDINATES];
    for (int j = 0; j < FU_PART_PLACES; ++j) {
        at[j] = moving[j] = 0.0;
        for (int k = 0; k < SIDES; ++k) at[j] += by_angle[k] * feet->z_p[angles * k * FU_PART_PLACES + j];
        for (int i = 0; i < FU_LENGTHS; ++i) {
            at[j] += law->K[i] * feet->by[i][j] + law->D[i] * by_rate[i][j];
            moving[j] += law->D[i] * feet->by[i][j];
        }
    }
    of_end(end, at, by, by + TURN);
    of_end(end, moving, by + VELOCITY, by + SPIN);
    fu_changes(&of->motion, 1, by, changes);
    for (int i = 0; i < n; ++i) fu_add(model, system, row, of->motion.at.at[i], -weights.stiffness * changes[i]);
    if (of->way_share == 0.0 || of->point->turn < 0) return;
    const double turn = of->way_share * (law->K[FU_WAY] + weights.rate * law->D[FU_WAY]);
    fu_add(model, system, row, of->point->turn, -weights.stiffness * turn);
}

/* Adds the entries of one side in the column of the forces of the tension. */
static void add_column(const fu_model *model, const fu_coupling *coupling, const fu_taut_part *part, int end,
                       const point_side *of, fu_weights weights, fu_system *system)
{
    const int column = fu_extra(model, coupling->unknown), n = of->motion.at.n;
    const double unit = fu_row_unit(weights.inertia, coupling->scale[0]);
    double on_point[FU_ATTACHMENT_COORDINATES], force[DIM], moment[DIM];
    of_end(end, part->feet.whole, force, moment);
    fu_wrench_force(DIM, &of->motion.at, force, moment, 1.0, on_point);
    for (int i = 0; i < n; ++i) fu_add(model, system, of->motion.at.at[i], column, unit * on_point[i]);
    if (of->turn_share != 0.0 && of->point->turn >= 0)
        fu_add(model, system, of->point->turn, column, unit * of->turn_share);
}

/* Adds the changes of the force and the moment of a part on one side by the other one, or by itself. */
static void add_stiffness(const fu_model *model, const double *K, double tension, const point_side *sides, int of,
                          int by, double stiffness, fu_system *system)
{
    double force[DIM * ROWS], moment[DIM * ROWS], changes[2][DIM * FU_ATTACHMENT_COORDINATES];
    double row[FU_PART_PLACES];
    memset(force, 0, sizeof force);
    memset(moment, 0, sizeof moment);
    for (int i = 0; i < DIM; ++i) {
        double *on_force = force + i * ROWS, *on_moment = moment + i * ROWS;
        for (int j = 0; j < FU_PART_PLACES; ++j) row[j] = (of ? tension : -tension) * K[i * FU_PART_PLACES + j];
        of_end(by, row, on_force, on_force + TURN);
        for (int j = 0; j < FU_PART_PLACES; ++j) row[j] = tension * K[(DIM * (1 + of) + i) * FU_PART_PLACES + j];
        of_end(by, row, on_moment, on_moment + TURN);
    }
    fu_changes(&sides[by].motion, DIM, force, changes[0]);
    fu_changes(&sides[by].motion, DIM, moment, changes[1]);
    fu_add_wrench_tangent(model, &sides[of].motion.at, &sides[by].motion.at, changes[0], changes[1],
                          of == by ? fu_stiffness_of(&sides[by].motion) : 0, stiffness, system);
}

void fu_taut_add_in_space(const fu_model *model, const fu_coupling *coupling, const fu_taut_rope *rope,
                          const fu_taut_part *part, const fu_taut_law *law, const fu_equations *equations,
                          fu_system *system)
{
    const int own = rope == (const fu_taut_rope *)coupling, last = rope->n_points - 1;
    const int holds[SIDES] = {part->from == 0, part->to == last};
    const double unknown = own ? equations->next->forces[coupling->force] : 0.0;
    const double by_angle[SIDES] = {holds[0] ? law->angle[0] : 0.0, holds[1] ? law->angle[1] : 0.0};
    double K[FU_PART_PLACES * FU_PART_PLACES], by_rate[FU_LENGTHS][FU_PART_PLACES];
    point_side sides[SIDES];
    fu_taut_second(rope, part, K, by_rate);
    for (int end = 0; end < SIDES; ++end) {
        point_side *of = &sides[end];
        double force[DIM], moment[DIM];
        of->point = fu_taut_point_of(model, rope, end ? part->to : part->from);
        of->turn_share = holds[end] ? -fu_taut_share_of_end(model, rope, end) : 0.0;
        of->way_share = holds[end] && fu_taut_slips(of->point, equations->next) ? 0.0 : of->turn_share;
        of_end(end, part->feet.whole, force, moment);
        for (int d = 0; d < DIM; ++d) {
            force[d] *= unknown;
            moment[d] *= unknown;
        }
        fu_point_motion_at(model, &of->point->attachments[0], equations->next, FU_POINT | FU_AXES, force, moment,
                           equations->psi, equations->weights.rate, &of->motion);
        add_row(model, coupling, part, end, law, by_angle, (const double (*)[FU_PART_PLACES])by_rate, of,
                equations->weights, system);
        if (own) add_column(model, coupling, part, end, of, equations->weights, system);
    }
    for (int end = 0; own && end < SIDES; ++end)
        for (int by = 0; by < SIDES; ++by)
            add_stiffness(model, K, unknown, sides, end, by, equations->weights.stiffness, system);
}
