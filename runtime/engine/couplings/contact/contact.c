/* Contact of a cable, along its length, or of points of a body with a surface: residuals and their derivatives.
 *
 * Along a cable the force is integrated by quadrature on each element, whose points come into contact one after the
 * other: the sum is continuous. A bounding sphere skips elements that are entirely off the surface. */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/contact/contact.h"

#include <string.h>

static const fu_contact *of(const fu_coupling *coupling)
{
    return (const fu_contact *)coupling;
}

/* Forces at a state. */
typedef struct {
    const fu_state *state;
    double *f;
} forces;

static void add_force(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, int element,
                      int number, const fu_contact_point *point, void *context)
{
    const forces *to = context;
    fu_contact_add_force(model, contact, to->state, on, element, number, point, to->f);
}

static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    forces to = {state, f};
    fu_contact_visit(model, of(coupling), state, add_force, &to);
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                     double *internal)
{
    (void)internal;
    force(model, coupling, at->next, f);
}

static void matrix(const fu_model *model, const fu_contact *contact, const fu_state *state, const double *psi,
                   fu_weights weights, fu_system *system)
{
    const int dim = model->dim, alone = contact->cable >= 0 && contact->surface.on->body < 0;
    double K[FU_MAX_COORDINATES * FU_MAX_COORDINATES];
    fu_attachment_state on;
    fu_surface_at(model, &contact->surface, state, &on);
    for (int e = 0; e < fu_contact_elements(contact); ++e) {
        int in_contact = 0;
        fu_contact_heights heights;
        if (!fu_contact_begin_element(model, contact, &on, state, e, &heights)) continue;
        const int n = contact->cable >= 0 ? model->cables[contact->cable].coordinates : 0;
        for (int k = 0; k < contact->n_points; ++k) {
            fu_contact_point point;
            if (!fu_contact_is_active_at(model, contact, &on, state, e, k, &heights, &point)) continue;
            fu_contact_derivatives(model, contact, &on, &point);
            if (!alone) {
                fu_contact_add_derivatives(model, contact, &on, state, e, k, &point, psi, weights, system);
                continue;
            }
            const double weight = fu_contact_weight(contact, e, k);
            if (!in_contact++) memset(K, 0, sizeof(double) * (size_t)(n * n));
            for (int i = 0; i < dim * dim; ++i) point.by_place[i] += weights.rate * point.by_rate[i];
            const double *N = fu_contact_shapes(contact, n / dim, e, k);
            fu_add_element_product(dim, n, -weights.stiffness * weight, N, N, point.by_place, K);
        }
        if (in_contact) fu_add_element_matrix(model, fu_contact_first(model, contact, e), n, K, system);
    }
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    matrix(model, of(coupling), at->next, at->psi, at->weights, system);
}

static const fu_field fields[] = {
    FU_SURFACE_FIELDS(fu_contact),
    {"stiffness", FU_REAL, offsetof(fu_contact, law.stiffness), 1, 0, NULL},
    {"damping", FU_REAL, offsetof(fu_contact, law.damping), 1, 0, NULL},
    {"friction", FU_REAL, offsetof(fu_contact, law.friction), 1, 0, NULL},
    {"tangential", FU_REAL, offsetof(fu_contact, law.tangential), 1, 0, NULL},
    {"hertz", FU_INTEGER, offsetof(fu_contact, law.hertz), 1, 0, NULL},
    FU_FIELD(fu_contact, cable, FU_INTEGER, 0),
    {"first_element", FU_INTEGER, offsetof(fu_contact, first), 1, 0, NULL},
    FU_FIELD(fu_contact, n_elements, FU_INTEGER, 0),
    FU_FIELD(fu_contact, radius, FU_REAL, 0),
    FU_FIELD(fu_contact, n_points, FU_INTEGER, 0),
    FU_FIELD(fu_contact, stride, FU_INTEGER, 0),
    FU_FIELD(fu_contact, weights, FU_REALS, 0),
    FU_FIELD(fu_contact, N, FU_REALS, 0),
    FU_FIELD(fu_contact, arc, FU_REALS, 0),
    FU_FIELD(fu_contact, start, FU_REAL, 0),
    FU_FIELD(fu_contact, stop, FU_REAL, 0),
    FU_FIELD(fu_contact, n_hull, FU_INTEGER, 0),
    FU_FIELD(fu_contact, hull, FU_REALS, 0),
    FU_FIELD(fu_contact, spread, FU_REALS, 0),
    FU_FIELD(fu_contact, marks, FU_REALS, 0),
    FU_FIELD_ARRAY(fu_contact, attachments, FU_ATTACHMENT),
    {0},
};

static const fu_proximity_operations proximity_of_surface = {.clearance = fu_contact_clearance,
                                                             .between = fu_contact_between};
static const fu_error_operations errors = {.quadrature = fu_contact_quadrature_error};
static const fu_start_operations start = {.reset = fu_contact_reset};
static const fu_history_operations history = {.update = fu_contact_update_history, .error = fu_contact_history_error};

const fu_output fu_contact_output_fields[] = {
    FU_OUTPUT(fu_contact_output, force, "N", "direction"),
    FU_OUTPUT(fu_contact_output, friction_force, "N", "direction"),
    FU_OUTPUT(fu_contact_output, penetration, "m", NULL),
    FU_OUTPUT(fu_contact_output, touching, "1", NULL),
    FU_OUTPUT(fu_contact_output, first, "m", NULL),
    FU_OUTPUT(fu_contact_output, last, "m", NULL),
    FU_LAST_OUTPUT(fu_contact_output),
};

const fu_coupling_type fu_contact_type = {
    .name = "contact",
    .size = sizeof(fu_contact),
    .fields = fields,
    .output_fields = fu_contact_output_fields,
    .n_flags = 1,
    .residual = residual,
    .tangent = tangent,
    .step_residual = fu_contact_step_residual,
    .step_tangent = fu_contact_step_tangent,
    .step_dissipation = fu_contact_step_dissipation,
    .force = force,
    .energy = fu_contact_energy,
    .dissipation = fu_contact_dissipation,
    .lost_in_step = fu_contact_lost,
    .outputs = fu_contact_outputs,
    .proximity = &proximity_of_surface,
    .history = &history,
    .errors = &errors,
    .start = &start,
};
