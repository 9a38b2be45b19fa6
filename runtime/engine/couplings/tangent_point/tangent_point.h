/* Tangent points in space (derive/couplings/tangent_point.py). */
#ifndef FUNICULAR_COUPLINGS_TANGENT_POINT_TANGENT_POINT_H
#define FUNICULAR_COUPLINGS_TANGENT_POINT_TANGENT_POINT_H

#include "couplings/wheel/wheel.h"

/* Gauss points on (0, 1) and their weights, of mean gradients along a step that conserves energy. */
enum { FU_STEP_POINTS = 5 };
static const double fu_part_of_step[FU_STEP_POINTS] = {0.04691007703066800, 0.23076534494715845, 0.5,
                                                       0.76923465505284155, 0.95308992296933200},
                    fu_weight_in_step[FU_STEP_POINTS] = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                                         0.23931433524968324, 0.11846344252809454};

/* A node of a wheel at the start of a span, or at its end; of the span the first dof, elements in all and within reach
 * of the chord, s of its ends, shares of its nodes; m: the stress-free length of the chord, and the radius to the
 * tangent point; half the weight of a length, and the tension over the length of a chord below which its sag has its
 * limit, N/m; by_chord: 1 where the radius is across the chord, 0 where it is across the slope; aside: m, the place of
 * the rope in the groove along the axis. */
typedef struct {
    const fu_wheel *wheel;
    int is_start, node, first, n_elements, reach;
    const int *s;
    const double *share, *weight;
    double chord, radius, limit, by_chord, aside;
} fu_foot;

enum {
    FU_FOOT_CONDITIONS = 3,
    FU_FOOT_VECTORS = 13, /* x, slope, chord, its stress-free length b; where the groove turns the axis */
    FU_FOOT_ELEMENT = 12,
    FU_FOOT_CENTRE = 6 + FU_FOOT_ELEMENT + 2, /* where the coordinates of the centre are among the dofs */
    FU_FOOT_DOFS = FU_FOOT_CENTRE + FU_ATTACHMENT_COORDINATES
};

/* A tangent point at a state; x is from the centre of the circle on which the rope lies. Its n dofs, those of the node,
 * of the element in which the chord ends, s of both ends of the span, and the coordinates of the centre, some of them
 * twice; the conditions and their derivatives by n_vectors numbers, x, the slope, the chord, b and the axis where it
 * turns (J, K), and the changes of these by the dofs. K: of J' multipliers. */
typedef struct {
    int n, n_vectors, dofs[FU_FOOT_DOFS];
    double phi[FU_FOOT_CONDITIONS], J[FU_FOOT_CONDITIONS * FU_FOOT_VECTORS], K[FU_FOOT_VECTORS * FU_FOOT_VECTORS];
    double by[FU_FOOT_VECTORS][FU_FOOT_DOFS], N_L[4], chord[3], chord_L[3], chord_LL[3], b, aside;
} fu_tangent_point;

/* Computes a tangent point with these multipliers. */
void fu_tangent_point_at(const fu_foot *foot, const fu_wheel_state *wheel, const double *q, const double *multipliers,
                         fu_tangent_point *out);
/* Computes the changes of x and the axis by the coordinates of the centre anew, from its moves. */
void fu_tangent_point_turn(const fu_wheel_state *wheel, const fu_centre_moves *moves, fu_tangent_point *at);
/* Adds n_rows of its rows from number `first` on, and the columns of their forces, to a system whose unknown `own` is
 * that of the first of them, with these scales; multipliers: of all rows, zero of others; moves: those of the columns.
 */
void fu_tangent_point_add(const fu_model *model, const fu_wheel_state *wheel, const fu_tangent_point *at,
                          const fu_centre_moves *moves, const double *multipliers, const double *scale, fu_weights w,
                          int first, int n_rows, int own, fu_system *system);
/* Computes the derivatives of the conditions by the dofs (conditions x n). */
void fu_tangent_point_rows(const fu_tangent_point *at, double *rows);
/* Computes the derivatives of the forces J' multipliers on the dofs (n x n) by those of `columns`. */
void fu_tangent_point_stiffness(const fu_wheel_state *wheel, const fu_tangent_point *at,
                                const fu_tangent_point *columns, const double *multipliers, double *K);
/* Adds these forces but those on the chord: on the node in the plane of the groove, and on the wheel. */
void fu_tangent_point_add_forces(const fu_wheel_state *wheel, const fu_tangent_point *at, const double *multipliers,
                                 double on_node[FU_GROOVE], double *on_wheel);
/* Computes the second rates of the conditions at zero accelerations of the dofs. */
void fu_tangent_point_bias(const fu_foot *foot, const fu_tangent_point *at, const fu_wheel_state *wheel,
                           const double *q, const double *v, double bias[FU_FOOT_CONDITIONS]);
/* Returns the fleet angle of the chord there, rad: positive where the span leaves the groove along the axis. */
double fu_fleet_angle(const fu_foot *foot, const double *q, const double axis[3]);

/* The point at which a chord ends: its element, and there the distance from the first node and the element's length,
 * and the stress-free length of the chord, with their derivatives by the length of the span. */
typedef struct {
    int element;
    double distance, length, by_L[2], b, b_L;
} fu_chord_end;
/* Returns the end of the chord in a span of the length L. */
fu_chord_end fu_chord_end_at(const fu_foot *foot, double L);

/* The groove over a step: at both ends the places of the centre and the axis, q at both ends. */
typedef struct {
    const double *q[2], *centre[2], *axis[2];
} fu_foot_step;
/* Adds the forces of the conditions of a tangent point across its chord over a step, a discrete gradient of theirs, to
 * those on the dofs of the span, on the centre, and to the moment about it (tangent_point_step.c). */
void fu_tangent_point_over_step(const fu_foot *foot, const fu_foot_step *step, const double *multipliers, double *f,
                                double force[3], double moment[3]);

#endif
