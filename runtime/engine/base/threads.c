/* Threads that share the work of a run, for jobs of some microseconds. OpenMP's threads wait for each other either
 * for milliseconds at full load or through the system; both take longer than such a job on a busy machine.
 *
 * A job has one part per thread. Each thread takes its own part, whose data are in its cache from the last time,
 * then parts that nobody has taken. The thread that shares its work thus waits for a part in progress, never for one
 * that has not begun: a sleeping thread costs nothing. A thread without work looks for some for about 0.1 ms, yields
 * its processor to others in the meantime, and then sleeps. */
#if !defined(_WIN32)
#define _POSIX_C_SOURCE 200809L
#endif
#include "base/threads.h"
#include "base/underflow.h"

#define MIN_SHARED_DOFS 1500 /* dofs: sharing fewer takes as long as doing the work */

/* fu_part_of for several parts. */
fu_range fu_one_of_parts(int n, int unit, int part, int parts)
{
    const long units = ((long)n + unit - 1) / unit;
    const long first = units * part / parts * unit, end = units * (part + 1L) / parts * unit;
    return (fu_range){first < n ? (int)first : n, end < n ? (int)end : n};
}

#if defined(_WIN32)

int fu_has_threads(void)
{
    return 0;
}

long fu_threads_size(int n)
{
    (void)n;
    return 1;
}

int fu_threads_start(fu_threads *threads, int n)
{
    (void)threads, (void)n;
    return 1;
}

void fu_threads_end(fu_threads *threads)
{
    (void)threads;
}

int fu_share_among(fu_threads *threads, int dofs, fu_work work, const void *what)
{
    (void)threads, (void)dofs;
    work(what, 0, 1);
    return 1;
}

#else

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>

enum {
    SPINS = 500,       /* polls for work or its end before a processor is yielded: some 20 microseconds */
    YIELDS = 200,      /* yields of the processor before a thread without work sleeps */
    CACHE_LINES = 128, /* bytes: threads that write at this distance do not share a line of the cache */
};

/* State of a thread: the last job whose part was taken, and the last whose part was done. */
typedef struct {
    atomic_uint taken, done;
    int number;
    fu_threads *all;
    pthread_t thread;
    char apart[CACHE_LINES];
} member;

struct fu_threads {
    int n;
    unsigned forks;   /* count of forks at the start */
    atomic_uint work; /* number of the last job; on one line of the cache with the next members */
    atomic_int sleeping, ending;
    fu_work function;
    const void *what;
    /* mode of the sharing thread, so that the bits of a result do not depend on the thread that computes it */
    unsigned underflow;
    char apart[CACHE_LINES];
    pthread_mutex_t mutex;
    pthread_cond_t wake;
    member members[];
};

static atomic_uint forks; /* forks of this process and its parents: a forked process has one thread alone */
static pthread_once_t once = PTHREAD_ONCE_INIT;

static void count_fork(void)
{
    ++forks;
}

static void count_forks(void)
{
    pthread_atfork(0, 0, count_fork);
}

/* Tells the processor that this thread waits. */
static void relax(void)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    __asm__ volatile("yield");
#endif
}

/* Does a member's part of a job, unless it is taken. */
static void take(fu_threads *all, member *owner, unsigned work)
{
    unsigned before = work - 1;
    if (atomic_load(&owner->taken) != before || !atomic_compare_exchange_strong(&owner->taken, &before, work)) return;
    fu_set_underflow(all->underflow);
    all->function(all->what, owner->number, all->n); /* no other job starts until this one is done */
    atomic_store(&owner->done, work);
}

/* Does the part of a member, then parts that nobody has taken. The first part is that of the sharing thread. */
static void take_parts(fu_threads *all, int first, unsigned work)
{
    for (int k = first; k < all->n; ++k) take(all, &all->members[k], work);
    for (int k = 1; k < first; ++k) take(all, &all->members[k], work);
}

/* Returns the number of a new job, or the last number if the threads shall end. */
static unsigned wait_for_work(fu_threads *all, unsigned last)
{
    for (int k = 0; k < SPINS + YIELDS; ++k) {
        const unsigned work = atomic_load(&all->work);
        if (work != last || atomic_load(&all->ending)) return work;
        if (k < SPINS) relax();
        else sched_yield();
    }
    pthread_mutex_lock(&all->mutex);
    ++all->sleeping;
    while (atomic_load(&all->work) == last && !atomic_load(&all->ending)) pthread_cond_wait(&all->wake, &all->mutex);
    --all->sleeping;
    pthread_mutex_unlock(&all->mutex);
    return atomic_load(&all->work);
}

static void *work_on(void *argument)
{
    const member *self = argument;
    fu_threads *all = self->all;
    for (unsigned last = 0, work; (work = wait_for_work(all, last)) != last; last = work)
        take_parts(all, self->number, work);
    return 0;
}

static void wake_all(fu_threads *all)
{
    if (!atomic_load(&all->sleeping)) return;
    pthread_mutex_lock(&all->mutex);
    pthread_cond_broadcast(&all->wake);
    pthread_mutex_unlock(&all->mutex);
}

int fu_has_threads(void)
{
    return 1;
}

/* Returns the bytes that n threads need. */
long fu_threads_size(int n)
{
    return (long)(sizeof(fu_threads) + (size_t)n * sizeof(member));
}

/* Starts n - 1 threads beside the calling one, in memory that is zero; returns their number with it. Signals remain
 * with the calling thread. */
int fu_threads_start(fu_threads *all, int n)
{
    sigset_t every, before;
    pthread_once(&once, count_forks);
    pthread_mutex_init(&all->mutex, 0);
    pthread_cond_init(&all->wake, 0);
    all->forks = forks;
    sigfillset(&every);
    pthread_sigmask(SIG_BLOCK, &every, &before);
    for (int k = 0; k < n; ++k) { /* they do nothing before there is work, when n is known */
        member *m = &all->members[k];
        m->all = all;
        m->number = k;
        if (k && pthread_create(&m->thread, 0, work_on, m)) break;
        all->n = k + 1;
    }
    pthread_sigmask(SIG_SETMASK, &before, 0);
    return all->n;
}

/* Ends the threads and waits for that. A forked process has none. */
void fu_threads_end(fu_threads *all)
{
    if (!all || all->forks != forks) return;
    atomic_store(&all->ending, 1);
    pthread_mutex_lock(&all->mutex);
    pthread_cond_broadcast(&all->wake);
    pthread_mutex_unlock(&all->mutex);
    for (int k = 1; k < all->n; ++k) pthread_join(all->members[k].thread, 0);
    pthread_cond_destroy(&all->wake);
    pthread_mutex_destroy(&all->mutex);
}

/* fu_share with threads. */
int fu_share_among(fu_threads *all, int dofs, fu_work function, const void *what)
{
    if (all->n == 1 || dofs < MIN_SHARED_DOFS || all->forks != forks) {
        function(what, 0, 1);
        return 1;
    }
    const unsigned work = atomic_load(&all->work) + 1;
    all->function = function;
    all->what = what;
    all->underflow = fu_underflow();
    atomic_store(&all->work, work);
    wake_all(all);
    function(what, 0, all->n);
    take_parts(all, 1, work);
    for (int k = 1, looked = 0; k < all->n; ++k)
        while (atomic_load(&all->members[k].done) != work) {
            if (++looked < SPINS) relax();
            else sched_yield();
        }
    return all->n;
}

#endif
