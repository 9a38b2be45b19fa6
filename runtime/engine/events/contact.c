/* Start and end of contact with a surface: the largest penetration passes zero, at the ends of a step or within it. */
#include "base/cubic.h"
#include "couplings/common/coupling_events.h"
#include "equations/run.h"
#include "events/contact.h"

#include <math.h>
#include <string.h>

static const fu_contact *of(const fu_coupling *coupling)
{
    return (const fu_contact *)coupling;
}

/* Returns the largest penetration, m, negative off the surface, for elements nearer than others. */
static double deepest(const fu_model *model, const fu_contact *contact, const fu_state *state)
{
    double depth = -INFINITY;
    fu_attachment_state on;
    fu_surface_at(model, &contact->surface, state, &on);
    for (int e = 0; e < fu_contact_elements(contact); ++e) {
        fu_contact_heights heights;
        if (fu_contact_heights_of(model, contact, &on, state, e, &heights)) {
            depth = fmax(depth, heights.deepest);
            continue;
        }
        if (!fu_contact_may_be_active(model, contact, &on, state, e, -depth)) continue;
        for (int k = 0; k < contact->n_points; ++k) {
            fu_contact_point point;
            fu_distance at;
            fu_contact_place(model, contact, &on, state, e, k, &point);
            fu_surface_distance(model->dim, &contact->surface, &on, point.r, &at);
            depth = fmax(depth, contact->radius - at.g);
        }
    }
    return depth;
}

static double value_of(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int which)
{
    (void)which;
    return deepest(model, of(coupling), state);
}

static double depth(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double value)
{
    (void)model, (void)coupling, (void)state;
    return value;
}

/* Returns the distance of contact beyond the ends of the surface, m. */
static double beyond(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_contact *contact = of(coupling);
    double farthest = -INFINITY;
    fu_attachment_state on;
    if (!fu_surface_has_ends(&contact->surface)) return farthest;
    fu_surface_at(model, &contact->surface, state, &on);
    for (int e = 0; e < fu_contact_elements(contact); ++e) {
        if (!fu_contact_may_be_active(model, contact, &on, state, e, 0.0)) continue;
        for (int k = 0; k < contact->n_points; ++k) {
            fu_contact_point point;
            fu_contact_place(model, contact, &on, state, e, k, &point);
            const double far = fu_surface_beyond(model->dim, &contact->surface, &on, point.r);
            if (far > fmax(farthest, 0.0) && fu_contact_is_active(model, contact, &on, &point)) farthest = far;
        }
    }
    return farthest;
}

static int sign(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int which)
{
    (void)model, (void)which;
    return state->flags[coupling->flags] ? 1 : -1;
}

static const char *change(const fu_model *model, const fu_coupling *coupling, fu_state *now, int which, int side)
{
    (void)model, (void)which;
    now->flags[coupling->flags] = side > 0;
    return side > 0 ? "came into contact" : "lost contact";
}

static void begin(const fu_model *model, const fu_coupling *coupling, fu_state *now)
{
    now->flags[coupling->flags] = deepest(model, of(coupling), now) > 0.0;
}

/* Returns a point at a state along the axes of its surface's shape. */
static fu_surface_end end_of(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                             const fu_state *state, int element, int number)
{
    fu_contact_point point;
    fu_surface_end end;
    double w[3] = {0.0};
    fu_contact_place(model, contact, on, state, element, number, &point);
    fu_surface_distance(model->dim, &contact->surface, on, point.r, &point.distance);
    fu_surface_past(model->dim, on, point.r, point.v, w);
    memcpy(end.y, point.distance.y, sizeof end.y);
    fu_surface_into(model->dim, on, w, end.rate);
    fu_surface_into(model->dim, on, point.distance.n, end.n);
    end.gap = point.distance.g - contact->radius;
    end.gap_rate = fu_dot(model->dim, point.distance.n, w);
    return end;
}

double fu_contact_grazing(const fu_run *run, const fu_contact *contact, const fu_attachment_state on[2], int element,
                          int number, double h)
{
    const fu_model *model = run->model;
    const fu_surface_end ends[2] = {end_of(model, contact, &on[0], &run->now, element, number),
                                    end_of(model, contact, &on[1], &run->next, element, number)};
    return fu_surface_detect_within(model->dim, &contact->surface, contact->radius, ends, h, run->round_off);
}

