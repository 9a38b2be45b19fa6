/* Dofs and unknowns: dofs = T unknowns, where each row of T is empty, a single one, or a combination. */
#include "base/simd.h"
#include "bodies/model.h"
#include "bodies/unknowns.h"

#include <limits.h>
#include <math.h>

/* The bits of a block, and those of magnitudes among them. */
typedef long long bits __attribute__((vector_size(sizeof(fu_simd_block)), aligned(sizeof(double)), may_alias));
static const bits MAGNITUDE = {LLONG_MAX, LLONG_MAX, LLONG_MAX, LLONG_MAX};

/* A row of T: the places of n unknowns, and their values. */
typedef struct {
    int n;
    const int *unknown;
    const double *value;
} row;

/* Returns the row of T of a dof with this entry of model->unknown_of_dof. */
static row row_of(const fu_model *model, const int *unknown)
{
    static const double one = 1.0;
    if (*unknown >= 0) return (row){1, unknown, &one};
    if (*unknown == FU_FIXED) return (row){0, 0, 0};
    const int *start = model->combination_start + FU_COMBINED - *unknown;
    return (row){start[1] - start[0], model->combination_unknown + start[0], model->combination_value + start[0]};
}

/* Numbers of dofs, or of unknowns, converted from the others by threads. */
typedef struct {
    const fu_model *model;
    const double *from;
    double *to;
} transfer;

/* Adds a dof's part of T' from. */
static void gather(const transfer *job, int dof)
{
    const int unknown = job->model->unknown_of_dof[dof];
    if (unknown >= 0) job->to[unknown] += job->from[dof];
    else if (unknown <= FU_COMBINED) {
        const row r = row_of(job->model, &unknown);
        for (int k = 0; k < r.n; ++k) job->to[r.unknown[k]] += r.value[k] * job->from[dof];
    }
}

/* Computes the unknowns of a part of the dofs, except those of several dofs. */
static void gather_part(const void *what, int part, int parts)
{
    const transfer *job = what;
    const int *unknown = job->model->unknown_of_dof, *is_shared = job->model->is_shared;
    const fu_range range = fu_part_of(job->model->n_dof, FU_DOFS_APART, part, parts);
    for (int i = range.first; i < range.end; ++i)
        if (unknown[i] >= 0 && !is_shared[i]) job->to[unknown[i]] = 0.0 + job->from[i];
}

/* Computes x = T' force, over the band and the border's dofs. */
void fu_gather(const fu_model *model, const double *force, double *x)
{
    const transfer job = {model, force, x};
    if (!model->threads) {
        for (int i = 0; i < model->n_band + model->n_border_dof; ++i) x[i] = 0.0;
        for (int i = 0; i < model->n_dof; ++i) gather(&job, i);
        return;
    }
    for (int k = 0; k < model->n_shared_unknowns; ++k) x[model->shared_unknowns[k]] = 0.0;
    fu_share(model->threads, model->n_dof, gather_part, &job);
    for (int k = 0; k < model->n_shared_dofs; ++k) gather(&job, model->shared_dofs[k]);
}

static void spread_part(const void *what, int part, int parts)
{
    const transfer *job = what;
    const fu_model *model = job->model;
    const double *x = job->from;
    double *dofs = job->to;
    const fu_range range = fu_part_of(model->n_dof, FU_DOFS_APART, part, parts);
    for (int i = range.first; i < range.end; ++i) {
        const int unknown = model->unknown_of_dof[i];
        dofs[i] = unknown >= 0 ? x[unknown] : 0.0;
        if (unknown <= FU_COMBINED) {
            const row r = row_of(model, &unknown);
            for (int k = 0; k < r.n; ++k) dofs[i] += r.value[k] * x[r.unknown[k]];
        }
    }
}

/* Computes dofs = T x. */
void fu_spread(const fu_model *model, const double *x, double *dofs)
{
    const transfer job = {model, x, dofs};
    fu_share(model->threads, model->n_dof, spread_part, &job);
}

/* Returns the number of the k-th unknown beyond the dofs for `fu_add`. */
int fu_extra(const fu_model *model, int k)
{
    return model->n_dof + k;
}

