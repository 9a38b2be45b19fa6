/* Sums over elements, and over bodies through bodies.c: forces, energies, and the band of a Newton matrix. */
#include "base/simd.h"
#include "bodies/growth.h"
#include "bodies/model.h"
#include "bodies/unknowns.h"

#include <string.h>

/* elements whose forces are computed before they are added: few enough for the first-level cache */
#define CHUNK 16

/* Returns the elements of a cable from the k-th on, in the form of block kernels. */
static fu_elements elements_from(const fu_cable *cable, const double *q, const double *v, int k)
{
    const long at = fu_element_entry(cable, k);
    return (fu_elements){cable->lengths + (long)k * cable->l_stride,
                         fu_piece_of(cable, k)->tau,
                         q + at,
                         v ? v + at : 0,
                         fu_element_constants(cable, k),
                         cable->per_node,
                         cable->A_stride,
                         cable->l_stride};
}

/* Returns the number of n elements that a block kernel takes. A single one behind whole blocks is evaluated alone,
 * since a block takes longer. */
static int in_blocks(fu_block kernel, int n)
{
    return kernel ? n - (n % FU_BLOCK_ELEMENTS == 1) : 0;
}

/* Returns the number of elements from the k-th on, of one piece, up to a multiple of a size. */
static int chunk(const fu_cable *cable, int k, int size)
{
    const int end = fu_piece_of(cable, k)->end, next = k - k % size + size;
    return (end < next ? end : next) - k;
}

/* A sum of forces that threads share: of a cable's elements, to f; one or two forces of each group of elements. */
typedef struct sum sum;

/* Computes the contributions of n elements of a cable, from the first on, one after the other. */
typedef void (*work_on)(const sum *job, int first, int n, const fu_elements *of, double *out);

struct sum {
    const fu_model *model;
    const fu_cable *cable;
    const double *q, *v;
    work_on forces[2];
    double *f;
};

static void elastic_forces(const sum *job, int first, int n, const fu_elements *of, double *f)
{
    const fu_cable *cable = job->cable;
    const fu_block block = cable->blocks ? cable->blocks->elastic_force : 0;
    if (cable->growth >= 0) {
        for (int k = 0; k < n; ++k) fu_grown_elastic_force(cable, first + k, job->q, f + k * cable->coordinates);
        return;
    }
    int k = in_blocks(block, n);
    if (k) block(k, of, f);
    for (; k < n; ++k)
        cable->law->elastic_force(of->l[k * of->l_stride], of->e + k * of->per_node, of->A + (long)k * of->A_stride,
                                  f + k * cable->coordinates);
}

static void damping_forces(const sum *job, int first, int n, const fu_elements *of, double *f)
{
    const fu_cable *cable = job->cable;
    const fu_block block = cable->blocks ? cable->blocks->damping_force : 0;
    if (cable->growth >= 0) {
        for (int k = 0; k < n; ++k)
            fu_grown_damping_force(cable, first + k, job->q, job->v, f + k * cable->coordinates);
        return;
    }
    int k = in_blocks(block, n);
    if (k) block(k, of, f);
    for (; k < n; ++k)
        cable->law->damping_force(of->l[k * of->l_stride], of->e + k * of->per_node, of->v + k * of->per_node,
                                  of->A + (long)k * of->A_stride, of->tau, f + k * cable->coordinates);
}

/* Computes M v. */
static void inertia_forces(const sum *job, int first, int n, const fu_elements *of, double *f)
{
    const fu_cable *cable = job->cable;
    for (int k = 0; k < n; ++k)
        cable->kernel->inertia_force(fu_element_mass(cable, first + k), of->v + k * of->per_node,
                                     f + k * cable->coordinates);
}

static void mass_damping_forces(const sum *job, int first, int n, const fu_elements *of, double *f)
{
    const double mass_damping = fu_piece_of(job->cable, first)->mass_damping;
    inertia_forces(job, first, n, of, f);
    for (int i = 0; i < n * job->cable->coordinates; ++i) f[i] *= mass_damping;
}

