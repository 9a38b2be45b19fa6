/* Ice on a cable: a ring of the thickness s(t) about the diameter d, with the mass per length
 *     m = rho pi s (d + s),   m' = rho pi (d + 2 s) s'.
 * It moves with the axis of the cable: with the shape functions N of an element and S = int N N', c = int N, its
 * kinetic energy is m/2 v'S v, its energy of gravity -m g . c q. Ice grows and falls off with the velocity of the
 * cable, so that no thrust acts: m S (a - g) is its force on the left side of the equations, and the energy m' (v'S v/2
 * - g . c q) that new ice brings, or that lost ice takes along, is external. Ice has no stiffness and no rotary
 * inertia. */
#include "couplings/ice/ice.h"
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/accelerator.h"

#include <string.h>

#define PI 3.141592653589793

static const fu_ice *of(const fu_coupling *coupling)
{
    return (const fu_ice *)coupling;
}

double fu_ice_thickness(const fu_model *model, int signal, double factor, double t, double *rate)
{
    if (rate) *rate = 0.0;
    if (signal < 0) return factor;
    const double thickness = factor * fu_signal_at(&model->signals[signal], t, rate, 0);
    if (rate) *rate *= factor;
    return thickness;
}

/* Returns the mass of a length, kg/m, and computes its rate, kg/m/s. */
static double mass_at(const fu_model *model, const fu_ice *ice, double t, double *rate)
{
    double growth;
    const double s = fu_ice_thickness(model, ice->signal, ice->factor, t, &growth);
    if (rate) *rate = ice->density * PI * (ice->diameter + 2.0 * s) * growth;
    return ice->density * PI * s * (ice->diameter + s);
}

/* The tables of an element, and its first dof. */
typedef struct {
    const double *products, *shares;
    int first, n;
} element_of_ice;

static element_of_ice element_at(const fu_model *model, const fu_ice *ice, int k)
{
    const fu_cable *cable = &model->cables[ice->cable];
    const int n = cable->coordinates / model->dim;
    return (element_of_ice){ice->products + (long)k * ice->stride * n * n, ice->shares + (long)k * ice->stride * n,
                            fu_element_entry(cable, ice->first + k), n};
}

/* Adds the weight to the left side of the equations of motion. */
static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    const fu_ice *ice = of(coupling);
    const double m = model->load_fraction * mass_at(model, ice, state->t, 0);
    for (int k = 0; k < ice->n_elements; ++k) {
        const element_of_ice it = element_at(model, ice, k);
        for (int i = 0; i < it.n; ++i)
            for (int d = 0; d < model->dim; ++d) f[it.first + i * model->dim + d] -= m * it.shares[i] * ice->gravity[d];
    }
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                     double *internal)
{
    (void)internal;
    force(model, coupling, at->next, f);
}

static void inertia_force(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                          const double *a, double *f)
{
    const fu_ice *ice = of(coupling);
    const double m = mass_at(model, ice, t, 0);
    (void)q;
    for (int k = 0; k < ice->n_elements; ++k) {
        const element_of_ice it = element_at(model, ice, k);
        for (int i = 0; i < it.n; ++i)
            for (int j = 0; j < it.n; ++j)
                for (int d = 0; d < model->dim; ++d)
                    f[it.first + i * model->dim + d] +=
                        m * it.products[i * it.n + j] * a[it.first + j * model->dim + d];
    }
}

static void mass_matrix(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double scale,
                        fu_system *system)
{
    const fu_ice *ice = of(coupling);
    const double m = scale * mass_at(model, ice, t, 0);
    const int dim = model->dim;
    double K[FU_MAX_COORDINATES * FU_MAX_COORDINATES];
    (void)q;
    for (int k = 0; k < ice->n_elements; ++k) {
        const element_of_ice it = element_at(model, ice, k);
        const int all = it.n * dim;
        memset(K, 0, sizeof(double) * (size_t)(all * all));
        for (int i = 0; i < it.n; ++i)
            for (int j = 0; j < it.n; ++j)
                for (int d = 0; d < dim; ++d) K[(i * dim + d) * all + j * dim + d] = m * it.products[i * it.n + j];
        fu_add_element_matrix(model, it.first, all, K, system);
    }
}

