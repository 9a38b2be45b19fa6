/* Bordered band systems: the chain of a cable's nodes is banded; riders, joints, and nodes where more than two cables
 * meet, are the border. A column of it has a solution in the chains that it touches and nowhere else. */
#include "engine.h"

#define SYMMETRIC 1e-10 /* of the diagonals: more than rounding leaves between the two halves of a symmetric matrix */
#define FADED 1e-32     /* of a column's largest entry: smaller ones add nothing to a solution */

void fu_system_clear(fu_system *s)
{
    const int rows = FU_BAND_ROWS(s->width);
    for (long i = 0; i < (long)rows * s->n; ++i) s->K[i] = 0.0;
    fu_system_clear_border(s);
}

void fu_system_clear_border(fu_system *s)
{
    for (int k = s->constant; k < s->m; ++k)
        for (int half = 0; half < FU_HALVES * s->n_chains; ++half) {
            fu_span *of[2] = {&s->span_B[k * FU_HALVES * s->n_chains + half], &s->span_C[k * FU_HALVES * s->n_chains + half]};
            double *column[2] = {s->B + (long)k * s->n, s->C + (long)k * s->n};
            for (int side = 0; side < 2; ++side) {
                for (int i = of[side]->first; i < of[side]->end; ++i) column[side][i] = 0.0;
                *of[side] = (fu_span){s->n, 0};
            }
        }
    for (int i = 0; i < s->m * s->m; ++i) s->D[i] = 0.0;
}

fu_span fu_common(fu_span one, fu_span other)
{
    return (fu_span){one.first > other.first ? one.first : other.first, one.end < other.end ? one.end : other.end};
}

static int size_of(const fu_system *s, int chain)
{
    return s->chains[chain + 1] - s->chains[chain];
}

/* Returns a chain's columns of L. */
double *fu_factor_of(const fu_system *s, int chain)
{
    return s->L + (s->width + 1) * ((long)s->chains[chain] + FU_BAND_MORE(s->width) * (long)chain);
}

/* Makes, of K between these rows, the lower half in L as band.c wants it, backwards with the last row first; returns zero where
 * K is not symmetric or its diagonal not positive. */
int fu_pack(const fu_system *s, fu_span of, int backwards, double *L)
{
    const int n = of.end - of.first, width = s->width, rows = FU_BAND_ROWS(width), stride = width + 1;
    for (int j = 0; j < n; ++j) {
        const int row = backwards ? of.end - 1 - j : of.first + j;
        const double *at = s->K + (long)row * rows + FU_BAND_DIAGONAL(width), diagonal = at[0];
        const int most = n - 1 - j < width ? n - 1 - j : width, next = backwards ? -1 : 1;
        double *column = L + (long)j * stride;
        column[0] = diagonal;
        for (int i = 1; i <= most; ++i) {
            const double *other = at + (long)next * i * rows; /* the diagonal of the column i further on */
            const double below = backwards ? other[i] : at[i], above = backwards ? at[-i] : other[-i], gap = below - above;
            if (!(gap * gap <= SYMMETRIC * SYMMETRIC * diagonal * other[0])) return 0;
            column[i] = below;
        }
        for (int i = most + 1; i < stride; ++i) column[i] = 0.0;
    }
    return 1;
}

int fu_system_factor_band(fu_system *s, const fu_lapack *lapack)
{
    int width = s->width, rows = FU_BAND_ROWS(width), info = 0;
    s->definite = 1;
    for (int c = 0; c < s->n_chains && s->definite; ++c)
        s->definite = fu_is_twisted(s, c) ? !fu_twisted_factor(s, lapack, c)
                                          : fu_pack(s, (fu_span){s->chains[c], s->chains[c + 1]}, 0, fu_factor_of(s, c)) &&
                                                !fu_band_factor(lapack, size_of(s, c), width, fu_factor_of(s, c));
    for (int c = 0; c < s->n_chains && !s->definite; ++c) {
        int n = size_of(s, c), first = s->chains[c];
        lapack->dgbtrf(&n, &n, &width, &width, s->K + (long)first * rows, &rows, s->pivot_band + first, &info);
        if (info) return first + info;
    }
    return 0;
}

/* Makes x = K^-1 x in a chain, where x is zero but in these rows. */
static void solve_chain(const fu_system *s, const fu_lapack *lapack, int chain, fu_span of, double *x)
{
    int n = size_of(s, chain), start = s->chains[chain], width = s->width, rows = FU_BAND_ROWS(width), one = 1, info;
    if (s->definite && fu_is_twisted(s, chain)) fu_twisted_solve(s, chain, of, x);
    else if (s->definite) fu_band_solve(n, width, fu_factor_of(s, chain), of.first - start, x + start);
    else
        lapack->dgbtrs("N", &n, &width, &width, &one, s->K + (long)start * rows, &rows, s->pivot_band + start,
                       x + start, &n, &info);
}

/* Returns a piece of a row of C times the rows `of` a column. */
static double times(const fu_system *s, const fu_piece *p, fu_span of, const double *x)
{
    const double *row = s->C + (long)p->k * s->n;
    const fu_span rows = fu_common(p->rows, of);
    double sum = 0.0;
    for (int i = rows.first; i < rows.end; ++i) sum += row[i] * x[i];
    return sum;
}

