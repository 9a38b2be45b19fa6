/* Drag and buoyancy in a fluid that moves: couplings/drags.c. */
#ifndef FUNICULAR_DRAGS_H
#define FUNICULAR_DRAGS_H

#include "attachments.h"
#include "coupling.h"

/* How the velocity of a fluid changes with height: not at all; as a power of it; as a table. */
enum { FU_UNIFORM, FU_POWER, FU_TABLE };

/* The velocity of a fluid: `velocity` times a signal (-1: one) times the profile at the height base + up . r. */
typedef struct {
    double velocity[3], up[3], base; /* base: height of the origin, m */
    int signal, profile;
    double reference, exponent, least; /* of a power: (max(height, least)/reference)^exponent, heights in m */
    int n_pieces;                      /* of a table: polynomials of the height, as a signal's of time */
    const double *breaks, *coefficients;
} fu_flow;

/* The force of a fluid on a whole cable, or on a point of a body. */
typedef struct {
    fu_coupling base;
    const fu_drag_kernels *kernel;
    fu_flow flow;
    int cable;                 /* -1: on a body, at its attachment */
    double coefficients[3];    /* as the kernel takes them */
    double buoyancy[3];        /* N/m a length of the undeformed cable, N on a body */
    int n_points;              /* of quadrature on an element: weights in m, shape functions, their slopes, */
    int stride;                /* each of the first element; points from one element's to the next's: 0 where they are equal */
    const double *weights, *N, *N_x;
    fu_attachment attachments[1];
} fu_drag;
extern const fu_coupling_type fu_drag_type;

#endif
