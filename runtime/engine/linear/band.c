/* Symmetric positive definite band matrices: factorisation and substitution. LAPACK calls a BLAS kernel for each
 * column, which takes several times as long as the arithmetic of the short columns of cables
 * (tests/benchmarks/linear_cost.py).
 *
 * Storage: columns of the lower triangle from the diagonal down, width + 1 each, and columns of a unit matrix up to
 * a whole number of groups, whose columns are eliminated at once. */
#include "base/simd.h"
#include "linear/linear.h"

#define NARROW 40 /* rows of a group with those of its last blocks, in bands of all elements alone */

/* Columns j ... j + 3 of a group from row j on: entry k is that of row j + k. */
typedef struct {
    double *a, *b, *c, *d;
} group;

FU_INLINE group group_at(int width, double *A, int j)
{
    double *a = A + (long)j * (width + 1);
    return (group){a, a + width, a + 2 * width, a + 3 * width};
}

/* y[k] -= factor x[k] for rows [first, end) */
FU_INLINE void take_column(int first, int end, double factor, const double *x, double *y)
{
    int k = first;
    for (; k + FU_SIMD_WIDTH <= end; k += FU_SIMD_WIDTH)
        *(fu_simd_block *)(y + k) -= *(const fu_simd_block *)(x + k) * factor;
    for (; k < end; ++k) y[k] -= x[k] * factor;
}

/* y[k] -= the sum of the group's columns times f for rows [first, end), where all of them have entries */
FU_INLINE void take_group(group g, int first, int end, const double *f, double *y)
{
    int k = first;
    for (; k + FU_SIMD_WIDTH <= end; k += FU_SIMD_WIDTH)
        *(fu_simd_block *)(y + k) -=
            *(const fu_simd_block *)(g.a + k) * f[0] + *(const fu_simd_block *)(g.b + k) * f[1] +
            *(const fu_simd_block *)(g.c + k) * f[2] + *(const fu_simd_block *)(g.d + k) * f[3];
    for (; k < end; ++k) y[k] -= g.a[k] * f[0] + g.b[k] * f[1] + g.c[k] * f[2] + g.d[k] * f[3];
}

/* The same for the rows beyond those of the first column, from row k on. */
FU_INLINE void take_ends(group g, int stride, int k, const double *f, double *y)
{
    if (k <= stride) y[stride] -= g.b[stride] * f[1] + g.c[stride] * f[2] + g.d[stride] * f[3];
    if (k <= stride + 1) y[stride + 1] -= g.c[stride + 1] * f[2] + g.d[stride + 1] * f[3];
    y[stride + 2] -= g.d[stride + 2] * f[3];
}

/* Eliminates the columns of a group from each other; computes 1/D. Returns whether their pivots are positive. */
FU_INLINE int eliminate_in_group(group g, int stride, double *over)
{
    over[0] = 1.0 / g.a[0];
    take_column(1, stride, g.a[1] * over[0], g.a, g.b);
    take_column(2, stride, g.a[2] * over[0], g.a, g.c);
    take_column(3, stride, g.a[3] * over[0], g.a, g.d);
    over[1] = 1.0 / g.b[1];
    take_column(2, stride + 1, g.b[2] * over[1], g.b, g.c);
    take_column(3, stride + 1, g.b[3] * over[1], g.b, g.d);
    over[2] = 1.0 / g.c[2];
    take_column(3, stride + 2, g.c[3] * over[2], g.c, g.d);
    over[3] = 1.0 / g.d[3];
    return g.a[0] > 0.0 && g.b[1] > 0.0 && g.c[2] > 0.0 && g.d[3] > 0.0;
}

/* Scales the columns of a group to those of L, with 1/D on the diagonal. */
FU_INLINE void scale_group(group g, int stride, const double *over)
{
    for (int k = 1; k < stride; ++k) {
        g.a[k] *= over[0];
        g.b[k + 1] *= over[1];
        g.c[k + 2] *= over[2];
        g.d[k + 3] *= over[3];
    }
    g.a[0] = over[0];
    g.b[1] = over[1];
    g.c[2] = over[2];
    g.d[3] = over[3];
}

/* Subtracts the products of a group's columns from the columns m ... end - 1 after its first one. */
FU_INLINE void take_products(group g, int stride, int end, const double *over)
{
    for (int m = FU_BAND_GROUP; m < end; ++m) {
        double *y = g.a + (long)m * (stride - 1);
        const double f[] = {m < stride ? g.a[m] * over[0] : 0.0, m < stride + 1 ? g.b[m] * over[1] : 0.0,
                            m < stride + 2 ? g.c[m] * over[2] : 0.0, g.d[m] * over[3]};
        take_group(g, m, stride, f, y);
        take_ends(g, stride, m, f, y);
    }
}

/* The same for narrow bands, without loops over single rows: in a copy of the group with zeros where a column has no
 * entries, whose blocks may go on into the next column. */
