/* Hard contacts that close, open, slide and stick: events/impact.c, events/impact_friction.c, events/impulse.c. */
#ifndef FUNICULAR_EVENTS_HARD_CONTACT_H
#define FUNICULAR_EVENTS_HARD_CONTACT_H

#include "couplings/hard_contact/hard_contact.h"

static inline const fu_hard_contact *fu_hard_contact_of(const fu_coupling *coupling)
{
    return (const fu_hard_contact *)coupling;
}

/* The active points: their earlier state; rows, compliance, normal velocities before and after, least velocities after,
 * impulses, their energy loss, J; whether they stay closed; whether any has friction. */
typedef struct {
    int n, friction, was[FU_MAX_HARD_CONTACTS], stuck[FU_MAX_HARD_CONTACTS], stays[FU_MAX_HARD_CONTACTS];
    const fu_coupling *of[FU_MAX_HARD_CONTACTS];
    fu_hard_row row[FU_MAX_HARD_CONTACTS];
    double G[FU_MAX_HARD_CONTACTS * FU_MAX_HARD_CONTACTS], before[FU_MAX_HARD_CONTACTS], after[FU_MAX_HARD_CONTACTS];
    double target[FU_MAX_HARD_CONTACTS], impulse[FU_MAX_HARD_CONTACTS], taken;
} fu_active_contacts;

/* events/impulse.c: adds an impulse along H, of a row's dofs, to run->before; computes in run->work the jump of
 * velocities by one of 1 Ns alone; returns the rate along H of dofs with these rates. */
void fu_hard_push(fu_run *run, const fu_hard_row *row, const double *H, double impulse);
void fu_hard_respond(fu_run *run, const fu_hard_row *row, const double *H);
double fu_hard_rate(const fu_hard_row *row, const double *H, const double *dofs);

/* events/impact_friction.c: the jump of velocities by impulses with friction, in run->work; the continuation of
 * friction and normal forces, of which `loose` may be known to break loose. They return nonzero without a solution. */
int fu_impact_with_friction(fu_run *run, fu_active_contacts *active);
int fu_settle_friction(fu_run *run, fu_active_contacts *active, const fu_coupling *loose);

/* events/impact.c: determines the continuation of hard contacts at `now`, after one of them, `first` (null: at the
 * start), has closed, would pull, stops sliding, or breaks loose if it `yields`; returns a status. Each contact records
 * its change. */
int fu_resolve_hard_contacts(fu_run *run, const fu_coupling *first, int yields);

#endif
