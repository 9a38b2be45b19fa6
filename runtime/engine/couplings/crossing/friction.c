/* Sticking friction of lines in contact: a spring, stretched by the relative displacement of particles of both lines
 * since the last step, up to the friction limit (derive/couplings/crossing.py, stretch.py). */
#include "bodies/model.h"
#include "couplings/crossing/crossing.h"

#include <math.h>
#include <string.h>

/* State of the last step: the closest points, the vector between them and the slopes there, with their rates; along and
 * across the last line the stretch and the relative velocity of particles; nonzero if it has slid, when the stretch
 * equals the friction limit; the penetration and its rate; the time. */
typedef struct {
    double s[FU_LINES], s_rate[FU_LINES], separation[3], separation_rate[3], slopes[6], slope_rates[6];
    double stretch[2], slid, rate[2], depth, sinking, time;
} last_step;
_Static_assert(sizeof(last_step) == FU_CROSSING_STICK * sizeof(double), "numbers of a state are doubles");

static last_step *before_of(const fu_crossing *crossing, const fu_state *state)
{
    return (last_step *)(state->numbers + crossing->base.numbers + FU_CROSSING_NUMBERS);
}

static void moved_since(const last_step *last, const fu_closest_points *points, double e[FU_LINES])
{
    for (int line = 0; line < FU_LINES; ++line) e[line] = points->s[line] - last->s[line];
}

/* Returns the time since the last step, s; 0 for the drawn state. */
static double time_since(const last_step *last, double time)
{
    return fmax(time - last->time, 0.0);
}

/* Returns the friction limit, N, by the law of kernel->contact. */
static double bound(const void *of, double depth, double rate)
{
    const fu_crossing *crossing = of;
    const int dim = crossing->kernel->dim;
    const double t[6] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0};
    fu_crossing_contact at;
    double d[3] = {0.0}, u[3] = {0.0};
    memset(&at, 0, sizeof at);
    crossing->kernel->contact(d, t, u, crossing->law, at.normal, at.depth, &at.size, at.force, &at.energy,
                              &at.dissipated);
    for (int k = 0; k < dim; ++k) {
        d[k] = (at.depth[0] - depth) * at.normal[k];
        u[k] = -rate * at.normal[k];
    }
    crossing->kernel->contact(d, t, u, crossing->law, at.normal, at.depth, &at.size, at.force, &at.energy,
                              &at.dissipated);
    return crossing->friction * fmax(at.size, 0.0);
}

/* Converts a direction in the lines' common tangent plane, along and across the last line, to space. */
static void in_space(int dim, const double *along, const double *normal, const double parts[2], double out[3])
{
    double across[3] = {0.0};
    if (dim == 3) fu_cross(normal, along, across);
    for (int d = 0; d < dim; ++d) out[d] = parts[0] * along[d] + parts[1] * across[d];
}

/* Computes the relative velocity of particles of both lines. */
static void slip_of(int dim, const fu_closest_points *points, const fu_crossing_contact *contact, double slip[3])
{
    for (int d = 0; d < dim; ++d) slip[d] = points->u[d] + contact->depth[1] * contact->normal[d];
}

/* Computes the path of friction's spring from the last step to points; the stretches are those of the kernel. */
static void travel_since(const fu_crossing *crossing, const last_step *last, const fu_closest_points *points,
                         const fu_crossing_contact *contact, double time, const fu_crossing_stick *stick,
                         fu_friction_travel *travel, fu_friction_path *path)
{
    const int dim = crossing->kernel->dim;
    memset(travel, 0, sizeof *travel);
    for (int d = 0; d < dim; ++d) {
        travel->stretch[d] = stick->old[d];
        travel->change[d] = stick->without_sliding[d] - stick->old[d];
    }
    in_space(dim, stick->along, contact->normal, last->rate, travel->rates[0]);
    slip_of(dim, points, contact, travel->rates[1]);
    *path =
        (fu_friction_path){.h = time - last->time, .stiffness = crossing->tangential, .bound = bound, .of = crossing};
    path->depth = (fu_step_ends){{last->depth, contact->depth[0]}, {last->sinking, contact->depth[1]}};
}

