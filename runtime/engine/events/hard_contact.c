/* Events of a hard contact (couplings/common/coupling_events.h): it closes, and opens under tension. */
#include "couplings/common/coupling_events.h"
#include "equations/run.h"
#include "events/contact.h"
#include "events/events.h"
#include "events/hard_contact.h"

#include <math.h>

/* of the weight: a smaller tension does not open a contact, since one of four points may bear nothing */
#define PULL_TOLERANCE 3e-10

static const char *const words[] = {"", "struck", "came into contact", "lost contact", "stuck", "broke loose"};

/* Event functions: the distance, or of a closed contact the normal force; friction. */
enum { OF_DISTANCE, OF_FRICTION };

static int functions(const fu_coupling *coupling, fu_event_function *out)
{
    const int n = coupling->n_forces > 1 ? 2 : 1;
    for (int k = 0; k < n && out; ++k) out[k] = (fu_event_function){.which = k, .direction = 1};
    return n;
}

/* Returns the multipliers of a closed contact, N: by eq 38, since those of Newton's method have the rounding of
 * positions over h^2. */
static const double *multipliers(const fu_run *run, const fu_coupling *coupling, const fu_state *state)
{
    static const double none[FU_SPACE] = {NAN, NAN, NAN};
    if (!run->integrator->newton) return state->forces + coupling->force;
    return fu_event_accelerations(run, state) ? run->accelerator.multipliers + coupling->multiplier : none;
}

/* Returns the excess of the tangential force over friction, N; or the speed of reversed sliding, m/s. */
static double friction_margin(const fu_run *run, const fu_coupling *coupling, const fu_state *state)
{
    const fu_hard_contact *contact = fu_hard_contact_of(coupling);
    const int dim = run->model->dim;
    fu_hard_row row;
    fu_hard_along along;
    if (fu_hard_flags_of(coupling, state)->sticks) {
        const double *held = multipliers(run, coupling, state);
        return sqrt(fu_dot(dim - 1, held + 1, held + 1)) - fu_hard_friction_limit(contact, held[0]);
    }
    fu_hard_row_at(run->model, contact, state, &row);
    fu_hard_along_at(run->model, contact, state, &row, &along);
    return -fu_dot(dim, fu_hard_numbers_of(coupling, state)->direction, along.past);
}

/* Penetration, m; of a closed contact the tension, N. */
static double value_of(const fu_run *run, const fu_coupling *coupling, const fu_state *state, int which)
{
    const int mode = fu_hard_flags_of(coupling, state)->mode;
    fu_hard_row row;
    if (which == OF_FRICTION) return mode == FU_CLOSED ? friction_margin(run, coupling, state) : -1.0;
    if (mode == FU_CLOSED)
        return multipliers(run, coupling, state)[0] - PULL_TOLERANCE * fu_hard_contact_of(coupling)->weight;
    if (mode == FU_IMPLIED) return -1.0;
    fu_hard_row_at(run->model, fu_hard_contact_of(coupling), state, &row);
    return -row.g;
}

static double grazing(const fu_run *run, const fu_coupling *coupling, int which, double h)
{
    const fu_contact *contact = &fu_hard_contact_of(coupling)->contact;
    fu_attachment_state on[2];
    if (which == OF_FRICTION || fu_hard_flags_of(coupling, &run->now)->mode != FU_APART) return 0.0;
    fu_surface_at(run->model, &contact->surface, &run->now, &on[0]);
    fu_surface_at(run->model, &contact->surface, &run->next, &on[1]);
    return fu_contact_grazing(run, contact, on, 0, 0, h);
}

static int act(fu_run *run, const fu_coupling *coupling, int which, int side, const char **what)
{
    fu_hard_flags *flags = fu_hard_flags_of(coupling, &run->now);
    const double *time = &fu_hard_numbers_of(coupling, &run->now)->time;
    (void)side;
    *what = words[FU_NO_NEWS];
    if (which == OF_FRICTION && flags->mode != FU_CLOSED) return FU_RUNNING;
    if (flags->news &&
        run->now.t - *time <= FU_AT_ONCE * run->duration) { /* caused by another point; earlier changes are old */
        *what = words[flags->news];
        flags->news = FU_NO_NEWS;
        return FU_RUNNING;
    }
    flags->news = FU_NO_NEWS;
    const int slid = which == OF_FRICTION && !flags->sticks;
    const int status = fu_resolve_hard_contacts(run, coupling, which == OF_FRICTION && flags->sticks);
    if (status == FU_NO_CONVERGENCE) fu_fail(run, FU_SELF_LOCKING, run->now.v, coupling->number);
    *what = slid && !flags->news ? "turned round" : words[flags->news];
    flags->news = FU_NO_NEWS;
    return status;
}

/* The first contact determines the state of all. */
static int begin(fu_run *run, const fu_coupling *coupling)
{
    fu_hard_flags *flags = fu_hard_flags_of(coupling, &run->now);
    if (!coupling->index && fu_resolve_hard_contacts(run, 0, 0)) return FU_SINGULAR;
    flags->news = FU_NO_NEWS;
    return FU_RUNNING;
}

static double beyond(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    return fu_hard_flags_of(coupling, state)->mode == FU_APART
               ? -INFINITY
               : fu_hard_beyond(model, fu_hard_contact_of(coupling), state);
}

const fu_coupling_events fu_hard_contact_events = {
    .beyond = beyond, .functions = functions, .value = value_of, .grazing = grazing, .act = act, .begin = begin};