FU_INLINE void take_padded_products(group g, int stride, int end, const double *over)
{
    double copy[FU_BAND_GROUP][NARROW] = {{0.0}};
    const double *columns[] = {g.a, g.b, g.c, g.d};
    for (int i = 0; i < FU_BAND_GROUP; ++i)
        for (int k = i; k < stride + i; ++k) copy[i][k] = columns[i][k];
    for (int m = FU_BAND_GROUP; m < end; ++m) {
        double *y = g.a + (long)m * (stride - 1);
        const double f[] = {copy[0][m] * over[0], copy[1][m] * over[1], copy[2][m] * over[2], copy[3][m] * over[3]};
        for (int k = m; k < stride + FU_BAND_GROUP - 1; k += FU_SIMD_WIDTH)
            *(fu_simd_block *)(y + k) -=
                *(fu_simd_block *)(copy[0] + k) * f[0] + *(fu_simd_block *)(copy[1] + k) * f[1] +
                *(fu_simd_block *)(copy[2] + k) * f[2] + *(fu_simd_block *)(copy[3] + k) * f[3];
    }
}

FU_INLINE void eliminate(int columns, int n, int width, double *A, int *failed)
{
    const int stride = width + 1;
    *failed = 0;
    for (int j = 0; j < columns; j += FU_BAND_GROUP) {
        const group g = group_at(width, A, j);
        const int end = n - j < stride + 3 ? n - j : stride + 3;
        double over[FU_BAND_GROUP];
        if (!eliminate_in_group(g, stride, over)) {
            *failed = 1;
            return;
        }
        if (stride + 2 * FU_BAND_GROUP <= NARROW) take_padded_products(g, stride, end, over);
        else take_products(g, stride, end, over);
        scale_group(g, stride, over);
    }
}

/* Eliminates the first columns, whole groups, of a matrix of n: they become those of L D L', L below the diagonal, 1/D
 * on it; the others hold the Schur complement. *failed: whether a pivot is not positive. */
FU_SIMD_FUNCTION(fu_band_eliminate, eliminate, (int columns, int n, int width, double *A, int *failed),
                 (columns, n, width, A, failed))

/* Factors A = L D L': L below the diagonal, 1/D on it; returns nonzero if A is not positive definite. */
int fu_band_factor(int n, int width, double *A)
{
    int failed;
    for (int j = n; j % FU_BAND_GROUP; ++j) A[(long)j * (width + 1)] = 1.0;
    fu_band_eliminate(n, n, width, A, &failed);
    return failed;
}

FU_INLINE void forward(int n, int width, const double *A, int first, double *x)
{
    const int stride = width + 1;
    for (int j = first - first % FU_BAND_GROUP; j < n; j += FU_BAND_GROUP) {
        const group g = group_at(width, (double *)A, j);
        double *y = x + j, of[FU_BAND_GROUP];
        of[0] = y[0];
        of[1] = y[1] - g.a[1] * of[0];
        of[2] = y[2] - g.a[2] * of[0] - g.b[2] * of[1];
        of[3] = y[3] - g.a[3] * of[0] - g.b[3] * of[1] - g.c[3] * of[2];
        take_group(g, FU_BAND_GROUP, stride, of, y);
        take_ends(g, stride, FU_BAND_GROUP, of, y);
        for (int i = 1; i < FU_BAND_GROUP; ++i) y[i] = of[i];
    }
}

/* Computes x = L^-1 x, with x zero before `first`, for the groups of columns that begin before n. */
FU_SIMD_FUNCTION(fu_band_forward, forward, (int n, int width, const double *A, int first, double *x),
                 (n, width, A, first, x))

FU_INLINE double sum_of(fu_simd_block x)
{
    return (x[0] + x[1]) + (x[2] + x[3]);
}

/* Computes the products of rows [first, end) of a group's columns and y, which passes through the registers once. */
FU_INLINE void products(group g, int first, int end, const double *y, double of[FU_BAND_GROUP])
{
    fu_simd_block a = {0.0}, b = {0.0}, c = {0.0}, d = {0.0};
    int k = first;
    for (; k + FU_SIMD_WIDTH <= end; k += FU_SIMD_WIDTH) {
        const fu_simd_block rows = *(const fu_simd_block *)(y + k);
        a += *(const fu_simd_block *)(g.a + k) * rows;
        b += *(const fu_simd_block *)(g.b + k) * rows;
        c += *(const fu_simd_block *)(g.c + k) * rows;
        d += *(const fu_simd_block *)(g.d + k) * rows;
    }
    of[0] = sum_of(a), of[1] = sum_of(b), of[2] = sum_of(c), of[3] = sum_of(d);
    for (; k < end; ++k) {
        of[0] += g.a[k] * y[k];
        of[1] += g.b[k] * y[k];
        of[2] += g.c[k] * y[k];
        of[3] += g.d[k] * y[k];
    }
}

