/* Chains of a bordered band system: places of their factors, and packing of the matrix into them. */
#include "linear/linear.h"

/* of the diagonals: above the rounding difference between the halves of a symmetric matrix */
#define SYMMETRY_TOLERANCE 1e-10

/* Returns where a chain's columns of L and U begin. */
long fu_factor_at(const fu_system *s, int chain)
{
    return (s->width + 1) * ((long)s->chains[chain] + FU_BAND_MORE(s->width) * (long)chain);
}

/* Returns a chain's columns of L. */
double *fu_factor_of(const fu_system *s, int chain)
{
    return s->L + fu_factor_at(s, chain);
}

/* Packs the lower half of K between these rows into L in the form of band.c, backwards with the last row first; returns
 * zero if K is not symmetric or its diagonal not positive. */
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
            const double *other = at + (long)next * i * rows; /* the diagonal of the column i columns further */
            const double below = backwards ? other[i] : at[i], above = backwards ? at[-i] : other[-i],
                         gap = below - above;
            if (!(gap * gap <= SYMMETRY_TOLERANCE * SYMMETRY_TOLERANCE * diagonal * other[0])) return 0;
            column[i] = below;
        }
        for (int i = most + 1; i < stride; ++i) column[i] = 0.0;
    }
    return 1;
}
