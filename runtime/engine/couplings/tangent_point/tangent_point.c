/* Tangent points in space: the conditions of a node at the end of a span, with the chord over a fixed stress-free
 * length of the span. */
#include "couplings/tangent_point/tangent_point.h"
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"

#include <math.h>
#include <string.h>

enum { SPACE = 3, NODE_IN_SPACE = 2 * SPACE, VECTORS = 4, S = NODE_IN_SPACE + FU_FOOT_ELEMENT };
enum { SLOPE = SPACE, CHORD = 2 * SPACE, LENGTH = 3 * SPACE, AXIS = LENGTH + 1 };

static double derivative(const fu_tangent_point *at, int row, int of)
{
    return at->J[row * at->n_vectors + of];
}

/* Returns the end of a chord from the first node of a span of the length L. */
static fu_chord_end after_start(const fu_foot *span, double L)
{
    const double *share = span->share;
    const int last = span->reach - 1;
    int j = 0;
    while (j < last && share[j + 1] * L < span->chord) ++j;
    const double whole = share[j + 1] - share[j];
    if (span->chord > share[j + 1] * L)
        return (fu_chord_end){j, whole * L, whole * L, {whole, whole}, share[j + 1] * L, share[j + 1]};
    return (fu_chord_end){j, span->chord - share[j] * L, whole * L, {-share[j], whole}, span->chord, 0.0};
}

/* Returns the end of a chord from the last node. */
static fu_chord_end before_end(const fu_foot *span, double L)
{
    const double *share = span->share;
    const int first = span->n_elements - span->reach;
    int j = span->n_elements - 1;
    while (j > first && (1.0 - share[j]) * L < span->chord) --j;
    const double whole = share[j + 1] - share[j], rest = 1.0 - share[j];
    if (span->chord > rest * L) return (fu_chord_end){j, 0.0, whole * L, {0.0, whole}, rest * L, rest};
    return (fu_chord_end){j, rest * L - span->chord, whole * L, {rest, whole}, span->chord, 0.0};
}

fu_chord_end fu_chord_end_at(const fu_foot *foot, double L)
{
    return foot->is_start ? after_start(foot, L) : before_end(foot, L);
}

/* Computes the chord and its derivatives, the dofs, and the changes of x, the slope, the chord and b by them. */
static void find_chord(const fu_foot *foot, const double *q, fu_tangent_point *out)
{
    const double L = q[foot->s[1]] - q[foot->s[0]], *node = q + foot->node;
    const fu_chord_end end = fu_chord_end_at(foot, L);
    const int first = foot->first + end.element * NODE_IN_SPACE;
    double N[VECTORS], r[SPACE];
    foot->wheel->foot->chord(q + first, end.length, end.distance, end.by_L, N, out->N_L, r, out->chord_L,
                             out->chord_LL);
    memset(out->by, 0, sizeof out->by);
    for (int i = 0; i < NODE_IN_SPACE; ++i) out->dofs[i] = foot->node + i;
    for (int i = 0; i < FU_FOOT_ELEMENT; ++i) {
        out->dofs[NODE_IN_SPACE + i] = first + i;
        out->by[CHORD + i % SPACE][NODE_IN_SPACE + i] = N[i / SPACE];
    }
    out->b = end.b;
    for (int e = 0; e < 2; ++e) {
        out->dofs[S + e] = foot->s[e];
        out->by[LENGTH][S + e] = e ? end.b_L : -end.b_L;
    }
    for (int d = 0; d < SPACE; ++d) {
        out->chord[d] = r[d] - node[d];
        out->by[d][d] = out->by[SLOPE + d][SLOPE + d] = 1.0;
        out->by[CHORD + d][d] = -1.0;
        out->by[CHORD + d][S] = -out->chord_L[d];
        out->by[CHORD + d][S + 1] = out->chord_L[d];
    }
}

