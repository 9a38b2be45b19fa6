/* The force of a fluid on cables and bodies: drag, quadratic in the relative velocity (derive/couplings/drag.py), and
 * buoyancy; couplings/fluid/added_mass.c adds the inertia of the fluid. Along a cable it is integrated by Gauss
 * quadrature on each element, along a span of a rope in couplings/fluid/span_drag.c.
 *
 * With the velocity U of the fluid and w = U - v, the power of drag f at a point of the velocity v is f . U - f . w.
 * The first term is external power of the fluid. The second, f . w, is never negative and is dissipated.
 */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/accelerator.h"
#include "couplings/common/attachments.h"
#include "couplings/fluid/drag.h"

#include <string.h>

static void densities_at(const fu_model *model, const fu_drag *drag, const fu_drag_block *block, fu_drag_loop *loop,
                         double *K)
{
    fu_block_action a;
    (void)K;
    fu_block_act(model, drag, block, &a);
    for (int p = 0; p < block->shapes.n; ++p) {
        double *out = loop->rows + (long)loop->n_rows++ * FU_DRAG_DENSITIES;
        out[0] = block->element;
        out[1] = block->points->part[block->from + p];
        out[2] = block->points->x[block->from + p];
        out[3] = block->shapes.weight[p];
        out[4] = out[5] = out[6] = 0.0;
        for (int d = 0; d < model->dim; ++d) out[4 + d] = model->load_fraction * (a.f[d][p] + a.buoyancy[d][p]);
    }
}

int fu_drag_densities(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *out)
{
    fu_drag_loop loop = {.t = state->t, .rows = out};
    fu_drag_visit(model, (const fu_drag *)coupling, state->q, state->v, 0, densities_at, &loop, 0);
    return loop.n_rows;
}

/* Computes a point of a body or of a cable, and its motion with the coordinates; over a step that conserves energy, the
 * mean position with the mean velocity. */
static void place_on_body(const fu_model *model, const fu_drag *drag, const fu_state *state, const fu_equations *step,
                          fu_drag_place *at, fu_attachment_state *end)
{
    const fu_attachment *on = &drag->attachments[0];
    memset(at, 0, sizeof *at);
    if (drag->is_foil) fu_attachment_at(model, on, state, 0.0, FU_AXES, end); /* in a step: those in its middle */
    fu_attachment_at(model, on, step ? step->now : state, 0.0, FU_POINT, end);
    memcpy(at->r, end->p, sizeof at->r);
    memcpy(at->v, end->v, sizeof at->v);
    if (!step) return;
    fu_attachment_state after;
    fu_attachment_at(model, on, step->next, 0.0, FU_POINT, &after);
    for (int d = 0; d < model->dim; ++d) {
        at->r[d] = 0.5 * (end->p[d] + after.p[d]);
        at->v[d] = (after.p[d] - end->p[d]) / step->h;
    }
    fu_discrete_point(model, on, step->now, step->next, end->P);
}

/* Adds drag and buoyancy of such a point, at a state or over a step. */
static void on_body(const fu_model *model, const fu_drag *drag, double t, const fu_state *state,
                    const fu_equations *step, const fu_drag_sums *sums)
{
    fu_attachment_state end;
    fu_drag_place at;
    fu_drag_action a;
    double force[3];
    place_on_body(model, drag, state, step, &at, &end);
    fu_drag_act(model, drag, t, &at, end.A, &a);
    fu_drag_whole_force(model, &a, force);
    if (sums->power) fu_drag_add_powers(model, &at, &a, 1.0, sums->power);
    for (int d = 0; d < model->dim && sums->total; ++d) sums->total[d] += force[d];
    if (sums->f) fu_add_wrench(model->dim, &end, force, 0, -1.0, sums->f);
}

