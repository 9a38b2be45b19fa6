/* Contact of a cable with a plane that does not move, without friction: the heights of its points are sums over those
 * of its nodal vectors, and no other part of their motion matters. */
#include "bodies/model.h"
#include "couplings/common/point_lanes.h"
#include "couplings/contact/contact.h"

#include <math.h>
#include <string.h>

/* Computes the sums of the values at four nodal vectors times the rows of their shape functions at four points. */
FU_INLINE void sums_at(const double *values, const double *const rows[FU_BLOCK_POINTS], double *out)
{
    const fu_points a = *(const fu_simd_block *)rows[0], b = *(const fu_simd_block *)rows[1],
                    c = *(const fu_simd_block *)rows[2], d = *(const fu_simd_block *)rows[3];
    const fu_points ab = FU_SHUFFLE(a, b, 0, 4, 2, 6), next_ab = FU_SHUFFLE(a, b, 1, 5, 3, 7),
                    cd = FU_SHUFFLE(c, d, 0, 4, 2, 6), next_cd = FU_SHUFFLE(c, d, 1, 5, 3, 7);
    fu_points sum = FU_SHUFFLE(ab, cd, 0, 1, 4, 5) * values[0];
    sum += FU_SHUFFLE(next_ab, next_cd, 0, 1, 4, 5) * values[1];
    sum += FU_SHUFFLE(ab, cd, 2, 3, 6, 7) * values[2];
    *(fu_simd_block *)out = sum + FU_SHUFFLE(next_ab, next_cd, 2, 3, 6, 7) * values[3];
}

/* Computes the sums of values at the nodal vectors at each point; those of four vectors in blocks of points, whose
 * unused places get the sum at the last point. */
FU_INLINE void sums_over(int n, int n_points, const double *N, const double *values, double *out)
{
    for (int k = 0; k < n_points && n != 4; ++k) out[k] = fu_dot(n, N + k * n, values);
    for (int from = 0; from < n_points && n == 4; from += FU_BLOCK_POINTS) {
        const double *rows[FU_BLOCK_POINTS];
        for (int p = 0; p < FU_BLOCK_POINTS; ++p) rows[p] = N + 4 * (from + p < n_points ? from + p : n_points - 1);
        sums_at(values, rows, out + from);
    }
}

FU_INLINE void heights_of(int dim, int n, const fu_contact *contact, const fu_attachment_state *on, const double *q,
                          const double *v, fu_contact_heights *out)
{
    double values[FU_MAX_COORDINATES], deepest = -INFINITY;
    fu_surface_out(dim, on, contact->surface.direction, out->normal);
    const double origin = fu_dot(dim, out->normal, on->p);
    for (int i = 0; i < n; ++i) values[i] = fu_dot(dim, out->normal, q + i * dim);
    sums_over(n, contact->n_points, out->N, values, out->depth);
    for (int k = 0; k < contact->n_points; ++k) {
        const double depth = contact->radius - (out->depth[k] - origin);
        out->depth[k] = depth;
        deepest = depth > deepest ? depth : deepest;
    }
    out->deepest = deepest;
    for (int i = 0; i < n && deepest > 0.0; ++i) out->rate[i] = fu_dot(dim, out->normal, v + i * dim);
}

FU_INLINE void by_shapes(int dim, const fu_contact *contact, const fu_attachment_state *on, const double *q,
                         const double *v, fu_contact_heights *out)
{
    FU_BY_SHAPES(heights_of, dim, out->n, contact, on, q, v, out);
}

static void compute(int dim, const fu_contact *contact, const fu_attachment_state *on, const double *q, const double *v,
                    fu_contact_heights *out);
FU_SIMD_FUNCTION(compute, by_shapes,
                 (int dim, const fu_contact *contact, const fu_attachment_state *on, const double *q, const double *v,
                  fu_contact_heights *out),
                 (dim, contact, on, q, v, out))

void fu_contact_compute_heights(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                                const fu_state *state, int element, fu_contact_heights *out)
{
    const int dim = model->dim, first = fu_contact_first(model, contact, element);
    out->n = model->cables[contact->cable].coordinates / dim;
    out->N = fu_contact_shapes(contact, out->n, element, 0);
    compute(dim, contact, on, state->q + first, state->v + first, out);
}

int fu_contact_is_pressed(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, int number,
                          const fu_contact_heights *heights, fu_contact_point *point)
{
    point->mark = 0;
    point->depth = heights->depth[number];
    if (!(point->depth > 0.0)) return 0;
    point->sinking = -fu_dot(heights->n, heights->N + number * heights->n, heights->rate);
    point->distance.g = contact->radius - point->depth;
    memcpy(point->distance.n, heights->normal, sizeof heights->normal);
    memset(point->distance.H, 0, sizeof point->distance.H);
    for (int d = 0; d < model->dim; ++d) point->past[d] = -point->sinking * heights->normal[d];
    fu_contact_press(model, contact, on, point);
    return 1;
}
