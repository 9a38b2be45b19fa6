/* Contact over a step, for the integrator that balances energy: residuals, their derivatives, and dissipation.
 *
 * On a moving body the step is evaluated along the shape's local axes, with the position y = A'(r - p) of a point. The
 * work of the force there, along y_next - y, is -(U_next - U). As y is bilinear in A and r - p, its change is, with
 * means over the step, mean(A)'(change of r - p) + (change of A)' mean(r - p): so mean(A) times the force acts on
 * the point, and its opposite on the body at the lever mean(r - p). Both have one line of action, and conserve
 * momentum and angular momentum as they conserve energy. */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/attachments.h"
#include "couplings/contact/contact.h"

#include <string.h>

static const fu_contact *of(const fu_coupling *coupling)
{
    return (const fu_contact *)coupling;
}

/* A surface over a step: at both ends, its mean p and A, and the frame of the points: the ground's axes if it does not
 * move, else the shape's local. */
typedef struct {
    int moves;
    fu_attachment_state ends[2], mean, frame;
} surface_step;

/* A point over a step: at both ends in the surface's frame, and its mean position in the ground's axes. If its sphere
 * rolls: the same of the body's particle at the mean point of contact, and the attachment to it. */
typedef struct {
    fu_contact_point now, next;
    double middle[3], from[3], to[3], at_contact[3];
    fu_attachment particle;
} point_step;

static void surface_over_step(const fu_model *model, const fu_contact *contact, const fu_equations *at,
                              surface_step *out)
{
    const int dim = model->dim;
    fu_attachment_state *const ends = out->ends;
    fu_surface_at(model, &contact->surface, at->now, &ends[0]);
    fu_surface_at(model, &contact->surface, at->next, &ends[1]);
    out->moves = ends[0].n > 0;
    if (!out->moves) {
        out->frame = ends[0];
        return;
    }
    memset(&out->frame, 0, sizeof out->frame);
    memset(&out->mean, 0, sizeof out->mean);
    for (int d = 0; d < dim; ++d) {
        out->frame.A[d * dim + d] = 1.0;
        out->mean.p[d] = 0.5 * (ends[0].p[d] + ends[1].p[d]);
    }
    for (int i = 0; i < dim * dim; ++i) out->mean.A[i] = 0.5 * (ends[0].A[i] + ends[1].A[i]);
}

/* Returns whether any point of an element may be in contact at an end of the step. */
static int may_be_in_contact(const fu_model *model, const fu_contact *contact, const surface_step *on,
                             const fu_equations *at, int element)
{
    return fu_contact_may_be_active(model, contact, &on->ends[0], at->now, element, 0.0) ||
           fu_contact_may_be_active(model, contact, &on->ends[1], at->next, element, 0.0);
}

/* Computes the position of a point at an end of a step along the axes of the shape; forces of the step do not depend on
 * its velocity there. */
static void place_along_shape(int dim, const fu_attachment_state *end, fu_contact_point *point)
{
    double from[3] = {0.0};
    for (int d = 0; d < dim; ++d) from[d] = point->r[d] - end->p[d];
    memset(point->r, 0, sizeof point->r);
    memset(point->v, 0, sizeof point->v);
    fu_surface_into(dim, end, from, point->r);
}

/* Computes the body's particle at the mean point of contact of its sphere in the step, and the arm to it, along the
 * ground's axes. */
static void particle_over_step(const fu_model *model, const fu_contact *contact, const surface_step *on,
                               const fu_equations *at, int number, point_step *out)
{
    const int dim = model->dim;
    const fu_state *states[2] = {at->now, at->next};
    const fu_contact_point *points[2] = {&out->now, &out->next};
    fu_contact_point ends[2];
    fu_attachment_state body;
    double u[3] = {0.0};
    out->particle = contact->attachments[number];
    for (int e = 0; e < 2; ++e) {
        double arm[3] = {0.0}, local[3];
        for (int d = 0; d < dim; ++d) local[d] = -contact->radius * points[e]->distance.n[d];
        if (on->moves) fu_surface_out(dim, &on->ends[e], local, arm);
        else memcpy(arm, local, sizeof arm);
        fu_attachment_at(model, &contact->attachments[number], states[e], 0.0, FU_AXES, &body);
        fu_surface_into(dim, &body, arm, local);
        for (int d = 0; d < dim; ++d) u[d] += 0.5 * local[d];
    }
    for (int d = 0; d < dim; ++d) out->particle.u[d] += fu_dot(dim, out->particle.axes + d * dim, u);
    for (int e = 0; e < 2; ++e) {
        fu_attachment_at(model, &out->particle, states[e], 0.0, FU_POINT, &body);
        memcpy(ends[e].r, body.p, sizeof body.p);
        for (int d = 0; d < dim; ++d) out->at_contact[d] += 0.5 * body.p[d];
        if (on->moves) place_along_shape(dim, &on->ends[e], &ends[e]);
    }
    memcpy(out->from, ends[0].r, sizeof out->from);
    memcpy(out->to, ends[1].r, sizeof out->to);
}

