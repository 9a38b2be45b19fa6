/* Loops over the couplings of a model, in the order of its list, each for one operation. */
#include "couplings/common/couplings.h"
#include "couplings/common/proximity.h"
#include "couplings/slide/slide.h"

#include <math.h>

const fu_field fu_coupling_fields[] = {
    FU_FIELD(fu_coupling, unknown, FU_INTEGER, 0),         FU_FIELD(fu_coupling, n_coordinates, FU_INTEGER, 0),
    FU_FIELD(fu_coupling, n_forces, FU_INTEGER, 0),        FU_FIELD(fu_coupling, n_multipliers, FU_INTEGER, 0),
    FU_FIELD(fu_coupling, multiplier, FU_INTEGER, 0),      FU_FIELD(fu_coupling, n_numbers, FU_INTEGER, 0),
    FU_FIELD(fu_coupling, needs_reactions, FU_INTEGER, 0), FU_FIELD(fu_coupling, is_damped, FU_INTEGER, 0),
    FU_FIELD(fu_coupling, is_driven, FU_INTEGER, 0),       FU_FIELD(fu_coupling, has_inertia, FU_INTEGER, 0),
    FU_FIELD_ARRAY(fu_coupling, scale, FU_REAL),           {0},
};

/* Adds a coupling to its lists. */
static void list_coupling(fu_model *model, const fu_coupling *c)
{
    const int alone = fu_acts_alone(c);
    model->n_pairs += c->type->proximity != 0;
    if (!alone) model->always_active[model->n_always_active++] = c;
    if (c->type->history && (!alone || c->n_numbers)) model->with_history[model->n_with_history++] = c;
}

int fu_n_outputs(const fu_coupling_type *type)
{
    const fu_output *output = type->output_fields;
    while (output && output->name) ++output;
    return output ? output->first : 0;
}

int fu_has_step(const fu_coupling *coupling)
{
    const fu_coupling_type *type = coupling->type;
    return type->step_residual && (!type->has_step || type->has_step(coupling));
}

void fu_number_couplings(fu_coupling *const *couplings, int n, const fu_coupling **lists, fu_model *model)
{
    model->couplings = (const fu_coupling *const *)couplings;
    model->n_couplings = n;
    model->always_active = lists;
    model->with_history = lists + n;
    model->n_always_active = model->n_with_history = model->n_pairs = 0;
    model->slides = 0;
    model->n_coordinates = model->n_forces = model->n_rows = model->n_outputs = 0;
    model->n_numbers = model->n_flags = model->n_scratch = 0;
    model->n_needing_reactions = model->n_external = model->n_driven = model->n_damped = model->n_deferring =
        model->n_inertial = 0;
    for (int k = 0; k < n; ++k) {
        fu_coupling *c = couplings[k];
        c->number = k;
        if (c->type == &fu_slide_type && !model->slides)
            model->slides = (const fu_slide *)c; /* attachments are on them */
        if (c->type->history && c->type->history->size) c->n_numbers = c->type->history->size(c);
        c->coordinate = model->n_coordinates;
        c->force = model->n_forces;
        c->output = model->n_outputs;
        c->numbers = model->n_numbers;
        c->flags = model->n_flags;
        c->scratch = model->n_scratch;
        c->row = c->type->rows ? model->n_rows++ : -1;
        model->n_coordinates += c->n_coordinates;
        model->n_forces += c->n_forces;
        model->n_outputs += fu_n_outputs(c->type);
        model->n_numbers += c->type->n_numbers + c->n_numbers;
        model->n_flags += c->type->n_flags;
        model->n_scratch += c->type->n_scratch;
        model->n_needing_reactions += c->needs_reactions;
        model->n_external += c->type->supply && c->type->supply->force;
        model->n_driven += c->is_driven;
        model->n_damped += c->is_damped;
        model->n_deferring += fu_can_defer(c);
        model->n_inertial += c->has_inertia;
        list_coupling(model, c);
    }
}

void fu_coupling_residuals(const fu_model *model, const fu_equations *at, double *f, double *internal)
{
    const fu_couplings near = fu_acting(model, at->next);
    FU_EACH_COUPLING(c, near.list, near.n)
        if (c->type->residual) c->type->residual(model, c, at, f, internal);
}

void fu_coupling_step_residuals(const fu_model *model, const fu_equations *at, double *f, double *internal)
{
    const fu_couplings near = fu_acting_in_step(model, at);
    FU_EACH_COUPLING(c, near.list, near.n)
        if (c->type->step_residual) c->type->step_residual(model, c, at, f, internal);
}

