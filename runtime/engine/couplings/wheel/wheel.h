/* Wheels: what sheaves and drums share. A wheel has a centre at an attachment, a rotation with inertia about its axis,
 * a bearing on its carrier, and a drive. */
#ifndef FUNICULAR_COUPLINGS_WHEEL_WHEEL_H
#define FUNICULAR_COUPLINGS_WHEEL_WHEEL_H

#include "couplings/common/attachments.h"
#include "couplings/common/coupling.h"

enum { FU_GROOVE = 2 }; /* dimension of the plane of the groove */

/* First member of a sheave and of a drum. g: gravity in the axes of the groove; of one that turns in those of the
 * ground. In space: kernels of tangent points (null in the plane); whether the groove
 * turns with its body, so that it has the axes of the attachment, else the vectors of its plane (3 x 2) and the axis.
 */
typedef struct {
    fu_coupling base;
    const fu_sheave_kernels *kernel;
    fu_attachment attachments[1];          /* the centre */
    int turn;                              /* dof: the rotation, -1 for none */
    double radius, sense, rho, g[3], A[2]; /* to the axis of the rope; and of the rope itself */
    double inertia, damping;               /* kg m^2, N m s */
    int torque_signal;                     /* of the torque on the wheel, -1 for a constant one */
    double torque;                         /* N m: the factor of the signal */
    const fu_tangent_point_kernels *foot;
    int tilts;
    double groove[6], axis[3];
} fu_wheel;

/* The fields of a wheel in the plane. */
#define FU_WHEEL_FIELDS                                                                                                \
    FU_FIELD_ARRAY(fu_wheel, attachments, FU_ATTACHMENT), FU_FIELD(fu_wheel, turn, FU_INTEGER, 0),                     \
        FU_FIELD(fu_wheel, radius, FU_REAL, 0), FU_FIELD(fu_wheel, sense, FU_REAL, 0),                                 \
        FU_FIELD(fu_wheel, rho, FU_REAL, 0), FU_FIELD_ARRAY(fu_wheel, g, FU_REAL),                                     \
        FU_FIELD_ARRAY(fu_wheel, A, FU_REAL), FU_FIELD(fu_wheel, inertia, FU_REAL, 0),                                 \
        FU_FIELD(fu_wheel, damping, FU_REAL, 0), FU_FIELD(fu_wheel, torque_signal, FU_INTEGER, 0),                     \
        FU_FIELD(fu_wheel, torque, FU_REAL, 0)

/* The fields of a wheel in space. */
#define FU_WHEEL_FIELDS_IN_SPACE                                                                                       \
    FU_FIELD(fu_wheel, tilts, FU_INTEGER, 0), FU_FIELD_ARRAY(fu_wheel, groove, FU_REAL),                               \
        FU_FIELD_ARRAY(fu_wheel, axis, FU_REAL)

enum { FU_TILTS = 2 }; /* rotations of a groove about the vectors of its plane */

/* A wheel at a state: in space its groove and axis; gravity in the axes of the groove; of a groove that turns the
 * angular velocity and its rate, likewise; its centre in the plane of the groove (c) and along the axis (across), and
 * its rotation; own: in the bearing. */
typedef struct {
    fu_attachment_state centre;
    double groove[6], axis[3], g[3], omega[3], omega_acc[3];
    double c[FU_GROOVE], c_rate[FU_GROOVE], c_acc[FU_GROOVE], c_bias[FU_GROOVE], across, across_rate, across_acc,
        acc[3];
    double own_rate, turn_rate, turn_acc;
} fu_wheel_state;

/* Forces on a wheel: on the centre in the plane of the groove, about the axis, on the centre along the axis; about the
 * vectors of the plane of a groove that turns. */
enum { FU_WHEEL_TURN = FU_GROOVE, FU_WHEEL_ACROSS, FU_WHEEL_TILT, FU_WHEEL_FORCES = FU_WHEEL_TILT + FU_TILTS };

/* Changes of the centre and rotations of its axes by the unknowns of the attachment (dim or turns x coordinates). */
typedef struct {
    double P[3 * FU_ATTACHMENT_COORDINATES], T[3 * FU_ATTACHMENT_COORDINATES];
} fu_centre_moves;

/* The change by a dof of the variables of a wheel and its rope: n of them from number `row` on. */
typedef struct {
    int dof, row, n;
    double value[FU_WHEEL_FORCES];
} fu_wheel_column;

/* Computes a wheel at a state, with these accelerations of the dofs. */
void fu_wheel_at(const fu_model *model, const fu_wheel *wheel, const fu_state *state, const double *a,
                 fu_wheel_state *out);
/* Computes the parts of a vector in the plane of the groove, in space. */
void fu_into_groove(const fu_wheel_state *at, const double *vector, double out[FU_GROOVE]);
/* Computes a vector from its parts in the plane of the groove, in space. */
void fu_out_of_groove(const fu_wheel_state *at, const double *parts, double out[3]);
/* Computes the place in the plane of the groove of a point r from the centre, and its first and second rates, in space;
 * of a groove that turns as in derive/couplings/turning_wheel.py. */
void fu_from_centre(const fu_wheel *wheel, const fu_wheel_state *at, const double *r, const double *v, const double *a,
                    double x[FU_GROOVE], double rate[FU_GROOVE], double acc[FU_GROOVE]);
