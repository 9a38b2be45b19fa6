/* Drums (couplings/drum/): the coupling in drum.c, its state in drum_state.c, the conditions of its tangent point and
 * of winding in drum_conditions.c, the rope that is wound in drum_history.c and drum_store.c, and steps that conserve
 * energy in drum_step.c. Derivatives are by
 * the place and slope of the node, the wheel, and the wound length (y). In space the wound rope lies in the plane of
 * the groove, to which all vectors of y belong, in one layer; in the place of the slope is its length. */
#ifndef FUNICULAR_COUPLINGS_DRUM_DRUM_H
#define FUNICULAR_COUPLINGS_DRUM_DRUM_H

#include "couplings/common/accelerator.h"
#include "couplings/tangent_point/tangent_point.h"
#include "couplings/wheel/wheel.h"

#include <stddef.h>

enum { DIM = FU_GROOVE, SPACE = 3, NODE = 2 * DIM, MAX_CONDITIONS = FU_FOOT_CONDITIONS + 1 };
/* y: node; centre, rotation, place along the axis and rotations about the vectors of the groove of the wheel; wound
 * length */
enum { SLOPE = DIM, CENTRE = NODE, TURN = CENTRE + FU_WHEEL_TURN, ACROSS = CENTRE + FU_WHEEL_ACROSS };
enum { TILT = CENTRE + FU_WHEEL_TILT, LENGTH = CENTRE + FU_WHEEL_FORCES, Y = LENGTH + 1 };
enum { COLUMNS = 2 * SPACE + 2 + FU_ATTACHMENT_COORDINATES };

/* A drum at an end of a rope (derive/couplings/drum.py): a tangent point, and the rope that is wound. Its wound length
 * is direction (s - end). Its history is the drawn length over the wound one, in cells. A rope that leaves the empty
 * drum has a free end there. */
typedef struct {
    fu_wheel wheel;
    int node, s; /* dofs: the first of the node; its material coordinate */
    int n_cells, leaves;
    double cell, direction, end;    /* m: stress-free length of a cell; 1 at the first end of the rope, else -1; m */
    double tangent_radius, stretch; /* m; of the rope as drawn */
    /* in space: half the weight of a length; of the span the first dof, elements in all and within reach of a chord, s
     * of its ends; m: the stress-free length of a chord */
    double weight[3], limit, chord;
    int span_first, span_elements, span_reach, span_s[2];
    const double *share; /* of its nodes */
} fu_drum;

/* Velocities of the wound rope: of the rim by its rotation, in space by those about the vectors of the groove, too; and
 * of the centre. */
enum { FU_DRUM_VELOCITIES = 2 * SPACE };

/* History of a drum: the last accepted state, whether the rope has left it and the energy of the height at which it was
 * laid on until then, J; whether it has made a step that conserves energy, and the velocities of the wound rope after
 * it, m/s; and the drawn length over the wound one at the ends of cells. */
typedef struct {
    double is_known, u, phi, turn, carrier, drawn, stretch, has_left, laid, is_moving, V[FU_DRUM_VELOCITIES], profile[];
} fu_drum_history;
enum { FU_DRUM_HISTORY = offsetof(fu_drum_history, profile) / sizeof(double) };

/* A drum at a state; u: wound length. */
typedef struct {
    fu_wheel_state wheel;
    const double *q;
    double x[DIM], slope[DIM], x_rate[DIM], slope_rate[DIM];
    double stretch[SPACE], rise; /* in space: direction of the slope; place along the axis, m */
    double u, u_rate, turn, carrier, phi, span_stretch, wound, winds;
    int has_left;
} fu_drum_state;

static inline const fu_drum *drum_of(const fu_coupling *coupling)
{
    return (const fu_drum *)coupling;
}

static inline int is_in_space(const fu_drum *drum)
{
    return drum->wheel.foot != 0;
}

/* Returns the number of its conditions until the rope leaves; the last one is that of winding. */
static inline int conditions_of(const fu_drum *drum)
{
    return (is_in_space(drum) ? FU_FOOT_CONDITIONS : DIM) + 1;
}

/* Returns the tangent point, in space. */
static inline fu_foot foot_of(const fu_drum *drum)
{
    return (fu_foot){.wheel = &drum->wheel,
                     .is_start = drum->direction > 0.0,
                     .node = drum->node,
                     .first = drum->span_first,
                     .n_elements = drum->span_elements,
                     .reach = drum->span_reach,
                     .s = drum->span_s,
                     .share = drum->share,
                     .chord = drum->chord,
                     .radius = drum->tangent_radius,
                     .weight = drum->weight,
                     .limit = drum->limit,
                     .by_chord = 1.0};
}

/* --- drum_state.c --- */

