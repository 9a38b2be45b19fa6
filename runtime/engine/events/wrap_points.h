/* Points where friction sticks to a wrap that changes: events/wrap_point.c. */
#ifndef FUNICULAR_EVENTS_WRAP_POINTS_H
#define FUNICULAR_EVENTS_WRAP_POINTS_H

#include "equations/run.h"

/* Chooses the points of a sheave after a change of the mode of its wrap, before velocities are projected: where other
 * ones act than before, they stick if any did, else they have no friction yet. */
void fu_change_points(fu_run *run, const fu_coupling *sheave);
/* Determines all points of the scene after this projection: whether they stick, or in which direction they slide.
 * Returns a status. */
int fu_settle_points(fu_run *run);

#endif