/* Extends a span to a row. */
static void extend_span(fu_span *span, int row)
{
    if (row < span->first) span->first = row;
    if (row >= span->end) span->end = row + 1;
}

/* Adds a value to a system at these places of the unknowns. */
static void add(fu_system *s, int row, int column, double value)
{
    const int n = s->n;
    if (row < 0 || column < 0) return; /* a fixed dof */
    if (row < n && column < n)
        s->K[(long)column * FU_BAND_ROWS(s->width) + FU_BAND_DIAGONAL(s->width) + row - column] += value;
    else if (row >= n && column >= n) {
        if (value == 0.0) return; /* most entries of a joint */
        const int at = fu_fronts_at(s->fronts, row - n, column - n);
        /* entries without a place must not cancel: they are refused */
        s->D[at] += at < s->fronts->size ? value : fabs(value);
    } else {
        const int in_band = row < n ? row : column, half = s->half[in_band];
        const int strip = fu_strip_of(s, (row < n ? column : row) - n, half / FU_HALVES);
        if (strip < 0) {
            s->D[s->fronts->size] += fabs(value);
            return;
        }
        (row < n ? s->B : s->C)[s->strips[strip].at + in_band] += value;
        extend_span((row < n ? s->span_B : s->span_C) + FU_HALVES * strip + half % FU_HALVES, in_band);
    }
}

/* Adds T' value T to a system at dofs (or unknowns beyond them, fu_extra) i, j, and extends the row spans of the
 * border; without a system (null) does nothing. */
void fu_add(const fu_model *model, fu_system *system, int i, int j, double value)
{
    if (!system) return;
    const int beyond = model->n_band + model->n_border_dof - model->n_dof;
    const int unknown_i = i < model->n_dof ? model->unknown_of_dof[i] : beyond + i;
    const int unknown_j = j < model->n_dof ? model->unknown_of_dof[j] : beyond + j;
    if (unknown_i >= FU_FIXED && unknown_j >= FU_FIXED) {
        add(system, unknown_i, unknown_j, value);
        return;
    }
    const row a = row_of(model, &unknown_i), b = row_of(model, &unknown_j);
    for (int k = 0; k < a.n; ++k)
        for (int m = 0; m < b.n; ++m) add(system, a.unknown[k], b.unknown[m], value * a.value[k] * b.value[m]);
}

/* Adds T' K T of an n x n matrix, by rows, over the dofs from `first` on to a system, if there is one. */
void fu_add_element_matrix(const fu_model *model, int first, int n, const double *K, fu_system *system)
{
    if (!system) return;
    const int rows = FU_BAND_ROWS(system->width), diagonal = FU_BAND_DIAGONAL(system->width),
              *unknown = model->unknown_of_dof + first;
    int outside_band = 0, is_run = unknown[0] >= 0; /* is_run: unknowns follow each other, none is fixed */
    for (int j = 0; j < n; ++j) {
        outside_band |= unknown[j] <= FU_COMBINED || unknown[j] >= system->n;
        is_run &= unknown[j] == unknown[0] + j;
    }
    if (outside_band) {
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) fu_add(model, system, first + i, first + j, K[i * n + j]);
        return;
    }
    if (is_run) {
        double *column = system->K + (long)unknown[0] * rows + diagonal;
        for (int j = 0; j < n; ++j, column += rows - 1)
            for (int i = 0; i < n; ++i) column[i] += K[i * n + j];
        return;
    }
    int moving[FU_MAX_COORDINATES], n_moving = 0; /* coordinates that are not fixed */
    for (int j = 0; j < n; ++j)
        if (unknown[j] >= 0) moving[n_moving++] = j;
    for (int k = 0; k < n_moving; ++k) {
        const double *of = K + moving[k];
        double *column = system->K + (long)unknown[moving[k]] * rows + diagonal - unknown[moving[k]];
        for (int m = 0; m < n_moving; ++m) column[unknown[moving[m]]] += of[moving[m] * n];
    }
}

/* Returns the number of n consecutive unknowns of the border that are in the front of the first one; those of a body
 * that turns alone are in two. */
