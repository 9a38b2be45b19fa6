/* Bordered band systems of complex numbers, solved as linear/bordered.c solves real ones. */
#include "complex_system.h"

#include "workspace.h"

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

/* Takes the arrays of a system as large as the real one from a work space (fu_take). */
void fu_complex_system_take(fu_complex_system *c, const fu_system *s, double *scratch, long *taken)
{
    const long n = s->n, m = s->m, slots = s->n_slots, pieces = FU_HALVES * slots * s->n_chains;
    const fu_factors *real = &s->factors;
    c->K = take(scratch, taken, storage_rows(s) * n);
    c->B = take(scratch, taken, n * slots);
    c->C = take(scratch, taken, n * slots);
    c->D = take(scratch, taken, s->fronts->size);
    c->X = take(scratch, taken, n * slots);
    c->x = take(scratch, taken, n + m);
    c->columns = (fu_piece *)fu_take(scratch, taken, FU_DOUBLES(pieces, fu_piece));
    c->pivot_band = (int *)fu_take(scratch, taken, FU_DOUBLES(n, int));
    c->pivot_border = (int *)fu_take(scratch, taken, FU_DOUBLES(m, int));
    c->factors = *real;
    c->factors.numbers = (double *)take(scratch, taken, real->most_numbers);
    c->factors.x = (double *)take(scratch, taken, 2 * m);
    int **own[] = {&c->factors.unknowns, &c->factors.map, &c->factors.start, &c->factors.first, &c->factors.size,
                   &c->factors.pivots, &c->factors.done};
    const long fronts = s->fronts->n, lengths[] = {real->most_unknowns, m, fronts, fronts, fronts, fronts, fronts};
    for (int k = 0; k < (int)(sizeof own / sizeof *own); ++k)
        *own[k] = (int *)fu_take(scratch, taken, FU_DOUBLES(lengths[k], int));
}

/* Makes the matrix zero. */
void fu_complex_system_clear(fu_complex_system *c, const fu_system *s)
{
    const size_t n = (size_t)s->n, slots = (size_t)s->n_slots;
    memset(c->K, 0, sizeof(fu_complex) * (size_t)storage_rows(s) * n);
    memset(c->B, 0, sizeof(fu_complex) * n * slots);
    memset(c->C, 0, sizeof(fu_complex) * n * slots);
    memset(c->D, 0, sizeof(fu_complex) * (size_t)s->fronts->size);
}

/* Adds the real matrix times a factor. */
void fu_complex_system_accumulate(fu_complex_system *c, const fu_system *s, fu_complex factor)
{
    const long band = (long)FU_BAND_ROWS(s->width) * s->n, corner = s->fronts->size;
    for (long i = 0; i < band; ++i) fu_complex_add(&c->K[i], factor, s->K[i]);
    for (int k = 0; k < s->n_slots; ++k)
        for (int half = 0; half < FU_HALVES * s->n_chains; ++half) {
            const fu_span right = s->span_B[k * FU_HALVES * s->n_chains + half], below = s->span_C[k * FU_HALVES * s->n_chains + half];
            fu_complex *B = c->B + (long)k * s->n, *C = c->C + (long)k * s->n;
            for (int i = right.first; i < right.end; ++i) fu_complex_add(&B[i], factor, s->B[(long)k * s->n + i]);
            for (int i = below.first; i < below.end; ++i) fu_complex_add(&C[i], factor, s->C[(long)k * s->n + i]);
        }
    for (long i = 0; i < corner; ++i) fu_complex_add(&c->D[i], factor, s->D[i]);
}

/* Solves for a column of X and finds the rows of it that count, unless B has none; size: work space of the band's size. */
static void solve_column(fu_complex_system *c, const fu_system *s, const fu_lapack *lapack, int k, double *size)
{
    int n = s->n, width = s->width, rows = FU_BAND_ROWS(width), one = 1, touched = 0, info;
    fu_complex *x = c->X + (long)k * n;
    for (int half = 0; half < FU_HALVES * s->n_chains; ++half) touched |= s->span_B[k * FU_HALVES * s->n_chains + half].end;
    if (!touched) return;
    memcpy(x, c->B + (long)k * n, sizeof(fu_complex) * (size_t)n);
    lapack->zgbtrs("N", &n, &width, &width, &one, c->K, &rows, c->pivot_band, x, &n, &info);
    for (int i = 0; i < n; ++i) size[i] = hypot(x[i].re, x[i].im);
    for (int chain = 0; chain < s->n_chains; ++chain)
        c->n_columns += fu_pieces(s, k, chain, size, c->columns + c->n_columns);
}

/* Factors the matrix, whose rows in the border have the pieces of the factored real one; size: work space of as many
 * doubles as the band has columns. Returns 0, or not 0 where it is singular. */
int fu_complex_system_factor(fu_complex_system *c, const fu_system *s, const fu_lapack *lapack, double *size)
{
    int n = s->n, m = s->m, width = s->width, rows = FU_BAND_ROWS(width), info = 0;
    fu_complex *C = c->C, *D = c->D, *X = c->X;
    if (n) lapack->zgbtrf(&n, &n, &width, &width, c->K, &rows, c->pivot_band, &info);
    if (info || !m) return info;
    c->n_columns = 0;
    for (int k = 0; k < s->n_slots; ++k) solve_column(c, s, lapack, k, size);
    for (const fu_piece *p = c->columns; p < c->columns + c->n_columns; ++p)
        for (const fu_piece *r = s->rows; r < s->rows + s->n_rows; ++r) {
            const fu_span of = fu_common(p->rows, r->rows);
            fu_complex *entry = D + fu_fronts_at(s->fronts, r->k, p->k);
            for (int i = of.first; i < of.end; ++i)
                fu_complex_subtract_product(entry, C[(long)r->slot * n + i], X[(long)p->slot * n + i]);
        }
    if (s->fronts->n > 1) return fu_complex_fronts_factor(s->fronts, D, &c->factors, lapack);
    lapack->zgetrf(&m, &m, D, &m, c->pivot_border, &info);
    return info;
}

/* Solves for the right side in x, in place. */
void fu_complex_system_solve(const fu_complex_system *c, const fu_system *s, const fu_lapack *lapack)
{
    int n = s->n, m = s->m, width = s->width, rows = FU_BAND_ROWS(width), one = 1, info;
    fu_complex *x = c->x, *y = x + n, *C = c->C, *X = c->X;
    if (n) lapack->zgbtrs("N", &n, &width, &width, &one, c->K, &rows, c->pivot_band, x, &n, &info);
    if (!m) return;
    for (const fu_piece *r = s->rows; r < s->rows + s->n_rows; ++r)
        for (int i = r->rows.first; i < r->rows.end; ++i)
            fu_complex_subtract_product(&y[r->k], C[(long)r->slot * n + i], x[i]);
    if (s->fronts->n > 1) fu_complex_fronts_solve(s->fronts, &c->factors, y);
    else lapack->zgetrs("N", &m, &one, c->D, &m, c->pivot_border, y, &m, &info);
    for (const fu_piece *p = c->columns; p < c->columns + c->n_columns; ++p)
        for (int i = p->rows.first; i < p->rows.end; ++i)
            fu_complex_subtract_product(&x[i], y[p->k], X[(long)p->slot * n + i]);
}
