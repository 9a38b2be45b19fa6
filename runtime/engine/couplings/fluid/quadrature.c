/* Points of quadrature on the elements of a cable in a fluid, and their positions. */
#include "base/simd.h"
#include "bodies/model.h"
#include "couplings/fluid/drag.h"

#include <string.h>

/* Returns a point of quadrature on an element of n shape functions. */
fu_quadrature_point fu_drag_point(const fu_drag *drag, int n, int element, int point)
{
    const long k = (long)element * drag->stride + point;
    return (fu_quadrature_point){drag->weights[k], drag->N + k * n, drag->N_x + k * n,
                                 fu_drag_on_section(drag) ? drag->N_chord + k * n : 0};
}

int fu_drag_nodes(const fu_model *model, const fu_drag *drag)
{
    return drag->cable >= 0 ? model->cables[drag->cable].n_elements + 1 : drag->on.kernel ? drag->on.n_elements + 1 : 0;
}

const double *fu_drag_node(const fu_model *model, const fu_drag *drag, int k, const double *q)
{
    if (drag->cable < 0) return fu_span_node(&drag->on, k, q);
    const fu_cable *cable = &model->cables[drag->cable];
    return q + cable->first + k * cable->per_node;
}

void fu_drag_motion_of(const fu_cable *cable, const double *e, const double *v, const double *a, fu_drag_motion *out)
{
    const int dim = cable->kernel->dim, vectors = cable->kernel->vectors;
    out->n = cable->coordinates / dim;
    memset(out->by_N, 0, sizeof out->by_N[0] * (size_t)out->n);
    memset(out->by_N_x, 0, sizeof out->by_N_x[0] * (size_t)out->n);
    for (int k = 0; k < out->n; ++k) {
        double *const motion = out->by_N[k], *const relative = out->by_N_x[k];
        const int is_place = k % vectors == 0;
        for (int d = 0; d < dim; ++d) {
            motion[d] = e[k * dim + d];
            motion[3 + d] = v[k * dim + d];
            if (a) motion[6 + d] = a[k * dim + d];
            relative[d] = motion[d] - (is_place ? e[d] : 0.0);
            relative[3 + d] = motion[3 + d] - (is_place ? v[d] : 0.0);
        }
    }
}

/* Computes the sum of n rows of a whole number of blocks of numbers, times N. */
FU_INLINE void sum_rows(int n, const double *N, const double *rows, int size, double *out)
{
    memset(out, 0, sizeof(double) * (size_t)size);
    for (int k = 0; k < n; ++k)
        for (int i = 0; i < size; i += FU_SIMD_WIDTH)
            *(fu_simd_block *)(out + i) += N[k] * *(const fu_simd_block *)(rows + k * size + i);
}

FU_INLINE void place_of(int n, const fu_drag_motion *of, const fu_quadrature_point *point, fu_drag_place *at)
{
    sum_rows(n, point->N, of->by_N[0], FU_DRAG_MOTION, at->by_N);
    sum_rows(n, point->N_x, of->by_N_x[0], FU_DRAG_SLOPES, at->by_N_x);
    if (point->N_chord) sum_rows(n, point->N_chord, of->by_N_x[0], FU_DRAG_SLOPES, at->by_N_chord);
}

FU_INLINE void place_on_axis(const fu_drag_motion *of, const fu_quadrature_point *point, fu_drag_place *at)
{
    if (of->n == 4) place_of(4, of, point, at); /* of the usual elements: unrolled */
    else place_of(of->n, of, point, at);
}

FU_SIMD_FUNCTION(fu_drag_place_on_axis, place_on_axis,
                 (const fu_drag_motion *of, const fu_quadrature_point *point, fu_drag_place *at), (of, point, at))
