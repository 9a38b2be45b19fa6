/* The parameters and the work space of Radau IIA. */
#include "integrators/radau.h"

/* Returns the parameters of the run's method. */
const fu_radau_parameters *fu_radau_method(const fu_run *run)
{
    return (const fu_radau_parameters *)run->parameters;
}

/* Returns the work space of a run. */
fu_radau_workspace *fu_radau_space(const fu_run *run)
{
    return (fu_radau_workspace *)run->scratch;
}
