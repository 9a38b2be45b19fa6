/* Cables whose stress-free length grows: bodies/growth.c. */
#ifndef FUNICULAR_BODIES_GROWTH_H
#define FUNICULAR_BODIES_GROWTH_H

#include "bodies/cables.h"

/* An element as its law takes it: growth factor, its rate, length, constants, nodal vectors, and their rates if they
 * are asked; made: the constants of a law that depend on the factor. */
typedef struct {
    double g, rate, l, e[FU_MAX_COORDINATES], v[FU_MAX_COORDINATES];
    const double *A;
    double made[FU_MAX_CONSTANTS];
} fu_grown;

/* Returns the dof of the growth factor of an element. */
static inline int fu_growth_dof(const fu_cable *cable, int element)
{
    return fu_piece_of(cable, element)->growth;
}

/* Returns the growth factor of an element at q, or its rate at v. */
static inline double fu_growth(const fu_cable *cable, int element, const double *q)
{
    return q[fu_growth_dof(cable, element)];
}

void fu_grow(const fu_cable *cable, int element, double g, const double *e, fu_grown *grown);
void fu_grow_rates(const fu_cable *cable, double rate, const double *v, fu_grown *grown);
void fu_forces_on_given(const fu_cable *cable, double g, double *f);
double fu_growth_force(const fu_cable *cable, const fu_grown *grown, const double *f);

void fu_grown_elastic_force(const fu_cable *cable, int element, const double *q, double *f);
void fu_grown_elastic_tangent(const fu_cable *cable, int element, const double *q, double *K);
void fu_grown_damping_force(const fu_cable *cable, int element, const double *q, const double *v, double *f);
void fu_grown_damping_tangent(const fu_cable *cable, int element, const double *q, const double *v, double rate,
                              double *K);
void fu_grown_discrete_force(const fu_cable *cable, int element, const double *q, const double *q_next, double *f);
void fu_grown_step_stiffness(const fu_cable *cable, int element, const double *q, const double *q_next, double *k);
double fu_grown_energy(const fu_cable *cable, int element, const double *q);
double fu_grown_dissipation(const fu_cable *cable, int element, const double *q, const double *v);

void fu_add_growth_forces(const fu_model *model, const double *q, double *f);
void fu_add_growth_rate_forces(const fu_model *model, const double *q, const double *v, double *f);
void fu_add_discrete_growth_forces(const fu_model *model, const double *q, const double *q_next, double *f);

#endif
