/* The parameters of the generalised-alpha scheme, which the equations of a scene and the linear model share. */
#ifndef FUNICULAR_INTEGRATORS_GENERALISED_ALPHA_H
#define FUNICULAR_INTEGRATORS_GENERALISED_ALPHA_H

#include "base/workspace.h"
#include "equations/run.h"
#include "events/events.h"

#include <math.h>

#define FU_MEAN_JUMP_DISTANCE 0.25 /* of a step: mean distance of a discontinuity from its middle */

typedef struct {
    double alpha_m, alpha_f, beta, gamma;
} fu_alpha_scheme;
_Static_assert(sizeof(fu_alpha_scheme) == 4 * sizeof(double), "parameters are an array of doubles");

static inline const fu_alpha_scheme *fu_alpha_scheme_of(const fu_run *run)
{
    return (const fu_alpha_scheme *)run->parameters;
}

static inline long fu_alpha_parameters(const double *given)
{
    (void)given;
    return FU_DOUBLES(1, fu_alpha_scheme);
}

/* Returns the factor of the stiffness in the matrix of a step, s^2. */
static inline double fu_alpha_sigma(const fu_alpha_scheme *g, double h)
{
    return g->beta * h * h * (1.0 - g->alpha_f) / (1.0 - g->alpha_m);
}

/* Returns the factor of the change of accelerations in the local error of positions of a step, over h^2:
 * |beta + (alpha_m - alpha_f)/2 - 1/6| of a smooth one. If a slide has changed its element the accelerations are
 * discontinuous at some instant of the step, and velocities have an error of the jump times the time between it and the
 * middle. That counts as over one step: the permitted error is h/t of the whole. */
static inline double fu_alpha_error_factor(const fu_run *run)
{
    const fu_alpha_scheme *g = fu_alpha_scheme_of(run);
    if (fu_count_changes(run)) return FU_MEAN_JUMP_DISTANCE;
    return fabs(g->beta + 0.5 * (g->alpha_m - g->alpha_f) - 1.0 / 6.0);
}

/* Deferred events do not need the change of the trapezoidal rule by the spectral radius. */
static inline fu_quadrature fu_alpha_quadrature(const fu_run *run)
{
    static const double b[] = {0.5, 0.5}, c[] = {0.0, 1.0};
    (void)run;
    return (fu_quadrature){2, b, c};
}

#endif
