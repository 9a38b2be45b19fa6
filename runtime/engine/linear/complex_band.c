/* Complex band matrices that are symmetric, or nearly so, factored without pivots: A = L D L', or A = L D U'.
 *
 * The stages of Radau IIA have A = M + z D + z^2 K with z = h/L and an argument of -49 degrees. Times conj(z)/|z|,
 * the real part of A is cos 49 (M + |z|^2 K) + |z| D. It is positive definite if the real system's M + s D + s^2 K
 * is, since |z| < s = h/gamma and D is dissipative. The values x* A x then lie in a sector of less than a half
 * plane. So do those of the inverse, of its diagonal blocks, and of their inverses, the Schur complements: no pivot
 * is small beside its column. The unsymmetric part must be small, as in unsymmetric_band.c.
 *
 * Storage: columns of the lower triangle from the diagonal down, FU_COMPLEX_STRIDE numbers each with zeros beyond
 * the band, real and imaginary parts apart; those of the upper one, transposed, likewise. */
#include "base/simd.h"
#include "linear/complex_system.h"

/* of the diagonal: least pivot of a matrix that is not symmetric */
#define MIN_PIVOT 1e-8

/* Returns 1 / d. */
static fu_complex inverse_of(double re, double im)
{
    return fu_complex_quotient((fu_complex){1.0, 0.0}, (fu_complex){re, im});
}

/* Computes y -= a f over whole SIMD blocks, for n numbers. */
FU_INLINE void subtract(int n, const double *a_re, const double *a_im, fu_complex f, double *y_re, double *y_im)
{
    for (int i = 0; i < n; i += FU_SIMD_WIDTH) {
        const fu_simd_block re = *(const fu_simd_block *)(a_re + i), im = *(const fu_simd_block *)(a_im + i);
        *(fu_simd_block *)(y_re + i) -= re * f.re - im * f.im;
        *(fu_simd_block *)(y_im + i) -= re * f.im + im * f.re;
    }
}

/* Scales a column with `below` entries below the diagonal to one of L or U. */
FU_INLINE void scale_column(int below, fu_complex scale, double *re, double *im)
{
    for (int k = 1; k <= below; ++k) {
        const fu_complex scaled = fu_complex_product((fu_complex){re[k], im[k]}, scale);
        re[k] = scaled.re;
        im[k] = scaled.im;
    }
    re[0] = scale.re;
    im[0] = scale.im;
}

FU_INLINE void factor(int n, int width, double *re, double *im)
{
    const int stride = FU_COMPLEX_STRIDE(width);
    for (int j = 0; j < n; ++j) {
        double *a = re + (long)j * stride, *b = im + (long)j * stride;
        const int below = n - 1 - j < width ? n - 1 - j : width;
        const fu_complex scale = inverse_of(a[0], b[0]);
        for (int k = 1; k <= below; ++k) {
            const fu_complex entry = {a[k], b[k]}, scaled = fu_complex_product(entry, scale);
            double *other_re = a + (long)k * stride, *other_im = b + (long)k * stride;
            subtract(width + 1 - k, a + k, b + k, scaled, other_re, other_im);
        }
        scale_column(below, scale, a, b);
    }
}

/* The diagonal of U keeps that of A until its column is reached. */
FU_INLINE void factor_unsymmetric(int n, int width, double *const L[2], double *const U[2], int *failed)
{
    const int stride = FU_COMPLEX_STRIDE(width);
    *failed = 0;
    for (int j = 0; j < n; ++j) {
        const long at = (long)j * stride;
        double *a = L[0] + at, *b = L[1] + at, *c = U[0] + at, *d = U[1] + at;
        const int below = n - 1 - j < width ? n - 1 - j : width;
        if (!(a[0] * a[0] + b[0] * b[0] > MIN_PIVOT * MIN_PIVOT * (c[0] * c[0] + d[0] * d[0]))) {
            *failed = 1;
            return;
        }
        const fu_complex scale = inverse_of(a[0], b[0]);
        for (int k = 1; k <= below; ++k) {
            const fu_complex by_upper = fu_complex_product((fu_complex){c[k], d[k]}, scale);
            const fu_complex by_lower = fu_complex_product((fu_complex){a[k], b[k]}, scale);
            const long other = (long)k * stride;
            subtract(width + 1 - k, a + k, b + k, by_upper, a + other, b + other);
            subtract(width - k, c + k + 1, d + k + 1, by_lower, c + other + 1, d + other + 1);
        }
        scale_column(below, scale, a, b);
        scale_column(below, scale, c, d);
    }
}

