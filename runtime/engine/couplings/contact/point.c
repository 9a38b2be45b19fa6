/* The force of contact at a point, by the kernels of derive/couplings/surface.py: at an instant, its derivatives, over
 * a step. */
#include "bodies/model.h"
#include "couplings/contact/contact.h"

#include <math.h>
#include <string.h>

void fu_contact_slip(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                     fu_contact_point *point)
{
    const int dim = model->dim;
    double *const w = point->past, normal[3], turned[3], arm[3] = {0.0}, turning[3] = {0.0};
    fu_surface_distance(dim, &contact->surface, on, point->r, &point->distance);
    fu_surface_past(dim, on, point->r, point->v, w);
    point->depth = contact->radius - point->distance.g;
    point->sinking = -fu_dot(dim, point->distance.n, w);
    if (!point->mark) return;
    for (int d = 0; d < dim; ++d) turned[d] = fu_dot(dim, point->distance.H + d * dim, w);
    fu_surface_into(dim, on, w, point->slip);
    fu_surface_into(dim, on, turned, point->normal_rate);
    fu_surface_into(dim, on, point->distance.n, normal);
    for (int d = 0; d < dim; ++d) point->slip[d] += point->sinking / fu_dot(dim, normal, normal) * normal[d];
    if (!fu_contact_rolls(contact)) return;
    for (int d = 0; d < dim; ++d) {
        arm[d] = -contact->radius * normal[d];
        point->arm[d] = -contact->radius * point->distance.n[d];
    }
    fu_cross(point->spin, arm, turning);
    for (int d = 0; d < dim; ++d) point->slip[d] += turning[d];
}

void fu_contact_note(int dim, const fu_attachment_state *on, const fu_contact_point *point, fu_friction_mark *mark)
{
    memset(mark, 0, sizeof *mark);
    memcpy(mark->place, point->distance.y, sizeof(double) * (size_t)dim);
    memcpy(mark->rate, point->slip, sizeof(double) * (size_t)dim);
    memcpy(mark->normal_rate, point->normal_rate, sizeof(double) * (size_t)dim);
    fu_surface_into(dim, on, point->distance.n, mark->normal);
    mark->gap = -point->depth;
    mark->gap_rate = -point->sinking;
}

/* Computes the contact of a point without derivatives; returns whether there is one. */
int fu_contact_is_active(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                         fu_contact_point *point)
{
    fu_contact_slip(model, contact, on, point);
    if (!(point->depth > 0.0)) return 0;
    fu_contact_press(model, contact, on, point);
    return 1;
}

void fu_contact_press(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                      fu_contact_point *point)
{
    const fu_normal_force of = fu_normal_force_at(contact, point->depth, point->sinking, point->depth);
    point->normal_force = of.p;
    point->energy = of.energy;
    point->spring_energy = 0.0;
    point->power = (of.p - of.elastic) * point->sinking;
    memset(point->friction, 0, sizeof point->friction);
    memset(point->f, 0, sizeof point->f);
    for (int d = 0; d < model->dim; ++d) point->f[d] = of.p * point->distance.n[d];
    if (point->mark) fu_contact_stretch(model, contact, on, point);
}

/* Computes the derivatives of the force on a point in contact. */
void fu_contact_derivatives(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                            fu_contact_point *point)
{
    const fu_surface_kernels *kernel = contact->surface.kernel;
    const fu_distance *at = &point->distance;
    const fu_normal_force of = fu_normal_force_at(contact, point->depth, point->sinking, point->depth);
    const double law[3] = {of.p, of.by_depth, of.by_rate};
    double f[3];
    kernel->frictionless(at->n, at->H, point->past, law, f, point->by_place, point->by_rate);
    memset(point->by_stretch, 0, sizeof point->by_stretch);
    if (point->mark && of.p > 0.0) fu_contact_friction_derivatives(model, contact, on, point);
}

/* Computes friction over a step: that of the mean stretch, limited at the end by the normal force; by_depth: derivative
 * of that by the penetration. */
