/* The force of contact at a point, by the kernels of derive/couplings/surface.py: an instant's, its derivatives, a step's. */
#include "engine.h"

#include <math.h>
#include <string.h>

/* Numbers of the law at a depth. */
typedef struct {
    double p, by_depth, by_rate, elastic, energy, mean;
} pressing;

static pressing press_at(const fu_contact *contact, double depth, double rate, double depth_next)
{
    pressing of;
    const double law[2] = {contact->law.stiffness, contact->law.damping};
    const fu_surface_kernels *kernel = contact->surface.kernel;
    (contact->law.hertz ? kernel->push_hertz : kernel->push)(depth, rate, law, depth_next, &of.p, &of.by_depth, &of.by_rate,
                                                             &of.elastic, &of.energy, &of.mean);
    if (of.p < 0.0) of.p = of.by_depth = of.by_rate = 0.0; /* damping never pulls */
    return of;
}

double fu_contact_press(const fu_contact *contact, double depth, double rate)
{
    return depth > 0.0 ? press_at(contact, depth, rate, depth).p : 0.0;
}

/* Makes the stretch of friction's spring as it is without sliding, along the ground's axes. */
static void without_sliding(int dim, const fu_contact *contact, const fu_attachment_state *on, const fu_touch_point *point, double *x)
{
    double own[3] = {0.0}, normal[3] = {0.0}, roll[3] = {0.0};
    if (fu_contact_rolls(contact)) {
        fu_surface_into(dim, on, point->distance.n, normal);
        fu_contact_roll(dim, contact, point->turn, normal, point->mark, roll);
    }
    for (int d = 0; d < dim; ++d) own[d] = point->mark->stretch[d] + point->distance.y[d] - point->mark->place[d] + roll[d];
    fu_surface_out(dim, on, own, x);
}

/* Makes the stretch of friction's spring, by how it is without sliding: no longer than what presses allows. */
static void map_stretch(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, fu_touch_point *point)
{
    const int dim = model->dim;
    const double *n = point->distance.n, most = contact->law.friction * point->press;
    double x[3];
    without_sliding(dim, contact, on, point, x);
    const double along = fu_dot(dim, n, x) / fu_dot(dim, n, n);
    for (int d = 0; d < dim; ++d) x[d] -= along * n[d];
    point->slides = fu_limit_stretch(dim, contact->law.tangential, most, x);
    for (int d = 0; d < dim; ++d) {
        point->friction[d] = -contact->law.tangential * x[d];
        point->f[d] += point->friction[d];
    }
    point->energy += 0.5 * contact->law.tangential * fu_dot(dim, x, x);
    fu_surface_into(dim, on, x, point->stretch);
}

/* Makes how a point touches, but for derivatives; returns whether it does. */
int fu_contact_touches(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, fu_touch_point *point)
{
    const int dim = model->dim;
    double w[3];
    fu_surface_distance(dim, &contact->surface, on, point->r, &point->distance);
    point->depth = contact->radius - point->distance.g;
    if (!(point->depth > 0.0)) return 0;
    fu_surface_past(dim, on, point->r, point->v, w);
    const double rate = -fu_dot(dim, point->distance.n, w);
    const pressing of = press_at(contact, point->depth, rate, point->depth);
    point->press = of.p;
    point->energy = of.energy;
    point->power = (of.p - of.elastic) * rate;
    memset(point->friction, 0, sizeof point->friction);
    memset(point->f, 0, sizeof point->f);
    for (int d = 0; d < dim; ++d) point->f[d] = of.p * point->distance.n[d];
    if (!point->mark) return 1;
    for (int d = 0; d < dim && fu_contact_rolls(contact); ++d) point->arm[d] = -contact->radius * point->distance.n[d];
    map_stretch(model, contact, on, point);
    return 1;
}

