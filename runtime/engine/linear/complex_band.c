/* Complex symmetric band matrices, factored without pivots: A = L D L'.
 *
 * The stages of Radau IIA have A = M + z D + z^2 K with z = h/L and an argument of -49 degrees. Times conj(z)/|z|, the real part of
 * A is cos 49 (M + |z|^2 K) + |z| D, and positive definite where the real system's M + s D + s^2 K is, as |z| < s = h/gamma and
 * D takes energy. The values x* A x then lie in a sector of less than a half plane. So do those of the inverse, of its
 * diagonal blocks, and of their inverses, the Schur complements: no pivot is small beside its column.
 *
 * Storage: columns of the lower triangle from the diagonal down, FU_COMPLEX_STRIDE numbers each with zeros beyond the band, real
 * and imaginary parts apart. */
#include "complex_system.h"

#include "lanes.h"

/* Returns 1 / d. */
static fu_complex inverse_of(double re, double im)
{
    return fu_complex_quotient((fu_complex){1.0, 0.0}, (fu_complex){re, im});
}

/* Makes y -= a f over whole lanes, for n numbers. */
FU_INLINE void subtract(int n, const double *a_re, const double *a_im, fu_complex f, double *y_re, double *y_im)
{
    for (int i = 0; i < n; i += FU_LANES) {
        const fu_lanes re = *(const fu_lanes *)(a_re + i), im = *(const fu_lanes *)(a_im + i);
        *(fu_lanes *)(y_re + i) -= re * f.re - im * f.im;
        *(fu_lanes *)(y_im + i) -= re * f.im + im * f.re;
    }
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
        for (int k = 1; k <= below; ++k) {
            const fu_complex scaled = fu_complex_product((fu_complex){a[k], b[k]}, scale);
            a[k] = scaled.re;
            b[k] = scaled.im;
        }
        a[0] = scale.re;
        b[0] = scale.im;
    }
}

FU_INLINE void solve(int n, int width, const double *re, const double *im, double *x, double *y)
{
    const int stride = FU_COMPLEX_STRIDE(width);
    for (int j = 0; j < n; ++j) {
        const double *a = re + (long)j * stride + 1, *b = im + (long)j * stride + 1;
        subtract(width, a, b, (fu_complex){x[j], y[j]}, x + j + 1, y + j + 1);
    }
    for (int j = n - 1; j >= 0; --j) {
        const double *a = re + (long)j * stride, *b = im + (long)j * stride;
        fu_lanes sum_re = {0.0}, sum_im = {0.0};
        for (int i = 1; i <= width; i += FU_LANES) {
            const fu_lanes l_re = *(const fu_lanes *)(a + i), l_im = *(const fu_lanes *)(b + i);
            const fu_lanes x_re = *(const fu_lanes *)(x + j + i), x_im = *(const fu_lanes *)(y + j + i);
            sum_re += l_re * x_re - l_im * x_im;
            sum_im += l_re * x_im + l_im * x_re;
        }
        const fu_complex own = fu_complex_product((fu_complex){x[j], y[j]}, (fu_complex){a[0], b[0]});
        x[j] = own.re - ((sum_re[0] + sum_re[1]) + (sum_re[2] + sum_re[3]));
        y[j] = own.im - ((sum_im[0] + sum_im[1]) + (sum_im[2] + sum_im[3]));
    }
}

FU_INLINE void add(int n, int width, const double *K, fu_complex factor, double *re, double *im)
{
    const int rows = width + 1, whole = rows - rows % FU_LANES;
    for (int j = 0; j < n; ++j, re += FU_COMPLEX_STRIDE(width), im += FU_COMPLEX_STRIDE(width)) {
        const double *below = K + (long)j * FU_BAND_ROWS(width) + FU_BAND_DIAGONAL(width);
        for (int i = 0; i < whole; i += FU_LANES) {
            *(fu_lanes *)(re + i) += *(const fu_lanes *)(below + i) * factor.re;
            *(fu_lanes *)(im + i) += *(const fu_lanes *)(below + i) * factor.im;
        }
        for (int i = whole; i < rows; ++i) {
            re[i] += below[i] * factor.re;
            im[i] += below[i] * factor.im;
        }
    }
}

/* Adds the lower half of a real band, in LAPACK's storage, times a factor. */
FU_IN_LANES(fu_complex_band_add, add, (int n, int width, const double *K, fu_complex factor, double *re, double *im),
            (n, width, K, factor, re, im))

/* Factors in place: L below the diagonal, 1/D on it. */
FU_IN_LANES(fu_complex_band_factor, factor, (int n, int width, double *re, double *im), (n, width, re, im))

/* Makes x + i y = A^-1 (x + i y); both go on FU_COMPLEX_BEYOND numbers beyond n, which are finite and stay. */
FU_IN_LANES(fu_complex_band_solve, solve, (int n, int width, const double *re, const double *im, double *x, double *y),
            (n, width, re, im, x, y))
