/* Ropes without mass (derive/couplings/taut_rope.py, taut_part.py). The items of a rope's route are points, couplings
 * of their own: anchors, sheaves and drums. A rope with one tension leads from an end or a wheel that holds it, a drum
 * or a sheave with friction, to the next one, over the frictionless sheaves between these. Ropes between which it slips
 * on sheaves are a chain (taut_slip.c). */
#ifndef FUNICULAR_COUPLINGS_ROPE_TAUT_ROPE_H
#define FUNICULAR_COUPLINGS_ROPE_TAUT_ROPE_H

#include "couplings/common/attachments.h"
#include "couplings/common/coupling.h"

#include <math.h>

enum { FU_DRAWN, FU_WAY, FU_LENGTHS }; /* of a rope: its drawn length, and the way of its ends onto wheels */
enum { FU_TOUCHES, FU_SLIPS, FU_POINT_FLAGS };
enum { FU_ASIDE = 2, FU_POINT_NUMBERS };

#define FU_MAX_PIECES 128 /* ropes of one tension of a rope */

/* of a straight part in space: angle and reach of both feet; change of the centres, and rotations of both grooves */
enum { FU_FEET = 4, FU_PART_PLACES = 9 };

/* A point. Its numbers in a state are the angles of the straight part after it and of what carries it, in space those
 * of the parts after and before it in its groove, counted over turns; and in space the place of the wrap along the
 * axis, m, which is that where the rope has touched it. Its flags are whether the rope touches it, and the direction in
 * which the rope slips on it: 1 in its order, -1 against it, 0 where it sticks. */
typedef struct {
    fu_coupling base;
    const fu_taut_part_kernels *wheel; /* of its spin */
    fu_attachment attachments[1];      /* the centre */
    int turn;                          /* dof: its rotation, -1 for none */
    double radius;                     /* m: with the sense of travel as sign, 0 of an anchor */
    double inertia, damping;           /* kg m^2, N m s */
    int torque_signal;                 /* of the torque on it, -1 for a constant one */
    double torque;                     /* N m: the factor of the signal */
    double friction;                   /* coefficient */
    double store;                      /* m: stress-free length that a drum holds as drawn */
    int ropes[2], places[2];           /* before and after it: numbers of the ropes, -1 for none; its places in them */
    double angle, carrier;             /* rad: its two numbers as drawn */
    double closing;     /* rad: by which the angles of parts grow along a closed rope, at its first point */
    double mouth, kink; /* of a sheave: half the width of its groove, m; rad: with which a rope leaves it */
    int touches;        /* as drawn */
    int in_space;
} fu_taut_point;

/* A rope with one tension. */
typedef struct {
    fu_coupling base;
    const fu_taut_rope_kernels *kernel;
    const fu_taut_part_kernels *part; /* of straight parts in space; null in the plane */
    int n_points;
    const int *points; /* numbers of the couplings */
    double EA, tau;
    double drawn_length, free_length, angles[2], carriers[2]; /* as drawn: m; rad: of both end parts and end points */
    double held;         /* m: stress-free length that wheels at its ends hold as drawn */
    double least_length; /* m: of a straight part */
    int n_pieces;        /* ropes of one tension that the whole rope has */
} fu_taut_rope;

/* Numbers of a rope in a state: its stress-free and drawn length, this without slack, after the last step, the ways of
 * its ends onto wheels until then and the stress-free length taken up, since the start, and the energy of that. */
typedef struct {
    double free, drawn, way[2], held[2], energy;
} fu_taut_history;

extern const fu_coupling_type fu_taut_point_type, fu_taut_rope_type;

/* A straight part in space beside its length and direction: radii with senses, places along the axes, frames, distances
 * from the axes and places of both feet from their centres, change of the centres and angular velocities, rates of the
 * feet; derivatives of the feet, of the length with the shares of both angles, and of its contributions to drawn length
 * and way, by the places; the factors of the conditions. */
typedef struct {
    double radius[2], aside[2], frame[2][9], reach[2], foot[2][3], d[3], rate[FU_PART_PLACES], z_rate[FU_FEET],
        z_p[FU_FEET * FU_PART_PLACES], whole[FU_PART_PLACES], by[FU_LENGTHS][FU_PART_PLACES],
        factors[FU_FEET * FU_FEET];
    double way_share[2]; /* of both angles in the way */
    int pivot[FU_FEET];
} fu_taut_feet;

