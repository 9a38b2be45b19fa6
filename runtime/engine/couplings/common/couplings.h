/* Public: loops over the couplings of a model: couplings/common/couplings.c. */
#ifndef FUNICULAR_COUPLINGS_COMMON_COUPLINGS_H
#define FUNICULAR_COUPLINGS_COMMON_COUPLINGS_H

#include "couplings/common/accelerator.h"
#include "couplings/common/coupling.h"
#include "bodies/model.h"

/* Number the couplings of model->couplings: `index`, `unknown` and the other members are given, offsets follow; sums go
 * to model; `lists` has room for 2 n. */
void fu_number_couplings(fu_coupling *const *couplings, int n, const fu_coupling **lists, fu_model *model);

/* Couplings over which to loop. */
typedef struct {
    const fu_coupling *const *list;
    int n;
} fu_couplings;
/* Couplings that may act at a state, or over a step (couplings/common/proximity.c). */
fu_couplings fu_acting(const fu_model *model, const fu_state *state);
fu_couplings fu_acting_in_step(const fu_model *model, const fu_equations *at);

void fu_coupling_residuals(const fu_model *model, const fu_equations *at, double *f, double *internal);
void fu_coupling_tangents(const fu_model *model, const fu_equations *at, fu_system *system);
void fu_coupling_step_residuals(const fu_model *model, const fu_equations *at, double *f, double *internal);
void fu_coupling_step_tangents(const fu_model *model, const fu_equations *at, fu_system *system);
void fu_coupling_inertia(const fu_model *model, double t, const double *q, const double *a, double *f);
void fu_coupling_inertia_beside_residuals(const fu_model *model, double t, const double *q, const double *a, double *f);
void fu_coupling_masses(const fu_model *model, double t, const double *q, double scale, fu_system *system);
double fu_coupling_kinetic_energy(const fu_model *model, double t, const double *q, const double *v, int past_fluid);
double fu_kinetic_energy_beyond_velocities(const fu_model *model, const fu_state *state);
double fu_coupling_potential_energy(const fu_model *model, const fu_state *state);
void fu_coupling_forces(const fu_model *model, const fu_state *state, double *f);
void fu_coupling_external_forces(const fu_model *model, double t, const double *q, double *f);
double fu_coupling_external_power(const fu_model *model, const fu_state *state);
double fu_coupling_energy(const fu_model *model, const fu_state *state);
double fu_coupling_dissipation(const fu_model *model, const fu_state *state, const fu_accelerator *work);
int fu_coupling_quadrature_error(const fu_model *model, const fu_state *from, const fu_state *to, int n,
                                 const double *b, const double *c, double *f);
double fu_lost_in_step(const fu_model *model, const fu_state *from, const fu_state *to, int by_ends);
void fu_take_forces(const fu_model *model, const fu_accelerator *work, fu_state *state);
void fu_coupling_outputs(const fu_model *model, const fu_state *state, const double *acceleration,
                         const fu_accelerator *work, double *out);
int fu_n_outputs(const fu_coupling_type *type); /* the length of `out` of one coupling */
int fu_has_step(const fu_coupling *coupling);   /* whether it has equations over a step that conserves energy */
void fu_gaps(const fu_model *model, const fu_state *state, double *gaps);
void fu_coordinate_rates(const fu_model *model, const fu_accelerator *work, double *rates);
int fu_may_start_open(const fu_model *model, const fu_state *state);
const fu_coupling *fu_solve_coordinates(const fu_model *model, fu_state *state);
void fu_reset(const fu_model *model, fu_state *state);
void fu_update_history(const fu_model *model, fu_state *state);
void fu_history_over_step(const fu_model *model, const fu_equations *at);
/* Computes the velocities after a step of dofs whose inertia is in history variables alone. */
void fu_history_velocities(const fu_model *model, const fu_equations *at, double since);
void fu_history_jump(const fu_model *model, fu_state *state, const double *change);
/* Returns the largest error of history variables after a step, m. */
double fu_history_error(const fu_model *model, const fu_state *from, const fu_state *to);
void fu_outputs_at_rest(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *out);
void fu_detect_contact(const fu_model *model, fu_state *state);
int fu_is_possible(const fu_model *model, const fu_state *state);

/* A point of a wrap to which a rope sticks in statics: whether it sticks, FU_STICKS, or in which direction it slides, 1
 * or -1; friction f and the limit of |f|, N; by how much it has slid, m. */
typedef struct {
    int mode;
    double f, limit, slip;
} fu_held_friction;
/* Hold a point from a state on, so that it sticks; compute it in a later state; set its mode. */
void fu_hold_point(const fu_model *model, fu_coupling *coupling, const fu_state *state);
void fu_held_point(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_held_friction *out);
void fu_set_held_mode(const fu_coupling *coupling, const fu_state *state, int mode);

/* Scale of constraint rows, and of internal forces, by the inertia of a system: statics has none. */
static inline double fu_row_unit(double inertia, double mass)
{
    return inertia != 0.0 ? mass : 1.0;
}
/* Adds a solution `internal` of a Newton system, whose equilibrium is multiplied by `scale`, to coordinates and forces.
 */
void fu_add_internal(const fu_model *model, fu_state *state, const double *internal, double inertia, double scale);
/* Returns the coupling of an unknown beyond the dofs. */
const fu_coupling *fu_owner(const fu_model *model, int unknown);

#endif
