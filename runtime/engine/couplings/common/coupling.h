/* Couplings: interactions between attachments, or on one. couplings/common/couplings.c loops over them. */
#ifndef FUNICULAR_COUPLINGS_COMMON_COUPLING_H
#define FUNICULAR_COUPLINGS_COMMON_COUPLING_H

#include "base/common.h"
#include "base/fields.h"
#include "linear/linear.h"
#include "bodies/state.h"

#define FU_MAX_FORCES 23 /* of one coupling: a rope in space that has left a sheave with 16 zones */

typedef struct fu_coupling_type fu_coupling_type;
typedef struct fu_coupling_events fu_coupling_events;

/* Base of each coupling: fu_slide, fu_joint, fu_point_force and fu_load have it as their first member, `base`.
 *
 * A coupling may have internal unknowns in a Newton system. They are contiguous from `unknown` on: first its
 * coordinates (s of a slide), then its forces (multipliers are forces). fu_list_couplings numbers them. */
struct fu_coupling {
    const fu_coupling_type *type;
    const fu_coupling_events *events; /* its events; null: none (couplings/common/coupling_events.h) */
    int index;                        /* among the couplings of its structure */
    int number;                       /* among all couplings of the model */
    int unknown;                      /* the first of its unknowns, counted beyond the dofs */
    int n_coordinates, coordinate;    /* its coordinates, and the first of them in state->s */
    int n_forces, force;              /* its internal forces, and the first of them in state->forces */
    int n_multipliers, multiplier;    /* multipliers of eq 38: their maximum, and the first of them */
    int row;                          /* its entry in fu_accelerator.rows, -1 without constraints */
    int output;                       /* its first number in a row of output */
    int numbers, flags;               /* its part of a state: the first of them in state->numbers, state->flags */
    int scratch;                      /* first place of its part of fu_accelerator.scratch */
    int n_numbers;                    /* its numbers in a state beyond those of its type */
    int needs_reactions;              /* nonzero if a force of it depends on the multipliers of eq 38 */
    int is_damped;                    /* nonzero if a force of it depends on velocities */
    int is_driven;                    /* nonzero if a signal does work on it */
    int has_inertia;                  /* nonzero if it has a mass */
    double scale[FU_MAX_FORCES];      /* kg or kg m: brings rows of constraints to the scale of the mass matrix */
};

extern const fu_field fu_coupling_fields[]; /* of fu_coupling */

