/* Nearly symmetric band matrices, as with damping whose direction rotates with the configuration: A = L D U' without
 * pivots. That is stable if the symmetric part is positive definite and dominates the rest (Golub & Van Loan 1979,
 * "Unsymmetric positive definite linear systems"). LAPACK's factorisation with pivots calls a BLAS kernel for each
 * column, which takes several times as long, in each solution, too.
 *
 * Storage: L and U each in the form of band.c, with 1/D on both diagonals, so that its substitutions apply. */
#include "linear/linear.h"

#define SYMMETRY_TOLERANCE 1e-2 /* of the diagonals: largest difference of both halves */
#define MIN_PIVOT 1e-8          /* of the diagonal: least pivot */

/* Packs the lower half of K in a chain into L, and the upper one, transposed, into U; returns zero if they differ by
 * more than the tolerance, or the diagonal is not positive. */
int fu_unsymmetric_pack(const fu_system *s, int chain, double *L, double *U)
{
    const int first = s->chains[chain], n = s->chains[chain + 1] - first;
    const int width = s->width, rows = FU_BAND_ROWS(width), stride = width + 1;
    for (int j = 0; j < n; ++j) {
        const double *at = s->K + (long)(first + j) * rows + FU_BAND_DIAGONAL(width);
        const int most = n - 1 - j < width ? n - 1 - j : width;
        double *lower = L + (long)j * stride, *upper = U + (long)j * stride;
        if (!(at[0] > 0.0)) return 0;
        lower[0] = upper[0] = at[0];
        for (int i = 1; i <= most; ++i) {
            const double *other = at + (long)i * rows; /* the diagonal of the column i columns further */
            const double gap = at[i] - other[-i];
            if (!(gap * gap <= SYMMETRY_TOLERANCE * SYMMETRY_TOLERANCE * at[0] * other[0])) return 0;
            lower[i] = at[i];
            upper[i] = other[-i];
        }
        for (int i = most + 1; i < stride; ++i) lower[i] = upper[i] = 0.0;
    }
    return 1;
}

/* Factors in place; returns nonzero if a pivot is too small. The diagonal of U keeps that of A until its column is
 * reached. */
int fu_unsymmetric_factor(int n, int width, double *restrict L, double *restrict U)
{
    const int stride = width + 1;
    for (int j = 0; j < n; ++j) {
        double *lower = L + (long)j * stride, *upper = U + (long)j * stride;
        const int most = n - 1 - j < width ? n - 1 - j : width;
        const double pivot = lower[0];
        if (!(pivot > MIN_PIVOT * upper[0])) return 1;
        const double inverse = 1.0 / pivot;
        for (int k = 1; k <= most; ++k) {
            double *L_k = L + (long)(j + k) * stride - k, *U_k = U + (long)(j + k) * stride - k;
            const double by_upper = upper[k] * inverse, by_lower = lower[k] * inverse;
            L_k[k] -= lower[k] * by_upper;
            for (int i = k + 1; i <= most; ++i) {
                L_k[i] -= lower[i] * by_upper;
                U_k[i] -= upper[i] * by_lower;
            }
        }
        for (int i = 1; i <= most; ++i) {
            lower[i] *= inverse;
            upper[i] *= inverse;
        }
        lower[0] = upper[0] = inverse;
    }
    for (int j = n; j % FU_BAND_GROUP; ++j) L[(long)j * stride] = U[(long)j * stride] = 1.0;
    return 0;
}
