/* What waits for a slide at the ends of its cable; events/end_stops.c lets it act. */
#ifndef FUNICULAR_COUPLINGS_SLIDE_END_STOPS_H
#define FUNICULAR_COUPLINGS_SLIDE_END_STOPS_H

/* What waits for a slide at an end of its cable: the restitution of a hard stop; the length before the end, m, the
 * stiffness, N/m, and the damping, N s/m, of a buffer. */
enum { FU_END_IS_ERROR, FU_END_IS_OPEN, FU_END_IS_HARD, FU_END_IS_BUFFERED };
typedef struct {
    int kind;
    double restitution, length, stiffness, damping;
} fu_end_stop;

extern const char *const fu_end_stop_kinds[]; /* the words for them: couplings/slide/state.c */

#endif
