/* Bordered band systems: the chain of a cable's nodes is banded; riders, joints, and nodes where more than two cables
 * meet, are the border. The solution for a column of the border is nonzero in the chains that it touches only. */
#include "base/simd.h"
#include "linear/columns.h"
#include "linear/linear.h"

#include <math.h>

#define NEGLIGIBLE_ENTRY 1e-32 /* of a column's largest entry: smaller ones do not change a solution */

void fu_system_clear(fu_system *s)
{
    const int rows = FU_BAND_ROWS(s->width);
    for (long i = 0; i < (long)rows * s->n; ++i) s->K[i] = 0.0;
    fu_system_clear_border(s);
}

void fu_system_clear_border(fu_system *s)
{
    for (int i = s->first_strip[s->constant]; i < s->n_strips; ++i)
        for (int half = FU_HALVES * i; half < FU_HALVES * (i + 1); ++half) {
            fu_span *of[2] = {&s->span_B[half], &s->span_C[half]};
            double *column[2] = {s->B + s->strips[i].at, s->C + s->strips[i].at};
            for (int side = 0; side < 2; ++side) {
                for (int row = of[side]->first; row < of[side]->end; ++row) column[side][row] = 0.0;
                *of[side] = (fu_span){s->n, 0};
            }
        }
    int size = s->fronts->size;
    s->D[size] = 0.0;
    const int last = s->factors.banded.front;
    if (last >= 0 && fu_clear_entries(&s->factors.banded, s->fronts->pivots[last], s->D + s->fronts->start[last])) {
        const int n = s->fronts->pivots[last], end = s->fronts->start[last] + n * n;
        for (int i = end; i < size; ++i) s->D[i] = 0.0;
        size = s->fronts->start[last];
    }
    for (int i = 0; i < size; ++i) s->D[i] = 0.0;
}

fu_span fu_common(fu_span one, fu_span other)
{
    return (fu_span){one.first > other.first ? one.first : other.first, one.end < other.end ? one.end : other.end};
}

static int size_of(const fu_system *s, int chain)
{
    return s->chains[chain + 1] - s->chains[chain];
}

/* Factors a chain in L if it is symmetric and positive definite; returns whether it is. */
static int factor_symmetric(fu_system *s, int chain)
{
    if (fu_is_twisted(s, chain)) return !fu_twisted_factor(s, chain);
    double *L = fu_factor_of(s, chain);
    return fu_pack(s, (fu_span){s->chains[chain], s->chains[chain + 1]}, 0, L) &&
           !fu_band_factor(size_of(s, chain), s->width, L);
}

/* Factors a chain in L and U if it is nearly symmetric and positive definite; returns whether it is. */
static int factor_unpivoted(fu_system *s, int chain)
{
    double *L = s->L + fu_factor_at(s, chain), *U = s->U + fu_factor_at(s, chain);
    return fu_unsymmetric_pack(s, chain, L, U) && !fu_unsymmetric_factor(size_of(s, chain), s->width, L, U);
}

/* Returns the diagonal of the first column of a chain. */
static double *diagonal_of(const fu_system *s, int chain)
{
    return s->K + (long)s->chains[chain] * FU_BAND_ROWS(s->width) + FU_BAND_DIAGONAL(s->width);
}

/* Factors each chain by the fastest applicable method; returns 0, or 1 + the row at which the band is singular. */
int fu_system_factor_band(fu_system *s)
{
    s->definite = 1;
    s->is_full = 0;
    for (int c = 0; c < s->n_chains; ++c) {
        s->factorisations[c] = factor_symmetric(s, c)   ? FU_SYMMETRIC
                               : factor_unpivoted(s, c) ? FU_UNPIVOTED
                                                        : FU_PIVOTED;
        s->definite &= s->factorisations[c] == FU_SYMMETRIC;
        if (s->factorisations[c] != FU_PIVOTED) continue;
        const int first = s->chains[c], stride = FU_BAND_STRIDE(s->width);
        const int info = fu_pivoted_factor(size_of(s, c), s->width, stride, diagonal_of(s, c), s->pivot_band + first);
        if (info) return first + info;
    }
    return 0;
}

