/* Complex bands and full matrices, factored with row pivots as in linear/pivoted.c. */
#include "base/simd.h"
#include "linear/complex_system.h"

#define NUMBER fu_complex
#define PREFIX(name) complex_##name
#define ZERO ((fu_complex){0.0, 0.0})
#define SIZE(x) (fabs((x).re) + fabs((x).im))
#define TIMES(a, b) fu_complex_product(a, b)
#define INVERSE(x) fu_complex_quotient((fu_complex){1.0, 0.0}, x)
#define SUBTRACT subtract

/* Subtracts from n numbers a column times a factor. */
FU_INLINE void subtract(int n, const fu_complex *restrict column, fu_complex factor, fu_complex *restrict to)
{
    for (int i = 0; i < n; ++i) fu_complex_subtract_product(&to[i], column[i], factor);
}

#include "linear/pivoted_template.h"

static void factor_columns(int n, int width, int stride, fu_complex *A, int *pivot, int *info);
FU_SIMD_FUNCTION(factor_columns, complex_factor, (int n, int width, int stride, fu_complex *A, int *pivot, int *info),
                 (n, width, stride, A, pivot, info))

/* Factors A = P L U in place; returns 0, or 1 + the index of the first zero pivot, and A is not factored. */
int fu_complex_pivoted_factor(int n, int width, int stride, fu_complex *A, int *pivot)
{
    int info;
    factor_columns(n, width, stride, A, pivot, &info);
    return info;
}

/* Computes x = A^-1 x with the factors of fu_complex_pivoted_factor. */
FU_SIMD_FUNCTION(fu_complex_pivoted_solve, complex_solve,
                 (int n, int width, int stride, const fu_complex *A, const int *pivot, fu_complex *x),
                 (n, width, stride, A, pivot, x))
