/* Random systems of the engine's own linear algebra: bands, complex bands, inverses of bands, small matrices, bands
 * with pivots. Prints the largest residual of each, of 400, in units of rounding; tests/engine/test_small_systems.py.
 */
#include "linear/complex_system.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>

enum { CASES = 400, MAX_SIZE = FU_MAX_INVERTED, MAX_WIDTH = 32, WIDE = 48 };

static double A[MAX_SIZE * MAX_SIZE], x[4 * MAX_SIZE], y[4 * MAX_SIZE], bx[MAX_SIZE], by[MAX_SIZE];

static double number(void)
{
    return rand() / (double)RAND_MAX - 0.5;
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

/* Makes K the lower half of A, as LAPACK has it, or the lower half of its transpose. */
static void half_of(int n, int width, int transposed, double *K)
{
    for (int i = 0; i < FU_BAND_ROWS(width) * n; ++i) K[i] = 0.0;
    for (int j = 0; j < n; ++j)
        for (int i = j; i < n && i - j <= width; ++i)
            K[j * FU_BAND_ROWS(width) + FU_BAND_DIAGONAL(width) + i - j] = transposed ? A[j * n + i] : A[i * n + j];
}

/* A complex band, symmetric or not, factored and solved with: what is left of its equations. */
static double complex_band(int n, int width, int symmetric)
{
    static double K[FU_BAND_ROWS(MAX_WIDTH) * MAX_SIZE], halves[4][FU_COMPLEX_STRIDE(MAX_WIDTH) * MAX_SIZE];
    double *const L[2] = {halves[0], halves[1]}, *const U[2] = {halves[2], halves[3]};
    const fu_complex factor = {0.3, -0.8};
    double worst = 0.0;
    for (int i = 0; i < n * n; ++i) A[i] = 0.0;
    for (int i = 0; i < FU_COMPLEX_STRIDE(width) * n; ++i)
        for (int half = 0; half < 4; ++half) halves[half][i] = 0.0;
    for (int j = 0; j < n; ++j)
        for (int i = j; i < n && i - j <= width; ++i) {
            A[i * n + j] = A[j * n + i] = i == j ? width + 3.0 : number();
            if (i > j && !symmetric) A[j * n + i] += 0.1 * number();
        }
    for (int i = 0; i < 4 * MAX_SIZE; ++i) x[i] = y[i] = 0.0;
    for (int i = 0; i < n; ++i) {
        bx[i] = x[i] = number();
        by[i] = y[i] = number();
    }
    half_of(n, width, 0, K);
    fu_complex_band_add(n, width, K, factor, L[0], L[1]);
    half_of(n, width, 1, K);
    fu_complex_band_add(n, width, K, factor, U[0], U[1]);
    if (symmetric) fu_complex_band_factor(n, width, L[0], L[1]);
    else if (fu_complex_unsymmetric_factor(n, width, L, U)) return INFINITY;
    fu_complex_band_solve(n, width, L, symmetric ? L : U, 0, x, y);
    for (int i = 0; i < n; ++i) {
        fu_complex left = {-bx[i], -by[i]};
        for (int j = 0; j < n; ++j) {
            const fu_complex product = fu_complex_product(factor, (fu_complex){x[j], y[j]});
            left.re += A[i * n + j] * product.re;
            left.im += A[i * n + j] * product.im;
        }
        worst = larger(worst, larger(fabs(left.re), fabs(left.im)));
    }
    return worst;
}

/* Returns the residual of a symmetric positive definite band, of any width up to more than that of elements. */
static double real_band(int n, int width)
{
    static double L[(WIDE + 1) * (MAX_SIZE + WIDE + 2 * FU_BAND_GROUP)];
    const int stride = width + 1;
    double worst = 0.0;
    for (int i = 0; i < n * n; ++i) A[i] = 0.0;
    for (int i = 0; i < stride * (n + WIDE + 2 * FU_BAND_GROUP); ++i) L[i] = 0.0;
    for (int j = 0; j < n; ++j)
        for (int i = j; i < n && i - j <= width; ++i)
            A[i * n + j] = A[j * n + i] = L[j * stride + i - j] = i == j ? width + 3.0 : number();
    for (int i = 0; i < 4 * MAX_SIZE; ++i) x[i] = 0.0;
    for (int i = 0; i < n; ++i) bx[i] = x[i] = number();
    if (fu_band_factor(n, width, L)) return INFINITY;
    fu_band_solve(n, width, L, 0, x);
    for (int i = 0; i < n; ++i) {
        double left = -bx[i];
        for (int j = 0; j < n; ++j) left += A[i * n + j] * x[j];
        worst = larger(worst, fabs(left));
    }
    return worst;
}

/* The inverse of a band that is factored already, times a part of a column: how far it is from the substitution. */
static double inverse(int n, int width)
{
    static double L[(MAX_WIDTH + 1) * (MAX_SIZE + FU_BAND_GROUP)], made[FU_INVERSE_ROWS(MAX_SIZE) * MAX_SIZE],
        out[FU_INVERSE_ROWS(MAX_SIZE)];
    const int stride = width + 1, first = rand() % n, end = first + rand() % (n - first + 1);
    double worst = 0.0;
    for (int j = 0; j < n + FU_BAND_GROUP; ++j)
        for (int i = 0; i < stride; ++i) {
            const double inside = i ? 0.2 * number() : 1.0 / (2.0 + number());
            L[j * stride + i] = i + j < n ? inside : j >= n && i == 0;
        }
    for (int i = 0; i < 4 * MAX_SIZE; ++i) x[i] = 0.0;
    for (int i = 0; i < n; ++i) bx[i] = x[i] = i >= first && i < end ? number() : 0.0;
    fu_inverse_make(n, width, L, made);
    fu_inverse_times(FU_INVERSE_ROWS(n), made, first, end, bx, out);
    fu_band_solve(n, width, L, 0, x);
    for (int i = 0; i < n; ++i) worst = larger(worst, fabs(out[i] - x[i]));
    return worst;
}

/* A small full matrix: what is left of its equations, over the size of the solution. */
static double small_matrix(int n)
{
    static double LU[FU_MAX_SMALL * FU_MAX_SMALL];
    int pivot[FU_MAX_SMALL];
    double worst = 0.0, size = 1.0;
    for (int i = 0; i < n * n; ++i) LU[i] = A[i] = number();
    for (int i = 0; i < n; ++i) bx[i] = x[i] = number();
    if (fu_small_factor(n, LU, pivot)) return INFINITY;
    fu_small_solve(n, LU, pivot, x);
    for (int i = 0; i < n; ++i) size = larger(size, fabs(x[i]));
    for (int i = 0; i < n; ++i) {
        double left = -bx[i];
        for (int j = 0; j < n; ++j) left += A[j * n + i] * x[j];
        worst = larger(worst, fabs(left) / size);
    }
    return worst;
}

/* A band, or a full matrix if it is as wide, with zeros and rows that must be exchanged, and junk where the fill comes:
 * what is left of its equations with real numbers, or with the same ones times a complex factor. */
static double pivoted(int n, int width, int full, int complex)
{
    static double K[FU_BAND_ROWS(MAX_WIDTH) * MAX_SIZE];
    static fu_complex Z[FU_BAND_ROWS(MAX_WIDTH) * MAX_SIZE], z[MAX_SIZE];
    static int pivot[MAX_SIZE];
    const int stride = full ? n : FU_BAND_STRIDE(width), diagonal = full ? 0 : FU_BAND_DIAGONAL(width);
    const fu_complex factor = {0.3, -0.8};
    double worst = 0.0, size = 1.0;
    for (int i = 0; i < FU_BAND_ROWS(MAX_WIDTH) * MAX_SIZE; ++i) Z[i].re = Z[i].im = K[i] = number();
    for (int i = 0; i < n * n; ++i) A[i] = 0.0;
    for (int j = 0; j < n; ++j)
        for (int i = j > width ? j - width : 0; i < n && i - j <= width; ++i) {
            A[j * n + i] = i == j + width || rand() % 3 ? number() : 0.0;
            K[diagonal + j * stride + i] = A[j * n + i];
            Z[diagonal + j * stride + i] = (fu_complex){A[j * n + i] * factor.re, A[j * n + i] * factor.im};
        }
    for (int i = 0; i < n; ++i) {
        bx[i] = x[i] = number();
        z[i] = (fu_complex){bx[i], 0.0};
    }
    if (complex ? fu_complex_pivoted_factor(n, width, stride, Z + diagonal, pivot)
                : fu_pivoted_factor(n, width, stride, K + diagonal, pivot))
        return 0.0; /* singular: the residuals of others count */
    if (complex) fu_complex_pivoted_solve(n, width, stride, Z + diagonal, pivot, z);
    else fu_pivoted_solve(n, width, stride, K + diagonal, pivot, x);
    for (int i = 0; i < n; ++i) {
        const fu_complex product = fu_complex_product(factor, z[i]);
        if (complex) x[i] = product.re;
        y[i] = complex ? product.im : 0.0;
        size = larger(size, larger(fabs(x[i]), fabs(y[i])));
    }
    for (int i = 0; i < n; ++i) {
        double left = -bx[i], imaginary = 0.0;
        for (int j = 0; j < n; ++j) {
            left += A[j * n + i] * x[j];
            imaginary += A[j * n + i] * y[j];
        }
        worst = larger(worst, larger(fabs(left), fabs(imaginary)));
    }
    return worst / size;
}

int main(void)
{
    double real = 0.0, band = 0.0, unsymmetric = 0.0, inverted = 0.0, small = 0.0, exchanged = 0.0;
    int pivot[2];
    double singular[4] = {1.0, 2.0, 2.0, 4.0}, row[2] = {0.0, 0.0};
    fu_complex zero[4] = {{1.0, 1.0}, {2.0, 2.0}, {2.0, 2.0}, {4.0, 4.0}};
    for (int k = 0; k < CASES; ++k) {
        const int n = 1 + rand() % MAX_SIZE, width = FU_BAND_GROUP - 1 + rand() % (MAX_WIDTH - FU_BAND_GROUP);
        real = larger(real, real_band(n, FU_BAND_GROUP - 1 + rand() % (WIDE - FU_BAND_GROUP + 2)));
        band = larger(band, complex_band(n, width, 1));
        unsymmetric = larger(unsymmetric, complex_band(n, width, 0));
        inverted = larger(inverted, inverse(n, width));
        small = larger(small, small_matrix(1 + rand() % FU_MAX_SMALL));
        const int size = 1 + rand() % FU_MAX_SMALL;
        for (int complex = 0; complex < 2; ++complex) {
            exchanged = larger(exchanged, pivoted(n, rand() % MAX_WIDTH, 0, complex));
            exchanged = larger(exchanged, pivoted(size, size - 1, 1, complex));
        }
    }
    printf("%g %g %g %g %g %g", real / DBL_EPSILON, band / DBL_EPSILON, unsymmetric / DBL_EPSILON,
           inverted / DBL_EPSILON, small / DBL_EPSILON, exchanged / DBL_EPSILON);
    printf(" %d %d %d\n", fu_small_factor(2, singular, pivot), fu_pivoted_factor(2, 0, 0, row, pivot),
           fu_complex_pivoted_factor(2, 1, 2, zero, pivot));
    return 0;
}
