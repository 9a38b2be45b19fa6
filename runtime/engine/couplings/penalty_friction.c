/* Friction that sticks beside a force by penalty: of contact with surfaces and of crossings. */
#include "engine.h"

#include <math.h>

int fu_limit_stretch(int dim, double stiffness, double most, double *stretch)
{
    const double size = stiffness * sqrt(fu_dot(dim, stretch, stretch));
    if (!(size > most)) return 0;
    for (int d = 0; d < dim; ++d) stretch[d] *= most / size;
    return 1;
}
