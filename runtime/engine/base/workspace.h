/* Arrays placed one behind the other in a work space that is allocated as a whole. */
#ifndef FUNICULAR_BASE_WORKSPACE_H
#define FUNICULAR_BASE_WORKSPACE_H

#include <stddef.h>

/* Doubles that n objects of a type take. */
#define FU_DOUBLES(n, type) (((n) * (long)sizeof(type) + (long)sizeof(double) - 1) / (long)sizeof(double))

/* Takes the next n doubles of a work space, of which so many are taken; only counts them where it is null. */
static inline double *fu_take(double *scratch, long *taken, long n)
{
    double *array = scratch ? scratch + *taken : NULL;
    *taken += n;
    return array;
}

#endif
