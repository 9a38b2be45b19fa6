/* Points of attachments alone: their motion, and a force on one. Most are fixed in an element of a cable, where sums
 * over its vectors suffice. */
#include "bodies/model.h"
#include "bodies/state.h"
#include "couplings/common/attachments.h"

/* Returns the first dof of the element that holds a point; -1 if its motion takes more than shape functions. */
static int element_of(const fu_model *model, const fu_attachment *on)
{
    if (on->cable < 0 || on->slide >= 0 || on->rope || on->body >= 0 || on->node >= 0) return -1;
    const fu_cable *cable = &model->cables[on->cable];
    return fu_element_entry(cable, on->element);
}

void fu_point_at(const fu_model *model, const fu_attachment *on, const fu_state *state, double p[3], double *v,
                 double *a)
{
    const int dim = model->dim, first = element_of(model, on);
    for (int d = 0; d < 3; ++d) p[d] = on->u[d];
    for (int d = 0; d < 3 && v; ++d) v[d] = 0.0;
    for (int d = 0; d < 3 && a; ++d) a[d] = 0.0;
    if (first >= 0) {
        const int n = model->cables[on->cable].coordinates;
        fu_interpolate(dim, n, on->N, state->q + first, p);
        if (v) fu_interpolate(dim, n, on->N, state->v + first, v);
        if (a) fu_interpolate(dim, n, on->N, state->acceleration + first, a);
        return;
    }
    fu_attachment_state at;
    fu_attachment_at(model, on, state, 0.0, v ? FU_POINT : FU_PLACE, &at);
    for (int d = 0; d < 3; ++d) p[d] = at.p[d];
    for (int d = 0; d < 3 && v; ++d) v[d] = at.v[d];
    for (int d = 0; d < dim && a; ++d) {
        a[d] = at.bias[d];
        for (int i = 0; i < at.n; ++i) a[d] += at.P[d * at.n + i] * state->acceleration[at.at[i]];
    }
}

void fu_add_force_at(const fu_model *model, const fu_attachment *on, const fu_state *state, const double *force,
                     double factor, double *f)
{
    const int dim = model->dim, first = element_of(model, on);
    if (first >= 0) {
        for (int k = 0; k < model->cables[on->cable].coordinates / dim; ++k)
            for (int d = 0; d < dim; ++d) f[first + k * dim + d] += factor * (on->N[k] * force[d]);
        return;
    }
    fu_attachment_state at;
    fu_attachment_at(model, on, state, 0.0, FU_PLACE, &at);
    fu_add_wrench(dim, &at, force, 0, factor, f);
}
