/* Drums at a state, and the changes of their variables by the dofs. */
#include "bodies/model.h"
#include "couplings/drum/drum.h"

#include <math.h>

/* Computes the node at the tangent point, in space. */
static void find_node_in_space(const fu_drum *drum, const double *q, const double *v, fu_drum_state *out)
{
    const double *slope = q + SPACE, size = sqrt(fu_dot(SPACE, slope, slope)), none[SPACE] = {0.0};
    double acc[DIM];
    for (int d = 0; d < SPACE; ++d) out->stretch[d] = slope[d] / size;
    out->rise = fu_dot(SPACE, out->wheel.axis, q) - fu_dot(SPACE, out->wheel.axis, out->wheel.centre.p);
    fu_from_centre(&drum->wheel, &out->wheel, q, v, none, out->x, out->x_rate, acc);
    out->slope[0] = size;
    out->slope[1] = out->slope_rate[1] = 0.0;
    out->slope_rate[0] = fu_dot(SPACE, out->stretch, v + SPACE);
    out->carrier = 0.0; /* angles are those from the body */
}

/* Computes it in the plane. */
static void find_node_in_plane(const double *q, const double *v, fu_drum_state *out)
{
    const fu_attachment_state *centre = &out->wheel.centre;
    for (int d = 0; d < DIM; ++d) {
        out->x[d] = q[d] - centre->p[d];
        out->slope[d] = q[SLOPE + d];
        out->x_rate[d] = v[d] - centre->v[d];
        out->slope_rate[d] = v[SLOPE + d];
    }
    out->carrier = atan2(centre->A[DIM], centre->A[0]);
}

void fu_drum_at(const fu_model *model, const fu_drum *drum, const fu_state *state, const double *a, fu_drum_state *out)
{
    const double *v = state->v ? state->v : model->zero;
    const fu_state moving = {.t = state->t, .q = state->q, .v = (double *)v};
    if (!a) a = model->zero;
    out->q = state->q;
    fu_wheel_at(model, &drum->wheel, &moving, a, &out->wheel);
    if (is_in_space(drum)) find_node_in_space(drum, state->q + drum->node, v + drum->node, out);
    else find_node_in_plane(state->q + drum->node, v + drum->node, out);
    out->u = drum->direction * (state->q[drum->s] - drum->end);
    out->u_rate = drum->direction * v[drum->s];
    out->turn = drum->wheel.turn < 0 ? 0.0 : state->q[drum->wheel.turn];
    out->phi = atan2(out->x[1], out->x[0]);
    out->span_stretch = sqrt(fu_dot(DIM, out->slope, out->slope));
    out->wound = out->span_stretch;
    out->winds = 1.0;
    out->has_left = 0;
    if (!state->numbers) return;
    const fu_drum_history *past = fu_drum_history_of(drum, state);
    out->has_left = past->has_left != 0.0;
    if (!past->is_known) return;
    out->wound = fu_drum_wound_stretch(drum, past, out->u);
    out->winds = out->u > past->u || (out->u == past->u && out->u_rate > 0.0) ? 1.0 : 0.0;
}

int fu_drum_columns(const fu_drum *drum, const fu_drum_state *at, const fu_centre_moves *moves, fu_wheel_column *out)
{
    const double *groove = at->wheel.groove;
    int n = 0;
    if (is_in_space(drum)) {
        for (; n < SPACE; ++n)
            out[n] = (fu_wheel_column){drum->node + n, 0, DIM, {groove[n * DIM], groove[n * DIM + 1]}};
        for (; n < 2 * SPACE; ++n) out[n] = (fu_wheel_column){drum->node + n, SLOPE, 1, {at->stretch[n - SPACE]}};
    } else
        for (; n < NODE; ++n) out[n] = (fu_wheel_column){drum->node + n, n, 1, {1.0}};
    out[n++] = (fu_wheel_column){drum->s, LENGTH, 1, {drum->direction}};
    return n + fu_wheel_columns(&drum->wheel, &at->wheel, moves, CENTRE, out + n);
}
