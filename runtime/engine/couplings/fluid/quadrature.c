/* Points of quadrature on the elements of a cable in a fluid, and its nodes. */
#include "bodies/model.h"
#include "couplings/fluid/drag.h"

/* Returns a point of quadrature on an element of n shape functions. */
fu_quadrature_point fu_drag_point(const fu_drag *drag, int n, int element, int point)
{
    const long k = (long)(element - drag->first) * drag->stride + point;
    return (fu_quadrature_point){drag->weights[k], drag->N + k * n, drag->N_x + k * n,
                                 fu_drag_on_section(drag) ? drag->N_chord + k * n : 0};
}

int fu_drag_nodes(const fu_drag *drag)
{
    return drag->cable >= 0 ? drag->n_elements + 1 : drag->on.kernel ? drag->on.n_elements + 1 : 0;
}

const double *fu_drag_node(const fu_model *model, const fu_drag *drag, int k, const double *q)
{
    if (drag->cable < 0) return fu_span_node(&drag->on, k, q);
    const fu_cable *cable = &model->cables[drag->cable];
    const int last = k == drag->n_elements; /* the second node of the last element */
    return q + fu_element_entry(cable, drag->first + k - last) + last * cable->per_node;
}
