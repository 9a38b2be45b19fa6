/* Forces between two points, couplings/force/point_force.c, and loads, couplings/force/loads.c. */
#ifndef FUNICULAR_COUPLINGS_FORCE_FORCE_H
#define FUNICULAR_COUPLINGS_FORCE_FORCE_H

#include "couplings/common/attachments.h"
#include "couplings/common/coupling.h"
#include "couplings/common/span_elements.h"

/* Permitted senses of a segment of a law: pull and push, one of them alone, or none: then it has no force. */
enum { FU_PUSHES_ALONE = -1, FU_PULLS_AND_PUSHES = 0, FU_PULLS_ALONE = 1, FU_HAS_NO_FORCE = 2 };

/* A force between the points of two attachments, by a law and its parameters.
 *
 * The parameters may depend on the distance of the points: n_segments sets of them, one after the other, and the
 * distances `bounds` between segments (couplings/force/segments.c). The flag of a state is the segment whose law the
 * force follows. */
typedef struct {
    fu_coupling base;
    const fu_point_law_kernels *law;
    const double *parameters;
    fu_attachment attachments[2];
    int dim;
    int n_segments, n_parameters;
    const double *bounds; /* (n_segments - 1), m */
    const int *senses;    /* (n_segments): permitted senses of each segment */
    double compliance;    /* m/N: converts forces to lengths, for comparison */
    /* Dofs that signals prescribe, -1 for none: by how much all lengths of the parameters are longer, m, never above
     * zero; the factor of the stiffness, of the parameters marked in `stiffnesses`. */
    int length_dof, stiffness_dof;
    const int *stiffnesses; /* (n_parameters): nonzero for those in proportion to the stiffness */
} fu_point_force;

#define FU_MAX_LAW_PARAMETERS 8

extern const fu_coupling_type fu_point_force_type;

/* couplings/force/point_force.c */
/* Adds to f, times a factor, the difference of the forces at a state from those by the law of another segment. */
void fu_add_force_change(const fu_model *model, const fu_point_force *between, const fu_state *state, int segment,
                         double factor, double *f);

/* couplings/force/segments.c; the first computes the gap between the points and, unless null, its rate; the second
 * makes them those that the law takes of a prescribed length, along the same line, shorter by its change, and returns
 * the ratio of the gaps; fu_gap does both. */
void fu_gap_of_points(const fu_model *model, const fu_point_force *between, const fu_state *state, double gap[3],
                      double *rate);
double fu_shorten_gap(const fu_point_force *between, const fu_state *state, double gap[3], double *rate);
void fu_gap(const fu_model *model, const fu_point_force *between, const fu_state *state, double gap[3], double *rate);
int fu_force_segment(const fu_point_force *between, const fu_state *state);
int fu_segment_at(const fu_model *model, const fu_point_force *between, const fu_state *state);
int fu_segment_at_distance(const fu_point_force *between, double distance);
/* Returns the parameters of a segment in a configuration, in `scaled` where a signal prescribes the stiffness. */
const double *fu_segment_parameters(const fu_point_force *between, const double *q, int segment,
                                    double scaled[FU_MAX_LAW_PARAMETERS]);
void fu_detect_segment(const fu_model *model, const fu_coupling *coupling, fu_state *state);

/* A force of constant direction in the dofs: values on n dofs, times a signal (-1: one). */
typedef struct {
    fu_coupling base;
    int signal, n;
    const int *dofs;
    const double *values;
} fu_dead_load;
extern const fu_coupling_type fu_dead_load_type;

/* A load that rotates with its carrier, or whose lever does: at x of a cable's element, or at a point of a body; a
 * force at a material point of a rope is one on a body. A load moves along its cable if the signal `place` gives its
 * arc-length, less x; it acts where the signal `presence` (-1: one) is not zero. */
enum { FU_CABLE_FOLLOWER, FU_CABLE_MOMENT, FU_BODY_FORCE, FU_BODY_FOLLOWER, FU_BODY_MOMENT, FU_CABLE_FORCE };
typedef struct {
    fu_coupling base;
    int kind, signal, place, presence;
    fu_attachment on;
    double x, c[3]; /* c: components, N or N m */
} fu_load;
extern const fu_coupling_type fu_load_type;

/* A force of a stress-free length of a rope on the material in a span, between two material coordinates, times a signal
 * (-1: one): couplings/force/line_load.c. */
typedef struct {
    fu_coupling base;
    fu_span_elements on;
    int signal;
    double value[3], between[2]; /* N/m, m */
} fu_line_load;
extern const fu_coupling_type fu_line_load_type;

void fu_external_forces(const fu_model *model, double t, const double *q, double *f);

#endif
