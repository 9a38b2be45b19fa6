/* Scales of the rows of a Newton system. */
#include "couplings/common/couplings.h"

double fu_row_unit(double inertia, double mass)
{
    return inertia != 0.0 ? mass : 1.0;
}