static void elastic_tangents(const fu_cable *cable, const double *q, int first, int n, const fu_elements *of, double *K)
{
    const int size = cable->coordinates * cable->coordinates;
    if (cable->growth >= 0) {
        for (int k = 0; k < n; ++k) fu_grown_elastic_tangent(cable, first + k, q, K + k * size);
        return;
    }
    const fu_block block = cable->blocks ? cable->blocks->elastic_tangent : 0;
    int k = in_blocks(block, n);
    if (k) block(k, of, K);
    for (; k < n; ++k)
        cable->law->elastic_tangent(of->l[k * of->l_stride], of->e + k * of->per_node, of->A + (long)k * of->A_stride,
                                    K + k * size);
}

/* to[i] += from[i] for n numbers */
FU_INLINE void add_numbers(int n, const double *from, double *to)
{
    int i = 0;
    for (; i + FU_SIMD_WIDTH <= n; i += FU_SIMD_WIDTH) *(fu_simd_block *)(to + i) += *(const fu_simd_block *)(from + i);
    for (; i < n; ++i) to[i] += from[i];
}

/* x[i] *= factor for n numbers */
FU_INLINE void scale_numbers(int n, double factor, double *x)
{
    int i = 0;
    for (; i + FU_SIMD_WIDTH <= n; i += FU_SIMD_WIDTH) *(fu_simd_block *)(x + i) *= factor;
    for (; i < n; ++i) x[i] *= factor;
}

/* Adds the contributions of n elements of a part from the k-th on. */
static void add_group(const sum *job, int k, int n, const double *from, double *first)
{
    const fu_cable *cable = job->cable;
    double *at = job->f + fu_element_entry(cable, k);
    const int left = first ? cable->per_node : 0;
    for (int i = 0; i < left; ++i) first[i] = from[i];
    add_numbers(cable->coordinates - left, from + left, at + left);
    for (int j = 1; j < n; ++j) {
        at += cable->per_node;
        from += cable->coordinates;
        add_numbers(cable->coordinates, from, at);
    }
}

/* Returns the contribution of one of the forces to the first node of a part. */
static double *on_first_node(const sum *job, int part, int which)
{
    return job->model->thread_work + (2 * part + which) * job->cable->per_node;
}

/* Adds a part of the elements, in the groups of one thread. `add_sum` adds the contributions to the first node of all
 * parts but the first, since another thread adds to that node. */
static void add_part(const void *what, int part, int parts)
{
    const sum *job = what;
    const fu_range range = fu_part_of(job->cable->n_elements, CHUNK, part, parts);
    double out[CHUNK * FU_MAX_COORDINATES];
    for (int k = range.first, n; k < range.end; k += n) {
        n = chunk(job->cable, k, CHUNK);
        const fu_elements of = elements_from(job->cable, job->q, job->v, k);
        for (int which = 0; which < 2 && job->forces[which]; ++which) {
            job->forces[which](job, k, n, &of, out);
            add_group(job, k, n, out, part && k == range.first ? on_first_node(job, part, which) : 0);
        }
    }
}

/* Adds the forces to those on the dofs: on each node those of the element before it, then those of the element after
 * it, for any number of threads. */
static void add_sum(const sum *job)
{
    const fu_cable *cable = job->cable;
    const int parts = fu_share(job->model->threads, cable->n_elements * cable->per_node, add_part, job);
    for (int part = 1; part < parts; ++part) {
        const fu_range range = fu_part_of(cable->n_elements, CHUNK, part, parts);
        double *at = job->f + fu_element_entry(cable, range.first);
        for (int which = 0; which < 2 && job->forces[which] && range.first < range.end; ++which)
            for (int i = 0; i < cable->per_node; ++i) at[i] += on_first_node(job, part, which)[i];
    }
}

static void clear_part(const void *what, int part, int parts)
{
    const sum *job = what;
    const fu_range range = fu_part_of(job->model->n_dof, CHUNK, part, parts);
    for (int i = range.first; i < range.end; ++i) job->f[i] = 0.0;
}