FU_INLINE void backward(int n, int width, const double *A, double *x)
{
    const int stride = width + 1;
    for (int j = (n - 1) / FU_BAND_GROUP * FU_BAND_GROUP; n && j >= 0; j -= FU_BAND_GROUP) {
        const group g = group_at(width, (double *)A, j);
        double *y = x + j, x0 = y[0] * g.a[0], x1 = y[1] * g.b[1], x2 = y[2] * g.c[2], x3 = y[3] * g.d[3];
        double of[FU_BAND_GROUP];
        x1 -= g.b[stride] * y[stride];
        x2 -= g.c[stride] * y[stride] + g.c[stride + 1] * y[stride + 1];
        x3 -= g.d[stride] * y[stride] + g.d[stride + 1] * y[stride + 1] + g.d[stride + 2] * y[stride + 2];
        products(g, FU_BAND_GROUP, stride, y, of);
        x0 -= of[0];
        x1 -= of[1];
        x2 -= of[2];
        x3 -= of[3];
        x2 -= g.c[3] * x3;
        x1 -= g.b[2] * x2 + g.b[3] * x3;
        y[0] = x0 - (g.a[1] * x1 + g.a[2] * x2 + g.a[3] * x3);
        y[1] = x1;
        y[2] = x2;
        y[3] = x3;
    }
}

/* Computes x = L'^-1 D^-1 x for the same groups. */
FU_SIMD_FUNCTION(fu_band_backward, backward, (int n, int width, const double *A, double *x), (n, width, A, x))

/* Computes x = A^-1 x, with x zero before `first`. FU_BAND_BEYOND(width) entries of x beyond n are read and kept; they
 * must be finite. */
void fu_band_solve(int n, int width, const double *A, int first, double *x)
{
    fu_band_forward(n, width, A, first, x);
    fu_band_backward(n, width, A, x);
}

/* Adds the products of one group of rows of the matrices. */
FU_INLINE void add_half_group_times(int j, int stride, int count, double *const *A, const double *const *x, double *y)
{
    fu_simd_block sums[FU_BAND_GROUP] = {{0.0}};
    double diagonal[FU_BAND_GROUP] = {0.0};
    for (int k = 0; k < stride; k += FU_SIMD_WIDTH) {
        fu_simd_block sum = *(fu_simd_block *)(y + j + k);
        for (int m = 0; m < count; ++m) {
            const group g = group_at(stride - 1, A[m], j);
            const double *f = x[m] + j;
            const fu_simd_block of = *(const fu_simd_block *)(f + k), a = *(const fu_simd_block *)(g.a + k),
                                b = *(const fu_simd_block *)(g.b + k), c = *(const fu_simd_block *)(g.c + k),
                                d = *(const fu_simd_block *)(g.d + k);
            sum += a * f[0] + b * f[1] + c * f[2] + d * f[3];
            sums[0] += a * of;
            sums[1] += b * of;
            sums[2] += c * of;
            sums[3] += d * of;
        }
        *(fu_simd_block *)(y + j + k) = sum;
    }
    for (int m = 0; m < count; ++m) {
        const group g = group_at(stride - 1, A[m], j);
        const double *f = x[m] + j, of[] = {g.a[0], g.b[1], g.c[2], g.d[3]};
        for (int i = 0; i < FU_BAND_GROUP; ++i) diagonal[i] += of[i] * f[i];
    }
    for (int i = 0; i < FU_BAND_GROUP; ++i)
        y[j + i] += (sums[i][0] + sums[i][1]) + (sums[i][2] + sums[i][3]) - diagonal[i];
}

FU_INLINE void add_half_bands_times(int n, int stride, int count, double *const *A, const double *const *x, double *y)
{
    for (int j = 0; j < n; j += FU_BAND_GROUP)
        if (count == 1) add_half_group_times(j, stride, 1, A, x, y);
        else add_half_group_times(j, stride, 3, A, x, y);
}

/* Adds the sum of the products A x of 1 or 3 matrices to y. They are symmetric, of n rows, their upper halves in rows
 * of `stride` numbers, a multiple of FU_SIMD_WIDTH, from the diagonal on, of which the last FU_BAND_GROUP - 1 are zero.
 * There are FU_HALF_BAND_ROWS(n) rows and entries of x and y with `stride` more; rows beyond n are zero, entries of x
 * there finite. */
FU_SIMD_FUNCTION(fu_add_half_bands_times, add_half_bands_times,
                 (int n, int stride, int count, double *const *A, const double *const *x, double *y),
                 (n, stride, count, A, x, y))

/* Computes value = x' A x of such a matrix: twice the product of the upper half, less the diagonal's part. */
FU_INLINE void half_band_form(int n, int stride, const double *A, const double *x, double *value)
{
    fu_simd_block sums = {0.0};
    double diagonal = 0.0;
    for (int i = 0; i < n; ++i, A += stride, ++x) {
        fu_simd_block row = {0.0};
        for (int j = 0; j < stride; j += FU_SIMD_WIDTH)
            row += *(const fu_simd_block *)(A + j) * *(const fu_simd_block *)(x + j);
        sums += row * *x;
        diagonal += *A * *x * *x;
    }
    *value = 2.0 * ((sums[0] + sums[1]) + (sums[2] + sums[3])) - diagonal;
}

FU_SIMD_FUNCTION(fu_half_band_form, half_band_form,
                 (int n, int stride, const double *A, const double *x, double *value), (n, stride, A, x, value))
