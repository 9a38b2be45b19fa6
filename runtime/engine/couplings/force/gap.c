/* The gap between the points of two attachments, and its rate. */
#include "bodies/model.h"
#include "couplings/force/point_force.h"

/* Makes position and velocity of an attachment's point, and how it moves with its coordinates; returns its first dof.
 */
int fu_force_point(const fu_model *model, const fu_attachment *on, const double *q, const double *v,
                   fu_attachment_state *at)
{
    const fu_state state = {.q = (double *)q, .v = (double *)v};
    fu_attachment_at(model, on, &state, 0.0, FU_POINT, at);
    return at->n ? at->at[0] : 0;
}

/* Makes the gap between the points, and its rate. */
void fu_gap(const fu_model *model, const fu_point_force *between, const double *q, const double *v, double gap[3],
            double rate[3])
{
    fu_attachment_state at[2];
    for (int e = 0; e < 2; ++e) fu_force_point(model, &between->attachments[e], q, v, &at[e]);
    for (int d = 0; d < 3; ++d) {
        gap[d] = at[1].p[d] - at[0].p[d];
        rate[d] = at[1].v[d] - at[0].v[d];
    }
}