/* Computes the force on the centre from forces on a wheel. */
void fu_wheel_force(const fu_wheel *wheel, const fu_wheel_state *at, const double *forces, double out[3]);
/* Adds forces on a wheel to those on the dofs. */
void fu_wheel_add_forces(const fu_wheel *wheel, const fu_wheel_state *at, const double *forces, double *f);
/* Adds the moment of the bearing, between the wheel and its carrier. */
void fu_wheel_add_bearing(const fu_wheel *wheel, const fu_wheel_state *at, double *f);
/* Compute the moves of the centre by its coordinates, and by the unknowns of its attachment. */
void fu_wheel_moves(const fu_model *model, const fu_wheel_state *at, fu_centre_moves *out);
void fu_wheel_by_psi(const fu_model *model, const fu_wheel *wheel, const fu_wheel_state *at, const double *psi,
                     fu_centre_moves *out);
/* Computes the columns of the rotation and of the centre with these moves; first: number of the first force among the
 * variables. Returns their number. */
int fu_wheel_columns(const fu_wheel *wheel, const fu_wheel_state *at, const fu_centre_moves *moves, int first,
                     fu_wheel_column *out);
/* Returns the product of a column and a row of derivatives by the variables. */
static inline double fu_by_column(const fu_wheel_column *column, const double *row)
{
    double sum = 0.0;
    for (int k = 0; k < column->n; ++k) sum += column->value[k] * row[column->row + k];
    return sum;
}
/* Adds rows' K columns of K (n_variables x n_variables) to a system; n columns each. */
void fu_wheel_add_matrix(const fu_model *model, int n, const fu_wheel_column *rows, const fu_wheel_column *columns,
                         int n_variables, const double *K, fu_system *system);
/* Adds the derivatives of the bearing's moment, and of forces on the wheel with the motion of its carrier, at fixed
 * ones. */
void fu_wheel_add_tangent(const fu_model *model, const fu_wheel *wheel, const fu_wheel_state *at,
                          const fu_equations *equations, const double *forces, fu_system *system);
/* Adds the latter alone. */
void fu_wheel_add_carried(const fu_model *model, const fu_wheel *wheel, const fu_wheel_state *at,
                          const fu_equations *equations, const double *forces, fu_system *system);
/* A force on a node at a tangent point, in the plane of a groove that turns: the first dof of the node, its place from
 * the centre. */
typedef struct {
    int node;
    double arm[3], force[3];
} fu_turning_force;
/* Adds the derivatives of such forces, of their opposites on the centre, and of the moments among the forces on the
 * wheel, by rotations of the groove that turns them, and by moves of the nodes out of its plane. */
void fu_wheel_add_turning(const fu_model *model, const fu_wheel_state *at, const fu_centre_moves *moves, int n,
                          const fu_turning_force *on_nodes, const double *forces, double factor, fu_system *system);
/* Adds the moments of a wheel, and of the rope wound on it, that spins about an axis that tilts to forces on the wheel;
 * inertia: about a diameter and about the axis, growth: rate of the first. Returns the kinetic energy about diameters.
 */
double fu_wheel_add_ring(const fu_wheel *wheel, const fu_wheel_state *at, const double inertia[2], double growth,
                         double *forces);
/* Returns the normal force on an angle, N: of a tension at an angle, a speed and a stretch of the rope. */
double fu_wheel_pressure(const fu_wheel *wheel, const fu_wheel_state *at, double phi, double tension, double speed,
                         double stretch);
/* Returns the part of gravity, and of the acceleration of the centre, outwards at an angle, m/s^2. */
double fu_wheel_outwards(const fu_wheel_state *at, double phi);

/* A groove in space over a step that conserves energy: means of the vectors of its plane (3 x 2) and of the axis; its
 * turn by the Cayley vector; changes of its centre; gravity, and its mean in the groove. */
typedef struct {
    double axes[3 * FU_GROOVE], axis[3], theta[3], c_change[3], gravity[3], g[FU_GROOVE];
} fu_groove_step;
/* Computes the groove over a step, in the plane the turn alone; and, half-way, moves and turns of the centre by the
 * unknowns of its carrier. */
void fu_groove_over_step(const fu_model *model, const fu_wheel *wheel, const fu_equations *at,
                         const fu_wheel_state *now, const fu_wheel_state *next, fu_wheel_state *middle,
                         fu_groove_step *out);
/* Returns the rotation of the wheel about its axis over a step. */
double fu_wheel_turn(const fu_wheel *wheel, const fu_groove_step *groove, const fu_equations *at);
/* Computes the mean place of a node from the centre, in space. */
void fu_mean_from_centre(int node, const fu_equations *at, const fu_wheel_state *now, const fu_wheel_state *next,
                         double out[3]);
/* Adds the moments of a wheel whose angular velocity changes over a step h, and its angular momentum about its axis
 * turns with it; returns that on the rotation on its carrier. */
double fu_wheel_add_spin(const fu_wheel *wheel, double from, double to, const fu_groove_step *groove, double h,
                         double moment[3]);
extern const fu_supply_operations fu_wheel_supply;
/* Subtracts the torque of the drive. */
void fu_wheel_drive(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double *f);
int fu_wheel_may_be_open(const fu_model *model, const fu_coupling *coupling, const fu_state *state);

#endif