/* Returns v'S v/2, m^3/s^2. */
static double half_square(const fu_model *model, const fu_ice *ice, const double *v)
{
    double sum = 0.0;
    for (int k = 0; k < ice->n_elements; ++k) {
        const element_of_ice it = element_at(model, ice, k);
        for (int i = 0; i < it.n; ++i)
            for (int j = 0; j < it.n; ++j)
                sum += 0.5 * it.products[i * it.n + j] *
                       fu_dot(model->dim, v + it.first + i * model->dim, v + it.first + j * model->dim);
    }
    return sum;
}

/* Returns -g . c q, m^3/s^2. */
static double height(const fu_model *model, const fu_ice *ice, const double *q)
{
    double sum = 0.0;
    for (int k = 0; k < ice->n_elements; ++k) {
        const element_of_ice it = element_at(model, ice, k);
        for (int i = 0; i < it.n; ++i)
            sum -= it.shares[i] * fu_dot(model->dim, ice->gravity, q + it.first + i * model->dim);
    }
    return sum;
}

static double kinetic_energy(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                             const double *v, int past_fluid)
{
    (void)q, (void)past_fluid;
    return mass_at(model, of(coupling), t, 0) * half_square(model, of(coupling), v);
}

static double potential_energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    return model->load_fraction * mass_at(model, of(coupling), state->t, 0) * height(model, of(coupling), state->q);
}

static double external_power(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    double rate;
    mass_at(model, of(coupling), state->t, &rate);
    if (rate == 0.0) return 0.0;
    return rate * (half_square(model, of(coupling), state->v) + height(model, of(coupling), state->q));
}

/* Of the length under ice: its thickness, m, and its mass, kg. */
typedef struct {
    double thickness, mass;
} fu_ice_output;

static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    const fu_ice *ice = of(coupling);
    fu_ice_output *numbers = (fu_ice_output *)out;
    (void)acceleration, (void)work;
    numbers->thickness = fu_ice_thickness(model, ice->signal, ice->factor, state->t, 0);
    numbers->mass = ice->length * mass_at(model, ice, state->t, 0);
}

/* It has no equations over a step that conserves energy: the mass at the middle of a step is not that of its ends. */
static int has_step(const fu_coupling *coupling)
{
    (void)coupling;
    return 0;
}

static const fu_field fields[] = {
    FU_FIELD(fu_ice, cable, FU_INTEGER, 0),
    FU_FIELD(fu_ice, first, FU_INTEGER, 0),
    FU_FIELD(fu_ice, n_elements, FU_INTEGER, 0),
    FU_FIELD(fu_ice, signal, FU_INTEGER, 0),
    FU_FIELD(fu_ice, factor, FU_REAL, 0),
    FU_FIELD(fu_ice, diameter, FU_REAL, 0),
    FU_FIELD(fu_ice, density, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_ice, gravity, FU_REAL),
    FU_FIELD(fu_ice, length, FU_REAL, 0),
    FU_FIELD(fu_ice, stride, FU_INTEGER, 0),
    FU_FIELD(fu_ice, products, FU_REALS, 0),
    FU_FIELD(fu_ice, shares, FU_REALS, 0),
    {0},
};

static const fu_output output_fields[] = {
    FU_OUTPUT(fu_ice_output, thickness, "m", NULL),
    FU_OUTPUT(fu_ice_output, mass, "kg", NULL),
    FU_LAST_OUTPUT(fu_ice_output),
};

static const fu_inertia_operations inertia = {.force = inertia_force,
                                              .matrix = mass_matrix,
                                              .kinetic_energy = kinetic_energy,
                                              .potential_energy = potential_energy};
static const fu_supply_operations supply = {.power = external_power};

const fu_coupling_type fu_ice_type = {
    .name = "ice",
    .size = sizeof(fu_ice),
    .fields = fields,
    .output_fields = output_fields,
    .residual = residual,
    .has_step = has_step,
    .force = force,
    .outputs = outputs,
    .inertia = &inertia,
    .supply = &supply,
};