/* Inverts a factored, definite and constant band if it is small enough. */
void fu_system_invert_band(fu_system *s)
{
    s->inverted = s->inverse != 0 && s->definite;
    double *inverse = s->inverse;
    for (int c = 0; c < s->n_chains && s->inverted; ++c) {
        const int n = size_of(s, c);
        fu_inverse_make(n, s->width, fu_factor_of(s, c), inverse);
        inverse += (long)n * FU_INVERSE_ROWS(n);
    }
}

/* Computes x = K^-1 x in a chain by the inverse of the band, with x zero outside of these rows. */
static void multiply_chain(const fu_system *s, int chain, fu_span of, double *x)
{
    const int n = size_of(s, chain);
    const double *inverse = s->inverse;
    double solution[FU_INVERSE_ROWS(FU_MAX_INVERTED)];
    for (int c = 0; c < chain; ++c) inverse += (long)size_of(s, c) * FU_INVERSE_ROWS(size_of(s, c));
    while (of.end > of.first && x[of.end - 1] == 0.0) --of.end;
    fu_inverse_times(FU_INVERSE_ROWS(n), inverse, of.first, of.end, x, solution);
    for (int i = 0; i < n; ++i) x[i] = solution[i];
}

/* Computes x = K^-1 x in a chain, with x zero outside of these rows. */
static void solve_chain(const fu_system *s, int chain, fu_span of, double *x)
{
    const int n = size_of(s, chain), start = s->chains[chain], width = s->width;
    if (s->inverted) multiply_chain(s, chain, (fu_span){of.first - start, of.end - start}, x + start);
    else if (s->factorisations[chain] == FU_SYMMETRIC && fu_is_twisted(s, chain)) fu_twisted_solve(s, chain, of, x);
    else if (s->factorisations[chain] == FU_SYMMETRIC)
        fu_band_solve(n, width, fu_factor_of(s, chain), of.first - start, x + start);
    else if (s->factorisations[chain] == FU_UNPIVOTED) {
        fu_band_forward(n, width, s->L + fu_factor_at(s, chain), of.first - start, x + start);
        fu_band_backward(n, width, s->U + fu_factor_at(s, chain), x + start);
    } else fu_pivoted_solve(n, width, FU_BAND_STRIDE(width), diagonal_of(s, chain), s->pivot_band + start, x + start);
}

/* Returns whether a strip has entries of B or C. */
static int has_entries(const fu_system *s, int strip)
{
    const fu_span *B = s->span_B + FU_HALVES * strip, *C = s->span_C + FU_HALVES * strip;
    return B[0].end || B[1].end || C[0].end || C[1].end;
}

/* Moves a strip without entries to another chain; returns whether it may move there. */
static int moves(fu_system *s, int strip, int chain)
{
    fu_strip *of = s->strips + strip;
    if (of->room < size_of(s, chain) || has_entries(s, strip)) return 0;
    const int shift = s->chains[of->chain] - s->chains[chain];
    of->at += shift;
    of->x += shift;
    of->chain = chain;
    s->is_listed = 0;
    return 1;
}

/* Returns the strip for entries of an unknown of the border in a chain, -1 if there is none. */
int fu_strip_of(fu_system *s, int k, int chain)
{
    const int first = s->first_strip[k], end = s->first_strip[k + 1];
    const int likely =
        first + chain - (first < end ? s->strips[first].chain : 0); /* of chains that follow each other */
    if (likely >= first && likely < end && s->strips[likely].chain == chain) return likely;
    for (int i = first; i < end; ++i)
        if (s->strips[i].chain == chain) return i;
    for (int i = first; i < end; ++i)
        if (moves(s, i, chain)) return i;
    return -1;
}

