/* Sheaves (couplings/sheave/): the coupling in sheave.c, its state in sheave_state.c, its wrap in wrap.c and
 * wrap_friction.c, its forces in sheave_forces.c, the conditions of its tangent points in sheave_conditions.c and
 * space_conditions.c, and its results in sheave_output.c. Points where friction sticks are couplings of their own,
 * wrap_point.c, which in statics held_wrap.c holds.
 *
 * Derivatives are first by the places and slopes of both nodes, the wheel, and the material coordinates (y); the angles
 * of the wrap follow from the places (z).
 *
 * In space the wrap lies in the plane of the groove, to which all vectors of y and z belong; in the place of the slope
 * of a node is its length, which alone friction and short wraps need. */
#ifndef FUNICULAR_COUPLINGS_SHEAVE_SHEAVE_H
#define FUNICULAR_COUPLINGS_SHEAVE_SHEAVE_H

#include "couplings/common/accelerator.h"
#include "couplings/tangent_point/tangent_point.h"
#include "couplings/wheel/wheel.h"

/* A sheave between the last node of a span and the first of the next (derive/couplings/sheave.py): two tangent points,
 * and the wrap in zones of equal angles. Of a node the place comes first, then the slope. */
typedef struct {
    fu_wheel wheel;
    int nodes[2]; /* dofs: the first of each node */
    int n_zones;
    const int *s; /* dofs: material coordinates of the ends of the zones */
    double tangent_radius[2], tau;
    double friction, slip_velocity; /* coefficient; m/s, see the kernel of friction */
    int wrap_points; /* number of the first of its points where friction sticks, -1 where it is regularised */
    double closing;  /* m: between the last and the first s of a closed rope */
    double least_wrap, no_length; /* rad: of a wrap that stretches; m: of that of a rope that has left */
    double mouth, kink; /* in space: m: half the width of the groove; rad: of a rope that leaves, along the axis */
    /* in space: of the spans before and after: the first dof, elements in all and within reach of a chord, s of their
     * ends, m: the stress-free length of a chord */
    double weight[3], limit, chord[2];
    int span_first[2], span_elements[2], span_reach[2], span_s[4];
    const double *share_before, *share_after; /* of their nodes */
} fu_sheave;

/* --- variables and state --- */

enum { DIM = FU_GROOVE, SPACE = 3, ENDS = 2, MAX_CONDITIONS = FU_MAX_FORCES, MAX_ZONES = 16 };
/* y: of each node the place and the slope; of the wheel the centre, the rotation, the place along the axis, rotations
 * about the vectors of the groove; s of the ends of the zones */
enum { NODE = 2 * DIM, SLOPE = DIM, CENTRE = ENDS * NODE, TURN = CENTRE + FU_WHEEL_TURN };
enum { ACROSS = CENTRE + FU_WHEEL_ACROSS, TILT = CENTRE + FU_WHEEL_TILT };
enum { MATERIAL = CENTRE + FU_WHEEL_FORCES, Y = MATERIAL + MAX_ZONES + 1 };
enum { COLUMNS = ENDS * 2 * SPACE + MAX_ZONES + 2 + FU_ATTACHMENT_COORDINATES };
/* z: the same with the angles of both tangent points in the place of those of the nodes, in the plane of the groove */
enum {
    Z_SLOPE = ENDS,
    Z_CENTRE = Z_SLOPE + ENDS * DIM,
    Z_TURN = Z_CENTRE + FU_WHEEL_TURN,
    Z_ACROSS = Z_CENTRE + FU_WHEEL_ACROSS,
    Z_TILT = Z_CENTRE + FU_WHEEL_TILT,
    Z_MATERIAL = Z_CENTRE + FU_WHEEL_FORCES,
    Z = Z_MATERIAL + MAX_ZONES + 1
};

/* Modes of a sheave that a rope may leave (short_wrap.c): the rope has left it; has a short wrap; a wrap that
 * stretches; in space one whose tangent points are across chords, not slopes. Zero: not known yet. */
enum { FU_LIFTED = 1, FU_SHORT, FU_WRAPPED, FU_CHORDED };

/* A sheave at a state: both tangent points, the angles with their rates and derivatives, and the material. tension: the
 * multiplier of a short wrap, as its user sets it. */