/* Computes a drum at a state, with these accelerations of the dofs (null: zero). */
void fu_drum_at(const fu_model *model, const fu_drum *drum, const fu_state *state, const double *a, fu_drum_state *out);
/* Computes the dofs of a drum and the changes of y by them, with these moves of the centre; returns their number. */
int fu_drum_columns(const fu_drum *drum, const fu_drum_state *at, const fu_centre_moves *moves, fu_wheel_column *out);

/* --- drum_history.c --- */

static inline fu_drum_history *fu_drum_history_of(const fu_drum *drum, const fu_state *state)
{
    return (fu_drum_history *)(state->numbers + drum->wheel.base.numbers);
}
/* Returns the sense in which the tangent point passes over the rim as the rope is wound. */
double fu_winding_sense(const fu_drum *drum);
/* Return the cell with the last part of a wound length; the stretch of a cell, the last one of the wound length; and
 * that of what is paid out next. */
int fu_drum_cell(const fu_drum *drum, double u);
double fu_drum_cell_stretch(const fu_drum *drum, const fu_drum_history *past, int cell);
double fu_drum_wound_stretch(const fu_drum *drum, const fu_drum_history *past, double u);
/* Return, in m, the drawn length of a part u of the wound rope; the way of the tangent point on the rim since the last
 * accepted state; and the residual of winding since then. */
double fu_drum_drawn_length(const fu_drum *drum, const fu_drum_history *past, double u);
double fu_drum_way(const fu_drum *drum, const fu_drum_history *past, const fu_drum_state *at);
double fu_drum_winding_gap(const fu_drum *drum, const fu_drum_history *past, const fu_drum_state *at);
/* Returns the mean stretch of what has passed since then: the drawn length over the wound one. */
double fu_drum_passing(const fu_drum *drum, const fu_drum_history *past, const fu_drum_state *at);

/* --- drum_store.c: the wound rope --- */

/* Computes all forces by y but those of the conditions; the bearing's is on the drum alone. */
void fu_drum_forces(const fu_drum *drum, const fu_drum_state *at, double y[Y]);
/* Adds their derivatives: D by rates, in units of w.rate, K by places. */
void fu_drum_add_derivatives(const fu_drum *drum, const fu_drum_state *at, fu_weights w, double (*D)[Y],
                             double (*K)[Y]);
/* Returns the elastic energy that the wound rope has gained since the last accepted state once that is updated, J. */
double fu_drum_stored(const fu_drum *drum, const fu_drum_history *past, const fu_drum_state *at);
/* Computes the mass matrix by y. */
void fu_drum_mass(const fu_drum *drum, const fu_drum_state *at, double factor, double (*out)[Y]);
/* Computes the kinetic energy and that of gravity, J. */
void fu_drum_energies(const fu_drum *drum, const fu_drum_state *at, double *T, double *V);
/* Operations of the coupling. */
double fu_drum_energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
double fu_drum_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                           const fu_accelerator *work);
void fu_drum_update(const fu_model *model, const fu_coupling *coupling, fu_state *state);

/* --- drum_conditions.c --- */

/* The conditions of a drum: their number; whether the tangent point is one in space, which then follows; residuals;
 * derivatives by y and those of J' multipliers, in space of winding alone. A rope that has left has one condition, that
 * of its end: the wound length is zero. */
typedef struct {
    int n, has_foot;
    double phi[MAX_CONDITIONS], J[MAX_CONDITIONS][Y], K[Y][Y];
    fu_tangent_point foot;
} fu_drum_conditions;

void fu_drum_conditions_at(const fu_drum *drum, const fu_drum_state *at, const fu_state *state,
                           const double *multipliers, fu_drum_conditions *out);
/* Adds the forces of the conditions by y, in space without those on the chord. */
void fu_drum_add_multipliers(const fu_drum_state *at, const fu_drum_conditions *of, const double *multipliers,
                             double y[Y]);
/* Adds all these forces: by y, in space those of the tangent point to those on the dofs. */
void fu_drum_add_all_multipliers(const fu_drum_conditions *of, const double *multipliers, double y[Y], double *f);
/* Adds the rows of the conditions, the columns of their forces, and in space the derivatives of those of the tangent
 * point. `rows` and `columns`: of the n dofs; by_psi: moves of the centre in the latter. */
void fu_drum_add_rows(const fu_model *model, const fu_coupling *coupling, const fu_drum_state *at,
                      const fu_drum_conditions *of, int n, const fu_wheel_column *rows, const fu_wheel_column *columns,
                      const fu_centre_moves *by_psi, const fu_equations *equations, fu_system *system);
/* Operation of the coupling. */
void fu_drum_rows(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_accelerator *work);

/* --- drum_step.c: operations of the coupling over a step that conserves energy --- */

void fu_drum_history_over_step(const fu_model *model, const fu_coupling *coupling, const fu_equations *at);
void fu_drum_history_jump(const fu_model *model, const fu_coupling *coupling, fu_state *state, const double *change);
double fu_drum_energy_beyond_velocities(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
void fu_drum_step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                           double *internal);
double fu_drum_step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at);

#endif
