/* Elimination of a border by fronts: linear/fronts.c, linear/complex_fronts.c, linear/banded_front.c. */
#ifndef FUNICULAR_LINEAR_FRONTS_H
#define FUNICULAR_LINEAR_FRONTS_H

/* The order in which the unknowns of a border are eliminated, found once for a scene (model/elimination.py).
 *
 * A front eliminates its pivots and updates the Schur complement of their neighbours, which are pivots of later
 * fronts. With one front the matrix is dense. Storage of the matrix, of front k from start[k] on: the columns of its
 * pivots, over the rows of pivots and neighbours; then the columns of the neighbours, over the rows of the pivots. */
typedef struct {
    int m, n;      /* unknowns, fronts */
    int size;      /* numbers in the storage */
    double solves; /* arithmetic of a factorisation over that of a solve; 0 where the entries decide on it (a band) */
    const int *start;                    /* n */
    const int *first;                    /* n: first place of its unknowns in `unknown` and `in_parent` */
    const int *pivots;                   /* n: number of eliminated unknowns */
    const int *neighbours;               /* n: number of neighbours */
    const int *unknown;                  /* pivots, then neighbours; both increase */
    const int *in_parent;                /* the neighbours' places among the unknowns of the parent */
    const int *parent, *child, *sibling; /* n: -1 for none */
    const int *front, *place; /* m: of each unknown the front that eliminates it, its place among the pivots there */
} fu_fronts;

/* A front without neighbours that is factored as a band where most of its entries are zero
 * (banded_front_template.h). */
typedef struct {
    int front;                      /* -1 for none */
    int most_entries, most_numbers; /* capacity: entries, numbers of the band */
    int is_listed;                  /* the entries are those of the matrix */
    int n, lower, upper;            /* unknowns, 0 if it is factored densely; diagonals on both sides */
    int *first, *rows;              /* of each column its first entry; rows of the entries */
    int *child;                     /* of each unknown a child of which it is a neighbour, -1 for none */
    int *order, *place;             /* the unknown at each place in the band, and the reverse */
    int *pivot;
    double *band; /* in LAPACK's storage with FU_BANDED_PADDING rows of zeros; complex numbers take two doubles */
} fu_banded_front;

/* Zeros at the end of a column of such a band: blocks of four rows of four columns may go on there, from the last row
 * of the first column, and before the first row of the last column. */
enum { FU_BANDED_PADDING = 6 };

/* Returns the numbers of a column of such a band. */
static inline int fu_banded_stride(const fu_banded_front *banded)
{
    return 2 * banded->lower + banded->upper + 1 + FU_BANDED_PADDING;
}

void fu_order_band(const fu_fronts *fronts, fu_banded_front *banded, int k);
void fu_find_width(const fu_fronts *fronts, fu_banded_front *banded, int k);
int fu_clear_entries(fu_banded_front *banded, int n, double *matrix);

/* Unknowns of a front up to which its factors stay where its Schur complement leaves gaps between them. */
enum { FU_UNPACKED_FRONT = 16 };

/* Factors of such a matrix. A front may delay pivots to its parent, so that sizes are known only afterwards. A front is
 * factored behind the factors of those before. Then they are packed: the columns of its pivots, after them the rows of
 * its pivots in the other columns. Its Schur complement goes to the end of the memory until its parent is assembled. */
typedef struct {
    double *numbers; /* factors, from the start; Schur complements, before the end; complex numbers take two doubles */
    int end, low;    /* in `numbers`: the end of the factors, the start of the Schur complements */
    int *unknowns;   /* of each: those of its rows, then those of its columns, in the order of elimination */
    int *map;        /* m: places of a child's unknowns in its parent */
    double *x;       /* 2 m numbers: the solution; of a front, the right side */
    int *start, *first, *size, *pivots,
        *done;                       /* n: in `numbers`, in `unknowns`; unknowns, candidates for pivots, and pivots */
    int *complement;                 /* n: Schur complement in `numbers`, -1 for none there */
    int most_numbers, most_unknowns; /* capacity of the memory */
    fu_banded_front banded;
} fu_factors;

#endif
