/* Threads that share the work of a run: base/threads.c. */
#ifndef FUNICULAR_BASE_THREADS_H
#define FUNICULAR_BASE_THREADS_H

/* least number of dofs, or unknowns, of a thread: more than those of one line of the cache */
#define FU_DOFS_APART 64

typedef struct fu_threads fu_threads;

/* Does one of the parts of a job. The numbers written must not depend on the number of parts. */
typedef void (*fu_work)(const void *what, int part, int parts);

/* Indices in [first, end). */
typedef struct {
    int first, end;
} fu_range;

int fu_has_threads(void);
long fu_threads_size(int n);
int fu_threads_start(fu_threads *threads, int n);
void fu_threads_end(fu_threads *threads);
int fu_share_among(fu_threads *threads, int dofs, fu_work work, const void *what);
fu_range fu_one_of_parts(int n, int unit, int part, int parts);

/* Does a job on a number of dofs, by all threads if that is faster; returns the number of its parts. */
static inline int fu_share(fu_threads *threads, int dofs, fu_work work, const void *what)
{
    if (threads) return fu_share_among(threads, dofs, work, what);
    work(what, 0, 1);
    return 1;
}

/* Returns a part of n items, in whole units except the last. */
static inline fu_range fu_part_of(int n, int unit, int part, int parts)
{
    return parts == 1 ? (fu_range){0, n} : fu_one_of_parts(n, unit, part, parts);
}

#endif