typedef struct {
    const double *q;
    int mode;
    double tension;
    fu_wheel_state wheel;
    double spin_below; /* angular velocity of the sheave as friction has it, see `fu_model.impending` */
    double stretch[ENDS][SPACE], rise[ENDS]; /* in space: direction of the slope; place along the axis, m */
    double aside;                            /* m: in space of the rope in the groove along the axis */
    double s[MAX_ZONES + 1], s_rate[MAX_ZONES + 1], s_acc[MAX_ZONES + 1];
    /* in space a slope is (length, 0), with the rate (that of the length, that of the direction times the length) */
    double x[ENDS][DIM], slope[ENDS][DIM], x_rate[ENDS][DIM], slope_rate[ENDS][DIM];
    double phi[ENDS], phi_rate[ENDS], phi_acc[ENDS];
    /* of the ends of the zones: their shares of the wrap, and their angles */
    double share[MAX_ZONES + 1], angle[MAX_ZONES + 1], angle_rate[MAX_ZONES + 1], angle_acc[MAX_ZONES + 1],
        length[MAX_ZONES];
    double phi_x[ENDS][DIM], phi_xx[ENDS][DIM * DIM], rate_x[ENDS][DIM], acc_x[ENDS][DIM], acc_v[ENDS][DIM];
} fu_sheave_state;

static inline const fu_sheave *sheave_of(const fu_coupling *coupling)
{
    return (const fu_sheave *)coupling;
}

static inline int is_in_space(const fu_sheave *sheave)
{
    return sheave->wheel.foot != 0;
}

/* Returns whether its groove turns with its body, in space. */
static inline int is_turning(const fu_sheave *sheave)
{
    return sheave->wheel.tilts;
}

static inline int has_friction(const fu_sheave *sheave)
{
    return sheave->friction > 0.0;
}

/* Returns whether friction sticks. */
static inline int sticks(const fu_sheave *sheave)
{
    return has_friction(sheave) && sheave->wrap_points >= 0;
}

/* Returns whether friction rises smoothly with the speed. */
static inline int has_smooth_friction(const fu_sheave *sheave)
{
    return has_friction(sheave) && !sticks(sheave);
}

/* Returns whether a wrap in this mode stretches on its own. */
static inline int fu_stretches(int mode)
{
    return mode >= FU_WRAPPED;
}

/* The place along the axis, m, in which a rope lies in the groove; not known before the start. */
typedef struct {
    double is_known, aside;
} fu_place_in_groove;
enum { FU_SHEAVE_NUMBERS = sizeof(fu_place_in_groove) / sizeof(double) };

static inline fu_place_in_groove *fu_place_in(const fu_sheave *sheave, const fu_state *state)
{
    const fu_coupling *base = &sheave->wheel.base;
    return (fu_place_in_groove *)(state->numbers + base->numbers + base->n_numbers);
}

/* Returns the number of conditions of a tangent point. */
static inline int conditions_of(const fu_sheave *sheave)
{
    return is_in_space(sheave) ? FU_FOOT_CONDITIONS : DIM;
}

/* Returns the number of the condition of a short wrap, after those of the tangent points; of a rope that has left, that
 * of its point next to the centre, after those that join both spans. */
static inline int short_row(const fu_sheave *sheave)
{
    return ENDS * conditions_of(sheave);
}

/* Returns the number of the first condition of the wrap alone: of a short wrap, or of the length of one that has left.
 * After it, in both modes, are those that keep the zones equal. */
static inline int first_row_of_wrap(const fu_sheave *sheave, int mode)
{
    return short_row(sheave) + (mode == FU_LIFTED);
}

static inline int fu_may_leave(const fu_sheave *sheave)
{
    return sheave->wheel.base.n_forces > short_row(sheave);
}

/* Returns the number of points of smooth friction at a state: ends of zones; in a short wrap one, in its middle. */
static inline int friction_points(const fu_sheave *sheave, const fu_sheave_state *at)
{
    return !has_smooth_friction(sheave) || at->mode == FU_LIFTED ? 0 : at->mode == FU_SHORT ? 1 : sheave->n_zones + 1;
}

/* Returns the stress-free length of the wrap, m. */
static inline double wrap_length(const fu_sheave *sheave, const fu_sheave_state *at)
{
    return at->s[sheave->n_zones] - at->s[0];
}

