/* Bordered band systems of complex numbers, solved as by linear/bordered.c. */
#include "base/workspace.h"
#include "linear/complex_system.h"

#include <math.h>
#include <string.h>

/* Returns the rows of the band's storage. */
static long storage_rows(const fu_system *s)
{
    return FU_BAND_ROWS((long)s->width);
}

static fu_complex *take(double *scratch, long *taken, long n)
{
    return (fu_complex *)fu_take(scratch, taken, FU_DOUBLES(n, fu_complex));
}

/* Takes the arrays of a system of the size of the real one from a work space (fu_take). */
void fu_complex_system_take(fu_complex_system *c, const fu_system *s, double *scratch, long *taken)
{
    const long n = s->n, m = s->m, beside = s->n_strip_rows, blocks = FU_HALVES * (long)s->n_strips;
    const fu_factors *real = &s->factors;
    c->K = take(scratch, taken, storage_rows(s) * n);
    c->B = take(scratch, taken, beside);
    c->C = take(scratch, taken, beside);
    c->D = take(scratch, taken, s->fronts->size);
    c->X = take(scratch, taken, beside);
    c->x = take(scratch, taken, n + m);
    c->columns = (fu_matrix_block *)fu_take(scratch, taken, FU_DOUBLES(blocks, fu_matrix_block));
    c->n_columns = (int *)fu_take(scratch, taken, FU_DOUBLES((long)s->n_chains, int));
    c->factorisations = (int *)fu_take(scratch, taken, FU_DOUBLES((long)s->n_chains, int));
    c->pivot_band = (int *)fu_take(scratch, taken, FU_DOUBLES(n, int));
    c->pivot_border = (int *)fu_take(scratch, taken, FU_DOUBLES(m, int));
    c->factors = *real;
    c->factors.numbers = (double *)take(scratch, taken, real->most_numbers);
    c->factors.x = (double *)take(scratch, taken, 2 * m);
    int **integers[] = {&c->factors.unknowns, &c->factors.map,    &c->factors.start, &c->factors.first,
                        &c->factors.size,     &c->factors.pivots, &c->factors.done,  &c->factors.complement};
    const long fronts = s->fronts->n;
    const long lengths[] = {real->most_unknowns, m, fronts, fronts, fronts, fronts, fronts, fronts};
    for (int k = 0; k < (int)(sizeof integers / sizeof *integers); ++k)
        *integers[k] = (int *)fu_take(scratch, taken, FU_DOUBLES(lengths[k], int));
    fu_banded_front *banded = &c->factors.banded;
    int **of_band[] = {&banded->first, &banded->rows, &banded->child, &banded->order, &banded->place, &banded->pivot};
    const long most = banded->front < 0 ? 0 : s->fronts->pivots[banded->front];
    const long sizes[] = {most + 1, banded->most_entries, most, most, most, most};
    for (int k = 0; k < (int)(sizeof of_band / sizeof *of_band); ++k)
        *of_band[k] = (int *)fu_take(scratch, taken, FU_DOUBLES(sizes[k], int));
    banded->band = (double *)take(scratch, taken, banded->most_numbers);
    c->is_lower = 1;
    for (int part = 0; part < 2; ++part) {
        c->L[part] = fu_take(scratch, taken, FU_COMPLEX_STRIDE((long)s->width) * n);
        c->U[part] = fu_take(scratch, taken, FU_COMPLEX_STRIDE((long)s->width) * n);
        c->right[part] = fu_take(scratch, taken, n + FU_COMPLEX_BEYOND(s->width));
    }
}

/* Sets the matrix to zero. */
void fu_complex_system_clear(fu_complex_system *c, const fu_system *s)
{
    const size_t n = (size_t)s->n, beside = (size_t)s->n_strip_rows;
    if (c->is_lower)
        for (int part = 0; part < 2; ++part)
            memset(c->L[part], 0, sizeof(double) * FU_COMPLEX_STRIDE((size_t)s->width) * n);
    else memset(c->K, 0, sizeof(fu_complex) * (size_t)storage_rows(s) * n);
    memset(c->B, 0, sizeof(fu_complex) * beside);
    memset(c->C, 0, sizeof(fu_complex) * beside);
    memset(c->D, 0, sizeof(fu_complex) * (size_t)s->fronts->size);
}

