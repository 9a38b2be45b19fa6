/* Elimination of the columns of a full matrix, and substitution in them, four pivots at once, which then pass through
 * memory once. Columns follow each other, n numbers each: below the diagonal those of L, on it 1 over that of U. */
#ifndef FUNICULAR_LINEAR_COLUMNS_H
#define FUNICULAR_LINEAR_COLUMNS_H

#include "base/simd.h"

/* Subtracts from n numbers the sum of four columns times a factor each. */
FU_INLINE void subtract_four(long n, const double *const column[4], const double factor[4], double *restrict to)
{
    const double *a = column[0], *b = column[1], *c = column[2], *d = column[3];
    const double w = factor[0], x = factor[1], y = factor[2], z = factor[3];
    long i = 0;
    for (; i + FU_SIMD_WIDTH <= n; i += FU_SIMD_WIDTH)
        *(fu_simd_block *)(to + i) -= *(const fu_simd_block *)(a + i) * w + *(const fu_simd_block *)(b + i) * x +
                                      *(const fu_simd_block *)(c + i) * y + *(const fu_simd_block *)(d + i) * z;
    for (; i < n; ++i) to[i] -= a[i] * w + b[i] * x + c[i] * y + d[i] * z;
}

/* Subtracts from n numbers a column times a factor. */
FU_INLINE void subtract_one(long n, const double *column, double factor, double *restrict to)
{
    long i = 0;
    for (; i + FU_SIMD_WIDTH <= n; i += FU_SIMD_WIDTH)
        *(fu_simd_block *)(to + i) -= *(const fu_simd_block *)(column + i) * factor;
    for (; i < n; ++i) to[i] -= column[i] * factor;
}

/* Subtracts from the rows `first` to `end`, in whole blocks, four columns times a factor each. */
FU_INLINE void subtract_in_turn(int first, int end, const double *const column[4], const double factor[4], double *x)
{
    for (int k = first; k < end; k += FU_SIMD_WIDTH) {
        fu_simd_block of = *(fu_simd_block *)(x + k);
        of -= *(const fu_simd_block *)(column[0] + k) * factor[0];
        of -= *(const fu_simd_block *)(column[1] + k) * factor[1];
        of -= *(const fu_simd_block *)(column[2] + k) * factor[2];
        of -= *(const fu_simd_block *)(column[3] + k) * factor[3];
        *(fu_simd_block *)(x + k) = of;
    }
}

/* Computes the factors of four pivots from k on in a column, and eliminates them from each other. */
FU_INLINE void factors_of_four(const double *F, int n, int k, double *restrict column, double factor[4])
{
    const double *a = F + k * n, *b = a + n, *c = b + n;
    factor[0] = column[k];
    factor[1] = column[k + 1] - a[k + 1] * factor[0];
    factor[2] = column[k + 2] - a[k + 2] * factor[0] - b[k + 2] * factor[1];
    factor[3] = column[k + 3] - a[k + 3] * factor[0] - b[k + 3] * factor[1] - c[k + 3] * factor[2];
    for (int i = 1; i < 4; ++i) column[k + i] = factor[i];
}

/* Eliminates four pivots from k on from a column of n. */
FU_INLINE void eliminate_four(const double *F, int n, int k, double *restrict column)
{
    const double *a = F + k * n + k + 4, *b = a + n, *c = b + n, *d = c + n;
    double factor[4];
    factors_of_four(F, n, k, column, factor);
    subtract_four(n - k - 4, (const double *const[4]){a, b, c, d}, factor, column + k + 4);
}

FU_INLINE void eliminate_one(const double *F, int n, int k, double *restrict column)
{
    subtract_one(n - k - 1, F + k * n + k + 1, column[k], column + k + 1);
}

/* Eliminates the pivots `from` to `to` from a column of n, four at once, which then pass through memory once. */
FU_INLINE void eliminated(const double *F, int n, int from, int to, double *restrict column)
{
    int k = from;
    for (; k + 4 <= to; k += 4) eliminate_four(F, n, k, column);
    for (; k < to; ++k) eliminate_one(F, n, k, column);
}

/* Computes the four pivots before k from their right side, and subtracts their contribution from the right side of
 * those before them. */
FU_INLINE void substitute_four(const double *F, int n, int k, double *restrict x)
{
    const double *d = F + (k - 1) * n, *c = d - n, *b = c - n, *a = b - n;
    const double x3 = x[k - 1] * d[k - 1], x2 = (x[k - 2] - d[k - 2] * x3) * c[k - 2];
    const double x1 = (x[k - 3] - c[k - 3] * x2 - d[k - 3] * x3) * b[k - 3];
    const double x0 = (x[k - 4] - b[k - 4] * x1 - c[k - 4] * x2 - d[k - 4] * x3) * a[k - 4];
    x[k - 1] = x3;
    x[k - 2] = x2;
    x[k - 3] = x1;
    x[k - 4] = x0;
    subtract_four(k - 4, (const double *const[4]){a, b, c, d}, (const double[4]){x0, x1, x2, x3}, x);
}

FU_INLINE void substitute_one(const double *F, int n, int k, double *restrict x)
{
    const double *d = F + (k - 1) * n;
    x[k - 1] *= d[k - 1];
    subtract_one(k - 1, d, x[k - 1], x);
}

#endif
