/* Derivatives of the contact of a span of a rope, by the unknowns of the span and of the body that the surface is on.
 */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/contact/contact.h"

#include <string.h>

enum { ENDS = FU_SPAN_ENDS, LOCAL = FU_SPAN_LOCAL };

typedef struct {
    const fu_state *state;
    const double *psi;
    fu_weights weights;
    fu_system *system;
    double local[LOCAL][LOCAL];
} matrix;

/* The force on a point in its two parts: that of the stored energy, and that of damping and friction on the material;
 * and the whole. */
typedef struct {
    fu_contact_point stored, line, whole;
    double by_S[3]; /* change of the whole by the material coordinate */
} parts;

/* Computes the change of the force on the material by the material coordinate of a point at a constant place: that of
 * friction's history. What slid in the step, or was off the surface or the span before, has forgotten the stretch that
 * it had. Changes of the instant at which it entered, and of velocity and gap before the step, are left out. */
static void by_material(int dim, const fu_attachment_state *on, const fu_contact_point *point, double by_S[3])
{
    double local[3] = {0.0}, change[3] = {0.0};
    memset(by_S, 0, sizeof(double[3]));
    if (!point->mark) return;
    const int has_stretch = !point->friction_end.slid && !(point->mark->gap > 0.0) && !(point->entered > 0.0);
    for (int d = 0; d < dim; ++d) local[d] = has_stretch * point->stretch_by_S[d] - point->place_by_S[d];
    fu_surface_out(dim, on, local, change);
    for (int i = 0; i < dim; ++i) by_S[i] = fu_dot(dim, point->by_stretch + i * dim, change);
}

static void parts_of(const fu_model *model, const fu_rope_contact *rope, const fu_attachment_state *on,
                     fu_contact_point *point, parts *out)
{
    const int dim = model->dim;
    double f[3], by_place[9], by_rate[9];
    if (rope->contact.base.is_damped) fu_contact_derivatives(model, &rope->contact, on, point);
    out->stored = *point;
    fu_rope_contact_elastic(rope, point, out->stored.f, out->stored.by_place);
    memset(out->stored.by_rate, 0, sizeof out->stored.by_rate);
    memset(out->stored.by_stretch, 0, sizeof out->stored.by_stretch);
    out->line = out->whole = out->stored;
    if (rope->contact.base.is_damped) out->whole = *point;
    memcpy(out->line.by_stretch, out->whole.by_stretch, sizeof out->line.by_stretch);
    by_material(dim, on, &out->whole, out->by_S);
    if (rope->friction > 0.0) {
        fu_rope_contact_friction(dim, rope, on, point, f, by_place, by_rate);
        for (int i = 0; i < dim * dim; ++i) {
            out->whole.by_place[i] += by_place[i];
            out->whole.by_rate[i] += by_rate[i];
        }
    }
    for (int d = 0; d < dim; ++d) out->line.f[d] = out->whole.f[d] - out->stored.f[d];
    for (int i = 0; i < dim * dim; ++i) {
        out->line.by_place[i] = out->whole.by_place[i] - out->stored.by_place[i];
        out->line.by_rate[i] = out->whole.by_rate[i];
    }
}

/* Computes the derivatives of the force on the material by its place, at a fixed velocity of the material: that of the
 * surface there changes, too. */
static void by_place_of(int dim, const fu_attachment_state *on, const fu_contact_point *line, double by_place[9])
{
    memcpy(by_place, line->by_place, sizeof(double[9]));
    for (int j = 0; on->n && j < dim; ++j) {
        double step[3] = {0.0}, past[3];
        step[j] = 1.0;
        fu_swing(dim, on->omega, step, past);
        for (int i = 0; i < dim; ++i) by_place[i * dim + j] -= fu_dot(dim, line->by_rate + i * dim, past);
    }
}

/* Computes the motion of a point of quadrature, with a constant share of the length of its element, by the unknowns of
 * the element and of both ends of the span. */
