/* What a hard contact does by itself (include/coupling_events.h): it comes together, and opens where it would pull. */
#include "engine.h"

#define AT_ONCE 1e-12 /* of the duration: news that is older is none */

static const char *const words[] = {"", "struck", "came to rest", "lost contact"};

static const fu_hard_contact *contact_of(const fu_coupling *coupling)
{
    return (const fu_hard_contact *)coupling;
}

static int watches(const fu_coupling *coupling, fu_watch *out)
{
    (void)coupling;
    if (out) *out = (fu_watch){.which = 0, .direction = 1};
    return 1;
}

/* Returns the multiplier of a contact that is closed, N: by eq 38, as a Newton method's has the rounding of positions over h^2. */
static double multiplier(const fu_run *run, const fu_coupling *coupling, const fu_state *state)
{
    fu_accelerator work = run->accelerator;
    if (!run->integrator->newton) return state->forces[coupling->force];
    if (fu_accelerations(run->model, state, &work, run->work, 0)) return NAN;
    return work.multipliers[coupling->multiplier];
}

/* How deep it is below the surface, m; where it is closed by how much it pulls, N. */
static double watched(const fu_run *run, const fu_coupling *coupling, const fu_state *state, int which)
{
    const int mode = fu_hard_flags_of(coupling, state)->mode;
    fu_hard_row row;
    (void)which;
    if (mode == FU_CLOSED) return multiplier(run, coupling, state);
    if (mode == FU_IMPLIED) return -1.0;
    fu_hard_row_at(run->model, contact_of(coupling), state, &row);
    return -row.g;
}

static double dip(const fu_run *run, const fu_coupling *coupling, int which, double h)
{
    fu_hard_row from, to;
    (void)which;
    if (fu_hard_flags_of(coupling, &run->now)->mode != FU_APART) return 0.0;
    fu_hard_row_at(run->model, contact_of(coupling), &run->now, &from);
    fu_hard_row_at(run->model, contact_of(coupling), &run->next, &to);
    return fu_dip((fu_course){from.g, from.rate}, (fu_course){to.g, to.rate}, 1, h, run->round_off);
}

static int sign(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int which)
{
    (void)model, (void)coupling, (void)state, (void)which;
    return -1;
}

static int act(fu_run *run, const fu_coupling *coupling, int which, int side, const char **what)
{
    fu_hard_flags *flags = fu_hard_flags_of(coupling, &run->now);
    const double *time = &fu_hard_numbers_of(coupling, &run->now)->time;
    (void)which, (void)side;
    *what = words[FU_NO_NEWS];
    if (flags->news && run->now.t - *time <= AT_ONCE * run->duration) { /* of what another one has brought */
        *what = words[flags->news];
        flags->news = FU_NO_NEWS;
        return FU_RUNNING;
    }
    flags->news = FU_NO_NEWS;
    const int status = fu_resolve_hard_contacts(run, coupling);
    if (status == FU_NO_CONVERGENCE) fu_fail(run, FU_SELF_LOCKING, run->now.v, coupling->number);
    *what = words[flags->news];
    flags->news = FU_NO_NEWS;
    return status;
}

static int can_act(const fu_coupling *coupling)
{
    (void)coupling;
    return 1;
}

/* The first of them finds how all are. */
static int begin(fu_run *run, const fu_coupling *coupling)
{
    fu_hard_flags *flags = fu_hard_flags_of(coupling, &run->now);
    if (!coupling->index && fu_resolve_hard_contacts(run, 0)) return FU_SINGULAR;
    flags->news = FU_NO_NEWS;
    return FU_RUNNING;
}

const fu_coupling_events fu_hard_contact_events = {
    .watches = watches, .watched = watched, .dip = dip, .sign = sign, .act = act, .can_act = can_act, .begin = begin};
