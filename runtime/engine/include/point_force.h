/* Forces between two points: couplings/point_force.c. */
#ifndef FUNICULAR_POINT_FORCE_H
#define FUNICULAR_POINT_FORCE_H

#include "attachments.h"
#include "coupling.h"

/* A force between the points of two attachments, by a law and its parameters. */
typedef struct {
    fu_coupling base;
    const fu_point_law_kernels *law;
    const double *parameters;
    fu_attachment attachments[2];
    int dim;
} fu_point_force;

extern const fu_coupling_type fu_point_force_type;

#endif