/* Returns the product of a block of a row of C with the rows `of` a column. */
static double times(const fu_system *s, const fu_matrix_block *p, fu_span of, const double *x)
{
    const double *row = s->C + s->strips[p->strip].at;
    const fu_span rows = fu_common(p->rows, of);
    double sum = 0.0;
    for (int i = rows.first; i < rows.end; ++i) sum += row[i] * x[i];
    return sum;
}

/* Finds the significant rows of a column of X in the halves of its chain. The column decays away from the rows that it
 * touches, finally to subnormal numbers, which slow down the processor. */
void fu_find_significant(const fu_system *s, int strip, const double *x, fu_span rows[FU_HALVES])
{
    const int chain = s->strips[strip].chain;
    const int begin = s->chains[chain], end = s->chains[chain + 1], middle = (begin + end) / 2;
    const fu_span halves[FU_HALVES] = {{begin, middle}, {middle, end}};
    double largest = 0.0;
    for (int i = begin; i < end; ++i) largest = fabs(x[i]) > largest ? fabs(x[i]) : largest;
    for (int half = 0; half < FU_HALVES; ++half) {
        fu_span of = halves[half];
        while (of.first < of.end && fabs(x[of.first]) <= NEGLIGIBLE_ENTRY * largest) ++of.first;
        while (of.first < of.end && fabs(x[of.end - 1]) <= NEGLIGIBLE_ENTRY * largest) --of.end;
        rows[half] = of.first < of.end ? of : (fu_span){s->n, 0};
    }
}

/* Lists the blocks of a strip that have rows; returns their number. */
int fu_list_blocks(const fu_system *s, int strip, const fu_span rows[FU_HALVES], fu_matrix_block *blocks)
{
    int n = 0;
    for (int half = 0; half < FU_HALVES; ++half)
        if (rows[half].end) blocks[n++] = (fu_matrix_block){s->strips[strip].k, strip, rows[half]};
    return n;
}

/* Sets a column of X to zero beside its significant rows, which become one block where few are between them. */
static void clear_insignificant(const fu_system *s, int strip, double *x, fu_span rows[FU_HALVES])
{
    const int chain = s->strips[strip].chain, begin = s->chains[chain], end = s->chains[chain + 1];
    fu_span one = rows[0], other = rows[1];
    if (!one.end) one = (fu_span){begin, begin};
    if (!other.end) other = (fu_span){end, end};
    for (int i = begin; i < one.first; ++i) x[i] = 0.0;
    for (int i = one.end; i < other.first; ++i) x[i] = 0.0;
    for (int i = other.end; i < end; ++i) x[i] = 0.0;
    if (!rows[0].end || !rows[1].end || other.first - one.end > s->width) return;
    rows[0].end = other.end;
    rows[1] = (fu_span){s->n, 0};
}

/* Computes a column of X = K^-1 B in a chain. */
static void solve_column(fu_system *s, int strip)
{
    const int chain = s->strips[strip].chain, begin = s->chains[chain], end = s->chains[chain + 1];
    const fu_span *of = s->span_B + FU_HALVES * strip;
    fu_span *rows = s->span_X + FU_HALVES * strip;
    double *x = s->X + s->strips[strip].x, *B = s->B + s->strips[strip].at;
    rows[0] = rows[1] = (fu_span){s->n, 0};
    if (!of[0].end && !of[1].end) return;
    for (int i = begin; i < end + FU_BAND_BEYOND(s->width); ++i) x[i] = 0.0;
    for (int half = 0; half < FU_HALVES; ++half)
        for (int i = of[half].first; i < of[half].end; ++i) x[i] = B[i];
    solve_chain(s, chain, (fu_span){of[of[0].end == 0].first, of[of[1].end != 0].end}, x);
    fu_find_significant(s, strip, x, rows);
    clear_insignificant(s, strip, x, rows);
}

/* Returns whether a strip has entries or may come to have them. */
static int is_used(const fu_system *s, int strip)
{
    return s->strips[strip].k >= s->constant || has_entries(s, strip);
}

