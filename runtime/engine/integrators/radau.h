/* Declarations of the integrator Radau IIA: integrators/radau.c, radau_stages.c, radau_newton.c, radau_error.c, its
 * only users. */
#ifndef FUNICULAR_INTEGRATORS_RADAU_H
#define FUNICULAR_INTEGRATORS_RADAU_H

#include "linear/complex_system.h"
#include "equations/run.h"
#include "base/workspace.h"

enum { STAGES = 3 };

/* A^-1 = T L T^-1 with L = gamma beside the block of alpha +- i beta; the error's weights stand over the stages'
 * increments, beside gamma0 = 1/gamma times the rate at the start. */
typedef struct {
    double A[STAGES * STAGES], A_inverse[STAGES * STAGES], c[STAGES], T[STAGES * STAGES], T_inverse[STAGES * STAGES];
    double gamma, alpha, beta, error[STAGES];
} fu_radau_parameters;
_Static_assert(sizeof(fu_radau_parameters) == (4 * STAGES * STAGES + 2 * STAGES + 3) * sizeof(double),
               "parameters are an array of doubles");

/* The head of the integrator's work space, and the arrays behind it. */
typedef struct {
    double *Z;              /* stages' increments of velocity, n_dof each */
    double *a;              /* accelerations: likewise */
    double *w;              /* their transforms: likewise */
    double *q;              /* configurations, n_q each */
    double *powers;         /* dissipated and external, of each stage */
    double *multipliers;    /* of eq 38 at the start and at each stage, if forces depend on them */
    double *unknowns;       /* of a Newton system */
    double *D_real;         /* the real system's border before it was factored */
    double *border_product; /* products of the border's rows with dofs */
    double *last;           /* the last step's Z */
    double h_last;          /* its size, s; 0 without a last step */
    fu_complex_system newton;
} fu_radau_workspace;

/* The parameters and the work space of a run. */
static inline const fu_radau_parameters *fu_radau_method(const fu_run *run)
{
    return (const fu_radau_parameters *)run->parameters;
}

static inline fu_radau_workspace *fu_radau_space(const fu_run *run)
{
    return (fu_radau_workspace *)run->scratch;
}

/* radau_stages.c. Predicts the stages by the last step's polynomial, by the present acceleration, or by the present
 * velocity. */
typedef enum { FU_BY_LAST_STEP, FU_BY_ACCELERATION, FU_BY_VELOCITY } fu_radau_prediction;
void fu_radau_predict(fu_run *run, fu_radau_workspace *w, double h, fu_radau_prediction prediction);
/* Moves the dofs of all stages by the quadrature of velocities. */
void fu_radau_configure(fu_run *run, fu_radau_workspace *w, double h);
/* Computes `next` as stage k, without accelerations; returns 0 if its slides converged. */
int fu_radau_place_stage(fu_run *run, fu_radau_workspace *w, int k, double h);
/* Computes the accelerations of all stages, and the powers of their couplings and loads; returns 0 on success. */
int fu_radau_evaluate(fu_run *run, fu_radau_workspace *w, double h);
/* Adds the dissipation of cables and bodies to the powers of the stages after the iteration; `next` is the last of them
 * then. */
void fu_radau_add_internal_dissipation(fu_run *run, fu_radau_workspace *w, double h);
/* Stores the multipliers of the last solution of eq 38 as those of stage k. */
void fu_radau_keep_multipliers(fu_run *run, fu_radau_workspace *w, int k);
/* Adds the powers of the stages to the energy balance, and stores the stages for the next prediction. */
void fu_radau_account(fu_run *run, double h);

/* radau_newton.c. Computes and factors the real and the complex matrix at `now`; returns 0, or nonzero if one is
 * singular. */
int fu_radau_factor(fu_run *run, double h);
/* Computes run->rhs = [M r; H r] of dofs r consistent with the supports; unknowns: work space. */
void fu_radau_right_side(fu_run *run, const double *r, double *unknowns);
/* Computes one Newton correction of the stages; returns its size as a length. */
double fu_radau_correct(fu_run *run, fu_radau_workspace *w, double h);

/* radau_error.c. Returns the local error of positions of the last step, m. */
double fu_radau_error(fu_run *run, double h);

#endif