/* Computes f = M a of cables and bodies. */
void fu_constant_mass_times(const fu_model *model, const double *q, const double *a, double *f)
{
    const sum job = {.model = model, .f = f};
    fu_share(model->threads, model->n_dof, clear_part, &job);
    for (int c = 0; c < model->n_cables; ++c) {
        const sum inertia = {model, &model->cables[c], q, a, {inertia_forces}, f};
        add_sum(&inertia);
    }
    fu_bodies_mass_times(model, q, a, f);
}

/* Adds elastic, damping and body forces, with the signs of the left side of the equations of motion, without
 * couplings. */
void fu_internal_forces(const fu_model *model, const double *q, const double *v, double *f)
{
    for (int c = 0; c < model->n_cables; ++c) {
        const sum elastic = {model, &model->cables[c], q, v, {elastic_forces}, f};
        add_sum(&elastic);
    }
    fu_add_growth_forces(model, q, f);
    fu_rate_forces(model, q, v, f);
}

/* Adds the discrete gradients of the elastic energies over a step. */
void fu_discrete_forces(const fu_model *model, const double *q, const double *q_next, double *f)
{
    double part[FU_MAX_COORDINATES];
    FU_EACH_CABLE(cable, model) {
        FU_EACH_ELEMENT(k, at, cable)
        {
            if (cable->growth >= 0) fu_grown_discrete_force(cable, k, q, q_next, part);
            else
                cable->law->discrete_force(fu_element_length(cable, k), q + at, q_next + at,
                                           fu_element_constants(cable, k), part);
            for (int i = 0; i < cable->coordinates; ++i) f[at + i] += part[i];
        }
    }
    fu_add_discrete_growth_forces(model, q, q_next, f);
}

/* Adds damping and bodies' forces. */
void fu_rate_forces(const fu_model *model, const double *q, const double *v, double *f)
{
    FU_EACH_CABLE(cable, model) {
        const work_on by_mass = cable->mass_damping > 0.0 ? mass_damping_forces : 0;
        const work_on first = cable->tau > 0.0 ? damping_forces : by_mass;
        const sum rates = {model, cable, q, v, {first, first == by_mass ? 0 : by_mass}, f};
        if (first) add_sum(&rates);
    }
    fu_add_growth_rate_forces(model, q, v, f);
    fu_bodies_forces(model, q, v, f);
}

/* Adds mass M of the k-th element to K. */
static void add_mass(const fu_cable *cable, int k, double mass, double *K)
{
    const double *m = fu_element_mass(cable, k);
    const int n = cable->coordinates, dim = cable->kernel->dim, vectors = n / dim;
    for (int j = 0; j < vectors; ++j, K += dim * n)
        for (int i = 0; i < vectors; ++i) {
            const double of = mass * m[j * vectors + i];
            for (int d = 0; d < dim; ++d) K[i * dim + d * (n + 1)] += of;
        }
}

/* K[m] += scale[m] row[m] for n numbers */
FU_INLINE void add_row(int n, const double *scale, const double *row, double *K)
{
    int m = 0;
    for (; m + FU_SIMD_WIDTH <= n; m += FU_SIMD_WIDTH)
        *(fu_simd_block *)(K + m) += *(const fu_simd_block *)(scale + m) * *(const fu_simd_block *)(row + m);
    for (; m < n; ++m) K[m] += scale[m] * row[m];
}

FU_INLINE void add_element_product(int dim, int n, double factor, const double *a, const double *b, const double *by,
                                   double *K)
{
    double rows[3 * FU_MAX_COORDINATES], right[FU_MAX_COORDINATES], scale[FU_MAX_COORDINATES]; /* as rows of K */
    for (int m = 0, l = 0; m < n; ++l)
        for (int j = 0; j < dim; ++j, ++m) {
            right[m] = b[l];
            for (int i = 0; i < dim; ++i) rows[i * n + m] = by[i * dim + j];
        }
    for (int k = 0; k < n / dim; ++k) {
        for (int m = 0; m < n; ++m) scale[m] = factor * a[k] * right[m];
        for (int i = 0; i < dim; ++i, K += n) add_row(n, scale, rows + i * n, K);
    }
}