void fu_tangent_point_turn(const fu_wheel_state *wheel, const fu_centre_moves *moves, fu_tangent_point *at)
{
    const int n = at->n - FU_FOOT_CENTRE;
    for (int d = 0; d < SPACE; ++d)
        for (int i = 0; i < n; ++i) at->by[d][FU_FOOT_CENTRE + i] = -moves->P[d * n + i];
    for (int i = 0; i < n && at->n_vectors > AXIS; ++i) {
        double turn[SPACE], change[SPACE];
        for (int d = 0; d < SPACE; ++d) turn[d] = moves->T[d * n + i];
        fu_cross(turn, wheel->axis, change);
        for (int d = 0; d < SPACE; ++d) {
            at->by[AXIS + d][FU_FOOT_CENTRE + i] = change[d];
            at->by[d][FU_FOOT_CENTRE + i] -= at->aside * change[d];
        }
    }
}

void fu_tangent_point_at(const fu_foot *foot, const fu_wheel_state *wheel, const double *q, const double *multipliers,
                         fu_tangent_point *out)
{
    const fu_attachment_state *centre = &wheel->centre;
    const fu_tangent_point_kernels *kernel = foot->wheel->foot;
    fu_centre_moves moves;
    double x[SPACE];
    find_chord(foot, q, out);
    out->aside = foot->aside;
    out->n = FU_FOOT_CENTRE + centre->n;
    out->n_vectors = foot->wheel->tilts ? FU_FOOT_VECTORS : AXIS;
    memcpy(out->dofs + FU_FOOT_CENTRE, centre->at, sizeof(int) * (size_t)centre->n);
    memcpy(moves.P, centre->P, sizeof(double) * (size_t)(SPACE * centre->n));
    memcpy(moves.T, centre->T, sizeof(double) * (size_t)(SPACE * centre->n));
    fu_tangent_point_turn(wheel, &moves, out);
    for (int d = 0; d < SPACE; ++d) x[d] = q[foot->node + d] - centre->p[d] - foot->aside * wheel->axis[d];
    (foot->wheel->tilts ? kernel->turned_conditions : kernel->conditions)(
        x, q + foot->node + SLOPE, out->chord, out->b, wheel->axis, foot->weight, foot->wheel->A[0], foot->by_chord,
        foot->limit, foot->radius, multipliers, out->phi, out->J, out->K);
}

void fu_tangent_point_rows(const fu_tangent_point *at, double *rows)
{
    for (int r = 0; r < FU_FOOT_CONDITIONS; ++r)
        for (int j = 0; j < at->n; ++j) {
            double sum = 0.0;
            for (int i = 0; i < at->n_vectors; ++i) sum += derivative(at, r, i) * at->by[i][j];
            rows[r * at->n + j] = sum;
        }
}

/* Adds the second derivatives of the chord, times a force on it: it is not linear in the length of the span. */
static void add_bending_of_chord(const fu_tangent_point *at, const double force[SPACE], double *K)
{
    const int n = at->n;
    for (int e = 0; e < 2; ++e) {
        const double sign = e ? 1.0 : -1.0;
        for (int i = 0; i < FU_FOOT_ELEMENT; ++i) {
            const double value = sign * at->N_L[i / SPACE] * force[i % SPACE];
            K[(NODE_IN_SPACE + i) * n + S + e] += value;
            K[(S + e) * n + NODE_IN_SPACE + i] += value;
        }
        for (int f = 0; f < 2; ++f)
            K[(S + e) * n + S + f] += (e == f ? 1.0 : -1.0) * fu_dot(SPACE, at->chord_LL, force);
    }
}

/* Computes the force on the axis, as if it were a place. */
static void find_force_on_axis(const fu_tangent_point *at, const double *multipliers, double out[SPACE])
{
    for (int d = 0; d < SPACE; ++d) {
        out[d] = 0.0;
        for (int r = 0; r < FU_FOOT_CONDITIONS; ++r)
            out[d] += multipliers[r] * (derivative(at, r, AXIS + d) - at->aside * derivative(at, r, d));
    }
}

