/* Sums over elements, and over bodies by way of bodies.c: forces, energies, and the band of a Newton matrix. */
#include "engine.h"

#include <string.h>

#define CHUNK 16 /* elements whose forces are made before they are added: few enough to stay in the first cache */

/* Returns the elements of a cable from the k-th on, as block kernels take them. */
static fu_elements elements_from(const fu_cable *cable, const double *q, const double *v, int k)
{
    const long at = cable->first + (long)k * cable->per_node;
    return (fu_elements){cable->length, cable->tau,      q + at, v ? v + at : 0, cable->A + (long)k * cable->A_stride,
                         cable->per_node, cable->A_stride};
}

/* Returns how many of n elements a block kernel takes; the others go one by one. */
static int in_blocks(fu_block kernel, int n)
{
    return kernel ? n - n % FU_BLOCK_ELEMENTS : 0;
}

/* Returns how many elements come next, from the k-th on. */
static int chunk(const fu_cable *cable, int k)
{
    return cable->n_elements - k < CHUNK ? cable->n_elements - k : CHUNK;
}

static void elastic_forces(const fu_cable *cable, int n, const fu_elements *of, double *f)
{
    const fu_block block = cable->blocks ? cable->blocks->elastic_force : 0;
    int k = in_blocks(block, n);
    if (k) block(k, of, f);
    for (; k < n; ++k)
        cable->law->elastic_force(of->l, of->e + k * of->per_node, of->A + (long)k * of->A_stride,
                                  f + k * cable->coordinates);
}

static void damping_forces(const fu_cable *cable, int n, const fu_elements *of, double *f)
{
    const fu_block block = cable->blocks ? cable->blocks->damping_force : 0;
    int k = in_blocks(block, n);
    if (k) block(k, of, f);
    for (; k < n; ++k)
        cable->law->damping_force(of->l, of->e + k * of->per_node, of->v + k * of->per_node,
                                  of->A + (long)k * of->A_stride, of->tau, f + k * cable->coordinates);
}

static void elastic_tangents(const fu_cable *cable, int n, const fu_elements *of, double *K)
{
    const fu_block block = cable->blocks ? cable->blocks->elastic_tangent : 0;
    int k = in_blocks(block, n);
    if (k) block(k, of, K);
    for (; k < n; ++k)
        cable->law->elastic_tangent(of->l, of->e + k * of->per_node, of->A + (long)k * of->A_stride,
                                    K + k * cable->coordinates * cable->coordinates);
}

typedef void (*work_on)(const fu_cable *cable, int n, const fu_elements *of, double *out);

/* Lets a cable's elements write what they give, `size` numbers each, to model->parts: groups of them on as many threads as the
 * model has. The groups are those of one thread and each has its place, so that the bits do not depend on the number. */
static void on_threads(const fu_model *model, const fu_cable *cable, const double *q, int group, int size, work_on work)
{
    const int groups = (cable->n_elements + group - 1) / group;
#ifdef _OPENMP
#pragma omp parallel for num_threads(model->threads) schedule(static)
#endif
    for (int g = 0; g < groups; ++g) {
        const int k = g * group, left = cable->n_elements - k;
        const fu_elements of = elements_from(cable, q, 0, k);
        work(cable, left < group ? left : group, &of, model->parts + (long)k * size);
    }
}

/* Returns whether the compiler had OpenMP. */
int fu_has_threads(void)
{
#ifdef _OPENMP
    return 1;
#else
    return 0;
#endif
}

/* Adds what n elements from the k-th on give, one after the other, to the forces f on the dofs. */
static void add_forces(const fu_cable *cable, int k, int n, const double *part, double *f)
{
    double *at = f + cable->first + (long)k * cable->per_node;
    for (int j = 0; j < n; ++j, at += cable->per_node, part += cable->coordinates)
        for (int i = 0; i < cable->coordinates; ++i) at[i] += part[i];
}

/* Makes f = M a. */
void fu_mass_times(const fu_model *model, const double *q, const double *a, double *f)
{
    double part[FU_MAX_COORDINATES];
    for (int i = 0; i < model->n_dof; ++i) f[i] = 0.0;
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        for (int k = 0, at = cable->first; k < cable->n_elements; ++k, at += cable->per_node) {
            cable->kernel->inertia_force(cable->m, a + at, part);
            for (int i = 0; i < cable->coordinates; ++i) f[at + i] += part[i];
        }
    }
    fu_bodies_mass_times(model, q, a, f);
}