/* Makes the derivatives of the force on a point that touches. */
void fu_contact_derivatives(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, fu_touch_point *point)
{
    const int dim = model->dim;
    const fu_surface_kernels *kernel = contact->surface.kernel;
    const fu_distance *at = &point->distance;
    double w[3], x[3], f[3], t[3], by_place[9], by_rate[9];
    fu_surface_past(dim, on, point->r, point->v, w);
    const pressing of = press_at(contact, point->depth, -fu_dot(dim, at->n, w), point->depth);
    const double law[3] = {of.p, of.by_depth, of.by_rate};
    kernel->pressing(at->n, at->H, w, law, f, point->by_place, point->by_rate);
    memset(point->by_stretch, 0, sizeof point->by_stretch);
    if (!point->mark || of.p == 0.0) return;
    without_sliding(dim, contact, on, point, x);
    memset(by_rate, 0, sizeof by_rate);
    if (point->slides) kernel->sliding(at->n, at->H, w, law, x, contact->law.friction, f, by_place, by_rate, point->by_stretch);
    else kernel->sticking(at->n, at->H, x, contact->law.tangential, f, by_place, t, point->by_stretch);
    for (int i = 0; i < dim * dim; ++i) {
        point->by_place[i] += by_place[i];
        point->by_rate[i] += by_rate[i];
    }
}

/* Makes friction over a step: that of the mean stretch, which at the end is as what presses allows. */
static void step_friction(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, double press,
                          const fu_touch_point *now, const fu_touch_point *next, double f[3], double by_stretch[9])
{
    const int dim = model->dim;
    fu_touch_point end = *next, begin = *now;
    end.mark = begin.mark = now->mark;
    end.press = press;
    begin.press = INFINITY; /* what is carried into the step is as long as it may be */
    memset(end.f, 0, sizeof end.f);
    memset(begin.f, 0, sizeof begin.f);
    if (now->depth > 0.0) map_stretch(model, contact, on, &begin);
    map_stretch(model, contact, on, &end);
    for (int d = 0; d < dim; ++d) f[d] = 0.5 * (begin.f[d] + end.f[d]);
    if (!end.slides)
        for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
                by_stretch[d * dim + e] = -0.5 * contact->law.tangential * ((d == e) - end.distance.n[d] * end.distance.n[e]);
}

/* Makes the normal force and friction over a step of h, s, between two places of a point in axes where the surface stays, and what they
 * do by the place, and by the stretch alone, at the end: of the normal force's elastic part a discrete gradient (Gonzalez 1996). Returns
 * the energy that its damping takes, J. */
double fu_contact_step(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, double h,
                       const fu_touch_point *now, const fu_touch_point *next, double f[3], double friction[3], double by_next[9],
                       double by_stretch[9])
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
    const pressing of = press_at(contact, from, rate, to), end = press_at(contact, to, 0.0, to);
    const double elastic = part * of.mean, press = fmax(0.0, elastic * (1.0 + contact->law.damping * rate));
    /* of the end's depth: (U' - mean)/change, which is half of the stiffness where the law is linear */
    const double stiffness = from > 0.0 && contact->law.hertz == 0 && to > 0.0 ? 0.5 * end.by_depth
                             : fabs(sunk) > 1e-9 * fmax(from, to) ? (end.elastic - elastic) / sunk : 0.5 * end.by_depth;
    const double by_depth = press > 0.0 ? stiffness * (1.0 + contact->law.damping * rate) + elastic * contact->law.damping / h : 0.0;
    for (int d = 0; d < dim; ++d) {
        f[d] = press * n[d];
        for (int e = 0; e < dim; ++e) by_next[d * dim + e] = 0.5 * press * at.H[d * dim + e] - by_depth * n[d] * next->distance.n[e];
    }
    if (!now->mark || !(press > 0.0)) return (press - elastic) * sunk;
    step_friction(model, contact, on, press, now, next, friction, by_stretch);
    for (int i = 0; i < dim * dim; ++i) by_next[i] += by_stretch[i];
    return (press - elastic) * sunk;
}
