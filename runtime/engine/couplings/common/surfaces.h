/* Surfaces in contact with cables and bodies: couplings/common/surfaces.c. */
#ifndef FUNICULAR_COUPLINGS_COMMON_SURFACES_H
#define FUNICULAR_COUPLINGS_COMMON_SURFACES_H

#include "couplings/common/attachments.h"
#include "base/fields.h"

/* Shapes: a plane; a sphere, or a cylinder without ends; a cylinder with half spheres at its ends; a height over a line
 * or over two horizontal axes; a box. */
enum { FU_FLAT, FU_ROUND, FU_CAPSULE, FU_TERRAIN, FU_BOX };

/* A surface: its shape from an origin along the axes of an attachment, of the ground or of a body. */
typedef struct {
    const fu_surface_kernels *kernel;
    int shape;
    double direction[3];              /* normal of a plane; axis of a cylinder or capsule, zero for a sphere */
    double round_radius, half_length; /* m; a cylinder continues beyond it */
    double half_size[3];              /* of a box along its axes, m */
    int inside; /* nonzero: a hollow, with contact from inside. Distances are `inset` less those of the shape */
    /* m: of a hollow box, the reduction of half_size: a sphere of that radius touches each wall where its centre is
     * beyond that size; at edges and corners the walls act together */
    double inset;
    int n_first, n_second; /* grid of a terrain along its horizontal axes, m; in the plane there is one axis */
    const double *first, *second,
        *heights; /* heights: 4 (or 4 x 4) coefficients of each cell's cubics, from the start of the cell */
    double highest, steepest,
        bend; /* bounds of a terrain's height, m, its slope, and the rate of change of that, 1/m */
    fu_attachment on[1];
} fu_surface;

/* Position of a surface: the state of its attachment. Distance of a point, its gradient and its second derivative, by
 * the ground's axes; the vector from the shape's origin to the point, along the shape's axes. */
typedef struct {
    double g, n[3], H[9], y[3];
} fu_distance;

void fu_surface_at(const fu_model *model, const fu_surface *surface, const fu_state *state, fu_attachment_state *at);
void fu_surface_distance(int dim, const fu_surface *surface, const fu_attachment_state *at, const double *r,
                         fu_distance *out);
/* Returns the distance of r beyond the ends of a cylinder or the table of a terrain, m, where the shape continues;
 * negative within them. */
double fu_surface_beyond(int dim, const fu_surface *surface, const fu_attachment_state *at, const double *r);
/* Whether a surface has such ends. */
int fu_surface_has_ends(const fu_surface *surface);
/* Returns a lower bound of the distance of any point within `reach` of r, m. */
double fu_surface_clearance(int dim, const fu_surface *surface, const fu_attachment_state *at, const double *r,
                            double reach);
/* Computes the normal over a step on a fixed surface: its product with the vector between two points is the change of
 * the distance, `rise` (Gonzalez 1996). middle: the distance half-way. */
void fu_surface_step_normal(int dim, const fu_surface *surface, const fu_attachment_state *at, const double *from,
                            const double *to, double rise, fu_distance *middle, double *n);
/* Velocity of the body's point at r, of the body of the surface. */
void fu_surface_velocity(int dim, const fu_attachment_state *at, const double *r, double *v);
/* Velocity relative to that point of a point at r with the velocity v. */
void fu_surface_past(int dim, const fu_attachment_state *at, const double *r, const double *v, double *past);
/* Converts a vector along a shape's axes to the ground's, and back. */
static inline void fu_surface_out(int dim, const fu_attachment_state *at, const double *components, double *out)
{
    for (int i = 0; i < dim; ++i) out[i] = fu_dot(dim, at->A + i * dim, components);
}
static inline void fu_surface_into(int dim, const fu_attachment_state *at, const double *given, double *components)
{
    for (int i = 0; i < dim; ++i) {
        const double sum = 0.0 + at->A[i] * given[0] + at->A[dim + i] * given[1];
        components[i] = dim == 3 ? sum + at->A[2 * 3 + i] * given[2] : sum;
    }
}

/* Fields of a structure's member `surface` (base/fields.h), which has the words of its shapes in fu_surface_shapes. */
extern const char *const fu_surface_shapes[], *const fu_surface_role[];
#define FU_SURFACE_FIELD(structure, member, kind, words)                                                               \
    {#member, kind, offsetof(structure, surface.member), 1, 0, words}
#define FU_SURFACE_FIELDS(structure)                                                                                   \
    FU_SURFACE_FIELD(structure, kernel, FU_KERNELS, fu_surface_role),                                                  \
        FU_SURFACE_FIELD(structure, shape, FU_WORD, fu_surface_shapes),                                                \
        {"direction", FU_REAL, offsetof(structure, surface.direction), 3, sizeof(double), NULL},                       \
        FU_SURFACE_FIELD(structure, round_radius, FU_LENGTH, 0),                                                       \
        FU_SURFACE_FIELD(structure, half_length, FU_LENGTH, 0),                                                        \
        {"half_size", FU_LENGTH, offsetof(structure, surface.half_size), 3, sizeof(double), NULL},                     \
        FU_SURFACE_FIELD(structure, inside, FU_INTEGER, 0), FU_SURFACE_FIELD(structure, inset, FU_LENGTH, 0),          \
        FU_SURFACE_FIELD(structure, n_first, FU_INTEGER, 0), FU_SURFACE_FIELD(structure, n_second, FU_INTEGER, 0),     \
        FU_SURFACE_FIELD(structure, first, FU_REALS, 0), FU_SURFACE_FIELD(structure, second, FU_REALS, 0),             \
        FU_SURFACE_FIELD(structure, heights, FU_REALS, 0), FU_SURFACE_FIELD(structure, highest, FU_LENGTH, 0),         \
        FU_SURFACE_FIELD(structure, steepest, FU_REAL, 0), FU_SURFACE_FIELD(structure, bend, FU_REAL, 0),              \
    {                                                                                                                  \
        "on", FU_ATTACHMENT, offsetof(structure, surface.on), 1, sizeof(fu_attachment), NULL                           \
    }

#endif
