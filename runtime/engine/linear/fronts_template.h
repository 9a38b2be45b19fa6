/* Gaussian elimination by fronts (Duff & Reid 1983) with threshold pivoting, for real and for complex numbers:
 * linear/fronts.c, linear/complex_fronts.c. A file that includes this has defined NUMBER, PREFIX(name), SIZE(x),
 * DIVIDE(x, by), TIMES(a, b), ADD(to, x), ZERO, ONE, FACTOR (LAPACK's getrf), APPLY, which eliminates pivots from a
 * column, APPLY_TO_TWO, from it and the next one, FORWARD, which does so for a right side with all pivots of a front,
 * and BACK, which computes the first unknowns of a front from the others, given the distance of their columns.
 *
 * A pivot is taken from the fully summed rows and columns, if it is not much smaller than the largest entry of its
 * column. Columns without a pivot are delayed to the parent front. The last front has no other rows: LAPACK factors
 * it. Pivots are stored as their inverses. */
#include <string.h>

/* of a column's largest entry: least pivot. Rounding grows by at most its inverse. */
#define PIVOT_THRESHOLD 1e-5

FU_INLINE NUMBER *PREFIX(front)(const fu_factors *f, int k)
{
    return (NUMBER *)f->numbers + f->start[k];
}

/* Returns the Schur complement of a front, and the distance of its columns. */
FU_INLINE const NUMBER *PREFIX(complement)(const fu_factors *f, int k, int *stride)
{
    const int size = f->size[k], done = f->done[k];
    *stride = f->complement[k] < 0 ? size : size - done;
    return f->complement[k] < 0 ? PREFIX(front)(f, k) + done * size + done : (NUMBER *)f->numbers + f->complement[k];
}

/* Returns whether n numbers fit between the packed factors and the Schur complements of the first k fronts, which it
 * moves together at the end of the memory where they do not. */
FU_INLINE int PREFIX(makes_room)(fu_factors *f, int k, int n)
{
    NUMBER *numbers = (NUMBER *)f->numbers;
    if (n <= f->low - f->end) return 1;
    f->low = f->most_numbers;
    for (int i = 0; i < k; ++i) {
        if (f->complement[i] < 0) continue;
        const int rest = f->size[i] - f->done[i];
        f->low -= rest * rest;
        memmove(numbers + f->low, numbers + f->complement[i], sizeof(NUMBER) * (size_t)(rest * rest));
        f->complement[i] = f->low;
    }
    return n <= f->low - f->end;
}

/* Frees the memory of the Schur complements of the children of front k. */
FU_INLINE void PREFIX(free_children)(const fu_fronts *t, fu_factors *f, int k)
{
    for (int found = 1; found;) {
        found = 0;
        for (int c = t->child[k]; c >= 0; c = t->sibling[c])
            if (f->complement[c] == f->low) {
                const int rest = f->size[c] - f->done[c];
                f->low += rest * rest;
                f->complement[c] = -1;
                found = 1;
            }
    }
    for (int c = t->child[k]; c >= 0; c = t->sibling[c]) f->complement[c] = -1;
}

/* Packs the factors of a front, and moves its Schur complement to those of others; returns 0, or 1 without memory. */
FU_INLINE int PREFIX(pack)(fu_factors *f, int k)
{
    const int n = f->size[k], done = f->done[k], rest = n - done;
    NUMBER *F = PREFIX(front)(f, k), *beside = F + done * n;
    if (n <= FU_UNPACKED_FRONT || !rest) {
        f->end += n * n;
        return 0;
    }
    if (!PREFIX(makes_room)(f, k, n * n + rest * rest)) return 1;
    f->low -= rest * rest;
    f->complement[k] = f->low;
    NUMBER *to = (NUMBER *)f->numbers + f->low;
    for (int j = 0; j < rest; ++j) {
        memcpy(to + j * rest, beside + j * n + done, sizeof(NUMBER) * (size_t)rest);
        memmove(beside + j * done, beside + j * n, sizeof(NUMBER) * (size_t)done);
    }
    f->end += done * (n + rest);
    return 0;
}

/* Copies the entries of the matrix of a front of n unknowns, with `delayed` ones between its own p and their s
 * neighbours. */
FU_INLINE void PREFIX(copy)(const NUMBER *from, int p, int s, int delayed, NUMBER *F)
{
    const int q = p + delayed, n = q + s;
    for (int j = 0; j < p; ++j, F += n, from += p + s) {
        for (int i = 0; i < p; ++i) F[i] = from[i];
        for (int i = p; i < q; ++i) F[i] = ZERO;
        for (int i = 0; i < s; ++i) F[q + i] = from[p + i];
    }
    for (int i = 0; i < delayed * n; ++i) *F++ = ZERO;
    for (int j = 0; j < s; ++j, F += n, from += p) {
        for (int i = 0; i < p; ++i) F[i] = from[i];
        for (int i = p; i < n; ++i) F[i] = ZERO;
    }
}

