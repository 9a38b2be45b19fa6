/* Loads: couplings/force/loads.c. */
#ifndef FUNICULAR_COUPLINGS_FORCE_LOADS_H
#define FUNICULAR_COUPLINGS_FORCE_LOADS_H

#include "couplings/common/attachments.h"
#include "couplings/common/coupling.h"

/* A force of constant direction in the dofs: values on n dofs, times a signal (-1: one). */
typedef struct {
    fu_coupling base;
    int signal, n;
    const int *dofs;
    const double *values;
} fu_dead_load;
extern const fu_coupling_type fu_dead_load_type;

/* A load that rotates with its carrier, or whose lever does: at x of a cable's element, or at a point of a body. */
enum { FU_CABLE_FOLLOWER, FU_CABLE_MOMENT, FU_BODY_FORCE, FU_BODY_FOLLOWER, FU_BODY_MOMENT };
typedef struct {
    fu_coupling base;
    int kind, signal;
    fu_attachment on;
    double x, c[3]; /* c: components, N or N m */
} fu_load;
extern const fu_coupling_type fu_load_type;

void fu_external_forces(const fu_model *model, double t, const double *q, double *f);

#endif