/* Returns the mode in a state. */
static inline int *fu_wrap_flag(const fu_sheave *sheave, const fu_state *state)
{
    return state->flags + sheave->wheel.base.flags;
}

/* Returns the tangent point where the rope runs on (k = 0) or off (1), in space. Small wraps have slopes in the place
 * of chords, in which both spans join where the wrap vanishes. Their chords have no sag: it would change at once where
 * the tension of a chord falls to zero in a wave along the rope. */
static inline fu_foot fu_foot_of(const fu_sheave *sheave, const fu_sheave_state *at, int k)
{
    static const double no_weight[SPACE] = {0.0};
    const int is_chorded = at->mode == FU_CHORDED;
    return (fu_foot){.wheel = &sheave->wheel,
                     .is_start = k,
                     .node = sheave->nodes[k],
                     .first = sheave->span_first[k],
                     .n_elements = sheave->span_elements[k],
                     .reach = sheave->span_reach[k],
                     .s = sheave->span_s + 2 * k,
                     .share = k ? sheave->share_after : sheave->share_before,
                     .chord = sheave->chord[k],
                     .radius = sheave->tangent_radius[k],
                     .weight = is_chorded ? sheave->weight : no_weight,
                     .limit = sheave->limit,
                     .by_chord = is_chorded,
                     .aside = at->aside};
}

/* Returns the number of variables z of a sheave. */
static inline int size_of_z(const fu_sheave *sheave)
{
    return Z_MATERIAL + sheave->n_zones + 1;
}

/* --- sheave_state.c --- */

/* Computes a sheave at a state, with these accelerations of the dofs (null: zero). */
void fu_sheave_at(const fu_model *model, const fu_sheave *sheave, const fu_state *state, const double *a,
                  fu_sheave_state *out);
/* Returns the stretch of the span at a tangent point. */
double fu_stretch_at(const fu_sheave_state *at, int k);

/* --- wrap.c: zones, by z --- */

/* A zone of the wrap: of both ends the shares of the wrap and the angles; its length; `first` of the ends of all
 * zones. */
typedef struct {
    const double *share, *phi, *phi_rate, *phi_acc, *s_rate, *s_acc;
    double l;
    int first;
} fu_zone;

static inline fu_zone fu_zone_at(const fu_sheave_state *at, int j)
{
    return (fu_zone){at->share + j,  at->angle + j, at->angle_rate + j, at->angle_acc + j,
                     at->s_rate + j, at->s_acc + j, at->length[j],      j};
}

/* Adds the inertial forces. */
void fu_wrap_add_inertia(const fu_sheave *sheave, const fu_sheave_state *at, double *z);
/* Adds all other forces: of both energies, of damping and friction. */
void fu_wrap_add_forces(const fu_sheave *sheave, const fu_sheave_state *at, double *z);
/* Adds the mass matrix. */
void fu_wrap_add_mass(const fu_sheave *sheave, const fu_sheave_state *at, double factor, double (*M)[Z]);
/* Adds the derivatives of the inertial forces by rates and places. */
void fu_wrap_add_inertia_matrices(const fu_sheave *sheave, const fu_sheave_state *at, double factor, double (*D)[Z],
                                  double (*K)[Z]);
/* Adds the derivatives of the other forces by rates and places. */
void fu_wrap_add_matrices(const fu_sheave *sheave, const fu_sheave_state *at, double factor, double (*D)[Z],
                          double (*K)[Z]);

/* --- turning_wrap.c: zones in a groove that turns, by z --- */

/* Add the inertial forces of the zones; their mass matrix; and the moments of their weight with its derivatives (M
 * null: none). */
void fu_turning_wrap_add_inertia(const fu_sheave *sheave, const fu_sheave_state *at, double *z);
void fu_turning_wrap_add_mass(const fu_sheave *sheave, const fu_sheave_state *at, double factor, double (*M)[Z]);
void fu_turning_wrap_add_weight(const fu_sheave *sheave, const fu_sheave_state *at, double *z);
void fu_turning_wrap_add_weight_matrix(const fu_sheave *sheave, const fu_sheave_state *at, double factor,
                                       double (*K)[Z]);