/* Adds the Schur complement of the child c to front k; next: place of its delayed pivots. p: own pivots of k. */
FU_INLINE void PREFIX(add_child)(const fu_fronts *t, fu_factors *f, int k, int c, int p, int next)
{
    const int n = f->size[k], delayed = f->pivots[k] - p;
    const int size = f->size[c], done = f->done[c], left = f->pivots[c] - done, rest = size - done;
    const int *in_parent = t->in_parent + t->first[c] + t->pivots[c] - left,
              *of_rows = f->unknowns + f->first[c] + done;
    int *rows = f->unknowns + f->first[k], *columns = rows + n;
    for (int i = 0; i < left; ++i) {
        rows[next] = of_rows[i];
        columns[next] = of_rows[size + i];
        f->map[i] = next++;
    }
    for (int i = left; i < rest; ++i) f->map[i] = in_parent[i] < p ? in_parent[i] : in_parent[i] + delayed;
    int stride;
    const NUMBER *column = PREFIX(complement)(f, c, &stride);
    for (int j = 0; j < rest; ++j, column += stride) {
        NUMBER *to = PREFIX(front)(f, k) + f->map[j] * n;
        for (int i = 0; i < rest; ++i) ADD(to[f->map[i]], column[i]);
    }
}

/* Assembles a front from the matrix and the Schur complements of its children; returns 0, or 1 without memory for
 * it. */
FU_INLINE int PREFIX(assemble)(const fu_fronts *t, const NUMBER *matrix, fu_factors *f, int k)
{
    const int p = t->pivots[k], s = t->neighbours[k];
    int delayed = 0;
    for (int c = t->child[k]; c >= 0; c = t->sibling[c]) delayed += f->pivots[c] - f->done[c];
    const int q = p + delayed, n = q + s;
    f->start[k] = f->end;
    f->first[k] = k ? f->first[k - 1] + 2 * f->size[k - 1] : 0;
    f->size[k] = n;
    f->pivots[k] = q;
    if (f->first[k] > f->most_unknowns - 2 * n || !PREFIX(makes_room)(f, k, n * n)) return 1;
    int *rows = f->unknowns + f->first[k], *columns = rows + n;
    const int *unknown = t->unknown + t->first[k];
    for (int i = 0; i < p; ++i) rows[i] = columns[i] = unknown[i];
    for (int i = 0; i < s; ++i) rows[q + i] = columns[q + i] = unknown[p + i];
    PREFIX(copy)(matrix + t->start[k], p, s, delayed, PREFIX(front)(f, k));
    for (int c = t->child[k], next = p; c >= 0; next += f->pivots[c] - f->done[c], c = t->sibling[c])
        PREFIX(add_child)(t, f, k, c, p, next);
    PREFIX(free_children)(t, f, k);
    return 0;
}

FU_INLINE void PREFIX(swap)(NUMBER *a, NUMBER *b, int n, int stride)
{
    for (int i = 0; i < n * stride; i += stride) {
        const NUMBER saved = a[i];
        a[i] = b[i];
        b[i] = saved;
    }
}

FU_INLINE void PREFIX(swap_unknowns)(int *unknowns, int a, int b)
{
    const int saved = unknowns[a];
    unknowns[a] = unknowns[b];
    unknowns[b] = saved;
}

/* Returns the row of the largest entry of a column among those from k to q, -1 if that is no pivot; n: its length. */
FU_INLINE int PREFIX(pivot)(const NUMBER *column, int k, int q, int n)
{
    double largest = 0.0, elsewhere = 0.0;
    int row = -1;
    for (int i = k; i < q; ++i)
        if (SIZE(column[i]) > largest) {
            largest = SIZE(column[i]);
            row = i;
        }
    for (int i = q; i < n; ++i) elsewhere = SIZE(column[i]) > elsewhere ? SIZE(column[i]) : elsewhere;
    return largest >= PIVOT_THRESHOLD * elsewhere ? row : -1;
}

/* Eliminates those of the first q unknowns of a front that have a pivot; returns their number. updated: work space of
 * n, the number of pivots eliminated from each column. */