static void matrix_of_body(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *psi,
                           fu_weights weights, fu_system *system)
{
    const int dim = model->dim, turns = drag->is_foil ? fu_turns(dim) : 0, rows = 2 * dim + 2 * turns;
    double by[3 * 12] = {0.0}, changes[3 * FU_ATTACHMENT_COORDINATES], force[3], gradient[9];
    fu_attachment_state end;
    fu_point_motion motion;
    fu_drag_place at;
    fu_drag_action a;
    place_on_body(model, drag, state, 0, &at, &end);
    fu_drag_act(model, drag, state->t, &at, end.A, &a);
    fu_drag_whole_force(model, &a, force);
    fu_point_motion_at(model, &drag->attachments[0], state, drag->is_foil ? FU_POINT | FU_AXES : FU_POINT, force, 0,
                       psi, weights.rate, &motion);
    fu_drag_by_place(dim, &a, gradient);
    for (int d = 0; d < dim; ++d) {
        for (int k = 0; k < dim; ++k) {
            by[d * rows + k] = model->load_fraction * gradient[d * dim + k];
            by[d * rows + dim + k] = -model->load_fraction * a.by_w[d * dim + k];
        }
        for (int k = 0; k < turns; ++k) by[d * rows + 2 * dim + k] = model->load_fraction * a.by_turn[d * turns + k];
    }
    fu_changes(&motion, dim, by, changes);
    fu_add_wrench_tangent(model, &motion.at, &motion.at, changes, 0, fu_stiffness_of(&motion), -weights.stiffness,
                          system);
}

/* Adds drag and buoyancy at a state, or over a step. */
static void add(const fu_model *model, const fu_drag *drag, const fu_state *state, const fu_equations *step,
                const fu_drag_sums *sums)
{
    fu_drag_loop loop = {.t = state->t, .sums = sums, .has_drag = 1};
    if (drag->cable >= 0) fu_drag_visit(model, drag, state->q, state->v, 0, fu_block_forces, &loop, 0);
    else if (drag->on.kernel) fu_add_span_drag(model, drag, state, sums);
    else on_body(model, drag, state->t, state, step, sums);
}

/* Adds all forces of the fluid at a state, with accelerations a (null: zero). */
static void add_all(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const double *a,
                    const fu_drag_sums *sums)
{
    const fu_drag *drag = (const fu_drag *)coupling;
    if (drag->cable >= 0 && coupling->has_inertia) {
        fu_drag_loop loop = {.t = state->t, .sums = sums, .has_drag = 1, .has_inertia = 1};
        fu_drag_visit(model, drag, state->q, state->v, a, fu_block_forces, &loop, 0);
        return;
    }
    add(model, drag, state, 0, sums);
    if (coupling->has_inertia) fu_added_mass_forces(model, drag, state, a, sums);
}

/* Adds all forces of the fluid over a step. */
static void add_step(const fu_model *model, const fu_coupling *coupling, const fu_equations *at,
                     const fu_drag_sums *sums)
{
    const fu_drag *drag = (const fu_drag *)coupling;
    add(model, drag, at->middle, at, sums);
    if (coupling->has_inertia) fu_added_mass_step_forces(model, drag, at, sums);
}

static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    const fu_drag_sums sums = {.f = f};
    add_all(model, coupling, state, 0, &sums);
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                     double *internal)
{
    const fu_drag_sums sums = {.f = f};
    (void)internal;
    add_all(model, coupling, at->next, at->weights.inertia != 0.0 ? at->next->acceleration : 0, &sums);
}

static void step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                          double *internal)
{
    const fu_drag_sums sums = {.f = f};
    (void)internal;
    add_step(model, coupling, at, &sums);
}

static void matrix(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const double *a,
                   const double *psi, fu_weights weights, fu_system *system)
{
    const fu_drag *drag = (const fu_drag *)coupling;
    const double *accelerations = weights.inertia != 0.0 ? a : 0;
    if (drag->cable >= 0) {
        fu_drag_loop loop = {
            .t = state->t, .has_drag = 1, .has_inertia = coupling->has_inertia, .has_matrix = 1, .weights = weights};
        fu_drag_visit(model, drag, state->q, state->v, accelerations, fu_block_tangent, &loop, system);
        return;
    }
    if (drag->on.kernel) fu_add_span_drag_matrix(model, drag, state, weights, system);
    else matrix_of_body(model, drag, state, psi, weights, system);
    if (coupling->has_inertia) fu_added_mass_tangent(model, drag, state, accelerations, psi, weights, system);
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    matrix(model, coupling, at->next, at->next->acceleration, at->psi, at->weights, system);
}

