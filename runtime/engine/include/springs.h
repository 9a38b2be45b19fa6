/* Springs and dampers: couplings/springs.c. */
#ifndef FUNICULAR_SPRINGS_H
#define FUNICULAR_SPRINGS_H

#include "attachments.h"

typedef struct {
    fu_attachment ends[2];
    int dim, unknown;
    double stiffness, damping, length, mass; /* N/m, N s/m, m; kg: scale of its rows */
} fu_spring;

void fu_spring_force(const fu_model *model, const fu_spring *spring, const double *q, const double *v, double force[3],
                     double by_gap[9], double by_rate[9]);
void fu_spring_forces_of(const fu_model *model, const fu_state *state, double *forces);
void fu_spring_forces(const fu_model *model, const double *q, const double *v, double *f);
void fu_spring_pull(const fu_model *model, const fu_spring *spring, const double *q, const double force[3], double *f);
void fu_spring_matrix(const fu_model *model, const fu_spring *spring, const fu_state *state, const double *psi,
                      double rate, double stiffness, double unit, fu_system *system);
double fu_discrete_spring(const fu_model *model, const fu_spring *spring, const double *q, const double *q_next, double h,
                          double force[3]);
void fu_discrete_pull(const fu_model *model, const fu_spring *spring, const double *q, const double *q_next,
                      const double force[3], double *f);
double fu_spring_energy(const fu_model *model, const double *q);
double fu_spring_dissipation(const fu_model *model, const double *q, const double *v);

#endif