FU_INLINE void solve(int n, int width, double *const L[2], double *const U[2], int first, double *x, double *y)
{
    const int stride = FU_COMPLEX_STRIDE(width);
    for (int j = first; j < n; ++j) {
        const double *a = L[0] + (long)j * stride + 1, *b = L[1] + (long)j * stride + 1;
        subtract(width, a, b, (fu_complex){x[j], y[j]}, x + j + 1, y + j + 1);
    }
    for (int j = n - 1; j >= 0; --j) {
        const double *a = U[0] + (long)j * stride, *b = U[1] + (long)j * stride;
        fu_simd_block sum_re = {0.0}, sum_im = {0.0};
        for (int i = 1; i <= width; i += FU_SIMD_WIDTH) {
            const fu_simd_block l_re = *(const fu_simd_block *)(a + i), l_im = *(const fu_simd_block *)(b + i);
            const fu_simd_block x_re = *(const fu_simd_block *)(x + j + i), x_im = *(const fu_simd_block *)(y + j + i);
            sum_re += l_re * x_re - l_im * x_im;
            sum_im += l_re * x_im + l_im * x_re;
        }
        const fu_complex scaled = fu_complex_product((fu_complex){x[j], y[j]}, (fu_complex){a[0], b[0]});
        x[j] = scaled.re - ((sum_re[0] + sum_re[1]) + (sum_re[2] + sum_re[3]));
        y[j] = scaled.im - ((sum_im[0] + sum_im[1]) + (sum_im[2] + sum_im[3]));
    }
}

FU_INLINE void add(int n, int width, const double *K, fu_complex factor, double *re, double *im)
{
    const int rows = width + 1, whole = rows - rows % FU_SIMD_WIDTH;
    for (int j = 0; j < n; ++j, re += FU_COMPLEX_STRIDE(width), im += FU_COMPLEX_STRIDE(width)) {
        const double *below = K + (long)j * FU_BAND_ROWS(width) + FU_BAND_DIAGONAL(width);
        for (int i = 0; i < whole; i += FU_SIMD_WIDTH) {
            *(fu_simd_block *)(re + i) += *(const fu_simd_block *)(below + i) * factor.re;
            *(fu_simd_block *)(im + i) += *(const fu_simd_block *)(below + i) * factor.im;
        }
        for (int i = whole; i < rows; ++i) {
            re[i] += below[i] * factor.re;
            im[i] += below[i] * factor.im;
        }
    }
}

/* Adds the lower half of a real band, in LAPACK's storage, times a factor. */
FU_SIMD_FUNCTION(fu_complex_band_add, add,
                 (int n, int width, const double *K, fu_complex factor, double *re, double *im),
                 (n, width, K, factor, re, im))

/* Factors in place: L below the diagonal, 1/D on it. */
FU_SIMD_FUNCTION(fu_complex_band_factor, factor, (int n, int width, double *re, double *im), (n, width, re, im))

static void unsymmetric_by_blocks(int n, int width, double *const L[2], double *const U[2], int *failed);
FU_SIMD_FUNCTION(unsymmetric_by_blocks, factor_unsymmetric,
                 (int n, int width, double *const L[2], double *const U[2], int *failed), (n, width, L, U, failed))

/* Factors in place: L and U' below the diagonal, 1/D on both; returns nonzero if a pivot is too small. */
int fu_complex_unsymmetric_factor(int n, int width, double *const L[2], double *const U[2])
{
    int failed;
    unsymmetric_by_blocks(n, width, L, U, &failed);
    return failed;
}

/* Computes x + i y = A^-1 (x + i y), zero before `first`, for a symmetric A with L as U. FU_COMPLEX_BEYOND numbers of
 * both beyond n are finite and kept. */
FU_SIMD_FUNCTION(fu_complex_band_solve, solve,
                 (int n, int width, double *const L[2], double *const U[2], int first, double *x, double *y),
                 (n, width, L, U, first, x, y))