static void motion_of(const fu_model *model, const fu_rope_contact *rope, const fu_span_element *it, int k, double rate,
                      fu_point_motion *out)
{
    const int dim = model->dim, n = rope->on.kernel->coordinates, all = n + ENDS;
    double r_q[3 * LOCAL], v_q[3 * LOCAL], v_v[3 * LOCAL];
    rope->on.kernel->point_tangent(it->l, it->e, it->v, it->s_rate, rope->contact.arc[k], r_q, v_q, v_v);
    out->at.n = all;
    out->rows = 2 * dim;
    out->is_stiff = 0;
    for (int i = 0; i < n; ++i) out->at.at[i] = it->at + i;
    for (int i = 0; i < ENDS; ++i) out->at.at[n + i] = rope->on.s[i];
    for (int d = 0; d < dim; ++d) {
        double *place = out->by + d * all, *velocity = out->by + (dim + d) * all;
        const double *by_l[2] = {r_q + d * (n + 1), v_q + d * (n + 1)};
        for (int i = 0; i < all; ++i) {
            const int at = i < n ? i : n;
            const double sign = i == n ? -1.0 : 1.0;
            place[i] = sign * by_l[0][at];
            velocity[i] = sign * by_l[1][at] + rate * v_v[d * all + i];
        }
    }
    fu_to_ends_of_span(&rope->on, it->number, out->by + n, out->by + n + 1, 2 * dim, all);
}

/* Adds the change of the forces on the span by one unknown of the body. */
static void add_column(const fu_model *model, const fu_rope_contact *rope, const fu_span_element *it, int k, int column,
                       double energy, const double *stored, const double *line, const matrix *to)
{
    const int n = rope->on.kernel->coordinates;
    const double part = -rope->contact.weights[k] * to->weights.stiffness, at = rope->contact.arc[k];
    double rows[LOCAL] = {0.0}, of_e[FU_MAX_COORDINATES], of_ends[ENDS], of_length;
    rope->on.kernel->stored_force(part, it->l, it->e, at, energy, stored, rows, &of_length);
    rows[n] = -of_length;
    rows[n + 1] = of_length;
    rope->on.kernel->line_force(part, it->l, it->e, at, line, of_e, of_ends);
    for (int i = 0; i < n; ++i) rows[i] += of_e[i];
    for (int i = 0; i < ENDS; ++i) rows[n + i] += of_ends[i];
    fu_to_ends_of_span(&rope->on, it->number, &rows[n], &rows[n + 1], 1, 1);
    for (int i = 0; i < n + ENDS; ++i)
        fu_add(model, to->system, i < n ? it->at + i : rope->on.s[i - n], column, rows[i]);
}

/* Adds the derivatives by the unknowns of the body, and those of the reaction on it. */
static void add_body(const fu_model *model, const fu_rope_contact *rope, const fu_attachment_state *on,
                     const fu_span_element *it, int k, const parts *of, const matrix *to)
{
    const int dim = model->dim, n = rope->on.kernel->coordinates;
    const double weight = rope->contact.weights[k] * it->l, scale = to->weights.stiffness * weight;
    double arm[3], moment[3], stored[3], turned[3];
    fu_point_motion a, b;
    fu_contact_changes by_a, by_b, stored_by, line_by;
    for (int d = 0; d < dim; ++d) arm[d] = of->whole.r[d] - on->p[d];
    fu_moment_of(dim, arm, of->whole.f, moment);
    fu_moment_of(dim, arm, of->stored.f, stored);
    motion_of(model, rope, it, k, to->weights.rate, &a);
    fu_point_motion_at(model, rope->contact.surface.on, to->state, FU_POINT | FU_AXES, of->whole.f, moment, to->psi,
                       to->weights.rate, &b);
    fu_contact_changes_by(dim, &rope->contact, on, &of->whole, &a, 0, &by_a);
    fu_contact_changes_by(dim, &rope->contact, on, &of->whole, &b, 1, &by_b);
    fu_contact_changes_by(dim, &rope->contact, on, &of->stored, &b, 1, &stored_by);
    fu_contact_changes_by(dim, &rope->contact, on, &of->line, &b, 1, &line_by);
    double of_length[ENDS] = {-1.0 / it->l, 1.0 / it->l}; /* of the weight, over it */
    double of_S[ENDS] = {1.0 - rope->contact.arc[k], rope->contact.arc[k]};
    fu_to_ends_of_span(&rope->on, it->number, &of_length[0], &of_length[1], 1, 1);
    fu_to_ends_of_span(&rope->on, it->number, &of_S[0], &of_S[1], 1, 1);
    fu_moment_of(dim, arm, of->by_S, turned);
    for (int i = 0; i < ENDS; ++i) {
        for (int d = 0; d < dim; ++d)
            by_a.force[d * a.at.n + n + i] += of_length[i] * of->whole.f[d] + of_S[i] * of->by_S[d];
        for (int t = 0; t < fu_turns(dim); ++t)
            by_a.far[t * a.at.n + n + i] += of_length[i] * moment[t] + of_S[i] * turned[t];
    }
    fu_add_wrench_tangent(model, &b.at, &a.at, by_a.force, by_a.far, 0, scale, to->system);
    fu_add_wrench_tangent(model, &b.at, &b.at, by_b.force, by_b.far, fu_stiffness_of(&b), scale, to->system);
    for (int i = 0; i < b.at.n; ++i) {
        double energy = 0.0, changes[2][3];
        for (int d = 0; d < dim; ++d) {
            energy += of->stored.f[d] * b.by[d * b.at.n + i];
            changes[0][d] = stored_by.force[d * b.at.n + i];
            changes[1][d] = line_by.force[d * b.at.n + i];
        }
        for (int t = 0; t < fu_turns(dim); ++t) energy += stored[t] * b.by[(2 * dim + t) * b.at.n + i];
        add_column(model, rope, it, k, b.at.at[i], energy, changes[0], changes[1], to);
    }
}

