/* The parameters of the generalised-alpha scheme, which the equations of a scene and the linear model share. */
#ifndef FUNICULAR_INTEGRATORS_GENERALISED_ALPHA_H
#define FUNICULAR_INTEGRATORS_GENERALISED_ALPHA_H

#include "base/workspace.h"
#include "equations/run.h"

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

#endif
