/* Substitution in a factored band with pivots (banded_front_template.h), four columns at once, one after the other: the
 * unknowns pass through the registers once for them. */
#ifndef FUNICULAR_LINEAR_BANDED_COLUMNS_H
#define FUNICULAR_LINEAR_BANDED_COLUMNS_H

#include "linear/columns.h"
#include "linear/fronts.h"

FU_INLINE int in_blocks(int rows)
{
    return (rows + FU_SIMD_WIDTH - 1) / FU_SIMD_WIDTH * FU_SIMD_WIDTH;
}

FU_INLINE void exchange(double *x, int one, int other)
{
    const double saved = x[one];
    x[one] = x[other];
    x[other] = saved;
}

/* Eliminates the columns of L, four at once where only the first of them exchanges rows. */
FU_INLINE void eliminate_banded(const fu_banded_front *b, double *restrict x)
{
    const int n = b->n, lower = b->lower, stride = fu_banded_stride(b), rows = in_blocks(lower);
    const double *diagonal = b->band + b->lower + b->upper;
    for (int j = 0; j < n;) {
        const int *pivot = b->pivot + j;
        exchange(x, j, *pivot - 1);
        double *y = x + j;
        if (j + 4 + rows > n || pivot[1] != j + 2 || pivot[2] != j + 3 || pivot[3] != j + 4) {
            subtract_one(n - 1 - j < lower ? n - 1 - j : lower, diagonal + 1, *y, y + 1);
            diagonal += stride;
            ++j;
            continue;
        }
        const double *const a = diagonal, *c = a + stride - 1, *d = c + stride - 1, *e = d + stride - 1;
        double factor[4] = {y[0], y[1], y[2], y[3]};
        factor[1] -= a[1] * factor[0];
        factor[2] -= a[2] * factor[0];
        factor[2] -= c[2] * factor[1];
        factor[3] -= a[3] * factor[0];
        factor[3] -= c[3] * factor[1];
        factor[3] -= d[3] * factor[2];
        for (int i = 1; i < 4; ++i) y[i] = factor[i];
        subtract_in_turn(4, 4 + rows, (const double *const[4]){a, c, d, e}, factor, y);
        diagonal += 4 * (long)stride;
        j += 4;
    }
}

/* Solves with a factored band in place, in its order. */
FU_INLINE void substitute_banded(const fu_banded_front *b, double *restrict x)
{
    const int n = b->n, upper = b->lower + b->upper, stride = fu_banded_stride(b), rows = in_blocks(upper);
    eliminate_banded(b, x);
    const double *a = b->band + upper + (long)(n - 1) * stride;
    int j = n - 1;
    for (; j - 3 >= rows; j -= 4, a -= 4 * (long)stride) {
        const double *c = a - stride + 1, *d = c - stride + 1, *e = d - stride + 1;
        double *y = x + j, factor[4] = {y[0], y[-1], y[-2], y[-3]};
        factor[0] /= a[0];
        factor[1] -= a[-1] * factor[0];
        factor[1] /= c[-1];
        factor[2] -= a[-2] * factor[0];
        factor[2] -= c[-2] * factor[1];
        factor[2] /= d[-2];
        factor[3] -= a[-3] * factor[0];
        factor[3] -= c[-3] * factor[1];
        factor[3] -= d[-3] * factor[2];
        factor[3] /= e[-3];
        for (int i = 0; i < 4; ++i) y[-i] = factor[i];
        subtract_in_turn(-3 - rows, -3, (const double *const[4]){a, c, d, e}, factor, y);
    }
    for (; j >= 0; --j, a -= stride) {
        const int most = j < upper ? j : upper;
        x[j] /= a[0];
        subtract_one(most, a - most, x[j], x + j - most);
    }
}

#endif