static int slid_before(const last_step *last)
{
    return last->slid != 0.0 && fu_dot(2, last->stretch, last->stretch) > 0.0;
}

/* Returns the size of the stretch at the last step if it slid then, m, else 1. */
static double slid_stretch(const last_step *last)
{
    return slid_before(last) ? sqrt(fu_dot(2, last->stretch, last->stretch)) : 1.0;
}

/* Returns whether a stretch takes the direction of turn_to_slip: in the plane there is one direction; against the slip
 * it is unloaded. */
static int turns(int dim, const fu_crossing_stick *stick, const fu_friction_travel *travel)
{
    const double *now = stick->without_sliding;
    return dim == 3 && stick->slides && stick->end.slid > 0 && fu_dot(3, now, travel->change) > 0.0 &&
           fu_dot(3, now, travel->rates[1]) > 0.0 && fu_dot(3, now, stick->old) >= 0.0;
}

/* Computes the direction of a stretch that slides as the step ends. */
static void turn_to_slip(const fu_crossing *crossing, const last_step *last, double time,
                         const fu_closest_points *points, const fu_crossing_contact *contact,
                         const fu_crossing_stick *stick, double along[3])
{
    const double r = crossing->friction * fmax(contact->size, 0.0) / crossing->tangential;
    double slip[2][3];
    in_space(3, stick->along, contact->normal, last->rate, slip[0]);
    slip_of(3, points, contact, slip[1]);
    crossing->kernel->turned(stick->without_sliding, stick->old, slip[0], slip[1], time_since(last, time), r,
                             crossing->law[FU_LAW_REGULARISATION], slid_before(last), slid_stretch(last), 1.0, along);
    const double size = sqrt(fu_dot(3, along, along));
    for (int d = 0; d < 3 && size > 0.0; ++d) along[d] /= size;
}

static void stick_since(const fu_crossing *crossing, const last_step *last, const fu_closest_points *points,
                        const fu_crossing_contact *contact, double time, fu_crossing_stick *out)
{
    const int dim = crossing->kernel->dim;
    const double most = crossing->friction * fmax(contact->size, 0.0) / crossing->tangential;
    double e[FU_LINES], along[3] = {0.0};
    fu_friction_travel travel;
    fu_friction_path path;
    memset(out, 0, sizeof *out);
    moved_since(last, points, e);
    crossing->kernel->stretch(points->d, points->t, points->k, points->w, points->u, crossing->law, e,
                              time_since(last, time), last->separation, last->separation_rate, last->slopes,
                              last->slope_rates, last->s_rate, last->stretch, last->rate, out->without_sliding,
                              out->old, out->along);
    travel_since(crossing, last, points, contact, time, out, &travel, &path);
    for (int d = 0; d < dim; ++d) along[d] = travel.stretch[d] + travel.change[d];
    fu_path_along(dim, travel.change, travel.rates[0], travel.rates[1], along, &path);
    out->end = fu_end_of_friction(&path, most);
    out->slides = out->end.slid && out->end.part == 1.0;
    out->turns = turns(dim, out, &travel);
    if (out->turns) turn_to_slip(crossing, last, time, points, contact, out, along);
    for (int d = 0; d < dim; ++d) {
        out->stretch[d] = out->end.stretch * along[d];
        out->force[d] = -crossing->tangential * out->stretch[d];
    }
    out->sticks = !out->slides && last->slid == 0.0;
    out->energy = 0.5 * crossing->tangential * fu_dot(dim, out->stretch, out->stretch);
}

void fu_crossing_stick_at(const fu_crossing *crossing, const fu_state *state, const fu_closest_points *points,
                          const fu_crossing_contact *contact, fu_crossing_stick *out)
{
    stick_since(crossing, before_of(crossing, state), points, contact, state->t, out);
}

/* Computes the derivatives of friction that has slid within the step and then sticks: shares of those of sticking,
 * since a velocity at the end also moves the end of sliding, and of sliding. */
