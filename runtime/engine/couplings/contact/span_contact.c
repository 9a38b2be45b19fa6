/* Contact of a span of a rope with a surface, by penalty, by quadrature on each element, as along a cable. The elastic
 * force follows from the stored energy, so that energy is conserved while the material flows past the points of
 * quadrature; damping and friction act on the material (derive/couplings/span_force.py). */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/contact/contact.h"

#include <math.h>
#include <string.h>

enum { ENDS = FU_SPAN_ENDS };

static const fu_rope_contact *of(const fu_coupling *coupling)
{
    return (const fu_rope_contact *)coupling;
}

/* --- forces ----------------------------------------------------------------------------------------------------- */

static void add_force(const fu_model *model, const fu_rope_contact *rope, const fu_attachment_state *on,
                      const fu_span_element *it, int k, fu_contact_point *point, void *context)
{
    double F[3], by_place[9], of_e[FU_MAX_COORDINATES], of_ends[ENDS], of_length;
    if (!point) return;
    if (on->n) fu_rope_contact_add_reaction(model->dim, on, point, rope->contact.weights[k] * it->l, context);
    const double part = -rope->contact.weights[k], at = rope->contact.arc[k];
    fu_rope_contact_elastic(rope, point, F, by_place);
    rope->on.kernel->stored_force(part, it->l, it->e, at, point->energy, F, of_e, &of_length);
    fu_add_span_force(&rope->on, it, of_e, 0, of_length, context);
    if (!rope->contact.base.is_damped) return;
    for (int d = 0; d < model->dim; ++d) F[d] = point->f[d] - F[d];
    rope->on.kernel->line_force(part, it->l, it->e, at, F, of_e, of_ends);
    fu_add_span_force(&rope->on, it, of_e, of_ends, 0.0, context);
}

static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    fu_rope_contact_visit(model, of(coupling), state, add_force, f);
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                     double *internal)
{
    (void)internal;
    force(model, coupling, at->next, f);
}

/* --- energies and results --------------------------------------------------------------------------------------- */

typedef struct {
    double energy, power;
} sums;

static void add_energies(const fu_model *model, const fu_rope_contact *rope, const fu_attachment_state *on,
                         const fu_span_element *it, int k, fu_contact_point *point, void *context)
{
    sums *to = context;
    (void)model, (void)on;
    if (!point) return;
    const double weight = rope->contact.weights[k] * it->l;
    to->energy += weight * (point->energy + point->spring_energy);
    to->power += weight * point->power;
}

static double energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    sums found = {0.0, 0.0};
    fu_rope_contact_visit(model, of(coupling), state, add_energies, &found);
    return found.energy;
}

static double dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const fu_accelerator *work)
{
    sums found = {0.0, 0.0};
    (void)work;
    if (coupling->is_damped) fu_rope_contact_visit(model, of(coupling), state, add_energies, &found);
    return found.power;
}

static void add_outputs(const fu_model *model, const fu_rope_contact *rope, const fu_attachment_state *on,
                        const fu_span_element *it, int k, fu_contact_point *point, void *context)
{
    fu_contact_output *out = context;
    (void)on;
    if (!point) return;
    const double weight = rope->contact.weights[k] * it->l, s = it->s[0] + rope->contact.arc[k] * it->l;
    for (int d = 0; d < model->dim; ++d) {
        out->force[d] += weight * point->f[d];
        out->friction_force[d] += weight * point->friction[d];
    }
    out->penetration = fmax(out->penetration, point->depth);
    if (out->touching == 0.0) out->first = s;
    out->touching += weight;
    out->last = s;
}

static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    (void)acceleration, (void)work;
    *(fu_contact_output *)out = (fu_contact_output){.penetration = 0.0};
    fu_rope_contact_visit(model, of(coupling), state, add_outputs, out);
}

static const fu_field fields[] = {
    FU_SURFACE_FIELDS(fu_contact), /* the first member */
    FU_SPAN_FIELDS(fu_rope_contact, on),
    FU_FIELD_AS("stiffness", fu_rope_contact, contact.law.stiffness, FU_REAL),
    FU_FIELD_AS("damping", fu_rope_contact, contact.law.damping, FU_REAL),
    FU_FIELD_AS("hertz", fu_rope_contact, contact.law.hertz, FU_INTEGER),
    FU_FIELD_AS("sticking", fu_rope_contact, contact.law.friction, FU_REAL),
    FU_FIELD_AS("tangential", fu_rope_contact, contact.law.tangential, FU_REAL),
    FU_FIELD(fu_rope_contact, friction, FU_REAL, 0),
    FU_FIELD(fu_rope_contact, slip_velocity, FU_REAL, 0),
    FU_FIELD_AS("cable", fu_rope_contact, contact.cable, FU_INTEGER),
    FU_FIELD_AS("radius", fu_rope_contact, contact.radius, FU_REAL),
    FU_FIELD_AS("n_points", fu_rope_contact, contact.n_points, FU_INTEGER),
    FU_FIELD_AS("weights", fu_rope_contact, contact.weights, FU_REALS),
    FU_FIELD_AS("arc", fu_rope_contact, contact.arc, FU_REALS),
    {0},
};

static const fu_error_operations errors = {.quadrature = fu_contact_quadrature_error};
static const fu_start_operations start = {.reset = fu_rope_contact_reset};
static const fu_history_operations history = {.update = fu_rope_contact_update_history,
                                              .error = fu_contact_history_error};

const fu_coupling_type fu_rope_contact_type = {
    .name = "rope contact",
    .size = sizeof(fu_rope_contact),
    .fields = fields,
    .output_fields = fu_contact_output_fields,
    .residual = residual,
    .tangent = fu_rope_contact_tangent,
    .force = force,
    .energy = energy,
    .dissipation = dissipation,
    .lost_in_step = fu_rope_contact_released,
    .outputs = outputs,
    .history = &history,
    .errors = &errors,
    .start = &start,
};
