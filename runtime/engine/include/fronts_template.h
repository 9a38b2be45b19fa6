/* Gaussian elimination by fronts (Duff & Reid 1983) with threshold pivoting, for real and for complex numbers:
 * linear/fronts.c, linear/complex_fronts.c. A file that includes this has defined NUMBER, PREFIX(name), SIZE(x),
 * DIVIDE(x, by), TIMES(a, b), ADD(to, x), ZERO, ONE, FACTOR (LAPACK's getrf), APPLY, which makes a column what pivots
 * leave of it, and BACK, which makes the first unknowns of a front from the others.
 *
 * A pivot is taken from the rows and columns that have all their entries, if it is not much smaller than what its column
 * has elsewhere. What finds none is left to the parent front. The last front has no other rows: LAPACK factors it.
 * Pivots are kept as their inverses. */
#define THRESHOLD 1e-5 /* of a column's largest entry: less is no pivot. Rounding grows by no more than its inverse. */

static NUMBER *PREFIX(front)(const fu_factors *f, int k)
{
    return (NUMBER *)f->numbers + f->start[k];
}

/* Makes a front of the matrix and of what its children have left; returns 0, or 1 where there is no memory for it. */
static int PREFIX(assemble)(const fu_fronts *t, const NUMBER *matrix, fu_factors *f, int k)
{
    const int p = t->pivots[k], s = t->neighbours[k];
    int delayed = 0;
    for (int c = t->child[k]; c >= 0; c = t->sibling[c]) delayed += f->pivots[c] - f->done[c];
    const int q = p + delayed, n = q + s;
    f->start[k] = k ? f->start[k - 1] + f->size[k - 1] * f->size[k - 1] : 0;
    f->first[k] = k ? f->first[k - 1] + 2 * f->size[k - 1] : 0;
    f->size[k] = n;
    f->pivots[k] = q;
    if (f->start[k] > f->most_numbers - n * n || f->first[k] > f->most_unknowns - 2 * n) return 1;
    NUMBER *F = PREFIX(front)(f, k);
    const NUMBER *from = matrix + t->start[k];
    int *rows = f->unknowns + f->first[k], *columns = rows + n;
    for (int i = 0; i < p + s; ++i)
        rows[i < p ? i : i + delayed] = columns[i < p ? i : i + delayed] = t->unknown[t->first[k] + i];
    for (int i = 0; i < n * n; ++i) F[i] = ZERO;
    for (int j = 0; j < p; ++j, from += s) {
        for (int i = 0; i < p; ++i) F[j * n + i] = *from++;
        for (int i = 0; i < s; ++i) F[j * n + q + i] = from[i];
    }
    for (int j = q; j < n; ++j)
        for (int i = 0; i < p; ++i) F[j * n + i] = *from++;
    int next = p;
    for (int c = t->child[k]; c >= 0; c = t->sibling[c]) {
        const int size = f->size[c], done = f->done[c], left = f->pivots[c] - done;
        const int *in_parent = t->in_parent + t->first[c] + t->pivots[c], *of_rows = f->unknowns + f->first[c];
        for (int i = 0; i < left; ++i) {
            rows[next] = of_rows[done + i];
            columns[next] = of_rows[size + done + i];
            f->map[i] = next++;
        }
        for (int i = left; i < size - done; ++i) {
            const int at = in_parent[i - left];
            f->map[i] = at < p ? at : at + delayed;
        }
        for (int j = 0; j < size - done; ++j) {
            const NUMBER *column = PREFIX(front)(f, c) + (done + j) * size + done;
            NUMBER *to = F + f->map[j] * n;
            for (int i = 0; i < size - done; ++i) ADD(to[f->map[i]], column[i]);
        }
    }
    return 0;
}

static void PREFIX(swap)(NUMBER *a, NUMBER *b, int n, int stride)
{
    for (int i = 0; i < n * stride; i += stride) {
        const NUMBER kept = a[i];
        a[i] = b[i];
        b[i] = kept;
    }
}

static void PREFIX(swap_unknowns)(int *unknowns, int a, int b)
{
    const int kept = unknowns[a];
    unknowns[a] = unknowns[b];
    unknowns[b] = kept;
}

