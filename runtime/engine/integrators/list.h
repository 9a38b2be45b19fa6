/* Public: the list of integrators: integrators/list.c; the linear model that one of them takes:
 * integrators/linear_model.h. */
#ifndef FUNICULAR_INTEGRATORS_LIST_H
#define FUNICULAR_INTEGRATORS_LIST_H

#include "equations/integrator.h"
#include "integrators/linear_model.h"

/* Returns the integrator of this name, null if there is none. */
const fu_integrator *fu_integrator_of(const char *name);

#endif