FU_INLINE int PREFIX(eliminate)(NUMBER *F, int n, int q, int *rows, int *columns, int *updated)
{
    int k = 0;
    for (int j = 0; j < n; ++j) updated[j] = 0;
    for (int last = q, before = 0; k < last;) {
        NUMBER *column = F + k * n;
        APPLY(F, n, updated[k], k, column);
        updated[k] = k;
        const int row = PREFIX(pivot)(column, k, q, n);
        if (row < 0) { /* later, when fewer remain, or in the parent */
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
        if (k == last && k > before) { /* retry postponed columns as long as that finds pivots */
            last = q;
            before = k;
        }
    }
    int j = k;
    for (; j + 1 < n; j += 2) {
        const int both = updated[j] > updated[j + 1] ? updated[j] : updated[j + 1];
        APPLY(F, n, updated[j], both, F + j * n);
        APPLY(F, n, updated[j + 1], both, F + (j + 1) * n);
        APPLY_TO_TWO(F, n, both, k, F + j * n);
    }
    if (j < n) APPLY(F, n, updated[j], k, F + j * n);
    return k;
}

#include "linear/banded_front_template.h"

/* Factors a front of n unknowns without neighbours; returns LAPACK's info. */
FU_INLINE int PREFIX(factor_last)(fu_factors *f, NUMBER *F, int n, int *rows, const fu_lapack *lapack)
{
    int info = 0;
    lapack->FACTOR(&n, &n, F, &n, f->map, &info);
    for (int i = 0; i < n; ++i)
        if (f->map[i] - 1 != i) PREFIX(swap_unknowns)(rows, i, f->map[i] - 1);
    if (info) return info;
    for (NUMBER *at = F, *end = F + n * n; at < end; at += n + 1) *at = DIVIDE(ONE, *at);
    return 0;
}

/* Factors the matrix; returns 0, or 1 + the unknown at which it is singular or exceeds the memory. */
FU_INLINE int PREFIX(factor)(const fu_fronts *t, const NUMBER *matrix, fu_factors *f, const fu_lapack *lapack)
{
    f->end = 0;
    f->low = f->most_numbers;
    for (int k = 0; k < t->n; ++k) {
        int info = 0;
        f->complement[k] = -1;
        if (k == f->banded.front && PREFIX(factor_banded)(t, matrix + t->start[k], f, k, lapack, &info)) {
            if (info) return 1 + t->unknown[t->first[k] + info - 1];
            PREFIX(free_children)(t, f, k);
            f->start[k] = f->end;
            f->first[k] = k ? f->first[k - 1] + 2 * f->size[k - 1] : 0;
            f->size[k] = f->pivots[k] = f->done[k] = 0;
            continue;
        }
        if (PREFIX(assemble)(t, matrix, f, k)) return 1 + t->unknown[t->first[k]];
        const int n = f->size[k], q = f->pivots[k];
        int *rows = f->unknowns + f->first[k], *columns = rows + n;
        if (t->parent[k] >= 0) f->done[k] = PREFIX(eliminate)(PREFIX(front)(f, k), n, q, rows, columns, f->map);
        else {
            info = PREFIX(factor_last)(f, PREFIX(front)(f, k), n, rows, lapack);
            f->done[k] = n;
            if (info) return 1 + columns[info - 1];
        }
        if (PREFIX(pack)(f, k)) return 1 + t->unknown[t->first[k]];
    }
    return 0;
}

/* Solves in place: y is the right side, then the solution. */
FU_INLINE void PREFIX(solve)(const fu_fronts *t, const fu_factors *f, NUMBER *y)
{
    NUMBER *x = (NUMBER *)f->x, *local = x + t->m;
    const int banded = f->banded.n ? f->banded.front : -1;
    for (int k = 0; k < t->n; ++k) {
        if (k == banded) {
            const int *unknown = t->unknown + t->first[k];
            for (int i = 0; i < f->banded.n; ++i) local[i] = y[unknown[i]];
            PREFIX(solve_banded)(&f->banded, local, x);
            for (int i = 0; i < f->banded.n; ++i) y[unknown[i]] = local[i];
            continue;
        }
        const int n = f->size[k], done = f->done[k], *rows = f->unknowns + f->first[k];
        for (int i = 0; i < n; ++i) local[i] = y[rows[i]];
        FORWARD(PREFIX(front)(f, k), n, done, local);
        for (int i = 0; i < n; ++i) y[rows[i]] = local[i];
    }
    for (int k = t->n - 1; k >= 0; --k) {
        if (k == banded) {
            const int *unknown = t->unknown + t->first[k];
            for (int i = 0; i < f->banded.n; ++i) x[unknown[i]] = y[unknown[i]];
            continue;
        }
        const int n = f->size[k], done = f->done[k], *rows = f->unknowns + f->first[k], *columns = rows + n;
        const NUMBER *F = PREFIX(front)(f, k);
        for (int i = 0; i < n; ++i) local[i] = i < done ? y[rows[i]] : x[columns[i]];
        BACK(F, n > FU_UNPACKED_FRONT ? done : n, n, done, local);
        for (int i = 0; i < done; ++i) x[columns[i]] = local[i];
    }
    for (int i = 0; i < t->m; ++i) y[i] = x[i];
}
