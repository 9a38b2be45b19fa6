/* Linear complementarity problems: linear/complementarity.c. */
#ifndef FUNICULAR_LINEAR_COMPLEMENTARITY_H
#define FUNICULAR_LINEAR_COMPLEMENTARITY_H

#define FU_MAX_COMPLEMENTARY 48 /* unknowns of one problem */

enum { FU_IS_POSITIVE, FU_IS_BASIC, FU_IS_DEPENDENT };
int fu_complement(int n, const double *G, const double *b, double least, double *x, int *kind);

#endif
