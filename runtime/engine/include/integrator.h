/* Integrators: their interface, and the parameters of each. */
#ifndef FUNICULAR_INTEGRATOR_H
#define FUNICULAR_INTEGRATOR_H

#include "linear.h"
#include "newton.h"

typedef struct {
    double alpha_m, alpha_f, beta, gamma;
} fu_genalpha;

/* Explicit Runge-Kutta method with two embedded error estimates. */
typedef struct {
    int stages;
    const double *A, *b, *c;          /* stages x stages, row by row; stages; stages */
    const double *error, *coarse;     /* stages + 1: the last is of the state at the end */
} fu_tableau;

/* Implicit Runge-Kutta method of three stages, stiffly accurate: A^-1 = T L T^-1 with L = gamma beside the block of
 * alpha +- i beta; `error` over the stages' increments, beside gamma0 = 1/gamma times the rate at the start. */
typedef struct {
    double A[9], A_inverse[9], c[3], T[9], T_inverse[9], gamma, alpha, beta, error[3];
} fu_collocation;

/* A complex matrix laid out as an fu_system; real systems of two steps combine to it. */
typedef struct {
    void *K, *B, *C, *D, *X, *x; /* fu_complex (complex_number.h); x: right side and solution */
    double *D_real;              /* the real system's border before it was factored */
    int n_columns;
    fu_piece *columns;           /* of X; those of C are the real system's */
    int *pivot_band, *pivot_border;
} fu_complex_system;

/* A way through time. `now` has consistent v, accelerations and forces when `start` is called; `step` makes `next` from
 * it and is not zero where that failed; `error` is the local error of positions of the step just made, m; `book` adds
 * what that step, now accepted, has dissipated and got from outside. */
typedef struct {
    const char *name;
    int (*start)(fu_run *run);
    int (*step)(fu_run *run, double h);
    double (*error)(fu_run *run, double h);
    void (*book)(fu_run *run, double h);
    int conserves; /* energy: velocities stay as they are where the scheme starts anew, projecting them would cost some */
    int straddles; /* steps may go over boundaries of elements: the slides' elements are found within the iteration */
    const fu_newton *newton; /* null where there is none */
} fu_integrator;
extern const fu_integrator fu_genalpha_method, fu_explicit_method, fu_energy_method, fu_radau_method;

#endif
