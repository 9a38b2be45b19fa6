/* Friction of contact at a point: the stretch of its spring at the end of its path since the mark
 * (couplings/common/stick_friction.c), and its derivatives by position and velocity of the point. */
#include "bodies/model.h"
#include "couplings/contact/contact.h"

#include <math.h>
#include <string.h>

#define DIRECTION_PARTS 8 /* of a step: intervals of the sum of the direction of sliding */

/* The path of a point since its mark, along the shape's axes: by its end, by its beginning; the stretch as without
 * sliding, with its direction; if the time of the path is unknown, as in statics, h is 0. */
typedef struct {
    double normal[3], change[3], begin[3], x[3], along[3], size, from;
    fu_friction_path path;
} friction_course;

static double bound(const void *of, double depth, double rate)
{
    const fu_contact *contact = of;
    return contact->law.friction * fu_normal_force_at(contact, depth, rate, depth).p;
}

fu_friction_path fu_contact_normal_path(const fu_contact *contact, const fu_contact_point *point)
{
    const fu_friction_mark *mark = point->mark;
    fu_friction_path path = {.h = point->since, .stiffness = contact->law.tangential, .bound = bound, .of = contact};
    path.depth = (fu_step_ends){{-mark->gap, point->depth}, {-mark->gap_rate, point->sinking}};
    return path;
}

/* Computes the part of a step after which the point comes into contact, and its displacement until then. */
static void begin_at_contact(int dim, const fu_contact_point *point, friction_course *of, double gone[3])
{
    const fu_friction_mark *mark = point->mark;
    const double h = of->path.h;
    of->from = point->entered;
    if (mark->gap > 0.0) {
        const double part = h > 0.0 ? fu_part_to_rise(&of->path.depth, h) : mark->gap / (mark->gap + point->depth);
        of->from = fmax(of->from, part);
    }
    if (of->from == 0.0) return;
    for (int d = 0; d < dim; ++d) {
        const fu_step_ends ends = {{0.0, of->change[d]}, {mark->rate[d], point->slip[d]}};
        gone[d] = h > 0.0 ? fu_value_within(&ends, h, of->from) : of->from * of->change[d];
    }
}

void fu_contact_change(int dim, const fu_contact *contact, const fu_contact_point *point, const double *normal,
                       double change[3])
{
    const fu_friction_mark *mark = point->mark;
    const double before = fu_dot(dim, mark->normal, mark->normal), now = fu_dot(dim, normal, normal),
                 h = fmax(point->since, 0.0);
    const double sunk = mark->gap + point->depth, rates[2] = {h * mark->gap_rate, -h * point->sinking};
    const double halfway = -1.5 * sunk - 0.25 * (rates[0] + rates[1]);
    double roll[3] = {0.0};
    if (fu_contact_rolls(contact)) fu_contact_roll(dim, contact, point->turn, normal, mark, roll);
    for (int d = 0; d < dim; ++d) change[d] = point->distance.y[d] - mark->place[d] + roll[d];
    if (!(before > 0.0)) return;
    /* the change of the penetration is not along the surface: the integral of the normal times the rate of the gap,
     * both by cubics, by Simpson's rule */
    for (int d = 0; d < dim; ++d) {
        const double n[2] = {mark->normal[d] / before, normal[d] / now},
                     turned = mark->normal_rate[d] / before - point->normal_rate[d] / now;
        const double middle = 0.5 * (n[0] + n[1]) + 0.125 * h * turned;
        change[d] -= h > 0.0 ? (n[0] * rates[0] + 4.0 * middle * halfway + n[1] * rates[1]) / 6.0 : -middle * sunk;
    }
}

/* Rotates a stretch along the surface at the mark to one along it at the end, with the normal, by the smallest
 * rotation. */
static void turn_along(int dim, const fu_friction_mark *mark, const double *normal, double stretch[3])
{
    const double before = sqrt(fu_dot(dim, mark->normal, mark->normal)), now = sqrt(fu_dot(dim, normal, normal));
    memcpy(stretch, mark->stretch, sizeof(double[3]));
    if (!(before > 0.0)) return;
    const double share =
        fu_dot(dim, normal, mark->stretch) / now / (1.0 + fu_dot(dim, normal, mark->normal) / (before * now));
    for (int d = 0; d < dim; ++d) stretch[d] -= share * (mark->normal[d] / before + normal[d] / now);
}

static void path_of(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                    const fu_contact_point *point, friction_course *out)
{
    const int dim = model->dim;
    const fu_friction_mark *mark = point->mark;
    double gone[3] = {0.0}, stretch[3];
    fu_surface_into(dim, on, point->distance.n, out->normal);
    turn_along(dim, mark, out->normal, stretch);
    fu_contact_change(dim, contact, point, out->normal, out->change);
    out->path = fu_contact_normal_path(contact, point);
    begin_at_contact(dim, point, out, gone);
    for (int d = 0; d < dim; ++d) {
        out->begin[d] = out->from > 0.0 ? 0.0 : stretch[d];
        out->x[d] = out->begin[d] + out->change[d] - gone[d];
    }
    const double across = fu_dot(dim, out->normal, out->x) / fu_dot(dim, out->normal, out->normal);
    for (int d = 0; d < dim; ++d) out->along[d] = out->x[d] - across * out->normal[d];
    out->path.from = out->from;
    out->size = fu_path_along(dim, out->change, mark->rate, point->slip, out->along, &out->path);
}