/* Adds the change of the forces on the span by the material coordinate of a point, which the ends of its element move.
 */
static void add_by_material(const fu_rope_contact *rope, const fu_span_element *it, int k, const double by_S[3],
                            matrix *to)
{
    const int n = rope->on.kernel->coordinates;
    const double at = rope->contact.arc[k];
    double rows[LOCAL];
    rope->on.kernel->line_force(-rope->contact.weights[k] * to->weights.stiffness, it->l, it->e, at, by_S, rows,
                                rows + n);
    for (int i = 0; i < n + ENDS; ++i) {
        to->local[i][n] += (1.0 - at) * rows[i];
        to->local[i][n + 1] += at * rows[i];
    }
}

static void add_matrix(const fu_model *model, const fu_rope_contact *rope, const fu_attachment_state *on,
                       const fu_span_element *it, int k, fu_contact_point *point, void *context)
{
    matrix *to = context;
    const int n = rope->on.kernel->coordinates, all = n + ENDS;
    const double none[9] = {0.0};
    double D[LOCAL * LOCAL], K[LOCAL * LOCAL], by_place[9], K_l[FU_MAX_COORDINATES], K_ll;
    parts of;
    if (!point) {
        fu_add_span_matrix(model, &rope->on, it, to->local, to->system);
        memset(to->local, 0, sizeof to->local);
        return;
    }
    const double part = -rope->contact.weights[k], share = rope->contact.arc[k];
    parts_of(model, rope, on, point, &of);
    rope->on.kernel->stored_force_tangent(part, it->l, it->e, share, of.stored.f, of.stored.by_place, K, K_l, &K_ll);
    fu_add_by_energy(n, to->weights.stiffness, K, K_l, K_ll, to->local);
    if (on->n) add_body(model, rope, on, it, k, &of, to);
    if (!rope->contact.base.is_damped) return;
    by_place_of(model->dim, on, &of.line, by_place);
    rope->on.kernel->line_force_tangent(part, it->l, it->e, it->v, it->s_rate, share, of.line.f, by_place, none,
                                        of.line.by_rate, D, K);
    fu_add_by_length(all, n, to->weights.stiffness, K, to->local);
    fu_add_by_rates(all, to->weights.stiffness * to->weights.rate, D, to->local);
    if (of.line.mark) add_by_material(rope, it, k, of.by_S, to);
}

void fu_rope_contact_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at,
                             fu_system *system)
{
    matrix to = {.state = at->next, .psi = at->psi, .weights = at->weights, .system = system};
    fu_rope_contact_visit(model, (const fu_rope_contact *)coupling, at->next, add_matrix, &to);
}
