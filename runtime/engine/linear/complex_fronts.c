/* Elimination of the border of a complex system by fronts. */
#include "base/simd.h"
#include "linear/complex_system.h"

#define NUMBER fu_complex
#define ZERO ((fu_complex){0.0, 0.0})
#define ONE ((fu_complex){1.0, 0.0})
#define TIMES(a, b) fu_complex_product(a, b)
#define PREFIX(name) complex_##name
#define SIZE(x) (fabs((x).re) + fabs((x).im))
#define DIVIDE(x, by) fu_complex_quotient(x, by)
#define ADD(to, x) ((to).re += (x).re, (to).im += (x).im)
#define APPLY eliminated
#define APPLY_TO_TWO eliminated_from_two
#define FORWARD(F, n, done, x) eliminated(F, n, 0, done, x)
#define BACK substituted
#define FACTOR zgetrf
#define FACTOR_BAND zgbtrf
#define SUBSTITUTE substitute

/* Subtracts from n numbers a column times a factor. */
static void subtract(int n, const fu_complex *column, fu_complex factor, fu_complex *to)
{
    for (int i = 0; i < n; ++i) fu_complex_subtract_product(&to[i], column[i], factor);
}

/* Eliminates the pivots `from` to `to` from a column of n. */
static void eliminated(const fu_complex *F, int n, int from, int to, fu_complex *column)
{
    for (int k = from; k < to; ++k)
        for (int i = k + 1; i < n; ++i) fu_complex_subtract_product(&column[i], F[k * n + i], column[k]);
}

static void eliminated_from_two(const fu_complex *F, int n, int from, int to, fu_complex *column)
{
    eliminated(F, n, from, to, column);
    eliminated(F, n, from, to, column + n);
}

/* Computes the first `done` of n unknowns from their right side and the others; stride: of the columns of the
 * others. */
static void substituted(const fu_complex *F, int stride, int n, int done, fu_complex *x)
{
    for (int k = n - 1; k >= 0; --k) {
        const fu_complex *column = k < done ? F + k * n : F + done * n + (k - done) * stride;
        if (k < done) x[k] = fu_complex_product(x[k], column[k]);
        for (int i = 0; i < (k < done ? k : done); ++i) fu_complex_subtract_product(&x[i], column[i], x[k]);
    }
}

/* Solves with a factored band in place, in its order. */
static void substitute(const fu_banded_front *b, fu_complex *x)
{
    const int n = b->n, lower = b->lower, diagonal = b->lower + b->upper, stride = fu_banded_stride(b);
    const fu_complex *column = (const fu_complex *)b->band;
    for (int j = 0; j < n; ++j, column += stride) {
        const int row = b->pivot[j] - 1;
        const fu_complex saved = x[j];
        x[j] = x[row];
        x[row] = saved;
        subtract(n - 1 - j < lower ? n - 1 - j : lower, column + diagonal + 1, x[j], x + j + 1);
    }
    for (int j = n - 1; j >= 0; --j) {
        const int most = j < diagonal ? j : diagonal;
        column -= stride;
        x[j] = fu_complex_quotient(x[j], column[diagonal]);
        subtract(most, column + diagonal - most, x[j], x + j - most);
    }
}

#include "linear/fronts_template.h"

int fu_complex_fronts_factor(const fu_fronts *t, const fu_complex *matrix, fu_factors *factors, const fu_lapack *lapack)
{
    return complex_factor(t, matrix, factors, lapack);
}

void fu_complex_fronts_solve(const fu_fronts *t, const fu_factors *factors, fu_complex *y)
{
    complex_solve(t, factors, y);
}
