/* The elements of a span of a rope, whose ends flow along it (derive/couplings/span.py): their motion, and forces and
 * matrices on the dofs of nodes and of the span's two material coordinates. */
#ifndef FUNICULAR_COUPLINGS_COMMON_SPAN_ELEMENTS_H
#define FUNICULAR_COUPLINGS_COMMON_SPAN_ELEMENTS_H

#include "base/common.h"
#include "base/fields.h"
#include "linear/linear.h"

enum { FU_SPAN_ENDS = 2, FU_SPAN_LOCAL = FU_MAX_COORDINATES + FU_SPAN_ENDS };

/* The dofs of the nodes are contiguous. The material coordinate of a node is s1 + share (s2 - s1). */
typedef struct {
    const fu_span_kernels *kernel;
    int n_elements, first, s[FU_SPAN_ENDS]; /* dofs: the first of the nodes, and s1, s2 */
    const double *share;                    /* of the nodes */
} fu_span_elements;

extern const char *const fu_span_role[];

/* The fields of the elements `member` of a structure. */
#define FU_SPAN_FIELDS(structure, member)                                                                              \
    {"span_kernel", FU_KERNELS, offsetof(structure, member.kernel), 1, 0, fu_span_role},                               \
        FU_FIELD_AS("span_elements", structure, member.n_elements, FU_INTEGER),                                        \
        FU_FIELD_AS("span_first", structure, member.first, FU_INTEGER),                                                \
        {"span_s", FU_INTEGER, offsetof(structure, member.s), FU_SPAN_ENDS, sizeof(int), NULL},                        \
        FU_FIELD_AS("span_share", structure, member.share, FU_REALS)

/* Returns the place of the k-th node of a span. */
static inline const double *fu_span_node(const fu_span_elements *span, int k, const double *q)
{
    return q + span->first + k * (span->kernel->coordinates / 2);
}

/* An element at a configuration q, and its motion with the rates v and accelerations a of the dofs. */
typedef struct {
    int number, at; /* at: first dof */
    double l;
    const double *e, *v, *a;
    double s[FU_SPAN_ENDS], s_rate[FU_SPAN_ENDS], s_acc[FU_SPAN_ENDS];
} fu_span_element;

/* Computes numbers of the ends of an element from those of the ends of the span. */
void fu_span_at_ends(const fu_span_elements *span, int k, const double *dofs, double out[FU_SPAN_ENDS]);
/* Returns the k-th element; v, a null: zero. */
fu_span_element fu_span_element_at(const fu_model *model, const fu_span_elements *span, int k, const double *q,
                                   const double *v, const double *a);
/* Adds forces on an element, and on its ends (null: none) and its length, to those on the dofs. */
void fu_add_span_force(const fu_span_elements *span, const fu_span_element *on, const double *of_e,
                       const double *of_ends, double of_length, double *f);
/* Converts n derivatives by the material coordinates of both ends of the k-th element, each `stride` apart, to those by
 * s1 and s2 of the span. */
void fu_to_ends_of_span(const fu_span_elements *span, int k, double *first, double *last, int n, int stride);
/* Adds a matrix over e and both ends to a system; it is overwritten. */
void fu_add_span_matrix(const fu_model *model, const fu_span_elements *span, const fu_span_element *on,
                        double (*K)[FU_SPAN_LOCAL], fu_system *system);
/* Add, times a factor, derivatives by e and by the length (n + 1 columns a row of `by`); derivatives by the rates of e
 * and of both ends (`all` a row). */
void fu_add_by_length(int rows, int n, double factor, const double *by, double (*local)[FU_SPAN_LOCAL]);
void fu_add_by_rates(int all, double factor, const double *D, double (*local)[FU_SPAN_LOCAL]);
/* Adds, times a factor, second derivatives of an energy by e (K, null: none), by e and l, by l. */
void fu_add_by_energy(int n, double factor, const double *K, const double *K_l, double K_ll,
                      double (*local)[FU_SPAN_LOCAL]);

#endif