/* Computes a point over a step; returns whether it may be in contact in it. */
static int point_over_step(const fu_model *model, const fu_contact *contact, const surface_step *on,
                           const fu_equations *at, int element, int number, point_step *out)
{
    fu_contact_place(model, contact, &on->ends[0], at->now, element, number, &out->now);
    fu_contact_place(model, contact, &on->ends[1], at->next, element, number, &out->next);
    for (int d = 0; d < 3; ++d) out->middle[d] = 0.5 * (out->now.r[d] + out->next.r[d]);
    if (on->moves) {
        place_along_shape(model->dim, &on->ends[0], &out->now);
        place_along_shape(model->dim, &on->ends[1], &out->next);
    }
    const int was_active = fu_contact_is_active(model, contact, &on->frame, &out->now);
    const int in_contact = fu_contact_is_active(model, contact, &on->frame, &out->next) || was_active;
    memset(out->at_contact, 0, sizeof out->at_contact);
    if (in_contact && fu_contact_rolls(contact)) particle_over_step(model, contact, on, at, number, out);
    return in_contact;
}

/* Converts the derivative of a force by the position along the shape's axes to that by the position along the
 * ground's. */
static void turn_derivative(int dim, const fu_attachment_state *mean, double *by_place)
{
    double half[9];
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) half[i * dim + j] = fu_dot(dim, by_place + i * dim, mean->A + j * dim);
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) {
            by_place[i * dim + j] = 0.0;
            for (int k = 0; k < dim; ++k) by_place[i * dim + j] += mean->A[i * dim + k] * half[k * dim + j];
        }
}

/* Adds the reaction of a force over a step on the body of the surface: at its point u, with mean(A of the body) u the
 * lever. */
static void add_reaction(const fu_model *model, const fu_contact *contact, const surface_step *on,
                         const fu_equations *at, const double *middle, const double *force, double weight, double *f)
{
    const int dim = model->dim;
    fu_attachment there = contact->surface.on[0];
    fu_attachment_state end = on->ends[0];
    double lever[3], columns[9];
    int pivot[3];
    for (int i = 0; i < dim; ++i) {
        lever[i] = middle[i] - on->mean.p[i];
        for (int j = 0; j < dim; ++j) columns[j * dim + i] = on->mean.A[i * dim + j];
    }
    /* a rotation by pi in a step, which no Cayley vector represents */
    if (fu_small_factor(dim, columns, pivot)) return;
    fu_small_solve(dim, columns, pivot, lever);
    for (int i = 0; i < dim; ++i) there.u[i] += fu_dot(dim, there.axes + i * dim, lever);
    fu_discrete_point(model, &there, at->now, at->next, end.P);
    fu_add_wrench(dim, &end, force, 0, weight, f);
}

/* Adds a force over a step on a point, `to` of a body, and its reaction, to the left side of the equations. */
static void add_step_force(const fu_model *model, const fu_contact *contact, const surface_step *on,
                           const fu_equations *at, int element, int number, const fu_attachment *to,
                           const double *middle, const double *local, double *f)
{
    const int dim = model->dim;
    const double weight = fu_contact_weight(contact, element, number);
    double force[3] = {local[0], local[1], dim == 3 ? local[2] : 0.0};
    if (on->moves) {
        fu_surface_out(dim, &on->mean, local, force);
        add_reaction(model, contact, on, at, middle, force, weight, f);
    }
    if (contact->cable >= 0) {
        fu_contact_add_on_cable(model, contact, element, number, force, f);
        return;
    }
    fu_attachment_state end;
    fu_attachment_at(model, to, at->now, 0.0, FU_PLACE, &end);
    fu_discrete_point(model, to, at->now, at->next, end.P);
    fu_add_wrench(dim, &end, force, 0, -weight, f);
}

/* The force of a step, as that of an instant; returns the dissipation in it and the energy that the contact stores, J.
 * f may be null. */