/* Calls an inlined function with the sizes of the usual elements as constants, which unrolls its loops. */
#define FU_BY_SIZE(function, dim, n, ...)                                                                              \
    if (dim == 2 && n == 8) function(2, 8, __VA_ARGS__);                                                               \
    else if (dim == 3 && n == 12) function(3, 12, __VA_ARGS__);                                                        \
    else function(dim, n, __VA_ARGS__)

FU_INLINE void add_product_by_size(int dim, int n, double factor, const double *a, const double *b, const double *by,
                                   double *K)
{
    FU_BY_SIZE(add_element_product, dim, n, factor, a, b, by, K);
}

FU_SIMD_FUNCTION(fu_add_element_product, add_product_by_size,
                 (int dim, int n, double factor, const double *a, const double *b, const double *by, double *K),
                 (dim, n, factor, a, b, by, K))

FU_INLINE void add_field_matrix(int dim, int n, double factor, const double *a, const fu_field_change *change,
                                double *K)
{
    double rows[3 * FU_MAX_COORDINATES], scale[FU_MAX_COORDINATES];
    for (int i = 0; i < dim; ++i)
        for (int m = 0, l = 0; m < n; ++l)
            for (int j = 0; j < dim; ++j, ++m)
                rows[i * n + m] =
                    change->by_slope[i * dim + j] * change->N_x[l] + change->by_place[i * dim + j] * change->N[l];
    for (int k = 0; k < n / dim; ++k) {
        for (int m = 0; m < n; ++m) scale[m] = factor * a[k];
        for (int i = 0; i < dim; ++i, K += n) add_row(n, scale, rows + i * n, K);
    }
}

FU_INLINE void add_field_by_size(int dim, int n, double factor, const double *a, const fu_field_change *change,
                                 double *K)
{
    FU_BY_SIZE(add_field_matrix, dim, n, factor, a, change, K);
}

FU_SIMD_FUNCTION(fu_add_field_matrix, add_field_by_size,
                 (int dim, int n, double factor, const double *a, const fu_field_change *change, double *K),
                 (dim, n, factor, a, change, K))

/* A matrix of a cable that threads share. */
typedef struct {
    const fu_model *model;
    const fu_cable *cable;
    const double *q, *v;
    double inertia, rate, stiffness;
    fu_system *system;
} matrix;

/* Returns whether an element has dofs whose unknowns other elements have at other nodes. */
static int is_shared(const fu_model *model, const fu_cable *cable, int k)
{
    const int *dofs = model->is_shared + fu_element_entry(cable, k);
    for (int i = 0; i < cable->coordinates; ++i)
        if (dofs[i]) return 1;
    return 0;
}

/* Completes the matrix of an element, from K with the elastic tangent if there is one. */
static void complete(const matrix *job, int k, double *K)
{
    double Q[FU_MAX_COORDINATES * FU_MAX_COORDINATES];
    const fu_cable *cable = job->cable;
    const int size = cable->coordinates * cable->coordinates;
    const fu_elements of = elements_from(cable, job->q, job->v, k);
    if (job->stiffness == 0.0)
        for (int i = 0; i < size; ++i) K[i] = 0.0;
    else {
        if (of.tau > 0.0) {
            if (cable->growth >= 0) fu_grown_damping_tangent(cable, k, job->q, job->v, job->rate, Q);
            else cable->law->damping_tangent(of.l[0], of.e, of.v, of.A, of.tau, job->rate, Q);
            for (int i = 0; i < size; ++i) K[i] += Q[i];
        }
        scale_numbers(size, job->stiffness, K);
    }
    add_mass(cable, k, job->inertia + job->stiffness * job->rate * fu_piece_of(cable, k)->mass_damping, K);
}

