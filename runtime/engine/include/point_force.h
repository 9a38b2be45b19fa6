/* Forces between two points: couplings/point_force.c. */
#ifndef FUNICULAR_POINT_FORCE_H
#define FUNICULAR_POINT_FORCE_H

#include "attachments.h"
#include "coupling.h"

#define FU_MAX_PARAMETERS 8 /* of the law of one; cython/translation.pxi checks */

/* A force along the gap between the points of two attachments, by the law of its type and the parameters of that. */
typedef struct {
    fu_coupling base;
    const void *kernels; /* of its law: derive/couplings/ */
    fu_attachment attachments[2];
    int dim;
    double parameters[FU_MAX_PARAMETERS];
} fu_point_force;

void fu_point_force_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                             double *own);
void fu_point_force_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system);
void fu_point_force_step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                                  double *own);
void fu_point_force_step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at,
                                 fu_system *system);
double fu_point_force_step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at);
void fu_point_force_force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f);
void fu_point_force_take(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work, fu_state *state);
void fu_point_force_outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                            const double *acceleration, const fu_accelerator *work, double *out);
double fu_point_force_energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
double fu_point_force_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                                  const fu_accelerator *work);

/* The operations of a type whose law is a force between two points. */
#define FU_POINT_FORCE_OPERATIONS                                                                              \
    .n_outputs = 3, .residual = fu_point_force_residual, .tangent = fu_point_force_tangent,                    \
    .step_residual = fu_point_force_step_residual, .step_tangent = fu_point_force_step_tangent,                \
    .step_dissipation = fu_point_force_step_dissipation, .force = fu_point_force_force,                        \
    .take_forces = fu_point_force_take, .outputs = fu_point_force_outputs, .energy = fu_point_force_energy,    \
    .dissipation = fu_point_force_dissipation

#endif