static int in_front(const fu_fronts *fronts, int first, int n)
{
    if (fronts->n == 1) return n;
    int same = 1;
    while (same < n && fronts->front[first + same] == fronts->front[first]) ++same;
    return same;
}

/* Adds T' values T of a block over contiguous unknowns of one front and of one front. */
static void add_in_fronts(fu_system *s, int row, int rows, int column, int columns, double factor,
                          const double *restrict values, int by_row, int by_column)
{
    int stride;
    const int at = fu_fronts_block(s->fronts, row, column, &stride), has_place = at < s->fronts->size;
    double *restrict to = s->D + at;
    for (int j = 0; j < columns; ++j, values += by_column) {
        for (int i = 0; has_place && i < rows; ++i) to[i] += factor * values[i * by_row];
        for (int i = 0; !has_place && i < rows; ++i) to[0] += fabs(factor * values[i * by_row]);
        to += has_place ? stride : 0;
    }
}

/* Adds T' values T of a block over contiguous unknowns of the border. */
static void add_together(fu_system *s, int row, int rows, int column, int columns, double factor,
                         const double *restrict values, int by_row, int by_column)
{
    for (int j = 0, n; j < columns; j += n) {
        n = in_front(s->fronts, column + j, columns - j);
        for (int i = 0, m; i < rows; i += m) {
            m = in_front(s->fronts, row + i, rows - i);
            add_in_fronts(s, row + i, m, column + j, n, factor, values + i * by_row + j * by_column, by_row, by_column);
        }
    }
}

/* Adds T' values T to a system: at row i and column j the factor times values[i by_row + j by_column]. */
void fu_add_block(const fu_model *model, fu_system *system, fu_side rows, fu_side columns, double factor,
                  const double *values, int by_row, int by_column)
{
    if (!system || !rows.n || !columns.n) return;
    if (rows.together && columns.together) {
        const int beyond = model->n_band + model->n_border_dof - model->n_dof;
        const int i = rows.at[0], j = columns.at[0];
        const int row = i < model->n_dof ? model->unknown_of_dof[i] : beyond + i;
        const int column = j < model->n_dof ? model->unknown_of_dof[j] : beyond + j;
        add_together(system, row - system->n, rows.n, column - system->n, columns.n, factor, values, by_row, by_column);
        return;
    }
    for (int i = 0; i < rows.n; ++i)
        for (int j = 0; j < columns.n; ++j) {
            const double value = values[i * by_row + j * by_column];
            if (value != 0.0) fu_add(model, system, rows.at[i], columns.at[j], factor * value);
        }
}

/* Adds an n x n matrix, by rows, over the dofs of a body from `dof` on. */
void fu_add_body(const fu_model *model, fu_system *s, int dof, int n, const double *values)
{
    const int first = model->unknown_of_dof[dof] - s->n;
    add_together(s, first, n, first, n, 1.0, values, n, 1);
}

/* Adds to a line of the border, numbered k there, a factor times values over unknowns of the band that follow each
 * other in half a chain, the first of them `unknown`; returns their number, n at most. */
static int add_run(const fu_model *model, fu_system *s, int k, int is_row, int unknown, int n, const int *at,
                   const double *value, double factor)
{
    const int half = s->half[unknown], strip = fu_strip_of(s, k, half / FU_HALVES);
    double *entries = strip < 0 ? 0 : (is_row ? s->C : s->B) + s->strips[strip].at + unknown;
    int i = 0;
    do {
        if (entries) entries[i] += factor * value[i];
        else s->D[s->fronts->size] += fabs(factor * value[i]);
        ++i;
    } while (i < n && at[i] < model->n_dof && model->unknown_of_dof[at[i]] == unknown + i && unknown + i < s->n &&
             s->half[unknown + i] == half);
    fu_span *span = strip < 0 ? 0 : (is_row ? s->span_C : s->span_B) + FU_HALVES * strip + half % FU_HALVES;
    if (span) extend_span(span, unknown);
    if (span) extend_span(span, unknown + i - 1);
    return i;
}

/* Adds to a line of the border, its row or its column, a factor times n values over the dofs `at`. line: numbered by
 * fu_extra. Without a system (null) does nothing. */
