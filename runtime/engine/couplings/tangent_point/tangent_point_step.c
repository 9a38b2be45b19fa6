/* Tangent points in space over a step that conserves energy (derive/couplings/turning_step.py): the mean gradient of
 * the conditions by the products of their vectors, by quadrature.
 *
 * A chord ends in another element where it passes a node within the step. Its shape functions are then those of the
 * nodes of both elements, zero for those of the other one. Where a point lies across its slope, their product has its
 * mean gradient by the means of both. */
#include "couplings/tangent_point/tangent_point.h"

#include <string.h>

enum { SPACE = 3, SLOPE = 3, LEAN = 1, ENDS = 2, PER_NODE = 2, NODE = PER_NODE * SPACE, OF_ELEMENT = 2 * PER_NODE };
enum { MAX_SHAPES = 2 * OF_ELEMENT, X_X = 0, A_X, D_X, D_D, A_D, X_W, A_W, D_W, B, PRODUCTS };

/* A chord over a step, over the nodal vectors D of n / 2 nodes, slopes times the length L of the span: dofs of these;
 * D, its shape functions, L and b at both ends; means of D and of the functions, their change over that of L, and that
 * of b. */
typedef struct {
    int n, dofs[MAX_SHAPES];
    double D[ENDS][MAX_SHAPES][SPACE], N[ENDS][MAX_SHAPES], L[ENDS], b[ENDS];
    double middle[MAX_SHAPES][SPACE], mean[MAX_SHAPES], N_L[MAX_SHAPES], b_L;
} chord_step;

/* Products of the vectors of a tangent point, and their means with D. */
typedef struct {
    double x[ENDS][SPACE], middle_x[SPACE], middle_axis[SPACE], products[ENDS][PRODUCTS];
} foot_vectors;

/* Returns the number of the first shape function of an element among those of the chord. */
static int first_of(const fu_chord_end end[ENDS], int e)
{
    const int lower = end[0].element < end[1].element ? end[0].element : end[1].element;
    const int apart = end[e].element - lower;
    return PER_NODE * (apart < PER_NODE ? apart : PER_NODE);
}

/* Computes the shape functions at both ends, and their change over that of the length of the span. */
static void find_shapes(const fu_foot *foot, const fu_chord_end end[ENDS], chord_step *out)
{
    double xi[ENDS], N[ENDS][OF_ELEMENT], N_xi[OF_ELEMENT];
    const int is_same =
        end[0].element == end[1].element && end[0].by_L[0] == end[1].by_L[0] && end[0].b_L == end[1].b_L;
    const double change = out->L[1] - out->L[0];
    for (int e = 0; e < ENDS; ++e) xi[e] = end[e].distance / end[e].length;
    foot->wheel->foot->chord_step(xi, N[0], N_xi);
    memset(out->N, 0, sizeof out->N);
    for (int e = 0; e < ENDS; ++e)
        for (int i = 0; i < OF_ELEMENT; ++i)
            out->N[e][first_of(end, e) + i] = N[e][i] * (i % PER_NODE ? end[e].by_L[1] : 1.0);
    /* xi is linear in 1/L */
    const double xi_L = (end[0].by_L[0] * out->L[0] - end[0].distance) / (end[0].length * out->L[1]);
    for (int i = 0; i < out->n; ++i) {
        const double share = i % PER_NODE ? end[0].by_L[1] : 1.0, jump = out->N[1][i] - out->N[0][i];
        out->N_L[i] = is_same ? share * N_xi[i] * xi_L : change != 0.0 ? jump / change : 0.0;
        out->mean[i] = 0.5 * (out->N[0][i] + out->N[1][i]);
    }
    out->b_L = is_same ? end[0].b_L : change != 0.0 ? (out->b[1] - out->b[0]) / change : 0.0;
}