/* The middle moves by half of psi, which is in weights.stiffness. */
static void step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    matrix(model, coupling, at->middle, at->next->acceleration, 0, at->weights, system);
}

static double dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const fu_accelerator *work)
{
    fu_drag_powers power = {0.0, 0.0};
    const fu_drag_sums sums = {.power = &power};
    (void)work;
    add(model, (const fu_drag *)coupling, state, 0, &sums);
    return power.dissipated;
}

static double external_power(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    fu_drag_powers power = {0.0, 0.0};
    const fu_drag_sums sums = {.power = &power};
    add_all(model, coupling, state, state->acceleration, &sums);
    return power.external;
}

static double step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at)
{
    fu_drag_powers power = {0.0, 0.0};
    const fu_drag_sums sums = {.power = &power};
    add(model, (const fu_drag *)coupling, at->middle, at, &sums);
    return at->h * power.dissipated;
}

/* Added mass of ropes and waves have no equations over a step that conserves energy, Morison's equation has no energy.
 */
static int has_step(const fu_coupling *coupling)
{
    const fu_drag *drag = (const fu_drag *)coupling;
    return !drag->waves.n_waves && !(coupling->has_inertia && (drag->on.kernel || drag->is_morison));
}

static double step_work(const fu_model *model, const fu_coupling *coupling, const fu_equations *at)
{
    fu_drag_powers power = {0.0, 0.0};
    const fu_drag_sums sums = {.power = &power};
    add_step(model, coupling, at, &sums);
    return at->h * power.external;
}

static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    const fu_drag_sums sums = {.total = out};
    (void)work;
    memset(out, 0, sizeof(double[3]));
    add_all(model, coupling, state, acceleration, &sums);
}

static const char *const role[] = {"drag", 0};
static const char *const wetted[] = {"all", "section", "sphere", "column", 0};
static const char *const profiles[] = {"uniform", "power", "table", 0};
#define FLOW_FIELD(member, kind, words) {#member, kind, offsetof(fu_drag, flow.member), 1, 0, words}
#define WAVES_FIELD(member, kind) {#member, kind, offsetof(fu_drag, waves.member), 1, 0, NULL}
#define ICED_FIELD(member, kind) {"ice_" #member, kind, offsetof(fu_drag, iced.member), 1, 0, NULL}
#define FLOW_VECTOR(member) {#member, FU_REAL, offsetof(fu_drag, flow.member), 3, sizeof(double), NULL}

