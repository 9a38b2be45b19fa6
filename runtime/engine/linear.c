/* Bordered band systems: the chain of a cable's nodes is banded, riders and joints are the border. */
#include "engine.h"

void fu_system_clear(fu_system *s)
{
    const int rows = 3 * s->width + 1;
    for (int i = 0; i < rows * s->n; ++i) s->K[i] = 0.0;
    for (int i = 0; i < s->n * s->m; ++i) s->B[i] = s->C[i] = 0.0;
    for (int i = 0; i < s->m * s->m; ++i) s->D[i] = 0.0;
}

void fu_system_add(fu_system *s, int row, int column, double value)
{
    const int n = s->n;
    if (row < 0 || column < 0) return; /* a fixed dof */
    if (row < n && column < n)
        s->K[(long)column * (3 * s->width + 1) + 2 * s->width + row - column] += value;
    else if (row < n)
        s->B[(long)(column - n) * n + row] += value;
    else if (column < n)
        s->C[(long)(row - n) * n + column] += value;
    else
        s->D[(long)(column - n) * s->m + row - n] += value;
}

int fu_system_factor_band(fu_system *s, const fu_lapack *lapack)
{
    int n = s->n, width = s->width, rows = 3 * width + 1, info = 0;
    if (n) lapack->dgbtrf(&n, &n, &width, &width, s->K, &rows, s->pivot_band, &info);
    return info;
}

/* Schur complement of the factored band: D <- D - C K^-1 B, factored. */
int fu_system_factor_border(fu_system *s, const fu_lapack *lapack)
{
    int n = s->n, m = s->m, width = s->width, rows = 3 * width + 1, info = 0;
    double one = 1.0, minus = -1.0;
    if (!m) return 0;
    if (n) {
        for (long i = 0; i < (long)n * m; ++i) s->X[i] = s->B[i];
        lapack->dgbtrs("N", &n, &width, &width, &m, s->K, &rows, s->pivot_band, s->X, &n, &info);
        lapack->dgemm("T", "N", &m, &m, &n, &minus, s->C, &n, s->X, &n, &one, s->D, &m);
    }
    lapack->dgetrf(&m, &m, s->D, &m, s->pivot_border, &info);
    return info;
}

/* In place: right-hand side to solution. */
void fu_system_solve(const fu_system *s, const fu_lapack *lapack, double *x)
{
    int n = s->n, m = s->m, width = s->width, rows = 3 * width + 1, one = 1, info;
    double plus = 1.0, minus = -1.0, *y = x + n;
    if (n) lapack->dgbtrs("N", &n, &width, &width, &one, s->K, &rows, s->pivot_band, x, &n, &info);
    if (!m) return;
    if (n) lapack->dgemv("T", &n, &m, &minus, s->C, &n, x, &one, &plus, y, &one);
    lapack->dgetrs("N", &m, &one, s->D, &m, s->pivot_border, y, &m, &info);
    if (n) lapack->dgemv("N", &n, &m, &minus, s->X, &n, y, &one, &plus, x, &one);
}
