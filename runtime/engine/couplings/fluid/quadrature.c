/* Points of quadrature on the elements of a cable in a fluid, and their positions. */
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

/* Computes the motion of a point of quadrature on an element with the coordinates e, rates v and accelerations a (null:
 * none). */
void fu_drag_place_on_axis(const fu_model *model, const fu_drag *drag, const double *e, const double *v,
                           const double *a, fu_quadrature_point point, fu_drag_place *at)
{
    const fu_cable *cable = &model->cables[drag->cable];
    const int dim = model->dim, n = cable->coordinates / dim;
    const double *N = point.N, *N_x = point.N_x;
    memset(at, 0, sizeof *at);
    for (int k = 0; k < n; ++k)
        for (int d = 0; d < dim; ++d) {
            /* from the first node: slopes do not depend on its position, and no digits are lost far from the origin */
            const int is_place = k % cable->kernel->vectors == 0;
            const double local = e[k * dim + d] - (is_place ? e[d] : 0.0);
            at->r[d] += N[k] * e[k * dim + d];
            at->r_x[d] += N_x[k] * local;
            at->v[d] += N[k] * v[k * dim + d];
            at->r_x_rate[d] += N_x[k] * (v[k * dim + d] - (is_place ? v[d] : 0.0));
            if (a) at->a[d] += N[k] * a[k * dim + d];
            if (!point.N_chord) continue;
            at->chord[d] += point.N_chord[k] * local;
            at->chord_rate[d] += point.N_chord[k] * (v[k * dim + d] - (is_place ? v[d] : 0.0));
        }
}