/* Returns the kinetic energy. */
double fu_turning_wrap_energy(const fu_sheave *sheave, const fu_sheave_state *at);
/* Adds the derivatives of the forces `y` by rotations of the groove; moves: those of the columns. */
void fu_turning_wrap_add_turning(const fu_model *model, const fu_sheave *sheave, const fu_sheave_state *at,
                                 const fu_centre_moves *moves, const double y[Y], double factor, fu_system *system);

/* --- short_wrap.c --- */

#define FU_LEAST_CHORDED 0.1 /* rad: of wraps that have chords */

/* Returns the mode of a sheave in a state, where it is not known by the angles and the length of its wrap. */
int fu_wrap_mode(const fu_sheave *sheave, const fu_sheave_state *at, const fu_state *state);
/* Returns the least length of the wrap, m, at which its inertia and weight are computed. */
double fu_least_length(const fu_sheave *sheave);
/* Adds the forces of a short wrap by z, that of its condition included, and their derivatives; returns its energy. */
void fu_short_wrap_add_forces(const fu_sheave *sheave, const fu_sheave_state *at, double *z);
void fu_short_wrap_add_matrix(const fu_sheave *sheave, const fu_sheave_state *at, double factor, double (*K)[Z]);
double fu_short_wrap_energy(const fu_sheave *sheave, const fu_sheave_state *at);
/* Compute the residual of its condition and the derivatives J by y; its second rate at zero accelerations. */
double fu_short_wrap_row(const fu_sheave *sheave, const fu_sheave_state *at, double J[Y]);
double fu_short_wrap_drift(const fu_sheave *sheave, const fu_sheave_state *at);
/* Computes the residual of a condition that joins both spans in the plane, or from number NODE on of the length of the
 * wrap, and the derivatives J by y. */
void fu_join_row(const fu_sheave *sheave, const fu_sheave_state *at, int r, double *phi, double J[Y]);
/* The same of the condition that keeps the j-th point between zones at its share of the wrap. */
void fu_share_row(const fu_sheave *sheave, const fu_sheave_state *at, int j, double *phi, double J[Y]);

/* --- wrap_friction.c: points between zones, by z --- */

/* Computes the forces of the j-th point on its angle, the rotation and its s; its slip and limit; and its power. */
void fu_friction_at(const fu_sheave *sheave, const fu_sheave_state *at, int j, double *F, double numbers[3],
                    double *power);
/* Adds the forces of the j-th point. */
void fu_friction_add_forces(const fu_sheave *sheave, const fu_sheave_state *at, int j, double *z);
/* Adds the derivatives of friction at the j-th point. */
void fu_friction_add_matrices(const fu_sheave *sheave, const fu_sheave_state *at, int j, double factor, double (*D)[Z],
                              double (*K)[Z]);

/* Returns whether friction acts at the j-th point: in a short wrap at the first alone, which is in its middle. */
static inline int fu_point_acts(const fu_sheave_state *at, int j)
{
    return fu_stretches(at->mode) || (at->mode == FU_SHORT && j == 0);
}

/* Return the angle and the material coordinate of such a point. */
static inline double fu_angle_of_point(const fu_sheave_state *at, int j)
{
    return at->mode == FU_SHORT ? 0.5 * (at->phi[0] + at->phi[1]) : at->angle[j];
}
static inline double fu_s_of_point(const fu_sheave *sheave, const fu_sheave_state *at, int j)
{
    return at->mode == FU_SHORT ? 0.5 * (at->s[0] + at->s[sheave->n_zones]) : at->s[j];
}

/* Coulomb friction at a point: the speed of sliding w, the limit of |f|, the rates of the angle, the rotation and s,
 * the derivatives of w by these, and the forces of a unit of f on them. All are zero at a point where it does not act.
 */
enum { FU_SLIDING = 3 };
typedef struct {
    double w, limit, rate[FU_SLIDING], row[FU_SLIDING], column[FU_SLIDING];
} fu_coulomb;
void fu_coulomb_at(const fu_sheave *sheave, const fu_sheave_state *at, int j, fu_coulomb *out);
/* Adds the derivatives of Coulomb friction, held by a multiplier, or at its limit in a direction. */
void fu_coulomb_add_matrices(const fu_sheave *sheave, const fu_sheave_state *at, int j, double held, double direction,
                             double factor, double (*D)[Z], double (*K)[Z]);
