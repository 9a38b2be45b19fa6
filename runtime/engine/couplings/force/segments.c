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

const double *fu_segment_parameters(const fu_point_force *between, int segment)
{
    return between->parameters + (long)segment * between->n_parameters;
}

/* Returns the segment of a distance. */
int fu_segment_at_distance(const fu_point_force *between, double distance)
{
    int segment = 0;
    while (segment < between->n_segments - 1 && distance > between->bounds[segment]) ++segment;
    return segment;
}

void fu_gap(const fu_model *model, const fu_point_force *between, const fu_state *state, double gap[3], double *rate)
{
    double p[2][3], v[2][3];
    for (int e = 0; e < 2; ++e) fu_point_at(model, &between->attachments[e], state, p[e], rate ? v[e] : 0, 0);
    for (int d = 0; d < 3; ++d) {
        gap[d] = p[1][d] - p[0][d];
        if (rate) rate[d] = v[1][d] - v[0][d];
    }
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