void fu_tangent_point_add_forces(const fu_wheel_state *wheel, const fu_tangent_point *at, const double *multipliers,
                                 double on_node[FU_GROOVE], double *on_wheel)
{
    double force[SPACE] = {0.0}, moment[SPACE], in_groove[FU_GROOVE];
    for (int r = 0; r < FU_FOOT_CONDITIONS; ++r)
        for (int d = 0; d < SPACE; ++d) force[d] += derivative(at, r, d) * multipliers[r];
    fu_into_groove(wheel, force, in_groove);
    on_wheel[FU_WHEEL_ACROSS] -= fu_dot(SPACE, wheel->axis, force);
    for (int d = 0; d < FU_GROOVE; ++d) {
        on_node[d] += in_groove[d];
        on_wheel[d] -= in_groove[d];
    }
    if (at->n_vectors == AXIS) return;
    find_force_on_axis(at, multipliers, force);
    fu_cross(wheel->axis, force, moment);
    fu_into_groove(wheel, moment, in_groove);
    for (int d = 0; d < FU_TILTS; ++d) on_wheel[FU_WHEEL_TILT + d] += in_groove[d];
}

/* Adds the change of the moment on the body, as the axis turns under the force on it. */
static void add_turning(const fu_wheel_state *wheel, const fu_tangent_point *at, const fu_tangent_point *columns,
                        const double *multipliers, double *K)
{
    const int n = at->n, n_centre = wheel->centre.n;
    double force[SPACE];
    find_force_on_axis(at, multipliers, force);
    for (int j = FU_FOOT_CENTRE; j < n; ++j) {
        double turned[SPACE], moment[SPACE];
        for (int d = 0; d < SPACE; ++d) turned[d] = columns->by[AXIS + d][j];
        fu_cross(turned, force, moment);
        for (int i = 0; i < n_centre; ++i)
            for (int d = 0; d < SPACE; ++d)
                K[(FU_FOOT_CENTRE + i) * n + j] += wheel->centre.T[d * n_centre + i] * moment[d];
    }
}

void fu_tangent_point_stiffness(const fu_wheel_state *wheel, const fu_tangent_point *at,
                                const fu_tangent_point *columns, const double *multipliers, double *K)
{
    const int n_vectors = at->n_vectors;
    double force[SPACE] = {0.0};
    for (int j = 0; j < at->n; ++j) {
        double column[FU_FOOT_VECTORS] = {0.0};
        for (int i = 0; i < n_vectors; ++i)
            for (int m = 0; m < n_vectors; ++m) column[i] += at->K[i * n_vectors + m] * columns->by[m][j];
        for (int i = 0; i < at->n; ++i) {
            double sum = 0.0;
            for (int m = 0; m < n_vectors; ++m) sum += at->by[m][i] * column[m];
            K[i * at->n + j] = sum;
        }
    }
    for (int r = 0; r < FU_FOOT_CONDITIONS; ++r)
        for (int d = 0; d < SPACE; ++d) force[d] += multipliers[r] * derivative(at, r, CHORD + d);
    add_bending_of_chord(at, force, K);
    if (n_vectors > AXIS) add_turning(wheel, at, columns, multipliers, K);
}