void fu_coupling_tangents(const fu_model *model, const fu_equations *at, fu_system *system)
{
    const fu_couplings near = fu_acting(model, at->next);
    FU_EACH_COUPLING(c, near.list, near.n)
        if (c->type->tangent) c->type->tangent(model, c, at, system);
}

void fu_coupling_step_tangents(const fu_model *model, const fu_equations *at, fu_system *system)
{
    const fu_couplings near = fu_acting_in_step(model, at);
    FU_EACH_COUPLING(c, near.list, near.n)
        if (c->type->step_tangent) c->type->step_tangent(model, c, at, system);
}

void fu_coupling_inertia(const fu_model *model, double t, const double *q, const double *a, double *f)
{
    FU_EACH_COUPLING(c, model->always_active, model->n_inertial ? model->n_always_active : 0)
        if (c->has_inertia) c->type->inertia->force(model, c, t, q, a, f);
}

/* Adds M a of the couplings whose residuals do not contain it. */
void fu_coupling_inertia_beside_residuals(const fu_model *model, double t, const double *q, const double *a, double *f)
{
    FU_EACH_COUPLING(c, model->always_active, model->n_inertial ? model->n_always_active : 0)
        if (c->has_inertia && !c->type->inertia->in_residual) c->type->inertia->force(model, c, t, q, a, f);
}

void fu_coupling_masses(const fu_model *model, double t, const double *q, double scale, fu_system *system)
{
    FU_EACH_COUPLING(c, model->always_active, model->n_inertial ? model->n_always_active : 0)
        if (c->has_inertia) c->type->inertia->matrix(model, c, t, q, scale, system);
}

double fu_coupling_kinetic_energy(const fu_model *model, double t, const double *q, const double *v, int past_fluid)
{
    double total = 0.0;
    FU_EACH_COUPLING(c, model->always_active, model->n_inertial ? model->n_always_active : 0)
        if (c->has_inertia) total += c->type->inertia->kinetic_energy(model, c, t, q, v, past_fluid);
    return total;
}

double fu_kinetic_energy_beyond_velocities(const fu_model *model, const fu_state *state)
{
    double total = 0.0;
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active)
        if (c->type->inertia && c->type->inertia->beyond_velocities)
            total += c->type->inertia->beyond_velocities(model, c, state);
    return total;
}

double fu_coupling_potential_energy(const fu_model *model, const fu_state *state)
{
    double total = 0.0;
    FU_EACH_COUPLING(c, model->always_active, model->n_inertial ? model->n_always_active : 0)
        if (c->has_inertia && c->type->inertia->potential_energy)
            total += c->type->inertia->potential_energy(model, c, state);
    return total;
}

void fu_coupling_forces(const fu_model *model, const fu_state *state, double *f)
{
    const fu_couplings near = fu_acting(model, state);
    FU_EACH_COUPLING(c, near.list, near.n)
        if (c->type->force) c->type->force(model, c, state, f);
}

void fu_coupling_external_forces(const fu_model *model, double t, const double *q, double *f)
{
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active)
        if (c->type->supply && c->type->supply->force) c->type->supply->force(model, c, t, q, f);
}

double fu_coupling_external_power(const fu_model *model, const fu_state *state)
{
    double total = 0.0;
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active)
        if (c->type->supply && c->type->supply->power) total += c->type->supply->power(model, c, state);
    return total;
}

double fu_coupling_energy(const fu_model *model, const fu_state *state)
{
    const fu_couplings near = fu_acting(model, state);
    double total = 0.0;
    FU_EACH_COUPLING(c, near.list, near.n)
        if (c->type->energy) total += c->type->energy(model, c, state);
    return total;
}

double fu_coupling_dissipation(const fu_model *model, const fu_state *state, const fu_accelerator *work)
{
    const fu_couplings near = fu_acting(model, state);
    double total = 0.0;
    FU_EACH_COUPLING(c, near.list, near.n)
        if (c->type->dissipation) total += c->type->dissipation(model, c, state, work);
    return total;
}

double fu_lost_in_step(const fu_model *model, const fu_state *from, const fu_state *to, int by_ends)
{
    const fu_equations step = {.now = from, .next = to};
    const fu_couplings near = fu_acting_in_step(model, &step);
    double total = 0.0;
    FU_EACH_COUPLING(c, near.list, near.n)
        if (c->type->lost_in_step) total += c->type->lost_in_step(model, c, from, to, by_ends);
    return total;
}

