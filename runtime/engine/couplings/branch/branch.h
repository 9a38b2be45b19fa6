/* Branches beside the elastic law of a cable (derive/couplings/branch.py): couplings/branch/branch.c. */
#ifndef FUNICULAR_COUPLINGS_BRANCH_BRANCH_H
#define FUNICULAR_COUPLINGS_BRANCH_BRANCH_H

#include "couplings/common/coupling.h"

#define FU_BRANCH_POINTS 2   /* of an element */
#define FU_BRANCH_MEASURES 4 /* of a point, at most: strain and curvature */

/* History of a point, from the end of the last step: measures and their elastic part, the tangent; and of all points,
 * the time, s (FU_NO_TIME before any step). */
typedef struct {
    double m[FU_BRANCH_MEASURES], d[FU_BRANCH_MEASURES], i[3];
} fu_branch_mark;
typedef struct {
    fu_branch_mark marks[FU_BRANCH_POINTS];
    double time;
} fu_branch_history;
#define FU_BRANCH_NUMBERS 23
_Static_assert(sizeof(fu_branch_history) == FU_BRANCH_NUMBERS * sizeof(double), "numbers of a state are doubles");

/* A branch on an element of a cable. */
typedef struct {
    fu_coupling base;
    const fu_branch_kernels *kernel;
    int cable, element;
    double stiffness[FU_BRANCH_MEASURES]; /* of each measure, N, N m^2 */
    double time;                          /* relaxation time of a dashpot, s; 0: a slider */
    double limit;                         /* size of the stress at which the slider slides, N, N m */
    double weights[FU_BRANCH_POINTS];     /* of the points, m */
    const double *N_x, *N_xx;             /* (points x vectors of an element): derivatives of the shape functions */
} fu_branch;
extern const fu_coupling_type fu_branch_type;

#endif
