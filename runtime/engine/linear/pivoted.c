/* Bands that are not nearly symmetric and positive definite, factored with row pivots. LAPACK calls a BLAS kernel for
 * each column, which takes longer than the arithmetic in bands of a few elements. */
#include "linear/columns.h"
#include "linear/linear.h"

#include <math.h>

#define NUMBER double
#define PREFIX(name) real_##name
#define ZERO 0.0
#define SIZE(x) fabs(x)
#define TIMES(a, b) ((a) * (b))
#define INVERSE(x) (1.0 / (x))
#define SUBTRACT subtract_one

#include "linear/pivoted_template.h"

static void factor_columns(int n, int width, int stride, double *A, int *pivot, int *info);
FU_SIMD_FUNCTION(factor_columns, real_factor, (int n, int width, int stride, double *A, int *pivot, int *info),
                 (n, width, stride, A, pivot, info))

/* Factors A = P L U in place; returns 0, or 1 + the index of the first zero pivot, and A is not factored. */
int fu_pivoted_factor(int n, int width, int stride, double *A, int *pivot)
{
    int info;
    factor_columns(n, width, stride, A, pivot, &info);
    return info;
}

/* Computes x = A^-1 x with the factors of fu_pivoted_factor. */
FU_SIMD_FUNCTION(fu_pivoted_solve, real_solve,
                 (int n, int width, int stride, const double *A, const int *pivot, double *x),
                 (n, width, stride, A, pivot, x))