static void mix_derivatives(const fu_crossing *crossing, const fu_crossing_stick *stick, double h,
                            const fu_crossing_stick_changes *stuck, fu_crossing_stick_changes *by)
{
    const int dim = crossing->kernel->dim;
    const fu_cubic at = fu_cubic_at(stick->end.part);
    const double lag = crossing->tangential * h * at.rates[1], square = fu_dot(dim, stick->stretch, stick->stretch);
    for (int i = 0; i < dim * dim; ++i) by->F_d[i] = at.change * by->F_d[i] + (1.0 - at.change) * stuck->F_d[i];
    for (int i = 0; i < dim * dim * (dim - 1); ++i) {
        by->F_t[i] = at.change * by->F_t[i] + (1.0 - at.change) * stuck->F_t[i];
        by->F_w[i] = at.change * by->F_w[i] + (1.0 - at.change) * stuck->F_w[i];
        by->F_k[i] = at.change * by->F_k[i] + (1.0 - at.change) * stuck->F_k[i];
    }
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim && square > 0.0; ++j) {
            const int ij = i * dim + j;
            by->F_u[ij] = at.change * by->F_u[ij] + (1.0 - at.change) * stuck->F_u[ij] +
                          lag * stick->stretch[i] * stick->stretch[j] / square;
        }
}

void fu_crossing_stick_derivatives(const fu_crossing *crossing, const fu_state *state, const fu_closest_points *points,
                                   const fu_line_bends *has_accelerations, const fu_crossing_contact *contact,
                                   fu_crossing_stick_changes *by)
{
    const last_step *last = before_of(crossing, state);
    const fu_crossing_kernels *kernel = crossing->kernel;
    const double friction = contact->size > 0.0 ? crossing->friction : 0.0, h = time_since(last, state->t);
    double e[FU_LINES];
    fu_crossing_stick stick;
    fu_crossing_stick_changes stuck;
    fu_crossing_stick_at(crossing, state, points, contact, &stick);
    moved_since(last, points, e);
    memset(by, 0, sizeof *by);
    memset(&stuck, 0, sizeof stuck);
    if (stick.end.slid)
        kernel->sliding(points->d, points->t, points->k, points->w, points->u, has_accelerations->third,
                        has_accelerations->rate, crossing->law, friction, crossing->tangential, e, h, last->separation,
                        last->separation_rate, last->slopes, last->slope_rates, last->s_rate, last->stretch, last->rate,
                        stick.turns ? slid_before(last) : 0.0, slid_stretch(last), stick.turns, by->F, by->F_d, by->F_t,
                        by->F_u, by->F_w, by->F_k);
    if (!stick.slides)
        kernel->sticking(points->d, points->t, points->k, points->w, points->u, has_accelerations->third,
                         has_accelerations->rate, crossing->law, crossing->tangential, e, h, last->separation,
                         last->separation_rate, last->slopes, last->slope_rates, last->s_rate, last->stretch,
                         last->rate, stuck.F, stuck.F_d, stuck.F_t, stuck.F_u, stuck.F_w, stuck.F_k);
    if (!stick.end.slid) *by = stuck;
    else if (!stick.slides) mix_derivatives(crossing, &stick, state->t - last->time, &stuck, by);
    memcpy(by->F, stick.force, sizeof by->F);
}

/* Updates the stretch, null for none, to points. */
static void take_along(const fu_crossing *crossing, const fu_closest_points *points, const fu_crossing_contact *contact,
                       double time, const fu_crossing_stick *stick, const double *line, last_step *last)
{
    const int dim = crossing->kernel->dim;
    double across[3] = {0.0}, slip[3];
    memset(last, 0, sizeof *last);
    memcpy(last->s, points->s, sizeof last->s);
    memcpy(last->separation, points->d, sizeof(double) * (size_t)dim);
    memcpy(last->slopes, points->t, sizeof(double) * (size_t)(dim * (dim - 1)));
    crossing->kernel->motion(points->d, points->t, points->k, points->w, points->u, last->s_rate, last->slope_rates,
                             last->separation_rate);
    last->depth = contact->depth[0];
    last->sinking = contact->depth[1];
    last->time = time;
    slip_of(dim, points, contact, slip);
    if (dim == 3) fu_cross(contact->normal, line, across);
    last->rate[0] = fu_dot(dim, line, slip);
    last->rate[1] = fu_dot(dim, across, slip);
    if (!stick) return;
    last->slid = stick->slides;
    last->stretch[0] = fu_dot(dim, line, stick->stretch);
    last->stretch[1] = fu_dot(dim, across, stick->stretch);
}

