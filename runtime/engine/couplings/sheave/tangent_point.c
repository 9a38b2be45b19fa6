/* Tangent points in space: the conditions of a node at the end of a span, with the chord over a fixed stress-free
 * length of the span. */
#include "couplings/sheave/sheave.h"

#include <math.h>
#include <string.h>

enum { NODE_IN_SPACE = 2 * SPACE, VECTORS = 4, S = NODE_IN_SPACE + FU_FOOT_ELEMENT };
enum { CHORD = SPACE, LENGTH = 2 * SPACE };

static double derivative(const fu_tangent_point *at, int row, int of)
{
    return at->J[row * FU_FOOT_VECTORS + of];
}

/* A span beside a sheave; reach: number of elements within reach of the chord. */
typedef struct {
    int first, n_elements, reach;
    const int *s;
    const double *share;
    double chord;
} adjoining_span;

static adjoining_span span_beside(const fu_sheave *sheave, int k)
{
    return (adjoining_span){sheave->span_first[k],
                            sheave->span_elements[k],
                            sheave->span_reach[k],
                            sheave->span_s + 2 * k,
                            k ? sheave->share_after : sheave->share_before,
                            sheave->chord[k]};
}

/* The point at which a chord ends: its element, and there the distance from the first node and the element's length,
 * and the stress-free length of the chord, with their derivatives by the length of the span. */
typedef struct {
    int element;
    double distance, length, by_L[2], b, b_L;
} chord_end;

/* Returns the end of a chord from the first node of a span of the length L. */
static chord_end after_start(const adjoining_span *span, double L)
{
    const double *share = span->share;
    const int last = span->reach - 1;
    int j = 0;
    while (j < last && share[j + 1] * L < span->chord) ++j;
    const double whole = share[j + 1] - share[j];
    if (span->chord > share[j + 1] * L)
        return (chord_end){j, whole * L, whole * L, {whole, whole}, share[j + 1] * L, share[j + 1]};
    return (chord_end){j, span->chord - share[j] * L, whole * L, {-share[j], whole}, span->chord, 0.0};
}

/* Returns the end of a chord from the last node. */
static chord_end before_end(const adjoining_span *span, double L)
{
    const double *share = span->share;
    const int first = span->n_elements - span->reach;
    int j = span->n_elements - 1;
    while (j > first && (1.0 - share[j]) * L < span->chord) --j;
    const double whole = share[j + 1] - share[j], rest = 1.0 - share[j];
    if (span->chord > rest * L) return (chord_end){j, 0.0, whole * L, {0.0, whole}, rest * L, rest};
    return (chord_end){j, rest * L - span->chord, whole * L, {rest, whole}, span->chord, 0.0};
}

/* Computes the chord and its derivatives, the dofs, and the changes of x, the chord and b by them. */
static void find_chord(const fu_sheave *sheave, int k, const double *q, fu_tangent_point *out)
{
    const adjoining_span span = span_beside(sheave, k);
    const double L = q[span.s[1]] - q[span.s[0]], *foot = q + sheave->nodes[k];
    const chord_end end = k ? after_start(&span, L) : before_end(&span, L);
    const int first = span.first + end.element * NODE_IN_SPACE;
    double N[VECTORS], r[SPACE];
    sheave->wheel.foot->chord(q + first, end.length, end.distance, end.by_L, N, out->N_L, r, out->chord_L,
                              out->chord_LL);
    memset(out->by, 0, sizeof out->by);
    for (int i = 0; i < NODE_IN_SPACE; ++i) out->dofs[i] = sheave->nodes[k] + i;
    for (int i = 0; i < FU_FOOT_ELEMENT; ++i) {
        out->dofs[NODE_IN_SPACE + i] = first + i;
        out->by[CHORD + i % SPACE][NODE_IN_SPACE + i] = N[i / SPACE];
    }
    out->b = end.b;
    for (int e = 0; e < 2; ++e) {
        out->dofs[S + e] = span.s[e];
        out->by[LENGTH][S + e] = e ? end.b_L : -end.b_L;
    }
    for (int d = 0; d < SPACE; ++d) {
        out->chord[d] = r[d] - foot[d];
        out->by[d][d] = 1.0;
        out->by[CHORD + d][d] = -1.0;
        out->by[CHORD + d][S] = -out->chord_L[d];
        out->by[CHORD + d][S + 1] = out->chord_L[d];
    }
}

