/* Symmetric positive definite band matrices: Cholesky factorisation by LAPACK, substitution here. LAPACK calls a
 * BLAS kernel for each column, which takes three times as long as the arithmetic of the short columns of cables
 * (tests/benchmarks/linear_cost.py).
 *
 * Storage: columns of the lower triangle from the diagonal down, width + 1 each, and columns of a unit matrix up to
 * a whole number of groups, whose columns are eliminated at once. */
#include "linear/linear.h"

/* Converts Cholesky's columns to those of L D L': L below the diagonal, 1/D on it. */
void fu_band_scale(int n, int width, double *A)
{
    for (int j = 0; j < n; ++j) {
        double *column = A + (long)j * (width + 1);
        const double scale = 1.0 / column[0];
        for (int i = 1; i <= width; ++i) column[i] *= scale;
        column[0] = scale * scale;
    }
}

/* Factors A = L D L': L below the diagonal, 1/D on it; returns nonzero if A is not positive definite. */
int fu_band_factor(const fu_lapack *lapack, int n, int width, double *A)
{
    int stride = width + 1, info = 0;
    if (n) lapack->dpbtrf("L", &n, &width, A, &stride, &info);
    if (!info) fu_band_scale(n, width, A);
    for (int j = n; j % FU_BAND_GROUP; ++j) A[(long)j * stride] = 1.0;
    return info;
}

/* Computes x = L^-1 x, with x zero before `first`, for the groups of columns that begin before n. */
void fu_band_forward(int n, int width, const double *A, int first, double *x)
{
    const int stride = width + 1;
    for (int j = first - first % FU_BAND_GROUP; j < n; j += FU_BAND_GROUP) {
        /* columns j ... j + 3 from row j on: entry k is that of row j + k */
        const double *a = A + (long)j * stride, *b = a + width, *c = b + width, *d = c + width;
        double *restrict y = x + j;
        const double x0 = y[0], x1 = y[1] - a[1] * x0, x2 = y[2] - a[2] * x0 - b[2] * x1;
        const double x3 = y[3] - a[3] * x0 - b[3] * x1 - c[3] * x2;
        for (int k = 4; k < stride; ++k) y[k] -= a[k] * x0 + b[k] * x1 + c[k] * x2 + d[k] * x3;
        y[stride] -= b[stride] * x1 + c[stride] * x2 + d[stride] * x3;
        y[stride + 1] -= c[stride + 1] * x2 + d[stride + 1] * x3;
        y[stride + 2] -= d[stride + 2] * x3;
        y[1] = x1;
        y[2] = x2;
        y[3] = x3;
    }
}

/* Computes x = L'^-1 D^-1 x for the same groups. */
void fu_band_backward(int n, int width, const double *A, double *x)
{
    const int stride = width + 1;
    for (int j = (n - 1) / FU_BAND_GROUP * FU_BAND_GROUP; j >= 0; j -= FU_BAND_GROUP) {
        const double *a = A + (long)j * stride, *b = a + width, *c = b + width, *d = c + width;
        double *y = x + j, x0 = y[0] * a[0], x1 = y[1] * b[1], x2 = y[2] * c[2], x3 = y[3] * d[3];
        x1 -= b[stride] * y[stride];
        x2 -= c[stride] * y[stride] + c[stride + 1] * y[stride + 1];
        x3 -= d[stride] * y[stride] + d[stride + 1] * y[stride + 1] + d[stride + 2] * y[stride + 2];
        for (int k = 4; k < stride; ++k) {
            x0 -= a[k] * y[k];
            x1 -= b[k] * y[k];
            x2 -= c[k] * y[k];
            x3 -= d[k] * y[k];
        }
        x2 -= c[3] * x3;
        x1 -= b[2] * x2 + b[3] * x3;
        y[0] = x0 - (a[1] * x1 + a[2] * x2 + a[3] * x3);
        y[1] = x1;
        y[2] = x2;
        y[3] = x3;
    }
}

/* Computes x = A^-1 x, with x zero before `first`. FU_BAND_BEYOND(width) entries of x beyond n are read and kept; they
 * must be finite. */
void fu_band_solve(int n, int width, const double *A, int first, double *x)
{
    fu_band_forward(n, width, A, first, x);
    if (n) fu_band_backward(n, width, A, x);
}