/* Adds elastic, damping and bodies' forces, as they stand on the left of the equations of motion; not those of couplings. */
void fu_internal_forces(const fu_model *model, const double *q, const double *v, double *f)
{
    double part[CHUNK * FU_MAX_COORDINATES];
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        if (model->threads > 1) {
            on_threads(model, cable, q, CHUNK, cable->coordinates, elastic_forces);
            add_forces(cable, 0, cable->n_elements, model->parts, f);
            continue;
        }
        for (int k = 0, n; k < cable->n_elements; k += n) {
            n = chunk(cable, k);
            const fu_elements of = elements_from(cable, q, v, k);
            elastic_forces(cable, n, &of, part);
            add_forces(cable, k, n, part, f);
        }
    }
    fu_rate_forces(model, q, v, f);
}

/* Adds the discrete gradients of the elastic energies over a step. */
void fu_discrete_forces(const fu_model *model, const double *q, const double *q_next, double *f)
{
    double part[FU_MAX_COORDINATES];
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        for (int k = 0, at = cable->first; k < cable->n_elements; ++k, at += cable->per_node) {
            cable->law->discrete_force(cable->length, q + at, q_next + at, cable->A + (long)k * cable->A_stride, part);
            for (int i = 0; i < cable->coordinates; ++i) f[at + i] += part[i];
        }
    }
}

/* Adds damping and bodies' forces. */
void fu_rate_forces(const fu_model *model, const double *q, const double *v, double *f)
{
    double part[CHUNK * FU_MAX_COORDINATES];
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        if (cable->tau <= 0.0 && cable->mass_damping <= 0.0) continue;
        for (int k = 0, n; k < cable->n_elements; k += n) {
            n = chunk(cable, k);
            const fu_elements of = elements_from(cable, q, v, k);
            if (cable->tau > 0.0) {
                damping_forces(cable, n, &of, part);
                add_forces(cable, k, n, part, f);
            }
            if (cable->mass_damping > 0.0) {
                for (int j = 0; j < n; ++j) {
                    double *of_element = part + j * cable->coordinates;
                    cable->kernel->inertia_force(cable->m, of.v + j * of.per_node, of_element);
                    for (int i = 0; i < cable->coordinates; ++i) of_element[i] *= cable->mass_damping;
                }
                add_forces(cable, k, n, part, f);
            }
        }
    }
    fu_bodies_forces(model, q, v, f);
}

/* Adds mass M of an element to K. */
static void add_mass(const fu_cable *cable, double mass, double *K)
{
    const int n = cable->coordinates, dim = cable->kernel->dim, vectors = n / dim;
    for (int j = 0; j < vectors; ++j)
        for (int i = 0; i < vectors; ++i)
            for (int d = 0; d < dim; ++d) K[(j * dim + d) * n + i * dim + d] += mass * cable->m[j * vectors + i];
}

/* Adds K over n dofs from `first` on to a system. */
static void add_matrix(const fu_model *model, int first, int n, const double *K, fu_system *system)
{
    const int rows = FU_BAND_ROWS(system->width), diagonal = FU_BAND_DIAGONAL(system->width), *unknown = model->unknown_of_dof + first;
    int outside_band = 0;
    for (int j = 0; j < n; ++j) outside_band |= unknown[j] <= FU_COMBINED || unknown[j] >= system->n;
    if (outside_band) {
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) fu_add(model, system, first + i, first + j, K[i * n + j]);
        return;
    }
    for (int j = 0; j < n; ++j) {
        if (unknown[j] < 0) continue;
        double *column = system->K + (long)unknown[j] * rows + diagonal - unknown[j];
        for (int i = 0; i < n; ++i)
            if (unknown[i] >= 0) column[unknown[i]] += K[i * n + j];
    }
}

