/* Spheres of a body that roll on a surface: friction acts at their points of contact, off their centres, and
 * rotation stretches it too.
 *
 * For a sphere of the radius R in contact along the normal n, the point of contact is at a = -R n from the centre.
 * Its velocity relative to the surface is that of the centre plus w x a, with the angular velocity w relative to the
 * surface: over a step, with the rotation p, the position changes by p x a in addition to the displacement of the
 * centre, with the mean of the normals at both ends of the step. */
#include "bodies/model.h"
#include "couplings/contact/contact.h"

#include <math.h>
#include <string.h>

int fu_contact_rolls(const fu_contact *contact)
{
    return contact->law.friction > 0.0 && contact->radius > 0.0 && contact->cable < 0 && !fu_contact_on_span(contact);
}

fu_friction_begin *fu_contact_begin_of(const fu_contact *contact, const fu_state *state)
{
    return (fu_friction_begin *)(state->numbers + contact->base.numbers + contact->base.n_numbers) - 1;
}

void fu_contact_axes(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                     const fu_state *state, double axes[9], double spin[3])
{
    const int dim = model->dim;
    double about[3], with[3];
    fu_attachment_state body;
    fu_attachment_at(model, contact->attachments, state, 0.0, FU_AXES, &body);
    memset(axes, 0, sizeof(double[9]));
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
            for (int k = 0; k < dim; ++k) axes[i * dim + j] += on->A[k * dim + i] * body.A[k * dim + j];
    fu_turn_in_space(dim, body.omega, about);
    fu_turn_in_space(dim, on->omega, with);
    for (int d = 0; d < 3; ++d) about[d] -= with[d];
    memcpy(spin, about, sizeof about);
    if (dim == 3) fu_surface_into(dim, on, about, spin);
}

/* Computes the rotation from one set of axes to another, along the axes in which both are given. */
static void turn_between(int dim, const double *from, const double *to, double turn[3])
{
    double R[9];
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) R[i * dim + j] = fu_dot(dim, to + i * dim, from + j * dim);
    turn[0] = turn[1] = turn[2] = 0.0;
    if (dim == 2) {
        turn[2] = atan2(R[2], R[0]);
        return;
    }
    for (int d = 0; d < 3; ++d) {
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        turn[d] = 0.5 * (R[f * 3 + e] - R[e * 3 + f]);
    }
    const double sine = sqrt(fu_dot(3, turn, turn)), angle = atan2(sine, 0.5 * (R[0] + R[4] + R[8] - 1.0));
    for (int d = 0; d < 3 && sine > 0.0; ++d) turn[d] *= angle / sine;
}

void fu_contact_roll(int dim, const fu_contact *contact, const double turn[3], const double *normal,
                     const fu_friction_mark *mark, double out[3])
{
    const double *before = fu_dot(dim, mark->normal, mark->normal) > 0.0 ? mark->normal : normal;
    double arm[3] = {0.0};
    for (int d = 0; d < dim; ++d) arm[d] = -0.5 * contact->radius * (before[d] + normal[d]);
    fu_cross(turn, arm, out);
}

void fu_contact_turning(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                        const fu_state *state, fu_contact_point *point)
{
    double axes[9];
    fu_contact_axes(model, contact, on, state, axes, point->spin);
    turn_between(model->dim, fu_contact_begin_of(contact, state)->axes, axes, point->turn);
}
