/* Small full matrices by columns: scenes of few unknowns, and borders of few bodies, where LAPACK's calls take longer
 * than their arithmetic. Each column is eliminated at once by all pivots before it, four of them at a time. */
#include "linear/columns.h"
#include "linear/linear.h"

#include <math.h>

/* of the root of the sum of squares of a column: smallest diagonal that is a pivot without a search for a larger one.
 * Rounding grows by at most its inverse. */
#define PIVOT_THRESHOLD 0.1

/* Returns the sum of squares of n numbers. */
FU_INLINE double sum_of_squares(int n, const double *x)
{
    fu_simd_block sums = {0.0};
    int i = 0;
    for (; i + FU_SIMD_WIDTH <= n; i += FU_SIMD_WIDTH)
        sums += *(const fu_simd_block *)(x + i) * *(const fu_simd_block *)(x + i);
    double sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    for (; i < n; ++i) sum += x[i] * x[i];
    return sum;
}

/* Returns the row of the pivot of a column: its diagonal if that is large enough, else the largest entry below. */
FU_INLINE int pivot_of(int n, const double *column, int diagonal)
{
    const double least = PIVOT_THRESHOLD * PIVOT_THRESHOLD * sum_of_squares(n - diagonal, column + diagonal);
    int largest = diagonal;
    if (least > 0.0 && column[diagonal] * column[diagonal] >= least) return diagonal;
    for (int i = diagonal + 1; i < n; ++i)
        if (fabs(column[i]) > fabs(column[largest])) largest = i;
    return largest;
}

FU_INLINE void exchange(double *a, double *b)
{
    const double saved = *a;
    *a = *b;
    *b = saved;
}

/* x = factor x */
FU_INLINE void scale(int n, double factor, double *x)
{
    int i = 0;
    for (; i + FU_SIMD_WIDTH <= n; i += FU_SIMD_WIDTH) *(fu_simd_block *)(x + i) *= factor;
    for (; i < n; ++i) x[i] *= factor;
}

FU_INLINE void factor(int n, double *A, int *pivot, int *info)
{
    int exchanged[FU_MAX_SMALL], n_exchanged = 0;
    for (int j = 0; j < n; ++j) {
        double *column = A + j * n;
        for (int i = 0; i < n_exchanged; ++i) exchange(column + exchanged[i], column + pivot[exchanged[i]]);
        eliminated(A, n, 0, j, column);
        const int p = pivot[j] = pivot_of(n, column, j);
        if (column[p] == 0.0) {
            *info = j + 1;
            return;
        }
        if (p != j) {
            exchanged[n_exchanged++] = j;
            for (int k = 0; k <= j; ++k) exchange(A + k * n + j, A + k * n + p);
        }
        column[j] = 1.0 / column[j];
        scale(n - j - 1, column[j], column + j + 1);
    }
    *info = 0;
}

static void factor_by_blocks(int n, double *A, int *pivot, int *info);
FU_SIMD_FUNCTION(factor_by_blocks, factor, (int n, double *A, int *pivot, int *info), (n, A, pivot, info))

/* Factors A = P L U in place, with row pivots; the diagonal has 1 over that of U. Returns 0, or 1 + the index of the
 * first zero pivot, and A is not factored. */
int fu_small_factor(int n, double *A, int *pivot)
{
    int info;
    factor_by_blocks(n, A, pivot, &info);
    return info;
}

FU_INLINE void solve(int n, const double *A, const int *pivot, double *x)
{
    for (int j = 0; j < n; ++j)
        if (pivot[j] != j) exchange(x + j, x + pivot[j]);
    int zeros = 0; /* first ones of the right side, such as those of the band for gaps of constraints */
    while (zeros + 4 <= n && x[zeros] == 0.0 && x[zeros + 1] == 0.0 && x[zeros + 2] == 0.0 && x[zeros + 3] == 0.0)
        zeros += 4;
    eliminated(A, n, zeros, n, x);
    int k = n;
    for (; k >= 4; k -= 4) substitute_four(A, n, k, x);
    for (; k > 0; --k) substitute_one(A, n, k, x);
}

/* Computes x = A^-1 x with the factors of fu_small_factor. */
FU_SIMD_FUNCTION(fu_small_solve, solve, (int n, const double *A, const int *pivot, double *x), (n, A, pivot, x))