/* Returns the rate of w at the accelerations of `at`, and the sum of the sizes of its terms. */
double fu_coulomb_rate(const fu_sheave *sheave, const fu_sheave_state *at, int j, const fu_coulomb *of, double *size);
/* Computes forces by z from those on the angle of a point, the rotation and s. */
void fu_point_by_z(const fu_sheave *sheave, const fu_sheave_state *at, int j, const double forces[FU_SLIDING],
                   double z[Z]);

/* --- wrap_point.c --- */

/* The end of a zone at which friction sticks: the number of its sheave among all couplings; its place in the wrap. Its
 * flag is its mode. Of a short wrap the first stands for the middle. held: of statics, see held_wrap.c. */
typedef struct {
    fu_coupling base;
    int sheave, place;
    struct {
        int is_held;
        double s, angle, turn; /* m; rad: on the carrier, and of the sheave on it */
        double stretch[2];     /* of the spans beyond both tangent points */
    } held;
} fu_wrap_point;
extern const fu_coupling_type fu_wrap_point_type;

/* Modes of a point: without friction, as in statics where no rope is about to slide, and where it does not act; others
 * are directions. */
enum { FU_SLIDES_BACKWARDS = -1, FU_POINT_IS_FREE, FU_SLIDES_FORWARDS, FU_STICKS };

int *fu_wrap_point_flag(const fu_coupling *coupling, const fu_state *state);
/* Return the place of a point in its wrap; its sheave. */
int fu_place_of_point(const fu_coupling *coupling);
const fu_sheave *fu_sheave_of_point(const fu_model *model, const fu_coupling *coupling);
/* Computes Coulomb friction at a point in a state. */
void fu_wrap_point_at(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_coulomb *out);

/* Friction at a point of a wrap, by its place; without multipliers of eq 38 by those of the state. */
typedef struct {
    fu_coulomb at;
    double f, slips; /* N; 1 or -1 where it slides, a part of that where it is about to in statics, else 0 */
} fu_wrap_force;
void fu_wrap_force_at(const fu_model *model, const fu_sheave *sheave, const fu_sheave_state *at, int j,
                      const fu_state *state, const double *multipliers, fu_wrap_force *out);

/* Adds the force f of a point by y, with the forces of a unit of it. */
void fu_wrap_force_by_y(const fu_sheave *sheave, const fu_sheave_state *at, int j, double f,
                        const double column[FU_SLIDING], double y[Y]);

/* --- held_wrap.c, see rope.h, too --- */

/* Returns by how much the rope has slid at the j-th point, m, and computes the stretch of the material held there. */
double fu_held_slip(const fu_model *model, const fu_sheave *sheave, const fu_sheave_state *at, int j, double *stretch);
/* Holds the material at a point of the wrap where it lies. */
void fu_hold_at(const fu_sheave *sheave, const fu_sheave_state *at, fu_wrap_point *point);

/* --- sheave_forces.c: by y --- */

/* Adds forces by z to those by y. */
void fu_sheave_add_by_angles(const fu_sheave *sheave, const fu_sheave_state *at, const double *of_z, double *y);
/* Adds the derivatives of forces by z, D_z by rates, K_z by places, to those by y. */
void fu_sheave_add_matrices(const fu_sheave *sheave, const fu_sheave_state *at, double factor, const double *of_z,
                            double (*D_z)[Z], double (*K_z)[Z], double (*D)[Y], double (*K)[Y]);

/* Computes the dofs of a sheave and the changes of y by them, with these of the centre; returns their number. */
int fu_sheave_columns(const fu_sheave *sheave, const fu_sheave_state *at, const fu_centre_moves *moves,
                      fu_wheel_column *out);
/* Computes all forces but those of the tangent points, or the inertial ones alone. */
void fu_sheave_forces(const fu_sheave *sheave, const fu_sheave_state *at, double y[Y]);
void fu_sheave_inertial_forces(const fu_sheave *sheave, const fu_sheave_state *at, double y[Y]);
/* Adds forces by y to those on the dofs. */
void fu_sheave_scatter(const fu_sheave *sheave, const fu_sheave_state *at, const double *y, double *f);
/* Adds the derivatives of forces by y on the lengths of slopes in space, as these turn. */
void fu_sheave_add_turn_of_slopes(const fu_model *model, const fu_sheave *sheave, const fu_sheave_state *at,
                                  const double y[Y], double factor, fu_system *system);
