/* External forces and moments, and their derivatives if they rotate with their carrier. */
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/common/attachments.h"
#include "couplings/force/force.h"

#include <math.h>
#include <string.h>

/* Returns the factor of a load, zero of one that has left its cable. */
static double factor_at(const fu_model *model, const fu_load *load, double t)
{
    const double present = fu_scale_at(model, load->presence, t);
    return present != 0.0 ? present * fu_scale_at(model, load->signal, t) : 0.0;
}

/* Returns the element of a cable on which a load acts, and x there. */
static int element_of(const fu_model *model, const fu_load *load, const fu_cable *cable, double t, double *x)
{
    *x = load->x;
    if (load->place < 0) return load->on.element;
    const double s = fu_signal_at(&model->signals[load->place], t, 0, 0) + load->x;
    const double on = fmin(fmax(s, 0.0), fu_cable_length(cable));
    const int element = fu_cable_element_at(cable, on);
    *x = on - fu_cable_start(cable, element);
    return element;
}

/* The generalised force g of a load on an element at unit signal, on n dofs from `first` on, and its derivative K by
 * them. */
typedef struct {
    int n, first;
    double g[FU_MAX_COORDINATES], K[FU_MAX_COORDINATES * FU_MAX_COORDINATES];
} element_load;

/* Computes the load on an element; the derivative is left out for a force of constant direction. */
static void on_element(const fu_model *model, const fu_load *load, double t, const double *q, element_load *out)
{
    const fu_cable *cable = &model->cables[load->on.cable];
    double x, c[3];
    const int element = element_of(model, load, cable, t, &x), dim = model->dim;
    const double length = fu_element_length(cable, element);
    for (int d = 0; d < 3; ++d) c[d] = model->load_fraction * load->c[d];
    out->n = cable->coordinates;
    out->first = fu_element_entry(cable, element);
    if (load->kind == FU_CABLE_FORCE) {
        double N[FU_MAX_COORDINATES], N_x[FU_MAX_COORDINATES];
        cable->kernel->on_axis(length, x, N, N_x);
        for (int i = 0; i < out->n; ++i) out->g[i] = N[i / dim] * c[i % dim];
        return;
    }
    (load->kind == FU_CABLE_MOMENT ? cable->kernel->moment : cable->kernel->follower_force)(length, x, q + out->first,
                                                                                            c, out->g, out->K);
}

/* Computes the load on a body or on a point of a rope at unit signal: the attachment, a force `f` or a moment `m` in
 * global axes, null without one. */
typedef struct {
    fu_attachment_state at;
    double vector[3];
    const double *f, *m;
} body_load;

static void on_body(const fu_model *model, const fu_load *load, const fu_state *state, body_load *out)
{
    static const int needs[] = {
        [FU_BODY_FORCE] = FU_PLACE, [FU_BODY_FOLLOWER] = FU_PLACE | FU_AXES, [FU_BODY_MOMENT] = FU_AXES};
    const int dim = model->dim, is_moment = load->kind == FU_BODY_MOMENT;
    const double *c = load->c + (is_moment && dim == 2 ? 2 : 0);
    fu_attachment_at(model, &load->on, state, 0.0, needs[load->kind], &out->at);
    for (int d = 0; d < (is_moment ? fu_turns(dim) : dim); ++d)
        out->vector[d] =
            model->load_fraction * (load->kind == FU_BODY_FOLLOWER ? fu_dot(dim, out->at.A + d * dim, c) : c[d]);
    out->f = is_moment ? 0 : out->vector;
    out->m = is_moment ? out->vector : 0;
}

static void dead_force(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double *f)
{
    const fu_dead_load *load = (const fu_dead_load *)coupling;
    const double scale = fu_scale_at(model, load->signal, t);
    (void)q;
    for (int i = 0; i < load->n; ++i) f[load->dofs[i]] -= scale * (model->load_fraction * load->values[i]);
}

static const fu_field dead_fields[] = {
    FU_FIELD(fu_dead_load, signal, FU_INTEGER, 0),
    FU_FIELD(fu_dead_load, n, FU_INTEGER, 0),
    FU_FIELD(fu_dead_load, dofs, FU_INTEGERS, 0),
    FU_FIELD(fu_dead_load, values, FU_REALS, 0),
    {0},
};

