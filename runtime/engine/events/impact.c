/* Continuation of hard contacts after one of them closes or would pull: impacts by Newton's law of restitution, at all
 * active points at once; then normal forces, by the accelerations that follow. Both are complementarity problems over
 * the compliance H M^-1 H' of the active points, with all other constraints unchanged. */
#include "bodies/unknowns.h"
#include "equations/equations.h"
#include "equations/run.h"
#include "events/events.h"
#include "events/hard_contact.h"

#include <math.h>
#include <string.h>

#define CONTACT_TOLERANCE 1e-12    /* of the largest length: distances of active points */
#define ROUNDING_OF_VELOCITY 1e-11 /* of velocities, or of accelerations: smaller ones are zero */
/* of the velocity below which a point comes to rest: a slower separation is none under a normal force */
#define SEPARATION_SPEED 1e-3
#define REST_SPEED 1e-6 /* of the velocity below which a point comes to rest: the same */
/* of the kinetic energy of the jump: largest gain in an impact */
#define ENERGY_TOLERANCE 1e-9

enum { MAX_CONTACTS = FU_MAX_HARD_CONTACTS };

/* Collects the active points and opens all of them, so that their rows are not in eq 38. */
static void collect(fu_run *run, const fu_coupling *first, fu_active_contacts *t)
{
    const fu_model *model = run->model;
    t->n = t->friction = 0;
    FU_EACH_COUPLING(c, model->couplings, model->n_couplings) {
        if (c->type != &fu_hard_contact_type) continue;
        fu_hard_flags *flags = fu_hard_flags_of(c, &run->now);
        fu_hard_row *row = &t->row[t->n];
        fu_hard_row_at(model, fu_hard_contact_of(c), &run->now, row);
        if (flags->mode == FU_APART && c != first && row->g > CONTACT_TOLERANCE * fu_largest_length(run)) continue;
        run->farthest[c->number] =
            fmax(run->farthest[c->number],
                 fu_hard_beyond(model, fu_hard_contact_of(c), &run->now)); /* it may separate within the step */
        t->was[t->n] = flags->mode;
        t->stuck[t->n] = flags->sticks;
        t->friction |= fu_hard_contact_of(c)->friction > 0.0;
        t->before[t->n] = row->rate;
        t->of[t->n++] = c;
        flags->mode = FU_APART;
    }
}

/* Computes the compliance of the active points; returns nonzero if other constraints have no solution. */
static int comply(fu_run *run, fu_active_contacts *t)
{
    if (fu_prepare_response(run->model, &run->now, &run->accelerator)) return 1;
    for (int k = 0; k < t->n; ++k) {
        fu_hard_respond(run, &t->row[k], t->row[k].H);
        for (int j = 0; j < t->n; ++j) t->G[j * t->n + k] = fu_hard_rate(&t->row[j], t->row[j].H, run->work);
    }
    for (int k = 0; k < t->n; ++k)
        for (int j = 0; j < k; ++j)
            t->G[j * t->n + k] = t->G[k * t->n + j] = 0.5 * (t->G[j * t->n + k] + t->G[k * t->n + j]);
    return 0;
}

/* Computes the jump of velocities by the impulses, in run->work. */
static void jump(fu_run *run, const fu_active_contacts *t)
{
    memset(run->before, 0, sizeof(double) * (size_t)run->model->n_dof);
    for (int k = 0; k < t->n; ++k) fu_hard_push(run, &t->row[k], t->row[k].H, t->impulse[k]);
    fu_response(run->model, &run->accelerator, run->before, run->work);
}

/* Solves for the impulses with which no point separates more slowly than by its restitution; returns nonzero if there
 * are none. */
static int solve_impulses(fu_active_contacts *t, double least)
{
    double b[MAX_CONTACTS];
    int unused[MAX_CONTACTS];
    for (int k = 0; k < t->n; ++k) b[k] = t->before[k] - t->target[k];
    if (fu_complement(t->n, t->G, b, least, t->impulse, unused)) return 1;
    for (int k = 0; k < t->n; ++k) t->after[k] = t->before[k] + fu_dot(t->n, t->G + k * t->n, t->impulse);
    return 0;
}

/* Returns the energy loss of the impulses, J: minus their work at the mean of the velocities before and after. */
static double lost(const fu_active_contacts *t)
{
    double sum = 0.0;
    for (int k = 0; k < t->n; ++k) sum -= 0.5 * t->impulse[k] * (t->before[k] + t->after[k]);
    return sum;
}

/* Computes the jump of velocities, in run->work, by the impulses of the law; returns nonzero if there are none. */
static int solve(fu_run *run, fu_active_contacts *t, double least)
{
    if (t->friction) return fu_impact_with_friction(run, t);
    if (solve_impulses(t, least)) return 1;
    jump(run, t);
    t->taken = lost(t);
    return 0;
}

/* Separates closing points by their restitution, or keeps those that would separate too slowly. Restitutions that
 * differ from point to point may add energy: then there is none. Returns nonzero if no impulses separate them. */