/* Adds a factor times the real matrix. */
void fu_complex_system_accumulate(fu_complex_system *c, const fu_system *s, fu_complex factor)
{
    const long rows = storage_rows(s), corner = s->fronts->size;
    if (c->is_lower) fu_complex_band_add(s->n, s->width, s->K, factor, c->L[0], c->L[1]);
    else
        for (long column = 0; column < s->n * rows; column += rows)
            for (long i = column + s->width; i < column + rows; ++i) fu_complex_add(&c->K[i], factor, s->K[i]);
    for (int strip = 0; strip < s->n_strips; ++strip)
        for (int half = FU_HALVES * strip; half < FU_HALVES * (strip + 1); ++half) {
            const fu_span right = s->span_B[half], below = s->span_C[half];
            const int at = s->strips[strip].at;
            for (int i = at + right.first; i < at + right.end; ++i) fu_complex_add(&c->B[i], factor, s->B[i]);
            for (int i = at + below.first; i < at + below.end; ++i) fu_complex_add(&c->C[i], factor, s->C[i]);
        }
    for (long i = 0; i < corner; ++i) fu_complex_add(&c->D[i], factor, s->D[i]);
}

/* Packs the lower half of a chain, or the upper one transposed, in the form of complex_band.c. next: from an entry of a
 * column, or of a row, to the next one. */
static void pack(const fu_complex_system *c, const fu_system *s, int chain, long next, double *const half[2])
{
    const int end = s->chains[chain + 1], width = s->width, stride = FU_COMPLEX_STRIDE(width);
    for (int j = s->chains[chain]; j < end; ++j) {
        const fu_complex *entry = c->K + storage_rows(s) * j + FU_BAND_DIAGONAL(width);
        double *re = half[0] + (long)j * stride, *im = half[1] + (long)j * stride;
        const int most = end - 1 - j < width ? end - 1 - j : width;
        for (int i = 0; i <= most; ++i, entry += next) {
            re[i] = entry->re;
            im[i] = entry->im;
        }
        for (int i = most + 1; i < stride; ++i) re[i] = im[i] = 0.0;
    }
}

/* Factors a chain without pivots in L, or in L and U; returns nonzero if a pivot is too small. */
static int factor_unpivoted(fu_complex_system *c, const fu_system *s, int chain)
{
    const int first = s->chains[chain], n = s->chains[chain + 1] - first;
    const long at = (long)first * FU_COMPLEX_STRIDE(s->width);
    double *const L[2] = {c->L[0] + at, c->L[1] + at}, *const U[2] = {c->U[0] + at, c->U[1] + at};
    if (!c->is_lower) pack(c, s, chain, 1, c->L);
    if (c->factorisations[chain] == FU_SYMMETRIC) {
        fu_complex_band_factor(n, s->width, L[0], L[1]);
        return 0;
    }
    pack(c, s, chain, storage_rows(s) - 1, c->U);
    return fu_complex_unsymmetric_factor(n, s->width, L, U);
}

/* Returns the diagonal of the first column of a chain. */
static fu_complex *diagonal_of(const fu_complex_system *c, const fu_system *s, int chain)
{
    return c->K + s->chains[chain] * storage_rows(s) + FU_BAND_DIAGONAL(s->width);
}

/* Factors the band: a chain without pivots if the real one was factored so, since the complex one then has no small
 * pivots; symmetric ones excepted, all of it must be present. Returns 0, or nonzero if it is singular. */
static int factor_band(fu_complex_system *c, const fu_system *s)
{
    for (int chain = 0; chain < s->n_chains; ++chain) {
        const int first = s->chains[chain], n = s->chains[chain + 1] - first;
        c->factorisations[chain] = s->factorisations[chain];
        if (c->factorisations[chain] != FU_PIVOTED && factor_unpivoted(c, s, chain))
            c->factorisations[chain] = FU_PIVOTED;
        if (c->factorisations[chain] != FU_PIVOTED) continue;
        const int info = fu_complex_pivoted_factor(n, s->width, FU_BAND_STRIDE(s->width), diagonal_of(c, s, chain),
                                                   c->pivot_band + first);
        if (info) return first + info;
    }
    return 0;
}

/* Computes x = K^-1 x in a chain, with x zero before the row `from`. */
static void solve_chain(const fu_complex_system *c, const fu_system *s, int chain, int from, fu_complex *x)
{
    const int first = s->chains[chain], n = s->chains[chain + 1] - first, width = s->width;
    if (!n) return;
    if (c->factorisations[chain] == FU_PIVOTED) {
        fu_complex_pivoted_solve(n, width, FU_BAND_STRIDE(width), diagonal_of(c, s, chain), c->pivot_band + first,
                                 x + first);
        return;
    }
    const long at = (long)first * FU_COMPLEX_STRIDE(width);
    double *re = c->right[0], *im = c->right[1];
    for (int i = 0; i < n + FU_COMPLEX_BEYOND(width); ++i) {
        re[i] = i < n ? x[first + i].re : 0.0;
        im[i] = i < n ? x[first + i].im : 0.0;
    }
    double *const L[2] = {c->L[0] + at, c->L[1] + at}, *const U[2] = {c->U[0] + at, c->U[1] + at};
    fu_complex_band_solve(n, width, L, c->factorisations[chain] == FU_SYMMETRIC ? L : U, from - first, re, im);
    for (int i = 0; i < n; ++i) x[first + i] = (fu_complex){re[i], im[i]};
}

