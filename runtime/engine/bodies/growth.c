/* Cables whose stress-free length grows by a factor g, with temperature or as a signal prescribes; their mass stays.
 *
 * An element of length l has the energy of one of length g l: with the arc-length g x of the grown material, slopes are
 * r_x/g, second derivatives r_xx/g^2, and positions and directors stay. Sections keep their dimensions and stiffness.
 *     U(g, e) = U_law(g l, T e),   f = T f_law,   K = T K_law T,
 * where T divides by the powers of g.
 *
 * The factor of a cable, or those of its pieces, may be dofs that signals prescribe; the force on one is the derivative
 * of the energy by g. The laws of cables are sums of EA l F and EI/l H, where F and H are functions of the strain
 * vectors: differences of positions over l, slopes, and second derivatives times l, all of which are in proportion to
 * 1/g. Hence
 *     g dU/dg = U_EA - U_EI - f_law . D T e,   and rates of strain are those by the rates T v - g'/g D T e
 * of the vectors at constant length, where D takes the positions from that of the first node, and leaves out directors.
 * (The factor EI/l counts as constant in the damping of bending.) Over a step of the energy-momentum method, whose
 * forces on the nodes are at the mean factor, the force on the factor times its change is the rest of the change of the
 * energy.
 *
 * The constants of the laws of beams depend on the length of the element, and those of a curved stress-free shape on
 * its growth: A(g), as Chebyshev polynomials of g between the bounds of its signal, to rounding (model/constants.py).
 * The energy at given coordinates is then a smooth function of g alone, and the force on the factor its difference of
 * the sixth order, with an error of rounding: nothing but the work of the signal depends on it. */
#include "bodies/growth.h"
#include "bodies/model.h"

static const double *vectors_of(const fu_cable *cable, int element, const double *q)
{
    return q + fu_element_entry(cable, element);
}

/* Returns the order of the derivative by the arc-length of a coordinate of an element. */
static int order_of(const fu_cable *cable, int coordinate)
{
    return cable->orders[coordinate / cable->kernel->dim % cable->kernel->vectors];
}

/* Returns 1/g to an order. */
static double power_of(double g, int order)
{
    double power = 1.0;
    for (int i = 0; i < order; ++i) power /= g;
    return power;
}

/* Returns what precedes the series of an element's constants: the middle of the factors, the inverse of half their
 * range, the step of differences. */
static const double *series_of(const fu_cable *cable, int element)
{
    const long size = FU_SERIES_HEAD + (long)cable->terms * cable->A_size;
    return cable->growth_series + (cable->A_stride ? element * size : 0);
}

/* Returns the constants of the law of an element with the factor g, by Clenshaw's recurrence where they depend on it.
 */
static const double *constants_with(const fu_cable *cable, int element, double g, double *made)
{
    if (!cable->growth_series) return fu_element_constants(cable, element);
    const double *head = series_of(cable, element), *series = head + FU_SERIES_HEAD, x = (g - head[0]) * head[1];
    const int n = cable->A_size;
    for (int i = 0; i < n; ++i) {
        double sum = 0.0, before = 0.0;
        for (int k = cable->terms - 1; k > 0; --k) {
            const double next = 2.0 * x * sum - before + series[k * n + i];
            before = sum;
            sum = next;
        }
        made[i] = series[i] + x * sum - before;
    }
    return made;
}

/* Computes length, constants and vectors of an element, whose coordinates are e, with the factor g. */
void fu_grow(const fu_cable *cable, int element, double g, const double *e, fu_grown *grown)
{
    grown->g = g;
    grown->l = g * fu_element_length(cable, element);
    grown->rate = 0.0;
    grown->A = constants_with(cable, element, g, grown->made);
    for (int i = 0; i < cable->coordinates; ++i) grown->e[i] = power_of(g, order_of(cable, i)) * e[i];
}

/* Returns a component of D T e. */
static double relative(const fu_cable *cable, const fu_grown *grown, int i)
{
    const int order = order_of(cable, i), is_position = i % cable->per_node < cable->kernel->dim;
    if (order) return grown->e[i];
    return is_position && i >= cable->per_node ? grown->e[i] - grown->e[i - cable->per_node] : 0.0;
}

