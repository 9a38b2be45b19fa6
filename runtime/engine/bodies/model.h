/* The model.
 *
 * Coordinates: q is the configuration, for each cable its nodal vectors node by node, then for each body position
 * and attitude (unit quaternion; in the plane unit complex number) and, of a modal one, the coordinates of its
 * modes. v, accelerations and increments have one entry a degree of freedom (dof): the cables' as in q, then the
 * bodies' (translation; rotation about body axes; modes).
 *
 * Unknowns of a linear system: the free coordinates of the cables ("band"), then the border: those of nodes where
 * cables meet, if that is cheaper (model/numbering.py), those of the bodies, then those of each joint and spring.
 * Supports make dofs linear in the unknowns, dofs = T unknowns + prescribed values; unknown_of_dof[dof] is the
 * number of the unknown that the dof is, -1 if it is fixed or prescribed, -2 - k if it is the k-th combination of
 * unknowns (bodies/unknowns.c).
 *
 * Every array belongs to the caller; nothing here allocates. */
#ifndef FUNICULAR_BODIES_MODEL_H
#define FUNICULAR_BODIES_MODEL_H

#include "bodies/bodies.h"
#include "bodies/cables.h"
#include "linear/linear.h"
#include "bodies/motions.h"

struct fu_model {
    int dim, n_cables, n_bodies, n_couplings, n_motions;
    const fu_cable *cables;
    const fu_body *bodies;
    const fu_slide *slides;              /* slides among the couplings, one after the other; null if there are none */
    const fu_coupling *const *couplings; /* all of them: loads, slides, joints, springs */
    /* Couplings that are more than a contact (fu_acts_alone); couplings with a history over steps. */
    const fu_coupling **always_active, **with_history;
    int n_always_active, n_with_history, n_pairs; /* n_pairs: couplings with a clearance */
    fu_proximity *proximity;                      /* which of these are far; null: unknown */
    const fu_motion *motions;
    const fu_signal *signals;
    int n_q, n_dof, n_band, n_border_dof;
    /* Sums over the couplings: internal coordinates and forces, sets of constraint rows, numbers in a row of output,
     * numbers and flags in a state, work space; numbers of those that depend on reactions, have external work, are
     * driven, are damped, may have deferred events, have inertia. */
    int n_coordinates, n_forces, n_rows, n_outputs, n_numbers, n_flags, n_scratch, n_needing_reactions, n_external,
        n_driven, n_damped, n_deferring, n_inertial;
    int n_dissipation_state;    /* zero without algorithmic dissipation */
    int n_extra, n_multipliers; /* unknowns of couplings in a Newton system, and in eq 38 */
    const int *unknown_of_dof;
    const int *combination_start, *combination_unknown; /* combinations, row by row */
    const double *combination_value;
    const double *weight;  /* displacement of a point by a unit of each dof, m: makes norms of increments lengths */
    const double *gravity; /* generalised force on each dof */
    const double *zero;    /* n_dof zeros: a velocity at rest */
    double load_fraction;  /* share of all loads but gravity: 1, or less on a load path of statics */
    /* in statics, of ropes that are about to slide on their sheaves: the speed in their order over the slip velocity */
    double impending;
    int vibrates; /* in statics: whether tangents are those of small vibrations about the state */
    const fu_lapack *lapack;
    fu_threads *threads; /* null for one thread, which needs nothing of the following */
    /* n_coordinates^2 for each element of the longest cable: contributions of threads that are added afterwards */
    double *thread_work;
    const int
        *is_shared; /* of each dof: others are the same unknown, it is a combination, or its unknown is in the border */
    const int *shared_dofs, *shared_unknowns; /* the numbers of these, and of their unknowns */
    int n_shared_dofs, n_shared_unknowns;
};

/* Returns the dofs between those of the cables and those of the bodies, which are entries of q as those of cables: of
 * ropes, their nodes, material coordinates, and rotations of sheaves. */
static inline fu_range fu_rope_dofs(const fu_model *model)
{
    const fu_cable *last = model->n_cables ? &model->cables[model->n_cables - 1] : 0;
    return (fu_range){last ? fu_cable_end(last) : 0, model->n_bodies ? model->bodies[0].dof : model->n_dof};
}

/* Loops over the cables and over the bodies of a model. */
#define FU_EACH_CABLE(cable, model)                                                                                    \
    for (const fu_cable *cable = (model)->cables; cable - (model)->cables < (model)->n_cables; ++cable)
#define FU_EACH_BODY(body, model)                                                                                      \
    for (const fu_body *body = (model)->bodies; body - (model)->bodies < (model)->n_bodies; ++body)

#endif
