/* What goes in and out of a scene's energy from outside and to heat. */
#include "couplings/common/couplings.h"
#include "equations/acceleration.h"
#include "equations/energies.h"
#include "equations/projection.h"
#include "equations/run.h"

#include <math.h>

#define MOST_GROWTH 0.5          /* of the energy exchanged, or of motion: beyond it the result is none */
#define BEGUN 1e-4               /* of the size of the scene: with less motion it has not begun */
#define LEAST_MOTION 1e-10       /* of the largest coordinate: less is what step control and rounding leave of rest */
#define ROUNDING_OF_ENERGY 1e-14 /* of the energies: what a sum over many elements may be off by */

/* Returns the power of what drives constraints, by the multipliers that eq 38 left, W. */
static double driving_power(const fu_run *run)
{
    const fu_accelerator *work = &run->accelerator;
    const fu_rows *end = work->rows + run->model->n_rows;
    double power = 0.0;
    for (const fu_rows *rows = work->rows; rows < end; ++rows)
        for (int c = 0; c < rows->rows; ++c) power += work->multipliers[rows->first + c] * rows->rate[c];
    for (const fu_rows *rows = work->rows; rows < end; ++rows) power -= rows->opposed;
    return power;
}

/* Returns the power that goes to heat at a state, W: in friction by the forces that a Newton method solves for, else by
 * those of eq 38. */
double fu_dissipated_power(const fu_run *run, const fu_state *state)
{
    return fu_dissipation(run->model, state, run->integrator->newton ? 0 : &run->accelerator);
}

/* Returns the power of the loads; of what drives constraints, by the last call of fu_accelerations; and of the motions,
 * with the forces that the supports give, which are not looked at where no support moves, W. */
double fu_external_power(fu_run *run, const fu_state *state, const double *reaction)
{
    const fu_model *model = run->model;
    double power = (model->n_driven ? driving_power(run) : 0.0) + fu_coupling_external_power(model, state);
    if (model->n_external) {
        for (int i = 0; i < model->n_dof; ++i) run->work[i] = 0.0;
        fu_coupling_external_forces(model, state->t, state->q, run->work);
        for (int i = 0; i < model->n_dof; ++i) power -= run->work[i] * state->v[i];
    }
    for (int k = 0; k < model->n_motions; ++k) {
        const int i = model->motions[k].dof;
        if (model->motions[k].first && state->v[i] != 0.0) power += reaction[i] * state->v[i];
    }
    return power;
}

/* Returns what drives give in the step just made beyond the trapezoidal rule, J. Their power is by the force of eq 38,
 * as it is reported, since the multipliers that Newton's method finds are off by h^2 of it. The error of the rule is
 * -h^3/12 of the second derivative of the power, which three instants tell. A very short step, as to an event, joins
 * the interval before it: over so short a time Newton's remainder would rule the rate of the power. */
static double beyond_trapezoid(fu_run *run, double h)
{
    const double power = driving_power(run);
    double beyond = 0.0;
    if (run->drive_step >= 0.0 && fu_is_short(run, h)) {
        run->drive_power = power;
        if (run->drive_step > 0.0) run->drive_step += h;
        return 0.0;
    }
    if (run->drive_step > 0.0) {
        const double slope = (power - run->drive_power) / h;
        const double before = (run->drive_power - run->drive_power_before) / run->drive_step;
        beyond = -h * h * h / 6.0 * (slope - before) / (h + run->drive_step);
    }
    run->drive_power_before = run->drive_power;
    run->drive_power = power;
    run->drive_step = run->drive_step < 0.0 ? 0.0 : h;
    return beyond;
}

/* Adds the step just made to the balance by the trapezoidal rule, as good as a method of order 2; what drives give,
 * better. */
void fu_account_trapezoid(fu_run *run, double h)
{
    const int driven = run->model->n_driven > 0;
    if (driven) fu_accelerations(run->model, &run->next, &run->accelerator, run->work, 0);
    const double dissipated = fu_dissipated_power(run, &run->next);
    const double external = fu_external_power(run, &run->next, run->force);
    run->dissipated += 0.5 * h * (run->dissipated_power + dissipated);
    run->external += 0.5 * h * (run->external_power + external);
    if (driven) run->external += beyond_trapezoid(run, h);
    run->dissipated_power = dissipated;
    run->external_power = external;
}

/* Changes the velocities of `now` by a jump M change = H' L, of which impacts take the energy `lost`, J. The impulses
 * of what drives the scene, and of a fluid that moves, have done the rest. */
void fu_take_jump(fu_run *run, const double *change, double lost)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    const double before = fu_kinetic_energy(model, now->t, now->q, now->v);
    for (int i = 0; i < model->n_dof; ++i) now->v[i] += change[i];
    run->dissipated += lost;
    if (model->n_driven || model->n_motions || model->n_inertial)
        run->external += fu_kinetic_energy(model, now->t, now->q, now->v) - before + lost;
}

/* Changes the velocities of `now` by an impact, so that constraints hold that they broke. What is lost is (1 - e)/(1 +
 * e) of the kinetic energy of the change (Carnot), with the restitution e of the constraint that was broken. */
void fu_impact(fu_run *run, const double *change, double restitution)
{
    const double of_change = fu_kinetic_energy_of_change(run->model, run->now.q, change);
    fu_take_jump(run, change, (1.0 - restitution) / (1.0 + restitution) * of_change);
}

/* Returns whether anything moves beyond what step control and rounding leave of a scene at rest. */
int fu_moves(const fu_run *run)
{
    return run->motion > LEAST_MOTION * run->extent;
}

/* Returns what rounding may make of the sum of the energies, J, that of coordinates far from the origin under gravity
 * included. */
static double rounding(const fu_run *run, const double energies[FU_ENERGIES])
{
    double sum = 0.0, weight = 0.0;
    for (int k = 0; k < FU_ENERGIES; ++k) sum += fabs(energies[k]);
    for (int i = 0; i < run->model->n_dof; ++i) weight += fabs(run->model->gravity[i]);
    return ROUNDING_OF_ENERGY * (sum + weight * run->extent);
}

/* Compares the energies at an output with the first: kinetic, elastic, potential, dissipated, and minus external
 * energy. Returns not zero where energy has come from nowhere, as where an explicit method's step is beyond its limit.
 */
int fu_check_energy_balance(fu_run *run, const double energies[FU_ENERGIES], int first)
{
    fu_energy_balance *balance = &run->balance;
    double grown = 0.0, changes = 0.0;
    for (int k = 0; k < FU_ENERGIES; ++k) {
        if (first) balance->first[k] = energies[k];
        grown += energies[k] - balance->first[k];
        changes += fabs(energies[k] - balance->first[k]);
    }
    balance->exchanged = fmax(balance->exchanged, 0.5 * changes);
    balance->in_motion = fmax(balance->in_motion, energies[0]);
    balance->rounding = fmax(balance->rounding, rounding(run, energies));
    balance->grown = fmax(balance->grown, grown);
    balance->lost = fmax(balance->lost, -grown);
    if (run->motion <= BEGUN * run->size || grown <= MOST_GROWTH * fmax(balance->exchanged, balance->in_motion))
        return 0;
    return fu_fail(run, FU_NO_FAILURE, run->now.v, -1);
}
