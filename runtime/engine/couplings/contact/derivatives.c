/* Derivatives of contact by the unknowns of a point and of the body that the surface is on: of the force on the point,
 * and of the reaction with its moment on that body, by the kernel `reaction` (derive/couplings/surface.py).
 */
#include "bodies/model.h"
#include "couplings/common/attachments.h"
#include "couplings/contact/contact.h"

#include <string.h>

/* Arguments of `reaction` for a point: position and velocity relative to the surface, the rotation since the last step
 * in global axes, the mean of the arms now and then, and the share of the arm in it. */
typedef struct {
    double x[3], w[3], radius, turn[3], mean_arm[3], share;
} rolling_point;

static void rolling_of(int dim, const fu_contact *contact, const fu_attachment_state *on, const fu_contact_point *point,
                       rolling_point *out)
{
    memset(out, 0, sizeof *out);
    for (int d = 0; d < dim; ++d) out->x[d] = point->r[d] - on->p[d];
    fu_surface_past(dim, on, point->r, point->v, out->w);
    if (!fu_contact_rolls(contact)) return;
    const double *last = point->mark->normal;
    const int is_first = !(fu_dot(dim, last, last) > 0.0);
    double normal[3];
    fu_surface_out(dim, on, last, normal);
    out->radius = contact->radius;
    out->share = is_first ? 1.0 : 0.5;
    for (int d = 0; d < dim; ++d)
        out->mean_arm[d] = is_first ? point->arm[d] : 0.5 * (point->arm[d] - contact->radius * normal[d]);
    if (dim == 3) fu_surface_out(dim, on, point->turn, out->turn);
    else out->turn[0] = point->turn[2];
}

/* Computes the changes by the unknowns of the point or, if is_surface is nonzero, of the surface. */
static void changes_by(int dim, const fu_contact *contact, const fu_attachment_state *on, const fu_contact_point *point,
                       const rolling_point *rolling, const fu_point_motion *of, int is_surface, fu_contact_changes *out)
{
    const int n = of->at.n, turns = of->rows > 2 * dim ? fu_turns(dim) : 0;
    for (int i = 0; i < n; ++i) {
        /* position, velocity, rotation of the point; rotation and angular velocity of the surface */
        double by[5][3] = {{0.0}}, force[3], near[3], far[3];
        const double sign = is_surface ? -1.0 : 1.0;
        for (int d = 0; d < dim; ++d) {
            by[0][d] = sign * of->by[d * n + i];
            by[1][d] = sign * of->by[(dim + d) * n + i];
        }
        for (int k = 0; k < turns; ++k) {
            by[is_surface ? 3 : 2][k] = of->by[(2 * dim + k) * n + i];
            if (is_surface) by[4][k] = of->by[(2 * dim + turns + k) * n + i];
        }
        contact->surface.kernel->reaction(rolling->x, rolling->w, on->omega, point->f, point->by_place, point->by_rate,
                                          point->by_stretch, point->distance.H, rolling->radius, point->arm,
                                          rolling->turn, rolling->mean_arm, rolling->share, by[0], by[1], by[2], by[3],
                                          by[4], force, near, far);
        for (int d = 0; d < dim; ++d) out->force[d * n + i] = force[d];
        for (int k = 0; k < fu_turns(dim); ++k) {
            out->near[k * n + i] = near[k];
            out->far[k * n + i] = far[k];
        }
    }
}

void fu_contact_changes_by(int dim, const fu_contact *contact, const fu_attachment_state *on,
                           const fu_contact_point *point, const fu_point_motion *of, int is_surface,
                           fu_contact_changes *out)
{
    rolling_point rolling;
    rolling_of(dim, contact, on, point, &rolling);
    changes_by(dim, contact, on, point, &rolling, of, is_surface, out);
}

void fu_contact_add_derivatives(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                                const fu_state *state, int element, int number, const fu_contact_point *point,
                                const double *psi, fu_weights weights, fu_system *system)
{
    const int dim = model->dim, rolls = fu_contact_rolls(contact);
    const double scale = weights.stiffness * fu_contact_weight(contact, element, number), *f = point->f;
    double lever[3], moment[3];
    rolling_point rolling;
    fu_point_motion a, b;
    fu_contact_changes by_a, by_b;
    rolling_of(dim, contact, on, point, &rolling);
    if (contact->cable >= 0) {
        const int n = model->cables[contact->cable].coordinates;
        fu_element_motion(model, fu_contact_first(model, contact, element), n,
                          fu_contact_shapes(contact, n / dim, element, number), weights.rate, &a);
    } else {
        fu_moment_of(dim, point->arm, f, moment);
        fu_point_motion_at(model, &contact->attachments[number], state, rolls ? FU_POINT | FU_AXES : FU_POINT, f,
                           rolls ? moment : 0, psi, weights.rate, &a);
    }
    changes_by(dim, contact, on, point, &rolling, &a, 0, &by_a);
    fu_add_wrench_tangent(model, &a.at, &a.at, by_a.force, rolls ? by_a.near : 0, fu_stiffness_of(&a), -scale, system);
    if (!on->n) return;
    for (int d = 0; d < dim; ++d) lever[d] = rolling.x[d] + point->arm[d];
    fu_moment_of(dim, lever, f, moment);
    fu_point_motion_at(model, contact->surface.on, state, FU_POINT | FU_AXES, f, moment, psi, weights.rate, &b);
    changes_by(dim, contact, on, point, &rolling, &b, 1, &by_b);
    fu_add_wrench_tangent(model, &a.at, &b.at, by_b.force, rolls ? by_b.near : 0, 0, -scale, system);
    fu_add_wrench_tangent(model, &b.at, &a.at, by_a.force, by_a.far, 0, scale, system);
    fu_add_wrench_tangent(model, &b.at, &b.at, by_b.force, by_b.far, fu_stiffness_of(&b), scale, system);
}