/* Returns the row of the largest entry of a column among those from k to q, -1 where that is no pivot; n: its length. */
static int PREFIX(pivot)(const NUMBER *column, int k, int q, int n)
{
    double largest = 0.0, elsewhere = 0.0;
    int row = -1;
    for (int i = k; i < q; ++i)
        if (SIZE(column[i]) > largest) {
            largest = SIZE(column[i]);
            row = i;
        }
    for (int i = q; i < n; ++i) elsewhere = SIZE(column[i]) > elsewhere ? SIZE(column[i]) : elsewhere;
    return largest >= THRESHOLD * elsewhere ? row : -1;
}

/* Eliminates as many of the first q unknowns of a front as find a pivot; returns how many. updated: work space of n, how many
 * pivots each column has been changed by. */
static int PREFIX(eliminate)(NUMBER *F, int n, int q, int *rows, int *columns, int *updated)
{
    int k = 0;
    for (int j = 0; j < n; ++j) updated[j] = 0;
    for (int last = q, before = 0; k < last;) {
        NUMBER *column = F + k * n;
        APPLY(F, n, updated[k], k, column);
        updated[k] = k;
        const int row = PREFIX(pivot)(column, k, q, n);
        if (row < 0) { /* later, when there are fewer left, or not here */
            --last;
            PREFIX(swap)(column, F + last * n, n, 1);
            PREFIX(swap_unknowns)(columns, k, last);
            PREFIX(swap_unknowns)(updated, k, last);
        } else {
            if (row != k) {
                PREFIX(swap)(F + k, F + row, n, n);
                PREFIX(swap_unknowns)(rows, k, row);
            }
            column[k] = DIVIDE(ONE, column[k]);
            for (int i = k + 1; i < n; ++i) column[i] = TIMES(column[i], column[k]);
            ++k;
        }
        if (k == last && k > before) { /* those that were put off, as long as that finds any */
            last = q;
            before = k;
        }
    }
    for (int j = k; j < n; ++j) APPLY(F, n, updated[j], k, F + j * n);
    return k;
}

/* Factors the matrix; returns 0, or 1 + the unknown at which it is singular or needs more memory than there is. */
static int PREFIX(factor)(const fu_fronts *t, const NUMBER *matrix, fu_factors *f, const fu_lapack *lapack)
{
    for (int k = 0; k < t->n; ++k) {
        if (PREFIX(assemble)(t, matrix, f, k)) return 1 + t->unknown[t->first[k]];
        int n = f->size[k], q = f->pivots[k], info = 0;
        int *rows = f->unknowns + f->first[k], *columns = rows + n;
        if (t->parent[k] >= 0) f->done[k] = PREFIX(eliminate)(PREFIX(front)(f, k), n, q, rows, columns, f->map);
        else {
            lapack->FACTOR(&n, &n, PREFIX(front)(f, k), &n, f->map, &info);
            for (int i = 0; i < n; ++i)
                if (f->map[i] - 1 != i) PREFIX(swap_unknowns)(rows, i, f->map[i] - 1);
            f->done[k] = n;
            if (info) return 1 + columns[info - 1];
            for (NUMBER *F = PREFIX(front)(f, k), *end = F + n * n; F < end; F += n + 1) *F = DIVIDE(ONE, *F);
        }
    }
    return 0;
}

/* Solves in place: y is the right side, then the solution. */
static void PREFIX(solve)(const fu_fronts *t, const fu_factors *f, NUMBER *y)
{
    NUMBER *x = (NUMBER *)f->x, *local = x + t->m;
    for (int k = 0; k < t->n; ++k) {
        const int n = f->size[k], done = f->done[k], *rows = f->unknowns + f->first[k];
        for (int i = 0; i < n; ++i) local[i] = y[rows[i]];
        APPLY(PREFIX(front)(f, k), n, 0, done, local);
        for (int i = 0; i < n; ++i) y[rows[i]] = local[i];
    }
    for (int k = t->n - 1; k >= 0; --k) {
        const int n = f->size[k], done = f->done[k], *rows = f->unknowns + f->first[k], *columns = rows + n;
        const NUMBER *F = PREFIX(front)(f, k);
        for (int i = 0; i < n; ++i) local[i] = i < done ? y[rows[i]] : x[columns[i]];
        BACK(F, n, done, local);
        for (int i = 0; i < done; ++i) x[columns[i]] = local[i];
    }
    for (int i = 0; i < t->m; ++i) y[i] = x[i];
}
