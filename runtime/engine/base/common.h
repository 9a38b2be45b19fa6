/* Declarations shared by all headers of the engine: kernels, limits, and names of structures described elsewhere. */
#ifndef FUNICULAR_BASE_COMMON_H
#define FUNICULAR_BASE_COMMON_H

#include "blocks.h"
#include "kernels.h"
#include "point_blocks.h"

#include <stddef.h>

#define FU_MAX_COORDINATES 32        /* of one element, or of the kernels of a slide on it; model/build.py checks */
#define FU_MAX_CONSTANTS 512         /* of a law on an element whose growth a signal prescribes */
#define FU_SERIES_HEAD 3             /* numbers of an element before the series of these constants */
#define FU_ATTACHMENT_COORDINATES 40 /* of the carrier of an attachment, s included; model/build.py checks */
#define FU_SLIDE_COORDINATES (FU_MAX_COORDINATES + FU_ATTACHMENT_COORDINATES)
#define FU_ROW_COORDINATES (2 * (FU_ATTACHMENT_COORDINATES + FU_SLIDE_COORDINATES))
#define FU_MAX_RATES 128  /* of strain, of one element; engine.pyx checks */
#define FU_SIGNAL_TERMS 7 /* coefficients of a segment of a signal */

#define FU_SPACE 3          /* components of a vector, in the plane too, and rotations of a frame in space */
#define FU_MATRIX_ENTRIES 9 /* of a matrix in space, or of a change of axes */
#define FU_FRAME_DOFS 6     /* of a body's frame in space: three translations, three rotations */
#define FU_FRAME_ENTRIES 7  /* of its configuration: position, and a unit quaternion */

/* An array of a state or of a row of output: its name, the number and size of its items, whether they are real (else
 * integers), and its number of axes in output, rows being the first. */
typedef struct {
    const char *name;
    void *data;
    long items;
    size_t size;
    int is_real, axes;
} fu_array;

typedef struct fu_model fu_model;
typedef struct fu_state fu_state;
typedef struct fu_run fu_run;
typedef struct fu_inputs fu_inputs;
typedef struct fu_proximity fu_proximity;
typedef struct fu_coupling fu_coupling;
typedef struct fu_slide fu_slide;
typedef struct fu_slackness fu_slackness;
typedef struct fu_accelerator fu_accelerator;
typedef struct fu_linear_model fu_linear_model;

/* Newton matrix = inertia M + stiffness (K + rate D); statics has no inertia */
typedef struct {
    double inertia, rate, stiffness;
} fu_weights;

/* Returns the scalar product of two vectors of n components. */
static inline double fu_dot(int n, const double *a, const double *b)
{
    double sum = 0.0;
    for (int i = 0; i < n; ++i) sum += a[i] * b[i];
    return sum;
}

/* Returns the last of the increasing breakpoints from `low` on and before `high` that x has reached; `low` if none. */
static inline int fu_last_reached(const double *increasing, int low, int high, double x)
{
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (increasing[middle] <= x) low = middle;
        else high = middle;
    }
    return low;
}

/* Computes the vector product of two vectors in space. */
static inline void fu_cross(const double *a, const double *b, double *out)
{
    for (int d = 0; d < 3; ++d) out[d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
}

#endif
