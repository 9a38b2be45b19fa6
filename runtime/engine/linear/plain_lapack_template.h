/* LU factorisations with row pivots, column by column, in LAPACK's storage, of real or complex numbers. A file that
 * includes this has defined NUMBER, PREFIX(name), SIZE(x), QUOTIENT(a, b) and SUBTRACT(to, a, b),
 * to -= a b. */

static void PREFIX(exchange)(NUMBER *a, NUMBER *b)
{
    const NUMBER saved = *a;
    *a = *b;
    *b = saved;
}

/* Returns the row of the largest of n numbers. */
static int PREFIX(largest)(int n, const NUMBER *column)
{
    int found = 0;
    for (int i = 1; i < n; ++i)
        if (SIZE(column[i]) > SIZE(column[found])) found = i;
    return found;
}

/* Eliminates a column of a matrix: its diagonal is at `column`, with `below` numbers, and the row at the distance
 * `stride` has `right` numbers. Sets the pivot, counted from the diagonal; returns nonzero where it is zero. */
static int PREFIX(eliminate)(int below, int right, long stride, NUMBER *column, int *pivot)
{
    const int p = *pivot;
    if (SIZE(column[p]) == 0.0) return 1;
    for (int k = 0; p && k <= right; ++k) PREFIX(exchange)(column + k * stride, column + k * stride + p);
    for (int i = 1; i <= below; ++i) column[i] = QUOTIENT(column[i], column[0]);
    for (int k = 1; k <= right; ++k) {
        NUMBER *other = column + k * stride;
        for (int i = 1; i <= below; ++i) SUBTRACT(other + i, column[i], other[0]);
    }
    return 0;
}

static int PREFIX(least)(int a, int b)
{
    return a < b ? a : b;
}

/* Factors a matrix m x n: xGETRF. */
static void PREFIX(factor)(int *m, int *n, NUMBER *A, int *lda, int *pivots, int *info)
{
    *info = 0;
    for (int j = 0; j < PREFIX(least)(*m, *n); ++j) {
        NUMBER *column = A + j + (long)j * *lda;
        int p = PREFIX(largest)(*m - j, column);
        pivots[j] = j + p + 1;
        for (int k = 0; p && k < j; ++k) /* factors to the left */
            PREFIX(exchange)(A + j + (long)k * *lda, A + j + p + (long)k * *lda);
        if (PREFIX(eliminate)(*m - 1 - j, *n - 1 - j, *lda, column, &p) && !*info) *info = j + 1;
    }
}

/* Factors a band of kl and ku diagonals below and above the main one: xGBTRF. */
static void PREFIX(factor_band)(int *m, int *n, int *kl, int *ku, NUMBER *AB, int *ldab, int *pivots, int *info)
{
    const int diagonal = *kl + *ku;
    int last = 0; /* column that the pivots so far reach */
    *info = 0;
    for (int j = *ku + 1; j < PREFIX(least)(diagonal, *n); ++j) /* room of the fill of pivots */
        for (int i = diagonal - j; i < *kl; ++i) AB[i + (long)j * *ldab] = (NUMBER){0};
    for (int j = 0; j < PREFIX(least)(*m, *n); ++j) {
        NUMBER *column = AB + diagonal + (long)j * *ldab;
        const int below = PREFIX(least)(*kl, *m - 1 - j);
        if (j + diagonal < *n)
            for (int i = 0; i < *kl; ++i) AB[i + (long)(j + diagonal) * *ldab] = (NUMBER){0};
        int p = PREFIX(largest)(below + 1, column);
        pivots[j] = j + p + 1;
        if (j + *ku + p > last) last = j + *ku + p;
        last = PREFIX(least)(last, *n - 1);
        if (PREFIX(eliminate)(below, last - j, *ldab - 1, column, &p) && !*info) *info = j + 1;
    }
}

/* Solves with the factors of a matrix: xGETRS without transposition. */
static void PREFIX(solve)(char *transposed, int *n, int *columns, NUMBER *A, int *lda, int *pivots, NUMBER *B, int *ldb,
                          int *info)
{
    (void)transposed;
    *info = 0;
    for (int c = 0; c < *columns; ++c) {
        NUMBER *x = B + (long)c * *ldb;
        for (int j = 0; j < *n; ++j) PREFIX(exchange)(x + j, x + pivots[j] - 1);
        for (int j = 0; j < *n; ++j)
            for (int i = j + 1; i < *n; ++i) SUBTRACT(x + i, A[i + (long)j * *lda], x[j]);
        for (int j = *n - 1; j >= 0; --j) {
            x[j] = QUOTIENT(x[j], A[j + (long)j * *lda]);
            for (int i = 0; i < j; ++i) SUBTRACT(x + i, A[i + (long)j * *lda], x[j]);
        }
    }
}
