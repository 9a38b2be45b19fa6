/* The list of integrators. */
#include "integrators/list.h"

#include <string.h>

extern const fu_integrator fu_genalpha, fu_explicit, fu_radau, fu_energy, fu_linear;

static const fu_integrator *const integrators[] = {&fu_genalpha, &fu_explicit, &fu_radau, &fu_energy, &fu_linear};

const fu_integrator *fu_integrator_of(const char *name)
{
    for (size_t i = 0; i < sizeof integrators / sizeof *integrators; ++i)
        if (!strcmp(integrators[i]->name, name)) return integrators[i];
    return NULL;
}