/* A straight part between two points of a rope, by their places in it: change of the centres and its rate, length and
 * direction, derivatives of length and angle by d; the shares of its angle in drawn length and way. Both angles, in the
 * plane the same one, with their rates; the rate of the length; its contribution to the drawn length, and the rate of
 * that; angles between it and the grooves of both points, towards their axes. */
typedef struct {
    int from, to, dim;
    double rise, d[2], d_rate[2], l, u[3], l_d[2], b_d[2], share[FU_LENGTHS], angle[2], turning[2], growth, drawn,
        drawn_rate, fleet[2];
    fu_taut_feet feet;
} fu_taut_part;

/* A rope at a state: drawn length, and way since the last step, with their rates; ways of both ends since the start,
 * with their rates, without the rotation of wheels on which it slips; angles of its first and its last part, with their
 * rates; stress-free and drawn length after the last step; the stress-free length now, and that of a length of way; the
 * tension, and the part of it without damping; the rate of the drawn length at the present stress-free one; the
 * ways by which it has slipped over the wheels at its ends since the last step, in its order, with the rates. */
typedef struct {
    double length[FU_LENGTHS], rate[FU_LENGTHS], way[2], way_rate[2], angle[2], turning[2], past[2], free, per_way,
        tension, elastic, growth, slid[2], slid_rate[2];
} fu_taut_lengths;

enum { FU_EXCESS, FU_BY_RATE, FU_SUMS }; /* sums over a chain: outputs of the kernel `slide` */

/* A rope of a chain: logarithm of the ratio of its tension to that of the first one, with its rate; its sums, and their
 * derivatives by the strain x of the first one. */
typedef struct {
    const fu_taut_rope *rope;
    fu_taut_lengths now;
    double log_ratio, log_ratio_rate, sums[FU_SUMS], sums_x[FU_SUMS];
} fu_taut_piece;

/* A chain, with the place of the rope from which it was found; the strain of its first rope, and its rate, also at
 * constant ratios; the sums. */
typedef struct {
    int n, own;
    double x, x_rate, x_rate_alone, sums[FU_SUMS], sums_x[FU_SUMS];
    fu_taut_piece of[FU_MAX_PIECES];
} fu_taut_chain;

/* Changes of a tension by drawn length and way, by their rates, and by the angles of the first and the last part. */
typedef struct {
    double K[FU_LENGTHS], D[FU_LENGTHS], angle[2];
} fu_taut_law;

const fu_taut_point *fu_taut_point_of(const fu_model *model, const fu_taut_rope *rope, int place);
/* Returns the point at an end of a rope, 0 at its start, 1 at its end. */
const fu_taut_point *fu_taut_end(const fu_model *model, const fu_taut_rope *rope, int end);
fu_taut_history *fu_taut_history_of(const fu_taut_rope *rope, const fu_state *state);
/* Returns the change of the way by the angle of the first straight part, or of the last one. */
double fu_taut_share_of_end(const fu_model *model, const fu_taut_rope *rope, int end);
/* Returns whether a rope touches a point. */
int fu_touches(const fu_taut_point *point, const fu_state *state);
/* Returns the place of the next point that a rope touches, or of the one before. */
int fu_next_touched(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, int place);
int fu_touched_before(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, int place);
/* Computes the straight part between two places of a rope. */
void fu_taut_part_at(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, int from, int to,
                     fu_taut_part *out);
/* Returns the direction in which a rope slips on a point, 0 where it sticks. */
int fu_taut_slips(const fu_taut_point *point, const fu_state *state);
int fu_taut_slips_at(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, int end);
/* Returns whether a rope is taut. */
int fu_is_taut(const fu_taut_rope *rope, const fu_state *state);
/* Computes places, lengths and ways of a rope, without what its law gives; adds the forces of a tension to f. */
void fu_taut_geometry(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, fu_taut_lengths *out);
void fu_taut_walk(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, fu_taut_lengths *out,
                  double tension, double *f);
/* Computes lengths and tension of a rope, none where it is slack. */
void fu_taut_lengths_at(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, fu_taut_lengths *out);
/* Computes the force of a part on its second point, of a unit of tension; its opposite acts on the first. */
void fu_taut_pull(const fu_taut_part *part, double pull[3]);
/* A sheave that a straight part passes: by how much the part cuts its groove, m, its place there along the axis, m, and
 * its angle; side: 1 where it passes on the side to which it would turn, else -1. */
