/* External work and dissipation of a scene. */
#include "couplings/common/couplings.h"
#include "equations/equations.h"
#include "equations/run.h"

#include <math.h>

#define MAX_ENERGY_GROWTH 0.5    /* of the energy exchanged, or of motion: a larger growth ends the run */
#define MIN_CHECKED_MOTION 1e-4  /* of the size of the scene: a smaller motion has not begun */
#define MIN_MOTION 1e-10         /* of the largest coordinate: motion of a scene at rest by step control and rounding */
#define ROUNDING_OF_ENERGY 1e-14 /* of the energies: rounding of a sum over many elements */

/* Returns the power of driven constraints, by the multipliers of eq 38, W. */
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

/* Returns the dissipated power at a state, W: friction by the forces of a Newton method if it solves for them, else by
 * those of eq 38. */
double fu_dissipated_power(const fu_run *run, const fu_state *state)
{
    return fu_dissipation(run->model, state, run->integrator->newton ? 0 : &run->accelerator);
}

/* Returns the power of the loads; of driven constraints, by the last call of fu_accelerations; and of motions, with the
 * forces of the supports, which are not read unless a support moves, W. */
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

/* Returns the work of drives in the last step beyond the trapezoidal rule, J. Their power is by the force of eq 38, as
 * reported, since the multipliers of Newton's method have a relative error of h^2. The error of the rule is -h^3/12 of
 * the second derivative of the power, which three instants determine. A very short step, as to an event, joins the
 * interval before it: over so short a time Newton's residual would dominate the rate of the power. */
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

/* Adds the last step to the balance by the trapezoidal rule, sufficient for a method of order 2; the work of drives has
 * a higher order. */
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

/* Changes the velocities of `now` by a jump M change = H' L, in which impacts dissipate the energy `lost`, J. The rest
 * of the energy change is work of the drives' impulses and of a moving fluid. */
void fu_take_jump(fu_run *run, const double *change, double lost)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    const double before = fu_kinetic_energy_at(model, now);
    for (int i = 0; i < model->n_dof; ++i) now->v[i] += change[i];
    fu_history_jump(model, now, change);
    run->dissipated += lost;
    if (model->n_driven || model->n_motions || model->n_inertial)
        run->external += fu_kinetic_energy_at(model, now) - before + lost;
}

/* Changes the velocities of `now` by an impact, so that the violated constraints hold. The loss is (1 - e)/(1 + e) of
 * the kinetic energy of the change (Carnot), with the restitution e of the violated constraint. */
void fu_impact(fu_run *run, const double *change, double restitution)
{
    const double of_change = fu_kinetic_energy_of_change(run->model, run->now.t, run->now.q, change);
    fu_take_jump(run, change, (1.0 - restitution) / (1.0 + restitution) * of_change);
}

/* Returns whether the motion exceeds that of a scene at rest by step control and rounding. */
int fu_moves(const fu_run *run)
{
    return run->motion > MIN_MOTION * run->extent;
}

/* Returns the rounding of the sum of the energies, J, including that of coordinates far from the origin under
 * gravity. */
static double rounding(const fu_run *run, const double energies[FU_ENERGIES])
{
    double sum = 0.0, weight = 0.0;
    for (int k = 0; k < FU_ENERGIES; ++k) sum += fabs(energies[k]);
    for (int i = 0; i < run->model->n_dof; ++i) weight += fabs(run->model->gravity[i]);
    return ROUNDING_OF_ENERGY * (sum + weight * run->extent);
}

/* Compares the energies at an output with the first: kinetic, elastic, potential, dissipated, and minus external
 * energy. Returns nonzero for unexplained growth, as of an explicit method beyond its stability limit. */
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
    if (run->motion <= MIN_CHECKED_MOTION * run->size ||
        grown <= MAX_ENERGY_GROWTH * fmax(balance->exchanged, balance->in_motion))
        return 0;
    return fu_fail(run, FU_NO_FAILURE, run->now.v, -1);
}