static double over_step(const fu_model *model, const fu_contact *contact, const fu_equations *at, double *f)
{
    const int dim = model->dim, rolls = fu_contact_rolls(contact);
    double lost = 0.0;
    surface_step on;
    surface_over_step(model, contact, at, &on);
    for (int e = 0; e < fu_contact_elements(contact); ++e) {
        if (!may_be_in_contact(model, contact, &on, at, e)) continue;
        for (int k = 0; k < contact->n_points; ++k) {
            point_step point;
            double force[3], friction[3], unused[2][9];
            if (!point_over_step(model, contact, &on, at, e, k, &point)) continue;
            fu_contact_step(model, contact, &on.frame, at->h, &point.now, &point.next, force, friction, unused[0],
                            unused[1]);
            const double weight = fu_contact_weight(contact, e, k);
            for (int d = 0; d < dim; ++d) {
                if (rolls) lost -= weight * friction[d] * (point.to[d] - point.from[d]);
                else force[d] += friction[d];
                lost -= weight * force[d] * (point.next.r[d] - point.now.r[d]);
            }
            if (f) add_step_force(model, contact, &on, at, e, k, &contact->attachments[k], point.middle, force, f);
            if (f && rolls)
                add_step_force(model, contact, &on, at, e, k, &point.particle, point.at_contact, friction, f);
        }
    }
    return lost;
}

void fu_contact_step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                              double *internal)
{
    (void)internal;
    over_step(model, of(coupling), at, f);
}

/* Computes force and derivatives of a point over a step, in point->next, along the ground's axes. The middle moves by
 * half of psi, which is in weights.stiffness: terms of the end count twice. */
static void derivatives_over_step(const fu_model *model, const fu_contact *contact, const surface_step *on, double h,
                                  point_step *point)
{
    const int dim = model->dim;
    fu_contact_point *next = &point->next;
    double force[3], friction[3];
    fu_contact_step(model, contact, &on->frame, h, &point->now, next, force, friction, next->by_place,
                    next->by_stretch);
    for (int i = 0; i < dim * dim; ++i) {
        next->by_place[i] *= 2.0;
        next->by_stretch[i] *= 2.0;
    }
    for (int d = 0; d < dim; ++d) force[d] += friction[d];
    memset(next->by_rate, 0, sizeof next->by_rate);
    memcpy(next->f, force, sizeof next->f);
    if (!on->moves) return;
    fu_surface_out(dim, &on->mean, force, next->f);
    turn_derivative(dim, &on->mean, next->by_place);
    turn_derivative(dim, &on->mean, next->by_stretch);
    turn_derivative(dim, &on->mean, next->distance.H);
}

/* The rotation of bodies in the step is that at its middle. */
void fu_contact_step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at,
                             fu_system *system)
{
    const fu_contact *contact = of(coupling);
    const int dim = model->dim;
    double K[FU_MAX_COORDINATES * FU_MAX_COORDINATES];
    surface_step on;
    fu_attachment_state on_middle;
    surface_over_step(model, contact, at, &on);
    fu_surface_at(model, &contact->surface, at->middle, &on_middle);
    for (int e = 0; e < fu_contact_elements(contact); ++e) {
        int in_contact = 0;
        if (!may_be_in_contact(model, contact, &on, at, e)) continue;
        const int n = contact->cable >= 0 ? model->cables[contact->cable].coordinates : 0;
        for (int k = 0; k < contact->n_points; ++k) {
            point_step point;
            fu_contact_point *next = &point.next;
            if (!point_over_step(model, contact, &on, at, e, k, &point)) continue;
            derivatives_over_step(model, contact, &on, at->h, &point);
            if (on.moves || !n) {
                memcpy(next->r, point.middle, sizeof next->r);
                for (int d = 0; d < dim && fu_contact_rolls(contact); ++d)
                    next->arm[d] = point.at_contact[d] - point.middle[d];
                fu_contact_add_derivatives(model, contact, &on_middle, at->middle, e, k, next, 0, at->weights, system);
                continue;
            }
            if (!in_contact++) memset(K, 0, sizeof(double) * (size_t)(n * n));
            const double *N = fu_contact_shapes(contact, n / dim, e, k);
            fu_add_element_product(dim, n, -at->weights.stiffness * fu_contact_weight(contact, e, k), N, N,
                                   next->by_place, K);
        }
        if (in_contact) fu_add_element_matrix(model, fu_contact_first(model, contact, e), n, K, system);
    }
}

/* The dissipation without that of fu_contact_lost. */
double fu_contact_step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at)
{
    const double stored = fu_contact_energy(model, coupling, at->next) - fu_contact_energy(model, coupling, at->now);
    return over_step(model, of(coupling), at, 0) - stored - fu_contact_lost(model, coupling, at->now, at->next, 1);
}
