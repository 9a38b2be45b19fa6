/* The inverse of a short band matrix that is factored once and used in every evaluation, such as the mass matrix. A
 * product with it has more terms than a substitution, but they are independent of each other: it takes a fifth of the
 * time for 42 unknowns. */
#include "base/simd.h"
#include "linear/linear.h"

/* Computes the inverse, FU_INVERSE_ROWS a column, of a matrix factored in L (band.c). */
void fu_inverse_make(int n, int width, const double *L, double *inverse)
{
    const int rows = FU_INVERSE_ROWS(n);
    double x[FU_BAND_LENGTH(FU_MAX_INVERTED, FU_MAX_INVERTED)];
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < FU_BAND_LENGTH(n, width); ++i) x[i] = i == j;
        fu_band_solve(n, width, L, j, x);
        for (int i = 0; i < rows; ++i) inverse[(long)j * rows + i] = i < n ? x[i] : 0.0;
    }
}

FU_INLINE void times(int rows, const double *inverse, int first, int end, const double *b, double *x)
{
    for (int i = 0; i < rows; i += FU_INVERSE_GROUP) {
        const double *column = inverse + (long)first * rows + i;
        fu_simd_block sum[FU_INVERSE_GROUP / FU_SIMD_WIDTH] = {{0.0}};
        for (int j = first; j < end; ++j, column += rows)
            for (int k = 0; k < FU_INVERSE_GROUP / FU_SIMD_WIDTH; ++k)
                sum[k] += *(const fu_simd_block *)(column + k * FU_SIMD_WIDTH) * b[j];
        for (int k = 0; k < FU_INVERSE_GROUP / FU_SIMD_WIDTH; ++k)
            *(fu_simd_block *)(x + i + k * FU_SIMD_WIDTH) = sum[k];
    }
}

/* Computes x, FU_INVERSE_ROWS numbers, as the inverse times b, which is zero outside of [first, end). */
FU_SIMD_FUNCTION(fu_inverse_times, times,
                 (int rows, const double *inverse, int first, int end, const double *b, double *x),
                 (rows, inverse, first, end, b, x))
