/* Elimination of a border by fronts: linear/fronts.c, linear/complex_fronts.c. */
#ifndef FUNICULAR_LINEAR_FRONTS_H
#define FUNICULAR_LINEAR_FRONTS_H

/* The order in which the unknowns of a border are eliminated, found once for a scene (model/elimination.py).
 *
 * A front eliminates its pivots and updates the Schur complement of their neighbours, which are pivots of later
 * fronts. With one front the matrix is dense. Storage of the matrix, of front k from start[k] on: the columns of its
 * pivots, over the rows of pivots and neighbours; then the columns of the neighbours, over the rows of the pivots. */
typedef struct {
    int m, n;                            /* unknowns, fronts */
    int size;                            /* numbers in the storage */
    const int *start;                    /* n */
    const int *first;                    /* n: first place of its unknowns in `unknown` and `in_parent` */
    const int *pivots;                   /* n: number of eliminated unknowns */
    const int *neighbours;               /* n: number of neighbours */
    const int *unknown;                  /* pivots, then neighbours; both increase */
    const int *in_parent;                /* the neighbours' places among the unknowns of the parent */
    const int *parent, *child, *sibling; /* n: -1 for none */
    const int *front, *place; /* m: of each unknown the front that eliminates it, its place among the pivots there */
} fu_fronts;

/* Factors of such a matrix. A front may delay pivots to its parent, so that sizes are known only afterwards. */
typedef struct {
    double *numbers; /* fronts, column by column, one after the other; complex numbers take two doubles */
    int *unknowns;   /* of each: those of its rows, then those of its columns, in the order of elimination */
    int *map;        /* m: places of a child's unknowns in its parent */
    double *x;       /* 2 m numbers: the solution; of a front, the right side */
    int *start, *first, *size, *pivots,
        *done;                       /* n: in `numbers`, in `unknowns`; unknowns, candidates for pivots, and pivots */
    int most_numbers, most_unknowns; /* capacity of the memory */
} fu_factors;

#endif