/* Computes the rates of the vectors of a grown element from those of its coordinates and of its factor. */
void fu_grow_rates(const fu_cable *cable, double rate, const double *v, fu_grown *grown)
{
    grown->rate = rate;
    for (int i = 0; i < cable->coordinates; ++i)
        grown->v[i] = power_of(grown->g, order_of(cable, i)) * v[i] - rate / grown->g * relative(cable, grown, i);
}

/* Turns forces on the vectors of a grown element into those on its coordinates. */
void fu_forces_on_given(const fu_cable *cable, double g, double *f)
{
    for (int i = 0; i < cable->coordinates; ++i) f[i] *= power_of(g, order_of(cable, i));
}

/* The same of a matrix over coordinates, or over nodal vectors. */
static void matrix_of_given(const fu_cable *cable, double g, int n, int dim, double *K)
{
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) K[i * n + j] *= power_of(g, order_of(cable, i * dim) + order_of(cable, j * dim));
}

/* Returns the force on the factor by forces on the vectors of a grown element, whose rates the factor's rate changes.
 */
double fu_growth_force(const fu_cable *cable, const fu_grown *grown, const double *f)
{
    double power = 0.0;
    for (int i = 0; i < cable->coordinates; ++i) power += f[i] * relative(cable, grown, i);
    return -power / grown->g;
}

static void grow_at(const fu_cable *cable, int element, const double *q, fu_grown *grown)
{
    fu_grow(cable, element, fu_growth(cable, element, q), vectors_of(cable, element, q), grown);
}

static void grow_moving(const fu_cable *cable, int element, const double *q, const double *v, fu_grown *grown)
{
    grow_at(cable, element, q, grown);
    fu_grow_rates(cable, fu_growth(cable, element, v), vectors_of(cable, element, v), grown);
}

void fu_grown_elastic_force(const fu_cable *cable, int element, const double *q, double *f)
{
    fu_grown grown;
    grow_at(cable, element, q, &grown);
    cable->law->elastic_force(grown.l, grown.e, grown.A, f);
    fu_forces_on_given(cable, grown.g, f);
}

void fu_grown_elastic_tangent(const fu_cable *cable, int element, const double *q, double *K)
{
    fu_grown grown;
    grow_at(cable, element, q, &grown);
    cable->law->elastic_tangent(grown.l, grown.e, grown.A, K);
    matrix_of_given(cable, grown.g, cable->coordinates, 1, K);
}

void fu_grown_damping_force(const fu_cable *cable, int element, const double *q, const double *v, double *f)
{
    fu_grown grown;
    grow_moving(cable, element, q, v, &grown);
    cable->law->damping_force(grown.l, grown.e, grown.v, grown.A, fu_piece_of(cable, element)->tau, f);
    fu_forces_on_given(cable, grown.g, f);
}

/* The rate of the factor is small beside the rate of an integrator: its part in the matrix is left out. */
void fu_grown_damping_tangent(const fu_cable *cable, int element, const double *q, const double *v, double rate,
                              double *K)
{
    fu_grown grown;
    grow_moving(cable, element, q, v, &grown);
    cable->law->damping_tangent(grown.l, grown.e, grown.v, grown.A, fu_piece_of(cable, element)->tau, rate, K);
    matrix_of_given(cable, grown.g, cable->coordinates, 1, K);
}

double fu_grown_dissipation(const fu_cable *cable, int element, const double *q, const double *v)
{
    fu_grown grown;
    double power;
    grow_moving(cable, element, q, v, &grown);
    cable->law->dissipation(grown.l, grown.e, grown.v, grown.A, fu_piece_of(cable, element)->tau, &power);
    return power;
}

/* Returns the energy of an element in a configuration with the factor g, J. */
static double energy_with(const fu_cable *cable, int element, double g, const double *q)
{
    fu_grown grown;
    double energy;
    fu_grow(cable, element, g, vectors_of(cable, element, q), &grown);
    cable->law->energy(grown.l, grown.e, grown.A, &energy);
    return energy;
}

double fu_grown_energy(const fu_cable *cable, int element, const double *q)
{
    return energy_with(cable, element, fu_growth(cable, element, q), q);
}