static const fu_supply_operations dead_supply = {.force = dead_force};
const fu_coupling_type fu_dead_load_type = {
    .name = "dead load", .size = sizeof(fu_dead_load), .fields = dead_fields, .supply = &dead_supply};

static void rotating_force(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double *f)
{
    const fu_load *load = (const fu_load *)coupling;
    const double scale = factor_at(model, load, t);
    if (load->on.cable >= 0) {
        element_load of;
        if (scale == 0.0) return;
        on_element(model, load, t, q, &of);
        for (int i = 0; i < of.n; ++i) f[of.first + i] -= scale * of.g[i];
        return;
    }
    const fu_state state = {.q = (double *)q, .v = (double *)model->zero};
    body_load of;
    on_body(model, load, &state, &of);
    fu_add_wrench(model->dim, &of.at, of.f, of.m, -scale, f);
}

/* Subtracts stiffness times the load's derivatives from a system, by psi if given. A follower force rotates with the
 * body. */
static void matrix(const fu_model *model, const fu_load *load, const fu_state *state, const double *psi,
                   double stiffness, fu_system *system)
{
    const double scale = stiffness * factor_at(model, load, state->t);
    const int dim = model->dim;
    if (load->on.cable >= 0) {
        element_load on;
        if (scale == 0.0 || load->kind == FU_CABLE_FORCE) return;
        on_element(model, load, state->t, state->q, &on);
        const int n = on.n, first = on.first;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j)
                if (on.K[i * n + j] != 0.0) fu_add(model, system, first + i, first + j, -scale * on.K[i * n + j]);
        return;
    }
    body_load of;
    fu_point_motion motion;
    double changes[3 * FU_ATTACHMENT_COORDINATES];
    on_body(model, load, state, &of);
    fu_point_motion_at(model, &load->on, state, FU_PLACE | FU_AXES, of.f, of.m, psi, 0.0, &motion);
    const int n = motion.at.n;
    for (int i = 0; i < n && load->kind == FU_BODY_FOLLOWER; ++i) {
        double turn[3], change[3];
        for (int k = 0; k < fu_turns(dim); ++k) turn[k] = motion.by[(2 * dim + k) * n + i];
        fu_swing(dim, turn, of.f, change);
        for (int d = 0; d < dim; ++d) changes[d * n + i] = change[d];
    }
    fu_add_wrench_tangent(model, &motion.at, &motion.at, load->kind == FU_BODY_FOLLOWER ? changes : 0, 0,
                          fu_stiffness_of(&motion), -scale, system);
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    matrix(model, (const fu_load *)coupling, at->next, at->psi, at->weights.stiffness, system);
}

/* The middle moves by half of psi, which is in weights.stiffness. */
static void step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    matrix(model, (const fu_load *)coupling, at->middle, 0, at->weights.stiffness, system);
}

static const char *const kinds[] = {
    "cable_follower", "cable_moment", "body_force", "body_follower", "body_moment", "cable_force", 0};

static const fu_field fields[] = {
    FU_FIELD(fu_load, kind, FU_WORD, kinds), FU_FIELD(fu_load, signal, FU_INTEGER, 0),
    FU_FIELD(fu_load, place, FU_INTEGER, 0), FU_FIELD(fu_load, presence, FU_INTEGER, 0),
    FU_FIELD(fu_load, on, FU_ATTACHMENT, 0), FU_FIELD(fu_load, x, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_load, c, FU_REAL),     {0},
};

static const fu_supply_operations supply = {.force = rotating_force};
const fu_coupling_type fu_load_type = {.name = "load",
                                       .size = sizeof(fu_load),
                                       .fields = fields,
                                       .supply = &supply,
                                       .tangent = tangent,
                                       .step_tangent = step_tangent};

/* Subtracts gravity and loads from f. */
void fu_external_forces(const fu_model *model, double t, const double *q, double *f)
{
    fu_add_times(model->threads, model->n_dof, -1.0, model->gravity, f);
    fu_coupling_external_forces(model, t, q, f);
}
