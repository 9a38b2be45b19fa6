/* Long chains, eliminated from both ends towards their middle: a twisted factorisation (van der Vorst 1987,
 * "Analysis of a parallel solution method for tridiagonal linear systems"; for bands Lang 1992). There is no fill
 * beyond the middle, the number of operations equals that from one end, and both halves are independent: in the
 * factorisation, and in either half of a substitution. The order, and so the bits, do not depend on the number of
 * threads.
 *
 * A chain of n unknowns has n = count + middle + count. Each half is a banded matrix of count + middle columns, the
 * second one backwards from the chain's end. Its last columns hold the Schur complement of the middle block A after
 * one half: A - U1 and A - U2. After both halves it is A - U1 - U2 = (A - U1) + (A - U2) - A. */
#include "linear/linear.h"

/* A chain in halves. L: columns of either half, those of the first one with the middle's. */
typedef struct {
    int start, n, count, middle;
    double *L[2];
} chain_in_halves;

/* A job shared by two threads, half each. */
typedef struct job {
    const fu_system *system;
    chain_in_halves chain;
    fu_span rows; /* nonzero rows of x */
    double *x;
    void (*work)(const struct job *job, int half);
} job;

static void work_part(const void *what, int part, int parts)
{
    const job *job = what;
    for (int half = part; half < 2; half += parts) job->work(job, half);
}

int fu_is_twisted(const fu_system *s, int chain)
{
    const int n = s->chains[chain + 1] - s->chains[chain];
    return n >= FU_TWISTED_FROM && n >= 4 * (s->width + FU_BAND_GROUP);
}

static chain_in_halves in_halves(const fu_system *s, int chain)
{
    const int start = s->chains[chain], n = s->chains[chain + 1] - start;
    const int count = (n - s->width) / 2 / FU_BAND_GROUP * FU_BAND_GROUP, middle = n - 2 * count;
    double *L = fu_factor_of(s, chain);
    return (chain_in_halves){start, n, count, middle, {L, L + (long)(count + middle + FU_BAND_GROUP) * (s->width + 1)}};
}

/* Eliminates half a chain; the Schur complement of the middle is in the last columns. The half's entry of pivot_band,
 * otherwise used by factorisations with pivots alone, becomes nonzero if the half is not symmetric or not positive
 * definite. */
static void eliminate(const job *job, int half)
{
    const fu_system *s = job->system;
    const chain_in_halves *c = &job->chain;
    const int columns = c->count + c->middle;
    int failed = 1;
    double *L = c->L[half];
    const fu_span rows =
        half ? (fu_span){c->start + c->count, c->start + c->n} : (fu_span){c->start, c->start + columns};
    if (fu_pack(s, rows, half, L)) fu_band_eliminate(c->count, columns, s->width, L, &failed);
    s->pivot_band[c->start + half] = failed;
}

/* Factors a chain of K; returns nonzero if it is not symmetric or not positive definite. */
int fu_twisted_factor(fu_system *s, int chain)
{
    const job job = {s, in_halves(s, chain), {0, 0}, 0, eliminate};
    const chain_in_halves *c = &job.chain;
    const int width = s->width, stride = width + 1, last = c->middle - 1;
    fu_share(s->threads, c->n, work_part, &job);
    if (s->pivot_band[c->start] || s->pivot_band[c->start + 1]) return 1;
    double *first = c->L[0] + (long)c->count * stride;
    const double *second = c->L[1] + (long)c->count * stride;
    for (int j = 0; j <= last; ++j) {
        const double *below = s->K + (long)(c->start + c->count + j) * FU_BAND_ROWS(width) + FU_BAND_DIAGONAL(width);
        for (int i = j; i <= last && i <= j + width; ++i)
            first[(long)j * stride + i - j] += second[(long)(last - i) * stride + i - j] - below[i - j];
    }
    return fu_band_factor(c->middle, width, first);
}

/* Computes x = L^-1 x in half a chain, of the second one in the mirror, with its change of the middle. */
static void forward(const job *job, int half)
{
    const fu_system *s = job->system;
    const chain_in_halves *c = &job->chain;
    const int end = c->start + c->n;
    double *x = job->x + c->start;
    if (half == 0) {
        fu_band_forward(c->count, s->width, c->L[0], job->rows.first > c->start ? job->rows.first - c->start : 0, x);
        return;
    }
    double *mirror = s->mirror + c->start;
    for (int i = 0; i < c->count; ++i) mirror[i] = x[c->n - 1 - i];
    for (int i = c->count; i < c->count + c->middle; ++i) mirror[i] = 0.0;
    fu_band_forward(c->count, s->width, c->L[1], job->rows.end < end ? end - job->rows.end : 0, mirror);
}

/* Computes x = L'^-1 D^-1 x in half a chain, after the solution of the middle. */
static void backward(const job *job, int half)
{
    const fu_system *s = job->system;
    const chain_in_halves *c = &job->chain;
    double *x = job->x + c->start;
    if (half == 0) {
        fu_band_backward(c->count, s->width, c->L[0], x);
        return;
    }
    double *mirror = s->mirror + c->start;
    for (int i = c->count; i < c->count + c->middle; ++i) mirror[i] = x[c->n - 1 - i];
    fu_band_backward(c->count, s->width, c->L[1], mirror);
    for (int i = 0; i < c->count; ++i) x[c->n - 1 - i] = mirror[i];
}

/* Computes x = K^-1 x in a chain, with x zero outside of these rows. */
void fu_twisted_solve(const fu_system *s, int chain, fu_span rows, double *x)
{
    job job = {s, in_halves(s, chain), rows, x, forward};
    const chain_in_halves *c = &job.chain;
    double *middle = x + c->start + c->count;
    fu_share(s->threads, c->n, work_part, &job);
    for (int i = 0; i < c->middle; ++i) middle[i] += s->mirror[c->start + c->count + c->middle - 1 - i];
    fu_band_solve(c->middle, s->width, c->L[0] + (long)c->count * (s->width + 1), 0, middle);
    job.work = backward;
    fu_share(s->threads, c->n, work_part, &job);
}