/* Loops over the first n couplings of a list. */
#define FU_EACH_COUPLING(c, list, n)                                                                                   \
    for (const fu_coupling *const *c##_at = (list), *c = NULL; c##_at - (list) < (n) && (c = *c##_at) != NULL; ++c##_at)

/* Place of the equations of a Newton method: at `next`, or, in a method that conserves energy, over the step from `now`
 * to `next` with `middle` between them. Rows of equilibrium are multiplied by weights.stiffness, rows of constraints by
 * fu_row_unit; internal forces of couplings are solved for in units of fu_row_unit/weights.stiffness. */
typedef struct {
    const fu_state *now, *next, *middle;
    const double *psi; /* displacement of the bodies to `next`; null if the unknowns move them from there */
    double h;          /* s: of the step; 0 at an instant */
    fu_weights weights;
} fu_equations;

/* Lower bound of the gap between the two parts of a coupling, m; the factor that converts rotations of the second part
 * to displacements of the first, m; the largest distance of points of the first from its origin, if it is a body, m. */
typedef struct {
    double gap, lever, radius;
} fu_clearance;

/* A mass that depends on the configuration. `force`, `residual` and `tangent` contain its inertial force at zero
 * accelerations. */
typedef struct {
    /* Adds M a to f, at the time t. */
    void (*force)(const fu_model *model, const fu_coupling *coupling, double t, const double *q, const double *a,
                  double *f);
    /* Adds scale M to a system. */
    void (*matrix)(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double scale,
                   fu_system *system);
    /* Returns the kinetic energy, J, at the velocities v; or of these alone, if the coupling is of a moving fluid and
     * past_fluid is zero. */
    double (*kinetic_energy)(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                             const double *v, int past_fluid);
    /* Returns the energy of gravity, J. Null: none. */
    double (*potential_energy)(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
    /* Returns the kinetic energy of a state beyond that of its velocities, J: that of momenta which are history
     * variables of steps that conserve energy. Null: none. */
    double (*beyond_velocities)(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
    int in_residual; /* `residual` contains M q'' as well */
} fu_inertia_operations;

/* A lower bound of the distance at which a coupling acts. Operations may be skipped until motions have exceeded it
 * (couplings/common/proximity.c). */
typedef struct {
    /* Returns the clearance at a state: motions of both sides, and rotations of the second times the lever, reduce its
     * gap at most. */
    fu_clearance (*clearance)(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
    /* Computes the two parts of the coupling: the number of a cable, n_cables plus that of a body, -1 for the
     * ground. */
    void (*between)(const fu_model *model, const fu_coupling *coupling, int between[2]);
} fu_proximity_operations;

/* External work: of an external force alone, whose power the energy balance computes; or of a part of `force`. */
typedef struct {
    /* Adds an external force to f. Null: none. */
    void (*force)(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double *f);
    /* Returns the external power of `force` at an instant, W. Null: none. */
    double (*power)(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
    /* Returns that work over a step that conserves energy, J. Null: none. */
    double (*step_work)(const fu_model *model, const fu_coupling *coupling, const fu_equations *at);
} fu_supply_operations;

/* A force that depends on the multipliers of eq 38. */
typedef struct {
    /* Adds the force for the multipliers lambda (null: those of the state) to work->work; returns the largest change
     * since the last call over the force. */
    double (*update)(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const double *lambda,
                     fu_accelerator *work);
    /* Accepts the final multipliers. */
    void (*accept)(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const double *lambda,
                   fu_accelerator *work);
} fu_reaction_operations;

/* Errors of a step by forces that are not smooth within it: estimates of integrators assume smooth forces. */
typedef struct {
    /* Adds to f the error of the mean force over a step from one state to another, N, by a quadrature of n weights b at
     * parts c of the step; returns whether there is one. Null: none. */
    int (*quadrature)(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                      int n, const double *b, const double *c, double *f);
    /* Returns the error of friction by reactions, m, by n states of the step, their weights in the mean, and the
     * multipliers there (n x model->n_multipliers); square: the step times the remaining time, s^2. Null: none. */
    double (*friction)(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int n,
                       const double *weights, const double *multipliers, double square);
} fu_error_operations;

/* Dependent coordinates. */
typedef struct {
    /* Computes their rates, after eq 38. */
    void (*rates)(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work, double *rates);
    /* Solves for them at a state; returns nonzero without a solution. */
    int (*solve)(const fu_model *model, const fu_coupling *coupling, fu_state *state);
} fu_coordinate_operations;

/* History variables: numbers and flags of a state that change from step to step. */
typedef struct {
    /* Returns their number beyond those of the type. Null: none. */
    int (*size)(const fu_coupling *coupling);
    /* Computes them at the end of a step that conserves energy, and after a change of the velocities. Null: none. */
    void (*over_step)(const fu_model *model, const fu_coupling *coupling, const fu_equations *at);
    void (*jump)(const fu_model *model, const fu_coupling *coupling, fu_state *state, const double *change);
    /* Updates them after an accepted step. Null: none. */
    void (*update)(const fu_model *model, const fu_coupling *coupling, fu_state *state);
    /* Computes velocities and accelerations after a step of dofs whose inertia is in the variables alone, see
     * fu_velocity_of_step; since: from the middle of the step before to the start, s. Null: none. */
    void (*velocities)(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double since);
    /* Returns their error after a step from one state to another, m. Null: none. */
    double (*error)(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to);
} fu_history_operations;

/* Limits of a coupling, its initial configuration, and the check of states. */
typedef struct {
    /* Returns in words which data of a coupling exceed the limits of the engine; null if none does. */
    const char *(*excess)(const fu_coupling *coupling);
    /* Sets coordinates, segments, numbers and flags of the state in the initial configuration; others are zero. */
    void (*reset)(const fu_coupling *coupling, fu_state *state);
    /* Returns whether a start may violate the constraints by a small gap. */
    int (*may_be_open)(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
    /* Returns whether a state from a file is possible. */
    int (*is_possible)(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
} fu_start_operations;

/* Operations of a coupling. A null operation does nothing. f: generalised forces on the dofs, with the signs of the
 * left side of the equations of motion; internal: minus the scaled residual of the unknowns beyond the dofs.
 *
 * No operation lists the columns of a coupling in a system: `tangent` and `rows` name each entry by its dof or unknown,
 * and fu_add (bodies/unknowns.h) finds its place and extends the row spans of the border. A separate list would state
 * this a second time.
 */
struct fu_coupling_type {
    const char *name;
    size_t size;                    /* bytes of its structure */
    const fu_field *fields;         /* its fields from the model */
    const fu_output *output_fields; /* its numbers in a row of output; null: none */
    int n_numbers, n_flags;         /* real numbers and integers in a state */
    int n_scratch;                  /* doubles stored from `rows` to `outputs` */

    const fu_inertia_operations *inertia; /* tables of operations; null: none */
    const fu_proximity_operations *proximity;
    const fu_supply_operations *supply;
    const fu_reaction_operations *reaction;
    const fu_coordinate_operations *coordinates;
    const fu_history_operations *history;
    const fu_error_operations *errors;
    const fu_start_operations *start;

    /* Newton systems at an instant: residual and its derivative. */
    void (*residual)(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                     double *internal);
    void (*tangent)(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system);
    /* The same over a step that conserves energy; and the energy that the coupling dissipates in it, J. */
    void (*step_residual)(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                          double *internal);
    void (*step_tangent)(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system);
    double (*step_dissipation)(const fu_model *model, const fu_coupling *coupling, const fu_equations *at);
    /* Returns whether a coupling has them. Null: all that have step_residual do. */
    int (*has_step)(const fu_coupling *coupling);

    /* Computes the constraint rows of accelerations (eq 38), H and W among them, in work->rows[coupling->row]. */
    void (*rows)(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_accelerator *work);
    /* Adds the coupling's force to f. */
    void (*force)(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f);
    /* Compute, after eq 38, the internal forces of the state; the numbers of `output_fields`. */
    void (*take_forces)(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work,
                        fu_state *state);
    void (*outputs)(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out);

    /* Computes the residuals of the constraints, redundant ones included: one number per internal force. */
    void (*gaps)(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *gaps);

    /* Return the stored energy, J; the dissipated power, W, by the internal forces of the state, or, if work is not
     * null, by those of eq 38. */
    double (*energy)(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
    double (*dissipation)(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const fu_accelerator *work);

    /* Returns the energy that a step from one state to another dissipates beside that power, J; by_ends: by the forces
     * at its ends alone, as in methods of order 2. */
    double (*lost_in_step)(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                           int by_ends);

    /* Detects contact from the positions, in statics. */
    void (*detect)(const fu_model *model, const fu_coupling *coupling, fu_state *state);
};

#endif
