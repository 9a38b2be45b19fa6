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
    const long n = s->n, m = s->m, pieces = FU_HALVES * m * s->n_chains;
    c->K = take(scratch, taken, storage_rows(s) * n);
    c->B = take(scratch, taken, n * m);
    c->C = take(scratch, taken, n * m);
    c->D = take(scratch, taken, m * m);
    c->X = take(scratch, taken, n * m);
    c->x = take(scratch, taken, n + m);
    c->columns = (fu_piece *)fu_take(scratch, taken, FU_DOUBLES(pieces, fu_piece));
    c->pivot_band = (int *)fu_take(scratch, taken, FU_DOUBLES(n, int));
    c->pivot_border = (int *)fu_take(scratch, taken, FU_DOUBLES(m, int));
    c->is_lower = 1;
    for (int part = 0; part < 2; ++part) {
        c->L[part] = fu_take(scratch, taken, FU_COMPLEX_STRIDE((long)s->width) * n);
        c->right[part] = fu_take(scratch, taken, n + FU_COMPLEX_BEYOND(s->width));
    }
}

/* Makes the matrix zero. */
void fu_complex_system_clear(fu_complex_system *c, const fu_system *s)
{
    const size_t n = (size_t)s->n, m = (size_t)s->m;
    if (c->is_lower)
        for (int part = 0; part < 2; ++part) memset(c->L[part], 0, sizeof(double) * FU_COMPLEX_STRIDE((size_t)s->width) * n);
    else memset(c->K, 0, sizeof(fu_complex) * (size_t)storage_rows(s) * n);
    memset(c->B, 0, sizeof(fu_complex) * n * m);
    memset(c->C, 0, sizeof(fu_complex) * n * m);
    memset(c->D, 0, sizeof(fu_complex) * m * m);
}

/* Adds the real matrix times a factor. */
void fu_complex_system_accumulate(fu_complex_system *c, const fu_system *s, fu_complex factor)
{
    const long band = (long)FU_BAND_ROWS(s->width) * s->n, corner = (long)s->m * s->m;
    if (c->is_lower) fu_complex_band_add(s->n, s->width, s->K, factor, c->L[0], c->L[1]);
    else
        for (long i = 0; i < band; ++i) fu_complex_add(&c->K[i], factor, s->K[i]);
    for (int k = 0; k < s->m; ++k)
        for (int half = 0; half < FU_HALVES * s->n_chains; ++half) {
            const fu_span right = s->span_B[k * FU_HALVES * s->n_chains + half], below = s->span_C[k * FU_HALVES * s->n_chains + half];
            fu_complex *B = c->B + (long)k * s->n, *C = c->C + (long)k * s->n;
            for (int i = right.first; i < right.end; ++i) fu_complex_add(&B[i], factor, s->B[(long)k * s->n + i]);
            for (int i = below.first; i < below.end; ++i) fu_complex_add(&C[i], factor, s->C[(long)k * s->n + i]);
        }
    for (long i = 0; i < corner; ++i) fu_complex_add(&c->D[i], factor, s->D[i]);
}

/* Makes the lower half of the band as complex_band.c wants it. */
static void pack(fu_complex_system *c, const fu_system *s)
{
    const int n = s->n, width = s->width, stride = FU_COMPLEX_STRIDE(width);
    for (int j = 0; j < n; ++j) {
        const fu_complex *below = c->K + storage_rows(s) * j + FU_BAND_DIAGONAL(width);
        double *re = c->L[0] + (long)j * stride, *im = c->L[1] + (long)j * stride;
        const int most = n - 1 - j < width ? n - 1 - j : width;
        for (int i = 0; i <= most; ++i) {
            re[i] = below[i].re;
            im[i] = below[i].im;
        }
        for (int i = most + 1; i < stride; ++i) re[i] = im[i] = 0.0;
    }
}

/* Factors the band: without pivots where the real one was definite, as the complex one is then; else all of it must be there.
 * Returns 0, or not 0 where it is singular. */