/* Adds the mass matrix. */
void fu_sheave_add_mass(const fu_sheave *sheave, const fu_sheave_state *at, double factor, double (*K)[Y]);
/* Adds the derivatives of all forces but those of the tangent points: D by rates, K by places. */
void fu_sheave_add_derivatives(const fu_sheave *sheave, const fu_sheave_state *at, fu_weights w, double (*D)[Y],
                               double (*K)[Y]);
/* Compute the kinetic energy and that of gravity, J, along the axis, in space. */
void fu_sheave_energies_across(const fu_sheave *sheave, const fu_sheave_state *at, double *T, double *V);

/* --- sheave_conditions.c: tangent points --- */

/* Returns the number of conditions at a state; others of the coupling are left out. */
int fu_sheave_conditions(const fu_sheave *sheave, const fu_sheave_state *at);
/* Adds the forces of the tangent points by y, in space without those on the chords; computes the residuals phi. */
void fu_sheave_add_multipliers(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers,
                               double *phi, double *y);
/* Adds all these forces: in the plane by y, in space to those on the dofs. */
void fu_sheave_add_all_multipliers(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers,
                                   double *phi, double *y, double *f);
/* Adds the derivatives of the conditions, and of their forces, to a system, and in the plane to K_y. `rows` and
 * `columns`: of the n dofs; by_psi: moves of the centre in the latter. */
void fu_sheave_add_conditions(const fu_model *model, const fu_coupling *coupling, const fu_sheave_state *at,
                              const fu_equations *equations, int n, const fu_wheel_column *rows,
                              const fu_wheel_column *columns, const fu_centre_moves *by_psi, double (*K_y)[Y],
                              fu_system *system);
/* Operations of the coupling. */
void fu_sheave_rows(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_accelerator *work);

/* Computes the residuals of the conditions of the wrap alone, and the derivatives J by y. */
void fu_sheave_rows_of_wrap(const fu_sheave *sheave, const fu_sheave_state *at, double phi[MAX_CONDITIONS],
                            double J[MAX_CONDITIONS][Y]);
/* Computes the derivatives J of the conditions by y in the plane, and their residuals, at these x and slopes. */
void fu_sheave_rows_at(const fu_sheave *sheave, const fu_sheave_state *at, double J[MAX_CONDITIONS][Y],
                       double phi[MAX_CONDITIONS]);

/* --- space_conditions.c: conditions in space but those of the wrap alone --- */

/* Add their forces to those on the dofs; or by y without those on the chords; compute the residuals. */
void fu_space_add_multipliers(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers,
                              double *phi, double *f);
void fu_space_add_multipliers_by_y(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers,
                                   double *phi, double *y);
/* Adds their derivatives, and those of their forces; by_psi: moves of the centre in the columns. */
void fu_space_add_conditions(const fu_model *model, const fu_coupling *coupling, const fu_sheave_state *at,
                             const fu_equations *equations, const fu_centre_moves *by_psi, fu_system *system);
/* Computes the rows of eq 38 of all conditions in space. */
void fu_space_rows(const fu_model *model, const fu_sheave *sheave, const fu_state *state, fu_rows *out);

/* --- over a step that conserves energy (derive/couplings/sheave_step.py, turning_step.py): shared types --- */

enum { FU_ZONE_POINTS = 8 }; /* of the momentum along a zone */

/* Returns the dimension of the momentum at a point of a zone. */
static inline int momentum_dim(const fu_sheave *sheave)
{
    return is_in_space(sheave) ? SPACE : DIM;
}

/* Returns where the momentum at a point of a zone stands in the history; after those of all zones stands the spin. */
static inline int momentum_number(const fu_sheave *sheave, int zone, int point)
{
    return (zone * FU_ZONE_POINTS + point) * momentum_dim(sheave);
}

/* A sheave over a step: at its start, at its end, half-way (with the mean places of nodes); half the turns of both
 * tangent points, and the forces along k x x~ of moments on these; the centre at the start, its change, and that of s.
 * In space the turns are those from the groove, the centre is taken as zero, and x are the mean places of the tangent
 * points from the centre. spin: angular velocities of the wheel at both ends, whose mean is the rotation. */
