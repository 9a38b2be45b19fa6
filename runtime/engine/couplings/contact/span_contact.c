/* Contact of a span of a rope with a surface of the ground, by penalty and without friction, by quadrature on each
 * element, as along a cable. The elastic force follows from the stored energy, so that energy is conserved while the
 * material flows past the points of quadrature; that of damping acts on the material (derive/couplings/span_force.py).
 */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/contact/contact.h"

#include <math.h>
#include <string.h>

enum { ENDS = FU_SPAN_ENDS, LOCAL = FU_SPAN_LOCAL, CORNERS = 4 };

static const fu_rope_contact *of(const fu_coupling *coupling)
{
    return (const fu_rope_contact *)coupling;
}

/* Returns whether any point of an element may be nearer to the surface than the radius: it lies within the hull of its
 * four Bezier points. */
static int may_be_active(int dim, const fu_rope_contact *rope, const fu_attachment_state *on, const fu_span_element *it)
{
    const double *first = it->e, *last = it->e + 2 * dim;
    double corners[CORNERS][3], middle[3] = {0.0}, square = 0.0;
    for (int d = 0; d < dim; ++d) {
        corners[0][d] = first[d];
        corners[1][d] = first[d] + it->l / 3.0 * first[dim + d];
        corners[2][d] = last[d] - it->l / 3.0 * last[dim + d];
        corners[3][d] = last[d];
        for (int k = 0; k < CORNERS; ++k) middle[d] += corners[k][d] / CORNERS;
    }
    for (int k = 0; k < CORNERS; ++k) {
        double sum = 0.0;
        for (int d = 0; d < dim; ++d) sum += (corners[k][d] - middle[d]) * (corners[k][d] - middle[d]);
        square = fmax(square, sum);
    }
    return fu_surface_clearance(dim, &rope->contact.surface, on, middle, sqrt(square)) <= rope->contact.radius;
}

/* Computes the contact of a point of quadrature; returns whether there is one. */
static int contact_at(const fu_model *model, const fu_rope_contact *rope, const fu_attachment_state *on,
                      const fu_span_element *it, int k, fu_contact_point *point)
{
    double r_S[3];
    memset(point, 0, sizeof *point);
    rope->on.kernel->point(it->l, it->e, it->v, it->s_rate, rope->contact.arc[k], point->r, r_S, point->v);
    return fu_contact_is_active(model, &rope->contact, on, point);
}

/* Calls `visit` with each point in contact; after the last one of an element with none. */
typedef void visitor(const fu_model *model, const fu_rope_contact *rope, const fu_attachment_state *on,
                     const fu_span_element *it, int k, fu_contact_point *point, void *context);

static void visit_all(const fu_model *model, const fu_rope_contact *rope, const fu_state *state, visitor *visit,
                      void *context)
{
    fu_attachment_state on;
    fu_surface_at(model, &rope->contact.surface, state, &on);
    for (int e = 0; e < rope->on.n_elements; ++e) {
        const fu_span_element it = fu_span_element_at(model, &rope->on, e, state->q, state->v, 0);
        int in_contact = 0;
        if (!may_be_active(model->dim, rope, &on, &it)) continue;
        for (int k = 0; k < rope->contact.n_points; ++k) {
            fu_contact_point point;
            if (!contact_at(model, rope, &on, &it, k, &point)) continue;
            ++in_contact;
            visit(model, rope, &on, &it, k, &point, context);
        }
        if (in_contact) visit(model, rope, &on, &it, -1, 0, context);
    }
}

/* --- forces ----------------------------------------------------------------------------------------------------- */

/* Computes the elastic part of the normal force at a point, with its derivatives by the place. */
static void elastic_part(const fu_rope_contact *rope, const fu_contact_point *point, double F[3], double by_place[9])
{
    const fu_normal_force at = fu_normal_force_at(&rope->contact, point->depth, 0.0, point->depth);
    const double none[3] = {0.0}, law[3] = {at.p, at.by_depth, 0.0};
    double by_rate[9];
    rope->contact.surface.kernel->frictionless(point->distance.n, point->distance.H, none, law, F, by_place, by_rate);
}

static void add_force(const fu_model *model, const fu_rope_contact *rope, const fu_attachment_state *on,
                      const fu_span_element *it, int k, fu_contact_point *point, void *context)
{
    double F[3], by_place[9], of_e[FU_MAX_COORDINATES], of_ends[ENDS], of_length;
    (void)on;
    if (!point) return;
    const double part = -rope->contact.weights[k], at = rope->contact.arc[k];
    elastic_part(rope, point, F, by_place);
    rope->on.kernel->stored_force(part, it->l, it->e, at, point->energy, F, of_e, &of_length);
    fu_add_span_force(&rope->on, it, of_e, 0, of_length, context);
    if (!rope->contact.base.is_damped) return;
    for (int d = 0; d < model->dim; ++d) F[d] = point->f[d] - F[d];
    rope->on.kernel->line_force(part, it->l, it->e, at, F, of_e, of_ends);
    fu_add_span_force(&rope->on, it, of_e, of_ends, 0.0, context);
}

