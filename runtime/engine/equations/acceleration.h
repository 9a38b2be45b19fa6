/* Accelerations by eq 38: run/acceleration.c. */
#ifndef FUNICULAR_ACCELERATION_H
#define FUNICULAR_ACCELERATION_H

#include "constraints.h"
#include "linear.h"
#include "coupling.h"

/* Eq 38 and what comes out of it */
struct fu_accelerator {
    fu_system mass;   /* [M H'; H 0], its band factored once */
    double *corner;   /* D of M, before constraints are added and it is factored */
    double *rhs;      /* unknowns, and FU_BAND_BEYOND */
    fu_rows *rows;    /* of the couplings that have constraints */
    double *scratch;  /* of couplings, from `scratch` of each on: what its type keeps from rows to outputs */
    double *force, *work, *prescribed; /* n_dof */
    double *multipliers; /* as eq 38 gives them */
    int self_locking;       /* coupling whose reaction to the multipliers was not found, by its number; -1 */
    long evaluated;   /* how often it was */
};
int fu_accelerator_prepare(const fu_model *model, fu_accelerator *work);
int fu_accelerations(const fu_model *model, const fu_state *state, fu_accelerator *work, double *acceleration,
                     double *reaction);
int fu_compliance(const fu_model *model, const fu_state *state, fu_accelerator *work, const int *at, int n, double *S);
int fu_project_positions(const fu_model *model, const fu_state *state, fu_accelerator *work, double *change);
int fu_project_velocities(const fu_model *model, const fu_state *state, fu_accelerator *work, double *change);
int fu_prepare_response(const fu_model *model, const fu_state *state, fu_accelerator *work);
void fu_response(const fu_model *model, fu_accelerator *work, const double *force, double *change);
int fu_strike(const fu_model *model, const fu_state *state, fu_accelerator *work, int row, int constraint,
              double rate, double *change);

#endif
