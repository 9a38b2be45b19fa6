/* Deferred events, changes of couplings within a step: events/deferred.c. */
#ifndef FUNICULAR_EVENTS_DEFERRED_H
#define FUNICULAR_EVENTS_DEFERRED_H

#include "couplings/common/coupling_events.h"

int fu_choose_deferred(fu_run *run, int first);
int fu_strayed(const fu_run *run);
int fu_count_deferred(const fu_run *run);
void fu_undo_deferred(fu_run *run);
void fu_note_deferred(fu_run *run, double h);
double fu_deferred_error(fu_run *run, double h);
double fu_friction_error(fu_run *run, double h);
int fu_take_deferred(fu_run *run);

#endif
