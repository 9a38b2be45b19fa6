/* The closest points of the two lines of a crossing, by Newton's method from their last positions, over all elements
 * of a cable.
 *
 * Beyond its ends a cable continues straight, so that points have arc-lengths there, too, which give the distance to
 * the end. */
#include "base/cubic.h"
#include "bodies/model.h"
#include "couplings/crossing/crossing.h"

#include <math.h>
#include <string.h>

#define MAX_ITERATIONS 40
/* of the line's size and s: a correction that is rounding ends the iteration */
#define ROUNDING_OF_LENGTH 1e-15
/* of the size: a correction of this size is sufficient if rounding keeps it from shrinking */
#define LENGTH_TOLERANCE 1e-11
#define MAX_CORRECTION 2.0    /* elements: largest correction */
#define SAMPLES_PER_ELEMENT 4 /* of an element, for a new search */

static void point_of_cable(const fu_cable *cable, const double *q, const double *v, double s, fu_line_point *out)
{
    const int dim = cable->kernel->dim, n = cable->coordinates / dim;
    const double within = fmin(fmax(s, 0.0), fu_cable_length(cable)), beyond = s - within;
    double every[9 * FU_MAX_COORDINATES];
    out->element = fu_cable_element_at(cable, within);
    const double length = fu_element_length(cable, out->element), start = fu_cable_start(cable, out->element);
    const int first = fu_element_entry(cable, out->element);
    cable->kernel->on_axis(length, within - start, out->N, out->N_x);
    cable->kernel->slopes(length, within - start, every);
    for (int i = 0; i < n && beyond != 0.0; ++i) out->N[i] += beyond * out->N_x[i];
    memset(out->r, 0, sizeof(double[15]));
    for (int i = 0; i < n; ++i)
        for (int d = 0; d < dim; ++d) {
            const double at = q[first + i * dim + d], rate = v[first + i * dim + d];
            /* from the first node: slopes do not depend on its position, and no digits are lost far from the origin */
            const double local = at - (i % cable->kernel->vectors == 0 ? q[first + d] : 0.0);
            out->r[d] += out->N[i] * at;
            out->t[d] += out->N_x[i] * local;
            out->k[d] += beyond != 0.0 ? 0.0 : every[n + i] * local;
            out->v[d] += out->N[i] * rate;
            out->w[d] += out->N_x[i] * rate;
        }
}

/* Computes the attachment of a bar at a point of it. */
static fu_attachment on_bar(const fu_crossing *crossing, double s)
{
    fu_attachment on = crossing->attachments[0];
    for (int d = 0; d < 3; ++d) on.u[d] += s * crossing->axis[d];
    return on;
}

/* A bar is straight: its slope is the vector to the point one metre further. */
static void point_of_bar(const fu_model *model, const fu_crossing *crossing, const fu_state *state, double s,
                         fu_line_point *out)
{
    fu_attachment_state at, next;
    out->on = on_bar(crossing, s);
    fu_attachment_at(model, &out->on, state, 0.0, FU_POINT, &at);
    memset(out->r, 0, sizeof(double[15]));
    for (int d = 0; d < model->dim; ++d) {
        out->r[d] = at.p[d];
        out->v[d] = at.v[d];
    }
    if (model->dim == 2) return;
    const fu_attachment on = on_bar(crossing, s + 1.0);
    fu_attachment_at(model, &on, state, 0.0, FU_POINT, &next);
    for (int d = 0; d < model->dim; ++d) {
        out->t[d] = next.p[d] - at.p[d];
        out->w[d] = next.v[d] - at.v[d];
    }
}

void fu_line_point_of(const fu_model *model, const fu_crossing *crossing, int line, const fu_state *state, double s,
                      fu_line_point *out)
{
    if (crossing->cables[line] >= 0) point_of_cable(&model->cables[crossing->cables[line]], state->q, state->v, s, out);
    else point_of_bar(model, crossing, state, s, out);
}

/* Computes the rates of change of the second derivatives by arc-length: those of a cable are linear in its
 * coordinates. */
static void bends_of_line(const fu_model *model, const fu_crossing *crossing, int line, const fu_state *state, double s,
                          double *out)
{
    fu_line_point rates;
    memset(out, 0, sizeof(double[3]));
    if (crossing->cables[line] < 0) return;
    point_of_cable(&model->cables[crossing->cables[line]], state->v, state->v, s, &rates);
    memcpy(out, rates.k, sizeof rates.k);
}

