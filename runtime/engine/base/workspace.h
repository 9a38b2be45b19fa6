/* Arrays placed one after the other in a work space that is allocated as a whole. */
#ifndef FUNICULAR_BASE_WORKSPACE_H
#define FUNICULAR_BASE_WORKSPACE_H

#include <stddef.h>

/* Doubles that hold n objects of a type. */
#define FU_DOUBLES(n, type) (((n) * (long)sizeof(type) + (long)sizeof(double) - 1) / (long)sizeof(double))

/* Takes the next n doubles of a work space after `taken` ones; only counts them if it is null. */
static inline double *fu_take(double *scratch, long *taken, long n)
{
    double *array = scratch ? scratch + *taken : NULL;
    *taken += n;
    return array;
}

#endif
