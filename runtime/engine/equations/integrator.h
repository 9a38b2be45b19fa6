/* Integrators: their interface to the time loop, and their work space. Their list is integrators/list.c. */
#ifndef FUNICULAR_EQUATIONS_INTEGRATOR_H
#define FUNICULAR_EQUATIONS_INTEGRATOR_H

#include "equations/newton.h"

/* The rule for velocities of a step from forces: n weights b at parts c of the step. */
typedef struct {
    int n;
    const double *b, *c;
} fu_quadrature;

/* An integrator. Its parameters are the numbers run->parameters, in the order of the class of its name in the package
 * funicular.integrators; its work space is run->scratch, which nothing else reads. */
typedef struct {
    const char *name;
    /* Returns the number of its parameters; the first one is given. */
    long (*n_parameters)(const double *parameters);
    /* Returns the doubles of work space for the model of a run. */
    long (*n_scratch)(const fu_run *run);
    /* Returns the numbers of algorithmic dissipation in a state; null: none. */
    long (*n_dissipation_state)(const fu_run *run);
    /* Starts at `now`, with consistent velocities, accelerations and forces; returns a status. */
    int (*start)(fu_run *run);
    /* Computes `next` from `now`; returns 0, or nonzero on failure. */
    int (*step)(fu_run *run, double h);
    /* Returns the local error of positions of the last step, m. */
    double (*error)(fu_run *run, double h);
    /* Returns the quadrature of a step's forces; null: steps with error control end on each deferred event. */
    fu_quadrature (*quadrature)(const fu_run *run);
    /* Adds dissipation and external work of the last accepted step. */
    void (*account)(fu_run *run, double h);
    /* Drops data kept from step to step in its work space, as at a pause; null: none. */
    void (*forget)(fu_run *run);
    /* Computes accelerations and forces of supports of a row, its forces and constraints in run->accelerator, and the
     * elastic energy; returns 0 if there is one solution. Null: eq 38, and the energy of the configuration. */
    int (*row)(fu_run *run, double *acceleration, double *reaction, double *elastic);
    int keeps_scratch;       /* checkpoints hold its work space, which is real numbers alone */
    int defers_all;          /* also fixed steps go over deferred events: they have hardly a larger error */
    int keeps_energy;        /* velocities are unchanged by a restart: their projection would cost energy */
    int coasts;              /* a very short step leaves no data to continue with: no restart after one */
    int has_matrix;          /* run->newton has the mass and the stiffness of a step, times its square */
    int crosses_boundaries;  /* finds the slides' elements within a step, which may cross boundaries of elements */
    const fu_newton *newton; /* of implicit steps with constraints on positions; null where eq 38 gives accelerations */
} fu_integrator;

#endif
