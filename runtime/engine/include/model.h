/* The model: what is integrated. */
#ifndef FUNICULAR_MODEL_H
#define FUNICULAR_MODEL_H

#include "bodies.h"
#include "cables.h"
#include "joints.h"
#include "linear.h"
#include "loads.h"
#include "motions.h"
#include "slides.h"
#include "springs.h"

struct fu_model {
    int dim, n_cables, n_bodies, n_slides, n_joints, n_springs, n_motions, n_dead_loads, n_loads;
    const fu_cable *cables;
    const fu_body *bodies;
    const fu_slide *slides;
    const fu_joint *joints;
    const fu_spring *springs;
    const fu_motion *motions;
    const fu_dead_load *dead_loads;
    const fu_load *loads;
    const fu_signal *signals;
    int n_q, n_dof, n_band, n_border_dof;
    int n_resistances; /* slides that have one */
    int n_memory; /* zero without algorithmic dissipation */
    int n_extra, n_multipliers; /* unknowns of slides, joints and springs in a Newton system, of the former in eq 38 */
    const int *place;
    const int *combination_start, *combination_place; /* combinations, row by row */
    const double *combination_value;
    const double *weight;  /* length that a unit of each dof moves a point by: makes norms of increments metres */
    const double *gravity; /* generalised force on each dof */
    const double *zero;    /* n_dof zeros: a velocity at rest */
    const int *dead_dof;
    const double *dead_value;
    const fu_lapack *lapack;
    int threads;   /* over elements */
    double *parts; /* what a cable's elements give, with more than one: forces or tangents */
};

#endif
