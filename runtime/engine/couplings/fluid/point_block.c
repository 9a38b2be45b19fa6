/* Blocks of points of quadrature on an element of a cable: shape functions, and motion. */
#include "bodies/model.h"
#include "couplings/common/point_lanes.h"
#include "couplings/fluid/drag.h"

#include <string.h>

void fu_block_shapes_of(const fu_drag_points *points, int from, int n_shapes, fu_block_shapes *out)
{
    out->n = points->n - from < FU_BLOCK_POINTS ? points->n - from : FU_BLOCK_POINTS;
    out->shapes = n_shapes;
    for (int p = 0; p < FU_BLOCK_POINTS; ++p) {
        const fu_quadrature_point *at = &points->at[from + (p < out->n ? p : out->n - 1)];
        out->weight[p] = p < out->n ? at->weight : 0.0;
        for (int k = 0; k < n_shapes; ++k) {
            out->N[k][p] = at->N[k];
            out->N_x[k][p] = at->N_x[k];
            if (at->N_chord) out->N_chord[k][p] = at->N_chord[k];
        }
    }
    out->has_chord = points->at[from].N_chord != 0;
}

void fu_block_vector(int dim, const fu_points *of, int point, double out[3])
{
    for (int d = 0; d < 3; ++d) out[d] = d < dim ? of[d][point] : 0.0;
}

/* Computes the sum of the values of each vector, of a component and less `first` at each node, times the rows N. */
FU_INLINE void sum_over(int dim, int n, int vectors, const fu_points *N, const double *values, double first,
                        fu_points *out)
{
    fu_points sum = {0.0};
    for (int k = 0; k < n; ++k) sum += N[k] * (values[k * dim] - (k % vectors == 0 ? first : 0.0));
    *out = sum;
}

FU_INLINE void motion_of(int dim, int n, int vectors, const fu_block_shapes *shapes, const double *e, const double *v,
                         const double *a, fu_block_motion *out)
{
    for (int d = 0; d < dim; ++d) {
        sum_over(dim, n, vectors, shapes->N, e + d, 0.0, &out->r[d]);
        sum_over(dim, n, vectors, shapes->N, v + d, 0.0, &out->v[d]);
        if (a) sum_over(dim, n, vectors, shapes->N, a + d, 0.0, &out->a[d]);
        else out->a[d] = (fu_points){0.0};
        sum_over(dim, n, vectors, shapes->N_x, e + d, e[d], &out->r_x[d]);
        sum_over(dim, n, vectors, shapes->N_x, v + d, v[d], &out->r_x_rate[d]);
        if (!shapes->has_chord) continue;
        sum_over(dim, n, vectors, shapes->N_chord, e + d, e[d], &out->chord[d]);
        sum_over(dim, n, vectors, shapes->N_chord, v + d, v[d], &out->chord_rate[d]);
    }
}

FU_INLINE void by_shapes(const fu_cable *cable, const fu_block_shapes *shapes, const double *e, const double *v,
                         const double *a, fu_block_motion *out)
{
    const int dim = cable->kernel->dim, vectors = cable->kernel->vectors;
    if (shapes->shapes == 4 && vectors == 2) { /* of the usual elements: unrolled */
        if (dim == 2) motion_of(2, 4, 2, shapes, e, v, a, out);
        else motion_of(3, 4, 2, shapes, e, v, a, out);
    } else motion_of(dim, shapes->shapes, vectors, shapes, e, v, a, out);
}

FU_SIMD_FUNCTION(fu_block_motion_of, by_shapes,
                 (const fu_cable *cable, const fu_block_shapes *shapes, const double *e, const double *v,
                  const double *a, fu_block_motion *out),
                 (cable, shapes, e, v, a, out))