static void find_chord(const fu_foot *foot, const fu_foot_step *step, chord_step *out)
{
    fu_chord_end end[ENDS];
    for (int e = 0; e < ENDS; ++e) {
        out->L[e] = step->q[e][foot->s[1]] - step->q[e][foot->s[0]];
        end[e] = fu_chord_end_at(foot, out->L[e]);
        out->b[e] = end[e].b;
    }
    const int later = first_of(end, 0) > first_of(end, 1) ? 0 : 1;
    out->n = OF_ELEMENT + first_of(end, later);
    for (int i = 0; i < out->n; ++i) {
        const int from = i < first_of(end, later) ? !later : later, at = i - first_of(end, from);
        out->dofs[i] = foot->first + end[from].element * NODE + at * SPACE;
    }
    for (int e = 0; e < ENDS; ++e)
        for (int i = 0; i < out->n; ++i)
            for (int d = 0; d < SPACE; ++d) {
                const double value = step->q[e][out->dofs[i] + d];
                out->D[e][i][d] = i % PER_NODE ? out->L[e] * value : value - step->q[e][foot->node + d];
            }
    for (int i = 0; i < out->n; ++i)
        for (int d = 0; d < SPACE; ++d) out->middle[i][d] = 0.5 * (out->D[0][i][d] + out->D[1][i][d]);
    find_shapes(foot, end, out);
}

static void find_vectors(const fu_foot *foot, const fu_foot_step *step, const chord_step *chord, foot_vectors *out)
{
    for (int e = 0; e < ENDS; ++e) {
        const double *a = step->axis[e], *w = foot->weight, *x = out->x[e];
        double d[SPACE] = {0.0}, *to = out->products[e];
        for (int i = 0; i < chord->n; ++i)
            for (int k = 0; k < SPACE; ++k) d[k] += chord->N[e][i] * chord->D[e][i][k];
        for (int k = 0; k < SPACE; ++k) out->x[e][k] = step->q[e][foot->node + k] - step->centre[e][k];
        to[X_X] = fu_dot(SPACE, x, x);
        to[A_X] = fu_dot(SPACE, a, x);
        to[D_X] = fu_dot(SPACE, d, x);
        to[D_D] = fu_dot(SPACE, d, d);
        to[A_D] = fu_dot(SPACE, a, d);
        to[X_W] = fu_dot(SPACE, x, w);
        to[A_W] = fu_dot(SPACE, a, w);
        to[D_W] = fu_dot(SPACE, d, w);
        to[B] = chord->b[e];
    }
    for (int k = 0; k < SPACE; ++k) {
        out->middle_x[k] = 0.5 * (out->x[0][k] + out->x[1][k]);
        out->middle_axis[k] = 0.5 * (step->axis[0][k] + step->axis[1][k]);
    }
}

/* Computes the forces of the multipliers on the products. */
static void mean_gradient(const fu_foot *foot, const foot_vectors *of, const double *multipliers, double g[PRODUCTS])
{
    const double square = fu_dot(SPACE, foot->weight, foot->weight);
    memset(g, 0, sizeof(double) * PRODUCTS);
    for (int k = 0; k < FU_STEP_POINTS; ++k) {
        double at[PRODUCTS], phi[FU_FOOT_CONDITIONS], J[FU_FOOT_CONDITIONS * PRODUCTS];
        for (int i = 0; i < PRODUCTS; ++i)
            at[i] = of->products[0][i] + fu_part_of_step[k] * (of->products[1][i] - of->products[0][i]);
        foot->wheel->foot->by_products(at, square, foot->wheel->A[0], foot->limit, foot->radius, phi, J);
        for (int r = 0; r < FU_FOOT_CONDITIONS; ++r)
            for (int i = 0; i < PRODUCTS; ++i) g[i] += fu_weight_in_step[k] * multipliers[r] * J[r * PRODUCTS + i];
    }
}

