/* Signals, and the degrees of freedom that follow them: bodies/motions.c. */
#ifndef FUNICULAR_BODIES_MOTIONS_H
#define FUNICULAR_BODIES_MOTIONS_H

#include "base/common.h"

/* f(t) = a polynomial of t - breaks[i] in each interval (the first and the last extend beyond the breaks) + amplitude
 * sin(angular_frequency t + phase) */
typedef struct {
    int n;
    const double *breaks;       /* n + 1 */
    const double *coefficients; /* n rows of FU_SIGNAL_TERMS, ascending powers */
    double amplitude, angular_frequency, phase;
} fu_signal;

/* An instant at which a signal is not smooth, s, and the lowest discontinuous derivative of the driven motion: none of
 * these, the acceleration, the rate (model/knots.py). */
enum { FU_HIGHER_JUMPS, FU_ACCELERATION_JUMPS, FU_RATE_JUMPS };
typedef struct {
    double t;
    int jumps;
} fu_breakpoint;

/* A dof that follows signals: q = base + linear f + cosine cos f + sine sin f */
typedef struct {
    int dof, signal, first; /* first: of the signals of its dof, with which its work is counted */
    double base, linear, cosine, sine;
} fu_motion;

double fu_signal_at(const fu_signal *signal, double t, double *rate, double *second);
/* Returns the value of a signal that scales forces, by its number; 1 for -1. */
double fu_scale_at(const fu_model *model, int signal, double t);
int fu_supports_move(const fu_model *model, const fu_state *state);
void fu_prescribe(const fu_model *model, fu_state *state);

#endif