/* Computes a column of X in a chain and lists its significant blocks, unless B is empty there; returns their number.
 * size: work space of the band's size. */
static int solve_column(fu_complex_system *c, const fu_system *s, int strip, double *size, fu_matrix_block *blocks)
{
    const fu_span *of = s->span_B + FU_HALVES * strip;
    const int chain = s->strips[strip].chain, first = s->chains[chain], end = s->chains[chain + 1];
    fu_complex *x = c->X + s->strips[strip].at, *B = c->B + s->strips[strip].at;
    if (!of[0].end && !of[1].end) return 0;
    memcpy(x + first, B + first, sizeof(fu_complex) * (size_t)(end - first));
    solve_chain(c, s, chain, of[of[0].end == 0].first, x);
    for (int i = first; i < end; ++i) size[i] = fabs(x[i].re) + fabs(x[i].im);
    fu_span rows[FU_HALVES];
    fu_find_significant(s, strip, size, rows);
    return fu_list_blocks(s, strip, rows, blocks);
}

/* Subtracts the contribution of a chain from D, to form the Schur complement. */
static void subtract(fu_complex_system *c, const fu_system *s, int chain)
{
    const int start = FU_HALVES * s->chain_start[chain];
    const fu_matrix_block *columns = c->columns + start, *rows = s->rows + start;
    for (const fu_matrix_block *p = columns; p < columns + c->n_columns[chain]; ++p)
        for (const fu_matrix_block *r = rows; r < rows + s->n_rows[chain]; ++r) {
            const fu_span of = fu_common(p->rows, r->rows);
            const fu_complex *C = c->C + s->strips[r->strip].at, *X = c->X + s->strips[p->strip].at;
            fu_complex *entry = c->D + fu_fronts_at(s->fronts, r->k, p->k);
            for (int i = of.first; i < of.end; ++i) fu_complex_subtract_product(entry, C[i], X[i]);
        }
}

/* Factors the matrix, whose rows in the border have the blocks of the factored real one; size: work space of as many
 * doubles as the band has columns. Returns 0, or nonzero if it is singular. */
int fu_complex_system_factor(fu_complex_system *c, const fu_system *s, const fu_lapack *lapack, double *size)
{
    int m = s->m, info = factor_band(c, s);
    if (info || !m) return info;
    for (int chain = 0; chain < s->n_chains; ++chain) {
        fu_matrix_block *columns = c->columns + FU_HALVES * s->chain_start[chain];
        c->n_columns[chain] = 0;
        for (int i = s->chain_start[chain]; i < s->chain_start[chain + 1]; ++i)
            c->n_columns[chain] += solve_column(c, s, s->on_chain[i], size, columns + c->n_columns[chain]);
        subtract(c, s, chain);
    }
    if (s->fronts->n > 1) return fu_complex_fronts_factor(s->fronts, c->D, &c->factors, lapack);
    if (!fu_needs_lapack(s)) return fu_complex_pivoted_factor(m, m - 1, m, c->D, c->pivot_border);
    lapack->zgetrf(&m, &m, c->D, &m, c->pivot_border, &info);
    return info;
}

/* Solves in place for the right side in x. */
void fu_complex_system_solve(const fu_complex_system *c, const fu_system *s, const fu_lapack *lapack)
{
    int m = s->m, one = 1, info;
    fu_complex *x = c->x, *y = x + s->n;
    for (int chain = 0; chain < s->n_chains && s->n; ++chain) solve_chain(c, s, chain, s->chains[chain], x);
    if (!m) return;
    for (int chain = 0; chain < s->n_chains; ++chain) {
        const fu_matrix_block *rows = s->rows + FU_HALVES * s->chain_start[chain];
        for (const fu_matrix_block *r = rows; r < rows + s->n_rows[chain]; ++r)
            for (int i = r->rows.first; i < r->rows.end; ++i)
                fu_complex_subtract_product(&y[r->k], c->C[s->strips[r->strip].at + i], x[i]);
    }
    if (s->fronts->n > 1) fu_complex_fronts_solve(s->fronts, &c->factors, y);
    else if (!fu_needs_lapack(s)) fu_complex_pivoted_solve(m, m - 1, m, c->D, c->pivot_border, y);
    else lapack->zgetrs("N", &m, &one, c->D, &m, c->pivot_border, y, &m, &info);
    for (int chain = 0; chain < s->n_chains; ++chain) {
        const fu_matrix_block *columns = c->columns + FU_HALVES * s->chain_start[chain];
        for (const fu_matrix_block *p = columns; p < columns + c->n_columns[chain]; ++p)
            for (int i = p->rows.first; i < p->rows.end; ++i)
                fu_complex_subtract_product(&x[i], y[p->k], c->X[s->strips[p->strip].at + i]);
    }
}
