/* Linear complementarity problems of contacts: small, with a symmetric matrix that may be singular. */
#include "base/common.h"
#include "linear/complementarity.h"

#include <math.h>

#define DEPENDENCE_TOLERANCE 1e-10 /* of its diagonal: the remainder of a row that depends on the basic ones */
#define MAX_PIVOTS 1000

enum { MAX_UNKNOWNS = FU_MAX_COMPLEMENTARY };

/* Solves the basic part of G y = column i by Cholesky's method; returns the Schur complement of G's diagonal i. */
static double complement_of(int n, const double *G, int n_basic, const int *basic, int i, double *y)
{
    double L[MAX_UNKNOWNS * MAX_UNKNOWNS], left = G[i * n + i];
    for (int r = 0; r < n_basic; ++r) {
        for (int c = 0; c <= r; ++c) {
            double sum = G[basic[r] * n + basic[c]];
            for (int k = 0; k < c; ++k) sum -= L[r * MAX_UNKNOWNS + k] * L[c * MAX_UNKNOWNS + k];
            L[r * MAX_UNKNOWNS + c] = r == c ? sqrt(fmax(sum, 0.0)) : sum / L[c * MAX_UNKNOWNS + c];
        }
        double sum = G[basic[r] * n + i];
        for (int k = 0; k < r; ++k) sum -= L[r * MAX_UNKNOWNS + k] * y[k];
        y[r] = sum / L[r * MAX_UNKNOWNS + r];
        left -= y[r] * y[r];
    }
    for (int r = n_basic - 1; r >= 0; --r) {
        for (int k = r + 1; k < n_basic; ++k) y[r] -= L[k * MAX_UNKNOWNS + r] * y[k];
        y[r] /= L[r * MAX_UNKNOWNS + r];
    }
    return left;
}

/* Classifies the rows outside the basis with w = 0: those that depend on others, and those that join the basis. */
static void sort_the_rest(int n, const double *G, const double *b, double least, const double *x, int *kind,
                          int n_basic, int *basic)
{
    double y[MAX_UNKNOWNS];
    for (int i = 0; i < n; ++i) {
        if (kind[i] || fu_dot(n, G + i * n, x) + b[i] > least) continue;
        kind[i] = FU_IS_DEPENDENT;
        if (!(complement_of(n, G, n_basic, basic, i, y) > DEPENDENCE_TOLERANCE * G[i * n + i])) continue;
        kind[i] = FU_IS_BASIC;
        basic[n_basic++] = i;
    }
}

/* Finds x >= 0 with w = G x + b >= 0 and x w = 0, for a symmetric positive semidefinite G (n x n), by the dual method
 * of Goldfarb and Idnani (1983). Basic rows are independent and have w = 0; dependent rows have w = 0 with them. w
 * within `least` is zero. Returns nonzero without a solution. */
int fu_complement(int n, const double *G, const double *b, double least, double *x, int *kind)
{
    int basic[MAX_UNKNOWNS], n_basic = 0, entering = -1;
    double y[MAX_UNKNOWNS];
    for (int i = 0; i < n; ++i) {
        x[i] = 0.0;
        kind[i] = FU_IS_POSITIVE;
    }
    for (int pivot = 0; pivot < MAX_PIVOTS; ++pivot) {
        double worst = -least;
        for (int i = 0, waits = entering < 0; i < n && waits; ++i) {
            const double w = kind[i] ? 0.0 : fu_dot(n, G + i * n, x) + b[i];
            if (w < worst) worst = w, entering = i;
        }
        if (entering < 0) {
            sort_the_rest(n, G, b, least, x, kind, n_basic, basic);
            return 0;
        }
        const double w = fu_dot(n, G + entering * n, x) + b[entering];
        const double left = complement_of(n, G, n_basic, basic, entering, y);
        const double full = left > DEPENDENCE_TOLERANCE * G[entering * n + entering] ? -w / left : INFINITY;
        double step = full;
        int leaving = -1;
        for (int r = 0; r < n_basic; ++r)
            if (y[r] > 0.0 && x[basic[r]] / y[r] < step) step = x[basic[r]] / y[r], leaving = r;
        if (step == INFINITY) return 1;
        for (int r = 0; r < n_basic; ++r) x[basic[r]] = fmax(x[basic[r]] - step * y[r], 0.0);
        x[entering] += step;
        if (leaving < 0) {
            basic[n_basic++] = entering;
            kind[entering] = FU_IS_BASIC;
            entering = -1;
        } else {
            x[basic[leaving]] = 0.0;
            kind[basic[leaving]] = FU_IS_POSITIVE;
            basic[leaving] = basic[--n_basic];
        }
    }
    return 1;
}