typedef struct {
    fu_sheave_state now, next, middle;
    double half[ENDS], arm[ENDS], c[DIM], c_change[DIM], s_change[MAX_ZONES + 1], x[ENDS][SPACE], spin[2];
    fu_groove_step groove;
} fu_sheave_over;

/* Forces over a step: moments on the turns of both tangent points by their measures, and the rest of z; in space the
 * force on the centre and the moment about it. */
typedef struct {
    double turn[ENDS], centre[DIM], wheel, s[MAX_ZONES + 1], force[SPACE], moment[SPACE];
} fu_sheave_step_forces;

/* A point of a zone: its number, its part of the zone and its weight there. */
typedef struct {
    int zone;
    double xi, weight;
} fu_zone_point;

/* --- step_view.c --- */

/* Computes a sheave over a step. */
void fu_sheave_over_step(const fu_model *model, const fu_sheave *sheave, const fu_equations *at, fu_sheave_over *out);
/* Adds a moment on the turn at a part of the wrap. */
void fu_add_turn(const fu_sheave_over *step, double part, double moment, fu_sheave_step_forces *out);
/* Adds a moment on the angle of the wrap. */
void fu_add_opening(const fu_sheave_over *step, double moment, fu_sheave_step_forces *out);
/* Returns the angular velocity of the wheel, a history variable after the momenta; by velocities where these are not
 * known. */
double fu_sheave_spin(const fu_sheave *sheave, const fu_sheave_state *at, const fu_state *state);
/* Returns x/sin(x). */
double fu_over_sine(double x);

/* --- space_step.c --- */

/* Computes the momentum at a point of a zone by velocities. */
void fu_space_momentum(const fu_sheave *sheave, const fu_sheave_state *at, const fu_zone_point *point, double P[SPACE]);
/* Adds the inertial forces of a point of a zone with the momentum P (null: none); computes it at the end of the step.
 */
void fu_space_point_over_step(const fu_sheave *sheave, const fu_sheave_over *step, const fu_zone_point *point, double h,
                              const double P[SPACE], fu_sheave_step_forces *out, double P_next[SPACE]);
/* Returns the kinetic energy of the wrap. */
double fu_space_wrap_energy(const fu_sheave *sheave, const fu_sheave_state *at);
/* Adds the weight but for that of the places from the centre in the groove. */
void fu_space_add_weight(const fu_sheave *sheave, const fu_sheave_over *step, fu_sheave_step_forces *out);
/* Adds these forces to those on the dofs. */
void fu_space_add_step_forces(const fu_sheave *sheave, const fu_sheave_over *step, const fu_sheave_step_forces *of,
                              double *f);
/* Adds all these forces and those of the conditions to those on the dofs; computes the residuals. */
void fu_space_over_step(const fu_sheave *sheave, const fu_sheave_over *step, const fu_equations *at,
                        const fu_sheave_step_forces *of, const double *multipliers, double *phi, double *f);

/* --- sheave_step.c: operations of the coupling over a step --- */

/* Adds forces to those on the dofs; returns their work over the step, J. */
void fu_sheave_add_step_forces(const fu_sheave *sheave, const fu_sheave_over *step, const fu_sheave_step_forces *of,
                               double *f);
double fu_sheave_step_power(const fu_sheave *sheave, const fu_sheave_over *step, const fu_equations *at,
                            const fu_sheave_step_forces *of);
/* Returns the turn of the wheel about its axis over the step, in space from the groove. */
double fu_turn_of_wheel(const fu_sheave *sheave, const fu_sheave_over *step, const fu_equations *at);
int fu_sheave_history_size(const fu_coupling *coupling);
void fu_sheave_history_over_step(const fu_model *model, const fu_coupling *coupling, const fu_equations *at);
void fu_sheave_velocities(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double since);
void fu_sheave_history_jump(const fu_model *model, const fu_coupling *coupling, fu_state *state, const double *change);
double fu_sheave_energy_beyond_velocities(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
void fu_sheave_step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                             double *internal);
double fu_sheave_step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at);

/* --- sheave_output.c --- */

extern const fu_output fu_sheave_output_fields[];
void fu_sheave_outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                       const double *acceleration, const fu_accelerator *work, double *out);

#endif
