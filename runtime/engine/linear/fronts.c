/* Elimination of the border of a real system by fronts. */
#include "linear/banded_columns.h"
#include "linear/linear.h"

#define NUMBER double
#define ZERO 0.0
#define ONE 1.0
#define TIMES(a, b) ((a) * (b))
#define PREFIX(name) real_##name
#define SIZE(x) fabs(x)
#define DIVIDE(x, by) ((x) / (by))
#define ADD(to, x) ((to) += (x))
#define APPLY eliminated
#define APPLY_TO_TWO eliminated_from_two
#define FORWARD forward
#define BACK backward
#define FACTOR dgetrf
#define FACTOR_BAND dgbtrf
#define SUBSTITUTE substitute_banded

/* Subtracts from twice n numbers the sum of four columns, at a distance of `stride`, times factors of each. */
FU_INLINE void subtract_four_from_two(long n, const double *column, int stride, const double f[4], const double g[4],
                                      double *restrict to, double *restrict other)
{
    const double *a = column, *b = a + stride, *c = b + stride, *d = c + stride;
    const double w = f[0], x = f[1], y = f[2], z = f[3];
    const double p = g[0], q = g[1], r = g[2], s = g[3];
    long i = 0;
    for (; i + FU_SIMD_WIDTH <= n; i += FU_SIMD_WIDTH) {
        const fu_simd_block u = *(const fu_simd_block *)(a + i), v = *(const fu_simd_block *)(b + i);
        const fu_simd_block m = *(const fu_simd_block *)(c + i), l = *(const fu_simd_block *)(d + i);
        *(fu_simd_block *)(to + i) -= u * w + v * x + m * y + l * z;
        *(fu_simd_block *)(other + i) -= u * p + v * q + m * r + l * s;
    }
    for (; i < n; ++i) {
        to[i] -= a[i] * w + b[i] * x + c[i] * y + d[i] * z;
        other[i] -= a[i] * p + b[i] * q + c[i] * r + d[i] * s;
    }
}

/* Eliminates the pivots `from` to `to` from two columns of n, as `eliminated` does from each: pivots pass through
 * memory once for both. */
FU_INLINE void eliminated_from_two(const double *F, int n, int from, int to, double *restrict column)
{
    double *restrict other = column + n;
    int k = from;
    for (; k + 4 <= to; k += 4) {
        const double *const first = F + k * n + k + 4;
        double f[4], g[4];
        factors_of_four(F, n, k, column, f);
        factors_of_four(F, n, k, other, g);
        subtract_four_from_two(n - k - 4, first, n, f, g, column + k + 4, other + k + 4);
    }
    for (; k < to; ++k) {
        eliminate_one(F, n, k, column);
        eliminate_one(F, n, k, other);
    }
}

/* Computes the first `done` of n unknowns from their right side and the others, four columns at once; stride: of the
 * columns of the others. */
FU_INLINE void substituted(const double *F, int stride, int n, int done, double *restrict x)
{
    const double *beside = F + done * n;
    int k = n;
    for (; k - 4 >= done; k -= 4) {
        const double *d = beside + (k - 1 - done) * stride, *c = d - stride, *b = c - stride, *a = b - stride;
        subtract_four(done, (const double *const[4]){a, b, c, d},
                      (const double[4]){x[k - 4], x[k - 3], x[k - 2], x[k - 1]}, x);
    }
    for (; k > done; --k) subtract_one(done, beside + (k - 1 - done) * stride, x[k - 1], x);
    for (; k >= 4; k -= 4) substitute_four(F, n, k, x);
    for (; k > 0; --k) substitute_one(F, n, k, x);
}

/* A link of a chain: the unknowns of a body and its spherical joint are eliminated, those of the next joint are not.
 * Sizes known to the compiler take half the instructions. */
enum { LINK_PIVOTS = FU_FRAME_DOFS + 3, LINK = LINK_PIVOTS + 3 };
_Static_assert(LINK_PIVOTS == 4 + 4 + 1, "as forward and backward do them");
_Static_assert((int)LINK <= (int)FU_UNPACKED_FRONT, "backward takes the columns of others where they are");

/* A rider of a slide: its body is eliminated before the slide's coordinate and force. */
enum { RIDER_PIVOTS = FU_FRAME_DOFS, RIDER = RIDER_PIVOTS + 4 };
_Static_assert((int)RIDER <= (int)FU_UNPACKED_FRONT, "its columns stay where they are");