static int strike(fu_run *run, fu_active_contacts *t, double least)
{
    for (int k = 0; k < t->n; ++k) {
        const fu_hard_contact *contact = fu_hard_contact_of(t->of[k]);
        const double back = -contact->restitution * t->before[k];
        t->target[k] = back > contact->rest_velocity ? back : 0.0;
    }
    if (solve(run, t, least)) return 1;
    if (t->taken < -ENERGY_TOLERANCE * fu_kinetic_energy_of_change(run->model, run->now.t, run->now.q, run->work)) {
        memset(t->target, 0, sizeof t->target);
        if (solve(run, t, least)) return 1;
    }
    fu_take_jump(run, run->work, t->taken);
    fu_update_directions(run);
    return 0;
}

/* Solves for the normal forces of points that do not separate, by the accelerations without them; returns nonzero
 * without a solution. */
static int find_normal_forces(fu_run *run, fu_active_contacts *t, double least)
{
    const fu_model *model = run->model;
    int n = 0, at[MAX_CONTACTS], kind[MAX_CONTACTS];
    double G[MAX_CONTACTS * MAX_CONTACTS], b[MAX_CONTACTS], force[MAX_CONTACTS], largest = 0.0;
    for (int k = 0; k < t->n; ++k) {
        t->stays[k] = t->after[k] <= fmax(least, SEPARATION_SPEED * fu_hard_contact_of(t->of[k])->rest_velocity);
        if (t->stays[k]) at[n++] = k;
    }
    if (!n) return 0;
    if (fu_accelerations(model, &run->now, &run->accelerator, run->work, 0)) return 1;
    for (int i = 0; i < n; ++i) {
        fu_hard_row row;
        fu_hard_row_at(model, fu_hard_contact_of(t->of[at[i]]), &run->now, &row); /* velocities have jumped */
        b[i] = fu_hard_rate(&row, row.H, run->work) + row.bias;
        largest = fmax(largest, fabs(b[i]));
        for (int j = 0; j < n; ++j) G[i * n + j] = t->G[at[i] * t->n + at[j]];
    }
    if (fu_complement(n, G, b, ROUNDING_OF_VELOCITY * largest, force, kind)) return 1;
    for (int i = 0; i < n; ++i)
        fu_hard_flags_of(t->of[at[i]], &run->now)->mode = kind[i] == FU_IS_BASIC       ? FU_CLOSED
                                                          : kind[i] == FU_IS_DEPENDENT ? FU_IMPLIED
                                                                                       : FU_APART;
    return 0;
}

/* Returns the change of an active point. */
static int news_of(const fu_active_contacts *t, int k, const fu_hard_flags *flags)
{
    if (t->was[k] == FU_APART)
        return flags->mode != FU_APART ? FU_CAME_INTO_CONTACT : t->impulse[k] > 0.0 ? FU_STRUCK : FU_NO_NEWS;
    if (flags->mode == FU_APART) return FU_LOST_CONTACT;
    return flags->sticks == t->stuck[k] ? FU_NO_NEWS : flags->sticks ? FU_STUCK : FU_BROKE_LOOSE;
}

/* Triggers an event function of a coupling at once, too. */
static void let_happen(fu_run *run, const fu_coupling *coupling)
{
    for (int k = 0; k < run->n_event_functions; ++k)
        if (fu_event_coupling(run, k) == coupling && !run->event_functions[k].which) fu_set_late(run, k, 1);
}

int fu_resolve_hard_contacts(fu_run *run, const fu_coupling *first, int yields)
{
    fu_active_contacts t = {.n = 0};
    double approach = 0.0;
    collect(run, first, &t);
    if (!t.n) return FU_RUNNING;
    double least = ROUNDING_OF_VELOCITY * fu_size(run->model, run->now.v);
    for (int k = 0; k < t.n; ++k) least = fmax(least, REST_SPEED * fu_hard_contact_of(t.of[k])->rest_velocity);
    if (comply(run, &t)) return FU_SINGULAR;
    for (int k = 0; k < t.n; ++k) {
        t.after[k] = t.before[k];
        approach = fmax(approach, -t.before[k]);
    }
    if (approach > least && strike(run, &t, least)) return FU_NO_CONVERGENCE;
    if (find_normal_forces(run, &t, least)) return FU_NO_CONVERGENCE;
    if (t.friction && fu_settle_friction(run, &t, yields ? first : 0)) return FU_NO_CONVERGENCE;
    for (int k = 0; k < t.n; ++k) {
        fu_hard_flags *flags = fu_hard_flags_of(t.of[k], &run->now);
        const int news = news_of(&t, k, flags);
        if (!news) continue;
        flags->news = news;
        fu_hard_numbers_of(t.of[k], &run->now)->time = run->now.t;
        if (first && t.of[k] != first) let_happen(run, t.of[k]);
    }
    return FU_RUNNING;
}
