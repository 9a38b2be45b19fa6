/* Systems of few unknowns as one full matrix: chains, strips and border take more instructions there than their
 * arithmetic. */
#include "linear/linear.h"

#include <string.h>

/* Copies the matrix to the columns of a full one. */
static void copy(const fu_system *s, double *A)
{
    const int n = s->n, m = s->m, width = s->width, size = n + m;
    memset(A, 0, sizeof(double) * (size_t)(size * size));
    for (int j = 0; j < n; ++j) {
        const double *diagonal = s->K + (long)j * FU_BAND_ROWS(width) + FU_BAND_DIAGONAL(width);
        const int first = j > width ? j - width : 0, end = j + width < n ? j + width + 1 : n;
        for (int i = first; i < end; ++i) A[j * size + i] = diagonal[i - j];
    }
    for (int i = 0; i < s->n_strips; ++i) {
        const int k = n + s->strips[i].k;
        const double *B = s->B + s->strips[i].at, *C = s->C + s->strips[i].at;
        for (int half = FU_HALVES * i; half < FU_HALVES * (i + 1); ++half) {
            const fu_span in_B = s->span_B[half], in_C = s->span_C[half];
            for (int j = in_B.first; j < in_B.end; ++j) A[k * size + j] = B[j];
            for (int j = in_C.first; j < in_C.end; ++j) A[j * size + k] = C[j];
        }
    }
    for (int j = 0; j < m; ++j)
        for (int i = 0; i < m; ++i) A[(n + j) * size + n + i] = s->D[j * m + i];
}

/* Factors the matrix, in `full` if there is one; returns 0, or 1 + the unknown at which it is singular. */
int fu_system_factor(fu_system *s, const fu_lapack *lapack)
{
    int info;
    s->is_full = s->full != 0;
    if (s->is_full) {
        copy(s, s->full);
        return s->D[s->fronts->size] != 0.0 ? s->n + 1 : fu_small_factor(s->n + s->m, s->full, s->pivot_full);
    }
    info = fu_system_factor_band(s);
    if (info) return info;
    info = fu_system_factor_border(s, lapack);
    return info ? s->n + info : 0;
}