/* Adds a part of the elements. If threads share the work, `add_matrix_of` afterwards adds, in order, the first element
 * of each part, which shares a node with another thread, and those with shared unknowns. An entry of two neighbours
 * alone is the same in either order. */
static void add_matrix_part(const void *what, int part, int parts)
{
    const matrix *job = what;
    const fu_model *model = job->model;
    const fu_cable *cable = job->cable;
    const int size = cable->coordinates * cable->coordinates;
    const fu_range range = fu_part_of(cable->n_elements, FU_BLOCK_ELEMENTS, part, parts);
    double every[FU_BLOCK_ELEMENTS * FU_MAX_COORDINATES * FU_MAX_COORDINATES];
    for (int k = range.first, end = k; k < range.end; ++k) {
        if (k == end) {
            const fu_elements of = elements_from(cable, job->q, job->v, k);
            end += chunk(cable, k, FU_BLOCK_ELEMENTS);
            if (job->stiffness != 0.0)
                elastic_tangents(cable, job->q, k, end - k, &of, every + (FU_BLOCK_ELEMENTS - (end - k)) * size);
        }
        double *K = every + (FU_BLOCK_ELEMENTS - (end - k)) * size;
        complete(job, k, K);
        if (parts > 1 && (k == range.first || is_shared(model, cable, k)))
            memcpy(model->thread_work + (long)k * size, K, sizeof(double) * (size_t)size);
        else fu_add_element_matrix(model, fu_element_entry(cable, k), cable->coordinates, K, job->system);
    }
}

static void add_matrix_of(const matrix *job)
{
    const fu_model *model = job->model;
    const fu_cable *cable = job->cable;
    const int size = cable->coordinates * cable->coordinates;
    const int parts = fu_share(model->threads, cable->n_elements * cable->per_node, add_matrix_part, job);
    for (int part = 0; part < parts && parts > 1; ++part) {
        const fu_range range = fu_part_of(cable->n_elements, FU_BLOCK_ELEMENTS, part, parts);
        for (int k = range.first; k < range.end; ++k)
            if (k == range.first || is_shared(model, cable, k))
                fu_add_element_matrix(model, fu_element_entry(cable, k), cable->coordinates,
                                      model->thread_work + (long)k * size, job->system);
    }
}

/* Adds inertia M + stiffness d(forces)/dq + stiffness rate d(forces)/dv of the cables to a cleared system. */
void fu_dynamic_matrix(const fu_model *model, const double *q, const double *v, double inertia, double rate,
                       double stiffness, fu_system *system)
{
    FU_EACH_CABLE(cable, model) {
        const matrix job = {model, cable, q, v, inertia, rate, stiffness, system};
        add_matrix_of(&job);
    }
}

/* Computes one of the matrices of an element of a cable at a configuration at rest. */
static void element_at_rest(const fu_cable *cable, int k, const double *q, const double *zero, fu_at_rest which,
                            double *K)
{
    const fu_elements of = elements_from(cable, q, zero, k);
    for (int i = 0; i < cable->coordinates * cable->coordinates; ++i) K[i] = 0.0;
    if (which == FU_STIFFNESS_AT_REST) elastic_tangents(cable, q, k, 1, &of, K);
    if (which == FU_DAMPING_AT_REST && of.tau > 0.0) {
        if (cable->growth >= 0) fu_grown_damping_tangent(cable, k, q, zero, 1.0, K);
        else cable->law->damping_tangent(of.l[0], of.e, of.v, of.A, of.tau, 1.0, K);
    }
    if (which != FU_STIFFNESS_AT_REST)
        add_mass(cable, k, which == FU_MASS_AT_REST ? 1.0 : fu_piece_of(cable, k)->mass_damping, K);
}

