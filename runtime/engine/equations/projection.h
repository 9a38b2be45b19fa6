/* Projection of states on their constraints: equations/projection.c. */
#ifndef FUNICULAR_EQUATIONS_PROJECTION_H
#define FUNICULAR_EQUATIONS_PROJECTION_H

#include "base/common.h"

int fu_find_internal(fu_run *run);
int fu_close(fu_run *run);
int fu_return_to_joints(fu_run *run, fu_state *state);
int fu_probe_mechanism(fu_run *run, const double *along, double *left);
int fu_complete(fu_run *run, fu_state *state);
int fu_is_short(const fu_run *run, double h);
int fu_coast(fu_run *run, double h);

#endif
