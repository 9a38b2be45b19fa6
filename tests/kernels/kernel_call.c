/* Calls a generated kernel from C: the elastic energy of a cable element of length 2 that is stretched by 1 %.
 *
 *     cc kernel_call.c $(python -m funicular.generated --include --sources) -lm -o kernel_call
 */
#include "kernels.h"
#include <stdio.h>

int main(void)
{
    const double l = 2.0, stiffness[2] = {1000.0, 0.5};                                   /* m; EA in N, EI in N m^2 */
    const double e[12] = {0.0, 0.0, 0.0, 1.01, 0.0, 0.0, 2.02, 0.0, 0.0, 1.01, 0.0, 0.0}; /* r and r_x at both ends */
    double constants[2], energy;
    cable12_green_exact_stiffness(l, stiffness, constants);
    cable12_green_exact_energy(l, e, constants, &energy);
    printf("%.17g\n", energy);
    return 0;
}
