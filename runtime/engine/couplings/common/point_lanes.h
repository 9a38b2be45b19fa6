/* Private: operations on a number of each point of a block, inlined. */
#ifndef FUNICULAR_COUPLINGS_COMMON_POINT_LANES_H
#define FUNICULAR_COUPLINGS_COMMON_POINT_LANES_H

#include "base/simd.h"
#include "point_blocks.h"

/* Numbers of two blocks by their places in both, those of the second after those of the first. */
#if defined(__clang__) || __GNUC__ >= 12
#define FU_SHUFFLE(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#else
#define FU_SHUFFLE(a, b, ...)                                                                                          \
    __builtin_shuffle(a, b, (long long __attribute__((vector_size(8 * FU_BLOCK_POINTS)))){__VA_ARGS__})
#endif

_Static_assert(FU_BLOCK_POINTS == 4, "sums over a block are of four points");

/* Adds the sums over the points of n numbers to `to`, times a factor. */
FU_INLINE void fu_add_sums(int n, double factor, const fu_points *x, double *to)
{
    int m = 0;
    for (; m + 4 <= n; m += 4) {
        const fu_points ab = FU_SHUFFLE(x[m], x[m + 1], 0, 4, 2, 6) + FU_SHUFFLE(x[m], x[m + 1], 1, 5, 3, 7);
        const fu_points cd = FU_SHUFFLE(x[m + 2], x[m + 3], 0, 4, 2, 6) + FU_SHUFFLE(x[m + 2], x[m + 3], 1, 5, 3, 7);
        const fu_points sums = FU_SHUFFLE(ab, cd, 0, 1, 4, 5) + FU_SHUFFLE(ab, cd, 2, 3, 6, 7);
        *(fu_simd_block *)(to + m) += factor * sums;
    }
    for (; m < n; ++m) to[m] += factor * ((x[m][0] + x[m][1]) + (x[m][2] + x[m][3]));
}

/* Calls an inlined function with the dimension and the number of shape functions of the usual elements as constants,
 * which unrolls its loops. */
#define FU_BY_SHAPES(function, dim, n, ...)                                                                            \
    if (dim == 2 && n == 4) function(2, 4, __VA_ARGS__);                                                               \
    else if (dim == 3 && n == 4) function(3, 4, __VA_ARGS__);                                                          \
    else function(dim, n, __VA_ARGS__)

#endif