void fu_add_cables_at_rest(const fu_model *model, const double *q, fu_at_rest which, int stride, double *band)
{
    double K[FU_MAX_COORDINATES * FU_MAX_COORDINATES];
    FU_EACH_CABLE(cable, model) {
        const int n = cable->coordinates;
        FU_EACH_ELEMENT(k, at, cable)
        {
            element_at_rest(cable, k, q, model->zero, which, K);
            for (int i = 0; i < n; ++i)
                for (int j = i; j < n; ++j) band[(long)(at + i) * stride + j - i] += K[i * n + j];
        }
    }
}

/* Returns the sum of e'.M e'/2 over the elements (eq 3) and the bodies' share, J. */
double fu_constant_kinetic_energy(const fu_model *model, const double *q, const double *v)
{
    double total = 0.0, part[FU_MAX_COORDINATES];
    FU_EACH_CABLE(cable, model) {
        FU_EACH_ELEMENT(k, at, cable)
        {
            cable->kernel->inertia_force(fu_element_mass(cable, k), v + at, part);
            for (int i = 0; i < cable->coordinates; ++i) total += 0.5 * part[i] * v[at + i];
        }
    }
    return total + fu_bodies_kinetic_energy(model, q, v);
}

/* Returns the energy stored in cables and bodies, J. */
double fu_constant_elastic_energy(const fu_model *model, const double *q)
{
    double total = 0.0, part;
    FU_EACH_CABLE(cable, model) {
        FU_EACH_ELEMENT(k, at, cable)
        {
            if (cable->growth >= 0) part = fu_grown_energy(cable, k, q);
            else cable->law->energy(fu_element_length(cable, k), q + at, fu_element_constants(cable, k), &part);
            total += part;
        }
    }
    return total + fu_bodies_elastic_energy(model, q);
}

/* Returns the energy of gravity, J. */
double fu_potential_energy(const fu_model *model, const double *q)
{
    double total = 0.0;
    FU_EACH_CABLE(cable, model) {
        for (int i = cable->first; i < fu_cable_end(cable); ++i) total -= model->gravity[i] * q[i];
    }
    return total + fu_bodies_potential_energy(model, q);
}

/* Computes the dissipated power of n elements of a cable, one number each. */
static void dissipations(const fu_cable *cable, const double *q, const double *v, int first, int n,
                         const fu_elements *of, double *power)
{
    if (cable->growth >= 0) {
        for (int k = 0; k < n; ++k) power[k] = fu_grown_dissipation(cable, first + k, q, v);
        return;
    }
    const fu_block block = cable->blocks ? cable->blocks->dissipation : 0;
    int k = in_blocks(block, n);
    if (k) block(k, of, power);
    for (; k < n; ++k)
        cable->law->dissipation(of->l[k * of->l_stride], of->e + k * of->per_node, of->v + k * of->per_node,
                                of->A + (long)k * of->A_stride, of->tau, power + k);
}

/* Returns the power dissipated by the damping of cables and bodies, W. */
double fu_internal_dissipation(const fu_model *model, const double *q, const double *v)
{
    double total = fu_bodies_dissipation(model, q, v), part[FU_MAX_COORDINATES], power[CHUNK];
    FU_EACH_CABLE(cable, model) {
        int end = 0; /* of the last chunk */
        if (cable->tau <= 0.0 && cable->mass_damping <= 0.0) continue;
        FU_EACH_ELEMENT(k, at, cable)
        {
            const double mass_damping = fu_piece_of(cable, k)->mass_damping;
            if (cable->tau > 0.0 && k == end) {
                const fu_elements of = elements_from(cable, q, v, k);
                end += chunk(cable, k, CHUNK);
                dissipations(cable, q, v, k, end - k, &of, power + CHUNK - (end - k));
            }
            if (cable->tau > 0.0) total += power[CHUNK - (end - k)];
            if (mass_damping > 0.0) {
                cable->kernel->inertia_force(fu_element_mass(cable, k), v + at, part);
                for (int i = 0; i < cable->coordinates; ++i) total += mass_damping * part[i] * v[at + i];
            }
        }
    }
    return total;
}
