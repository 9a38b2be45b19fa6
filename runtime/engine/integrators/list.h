/* Public: the list of integrators: integrators/list.c. */
#ifndef FUNICULAR_INTEGRATORS_LIST_H
#define FUNICULAR_INTEGRATORS_LIST_H

#include "equations/integrator.h"

/* Returns the integrator of this name, null if there is none. */
const fu_integrator *fu_integrator_of(const char *name);

#endif
