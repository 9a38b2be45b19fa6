/* Public: equations of motion of a whole scene at an instant: equations/equations.c; accelerations by eq 38:
 * equations/acceleration.c; inertia and energies: equations/energies.c; projection of states on their constraints:
 * equations/projection.c. */
#ifndef FUNICULAR_EQUATIONS_EQUATIONS_H
#define FUNICULAR_EQUATIONS_EQUATIONS_H

#include "base/common.h"
#include "bodies/model.h"
#include "couplings/common/accelerator.h"
#include "couplings/common/coupling.h"

/* The unknowns beyond the dofs in run->rhs. */
double *fu_internal_unknowns(fu_run *run);
void fu_scale_residual(fu_run *run, double scale);
void fu_residual(fu_run *run, const fu_equations *at);
void fu_matrix(fu_run *run, const fu_equations *at);
void fu_matrix_of_weights(fu_run *run, fu_weights weights);
void fu_matrix_of_cables(fu_run *run, fu_weights weights);
void fu_add_matrix_without_cables(fu_run *run, fu_weights weights);
void fu_static_move(fu_run *run, const double *change);
void fu_static_residual(fu_run *run);

/* equations/refinement.c: refines accelerations of a state without constraints until they satisfy eq 38 to 1e-9 of the
 * forces; reaction: M q'' - Q on all dofs before and after, the force of the supports on those that are held. Returns
 * nonzero if that takes more than two corrections. */
int fu_refine_accelerations(const fu_model *model, double t, const double *q, fu_accelerator *work,
                            double *acceleration, double *reaction);

/* equations/acceleration.c */
/* Computes the constraint rows of all couplings. */
void fu_evaluate_rows(const fu_model *model, const fu_state *state, fu_accelerator *work);
int fu_accelerator_prepare(const fu_model *model, fu_accelerator *work);
int fu_accelerations(const fu_model *model, const fu_state *state, fu_accelerator *work, double *acceleration,
                     double *reaction);
int fu_compliance(const fu_model *model, const fu_state *state, fu_accelerator *work, const int *at, int n, double *S);
int fu_project_positions(const fu_model *model, const fu_state *state, fu_accelerator *work, double *change);
int fu_project_velocities(const fu_model *model, const fu_state *state, fu_accelerator *work, double *change);
int fu_prepare_response(const fu_model *model, const fu_state *state, fu_accelerator *work);
void fu_response(const fu_model *model, fu_accelerator *work, const double *force, double *change);
int fu_strike(const fu_model *model, const fu_state *state, fu_accelerator *work, int row, int constraint, double rate,
              double *change);

/* equations/energies.c */
void fu_mass_times(const fu_model *model, double t, const double *q, const double *a, double *f);
double fu_kinetic_energy(const fu_model *model, double t, const double *q, const double *v);
double fu_kinetic_energy_at(const fu_model *model, const fu_state *state);
double fu_kinetic_energy_of_change(const fu_model *model, double t, const double *q, const double *v);
double fu_elastic_energy(const fu_model *model, const fu_state *state);
double fu_dissipation(const fu_model *model, const fu_state *state, const fu_accelerator *work);

/* equations/projection.c */
int fu_find_internal(fu_run *run);
int fu_close(fu_run *run);
int fu_return_to_joints(fu_run *run, fu_state *state);
int fu_probe_mechanism(fu_run *run, const double *along, double *left);
int fu_complete(fu_run *run, fu_state *state);
int fu_is_short(const fu_run *run, double h);
int fu_coast(fu_run *run, double h);

#endif
