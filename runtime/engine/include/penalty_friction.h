/* Friction that sticks beside a force by penalty: couplings/penalty_friction.c. */
#ifndef FUNICULAR_PENALTY_FRICTION_H
#define FUNICULAR_PENALTY_FRICTION_H

/* Limits the stretch of friction's spring, of this stiffness in N/m, to what friction allows, in N; returns whether that slides. */
int fu_limit_stretch(int dim, double stiffness, double most, double *stretch);

#endif