/* Returns a bound of the displacement of a near point relative to the surface over a step, m, by the velocities at one
 * end of it. */
static double reach_of(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                       const fu_state *state, double h)
{
    double fastest = 0.0, farthest = 0.0;
    if (contact->cable < 0) return INFINITY;
    const fu_cable *cable = &model->cables[contact->cable];
    FU_EACH_NODE(i, cable)
    fastest = fmax(fastest, sqrt(fu_dot(model->dim, state->v + i, state->v + i)));
    if (!on->n) return h * fastest;
    FU_EACH_NODE(i, cable)
    for (int d = 0; d < model->dim; ++d) farthest = fmax(farthest, fabs(state->q[i + d] - on->p[d]));
    return h * (fastest + sqrt(fu_dot(model->dim, on->v, on->v)) +
                2.0 * farthest * sqrt(fu_dot(model->dim == 3 ? 3 : 1, on->omega, on->omega)));
}

#define MAX_IMPACT_STEP 0.25 /* of an impact's time over pi: upper bound of steps in it */

/* Returns the step that resolves an impact of a body that begins at `now`, s; 0 if unnecessary, since its reversed
 * speed moves it by less than tol in the remaining time. */
static double step_of_impact(const fu_run *run, const fu_contact *contact, double h)
{
    const fu_model *model = run->model;
    double fastest = 0.0, deepest_now = 0.0;
    fu_attachment_state on;
    if (contact->cable >= 0 || run->fixed_step > 0.0) return 0.0;
    fu_surface_at(model, &contact->surface, &run->now, &on);
    for (int k = 0; k < contact->n_points; ++k) {
        const fu_surface_end end = end_of(model, contact, &on, &run->now, 0, k);
        if (end.gap > h * fabs(end.gap_rate)) continue;
        fastest = fmax(fastest, fabs(end.gap_rate));
        deepest_now = fmax(deepest_now, -end.gap);
    }
    if (!(fastest * (run->duration - run->now.t) > fmax(run->absolute_tol, run->tol * run->controlled_motion)))
        return 0.0;
    const double mass = model->bodies[contact->attachments[0].body].mass;
    double stiffness = contact->n_points * contact->law.stiffness;
    if (contact->law.hertz) /* at the penetration for this speed: 2/5 k d^(5/2) = m v^2/2 */
        stiffness *= 1.5 * sqrt(fmax(deepest_now, pow(1.25 * mass * fastest * fastest / stiffness, 0.4)));
    const double longest = MAX_IMPACT_STEP * sqrt(mass / stiffness);
    return h > 1.5 * longest ? longest : 0.0;
}

static double grazing(const fu_run *run, const fu_coupling *coupling, int which, double h)
{
    const fu_model *model = run->model;
    const fu_contact *contact = of(coupling);
    double first = 0.0;
    fu_attachment_state on[2];
    (void)which;
    if (run->now.flags[coupling->flags]) return step_of_impact(run, contact, h);
    fu_surface_at(model, &contact->surface, &run->now, &on[0]);
    fu_surface_at(model, &contact->surface, &run->next, &on[1]);
    const double reach =
        fmax(reach_of(model, contact, &on[0], &run->now, h), reach_of(model, contact, &on[1], &run->next, h));
    for (int e = 0; e < fu_contact_elements(contact); ++e) {
        if (!fu_contact_may_be_active(model, contact, &on[1], &run->next, e, reach)) continue;
        for (int k = 0; k < contact->n_points; ++k) {
            const double found = fu_contact_grazing(run, contact, on, e, k, h);
            if (found > 0.0 && (first == 0.0 || found < first)) first = found;
        }
    }
    return first;
}

static const fu_state_event_operations of_state = {.value = value_of, .change = change, .begin = begin};

const fu_coupling_events fu_contact_events = {
    .of_state = &of_state, .direction = 0, .depth = depth, .beyond = beyond, .sign = sign, .grazing = grazing};
