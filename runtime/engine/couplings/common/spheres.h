/* Bounding spheres of elements, for clearances: couplings/common/spheres.c. */
#ifndef FUNICULAR_COUPLINGS_COMMON_SPHERES_H
#define FUNICULAR_COUPLINGS_COMMON_SPHERES_H

#include "bodies/model.h"
#include "couplings/common/coupling.h"

extern const fu_clearance fu_no_clearance; /* of a coupling that may act */
double fu_sphere_about(const fu_cable *cable, const double *q, int element, double middle[3]);
double fu_distance_between(int dim, const double *a, const double *b);
const double *fu_place_of_body(const fu_model *model, const fu_state *state, int body);

#endif
