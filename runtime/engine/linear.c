/* Bordered band systems: the chain of a cable's nodes is banded, riders and joints are the border. */
#include "engine.h"

#define SYMMETRIC 1e-10 /* of the diagonals: what rounding leaves between two halves */

void fu_system_clear(fu_system *s)
{
    const int rows = 3 * s->width + 1;
    for (long i = 0; i < (long)rows * s->n; ++i) s->K[i] = 0.0;
    fu_system_clear_border(s);
}

void fu_system_clear_border(fu_system *s)
{
    for (int k = 0; k < s->m; ++k) {
        fu_span *of[2] = {&s->span_B[k], &s->span_C[k]};
        double *column[2] = {s->B + (long)k * s->n, s->C + (long)k * s->n};
        for (int side = 0; side < 2; ++side) {
            for (int i = of[side]->first; i < of[side]->end; ++i) column[side][i] = 0.0;
            *of[side] = (fu_span){s->n, 0};
        }
    }
    for (int i = 0; i < s->m * s->m; ++i) s->D[i] = 0.0;
}

/* The lower half of K as band.c wants it; zero where K is not symmetric or its diagonal not positive. */
static int pack(fu_system *s)
{
    const int width = s->width, rows = 3 * width + 1, stride = width + 1;
    for (int j = 0; j < s->n; ++j) {
        const double *below = s->K + (long)j * rows + 2 * width, diagonal = below[0];
        const int most = s->n - 1 - j < width ? s->n - 1 - j : width;
        double *column = s->L + (long)j * stride;
        column[0] = diagonal;
        for (int i = 1; i <= most; ++i) {
            const double *beside = below + (long)i * (rows - 1); /* row j of column j + i */
            const double gap = below[i] - *beside;
            if (!(gap * gap <= SYMMETRIC * SYMMETRIC * diagonal * beside[i])) return 0;
            column[i] = below[i];
        }
        for (int i = most + 1; i < stride; ++i) column[i] = 0.0;
    }
    return 1;
}

int fu_system_factor_band(fu_system *s, const fu_lapack *lapack)
{
    int n = s->n, width = s->width, rows = 3 * width + 1, info = 0;
    s->definite = pack(s) && !fu_band_factor(lapack, n, width, s->L);
    if (n && !s->definite) lapack->dgbtrf(&n, &n, &width, &width, s->K, &rows, s->pivot_band, &info);
    return info;
}

/* x <- K^-1 x, zero before `first` */
static void solve_band(const fu_system *s, const fu_lapack *lapack, int first, double *x)
{
    int n = s->n, width = s->width, rows = 3 * width + 1, one = 1, info;
    if (s->definite) fu_band_solve(n, width, s->L, first, x);
    else if (n) lapack->dgbtrs("N", &n, &width, &width, &one, s->K, &rows, s->pivot_band, x, &n, &info);
}

/* row k of C, times a column of the band */
static double times_row(const fu_system *s, int k, const double *x)
{
    const double *row = s->C + (long)k * s->n;
    double sum = 0.0;
    for (int i = s->span_C[k].first; i < s->span_C[k].end; ++i) sum += row[i] * x[i];
    return sum;
}

/* Schur complement of the factored band: D <- D - C K^-1 B, factored. Most columns of B are zero: a body touches a
 * cable through its joint only. */
int fu_system_factor_border(fu_system *s, const fu_lapack *lapack)
{
    int n = s->n, m = s->m, info = 0;
    const long stride = FU_BAND_LENGTH(n, s->width);
    if (!m) return 0;
    s->n_coupled = 0;
    for (int k = 0; k < m; ++k) {
        const fu_span span = s->span_B[k];
        if (span.first >= span.end) continue;
        double *x = s->X + stride * s->n_coupled;
        for (int i = 0; i < span.first; ++i) x[i] = 0.0;
        for (int i = span.first; i < span.end; ++i) x[i] = s->B[(long)k * n + i];
        for (int i = span.end; i < stride; ++i) x[i] = 0.0;
        solve_band(s, lapack, span.first, x);
        for (int i = 0; i < m; ++i) s->D[(long)k * m + i] -= times_row(s, i, x);
        s->coupled[s->n_coupled++] = k;
    }
    lapack->dgetrf(&m, &m, s->D, &m, s->pivot_border, &info);
    return info;
}

/* In place: right-hand side to solution; x goes on FU_BAND_BEYOND beyond the unknowns, all zero. */
void fu_system_solve(const fu_system *s, const fu_lapack *lapack, double *x)
{
    int n = s->n, m = s->m, one = 1, info;
    double *y = x + n;
    solve_band(s, lapack, 0, x);
    if (!m) return;
    for (int k = 0; k < m; ++k) y[k] -= times_row(s, k, x);
    lapack->dgetrs("N", &m, &one, s->D, &m, s->pivot_border, y, &m, &info);
    for (int c = 0; c < s->n_coupled; ++c) {
        const double *column = s->X + FU_BAND_LENGTH(n, s->width) * c, scale = y[s->coupled[c]];
        for (int i = 0; i < n; ++i) x[i] -= scale * column[i];
    }
}