/* Finds the rows that count of column k of X in a chain, by halves; returns how many pieces they are. The column decays away from
 * what it touches, in the end to numbers so small that the processor is slow with them. */
int fu_pieces(const fu_system *s, int k, int chain, const double *x, fu_piece *pieces)
{
    const int begin = s->chains[chain], end = s->chains[chain + 1], middle = (begin + end) / 2;
    const fu_span halves[FU_HALVES] = {{begin, middle}, {middle, end}};
    double largest = 0.0;
    int n = 0;
    for (int i = begin; i < end; ++i) largest = fabs(x[i]) > largest ? fabs(x[i]) : largest;
    for (int half = 0; half < FU_HALVES; ++half) {
        fu_span rows = halves[half];
        while (rows.first < rows.end && fabs(x[rows.first]) <= FADED * largest) ++rows.first;
        while (rows.first < rows.end && fabs(x[rows.end - 1]) <= FADED * largest) --rows.end;
        if (rows.first < rows.end) pieces[n++] = (fu_piece){k, rows};
    }
    return n;
}

/* Makes column k of X = K^-1 B in a chain. */
static void solve_column(fu_system *s, const fu_lapack *lapack, int k, int chain)
{
    const int begin = s->chains[chain], end = s->chains[chain + 1];
    const fu_span *of = s->span_B + FU_HALVES * (k * s->n_chains + chain);
    double *x = s->X + FU_BAND_LENGTH(s->n, s->width) * k;
    if (!of[0].end && !of[1].end) return;
    for (int i = begin; i < end + FU_BAND_BEYOND(s->width); ++i) x[i] = 0.0;
    for (int half = 0; half < FU_HALVES; ++half)
        for (int i = of[half].first; i < of[half].end; ++i) x[i] = s->B[(long)k * s->n + i];
    solve_chain(s, lapack, chain, (fu_span){of[of[0].end == 0].first, of[of[1].end != 0].end}, x);
    s->n_columns += fu_pieces(s, k, chain, x, s->columns + s->n_columns);
}

/* Makes the columns of X and the pieces of C, but those that stay. */
static void couple(fu_system *s, const fu_lapack *lapack)
{
    s->n_columns = s->constant_columns;
    s->n_rows = s->constant_rows;
    for (int k = s->constant; k < s->m; ++k)
        for (int c = 0; c < s->n_chains; ++c) {
            const fu_span *of = s->span_C + FU_HALVES * (k * s->n_chains + c);
            for (int half = 0; half < FU_HALVES; ++half)
                if (of[half].end) s->rows[s->n_rows++] = (fu_piece){k, of[half]};
            solve_column(s, lapack, k, c);
        }
}

/* Lets the first columns and rows of the border stay as they are, beside the band, which is factored. */
void fu_system_keep_border(fu_system *s, const fu_lapack *lapack, int columns)
{
    couple(s, lapack);
    s->constant = columns;
    s->constant_columns = s->n_columns;
    s->constant_rows = s->n_rows;
}

/* Makes and factors the Schur complement of the factored band, D - C K^-1 B, in place of D; returns LAPACK's info. */
int fu_system_factor_border(fu_system *s, const fu_lapack *lapack)
{
    int m = s->m, info = 0;
    if (!m) return 0;
    couple(s, lapack);
    for (const fu_piece *p = s->columns; p < s->columns + s->n_columns; ++p)
        for (const fu_piece *r = s->rows; r < s->rows + s->n_rows; ++r)
            s->D[(long)p->k * m + r->k] -= times(s, r, p->rows, s->X + FU_BAND_LENGTH(s->n, s->width) * p->k);
    lapack->dgetrf(&m, &m, s->D, &m, s->pivot_border, &info);
    return info;
}

/* Solves in place: x is the right side, then the solution, and goes on FU_BAND_BEYOND beyond the unknowns. These are made zero here: a step
 * that has overflowed leaves no numbers in them, and no later step would have any. */
void fu_system_solve(const fu_system *s, const fu_lapack *lapack, double *x)
{
    int m = s->m, one = 1, info;
    double *y = x + s->n;
    for (int i = m; i < m + FU_BAND_BEYOND(s->width); ++i) y[i] = 0.0;
    for (int c = 0; c < s->n_chains; ++c) solve_chain(s, lapack, c, (fu_span){s->chains[c], s->chains[c + 1]}, x);
    if (!m) return;
    for (const fu_piece *r = s->rows; r < s->rows + s->n_rows; ++r) y[r->k] -= times(s, r, r->rows, x);
    lapack->dgetrs("N", &m, &one, s->D, &m, s->pivot_border, y, &m, &info);
    for (const fu_piece *p = s->columns; p < s->columns + s->n_columns; ++p) {
        const double *column = s->X + FU_BAND_LENGTH(s->n, s->width) * p->k, scale = y[p->k];
        for (int i = p->rows.first; i < p->rows.end; ++i) x[i] -= scale * column[i];
    }
}