typedef struct {
    double depth, aside, angle;
    int side;
} fu_taut_passage;

/* In space (taut_space.c). Computes what a straight part has between these states of its points, the radii, shares and
 * places along the axes of which are given, with angles near those given; not a number where there is none. */
void fu_taut_part_in_space(const fu_taut_part_kernels *kernel, const fu_attachment_state *one,
                           const fu_attachment_state *other, const double near[2], fu_taut_part *out);
/* Computes how a part passes a groove of a radius with sense; first: the state of its first point. */
void fu_taut_pass_in_space(const fu_taut_part *part, const fu_attachment_state *first,
                           const fu_attachment_state *groove, double radius, fu_taut_passage *out);
/* Returns the length of a part from its first foot to the point next to the centre of a groove, m, and its rate. */
double fu_taut_along(const fu_taut_part *part, const fu_attachment_state *first, const fu_attachment_state *groove,
                     double *rate);
/* Returns by how much a part exceeds the length at which it would slide along the groove at an end, m. */
double fu_taut_margin_of_fleet(const fu_taut_part *part, int end);
/* Returns the moment of a part on one of its points, of a unit of tension. */
const double *fu_taut_moment(const fu_taut_part *part, int end);
/* Computes the derivatives, by the places, of the force and both moments of a part of a unit of tension, K (9 x 9), and
 * of the rates of its contributions to drawn length and way. */
void fu_taut_second(const fu_taut_rope *rope, const fu_taut_part *part, double *K, double (*by_rate)[FU_PART_PLACES]);
/* Adds the derivatives of a part of a rope to a Newton system (taut_space_tangent.c): those of the tension of a
 * coupling, and, of its own rope, those of the forces. */
void fu_taut_add_in_space(const fu_model *model, const fu_coupling *coupling, const fu_taut_rope *rope,
                          const fu_taut_part *part, const fu_taut_law *law, const fu_equations *equations,
                          fu_system *system);
/* Returns an angle, whole turns added, near another one. */
static inline double fu_near_angle(double angle, double to)
{
    return to + remainder(angle - to, 2.0 * acos(-1.0));
}
/* Returns the rotation of what carries a point, in the plane; the rotation and its rate from which angles of parts in
 * the groove count: in the plane with the carrier, in space on it; at: with its axes. */
double fu_taut_carrier_angle(const fu_taut_point *point, const fu_state *state, const fu_attachment_state *at);
double fu_taut_turn(const fu_taut_point *point, const fu_state *state, const fu_attachment_state *at);
double fu_taut_spin(const fu_model *model, const fu_taut_point *point, const fu_state *state,
                    const fu_attachment_state *at);
/* Computes the state of a point's centre with its axes; velocities are zero where the state has none. */
void fu_taut_centre(const fu_model *model, const fu_taut_point *point, const fu_state *state, fu_attachment_state *out);
/* Returns the drawn length of a rope from its first tangent point to the middle of the wrap at a place, m, and its
 * rate. */
double fu_taut_length_to(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, int place,
                         double *rate);
/* Returns the stress-free length that a wheel at an end of a rope holds beyond that as drawn, m, and its rate; end: 0
 * at the rope's start, 1 at its end. */
double fu_taut_held(const fu_taut_rope *rope, const fu_state *state, const fu_taut_lengths *now, int end, double *rate);

/* Returns the rope beside a point, null for none; side: 0 before it, 1 after it; and the rope beyond an end of one. */
const fu_taut_rope *fu_taut_beside(const fu_model *model, const fu_taut_point *point, int side);
const fu_taut_rope *fu_taut_beyond(const fu_model *model, const fu_taut_rope *rope, int end);

/* Ropes that slip (taut_chain.c, taut_slip.c). Returns whether a rope is part of a chain. */
int fu_taut_slides(const fu_model *model, const fu_taut_rope *rope, const fu_state *state);
/* Computes the chain of a rope; and what its law gives for one of its ropes, from the geometry. */
void fu_taut_chain_at(const fu_model *model, const fu_taut_rope *rope, const fu_state *state, fu_taut_chain *out);
void fu_taut_slide(const fu_taut_chain *chain, const fu_state *state, fu_taut_lengths *out);
/* Computes the changes of the tension of the chain's own rope by one of its ropes, and adds that by its ratio, of which
 * by_ratios has the sum over the ropes after it. */
