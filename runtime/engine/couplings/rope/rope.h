/* Ropes: spans with moving material coordinates, sheaves between spans, and drums at ends. */
#ifndef FUNICULAR_COUPLINGS_ROPE_ROPE_H
#define FUNICULAR_COUPLINGS_ROPE_ROPE_H

#include "couplings/common/attachments.h"
#include "couplings/common/coupling.h"

#define FU_ROPE_CONSTANTS 4 /* of a law, at most */

/* A span (derive/couplings/span.py). The dofs of its nodes are contiguous. The material coordinate of a node is
 * s1 + share (s2 - s1). */
typedef struct {
    fu_coupling base;
    const fu_span_kernels *kernel;
    int n_elements, first, s[2]; /* dofs: the first of the nodes, and s1, s2 */
    const double *share;         /* of the nodes */
    double rho, tau, g[3], A[FU_ROPE_CONSTANTS];
    double least_length; /* m: stress-free, of a span that can be modelled */
} fu_span_coupling;
extern const fu_coupling_type fu_span_type;

/* Returns the place of the k-th node of a span. */
static inline const double *fu_span_node(const fu_span_coupling *span, int k, const double *q)
{
    return q + span->first + k * (span->kernel->coordinates / 2);
}

/* A sheave between the last node of a span and the first of the next (derive/couplings/sheave.py): two tangent points,
 * and the wrap in zones of equal angles. Of a node the place comes first, then the slope. */
typedef struct {
    fu_coupling base;
    const fu_sheave_kernels *kernel;
    fu_attachment attachments[1]; /* the centre */
    int nodes[2], turn;           /* dofs: the first of each node; the rotation of the sheave, -1 for none */
    int n_zones;
    const int *s; /* dofs: material coordinates of the ends of the zones */
    double radius, tangent_radius[2], sense, rho, tau, g[3], A[2];
    double inertia, friction, slip_velocity; /* kg m^2; coefficient; m/s, see the kernel of friction */
    int torque_signal;                       /* of the torque on the sheave, -1 for a constant one */
    double torque;                           /* N m: the factor of the signal */
    double closing, damping;                 /* m: between the last and the first s of a closed rope; N m s */
    double least_wrap;                       /* rad: of a wrap that can be modelled */
} fu_sheave;

/* A drum at an end of a rope (derive/couplings/drum.py): a tangent point, and the rope that is wound. Its wound length
 * is direction (s - end). Its history is the drawn length over the wound one, in cells. */
typedef struct {
    fu_coupling base;
    const fu_sheave_kernels *kernel;
    fu_attachment attachments[1]; /* the centre */
    int node, s, turn;            /* dofs: the first of the node; its material coordinate; the rotation, -1 for none */
    int n_cells;
    double cell, direction, end; /* m: stress-free length of a cell; 1 at the first end of the rope, else -1; m */
    double radius, tangent_radius, sense, rho, g[3], A[2];
    double inertia, damping; /* kg m^2, N m s */
    int torque_signal;       /* of the torque on the drum, -1 for a constant one */
    double torque;           /* N m: the factor of the signal */
} fu_drum;

/* Return how far a rope is from leaving: its wrap above the least one, rad; the least normal force, times the radius on
 * an angle, N; the length of a span above the least one, m. */
double fu_wrap_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
double fu_wrap_pressure(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
double fu_span_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
/* Return the wound length of a drum, m; the normal force as above, N. */
double fu_drum_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
double fu_drum_pressure(const fu_model *model, const fu_coupling *coupling, const fu_state *state);

#endif
