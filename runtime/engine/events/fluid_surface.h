/* Surfaces of fluids begin to cut what the fluid acts on: events/fluid_surface.c. */
#ifndef FUNICULAR_EVENTS_FLUID_SURFACE_H
#define FUNICULAR_EVENTS_FLUID_SURFACE_H

#include "base/event.h"
#include "couplings/fluid/drag.h"

/* The watches of the surfaces of a fluid, numbered from `first`; the number that one of them is, m. */
int fu_surface_event_functions(const fu_drag *drag, int first, fu_event_function *out);
double fu_surface_event_value(const fu_model *model, const fu_drag *drag, const fu_state *state, int which);

#endif
