/* The functions of LAPACK that systems with large borders call, as plain C: results equal those of a library up to
 * rounding. */
#include "linear/plain_lapack.h"
#include "linear/complex_number.h"

#include <math.h>

#define NUMBER double
#define PREFIX(name) real_##name
#define SIZE(x) fabs(x)
#define QUOTIENT(a, b) ((a) / (b))
#define SUBTRACT(to, a, b) (*(to) -= (a) * (b))
#include "linear/plain_lapack_template.h"
#undef NUMBER
#undef PREFIX
#undef SIZE
#undef QUOTIENT
#undef SUBTRACT

#define NUMBER fu_complex
#define PREFIX(name) complex_##name
#define SIZE(x) (fabs((x).re) + fabs((x).im))
#define QUOTIENT(a, b) fu_complex_quotient(a, b)
#define SUBTRACT(to, a, b) fu_complex_subtract_product(to, a, b)
#include "linear/plain_lapack_template.h"

static void zgbtrf(int *m, int *n, int *kl, int *ku, void *AB, int *ldab, int *pivots, int *info)
{
    complex_factor_band(m, n, kl, ku, AB, ldab, pivots, info);
}

static void zgetrf(int *m, int *n, void *A, int *lda, int *pivots, int *info)
{
    complex_factor(m, n, A, lda, pivots, info);
}

static void zgetrs(char *transposed, int *n, int *columns, void *A, int *lda, int *pivots, void *B, int *ldb, int *info)
{
    complex_solve(transposed, n, columns, A, lda, pivots, B, ldb, info);
}

const fu_lapack fu_plain_lapack = {real_factor_band, real_factor, zgbtrf, zgetrf, zgetrs, real_solve};