/* Computes the stretch, m, of a spring that slides along the path in equal intervals: in each it is stretched by the
 * velocity at the interval's end, and slides back to the bound. */
static void slide(int dim, const fu_contact_point *point, const friction_course *of, int parts, double out[3])
{
    const double whole = 1.0 - of->from, normal = fu_dot(dim, of->normal, of->normal);
    memcpy(out, of->begin, sizeof of->begin);
    for (int i = 1; i <= parts; ++i) {
        const double x = of->from + whole * i / parts;
        for (int d = 0; d < dim; ++d) {
            const fu_step_ends ends = {{0.0, of->change[d]}, {point->mark->rate[d], point->slip[d]}};
            out[d] += whole / parts * of->path.h * fu_rate_within(&ends, of->path.h, x);
        }
        const double across = fu_dot(dim, of->normal, out) / normal;
        for (int d = 0; d < dim; ++d) out[d] -= across * of->normal[d];
        fu_limit_stretch(dim, of->path.stiffness, fu_bound_within(&of->path, x), out);
    }
}

/* Rotates the stretch of a sliding point, in space. Its direction lags behind the velocity by a path of the stretch's
 * length. The sum over intervals of the step and half as many (Richardson) is accurate; the sum over the step alone
 * would be of the first order. Returns the time of that path, s, 0 without a rotation. */
static double turn_to_slip(int dim, const fu_contact_point *point, int parts, friction_course *of)
{
    const double h = (1.0 - of->from) * of->path.h;
    double fine[3], coarse[3];
    if (dim != 3 || !(h > 0.0) || !point->slides) return 0.0;
    slide(dim, point, of, parts, fine);
    slide(dim, point, of, parts / 2, coarse);
    for (int d = 0; d < dim; ++d) of->along[d] = 2.0 * fine[d] - coarse[d];
    const double size = sqrt(fu_dot(dim, of->along, of->along));
    for (int d = 0; d < dim; ++d) {
        of->x[d] = of->begin[d] + h * point->slip[d];
        if (size > 0.0) of->along[d] /= point->friction_end.stretch < 0.0 ? -size : size;
    }
    const double reach = sqrt(fu_dot(dim, of->x, of->x));
    for (int d = 0; d < dim; ++d) of->x[d] = reach * (point->friction_end.stretch < 0.0 ? -of->along[d] : of->along[d]);
    return h;
}

void fu_contact_path(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                     const fu_contact_point *point, fu_friction_path *path, double along[3])
{
    friction_course of;
    path_of(model, contact, on, point, &of);
    *path = of.path;
    memcpy(along, of.along, sizeof of.along);
}

double fu_contact_turn_error(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                             const fu_contact_point *point)
{
    const int dim = model->dim;
    double square = 0.0;
    friction_course of, other;
    path_of(model, contact, on, point, &of);
    other = of;
    turn_to_slip(dim, point, DIRECTION_PARTS, &of);
    turn_to_slip(dim, point, DIRECTION_PARTS / 2, &other);
    for (int d = 0; d < dim; ++d) square += (of.along[d] - other.along[d]) * (of.along[d] - other.along[d]);
    return sqrt(square) * fabs(point->friction_end.stretch);
}

void fu_contact_stretch(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                        fu_contact_point *point)
{
    const int dim = model->dim;
    const double most = contact->law.friction * point->normal_force / contact->law.tangential;
    double x[3];
    friction_course of;
    path_of(model, contact, on, point, &of);
    point->friction_end = fu_end_of_friction(&of.path, most);
    point->friction_end.slid |= !(of.path.h > 0.0) && most == 0.0;
    point->slides = point->friction_end.slid != 0 && point->friction_end.part == 1.0;
    turn_to_slip(dim, point, DIRECTION_PARTS, &of);
    for (int d = 0; d < dim; ++d) point->stretch[d] = point->friction_end.stretch * of.along[d];
    fu_surface_out(dim, on, point->stretch, x);
    for (int d = 0; d < dim; ++d) {
        point->friction[d] = -contact->law.tangential * x[d];
        point->f[d] += point->friction[d];
    }
    point->spring_energy = 0.5 * contact->law.tangential * fu_dot(dim, x, x);
}

/* Adds the derivatives of a path in contact for a part of the step only, in which position and velocity at the end have
 * smaller shares. */
