/* Friction that holds at rest, of slides and of joints: events/sticking.c. */
#ifndef FUNICULAR_COUPLINGS_COMMON_STICKING_H
#define FUNICULAR_COUPLINGS_COMMON_STICKING_H

/* mode: it slides; it is locked, by a signal or at rest; the rider of a slide has left the cable. slip_direction: 1 or
 * -1 if friction opposes that direction at any speed. */
enum { FU_SLIDES, FU_LOCKED, FU_LEFT };
typedef struct {
    int mode, slip_direction;
} fu_sticking_flags;

#endif