void fu_tangent_point_add(const fu_model *model, const fu_wheel_state *wheel, const fu_tangent_point *at,
                          const fu_centre_moves *moves, const double *multipliers, const double *scale, fu_weights w,
                          int first, int n_rows, int own, fu_system *system)
{
    const int n = at->n;
    double rows[FU_FOOT_CONDITIONS * FU_FOOT_DOFS], columns[FU_FOOT_CONDITIONS * FU_FOOT_DOFS],
        K[FU_FOOT_DOFS * FU_FOOT_DOFS];
    fu_tangent_point turned = *at;
    fu_tangent_point_turn(wheel, moves, &turned);
    fu_tangent_point_rows(&turned, rows);
    fu_tangent_point_rows(at, columns);
    fu_tangent_point_stiffness(wheel, at, &turned, multipliers, K);
    for (int j = 0; j < n; ++j) {
        for (int r = 0; r < n_rows; ++r) {
            const double unit = fu_row_unit(w.inertia, scale[r]);
            const double row = rows[(first + r) * n + j], column = columns[(first + r) * n + j];
            if (row != 0.0) fu_add(model, system, own + r, at->dofs[j], unit * row);
            if (column != 0.0) fu_add(model, system, at->dofs[j], own + r, unit * column);
        }
        for (int i = 0; i < n; ++i)
            if (K[i * n + j] != 0.0) fu_add(model, system, at->dofs[i], at->dofs[j], w.stiffness * K[i * n + j]);
    }
}

/* Computes the rate of the axis and its second rate at zero accelerations. */
static void find_motion_of_axis(const fu_wheel_state *wheel, double rate[SPACE], double second[SPACE])
{
    double of_bias[SPACE];
    fu_cross(wheel->centre.omega, wheel->axis, rate);
    fu_cross(wheel->centre.omega, rate, second);
    fu_cross(wheel->centre.alpha, wheel->axis, of_bias);
    for (int d = 0; d < SPACE; ++d) second[d] += of_bias[d];
}

void fu_tangent_point_bias(const fu_foot *foot, const fu_tangent_point *at, const fu_wheel_state *wheel,
                           const double *q, const double *v, double bias[FU_FOOT_CONDITIONS])
{
    const double L_rate = v[at->dofs[S + 1]] - v[at->dofs[S]];
    const fu_tangent_point_kernels *kernel = foot->wheel->foot;
    double x[SPACE], rate[FU_FOOT_VECTORS] = {0.0}, second[FU_FOOT_VECTORS] = {0.0};
    for (int d = 0; d < SPACE; ++d) {
        x[d] = q[foot->node + d] - wheel->centre.p[d] - foot->aside * wheel->axis[d];
        second[d] = -wheel->centre.bias[d];
        second[CHORD + d] = at->chord_LL[d] * L_rate * L_rate;
    }
    for (int j = 0; j < at->n; ++j)
        for (int i = 0; i < AXIS; ++i) rate[i] += at->by[i][j] * v[at->dofs[j]];
    for (int i = 0; i < FU_FOOT_ELEMENT; ++i)
        second[CHORD + i % SPACE] += 2.0 * L_rate * at->N_L[i / SPACE] * v[at->dofs[NODE_IN_SPACE + i]];
    if (foot->wheel->tilts) {
        find_motion_of_axis(wheel, rate + AXIS, second + AXIS);
        for (int d = 0; d < SPACE; ++d) second[d] -= foot->aside * second[AXIS + d];
        kernel->turned_motion(x, q + foot->node + SLOPE, at->chord, at->b, wheel->axis, foot->weight, foot->wheel->A[0],
                              foot->by_chord, foot->limit, rate, rate + SLOPE, rate + CHORD, rate[LENGTH], rate + AXIS,
                              bias);
    } else
        kernel->motion(x, q + foot->node + SLOPE, at->chord, at->b, wheel->axis, foot->weight, foot->wheel->A[0],
                       foot->by_chord, foot->limit, rate, rate + SLOPE, rate + CHORD, rate[LENGTH], bias);
    for (int r = 0; r < FU_FOOT_CONDITIONS; ++r)
        for (int i = 0; i < at->n_vectors; ++i) bias[r] += derivative(at, r, i) * second[i];
}

double fu_fleet_angle(const fu_foot *foot, const double *q, const double axis[SPACE])
{
    fu_tangent_point at;
    find_chord(foot, q, &at);
    return asin(fu_dot(SPACE, axis, at.chord) / sqrt(fu_dot(SPACE, at.chord, at.chord)));
}
