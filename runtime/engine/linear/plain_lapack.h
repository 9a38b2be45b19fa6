/* Plain versions of the functions of LAPACK, for programs without it: linear/plain_lapack.c. */
#ifndef FUNICULAR_LINEAR_PLAIN_LAPACK_H
#define FUNICULAR_LINEAR_PLAIN_LAPACK_H

#include "linear/linear.h"

extern const fu_lapack fu_plain_lapack;

#endif