FU_INLINE void forward(const double *F, int n, int done, double *restrict x)
{
    if (n == RIDER && done == RIDER_PIVOTS) {
        eliminated(F, RIDER, 0, RIDER_PIVOTS, x);
        return;
    }
    if (n != LINK || done != LINK_PIVOTS) {
        eliminated(F, n, 0, done, x);
        return;
    }
    eliminate_four(F, LINK, 0, x);
    eliminate_four(F, LINK, 4, x);
    eliminate_one(F, LINK, 8, x);
}

FU_INLINE void backward(const double *F, int stride, int n, int done, double *restrict x)
{
    if (n == RIDER && done == RIDER_PIVOTS) {
        substituted(F, RIDER, RIDER, RIDER_PIVOTS, x);
        return;
    }
    if (n != LINK || done != LINK_PIVOTS) {
        substituted(F, stride, n, done, x);
        return;
    }
    for (int k = LINK; k > LINK_PIVOTS; --k) subtract_one(LINK_PIVOTS, F + (k - 1) * LINK, x[k - 1], x);
    substitute_four(F, LINK, 9, x);
    substitute_four(F, LINK, 5, x);
    substitute_one(F, LINK, 1, x);
}

#include "linear/fronts_template.h"

FU_INLINE void factor(const fu_fronts *t, const double *matrix, fu_factors *factors, const fu_lapack *lapack, int *info)
{
    *info = real_factor(t, matrix, factors, lapack);
}

static void factor_by_blocks(const fu_fronts *t, const double *matrix, fu_factors *factors, const fu_lapack *lapack,
                             int *info);
FU_SIMD_FUNCTION(factor_by_blocks, factor,
                 (const fu_fronts *t, const double *matrix, fu_factors *factors, const fu_lapack *lapack, int *info),
                 (t, matrix, factors, lapack, info))

int fu_fronts_factor(const fu_fronts *t, const double *matrix, fu_factors *factors, const fu_lapack *lapack)
{
    int info;
    factor_by_blocks(t, matrix, factors, lapack, &info);
    return info;
}

FU_SIMD_FUNCTION(fu_fronts_solve, real_solve, (const fu_fronts *t, const fu_factors *factors, double *y),
                 (t, factors, y))

/* Returns the place of an unknown among the neighbours of a front, -1 if it is none of them. */
static int neighbour(const fu_fronts *t, int k, int unknown)
{
    const int *all = t->unknown + t->first[k] + t->pivots[k];
    int low = 0, high = t->neighbours[k] - 1;
    while (low <= high) {
        const int middle = (low + high) / 2;
        if (all[middle] == unknown) return middle;
        if (all[middle] < unknown) low = middle + 1;
        else high = middle - 1;
    }
    return -1;
}

/* Returns the place of an entry of the matrix in the storage; its end, `stray`, for an entry without a place. stride:
 * to the place in the next column, if both are in the same front. */
int fu_fronts_block(const fu_fronts *t, int row, int column, int *stride)
{
    *stride = t->m;
    if (t->n == 1) return column * t->m + row;
    const int of_row = t->front[row], of_column = t->front[column], k = of_row < of_column ? of_row : of_column;
    const int p = t->pivots[k], s = t->neighbours[k];
    if (of_column == k) {
        const int below = of_row == k ? 0 : neighbour(t, k, row);
        *stride = p + s;
        return below < 0 ? t->size
                         : t->start[k] + t->place[column] * (p + s) + (of_row == k ? t->place[row] : p + below);
    }
    const int beside = neighbour(t, k, column);
    *stride = p;
    return beside < 0 ? t->size : t->start[k] + p * (p + s) + beside * p + t->place[row];
}

/* Returns the place of an entry of the matrix in the storage, as above. */
int fu_fronts_at(const fu_fronts *t, int row, int column)
{
    int unused;
    return fu_fronts_block(t, row, column, &unused);
}

/* Adds to y the product of the first `columns` columns of a matrix with x. */
void fu_fronts_add_product(const fu_fronts *t, const double *matrix, int columns, const double *x, double *y)
{
    for (int k = 0; k < t->n; ++k) {
        const int p = t->pivots[k], s = t->neighbours[k], *unknown = t->unknown + t->first[k];
        const double *entry = matrix + t->start[k];
        for (int j = 0; j < p + s; ++j) {
            const int rows = j < p ? p + s : p;
            for (int i = 0; i < rows && unknown[j] < columns; ++i) y[unknown[i]] += entry[i] * x[unknown[j]];
            entry += rows;
        }
    }
}
