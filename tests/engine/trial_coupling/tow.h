/* A tow: tow.c. */
#ifndef FUNICULAR_EVENTS_TOW_H
#define FUNICULAR_EVENTS_TOW_H

#include "couplings/common/coupling_events.h"

extern const fu_coupling_type fu_tow_type;
extern const fu_coupling_events fu_tow_events;

#endif
