/* Banded matrices with a border, and LAPACK for their parts: linear/band.c, linear/bordered.c,
 * linear/unsymmetric_band.c, linear/pivoted.c, linear/inverse.c, linear/small.c, linear/full.c. */
#ifndef FUNICULAR_LINEAR_LINEAR_H
#define FUNICULAR_LINEAR_LINEAR_H

#include "base/common.h"
#include "linear/fronts.h"
#include "base/threads.h"

/* The functions of LAPACK that systems with large borders call (fu_needs_lapack), with their arguments;
 * linear/lapack.c. */
#define FU_LAPACK_FUNCTIONS(LAPACK)                                                                                    \
    LAPACK(dgbtrf, int *, int *, int *, int *, double *, int *, int *, int *)                                          \
    LAPACK(dgetrf, int *, int *, double *, int *, int *, int *)                                                        \
    LAPACK(zgbtrf, int *, int *, int *, int *, void *, int *, int *, int *)                                            \
    LAPACK(zgetrf, int *, int *, void *, int *, int *, int *)                                                          \
    LAPACK(zgetrs, char *, int *, int *, void *, int *, int *, void *, int *, int *)                                   \
    LAPACK(dgetrs, char *, int *, int *, double *, int *, int *, double *, int *, int *)
#define MEMBER(name, ...) void (*name)(__VA_ARGS__);
typedef struct {
    FU_LAPACK_FUNCTIONS(MEMBER)
} fu_lapack;
#undef MEMBER

const char *fu_lapack_name(int k);
void fu_lapack_attach(fu_lapack *lapack, int k, const void *function);

/* band.c: number of columns eliminated at once (the width of a band is at least this less one), and of numbers accessed
 * beyond the end of a column of n. */
#define FU_BAND_GROUP 4
#define FU_BAND_BEYOND(width) ((width) + FU_BAND_GROUP)
#define FU_BAND_LENGTH(n, width) ((long)(n) + FU_BAND_BEYOND(width))

/* inverse.c: largest number of unknowns of an inverted band, and rows of a column of the inverse. */
#define FU_MAX_INVERTED 96
#define FU_INVERSE_GROUP 16
#define FU_INVERSE_ROWS(n) (((n) + FU_INVERSE_GROUP - 1) / FU_INVERSE_GROUP * FU_INVERSE_GROUP)

/* small.c: the largest matrix that is factored there. */
#define FU_MAX_SMALL 32

/* Chains of this number of unknowns and more are eliminated from both ends towards their middle (twisted.c), by two
 * threads if there are: shorter ones are too fast to share. Then the columns of a factored chain beyond its unknowns:
 * groups, and the middle's. */
#define FU_TWISTED_FROM 1024
#define FU_BAND_MORE(width) ((width) + 3 * FU_BAND_GROUP)

/* LAPACK's band storage for a factorisation with pivots: its rows, the row of the diagonal, and from an entry to that
 * of its row in the next column. Above the 2 width + 1 rows of the band there are width more for the fill of pivots. */
#define FU_BAND_ROWS(width) (3 * (width) + 1)
#define FU_BAND_DIAGONAL(width) (2 * (width))
#define FU_BAND_STRIDE(width) (3 * (width))

/* Parts of a chain with separate row ranges: the closure of a loop touches both ends, and not the rows between them. */
enum { FU_HALVES = 2 };

/* Rows [first, end) of a column; end is 0 if there are none. */
typedef struct {
    int first, end;
} fu_span;

/* Strip of unknown k of the border in a chain: columns of B and X, a row of C. Its entry in a row of the band is at
 * `at` + row of B and C, at `x` + row of X. room: 0, or the rows of a strip that follows a slide: without entries it
 * may move to another chain. */
typedef struct {
    int k, chain, at, x, room;
} fu_strip;

/* Block of a column of X, or a row of C, in half a chain. */
typedef struct {
    int k, strip;
    fu_span rows;
} fu_matrix_block;

/* Factorisation of a chain: in L (band.c), in L and U (unsymmetric_band.c), in K (pivoted.c). */
typedef enum { FU_SYMMETRIC, FU_UNPIVOTED, FU_PIVOTED } fu_factorisation;

/* A banded matrix with a border: [K B; C D]. Only K is large. It consists of chains, which the border alone
 * connects. */
