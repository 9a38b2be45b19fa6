/* Sticking friction beside a penalty force: couplings/common/stick_friction.c. */
#ifndef FUNICULAR_COUPLINGS_COMMON_STICK_FRICTION_H
#define FUNICULAR_COUPLINGS_COMMON_STICK_FRICTION_H

#include "base/cubic.h"

/* Limits the stretch of friction's spring, of this stiffness in N/m, to the friction limit, N; returns whether it
 * slides. */
int fu_limit_stretch(int dim, double stiffness, double most, double *stretch);

/* Limit of friction within a step, N, at a penetration, m, with a rate, m/s. */
typedef double fu_friction_bound(const void *of, double depth, double rate);

/* The path of a spring through a step of h, s, along the direction of its stretch at the end: its stretch as without
 * sliding, m, and the penetration; `from`: the part of the step at which it begins; stiffness: N/m. */
typedef struct {
    fu_step_ends stretch, depth;
    double h, from, stiffness;
    fu_friction_bound *bound;
    const void *of;
} fu_friction_path;

/* The bound at a part of the step, N. */
double fu_bound_within(const fu_friction_path *path, double x);

/* The stretch at the end, m; the part of the step after which it slid last, and whether forwards, 1, backwards, -1, or
 * not at all, 0. */
typedef struct {
    double stretch, part;
    int slid;
} fu_friction_end;
/* `most`: the bound of the stretch, m, where the path has no duration, as in statics. */
fu_friction_end fu_end_of_friction(const fu_friction_path *path, double most);

/* The same at a part of the step. */
double fu_friction_within(const fu_friction_path *path, double x);

/* The same with vectors along the contact: the stretch at the beginning, the displacement along the contact, m, the
 * velocities at both ends, m/s. */
typedef struct {
    double stretch[3], change[3], rates[2][3];
} fu_friction_travel;
/* Normalises the stretch `along` as without sliding, and computes the path along it, from the displacement over the
 * step, m, and the velocities at both ends, m/s; returns its size, m. */
double fu_path_along(int dim, const double *change, const double *rate, const double *rate_next, double along[3],
                     fu_friction_path *path);
/* Returns the work of friction over the stiffness, m^2, for a given stretch at the end: by parts of the step, and by
 * half as many (Richardson), or by the ends alone. */
double fu_dissipated_by_friction(int dim, const fu_friction_travel *travel, const fu_friction_path *path,
                                 const double *end, int by_ends);

#define FU_NO_TIME 1e300 /* s: of numbers in the initial configuration, before any step */

#endif