void fu_crossing_begin_stick(const fu_crossing *crossing, const fu_closest_points *points, fu_state *state)
{
    last_step here = *before_of(crossing, state);
    fu_crossing_contact contact;
    fu_crossing_stick stick;
    fu_crossing_contact_at(crossing, points, &contact);
    memcpy(here.s, points->s, sizeof here.s);
    memcpy(here.slopes, points->t, sizeof here.slopes);
    stick_since(crossing, &here, points, &contact, here.time, &stick); /* for the direction of the last line */
    take_along(crossing, points, &contact, state->t, 0, stick.along, before_of(crossing, state));
}

void fu_crossing_update_stick(const fu_crossing *crossing, const fu_closest_points *points,
                              const fu_crossing_contact *contact, fu_state *state)
{
    fu_crossing_stick stick;
    fu_crossing_stick_at(crossing, state, points, contact, &stick);
    take_along(crossing, points, contact, state->t, &stick, stick.along, before_of(crossing, state));
}

/* Computes the stretch at the end of a step, and the path to it; returns whether lines in contact have closest points
 * there. */
static int stick_over_step(const fu_model *model, const fu_crossing *crossing, const fu_state *from, const fu_state *to,
                           fu_crossing_stick *stick, fu_friction_travel *travel, fu_friction_path *path)
{
    const last_step *last = before_of(crossing, from);
    fu_closest_points end;
    fu_crossing_contact contact;
    fu_find_closest(model, crossing, to, &end);
    if (!end.found || !(to->t > last->time)) return 0;
    fu_crossing_contact_at(crossing, &end, &contact);
    stick_since(crossing, last, &end, &contact, to->t, stick);
    travel_since(crossing, last, &end, &contact, to->t, stick, travel, path);
    return 1;
}

/* The difference to another path, the parabola without the velocities at the beginning. */
double fu_crossing_history_error(const fu_model *model, const fu_coupling *coupling, const fu_state *from,
                                 const fu_state *to)
{
    const fu_crossing *crossing = (const fu_crossing *)coupling;
    const int dim = model->dim;
    fu_crossing_stick stick;
    fu_friction_travel travel;
    fu_friction_path path;
    double along[3] = {0.0}, square = 0.0;
    if (!(crossing->friction > 0.0) || !from->flags[coupling->flags]) return 0.0;
    if (!stick_over_step(model, crossing, from, to, &stick, &travel, &path)) return 0.0;
    for (int d = 0; d < dim; ++d) travel.rates[0][d] = 2.0 * travel.change[d] / path.h - travel.rates[1][d];
    path.depth.rate[0] = 2.0 * (path.depth.value[1] - path.depth.value[0]) / path.h - path.depth.rate[1];
    for (int d = 0; d < dim; ++d) along[d] = travel.stretch[d] + travel.change[d];
    fu_path_along(dim, travel.change, travel.rates[0], travel.rates[1], along, &path);
    const fu_friction_end other = fu_end_of_friction(&path, INFINITY);
    if (stick.turns && other.slid > 0 && other.part == 1.0) return fabs(other.stretch - stick.end.stretch);
    for (int d = 0; d < dim; ++d) {
        const double off = other.stretch * along[d] - stick.stretch[d];
        square += off * off;
    }
    return sqrt(square);
}

double fu_crossing_slip_work(const fu_model *model, const fu_crossing *crossing, const fu_state *from,
                             const fu_state *to, int by_ends)
{
    fu_crossing_stick stick;
    fu_friction_travel travel;
    fu_friction_path path;
    if (!stick_over_step(model, crossing, from, to, &stick, &travel, &path)) return 0.0;
    return crossing->tangential * fu_dissipated_by_friction(model->dim, &travel, &path, stick.stretch, by_ends);
}

void fu_crossing_reset_stick(const fu_crossing *crossing, fu_state *state)
{
    last_step *last = before_of(crossing, state);
    memset(last, 0, sizeof *last);
    memcpy(last->s, crossing->start, sizeof last->s);
    memcpy(last->separation, crossing->separation, sizeof last->separation);
    memcpy(last->slopes, crossing->slopes, sizeof last->slopes);
    last->time = FU_NO_TIME;
}
