/* Complex matrices in the layout of an fu_system: linear/complex_system.c, linear/complex_band.c,
 * linear/complex_pivoted.c. */
#ifndef FUNICULAR_LINEAR_COMPLEX_SYSTEM_H
#define FUNICULAR_LINEAR_COMPLEX_SYSTEM_H

#include "linear/complex_number.h"
#include "linear/linear.h"

/* complex_band.c: numbers of a column of the factor's storage, and those accessed behind a column of unknowns. */
#define FU_COMPLEX_STRIDE(width) ((width) + 4)
#define FU_COMPLEX_BEYOND(width) ((width) + 4)

void fu_complex_band_factor(int n, int width, double *re, double *im);
void fu_complex_band_add(int n, int width, const double *K, fu_complex factor, double *re, double *im);
int fu_complex_unsymmetric_factor(int n, int width, double *const L[2], double *const U[2]);
int fu_complex_pivoted_factor(int n, int width, int stride, fu_complex *A, int *pivot);
void fu_complex_pivoted_solve(int n, int width, int stride, const fu_complex *A, const int *pivot, fu_complex *x);
void fu_complex_band_solve(int n, int width, double *const L[2], double *const U[2], int first, double *x, double *y);

/* [K B; C D] in the form of an fu_system, combined from real systems with several weights. */
typedef struct {
    fu_complex *K, *B, *C, *D, *X;
    fu_complex *x;      /* right side, then solution */
    fu_factors factors; /* of D, unless there is only one front */
    int *n_columns;
    fu_matrix_block *columns; /* of X, by chain; those of C are the real system's */
    int *pivot_band, *pivot_border;
    int is_lower;        /* the band is in L, its lower half, else in K, all of it */
    double *L[2], *U[2]; /* FU_COMPLEX_STRIDE x n, real and imaginary parts (complex_band.c) */
    int *factorisations; /* n_chains: factorisation of each: in L, in L and U, in K */
    double *right[2];    /* n + FU_COMPLEX_BEYOND: a right side of the band, likewise */
} fu_complex_system;

int fu_complex_fronts_factor(const fu_fronts *fronts, const fu_complex *matrix, fu_factors *factors,
                             const fu_lapack *lapack);
void fu_complex_fronts_solve(const fu_fronts *fronts, const fu_factors *factors, fu_complex *y);

void fu_complex_system_take(fu_complex_system *c, const fu_system *real, double *scratch, long *taken);
void fu_complex_system_clear(fu_complex_system *c, const fu_system *real);
void fu_complex_system_accumulate(fu_complex_system *c, const fu_system *real, fu_complex factor);
int fu_complex_system_factor(fu_complex_system *c, const fu_system *real, const fu_lapack *lapack, double *size);
void fu_complex_system_solve(const fu_complex_system *c, const fu_system *real, const fu_lapack *lapack);

#endif