/* Adds inertia M + stiffness d(forces)/dq + stiffness rate d(forces)/dv of the cables to a cleared system. */
void fu_dynamic_matrix(const fu_model *model, const double *q, const double *v, double inertia, double rate,
                       double stiffness, fu_system *system)
{
    double every[FU_BLOCK_ELEMENTS * FU_MAX_COORDINATES * FU_MAX_COORDINATES];
    double Q[FU_MAX_COORDINATES * FU_MAX_COORDINATES], *K = every;
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        const int size = cable->coordinates * cable->coordinates;
        const double mass = inertia + stiffness * rate * cable->mass_damping;
        const int threaded = model->threads > 1 && stiffness != 0.0;
        if (threaded) on_threads(model, cable, q, FU_BLOCK_ELEMENTS, size, elastic_tangents);
        for (int k = 0; k < cable->n_elements; ++k) {
            const int j = k % FU_BLOCK_ELEMENTS, left = cable->n_elements - k;
            const fu_elements of = elements_from(cable, q, v, k);
            K = every + j * size;
            if (stiffness != 0.0) {
                if (threaded) memcpy(K, model->parts + (long)k * size, sizeof(double) * (size_t)size);
                else if (j == 0) elastic_tangents(cable, left < FU_BLOCK_ELEMENTS ? left : FU_BLOCK_ELEMENTS, &of, every);
                if (cable->tau > 0.0) {
                    cable->law->damping_tangent(of.l, of.e, of.v, of.A, of.tau, rate, Q);
                    for (int i = 0; i < size; ++i) K[i] += Q[i];
                }
                for (int i = 0; i < size; ++i) K[i] *= stiffness;
            } else {
                for (int i = 0; i < size; ++i) K[i] = 0.0;
            }
            add_mass(cable, mass, K);
            add_matrix(model, cable->first + k * cable->per_node, cable->coordinates, K, system);
        }
    }
}

/* Returns the sum of e'.M e'/2 over the elements (eq 3) and the bodies' share, J. */
double fu_kinetic_energy(const fu_model *model, const double *q, const double *v)
{
    double total = 0.0, part[FU_MAX_COORDINATES];
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        for (int k = 0, at = cable->first; k < cable->n_elements; ++k, at += cable->per_node) {
            cable->kernel->inertia_force(cable->m, v + at, part);
            for (int i = 0; i < cable->coordinates; ++i) total += 0.5 * part[i] * v[at + i];
        }
    }
    return total + fu_bodies_kinetic_energy(model, q, v);
}

/* Returns the energy stored in cables, bodies and couplings, J. */
double fu_elastic_energy(const fu_model *model, const fu_state *state)
{
    const double *q = state->q;
    double total = 0.0, part;
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        for (int k = 0, at = cable->first; k < cable->n_elements; ++k, at += cable->per_node) {
            cable->law->energy(cable->length, q + at, cable->A + (long)k * cable->A_stride, &part);
            total += part;
        }
    }
    return total + fu_bodies_elastic_energy(model, q) + fu_coupling_energy(model, state);
}

/* Returns the energy of gravity, J. */
double fu_potential_energy(const fu_model *model, const double *q)
{
    double total = 0.0;
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        const int end = cable->first + (cable->n_elements + 1) * cable->per_node;
        for (int i = cable->first; i < end; ++i) total -= model->gravity[i] * q[i];
    }
    return total + fu_bodies_potential_energy(model, q);
}

/* Returns the power that damping and friction take out, W; work: see `dissipation` in coupling.h. */
double fu_dissipation(const fu_model *model, const fu_state *state, const fu_accelerator *work)
{
    const double *q = state->q, *v = state->v;
    double total = fu_bodies_dissipation(model, q, v), part[FU_MAX_COORDINATES];
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        if (cable->tau <= 0.0 && cable->mass_damping <= 0.0) continue;
        for (int k = 0, at = cable->first; k < cable->n_elements; ++k, at += cable->per_node) {
            if (cable->tau > 0.0) {
                cable->law->dissipation(cable->length, q + at, v + at, cable->A + (long)k * cable->A_stride, cable->tau,
                                        part);
                total += part[0];
            }
            if (cable->mass_damping > 0.0) {
                cable->kernel->inertia_force(cable->m, v + at, part);
                for (int i = 0; i < cable->coordinates; ++i) total += cable->mass_damping * part[i] * v[at + i];
            }
        }
    }
    return total + fu_coupling_dissipation(model, state, work);
}

/* Returns the length of the cable of a slide, m. */
double fu_length(const fu_model *model, int slide)
{
    const fu_cable *cable = &model->cables[model->slides[slide].cable];
    return cable->n_elements * cable->length;
}

/* Returns the arc-length at the first node of an element of a slide's cable, m. */
double fu_element_start(const fu_model *model, int slide, int element)
{
    return element * model->cables[model->slides[slide].cable].length;
}
