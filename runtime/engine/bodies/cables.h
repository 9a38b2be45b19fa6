/* Cables, and sums over their elements: bodies/assembly.c. */
#ifndef FUNICULAR_BODIES_CABLES_H
#define FUNICULAR_BODIES_CABLES_H

#include "linear/linear.h"

/* Consecutive elements of a cable with one damping, each of which begins at the node where the one before it ends. */
typedef struct {
    int end;             /* number of the element after the last */
    int first;           /* entry in q of the element 0 if it were of this piece */
    double tau;          /* Kelvin-Voigt retardation time, s */
    double mass_damping; /* 1/s */
    int growth;          /* dof of the growth factor of its stress-free length, -1 for none (bodies/growth.c) */
} fu_cable_piece;

typedef struct {
    const fu_element_kernels *kernel;
    const fu_law_kernels *law;
    const fu_law_blocks *blocks; /* null if there are none */
    int n_elements, n_nodes;
    int first;             /* first dof and first entry in q */
    int coordinates;       /* of an element */
    int per_node;          /* coordinates of a node */
    double length;         /* of an element, m; the mean where they differ */
    const double *lengths; /* of the elements, m */
    const double *nodes;   /* arc-lengths of the nodes, m; null where the elements are equal */
    const fu_cable_piece *pieces;
    double tau, mass_damping; /* the largest of its pieces */
    const double *m;          /* mass matrix of the first element over nodal vectors */
    int l_stride;             /* from one element's length to the next's: zero for equal elements */
    int m_stride;             /* from one element's mass matrix to the next's: zero for equal elements */
    const double *A;          /* constants of the law, of the first element */
    int A_stride;             /* from one element's constants to the next's: zero for equal elements */
    /* of each vector of a node: largest displacement of points of its elements by a unit of it; null if unknown */
    const double *share;
    int tension_only; /* nonzero for a law with reduced stiffness in compression */
    /* growth of the stress-free length (bodies/growth.c): the dof of the first piece, -1 for none; nonzero where
     * signals prescribe it; orders of the derivatives by the arc-length of the vectors of a node */
    int growth, grows;
    const int *orders;
    /* constants of the law as A, with negative bending stiffness, of laws of cables whose growth signals prescribe */
    const double *growth_constants;
    /* of other laws: their constants, A_size of an element, in `terms` Chebyshev polynomials of the growth factors */
    int A_size, terms;
    const double *growth_series;
    int dissipation_state; /* first number in a state's of algorithmic dissipation: law->rates + 1 an element */
} fu_cable;

void fu_constant_mass_times(const fu_model *model, const double *q, const double *a, double *f);
void fu_internal_forces(const fu_model *model, const double *q, const double *v, double *f);
void fu_rate_forces(const fu_model *model, const double *q, const double *v, double *f);
void fu_discrete_forces(const fu_model *model, const double *q, const double *q_next, double *f);
void fu_dynamic_matrix(const fu_model *model, const double *q, const double *v, double inertia, double rate,
                       double stiffness, fu_system *system);
/* Adds a matrix of the cables, which is symmetric, at the configuration q at rest to a band over the dofs: row i has
 * the entries of columns i, i + 1 and so on, `stride` after those of row i - 1. */
typedef enum { FU_MASS_AT_REST, FU_DAMPING_AT_REST, FU_STIFFNESS_AT_REST } fu_at_rest;
void fu_add_cables_at_rest(const fu_model *model, const double *q, fu_at_rest which, int stride, double *band);
/* Adds to the matrix K (n x n) of an element factor times a' by b, of two rows of n / dim numbers and a matrix (dim x
 * dim). */
void fu_add_element_product(int dim, int n, double factor, const double *a, const double *b, const double *by,
                            double *K);
/* The derivatives of a force at a point of an element by its slope and its place (dim x dim), of the rows N_x and N. */
typedef struct {
    const double *by_slope, *N_x, *by_place, *N;
} fu_field_change;
/* Adds to the matrix K (n x n) of an element factor times a' by these derivatives. */
void fu_add_field_matrix(int dim, int n, double factor, const double *a, const fu_field_change *change, double *K);
double fu_constant_elastic_energy(const fu_model *model, const double *q);
double fu_constant_kinetic_energy(const fu_model *model, const double *q, const double *v);
double fu_potential_energy(const fu_model *model, const double *q);
double fu_internal_dissipation(const struct fu_model *model, const double *q, const double *v);

/* Returns the length of an element, m. */
static inline double fu_element_length(const fu_cable *cable, int element)
{
    return cable->lengths[(long)element * cable->l_stride];
}

/* Returns the piece that an element belongs to. */
static inline const fu_cable_piece *fu_piece_of(const fu_cable *cable, int element)
{
    const fu_cable_piece *piece = cable->pieces;
    while (element >= piece->end) ++piece;
    return piece;
}

/* Returns the entry in q of the first of an element's coordinates, which follow one another. */
static inline int fu_element_entry(const fu_cable *cable, int element)
{
    return fu_piece_of(cable, element)->first + element * cable->per_node;
}

/* Returns the entry in q after the last of a cable. */
static inline int fu_cable_end(const fu_cable *cable)
{
    return cable->first + cable->n_nodes * cable->per_node;
}

/* Loops over the elements and over the nodes of a cable, with the entry in q of the first coordinate of each. */
#define FU_EACH_ELEMENT(k, at, cable)                                                                                  \
    for (int k = 0, at; k < (cable)->n_elements && (at = fu_element_entry(cable, k), 1); ++k)
#define FU_EACH_NODE(at, cable) for (int at = (cable)->first; at < fu_cable_end(cable); at += (cable)->per_node)

/* Returns the length of a cable, m. */
static inline double fu_cable_length(const fu_cable *cable)
{
    return cable->nodes ? cable->nodes[cable->n_elements] : cable->n_elements * cable->length;
}

/* Returns the arc-length at the first node of an element, m. */
static inline double fu_cable_start(const fu_cable *cable, int element)
{
    return cable->nodes ? cable->nodes[element] : element * cable->length;
}

/* Returns the element at an arc-length on the cable. */
static inline int fu_cable_element_at(const fu_cable *cable, double s)
{
    if (cable->nodes) return fu_last_reached(cable->nodes, 0, cable->n_elements, s);
    const int element = (int)(s / cable->length);
    return element < cable->n_elements ? element : cable->n_elements - 1;
}

/* Returns the mass matrix of an element over nodal vectors. */
static inline const double *fu_element_mass(const fu_cable *cable, int element)
{
    return cable->m + (long)element * cable->m_stride;
}

/* Returns the constants of the law of an element. */
static inline const double *fu_element_constants(const fu_cable *cable, int element)
{
    return cable->A + (long)element * cable->A_stride;
}

#endif