/* Computes an element at both ends of a step with the mean factor, which it returns. */
static double grow_over(const fu_cable *cable, int element, const double *q, const double *q_next, fu_grown *now,
                        fu_grown *next)
{
    const double g = 0.5 * (fu_growth(cable, element, q) + fu_growth(cable, element, q_next));
    fu_grow(cable, element, g, vectors_of(cable, element, q), now);
    fu_grow(cable, element, g, vectors_of(cable, element, q_next), next);
    return g;
}

void fu_grown_discrete_force(const fu_cable *cable, int element, const double *q, const double *q_next, double *f)
{
    fu_grown now, next;
    const double g = grow_over(cable, element, q, q_next, &now, &next);
    cable->law->discrete_force(now.l, now.e, next.e, now.A, f);
    fu_forces_on_given(cable, g, f);
}

/* Computes the Newton matrix of these forces over nodal vectors beyond the tangent half-way. */
void fu_grown_step_stiffness(const fu_cable *cable, int element, const double *q, const double *q_next, double *k)
{
    fu_grown now, next;
    const double g = grow_over(cable, element, q, q_next, &now, &next);
    cable->law->step_stiffness(now.l, now.e, next.e, now.A, k);
    matrix_of_given(cable, g, cable->coordinates / cable->kernel->dim, cable->kernel->dim, k);
}

/* Loops over the elements of the cables whose growth a signal prescribes. */
#define EACH_GROWING_ELEMENT(cable, k, model)                                                                          \
    FU_EACH_CABLE(cable, model)                                                                                        \
        for (int k = 0; cable->grows && k < cable->n_elements; ++k)

/* Returns the derivative by g of the energy of an element whose law has constants A(g), N m. */
static double energy_slope(const fu_cable *cable, int element, const double *q)
{
    static const double weights[] = {45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0};
    const double g = fu_growth(cable, element, q), step = series_of(cable, element)[2];
    double slope = 0.0;
    for (int i = 0; i < 3; ++i) {
        const double h = (i + 1) * step;
        slope += weights[i] * (energy_with(cable, element, g + h, q) - energy_with(cable, element, g - h, q));
    }
    return slope / step;
}

/* Adds the derivatives of the elastic energies by the factors to the forces on their dofs. */
void fu_add_growth_forces(const fu_model *model, const double *q, double *f)
{
    double force[FU_MAX_COORDINATES], energy;
    EACH_GROWING_ELEMENT(cable, k, model)
    {
        fu_grown grown;
        double *on_factor = f + fu_growth_dof(cable, k);
        if (cable->growth_series) {
            *on_factor += energy_slope(cable, k, q);
            continue;
        }
        grow_at(cable, k, q, &grown);
        cable->law->elastic_force(grown.l, grown.e, grown.A, force);
        cable->law->energy(grown.l, grown.e, cable->growth_constants + (long)k * cable->A_stride, &energy);
        *on_factor += energy / grown.g + fu_growth_force(cable, &grown, force);
    }
}

/* Adds the parts of damping to the forces on the dofs of the factors. */
void fu_add_growth_rate_forces(const fu_model *model, const double *q, const double *v, double *f)
{
    double force[FU_MAX_COORDINATES];
    EACH_GROWING_ELEMENT(cable, k, model)
    {
        fu_grown grown;
        const double tau = fu_piece_of(cable, k)->tau;
        if (!(tau > 0.0)) continue;
        grow_moving(cable, k, q, v, &grown);
        cable->law->damping_force(grown.l, grown.e, grown.v, grown.A, tau, force);
        f[fu_growth_dof(cable, k)] += fu_growth_force(cable, &grown, force);
    }
}

/* Adds the forces on the factors over a step: none where the factor stays, for they do no work. */
void fu_add_discrete_growth_forces(const fu_model *model, const double *q, const double *q_next, double *f)
{
    EACH_GROWING_ELEMENT(cable, k, model)
    {
        const double from = fu_growth(cable, k, q), to = fu_growth(cable, k, q_next), mean = 0.5 * (from + to);
        if (to == from) continue;
        f[fu_growth_dof(cable, k)] += (energy_with(cable, k, to, q_next) - energy_with(cable, k, mean, q_next) +
                                       energy_with(cable, k, mean, q) - energy_with(cable, k, from, q)) /
                                      (to - from);
    }
}