/* Returns the mean of the products of a vector at both ends and the i-th nodal vector. */
static double mean_product(const chord_step *chord, int i, const double *at_start, const double *at_end)
{
    return 0.5 * (fu_dot(SPACE, at_start, chord->D[0][i]) + fu_dot(SPACE, at_end, chord->D[1][i]));
}

/* Adds the forces on the nodal vectors of the chord, and on the length of the span. */
static void add_on_chord(const fu_foot *foot, const fu_foot_step *step, const chord_step *chord, const foot_vectors *of,
                         const double g[PRODUCTS], double *f)
{
    double on_L = g[B] * chord->b_L;
    const double L = 0.5 * (chord->L[0] + chord->L[1]);
    for (int i = 0; i < chord->n; ++i) {
        double force[SPACE];
        for (int k = 0; k < SPACE; ++k)
            force[k] =
                chord->mean[i] * (g[D_X] * of->middle_x[k] + g[A_D] * of->middle_axis[k] + g[D_W] * foot->weight[k]);
        on_L += chord->N_L[i] * (g[D_X] * mean_product(chord, i, of->x[0], of->x[1]) +
                                 g[A_D] * mean_product(chord, i, step->axis[0], step->axis[1]) +
                                 g[D_W] * mean_product(chord, i, foot->weight, foot->weight));
        for (int j = 0; j < chord->n; ++j) {
            const double N_N = 0.5 * (chord->N[0][i] * chord->N[0][j] + chord->N[1][i] * chord->N[1][j]);
            for (int k = 0; k < SPACE; ++k) force[k] += 2.0 * g[D_D] * N_N * chord->middle[j][k];
            on_L +=
                2.0 * g[D_D] * chord->N_L[i] * chord->mean[j] * mean_product(chord, i, chord->D[0][j], chord->D[1][j]);
        }
        for (int k = 0; k < SPACE; ++k) {
            const int dof = chord->dofs[i] + k;
            if (i % PER_NODE) {
                f[dof] += L * force[k];
                on_L += 0.5 * (step->q[0][dof] + step->q[1][dof]) * force[k];
            } else {
                f[dof] += force[k];
                f[foot->node + k] -= force[k];
            }
        }
    }
    f[foot->s[0]] -= on_L;
    f[foot->s[1]] += on_L;
}

void fu_tangent_point_over_step(const fu_foot *foot, const fu_foot_step *step, const double *multipliers, double *f,
                                double force[SPACE], double moment[SPACE])
{
    const double lean = multipliers[LEAN], by_slope = (1.0 - foot->by_chord) * lean;
    const double by_chord[FU_FOOT_CONDITIONS] = {multipliers[0], foot->by_chord * lean, multipliers[2]};
    double g[PRODUCTS], d[SPACE] = {0.0}, on_axis[SPACE], turn[SPACE];
    chord_step chord;
    foot_vectors of;
    find_chord(foot, step, &chord);
    find_vectors(foot, step, &chord, &of);
    mean_gradient(foot, &of, by_chord, g);
    add_on_chord(foot, step, &chord, &of, g, f);
    for (int i = 0; i < chord.n; ++i)
        for (int k = 0; k < SPACE; ++k) d[k] += chord.mean[i] * chord.middle[i][k];
    for (int k = 0; k < SPACE; ++k) {
        const int slope = foot->node + SLOPE + k;
        const double x = 2.0 * g[X_X] * of.middle_x[k] + g[A_X] * of.middle_axis[k] + g[D_X] * d[k] +
                         g[X_W] * foot->weight[k] + by_slope * 0.5 * (step->q[0][slope] + step->q[1][slope]);
        f[slope] += by_slope * of.middle_x[k];
        f[foot->node + k] += x;
        force[k] -= x;
        on_axis[k] = g[A_X] * of.middle_x[k] + g[A_D] * d[k] + g[A_W] * foot->weight[k];
    }
    fu_cross(of.middle_axis, on_axis, turn);
    for (int k = 0; k < SPACE; ++k) moment[k] += turn[k];
}