void fu_line_bends_at(const fu_model *model, const fu_crossing *crossing, const fu_state *state,
                      const fu_closest_points *points, fu_line_bends *out)
{
    const int dim = model->dim;
    double every[9 * FU_MAX_COORDINATES];
    memset(out, 0, sizeof *out);
    for (int line = 0; line < dim - 1 && crossing->cables[line] >= 0; ++line) {
        const fu_cable *cable = &model->cables[crossing->cables[line]];
        const int n = cable->coordinates / dim, element = points->line[line].element;
        const double *q = state->q + fu_element_entry(cable, element), *v = state->v + fu_element_entry(cable, element);
        const double s = points->s[line];
        if (s < 0.0 || s > fu_cable_length(cable)) continue; /* straight beyond the ends */
        cable->kernel->slopes(fu_element_length(cable, element), s - fu_cable_start(cable, element), every);
        memcpy(out->N_xx[line], every + n, sizeof(double) * (size_t)n);
        for (int i = 0; i < n; ++i)
            for (int d = 0; d < dim; ++d) {
                const int is_position = i % cable->kernel->vectors == 0; /* from the first node, as in point_of_cable */
                out->third[line * dim + d] += every[2 * n + i] * (q[i * dim + d] - (is_position ? q[d] : 0.0));
                out->rate[line * dim + d] += every[n + i] * (v[i * dim + d] - (is_position ? v[d] : 0.0));
            }
    }
}

/* Computes a line's point at an instant; a bar's is not on its carrier within a step. */
static void point_at(const fu_model *model, const fu_crossing *crossing, int line, const fu_moment *at, double s,
                     fu_line_point *out)
{
    fu_line_point_of(model, crossing, line, at->now, s, out);
    if (!at->next) return;
    const fu_line_point from = *out;
    fu_line_point to;
    double from_k[3], to_k[3], unused[3];
    fu_line_point_of(model, crossing, line, at->next, s, &to);
    bends_of_line(model, crossing, line, at->now, s, from_k);
    bends_of_line(model, crossing, line, at->next, s, to_k);
    fu_vector_within(3, from.r, from.v, to.r, to.v, at->h, at->x, out->r, out->v);
    fu_vector_within(3, from.t, from.w, to.t, to.w, at->h, at->x, out->t, out->w);
    fu_vector_within(3, from.k, from_k, to.k, to_k, at->h, at->x, out->k, unused);
}

/* Computes both points at out->s in the form of the kernels. */
static void put_together(const fu_model *model, const fu_crossing *crossing, const fu_moment *moment,
                         fu_closest_points *out)
{
    const int dim = model->dim;
    for (int line = 0; line < FU_LINES; ++line) {
        fu_line_point *point = &out->line[line];
        point_at(model, crossing, line, moment, out->s[line], point);
        if (line >= dim - 1) continue;
        memcpy(out->t + line * dim, point->t, sizeof(double) * (size_t)dim);
        memcpy(out->k + line * dim, point->k, sizeof(double) * (size_t)dim);
        memcpy(out->w + line * dim, point->w, sizeof(double) * (size_t)dim);
    }
    for (int d = 0; d < dim; ++d) {
        out->d[d] = out->line[0].r[d] - out->line[1].r[d];
        out->u[d] = out->line[0].v[d] - out->line[1].v[d];
    }
}

double fu_line_size(const fu_model *model, const fu_crossing *crossing, int line)
{
    const int cable = crossing->cables[line];
    return cable >= 0 ? model->cables[cable].length : 0.5 * (crossing->high[line] - crossing->low[line]);
}

/* Solves for the closest points by Newton's method from out->s; returns whether it converged. `out` is there then. */
static int converge(const fu_model *model, const fu_crossing *crossing, const fu_moment *moment, fu_closest_points *out)
{
    const int lines = model->dim - 1;
    double step[FU_LINES] = {0.0, 0.0}, size[FU_LINES] = {1.0, 1.0};
    for (int line = 0; line < lines; ++line) size[line] = fu_line_size(model, crossing, line);
    for (int i = 0; i < MAX_ITERATIONS; ++i) {
        double part = 1.0, left = 0.0;
        put_together(model, crossing, moment, out);
        crossing->kernel->closest(out->d, out->t, out->k, step);
        for (int line = 0; line < lines; ++line) part = fmin(part, MAX_CORRECTION * size[line] / fabs(step[line]));
        for (int line = 0; line < lines; ++line) {
            if (!(fabs(step[line]) < INFINITY)) return 0;
            left = fmax(left, fabs(step[line]) / (size[line] + fabs(out->s[line])));
        }
        if (left <= ROUNDING_OF_LENGTH || (i == MAX_ITERATIONS - 1 && left <= LENGTH_TOLERANCE)) return 1;
        for (int line = 0; line < lines; ++line) out->s[line] += part * step[line];
    }
    return 0;
}

