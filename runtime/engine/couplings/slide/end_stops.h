/* End stops of slides; events/end_stops.c has their actions. */
#ifndef FUNICULAR_COUPLINGS_SLIDE_END_STOPS_H
#define FUNICULAR_COUPLINGS_SLIDE_END_STOPS_H

/* End stop at an end of a cable: the restitution of a hard stop; the length before the end, m, the stiffness, N/m, and
 * the damping, N s/m, of a buffer. */
enum { FU_END_IS_ERROR, FU_END_IS_OPEN, FU_END_IS_HARD, FU_END_IS_BUFFERED };
typedef struct {
    int kind;
    double restitution, length, stiffness, damping;
} fu_end_stop;

extern const char *const fu_end_stop_kinds[]; /* their words: couplings/slide/state.c */

#endif