static void step_friction(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                          double normal_force, double by_depth, const fu_contact_point *now,
                          const fu_contact_point *next, double f[3], double by_next[9], double by_stretch[9])
{
    const int dim = model->dim;
    fu_contact_point end = *next, begin = *now;
    end.mark = begin.mark = now->mark;
    end.normal_force = normal_force;
    begin.normal_force = INFINITY; /* the initial stretch is not limited */
    end.since = begin.since = 0.0;
    memset(end.f, 0, sizeof end.f);
    memset(begin.f, 0, sizeof begin.f);
    if (now->depth > 0.0) fu_contact_stretch(model, contact, on, &begin);
    fu_contact_stretch(model, contact, on, &end);
    for (int d = 0; d < dim; ++d) f[d] = 0.5 * (begin.f[d] + end.f[d]);
    const double part =
        now->mark->gap > 0.0 ? next->depth / (next->depth + now->mark->gap) : 1.0; /* of the path, in contact */
    const fu_distance *at = &end.distance;
    const double none[3] = {0.0}, law[3] = {normal_force, by_depth, 0.0};
    double local[3], x[3], of_end[3], by_place[9], by_rate[9];
    if (!end.slides)
        for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
                by_place[d * dim + e] = by_stretch[d * dim + e] =
                    contact->law.tangential * (at->n[d] * at->n[e] - (d == e));
    else if (normal_force > 0.0) {
        fu_friction_path path;
        fu_contact_path(model, contact, on, &end, &path, local);
        for (int d = 0; d < dim; ++d) local[d] *= path.stretch.value[1];
        fu_surface_out(dim, on, local, x);
        contact->surface.kernel->sliding(at->n, at->H, none, law, x, contact->law.friction, of_end, by_place, by_rate,
                                         by_stretch);
    } else memset(by_place, 0, sizeof by_place);
    for (int i = 0; i < dim * dim; ++i) {
        by_stretch[i] *= 0.5 * part;
        by_next[i] += end.slides ? 0.5 * by_place[i] : by_stretch[i];
    }
}

/* Computes the normal force and friction over a step of h, s, between two positions of a point in axes in which the
 * surface does not move, and their derivatives by the position, and by the stretch alone, at the end: for the elastic
 * normal force a discrete gradient (Gonzalez 1996). Returns the dissipation of its damping, J. */
double fu_contact_step(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, double h,
                       const fu_contact_point *now, const fu_contact_point *next, double f[3], double friction[3],
                       double by_next[9], double by_stretch[9])
{
    const int dim = model->dim;
    const double from = fmax(now->depth, 0.0), to = fmax(next->depth, 0.0), sunk = next->depth - now->depth;
    double n[3];
    fu_distance at;
    memset(f, 0, sizeof(double[3]));
    memset(friction, 0, sizeof(double[3]));
    memset(by_next, 0, sizeof(double[9]));
    memset(by_stretch, 0, sizeof(double[9]));
    if (from == 0.0 && to == 0.0) return 0.0;
    fu_surface_step_normal(dim, &contact->surface, on, now->r, next->r, -sunk, &at, n);
    const double part = from > 0.0 && to > 0.0 ? 1.0 : (to - from) / sunk, rate = sunk / h;
    const fu_normal_force of = fu_normal_force_at(contact, from, rate, to),
                          end = fu_normal_force_at(contact, to, 0.0, to);
    const double elastic = part * of.mean, normal_force = fmax(0.0, elastic * (1.0 + contact->law.damping * rate));
    /* of the penetration at the end: (U' - mean)/change, half of the stiffness of a linear law */
    const double stiffness = from > 0.0 && contact->law.hertz == 0 && to > 0.0 ? 0.5 * end.by_depth
                             : fabs(sunk) > 1e-9 * fmax(from, to)              ? (end.elastic - elastic) / sunk
                                                                               : 0.5 * end.by_depth;
    const double by_depth =
        normal_force > 0.0 ? stiffness * (1.0 + contact->law.damping * rate) + elastic * contact->law.damping / h : 0.0;
    for (int d = 0; d < dim; ++d) {
        f[d] = normal_force * n[d];
        for (int e = 0; e < dim; ++e)
            by_next[d * dim + e] = 0.5 * normal_force * at.H[d * dim + e] - by_depth * n[d] * next->distance.n[e];
    }
    if (!now->mark || !(normal_force > 0.0)) return (normal_force - elastic) * sunk;
    /* the bound at the end, with the rate there by that at the beginning: the mean over the step would lag by half of
     * it */
    const fu_normal_force last = fu_normal_force_at(contact, to, 2.0 * rate + now->mark->gap_rate, to);
    step_friction(model, contact, on, to > 0.0 ? last.p : 0.0, to > 0.0 ? last.by_depth + 2.0 * last.by_rate / h : 0.0,
                  now, next, friction, by_next, by_stretch);
    return (normal_force - elastic) * sunk;
}