void fu_tangent_point_turn(const double *of_centre, fu_tangent_point *at)
{
    const int n = at->n - FU_FOOT_CENTRE;
    for (int d = 0; d < SPACE; ++d)
        for (int i = 0; i < n; ++i) at->by[d][FU_FOOT_CENTRE + i] = -of_centre[d * n + i];
}

void fu_tangent_point_at(const fu_sheave *sheave, int k, const fu_attachment_state *centre, const double *q,
                         const double *multipliers, fu_tangent_point *out)
{
    const double *foot = q + sheave->nodes[k];
    double x[SPACE];
    find_chord(sheave, k, q, out);
    out->n = FU_FOOT_CENTRE + centre->n;
    memcpy(out->dofs + FU_FOOT_CENTRE, centre->at, sizeof(int) * (size_t)centre->n);
    fu_tangent_point_turn(centre->P, out);
    for (int d = 0; d < SPACE; ++d) x[d] = foot[d] - centre->p[d];
    sheave->wheel.foot->conditions(x, out->chord, out->b, sheave->wheel.axis, sheave->weight, sheave->wheel.A[0],
                                   sheave->limit, sheave->tangent_radius[k], multipliers, out->phi, out->J, out->K);
}

void fu_tangent_point_rows(const fu_tangent_point *at, double *rows)
{
    for (int r = 0; r < FU_FOOT_CONDITIONS; ++r)
        for (int j = 0; j < at->n; ++j) {
            double sum = 0.0;
            for (int i = 0; i < FU_FOOT_VECTORS; ++i) sum += derivative(at, r, i) * at->by[i][j];
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

void fu_tangent_point_stiffness(const fu_tangent_point *at, const fu_tangent_point *columns, const double *multipliers,
                                double *K)
{
    double force[SPACE] = {0.0};
    for (int j = 0; j < at->n; ++j) {
        double column[FU_FOOT_VECTORS] = {0.0};
        for (int i = 0; i < FU_FOOT_VECTORS; ++i)
            for (int m = 0; m < FU_FOOT_VECTORS; ++m) column[i] += at->K[i * FU_FOOT_VECTORS + m] * columns->by[m][j];
        for (int i = 0; i < at->n; ++i) {
            double sum = 0.0;
            for (int m = 0; m < FU_FOOT_VECTORS; ++m) sum += at->by[m][i] * column[m];
            K[i * at->n + j] = sum;
        }
    }
    for (int r = 0; r < FU_FOOT_CONDITIONS; ++r)
        for (int d = 0; d < SPACE; ++d) force[d] += multipliers[r] * derivative(at, r, CHORD + d);
    add_bending_of_chord(at, force, K);
}

void fu_tangent_point_bias(const fu_sheave *sheave, int k, const fu_tangent_point *at,
                           const fu_attachment_state *centre, const double *q, const double *v,
                           double bias[FU_FOOT_CONDITIONS])
{
    const double *foot = q + sheave->nodes[k], L_rate = v[at->dofs[S + 1]] - v[at->dofs[S]];
    double x[SPACE], rate[FU_FOOT_VECTORS] = {0.0}, second[FU_FOOT_VECTORS] = {0.0};
    for (int d = 0; d < SPACE; ++d) {
        x[d] = foot[d] - centre->p[d];
        second[d] = -centre->bias[d];
        second[CHORD + d] = at->chord_LL[d] * L_rate * L_rate;
    }
    for (int j = 0; j < at->n; ++j)
        for (int i = 0; i < FU_FOOT_VECTORS; ++i) rate[i] += at->by[i][j] * v[at->dofs[j]];
    for (int i = 0; i < FU_FOOT_ELEMENT; ++i)
        second[CHORD + i % SPACE] += 2.0 * L_rate * at->N_L[i / SPACE] * v[at->dofs[NODE_IN_SPACE + i]];
    sheave->wheel.foot->motion(x, at->chord, at->b, sheave->wheel.axis, sheave->weight, sheave->wheel.A[0],
                               sheave->limit, rate, rate + CHORD, rate[LENGTH], bias);
    for (int r = 0; r < FU_FOOT_CONDITIONS; ++r)
        for (int i = 0; i < FU_FOOT_VECTORS; ++i) bias[r] += derivative(at, r, i) * second[i];
}

double fu_fleet_angle(const fu_sheave *sheave, int k, const double *q)
{
    fu_tangent_point at;
    find_chord(sheave, k, q, &at);
    return asin(fu_dot(SPACE, sheave->wheel.axis, at.chord) / sqrt(fu_dot(SPACE, at.chord, at.chord)));
}
