/* Surfaces of fluids that begin to cut parts: events/fluid_surface.c. */
#ifndef FUNICULAR_EVENTS_FLUID_SURFACE_H
#define FUNICULAR_EVENTS_FLUID_SURFACE_H

#include "base/event.h"
#include "couplings/fluid/drag.h"

/* The event functions of the surfaces of a fluid, numbered from `first`; the value of one of them, m. */
int fu_surface_event_functions(const fu_drag *drag, int first, fu_event_function *out);
double fu_surface_event_value(const fu_model *model, const fu_drag *drag, const fu_state *state, int which);

#endif
