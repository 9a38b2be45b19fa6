/* Integrators: what the time loop knows of one, and how it gets its work space. Their list is integrators/list.c. */
#ifndef FUNICULAR_EQUATIONS_INTEGRATOR_H
#define FUNICULAR_EQUATIONS_INTEGRATOR_H

#include "equations/newton.h"

/* The rule by which a step's velocities follow from forces: weights b at parts c of the step, n of them. */
typedef struct {
    int n;
    const double *b, *c;
} fu_quadrature;

/* A way through time. Its parameters are the numbers run->parameters, in the order of the class of its name in the
 * package funicular.integrators; its work space is run->scratch, which nothing else reads. */
typedef struct {
    const char *name;
    /* Returns how many parameters it takes, of which the first is given. */
    long (*n_parameters)(const double *parameters);
    /* Returns how many doubles of work space it takes for the model of a run. */
    long (*n_scratch)(const fu_run *run);
    /* Returns how many numbers of algorithmic dissipation a state keeps; null: none. */
    long (*n_dissipation_state)(const fu_run *run);
    /* Begins at `now`, which has consistent velocities, accelerations and forces; returns a status. */
    int (*start)(fu_run *run);
    /* Makes `next` from `now`; returns 0, or not 0 where that failed. */
    int (*step)(fu_run *run, double h);
    /* Returns the local error of positions of the step just made, m. */
    double (*error)(fu_run *run, double h);
    /* Returns the rule by which forces of a step count; null: steps of which the error is controlled end on each
     * passage. */
    fu_quadrature (*quadrature)(const fu_run *run);
    /* Adds what the step just accepted has dissipated and got from outside. */
    void (*account)(fu_run *run, double h);
    /* Drops what it keeps from step to step in its work space, as at a pause; null: nothing. */
    void (*forget)(fu_run *run);
    int keeps_scratch; /* checkpoints hold its work space, which is real numbers alone */
    int keeps_energy;  /* velocities stay as they are where it starts anew: to project them would cost energy */
    int coasts;        /* nothing of a very short step is in what it goes on with: it is not started anew after one */
    int has_matrix;    /* run->newton has the mass and the stiffness of a step, times its square */
    int crosses_boundaries;  /* it finds the slides' elements within a step, which may go over boundaries of elements */
    const fu_newton *newton; /* of implicit steps with constraints on positions; null where eq 38 gives accelerations */
} fu_integrator;

#endif