void fu_taut_slide_law(const fu_model *model, const fu_taut_chain *chain, const fu_state *state, int of,
                       double *by_ratios, fu_taut_law *out);
/* Returns the speed of the rope on a sheave, in its order, m/s; none where it sticks. */
double fu_taut_slip(const fu_model *model, const fu_taut_point *point, const fu_state *state);
/* Lets a rope slip on a point in a direction, or stick. */
void fu_taut_set_slip(const fu_model *model, const fu_taut_point *point, fu_state *state, int direction);
/* Lets a closed rope that slips on all sheaves stick on all but one. */
void fu_taut_close(const fu_model *model, const fu_taut_point *point, fu_state *state);
/* Returns by how much a chain is slack, m, for its first rope; NaN for others. */
double fu_taut_chain_slack(const fu_model *model, const fu_taut_rope *rope, const fu_state *state);
/* Makes a chain taut or slack; finds which it is, from its lengths; finds the directions in which it slips as it
 * becomes taut. */
void fu_taut_set_taut(const fu_model *model, const fu_taut_rope *rope, fu_state *state, int is_taut);
void fu_taut_find_taut(const fu_model *model, const fu_taut_rope *rope, fu_state *state);
void fu_taut_redirect(const fu_model *model, const fu_taut_rope *rope, fu_state *state);

/* Computes how a straight rope passes a sheave that it does not touch. */
void fu_taut_pass(const fu_model *model, const fu_taut_point *point, const fu_state *state, fu_taut_passage *out);
/* Lays a rope on a sheave that it passes; lays it off one, which leaves it straight. */
void fu_taut_touch(const fu_taut_point *point, const fu_taut_passage *at, fu_state *state);
void fu_taut_leave(const fu_taut_point *point, fu_state *state);
/* Returns the angle of the kink along the axis that a rope has on a sheave as its wrap ends, rad. */
double fu_taut_kink(const fu_model *model, const fu_taut_point *point, const fu_state *state);
/* Returns the place along the axis that a rope has as it touches a groove there, m: 0 within rounding. */
double fu_taut_aside(const fu_taut_point *point, double aside);
/* Counts all ropes from a state whose lengths have changed at once, and finds whether that of a point is taut. */
void fu_taut_recount(const fu_model *model, const fu_taut_point *point, fu_state *state);

/* Wheels with inertia (taut_wheel.c). Returns the acceleration of one about its axis at these of the dofs. Add the
 * inertial force at zero accelerations, of an axis that tilts and of a carrier whose coordinates are not rotations, and
 * its derivatives with those of the moment by accelerations, which turns with the carrier. */
double fu_taut_spinning_up(const fu_model *model, const fu_taut_point *point, const fu_state *state, const double *a);
void fu_taut_add_gyration(const fu_model *model, const fu_taut_point *point, const fu_state *state, double *f);
void fu_taut_add_gyration_tangent(const fu_model *model, const fu_taut_point *point, const fu_equations *equations,
                                  fu_system *system);
extern const fu_inertia_operations fu_taut_wheel_inertia;

/* Event functions (events/taut_rope.c): of a point, the angle of its wrap, rad, positive beyond its end; of friction,
 * the difference of both elastic tensions less the limit, N; of a drum, the length in store, m. Of a rope, by how far
 * it is slack, and the length of its shortest part above the least one, m. */
double fu_taut_wrap(const fu_model *model, const fu_taut_point *point, const fu_state *state);
double fu_taut_grip(const fu_model *model, const fu_taut_point *point, const fu_state *state);
/* Returns whether friction holds a rope on a point, by more than rounding. */
int fu_taut_is_held(const fu_model *model, const fu_taut_point *point, const fu_state *state);
/* Returns the direction in which the tensions beside a point pull the rope: 1 in its order, -1 against it. */
int fu_taut_pulled(const fu_model *model, const fu_taut_point *point, const fu_state *state);
double fu_taut_store(const fu_model *model, const fu_taut_point *point, const fu_state *state);
double fu_taut_slack(const fu_model *model, const fu_taut_rope *rope, const fu_state *state);
double fu_taut_margin(const fu_model *model, const fu_taut_rope *rope, const fu_state *state);
/* Returns by how much the parts beside a point that the rope touches exceed the length at which they would slide along
 * its groove, m. */
double fu_taut_fleet_margin(const fu_model *model, const fu_taut_point *point, const fu_state *state);

#endif
