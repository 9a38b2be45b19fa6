/* The energy balance of a run: equations/energy_balance.c. */
#ifndef FUNICULAR_EQUATIONS_ENERGY_BALANCE_H
#define FUNICULAR_EQUATIONS_ENERGY_BALANCE_H

#include "base/common.h"

/* The energy balance since the start, J: energies then, the most exchanged between them and in motion, the largest
 * unexplained growth and loss, and their rounding. */
#define FU_ENERGIES 5
typedef struct {
    double first[FU_ENERGIES], exchanged, in_motion, grown, lost, rounding;
} fu_energy_balance;

double fu_dissipated_power(const fu_run *run, const fu_state *state);
double fu_external_power(fu_run *run, const fu_state *state, const double *reaction);
void fu_account_trapezoid(fu_run *run, double h);
void fu_impact(fu_run *run, const double *change, double restitution);
void fu_take_jump(fu_run *run, const double *change, double lost);
int fu_moves(const fu_run *run);
int fu_check_energy_balance(fu_run *run, const double energies[FU_ENERGIES], int first);

#endif