/* Returns the squared distance of a point from the second line, and the arc-length there; a cable's by its samples. */
static double distance_from_second(const fu_model *model, const fu_crossing *crossing, const fu_moment *moment,
                                   const double *r, double *s)
{
    const int dim = model->dim, cable = crossing->cables[1],
              n = cable >= 0 ? SAMPLES_PER_ELEMENT * model->cables[cable].n_elements : 0;
    double least = INFINITY;
    fu_line_point point;
    for (int i = 0; i <= n; ++i) {
        double square = 0.0, along = 0.0, slope = 0.0,
               at = cable >= 0 ? i * fu_cable_length(&model->cables[cable]) / n : 0.0;
        point_at(model, crossing, 1, moment, at, &point);
        for (int d = 0; d < dim; ++d) {
            square += (r[d] - point.r[d]) * (r[d] - point.r[d]);
            along += (r[d] - point.r[d]) * point.t[d];
            slope += point.t[d] * point.t[d];
        }
        if (cable < 0 && dim == 3) {
            at = fmin(fmax(along / slope, crossing->low[1]), crossing->high[1]);
            square += at * (at * slope - 2.0 * along);
        }
        if (square >= least) continue;
        least = square;
        *s = at;
    }
    return least;
}

/* Starts a new search at the closest samples of both lines. Returns their distance, m. */
static double search(const fu_model *model, const fu_crossing *crossing, const fu_moment *moment, double s[FU_LINES])
{
    const fu_cable *cable = &model->cables[crossing->cables[0]];
    const int n = SAMPLES_PER_ELEMENT * cable->n_elements;
    double least = INFINITY, other = 0.0;
    fu_line_point point;
    for (int i = 0; i <= n; ++i) {
        const double at = i * fu_cable_length(cable) / n;
        point_at(model, crossing, 0, moment, at, &point);
        const double square = distance_from_second(model, crossing, moment, point.r, &other);
        if (square >= least) continue;
        least = square;
        s[0] = at;
        s[1] = other;
    }
    return sqrt(least);
}

void fu_find_closest_within(const fu_model *model, const fu_crossing *crossing, const fu_moment *moment,
                            const double s[FU_LINES], fu_closest_points *out)
{
    memcpy(out->s, s, sizeof out->s);
    out->found = converge(model, crossing, moment, out);
    if (out->found) return;
    const double apart = search(model, crossing, moment, out->s),
                 reach = fu_line_size(model, crossing, 0) / SAMPLES_PER_ELEMENT;
    out->found = converge(model, crossing, moment, out);
    out->apart = fmax(apart - reach - crossing->law[0], 0.0);
}

void fu_find_closest(const fu_model *model, const fu_crossing *crossing, const fu_state *state, fu_closest_points *out)
{
    const fu_moment moment = {.now = state};
    fu_find_closest_within(model, crossing, &moment, state->numbers + crossing->base.numbers + FU_CROSSING_S, out);
}

void fu_find_closest_anew(const fu_model *model, const fu_crossing *crossing, const fu_state *state,
                          fu_closest_points *out)
{
    const double *saved = state->numbers + crossing->base.numbers + FU_CROSSING_S;
    const fu_moment moment = {.now = state};
    fu_closest_points other;
    int moved = 0;
    fu_find_closest(model, crossing, state, out);
    for (int line = 0; line < model->dim - 1; ++line)
        moved |= fabs(out->s[line] - saved[line]) > fu_line_size(model, crossing, line);
    if (!moved) return;
    other = *out;
    search(model, crossing, &moment, other.s);
    other.found = converge(model, crossing, &moment, &other);
    if (other.found && fu_dot(model->dim, other.d, other.d) < fu_dot(model->dim, out->d, out->d)) *out = other;
}

void fu_line_moves_at(const fu_model *model, const fu_crossing *crossing, int line, const fu_state *state,
                      const fu_line_point *point, fu_line_moves *out)
{
    const int dim = model->dim;
    if (crossing->cables[line] >= 0) {
        const fu_cable *cable = &model->cables[crossing->cables[line]];
        const int n = out->n = cable->coordinates;
        memset(out->P, 0, sizeof(double) * (size_t)(dim * n));
        memset(out->T, 0, sizeof(double) * (size_t)(dim * n));
        for (int i = 0; i < n; ++i) {
            out->at[i] = fu_element_entry(cable, point->element) + i;
            out->P[i % dim * n + i] = point->N[i / dim];
            out->T[i % dim * n + i] = point->N_x[i / dim];
        }
        return;
    }
    fu_attachment_state at;
    fu_attachment_at(model, &point->on, state, 0.0, FU_POINT, &at);
    out->n = at.n;
    memcpy(out->at, at.at, sizeof(int) * (size_t)at.n);
    memcpy(out->P, at.P, sizeof(double) * (size_t)(dim * at.n));
    memset(out->T, 0, sizeof(double) * (size_t)(dim * at.n));
    if (dim == 2) return;
    fu_attachment on = point->on;
    for (int d = 0; d < 3; ++d) on.u[d] += crossing->axis[d];
    fu_attachment_at(model, &on, state, 0.0, FU_POINT, &at);
    for (int i = 0; i < dim * at.n; ++i) out->T[i] = at.P[i] - out->P[i];
}