static void add_late_contact(int dim, const fu_attachment_state *on, const friction_course *of, fu_contact_point *point)
{
    const double h = of->path.h, *n = point->distance.n;
    const fu_cubic at = fu_cubic_at(of->from);
    const double sinking = point->entered > 0.0 ? INFINITY /* its instant does not depend on the penetration */
                           : h > 0.0            ? h * fu_rate_within(&of->path.depth, h, of->from)
                                                : point->depth + point->mark->gap;
    const double end = h > 0.0 ? at.change : of->from, rate = h > 0.0 ? h * at.rates[1] : 0.0;
    double by_place[9], by_rate[9], slope[3], local[3];
    for (int d = 0; d < dim; ++d) {
        const fu_step_ends ends = {{0.0, of->change[d]}, {point->mark->rate[d], point->slip[d]}};
        local[d] = h > 0.0 ? h * fu_rate_within(&ends, h, of->from) : of->change[d];
    }
    fu_surface_out(dim, on, local, slope);
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) {
            by_place[i * dim + j] = -end * (i == j) - slope[i] * n[j] * end / sinking;
            by_rate[i * dim + j] = -rate * (i == j) - slope[i] * n[j] * rate / sinking;
        }
    double turned[9];
    memcpy(turned, point->by_stretch, sizeof turned);
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) {
            for (int k = 0; k < dim; ++k) {
                point->by_place[i * dim + j] += turned[i * dim + k] * by_place[k * dim + j];
                point->by_rate[i * dim + j] += turned[i * dim + k] * by_rate[k * dim + j];
            }
            point->by_stretch[i * dim + j] *= 1.0 - end;
        }
}

/* Computes the derivatives of friction that has slid within the step and then sticks, or slides to its end. */
static void add_sliding(int dim, const fu_contact *contact, const fu_attachment_state *on, const friction_course *of,
                        const double *x, fu_contact_point *point)
{
    const fu_distance *at = &point->distance;
    const fu_friction_end *end = &point->friction_end;
    const double k = contact->law.tangential, mu = contact->law.friction;
    double w[3], f[3], by_place[9], by_rate[9], along[3];
    fu_cubic weights = {1.0, {0.0, 0.0}, 0.0, {0.0, 1.0}};
    fu_surface_past(dim, on, point->r, point->v, w);
    double depth = point->depth, sinking = point->sinking;
    if (end->part < 1.0) {
        weights = fu_cubic_at(end->part);
        depth = fu_value_within(&of->path.depth, of->path.h, end->part);
        sinking = fu_rate_within(&of->path.depth, of->path.h, end->part);
    }
    const fu_normal_force law = fu_normal_force_at(contact, depth, sinking, depth);
    const double h = of->path.h, sign = end->slid;
    const double rate = h > 0.0 ? weights.slope / h : 0.0, lag = h > 0.0 ? h * weights.rates[1] : 0.0;
    const double normal_force[3] = {k * end->stretch / mu, sign * (law.by_depth * weights.change + law.by_rate * rate),
                                    sign * (law.by_depth * lag + law.by_rate * weights.slope_rates[1])};
    contact->surface.kernel->sliding(at->n, at->H, w, normal_force, x, mu, f, by_place, by_rate, point->by_stretch);
    fu_surface_out(dim, on, of->along, along);
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) {
            const double held = -k * along[i] * along[j];
            point->by_stretch[i * dim + j] += held * (1.0 - weights.change);
            point->by_place[i * dim + j] += by_place[i * dim + j] + held * (1.0 - weights.change);
            point->by_rate[i * dim + j] += by_rate[i * dim + j] - held * lag;
        }
}

void fu_contact_friction_derivatives(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                                     fu_contact_point *point)
{
    const int dim = model->dim;
    const fu_distance *at = &point->distance;
    double x[3], f[3], t[3], by_place[9];
    friction_course of;
    path_of(model, contact, on, point, &of);
    const double h = turn_to_slip(dim, point, DIRECTION_PARTS, &of);
    fu_surface_out(dim, on, of.x, x);
    if (fu_dot(dim, point->mark->normal, point->mark->normal) >
        0.0) /* half of the change of the penetration rotates with this normal, half with that before */
        for (int d = 0; d < dim; ++d) x[d] -= 0.5 * (point->depth + point->mark->gap) * at->n[d];
    if (point->friction_end.slid && of.size > 0.0) add_sliding(dim, contact, on, &of, x, point);
    else {
        contact->surface.kernel->sticking(at->n, at->H, x, contact->law.tangential, f, by_place, t, point->by_stretch);
        for (int i = 0; i < dim * dim; ++i) point->by_place[i] += by_place[i];
    }
    for (int i = 0; i < dim * dim && h > 0.0; ++i) {
        point->by_place[i] -= point->by_stretch[i];
        point->by_rate[i] += h * point->by_stretch[i];
        point->by_stretch[i] = 0.0;
    }
    if (of.from > 0.0) add_late_contact(dim, on, &of, point);
}
