/* Loads: couplings/force/loads.c. */
#ifndef FUNICULAR_COUPLINGS_FORCE_LOADS_H
#define FUNICULAR_COUPLINGS_FORCE_LOADS_H

#include "bodies/bodies.h"
#include "couplings/common/coupling.h"

/* A force of constant direction in the dofs: values on n dofs, times a signal (-1: one). */
typedef struct {
    fu_coupling base;
    int signal, n;
    const int *dofs;
    const double *values;
} fu_dead_load;
extern const fu_coupling_type fu_dead_load_type;

/* A load that turns with what it acts on, or whose lever does: at x of a cable's element, at the point u of a body, at
 * that of a modal one. */
enum { FU_CABLE_FOLLOWER, FU_CABLE_MOMENT, FU_BODY_FORCE, FU_BODY_FOLLOWER, FU_BODY_MOMENT };
typedef struct {
    fu_coupling base;
    int kind, signal, on; /* `on`: the cable or the body */
    int element;
    double x, u[3], c[3]; /* c: components, N or N m */
    fu_modal_attachment modal;
} fu_load;
extern const fu_coupling_type fu_load_type;

void fu_external_forces(const fu_model *model, double t, const double *q, double *f);

#endif
