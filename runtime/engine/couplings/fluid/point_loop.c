/* The loop over all points of quadrature of a cable in a fluid. */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/fluid/drag.h"

#include <string.h>

void fu_drag_visit(const fu_model *model, const fu_drag *drag, const double *q, const double *v, const double *a,
                   fu_drag_visitor *visit, fu_drag_loop *loop, fu_system *system)
{
    const fu_cable *cable = &model->cables[drag->cable];
    const int all = cable->coordinates;
    double K[FU_MAX_COORDINATES * FU_MAX_COORDINATES];
    for (int e = 0; e < cable->n_elements; ++e) {
        fu_drag_points points;
        fu_drag_site site = {.element = e, .first = cable->first + e * cable->per_node};
        fu_drag_motion motion;
        fu_drag_points_on(model, drag, e, q + site.first, &points);
        fu_drag_motion_of(cable, q + site.first, v + site.first, a ? a + site.first : 0, &motion);
        if (loop->has_matrix) memset(K, 0, sizeof(double) * (size_t)(all * all));
        for (int g = 0; g < points.n; ++g) {
            site.part = points.part[g];
            site.x = points.x[g];
            site.point = points.at[g];
            fu_drag_place_on_axis(&motion, &site.point, &site.at);
            visit(model, drag, &site, loop, K);
        }
        if (loop->has_matrix) fu_add_element_matrix(model, site.first, all, K, system);
    }
}
