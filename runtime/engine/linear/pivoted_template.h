/* Factorisation with row pivots, by columns, of a band or a full matrix of real or complex numbers: linear/pivoted.c,
 * linear/complex_pivoted.c. A file that includes this has defined NUMBER, PREFIX(name), SIZE(x), TIMES(a, b),
 * INVERSE(x), and SUBTRACT(n, column, factor, to), which subtracts a column times a factor from n numbers.
 *
 * Entry (i, j) is at A + j stride + i: of a band, A is the diagonal of its first column in LAPACK's storage, which has
 * room for the fill of pivots; a full matrix of n is a band of the width n - 1. */

FU_INLINE void PREFIX(exchange)(NUMBER *a, NUMBER *b)
{
    const NUMBER saved = *a;
    *a = *b;
    *b = saved;
}

/* Returns the row of the largest of n numbers. */
FU_INLINE int PREFIX(largest)(int n, const NUMBER *column)
{
    int found = 0;
    for (int i = 1; i < n; ++i)
        if (SIZE(column[i]) > SIZE(column[found])) found = i;
    return found;
}

FU_INLINE void PREFIX(factor)(int n, int width, int stride, NUMBER *A, int *pivot, int *info)
{
    int end = 0; /* of the columns that the row of a pivot touches */
    for (int j = width + 1; j < n; ++j)
        for (int i = j > 2 * width ? j - 2 * width : 0; i < j - width; ++i) A[(long)j * stride + i] = ZERO;
    for (int j = 0; j < n; ++j) {
        NUMBER *column = A + (long)j * stride + j;
        const int below = n - 1 - j < width ? n - 1 - j : width, p = PREFIX(largest)(below + 1, column);
        pivot[j] = j + p;
        if (SIZE(column[p]) == 0.0) {
            *info = j + 1;
            return;
        }
        const int last = j + p + width + 1;
        end = last > end ? last : end;
        if (end > n) end = n;
        for (int k = 0; p && k < end - j; ++k)
            PREFIX(exchange)(column + (long)k * stride, column + (long)k * stride + p);
        column[0] = INVERSE(column[0]);
        for (int i = 1; i <= below; ++i) column[i] = TIMES(column[i], column[0]);
        for (int k = 1; k < end - j; ++k) {
            NUMBER *other = column + (long)k * stride;
            if (SIZE(other[0]) != 0.0) SUBTRACT(below, column + 1, other[0], other + 1);
        }
    }
    *info = 0;
}

FU_INLINE void PREFIX(solve)(int n, int width, int stride, const NUMBER *A, const int *pivot, NUMBER *x)
{
    for (int j = 0; j < n; ++j) {
        if (pivot[j] != j) PREFIX(exchange)(x + j, x + pivot[j]);
        SUBTRACT(n - 1 - j < width ? n - 1 - j : width, A + (long)j * stride + j + 1, x[j], x + j + 1);
    }
    for (int j = n - 1; j >= 0; --j) {
        const NUMBER *column = A + (long)j * stride;
        const int above = j < 2 * width ? j : 2 * width;
        x[j] = TIMES(x[j], column[j]);
        SUBTRACT(above, column + j - above, x[j], x + j - above);
    }
}
