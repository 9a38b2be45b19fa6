/* Sums of vectors that threads share. They cost little, but one thread alone would move half of each vector out of the
 * cache of the other. */
#include "base/simd.h"
#include "linear/linear.h"

/* x = factor (y - z), or factor y if z is null; `adds`: adds to x. */
typedef struct {
    int n, adds;
    double factor;
    const double *y, *z;
    double *x;
} sum;

#define BLOCK(vector, i) (*(fu_simd_block *)((vector) + (i)))
#define BLOCK_OF(vector, i) (*(const fu_simd_block *)((vector) + (i)))

FU_INLINE void sum_range(const sum *job, int first, int end)
{
    const double factor = job->factor, *y = job->y, *z = job->z;
    double *x = job->x;
    int i = first;
    if (job->adds) {
        for (; i + FU_SIMD_WIDTH <= end; i += FU_SIMD_WIDTH) BLOCK(x, i) += factor * BLOCK_OF(y, i);
        for (; i < end; ++i) x[i] += factor * y[i];
    } else if (z) {
        for (; i + FU_SIMD_WIDTH <= end; i += FU_SIMD_WIDTH) BLOCK(x, i) = factor * (BLOCK_OF(y, i) - BLOCK_OF(z, i));
        for (; i < end; ++i) x[i] = factor * (y[i] - z[i]);
    } else {
        for (; i + FU_SIMD_WIDTH <= end; i += FU_SIMD_WIDTH) BLOCK(x, i) = factor * BLOCK_OF(y, i);
        for (; i < end; ++i) x[i] = factor * y[i];
    }
}

/* Computes the numbers [first, end) of x. */
static void sums(const sum *job, int first, int end);
FU_SIMD_FUNCTION(sums, sum_range, (const sum *job, int first, int end), (job, first, end))

static void sum_part(const void *what, int part, int parts)
{
    const sum *job = what;
    const fu_range of = fu_part_of(job->n, FU_DOFS_APART, part, parts);
    sums(job, of.first, of.end);
}

/* Computes x = factor y. */
void fu_set_times(fu_threads *threads, int n, double factor, const double *y, double *x)
{
    const sum job = {n, 0, factor, y, 0, x};
    fu_share(threads, n, sum_part, &job);
}

/* Adds factor y to x. */
void fu_add_times(fu_threads *threads, int n, double factor, const double *y, double *x)
{
    const sum job = {n, 1, factor, y, 0, x};
    fu_share(threads, n, sum_part, &job);
}

/* Computes x = factor (y - z). */
void fu_set_difference(fu_threads *threads, int n, double factor, const double *y, const double *z, double *x)
{
    const sum job = {n, 0, factor, y, z, x};
    fu_share(threads, n, sum_part, &job);
}
