/* Forces between two points whose law has segments by their distance: tension-only springs, free play, tables.
 *
 * Within a step the force follows the law of one segment, the flag of the state, so that each step is smooth. A
 * tension-only or compression-only segment is left where its force, the damper's part included, reverses; it is
 * entered where the distance is in it and its force has the permitted sense. Steps end where the force changes its
 * segment. */
#include "bodies/model.h"
#include "couplings/force/force.h"

#include <math.h>

static const fu_point_force *force_of(const fu_coupling *coupling)
{
    return (const fu_point_force *)coupling;
}

/* Returns the segment whose law the force follows. */
int fu_force_segment(const fu_point_force *between, const fu_state *state)
{
    return state->flags[between->base.flags];
}

const double *fu_segment_parameters(const fu_point_force *between, const double *q, int segment,
                                    double scaled[FU_MAX_LAW_PARAMETERS])
{
    const double *given = between->parameters + (long)segment * between->n_parameters;
    if (between->stiffness_dof < 0) return given;
    for (int i = 0; i < between->n_parameters; ++i)
        scaled[i] = between->stiffnesses[i] ? q[between->stiffness_dof] * given[i] : given[i];
    return scaled;
}

/* Returns the segment of a distance. */
int fu_segment_at_distance(const fu_point_force *between, double distance)
{
    int segment = 0;
    while (segment < between->n_segments - 1 && distance > between->bounds[segment]) ++segment;
    return segment;
}

void fu_gap_of_points(const fu_model *model, const fu_point_force *between, const fu_state *state, double gap[3],
                      double *rate)
{
    double p[2][3], v[2][3];
    for (int e = 0; e < 2; ++e) fu_point_at(model, &between->attachments[e], state, p[e], rate ? v[e] : 0, 0);
    for (int d = 0; d < 3; ++d) {
        gap[d] = p[1][d] - p[0][d];
        if (rate) rate[d] = v[1][d] - v[0][d];
    }
}

double fu_shorten_gap(const fu_point_force *between, const fu_state *state, double gap[3], double *rate)
{
    const double distance = sqrt(fu_dot(between->dim, gap, gap));
    const double ratio = (distance - state->q[between->length_dof]) / distance;
    for (int d = 0; d < between->dim; ++d) {
        if (rate) rate[d] -= state->v[between->length_dof] / distance * gap[d];
        gap[d] *= ratio;
    }
    return ratio;
}

void fu_gap(const fu_model *model, const fu_point_force *between, const fu_state *state, double gap[3], double *rate)
{
    fu_gap_of_points(model, between, state, gap, rate);
    if (between->length_dof >= 0) fu_shorten_gap(between, state, gap, rate);
}

/* Returns the segment of the distance of the points. */
int fu_segment_at(const fu_model *model, const fu_point_force *between, const fu_state *state)
{
    double gap[3];
    if (between->n_segments == 1) return 0;
    fu_gap(model, between, state, gap, 0);
    return fu_segment_at_distance(between, sqrt(fu_dot(between->dim, gap, gap)));
}

/* In statics the force follows from the positions. */
void fu_detect_segment(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    state->flags[coupling->flags] = fu_segment_at(model, force_of(coupling), state);
}