/* Lists the strips by chain, in each by unknown, without constant ones that are empty. */
static void list_strips(fu_system *s)
{
    int *start = s->chain_start;
    for (int c = 0; c <= s->n_chains; ++c) start[c] = 0;
    for (int i = 0; i < s->n_strips; ++i) start[s->strips[i].chain] += is_used(s, i);
    for (int c = 1; c <= s->n_chains; ++c) start[c] += start[c - 1];
    for (int i = s->n_strips - 1; i >= 0; --i)
        if (is_used(s, i)) s->on_chain[--start[s->strips[i].chain]] = i;
    s->is_listed = 1;
}

/* Computes the columns of X that are not constant, and lists the blocks of X and C. */
static void couple(fu_system *s)
{
    if (!s->is_listed) list_strips(s);
    for (int c = 0; c < s->n_chains; ++c) {
        const int start = FU_HALVES * s->chain_start[c];
        fu_matrix_block *columns = s->columns + start, *rows = s->rows + start;
        s->n_columns[c] = s->n_rows[c] = 0;
        for (int i = s->chain_start[c]; i < s->chain_start[c + 1]; ++i) {
            const int strip = s->on_chain[i];
            if (s->strips[strip].k >= s->constant) solve_column(s, strip);
            s->n_rows[c] += fu_list_blocks(s, strip, s->span_C + FU_HALVES * strip, rows + s->n_rows[c]);
            s->n_columns[c] += fu_list_blocks(s, strip, s->span_X + FU_HALVES * strip, columns + s->n_columns[c]);
        }
    }
}

/* Keeps the first `columns` columns and rows of the border constant, beside a factored band. */
void fu_system_keep_border(fu_system *s, int columns)
{
    couple(s);
    s->constant = columns;
    s->is_listed = 0;
}

/* Keeps nothing of the border constant. */
void fu_system_release_border(fu_system *s)
{
    s->constant = 0;
    s->is_listed = 0;
}

/* Returns whether a system of this border, real or complex, calls LAPACK. */
int fu_needs_lapack(const fu_system *s)
{
    return s->fronts->n > 1 || s->m > FU_MAX_SMALL;
}

/* Computes and factors the Schur complement of the factored band, D - C K^-1 B, in place of D or beside it; returns 0,
 * or 1 + the unknown of the border at which it is singular. */
int fu_system_factor_border(fu_system *s, const fu_lapack *lapack)
{
    int m = s->m, info = 0;
    if (!m) return 0;
    couple(s);
    for (int c = 0; c < s->n_chains; ++c) {
        const int start = FU_HALVES * s->chain_start[c];
        const fu_matrix_block *columns = s->columns + start, *rows = s->rows + start;
        for (const fu_matrix_block *p = columns; p < columns + s->n_columns[c]; ++p)
            for (const fu_matrix_block *r = rows; r < rows + s->n_rows[c]; ++r)
                if (r->rows.first < p->rows.end &&
                    p->rows.first < r->rows.end) /* otherwise the search for the place takes longer */
                    s->D[fu_fronts_at(s->fronts, r->k, p->k)] -= times(s, r, p->rows, s->X + s->strips[p->strip].x);
    }
    if (s->D[s->fronts->size] != 0.0) return 1; /* the order of elimination has no place for an entry */
    if (s->fronts->n > 1) return fu_fronts_factor(s->fronts, s->D, &s->factors, lapack);
    if (m <= FU_MAX_SMALL) return fu_small_factor(m, s->D, s->pivot_border);
    lapack->dgetrf(&m, &m, s->D, &m, s->pivot_border, &info);
    return info;
}

/* Solves with the Schur complement in place. */
static void solve_border(const fu_system *s, const fu_lapack *lapack, double *y)
{
    int m = s->m, one = 1, info;
    if (s->fronts->n > 1) fu_fronts_solve(s->fronts, &s->factors, y);
    else if (m <= FU_MAX_SMALL) fu_small_solve(m, s->D, s->pivot_border, y);
    else lapack->dgetrs("N", &m, &one, s->D, &m, s->pivot_border, y, &m, &info);
}

