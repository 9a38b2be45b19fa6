/* A monotonic clock: base/clock.c. */
#ifndef FUNICULAR_BASE_CLOCK_H
#define FUNICULAR_BASE_CLOCK_H

double fu_clock(void); /* s */

#endif
