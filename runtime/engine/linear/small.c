/* Small full matrices by columns: the border of a scene of few bodies, where LAPACK's calls take longer than their
 * arithmetic. */
#include "linear/linear.h"

#include <math.h>

/* Returns the row of the largest entry of a column, from the diagonal down. */
static int pivot_of(int n, const double *column, int diagonal)
{
    int largest = diagonal;
    for (int i = diagonal + 1; i < n; ++i)
        if (fabs(column[i]) > fabs(column[largest])) largest = i;
    return largest;
}

/* Factors A = P L U in place, with row pivots; the diagonal has 1 over that of U. Returns 0, or 1 + the index of the
 * first zero pivot. */
int fu_small_factor(int n, double *A, int *pivot)
{
    int info = 0;
    for (int j = 0; j < n; ++j) {
        double *column = A + j * n;
        const int p = pivot[j] = pivot_of(n, column, j);
        if (column[p] == 0.0) {
            if (!info) info = j + 1;
            continue;
        }
        if (p != j)
            for (int k = 0; k < n; ++k) {
                const double saved = A[k * n + j];
                A[k * n + j] = A[k * n + p];
                A[k * n + p] = saved;
            }
        const double scale = 1.0 / column[j];
        column[j] = scale;
        for (int i = j + 1; i < n; ++i) column[i] *= scale;
        for (int k = j + 1; k < n; ++k) {
            double *other = A + k * n;
            const double factor = other[j];
            for (int i = j + 1; i < n; ++i) other[i] -= column[i] * factor;
        }
    }
    return info;
}

/* Computes x = A^-1 x with the factors of fu_small_factor. */
void fu_small_solve(int n, const double *A, const int *pivot, double *x)
{
    for (int j = 0; j < n; ++j) {
        const double saved = x[pivot[j]];
        x[pivot[j]] = x[j];
        x[j] = saved;
    }
    for (int j = 0; j < n; ++j)
        for (int i = j + 1; i < n; ++i) x[i] -= A[j * n + i] * x[j];
    for (int j = n - 1; j >= 0; --j) {
        x[j] *= A[j * n + j];
        for (int i = 0; i < j; ++i) x[i] -= A[j * n + i] * x[j];
    }
}
