/* The parameters of the generalised-alpha scheme, which the equations of a scene and the linear model share. */
#ifndef FUNICULAR_INTEGRATORS_GENERALISED_ALPHA_H
#define FUNICULAR_INTEGRATORS_GENERALISED_ALPHA_H

#include "base/workspace.h"
#include "equations/run.h"

#include <math.h>

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

/* Returns the factor of the change of accelerations in the local error of positions of a smooth step, over h^2. */
static inline double fu_alpha_error_factor(const fu_alpha_scheme *g)
{
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
