/* Forces and moments from outside, and their derivatives where they turn with what they act on. */
#include "bodies/rotation.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/force/loads.h"

#include <string.h>

/* Returns the value of a signal, 1 where there is none. */
static double scale_at(const fu_model *model, int signal, double t)
{
    return signal < 0 ? 1.0 : fu_signal_at(&model->signals[signal], t, 0, 0);
}

/* Does what `generalised` does, for a load c on a point of a modal body; what follows turns with the section there. */
static int on_modes(const fu_model *model, const fu_load *load, const double *c, const double *q, double *g, double *K)
{
    const fu_body *body = &model->bodies[load->on];
    const int dim = model->dim, turns = dim == 3 ? 3 : 1, n = fu_body_dofs(body);
    const double *b = q + body->configuration;
    double P[3 * FU_ATTACHMENT_COORDINATES], T[3 * FU_ATTACHMENT_COORDINATES], f[3] = {0.0}, m[3] = {0.0};
    fu_modal_point at;
    if (load->kind == FU_BODY_FOLLOWER) {
        fu_modal_attachment_follower(body, &load->modal, b, c, g, K);
        return n;
    }
    fu_modal_attachment_state(body, &load->modal, b, model->zero, &at, P, T);
    if (load->kind == FU_BODY_MOMENT) memcpy(m, c + (dim == 2 ? 2 : 0), sizeof(double) * (size_t)turns);
    else memcpy(f, c, sizeof(double) * (size_t)dim);
    for (int i = 0; i < n; ++i) {
        g[i] = 0.0;
        for (int d = 0; d < dim; ++d) g[i] += P[d * n + i] * f[d];
        for (int d = 0; d < turns; ++d) g[i] += T[d * n + i] * m[d];
    }
    fu_modal_attachment_force(body, &load->modal, b, f, m, K);
    return n;
}

/* Makes the generalised force g of the part of a load that acts, at unit signal, and its derivative K by the dofs (row
 * by row); returns their number, and the first dof. On a body: translation of the force c, rotation of its moment about
 * the mass centre. */
static int generalised(const fu_model *model, const fu_load *load, const double *q, double *g, double *K, int *first)
{
    double c[3];
    for (int d = 0; d < 3; ++d) c[d] = model->load_fraction * load->c[d];
    if (load->kind == FU_CABLE_FOLLOWER || load->kind == FU_CABLE_MOMENT) {
        const fu_cable *cable = &model->cables[load->on];
        *first = cable->first + load->element * cable->per_node;
        (load->kind == FU_CABLE_MOMENT ? cable->kernel->moment : cable->kernel->follower_force)(
            fu_element_length(cable, load->element), load->x, q + *first, c, g, K);
        return cable->coordinates;
    }
    const fu_body *body = &model->bodies[load->on];
    const fu_body_kernels *kernel = body->kernel;
    const double *b = q + body->configuration;
    *first = body->dof;
    if (body->modes) return on_modes(model, load, c, q, g, K);
    if (load->kind == FU_BODY_FORCE) kernel->force(b, load->u, c, g, K);
    else if (load->kind == FU_BODY_FOLLOWER) kernel->follower_force(b, load->u, c, g, K);
    else kernel->moment(b, c + (kernel->dim == 2 ? 2 : 0), g, K);
    return kernel->velocity;
}

static void dead_force(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double *f)
{
    const fu_dead_load *load = (const fu_dead_load *)coupling;
    const double scale = scale_at(model, load->signal, t);
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

const fu_coupling_type fu_dead_load_type = {
    .name = "dead load", .size = sizeof(fu_dead_load), .fields = dead_fields, .external_force = dead_force};

static void external_force(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double *f)
{
    const fu_load *load = (const fu_load *)coupling;
    double g[FU_ATTACHMENT_COORDINATES], K[FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES];
    const double scale = scale_at(model, load->signal, t);
    int first;
    const int n = generalised(model, load, q, g, K, &first);
    for (int i = 0; i < n; ++i) f[first + i] -= scale * g[i];
}

/* Subtracts stiffness times the load's derivatives from a system, by psi where that is given. */
static void matrix(const fu_model *model, const fu_load *load, double t, const double *q, const double *psi,
                   double stiffness, fu_system *system)
{
    double g[FU_ATTACHMENT_COORDINATES], K[FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES];
    const double scale = stiffness * scale_at(model, load->signal, t);
    int first;
    const int n = generalised(model, load, q, g, K, &first);
    if (psi && load->kind >= FU_BODY_FORCE) fu_turn_columns(model->bodies[load->on].kernel, K, n, n, 0, psi + first);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            if (K[i * n + j] != 0.0) fu_add(model, system, first + i, first + j, -scale * K[i * n + j]);
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    matrix(model, (const fu_load *)coupling, at->next->t, at->next->q, at->psi, at->weights.stiffness, system);
}

/* The middle moves by half of psi, which weights.stiffness has. */
static void step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    matrix(model, (const fu_load *)coupling, at->middle->t, at->middle->q, 0, at->weights.stiffness, system);
}

static const char *const kinds[] = {"cable_follower", "cable_moment", "body_force", "body_follower", "body_moment", 0};

static const fu_field fields[] = {
    FU_FIELD(fu_load, kind, FU_WORD, kinds),
    FU_FIELD(fu_load, signal, FU_INTEGER, 0),
    FU_FIELD(fu_load, on, FU_INTEGER, 0),
    FU_FIELD(fu_load, element, FU_INTEGER, 0),
    FU_FIELD(fu_load, x, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_load, u, FU_REAL),
    FU_FIELD_ARRAY(fu_load, c, FU_REAL),
    FU_FIELD(fu_load, modal, FU_MODAL_POINT, 0),
    {0},
};

const fu_coupling_type fu_load_type = {.name = "load",
                                       .size = sizeof(fu_load),
                                       .fields = fields,
                                       .external_force = external_force,
                                       .tangent = tangent,
                                       .step_tangent = step_tangent};

/* Subtracts gravity and loads from f. */
void fu_external_forces(const fu_model *model, double t, const double *q, double *f)
{
    fu_add_times(model->threads, model->n_dof, -1.0, model->gravity, f);
    fu_coupling_external_forces(model, t, q, f);
}