static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    visit_all(model, of(coupling), state, add_force, f);
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                     double *internal)
{
    (void)internal;
    force(model, coupling, at->next, f);
}

typedef struct {
    fu_weights weights;
    fu_system *system;
    double local[LOCAL][LOCAL];
} matrix;

static void add_matrix(const fu_model *model, const fu_rope_contact *rope, const fu_attachment_state *on,
                       const fu_span_element *it, int k, fu_contact_point *point, void *context)
{
    matrix *to = context;
    const int n = rope->on.kernel->coordinates, all = n + ENDS;
    const double none[9] = {0.0};
    double D[LOCAL * LOCAL], K[LOCAL * LOCAL];
    if (!point) {
        fu_add_span_matrix(model, &rope->on, it, to->local, to->system);
        memset(to->local, 0, sizeof to->local);
        return;
    }
    const double part = -rope->contact.weights[k], share = rope->contact.arc[k];
    double F[3], by_place[9], K_l[FU_MAX_COORDINATES], K_ll;
    elastic_part(rope, point, F, by_place);
    rope->on.kernel->stored_force_tangent(part, it->l, it->e, share, F, by_place, K, K_l, &K_ll);
    fu_add_by_energy(n, to->weights.stiffness, K, K_l, K_ll, to->local);
    if (!rope->contact.base.is_damped) return;
    fu_contact_derivatives(model, &rope->contact, on, point);
    for (int d = 0; d < model->dim; ++d) F[d] = point->f[d] - F[d];
    for (int i = 0; i < model->dim * model->dim; ++i) by_place[i] = point->by_place[i] - by_place[i];
    rope->on.kernel->line_force_tangent(part, it->l, it->e, it->v, it->s_rate, share, F, by_place, none, point->by_rate,
                                        D, K);
    fu_add_by_length(all, n, to->weights.stiffness, K, to->local);
    fu_add_by_rates(all, to->weights.stiffness * to->weights.rate, D, to->local);
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    matrix to = {.weights = at->weights, .system = system};
    visit_all(model, of(coupling), at->next, add_matrix, &to);
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
    to->energy += weight * point->energy;
    to->power += weight * point->power;
}

static double energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    sums found = {0.0, 0.0};
    visit_all(model, of(coupling), state, add_energies, &found);
    return found.energy;
}

static double dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const fu_accelerator *work)
{
    sums found = {0.0, 0.0};
    (void)work;
    if (coupling->is_damped) visit_all(model, of(coupling), state, add_energies, &found);
    return found.power;
}

static void add_outputs(const fu_model *model, const fu_rope_contact *rope, const fu_attachment_state *on,
                        const fu_span_element *it, int k, fu_contact_point *point, void *context)
{
    fu_contact_output *out = context;
    (void)on;
    if (!point) return;
    const double weight = rope->contact.weights[k] * it->l, s = it->s[0] + rope->contact.arc[k] * it->l;
    for (int d = 0; d < model->dim; ++d) out->force[d] += weight * point->f[d];
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
    visit_all(model, of(coupling), state, add_outputs, out);
}

static const fu_field fields[] = {
    FU_SURFACE_FIELDS(fu_contact), /* the first member */
    FU_SPAN_FIELDS(fu_rope_contact, on),
    FU_FIELD_AS("stiffness", fu_rope_contact, contact.law.stiffness, FU_REAL),
    FU_FIELD_AS("damping", fu_rope_contact, contact.law.damping, FU_REAL),
    FU_FIELD_AS("hertz", fu_rope_contact, contact.law.hertz, FU_INTEGER),
    FU_FIELD_AS("cable", fu_rope_contact, contact.cable, FU_INTEGER),
    FU_FIELD_AS("radius", fu_rope_contact, contact.radius, FU_REAL),
    FU_FIELD_AS("n_points", fu_rope_contact, contact.n_points, FU_INTEGER),
    FU_FIELD_AS("weights", fu_rope_contact, contact.weights, FU_REALS),
    FU_FIELD_AS("arc", fu_rope_contact, contact.arc, FU_REALS),
    {0},
};

const fu_coupling_type fu_rope_contact_type = {
    .name = "rope contact",
    .size = sizeof(fu_rope_contact),
    .fields = fields,
    .output_fields = fu_contact_output_fields,
    .residual = residual,
    .tangent = tangent,
    .force = force,
    .energy = energy,
    .dissipation = dissipation,
    .outputs = outputs,
};