void fu_add_line(const fu_model *model, fu_system *system, int line, int is_row, int n, const int *at,
                 const double *value, double factor)
{
    fu_system *s = system;
    if (!s) return;
    const int beyond = model->n_band + model->n_border_dof - model->n_dof, extra = beyond + line;
    /* the line in a dense border, and the distance of its entries */
    const int m = s->m, by = is_row ? m : 1;
    double *border = s->fronts->n == 1 ? s->D + (is_row ? extra - s->n : (extra - s->n) * m) : 0;
    for (int i = 0, done = 1; i < n; i += done, done = 1) {
        const int unknown = at[i] < model->n_dof ? model->unknown_of_dof[at[i]] : beyond + at[i];
        const double added = factor * value[i];
        if (unknown == FU_FIXED) continue;
        if (unknown < 0) fu_add(model, s, is_row ? line : at[i], is_row ? at[i] : line, added);
        else if (unknown < s->n)
            done = add_run(model, s, extra - s->n, is_row, unknown, n - i, at + i, value + i, factor);
        else if (border) border[(unknown - s->n) * by] += added;
        else add(s, is_row ? extra : unknown, is_row ? unknown : extra, added);
    }
}

/* Adds a row of the border and its transpose as a column, likewise. */
void fu_add_row_and_column(const fu_model *model, fu_system *system, int row, int n, const int *at, const double *value,
                           double factor)
{
    fu_add_line(model, system, row, 1, n, at, value, factor);
    fu_add_line(model, system, row, 0, n, at, value, factor);
}

/* The size of dofs: the largest of n weighted dofs, of each part of threads. */
typedef struct {
    int n;
    const double *weight, *dofs;
    double *largest;
} measure;

FU_INLINE void measure_range(const double *weight, const double *dofs, int first, int end, double *size_of)
{
    fu_simd_block largest = {0.0}, checks = {0.0}; /* a maximum does not detect a NaN */
    int i = first;
    for (; i + FU_SIMD_WIDTH <= end; i += FU_SIMD_WIDTH) {
        const fu_simd_block of = *(const fu_simd_block *)(dofs + i);
        const fu_simd_block size = (fu_simd_block)((bits)of & MAGNITUDE) * *(const fu_simd_block *)(weight + i);
        const bits larger = (bits)(size > largest);
        largest = (fu_simd_block)((larger & (bits)size) | (~larger & (bits)largest));
        checks += 0.0 * size;
    }
    double check = (checks[0] + checks[1]) + (checks[2] + checks[3]);
    for (; i < end; ++i) {
        const double size = fabs(dofs[i]) * weight[i];
        largest[0] = size > largest[0] ? size : largest[0];
        check += 0.0 * size;
    }
    *size_of = check + fmax(fmax(largest[0], largest[1]), fmax(largest[2], largest[3]));
}

/* Computes the size of the dofs [first, end). */
static void measure_dofs(const double *weight, const double *dofs, int first, int end, double *size_of);
FU_SIMD_FUNCTION(measure_dofs, measure_range,
                 (const double *weight, const double *dofs, int first, int end, double *size_of),
                 (weight, dofs, first, end, size_of))

/* Computes the size of a part of the dofs. */
static void size_part(const void *what, int part, int parts)
{
    const measure *job = what;
    const fu_range range = fu_part_of(job->n, FU_DOFS_APART, part, parts);
    measure_dofs(job->weight, job->dofs, range.first, range.end, job->largest + part);
}

/* Returns the largest displacement of points by the weighted dofs, as a length, m; NaN if any is. */
double fu_weighted_size(const fu_model *model, const double *weight, const double *dofs)
{
    double alone;
    const measure job = {model->n_dof, weight, dofs, model->threads ? model->thread_work : &alone};
    const int parts = fu_share(model->threads, model->n_dof, size_part, &job);
    double size = job.largest[0];
    for (int part = 1; part < parts; ++part)
        size = job.largest[part] > size || isnan(job.largest[part]) ? job.largest[part] : size;
    return size;
}

/* Returns the largest displacement of points by the dofs, as a length, m; NaN if any is. */
double fu_size(const fu_model *model, const double *dofs)
{
    return fu_weighted_size(model, model->weight, dofs);
}