static const fu_field fields[] = {
    FU_FIELD(fu_drag, kernel, FU_KERNELS, role),
    FLOW_VECTOR(velocity),
    FLOW_VECTOR(up),
    FLOW_FIELD(base, FU_REAL, 0),
    FLOW_FIELD(signal, FU_INTEGER, 0),
    FLOW_FIELD(profile, FU_WORD, profiles),
    FLOW_FIELD(reference, FU_REAL, 0),
    FLOW_FIELD(exponent, FU_REAL, 0),
    FLOW_FIELD(least, FU_REAL, 0),
    FLOW_FIELD(n_segments, FU_INTEGER, 0),
    FLOW_FIELD(breaks, FU_REALS, 0),
    {"coefficients_of_profile", FU_REALS, offsetof(fu_drag, flow.coefficients), 1, 0, NULL},
    FLOW_FIELD(degree, FU_INTEGER, 0),
    {"n_splines", FU_INTEGER, offsetof(fu_drag, flow.n_splines), FU_FLOW_AXES, sizeof(int), NULL},
    FLOW_FIELD(knots, FU_REALS, 0),
    FLOW_FIELD(table, FU_REALS, 0),
    FLOW_VECTOR(origin),
    {"axes", FU_REAL, offsetof(fu_drag, flow.axes), 9, sizeof(double), NULL},
    WAVES_FIELD(n_waves, FU_INTEGER),
    WAVES_FIELD(move_fluid, FU_INTEGER),
    WAVES_FIELD(wave_vectors, FU_REALS),
    WAVES_FIELD(wave_numbers, FU_REALS),
    WAVES_FIELD(inv_depth, FU_REAL),
    WAVES_FIELD(max_elevation, FU_REAL),
    FU_FIELD(fu_drag, cable, FU_INTEGER, 0),
    FU_FIELD(fu_drag, first, FU_INTEGER, 0),
    FU_FIELD(fu_drag, n_elements, FU_INTEGER, 0),
    FU_SPAN_FIELDS(fu_drag, on),
    FU_FIELD_ARRAY(fu_drag, coefficients, FU_REAL),
    FU_FIELD_ARRAY(fu_drag, lift, FU_REAL),
    FU_FIELD(fu_drag, is_foil, FU_INTEGER, 0),
    FU_FIELD_ARRAY(fu_drag, foil, FU_REAL),
    FU_FIELD_ARRAY(fu_drag, span, FU_REAL),
    FU_FIELD_ARRAY(fu_drag, chord, FU_REAL),
    FU_FIELD(fu_drag, foil_lift, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_drag, section, FU_REAL),
    FU_FIELD(fu_drag, n_angles, FU_INTEGER, 0),
    FU_FIELD(fu_drag, angles, FU_REALS, 0),
    FU_FIELD(fu_drag, polar_drag, FU_REALS, 0),
    FU_FIELD(fu_drag, polar_lift, FU_REALS, 0),
    FU_FIELD(fu_drag, polar_moment, FU_REALS, 0),
    FU_FIELD_ARRAY(fu_drag, buoyancy, FU_REAL),
    ICED_FIELD(has_ice, FU_INTEGER),
    ICED_FIELD(signal, FU_INTEGER),
    ICED_FIELD(factor, FU_REAL),
    ICED_FIELD(width, FU_REAL),
    ICED_FIELD(diameter, FU_REAL),
    {"ice_buoyancy", FU_REAL, offsetof(fu_drag, iced.buoyancy), 3, sizeof(double), NULL},
    FU_FIELD(fu_drag, wet, FU_WORD, wetted),
    FU_FIELD(fu_drag, extent, FU_REAL, 0),
    FU_FIELD(fu_drag, surface, FU_REAL, 0),
    FU_FIELD(fu_drag, bottom, FU_REAL, 0),
    FU_FIELD(fu_drag, displaced, FU_REAL, 0),
    FU_FIELD(fu_drag, is_morison, FU_INTEGER, 0),
    FU_FIELD_ARRAY(fu_drag, added, FU_REAL),
    FU_FIELD(fu_drag, n_points, FU_INTEGER, 0),
    FU_FIELD(fu_drag, stride, FU_INTEGER, 0),
    FU_FIELD(fu_drag, weights, FU_REALS, 0),
    FU_FIELD(fu_drag, N, FU_REALS, 0),
    FU_FIELD(fu_drag, N_x, FU_REALS, 0),
    FU_FIELD(fu_drag, N_chord, FU_REALS, 0),
    FU_FIELD_ARRAY(fu_drag, attachments, FU_ATTACHMENT),
    {0},
};

static const fu_inertia_operations inertia = {.force = fu_added_mass_force,
                                              .matrix = fu_added_mass_matrix,
                                              .kinetic_energy = fu_added_mass_kinetic_energy,
                                              .in_residual = 1};
static const fu_supply_operations supply = {.power = external_power, .step_work = step_work};

typedef struct {
    double force[3]; /* on the cable or body */
} fu_drag_output;
static const fu_output output_fields[] = {
    FU_OUTPUT(fu_drag_output, force, "N", "direction"),
    FU_LAST_OUTPUT(fu_drag_output),
};

const fu_coupling_type fu_drag_type = {
    .name = "drag",
    .size = sizeof(fu_drag),
    .fields = fields,
    .output_fields = output_fields,
    .n_flags = FU_DRAG_FLAGS,
    .residual = residual,
    .tangent = tangent,
    .step_residual = step_residual,
    .step_tangent = step_tangent,
    .step_dissipation = step_dissipation,
    .has_step = has_step,
    .force = force,
    .dissipation = dissipation,
    .outputs = outputs,
    .inertia = &inertia,
    .supply = &supply,
};