FU_INLINE void take_column(const fu_system *s, const fu_matrix_block *p, const double *y, double *x)
{
    const double *column = s->X + s->strips[p->strip].x;
    subtract_one(p->rows.end - p->rows.first, column + p->rows.first, y[p->k], x + p->rows.first);
}

enum { TAKEN = 4 }; /* columns for which x passes through the registers once */

/* Takes TAKEN columns of a chain, one after the other. Most have the same rows, and are zero beyond them: whole blocks
 * of rows from the first of any to the last of any. */
FU_INLINE void take_columns_at_once(const fu_system *s, const fu_matrix_block *p, const double *y, double *x)
{
    const double *column[TAKEN];
    double factor[TAKEN];
    fu_span all = p->rows;
    int sum = 0;
    for (int k = 0; k < TAKEN; ++k) {
        const fu_span rows = p[k].rows;
        column[k] = s->X + s->strips[p[k].strip].x;
        factor[k] = y[p[k].k];
        all = (fu_span){rows.first < all.first ? rows.first : all.first, rows.end > all.end ? rows.end : all.end};
        sum += rows.end - rows.first;
    }
    if (2 * (all.end - all.first) > sum) { /* more than half of the numbers there are zeros beside the rows */
        for (int k = 0; k < TAKEN; ++k) take_column(s, p + k, y, x);
        return;
    }
    subtract_in_turn(all.first, all.end, column, factor, x);
}

FU_INLINE void take(const fu_system *s, const double *y, double *x)
{
    for (int c = 0; c < s->n_chains; ++c) {
        const fu_matrix_block *p = s->columns + FU_HALVES * s->chain_start[c], *end = p + s->n_columns[c];
        for (; p + TAKEN <= end; p += TAKEN) take_columns_at_once(s, p, y, x);
        for (; p < end; ++p) take_column(s, p, y, x);
    }
}

/* Subtracts from x, of the band, the contribution K^-1 B y of the border's solution y. */
static void take_columns(const fu_system *s, const double *y, double *x);
FU_SIMD_FUNCTION(take_columns, take, (const fu_system *s, const double *y, double *x), (s, y, x))

/* Sets the entries beyond the unknowns to zero: a step that overflows leaves NaN there, which later steps would
 * keep. */
static void clear_beyond(const fu_system *s, double *y)
{
    for (int i = s->m; i < s->m + FU_BAND_BEYOND(s->width); ++i) y[i] = 0.0;
}

/* Solves in place: x is the right side, then the solution, with FU_BAND_BEYOND entries beyond the unknowns. */
void fu_system_solve(const fu_system *s, const fu_lapack *lapack, double *x)
{
    double *y = x + s->n;
    if (s->is_full) {
        fu_small_solve(s->n + s->m, s->full, s->pivot_full, x);
        return;
    }
    clear_beyond(s, y);
    for (int c = 0; c < s->n_chains; ++c) solve_chain(s, c, (fu_span){s->chains[c], s->chains[c + 1]}, x);
    if (!s->m) return;
    for (int c = 0; c < s->n_chains; ++c) {
        const fu_matrix_block *rows = s->rows + FU_HALVES * s->chain_start[c];
        for (const fu_matrix_block *r = rows; r < rows + s->n_rows[c]; ++r) y[r->k] -= times(s, r, r->rows, x);
    }
    solve_border(s, lapack, y);
    take_columns(s, y, x);
}

/* Solves for a right side that is zero in the band. */
void fu_system_solve_border(const fu_system *s, const fu_lapack *lapack, double *x)
{
    double *y = x + s->n;
    for (int i = 0; i < s->n; ++i) x[i] = 0.0;
    if (s->is_full) {
        fu_system_solve(s, lapack, x);
        return;
    }
    clear_beyond(s, y);
    solve_border(s, lapack, y);
    take_columns(s, y, x);
}