static int factor_band(fu_complex_system *c, const fu_system *s, const fu_lapack *lapack)
{
    int n = s->n, width = s->width, rows = FU_BAND_ROWS(width), info = 0;
    c->definite = s->definite;
    if (c->definite) {
        if (!c->is_lower) pack(c, s);
        fu_complex_band_factor(n, width, c->L[0], c->L[1]);
    } else if (n)
        lapack->zgbtrf(&n, &n, &width, &width, c->K, &rows, c->pivot_band, &info);
    return info;
}

/* Makes x = K^-1 x. */
static void solve_band(const fu_complex_system *c, const fu_system *s, const fu_lapack *lapack, fu_complex *x)
{
    int n = s->n, width = s->width, rows = FU_BAND_ROWS(width), one = 1, info;
    if (!n) return;
    if (!c->definite) {
        lapack->zgbtrs("N", &n, &width, &width, &one, c->K, &rows, c->pivot_band, x, &n, &info);
        return;
    }
    double *re = c->right[0], *im = c->right[1];
    for (int i = 0; i < n + FU_COMPLEX_BEYOND(width); ++i) {
        re[i] = i < n ? x[i].re : 0.0;
        im[i] = i < n ? x[i].im : 0.0;
    }
    fu_complex_band_solve(n, width, c->L[0], c->L[1], re, im);
    for (int i = 0; i < n; ++i) x[i] = (fu_complex){re[i], im[i]};
}

/* Solves for column k of X and finds the rows of it that count, unless B has none; size: work space of the band's size. */
static void solve_column(fu_complex_system *c, const fu_system *s, const fu_lapack *lapack, int k, double *size)
{
    int n = s->n, touched = 0;
    fu_complex *x = c->X + (long)k * n;
    for (int half = 0; half < FU_HALVES * s->n_chains; ++half) touched |= s->span_B[k * FU_HALVES * s->n_chains + half].end;
    if (!touched) return;
    memcpy(x, c->B + (long)k * n, sizeof(fu_complex) * (size_t)n);
    solve_band(c, s, lapack, x);
    for (int i = 0; i < n; ++i) size[i] = hypot(x[i].re, x[i].im);
    for (int chain = 0; chain < s->n_chains; ++chain)
        c->n_columns += fu_pieces(s, k, chain, size, c->columns + c->n_columns);
}

/* Factors the matrix, whose rows in the border have the pieces of the factored real one; size: work space of as many
 * doubles as the band has columns. Returns 0, or not 0 where it is singular. */
int fu_complex_system_factor(fu_complex_system *c, const fu_system *s, const fu_lapack *lapack, double *size)
{
    int n = s->n, m = s->m, info = factor_band(c, s, lapack);
    fu_complex *C = c->C, *D = c->D, *X = c->X;
    if (info || !m) return info;
    c->n_columns = 0;
    for (int k = 0; k < m; ++k) solve_column(c, s, lapack, k, size);
    for (const fu_piece *p = c->columns; p < c->columns + c->n_columns; ++p)
        for (const fu_piece *r = s->rows; r < s->rows + s->n_rows; ++r) {
            const fu_span of = fu_common(p->rows, r->rows);
            for (int i = of.first; i < of.end; ++i)
                fu_complex_subtract_product(&D[(long)p->k * m + r->k], C[(long)r->k * n + i], X[(long)p->k * n + i]);
        }
    lapack->zgetrf(&m, &m, D, &m, c->pivot_border, &info);
    return info;
}

/* Solves for the right side in x, in place. */
void fu_complex_system_solve(const fu_complex_system *c, const fu_system *s, const fu_lapack *lapack)
{
    int n = s->n, m = s->m, one = 1, info;
    fu_complex *x = c->x, *y = x + n, *C = c->C, *X = c->X;
    solve_band(c, s, lapack, x);
    if (!m) return;
    for (const fu_piece *r = s->rows; r < s->rows + s->n_rows; ++r)
        for (int i = r->rows.first; i < r->rows.end; ++i)
            fu_complex_subtract_product(&y[r->k], C[(long)r->k * n + i], x[i]);
    lapack->zgetrs("N", &m, &one, c->D, &m, c->pivot_border, y, &m, &info);
    for (const fu_piece *p = c->columns; p < c->columns + c->n_columns; ++p)
        for (int i = p->rows.first; i < p->rows.end; ++i)
            fu_complex_subtract_product(&x[i], y[p->k], X[(long)p->k * n + i]);
}
