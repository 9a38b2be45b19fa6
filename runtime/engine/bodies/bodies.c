/* Bodies with a frame of any kind: sums over them, and the functions of rigid ones. */
#include "bodies/model.h"
#include "bodies/rotation.h"
#include "bodies/state.h"
#include "bodies/unknowns.h"

static void of_rigid_mass_times(const fu_body *body, const double *b, const double *a, double *f)
{
    const double rest[FU_FRAME_DOFS] = {0};
    (void)b;
    body->kernel->inertia_force(body->mass, body->J, rest, a, f);
}

/* Adds the gyroscopic moment. */
static void of_rigid_forces(const fu_body *body, const double *b, const double *w, double *f)
{
    const double none[FU_FRAME_DOFS] = {0};
    double part[FU_FRAME_DOFS];
    (void)b;
    body->kernel->inertia_force(body->mass, body->J, w, none, part);
    for (int i = body->kernel->dim; i < body->kernel->velocity; ++i) f[i] += part[i];
}

static void of_rigid_mass(const fu_body *body, const double *b, double *M)
{
    const double rest[FU_FRAME_DOFS] = {0};
    double unused[FU_FRAME_DOFS * FU_FRAME_DOFS];
    (void)b;
    body->kernel->inertia_tangent(body->mass, body->J, rest, M, unused);
}

static void of_rigid_tangent(const fu_body *body, const fu_instant *at, double *D, double *K)
{
    double unused[FU_FRAME_DOFS * FU_FRAME_DOFS];
    (void)K; /* none: in body axes it does not depend on the attitude */
    body->kernel->inertia_tangent(body->mass, body->J, at->w, unused, D);
}

static double of_rigid_kinetic_energy(const fu_body *body, const double *b, const double *w)
{
    double energy;
    (void)b;
    body->kernel->kinetic_energy(body->mass, body->J, w, &energy);
    return energy;
}

static double none_at(const fu_body *body, const double *b)
{
    (void)body, (void)b;
    return 0.0;
}

static double none_along(const fu_body *body, const double *b, const double *w)
{
    (void)body, (void)b, (void)w;
    return 0.0;
}

const fu_matter fu_rigid_matter = {
    1,       of_rigid_mass_times, of_rigid_forces, of_rigid_mass, of_rigid_tangent, of_rigid_kinetic_energy, none_at,
    none_at, none_along};

/* Returns the number of a body's dofs, of its frame and its modes. */
int fu_body_dofs(const fu_body *body)
{
    return body->kernel->velocity + body->modes;
}

/* Computes f = M a, on the bodies' dofs. */
void fu_bodies_mass_times(const fu_model *model, const double *q, const double *a, double *f)
{
    FU_EACH_BODY(body, model) body->matter->mass_times(body, q + body->configuration, a + body->dof, f + body->dof);
}

/* Adds the left side of the equations of motion at zero accelerations. */
void fu_bodies_forces(const fu_model *model, const double *q, const double *v, double *f)
{
    FU_EACH_BODY(body, model) body->matter->forces(body, q + body->configuration, v + body->dof, f + body->dof);
}

/* Adds weights.inertia M + weights.stiffness (K + weights.rate D) of a body at a state to a system; psi: its
 * displacement to there, or null. Without acceleration K is that at rest. */
static void add_body(const fu_model *model, const fu_body *body, const fu_state *at, const double *psi,
                     fu_weights weights, fu_system *system)
{
    double few[3 * FU_FRAME_DOFS * FU_FRAME_DOFS]; /* M, D, K of a rigid body */
    const int n = fu_body_dofs(body), turns = !body->matter->constant && weights.stiffness != 0.0;
    double *M = body->modes ? body->shape->matrices : few, *D = M + n * n, *K = D + n * n;
    const double *a = at->acceleration ? at->acceleration : model->zero;
    const fu_instant instant = {at->q + body->configuration, at->v + body->dof, a + body->dof};
    if (weights.inertia != 0.0) body->matter->mass(body, instant.b, M);
    if (weights.stiffness != 0.0) body->matter->tangent(body, &instant, D, K);
    if (turns && psi) fu_turn_columns(body->kernel, K, n, n, 0, psi + body->dof);
    for (int i = 0; i < n * n; ++i) {
        double value = 0.0;
        if (weights.inertia != 0.0) value += weights.inertia * M[i];
        if (weights.stiffness != 0.0) value += weights.stiffness * weights.rate * D[i];
        if (turns) value += weights.stiffness * K[i];
        M[i] = value;
    }
    fu_add_body(model, system, body->dof, n, M);
}

void fu_bodies_matrix(const fu_model *model, const fu_state *at, const double *psi, fu_weights weights,
                      fu_system *system)
{
    FU_EACH_BODY(body, model) add_body(model, body, at, psi, weights, system);
}

/* Adds M of the bodies with a constant one, or of the others. */
void fu_bodies_mass(const fu_model *model, const double *q, int constant, fu_system *system)
{
    const fu_state at = {.q = (double *)q, .v = (double *)model->zero};
    FU_EACH_BODY(body, model)
        if (body->matter->constant == constant) add_body(model, body, &at, 0, (fu_weights){1.0, 0.0, 0.0}, system);
}

double fu_bodies_kinetic_energy(const fu_model *model, const double *q, const double *v)
{
    double total = 0.0;
    FU_EACH_BODY(body, model) total += body->matter->kinetic_energy(body, q + body->configuration, v + body->dof);
    return total;
}

double fu_bodies_elastic_energy(const fu_model *model, const double *q)
{
    double total = 0.0;
    FU_EACH_BODY(body, model) total += body->matter->elastic_energy(body, q + body->configuration);
    return total;
}

/* Returns the energy of gravity, J: that of model->gravity, and the part that depends on the attitude. */
double fu_bodies_potential_energy(const fu_model *model, const double *q)
{
    double total = 0.0;
    FU_EACH_BODY(body, model) {
        const double *b = q + body->configuration;
        for (int i = 0; i < body->kernel->dim; ++i) total -= model->gravity[body->dof + i] * b[i];
        total += body->matter->potential_energy(body, b);
    }
    return total;
}

double fu_bodies_dissipation(const fu_model *model, const double *q, const double *v)
{
    double total = 0.0;
    FU_EACH_BODY(body, model) total += body->matter->dissipation(body, q + body->configuration, v + body->dof);
    return total;
}
