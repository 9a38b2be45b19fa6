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
    /* in space, on the ground: kernels of tangent points (null in the plane); vectors of the plane of the groove (3 x
     * 2); the axis; of the spans before and after: the first dof, elements in all and within reach of a chord, s of
     * their ends, m: the stress-free length of a chord */
    const fu_tangent_point_kernels *foot;
    double groove[6], axis[3], weight[3], limit, chord[2];
    int span_first[2], span_elements[2], span_reach[2], span_s[4];
    const double *share_before, *share_after; /* of their nodes */
} fu_sheave;

/* --- the tangent point of a rope on a sheave in space (derive/couplings/tangent_point.py) --- */

enum {
    FU_FOOT_CONDITIONS = 3,
    FU_FOOT_VECTORS = 7, /* x, chord, its stress-free length b */
    FU_FOOT_ELEMENT = 12,
    FU_FOOT_CENTRE = 6 + FU_FOOT_ELEMENT + 2, /* where the coordinates of the centre are among the dofs */
    FU_FOOT_DOFS = FU_FOOT_CENTRE + FU_ATTACHMENT_COORDINATES
};

/* A tangent point at a state: its n dofs, those of the node, of the element in which the chord ends, s of both ends of
 * the span, and the coordinates of the centre, some of them twice; the conditions and their derivatives by x, the chord
 * and b (J, K), and the changes of these by the dofs. K: of J' multipliers. */
typedef struct {
    int n, dofs[FU_FOOT_DOFS];
    double phi[FU_FOOT_CONDITIONS], J[FU_FOOT_CONDITIONS * FU_FOOT_VECTORS], K[FU_FOOT_VECTORS * FU_FOOT_VECTORS];
    double by[FU_FOOT_VECTORS][FU_FOOT_DOFS], N_L[4], chord[3], chord_L[3], chord_LL[3], b;
} fu_tangent_point;

/* Computes the tangent point where the rope runs on (k = 0) or off (1), with these multipliers. */
void fu_tangent_point_at(const fu_sheave *sheave, int k, const fu_attachment_state *centre, const double *q,
                         const double *multipliers, fu_tangent_point *out);
/* Computes the changes of x by the coordinates of the centre anew, from those of the centre (3 x coordinates). */
void fu_tangent_point_turn(const double *of_centre, fu_tangent_point *at);
/* Computes the derivatives of the conditions by the dofs (conditions x n). */
void fu_tangent_point_rows(const fu_tangent_point *at, double *rows);
/* Computes the derivatives of the forces J' multipliers on the dofs (n x n) by those of `columns`. */
void fu_tangent_point_stiffness(const fu_tangent_point *at, const fu_tangent_point *columns, const double *multipliers,
                                double *K);
/* Computes the second rates of the conditions at zero accelerations of the dofs. */
void fu_tangent_point_bias(const fu_sheave *sheave, int k, const fu_tangent_point *at,
                           const fu_attachment_state *centre, const double *q, const double *v,
                           double bias[FU_FOOT_CONDITIONS]);
/* Returns the fleet angle of the chord there, rad: positive where the span leaves the groove along the axis. */
double fu_fleet_angle(const fu_sheave *sheave, int k, const double *q);

/* --- drums --- */

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
 * an angle, N; the length of a span above the least one, m; in space that of both spans beside a sheave above the one
 * at which a rope with their fleet angles slides out of the groove, m. */
double fu_wrap_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
double fu_wrap_pressure(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
double fu_fleet_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
double fu_span_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
/* Return the wound length of a drum, m; the normal force as above, N. */
double fu_drum_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
double fu_drum_pressure(const fu_model *model, const fu_coupling *coupling, const fu_state *state);

/* Returns whether a sheave is one in space. */
static inline int fu_is_in_space(const fu_coupling *sheave)
{
    return ((const fu_sheave *)sheave)->foot != 0;
}

#endif