int fu_coupling_quadrature_error(const fu_model *model, const fu_state *from, const fu_state *to, int n,
                                 const double *b, const double *c, double *f)
{
    const fu_equations step = {.now = from, .next = to};
    const fu_couplings near = fu_acting_in_step(model, &step);
    int found = 0;
    FU_EACH_COUPLING(coupling, near.list, near.n)
        if (coupling->type->errors && coupling->type->errors->quadrature)
            found |= coupling->type->errors->quadrature(model, coupling, from, to, n, b, c, f);
    return found;
}

void fu_take_forces(const fu_model *model, const fu_accelerator *work, fu_state *state)
{
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active)
        if (c->type->take_forces) c->type->take_forces(model, c, work, state);
}

void fu_coupling_outputs(const fu_model *model, const fu_state *state, const double *acceleration,
                         const fu_accelerator *work, double *out)
{
    FU_EACH_COUPLING(c, model->couplings, model->n_couplings)
        if (c->type->outputs) c->type->outputs(model, c, state, acceleration, work, out + c->output);
}

/* Computes the row of output of a coupling whose outputs do not depend on accelerations. */
void fu_outputs_at_rest(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *out)
{
    coupling->type->outputs(model, coupling, state, 0, 0, out);
}

void fu_gaps(const fu_model *model, const fu_state *state, double *gaps)
{
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active)
        if (c->type->gaps) c->type->gaps(model, c, state, gaps + c->force);
}

void fu_coordinate_rates(const fu_model *model, const fu_accelerator *work, double *rates)
{
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active)
        if (c->type->coordinates) c->type->coordinates->rates(model, c, work, rates + c->coordinate);
}

void fu_reset(const fu_model *model, fu_state *state)
{
    FU_EACH_COUPLING(c, model->couplings, model->n_couplings)
        if (c->type->start && c->type->start->reset) c->type->start->reset(c, state);
}

double fu_history_error(const fu_model *model, const fu_state *from, const fu_state *to)
{
    double largest = 0.0;
    FU_EACH_COUPLING(c, model->with_history, model->n_with_history)
        if (c->type->history->error) largest = fmax(largest, c->type->history->error(model, c, from, to));
    return largest;
}

void fu_update_history(const fu_model *model, fu_state *state)
{
    FU_EACH_COUPLING(c, model->with_history, model->n_with_history)
        if (c->type->history->update) c->type->history->update(model, c, state);
}

void fu_history_over_step(const fu_model *model, const fu_equations *at)
{
    FU_EACH_COUPLING(c, model->with_history, model->n_with_history)
        if (c->type->history->over_step) c->type->history->over_step(model, c, at);
}

void fu_history_velocities(const fu_model *model, const fu_equations *at, double since)
{
    FU_EACH_COUPLING(c, model->with_history, model->n_with_history)
        if (c->type->history->velocities) c->type->history->velocities(model, c, at, since);
}

void fu_history_jump(const fu_model *model, fu_state *state, const double *change)
{
    FU_EACH_COUPLING(c, model->with_history, model->n_with_history)
        if (c->type->history->jump) c->type->history->jump(model, c, state, change);
}

void fu_detect_contact(const fu_model *model, fu_state *state)
{
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active)
        if (c->type->detect) c->type->detect(model, c, state);
}

/* Solves for dependent coordinates; returns null, or the first coupling without a solution. */
const fu_coupling *fu_solve_coordinates(const fu_model *model, fu_state *state)
{
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active)
        if (c->type->coordinates && c->type->coordinates->solve(model, c, state)) return c;
    return 0;
}

int fu_may_start_open(const fu_model *model, const fu_state *state)
{
    int open = 0;
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active)
        if (c->type->start && c->type->start->may_be_open) open |= c->type->start->may_be_open(model, c, state);
    return open;
}

int fu_is_possible(const fu_model *model, const fu_state *state)
{
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active)
        if (c->type->start && c->type->start->is_possible && !c->type->start->is_possible(model, c, state)) return 0;
    return 1;
}

void fu_add_internal(const fu_model *model, fu_state *state, const double *internal, double inertia, double scale)
{
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active) {
        const double *of = internal + c->unknown;
        for (int i = 0; i < c->n_coordinates; ++i) state->s[c->coordinate + i] += of[i];
        for (int i = 0; i < c->n_forces; ++i)
            state->forces[c->force + i] += of[c->n_coordinates + i] * fu_row_unit(inertia, c->scale[i]) / scale;
    }
}

const fu_coupling *fu_owner(const fu_model *model, int unknown)
{
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active)
        if (c->unknown <= unknown && unknown < c->unknown + c->n_coordinates + c->n_forces) return c;
    return 0;
}
