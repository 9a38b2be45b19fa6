/* Springs and dampers: couplings/springs.c. */
#ifndef FUNICULAR_SPRINGS_H
#define FUNICULAR_SPRINGS_H

#include "point_force.h"

typedef struct {
    fu_point_force between;
    double stiffness, damping, length; /* N/m, N s/m, m */
} fu_spring;

extern const fu_coupling_type fu_spring_type;

#endif