typedef struct {
    int n, width; /* band part: size, half bandwidth */
    int m;        /* border */
    int n_chains;
    int constant;                /* number of first unknowns of the border that are constant */
    int definite;                /* all chains are factored as FU_SYMMETRIC */
    int *factorisations;         /* n_chains: factorisation of each */
    int n_strips, n_strip_rows;  /* n_strip_rows: the numbers of B, or of C */
    fu_strip *strips;            /* by unknown of the border, those that may move last */
    const int *first_strip;      /* m + 1: of each unknown of the border, and n_strips */
    int *chain_start, *on_chain; /* n_chains + 1: first place in on_chain of the strips of each chain */
    int is_listed;               /* they are those of the present strips */
    const int *chains;           /* n_chains + 1: the first row of each, and n */
    const int *half;             /* of each row of the band: 2 chain, plus 1 from the middle on */
    double *K;                   /* LAPACK's band storage, FU_BAND_ROWS x n; shared by all systems of a run */
    double *L, *U;               /* (width + 1) x n, and FU_BAND_MORE for each chain */
    double *mirror;              /* n: right sides from the ends of chains backwards */
    double *B;                   /* strip by strip */
    double *C;                   /* the border's rows, likewise */
    double *D;                   /* stored as by `fronts`, with one more number, which must stay zero */
    const fu_fronts *fronts;
    fu_factors factors;              /* of D, unless there is only one front: then D has them */
    double *X;                       /* K^-1 B, FU_BAND_BEYOND more a strip */
    fu_span *span_B, *span_C;        /* FU_HALVES a strip: nonzero rows of each half; end 0 if none */
    fu_span *span_X;                 /* likewise, the significant rows */
    fu_matrix_block *columns, *rows; /* of X and C: those of a chain from FU_HALVES chain_start on */
    int *n_columns, *n_rows;         /* n_chains: numbers of blocks */
    int *pivot_band, *pivot_border;
    double *inverse; /* null, or the inverse of the band, FU_INVERSE_ROWS a column, if `inverted` */
    int inverted;
    double *full; /* null, or all of the matrix, factored, if `is_full` (full.c); by columns */
    int *pivot_full;
    int is_full;
    fu_threads *threads; /* null for one */
} fu_system;

void fu_band_eliminate(int columns, int n, int width, double *A, int *failed);
int fu_band_factor(int n, int width, double *A);
void fu_band_forward(int n, int width, const double *A, int first, double *x);
void fu_band_backward(int n, int width, const double *A, double *x);
void fu_band_solve(int n, int width, const double *A, int first, double *x);

/* Rows of the upper half of a band of n rows, in whole groups. */
#define FU_HALF_BAND_ROWS(n) (((n) + FU_BAND_GROUP - 1) / FU_BAND_GROUP * FU_BAND_GROUP)
void fu_add_half_bands_times(int n, int stride, int count, double *const *A, const double *const *x, double *y);
void fu_half_band_form(int n, int stride, const double *A, const double *x, double *value);

int fu_unsymmetric_pack(const fu_system *system, int chain, double *L, double *U);
int fu_unsymmetric_factor(int n, int width, double *L, double *U);

int fu_fronts_block(const fu_fronts *fronts, int row, int column, int *stride);
int fu_fronts_at(const fu_fronts *fronts, int row, int column);
void fu_fronts_add_product(const fu_fronts *fronts, const double *matrix, int columns, const double *x, double *y);
int fu_fronts_factor(const fu_fronts *fronts, const double *matrix, fu_factors *factors, const fu_lapack *lapack);
void fu_fronts_solve(const fu_fronts *fronts, const fu_factors *factors, double *y);

int fu_pivoted_factor(int n, int width, int stride, double *A, int *pivot);
void fu_pivoted_solve(int n, int width, int stride, const double *A, const int *pivot, double *x);

void fu_inverse_make(int n, int width, const double *L, double *inverse);
void fu_inverse_times(int rows, const double *inverse, int first, int end, const double *b, double *x);

int fu_small_factor(int n, double *A, int *pivot);
void fu_small_solve(int n, const double *A, const int *pivot, double *x);

int fu_is_twisted(const fu_system *system, int chain);
int fu_twisted_factor(fu_system *system, int chain);
void fu_twisted_solve(const fu_system *system, int chain, fu_span rows, double *x);

void fu_set_times(fu_threads *threads, int n, double factor, const double *y, double *x);
void fu_add_times(fu_threads *threads, int n, double factor, const double *y, double *x);
void fu_set_difference(fu_threads *threads, int n, double factor, const double *y, const double *z, double *x);

int fu_needs_lapack(const fu_system *system);
void fu_system_clear(fu_system *system);
long fu_factor_at(const fu_system *system, int chain);
double *fu_factor_of(const fu_system *system, int chain);
int fu_pack(const fu_system *system, fu_span rows, int backwards, double *L);
void fu_system_clear_border(fu_system *system);
fu_span fu_common(fu_span one, fu_span other);
int fu_strip_of(fu_system *system, int k, int chain);
void fu_find_significant(const fu_system *system, int strip, const double *x, fu_span rows[FU_HALVES]);
int fu_list_blocks(const fu_system *system, int strip, const fu_span rows[FU_HALVES], fu_matrix_block *blocks);
void fu_system_release_border(fu_system *system);
int fu_system_factor(fu_system *system, const fu_lapack *lapack);
int fu_system_factor_band(fu_system *system);
void fu_system_invert_band(fu_system *system);
void fu_system_keep_border(fu_system *system, int columns);
int fu_system_factor_border(fu_system *system, const fu_lapack *lapack);
void fu_system_solve(const fu_system *system, const fu_lapack *lapack, double *x);
void fu_system_solve_border(const fu_system *system, const fu_lapack *lapack, double *x);

#endif
