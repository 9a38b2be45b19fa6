/* Attachments: a point and axes of the ground, of a cable, of a body; their motion with the coordinates of their
 * carrier, and the derivatives of a force and a moment on them. */
#include "bodies/model.h"
#include "bodies/rotation.h"
#include "bodies/unknowns.h"
#include "couplings/slide/slide.h"

#include <string.h>

#define LEAST_CORRECTED 1e-6 /* change of the vectors of a frame over a step: of less, turns are linear to rounding */

static const double unit_axes[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};

/* Computes C (n x m) = A (n x k) B (k x m). */
static void multiply(int n, int k, int m, const double *A, const double *B, double *C)
{
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) {
            double sum = 0.0;
            for (int l = 0; l < k; ++l) sum += A[i * k + l] * B[l * m + j];
            C[i * m + j] = sum;
        }
}

/* Computes the two vectors of the frame of a cable or a rope; `rows` then holds their derivatives by the element's
 * coordinates and, on a slide, by s. */
typedef struct {
    double value[2][3], rate[2][3], second[2][3], rows[6 * FU_ATTACHMENT_COORDINATES];
    double S[2]
            [3 * FU_MAX_COORDINATES]; /* shape functions of each: themselves, their first and second derivative by x */
} frame_vectors;

/* Computes the k-th vector of the frame, a sum over the vectors of an element with coordinates e and rates v. */
static void add_vector(const fu_cable *cable, const double *e, const double *v, double s_rate, int on_slide,
                       int n_columns, int k, frame_vectors *w)
{
    const int dim = cable->kernel->dim, n = cable->coordinates / dim;
    const double *S = w->S[k], *S_x = S + n, *S_xx = S + 2 * n;
    for (int d = 0; d < dim; ++d) {
        double value = 0.0, slope = 0.0, bend = 0.0, rate = 0.0, slope_rate = 0.0;
        for (int i = 0; i < n; ++i) {
            /* from the first node: slopes do not depend on its position, and no digits are lost far from the origin */
            const double at = e[i * dim + d] - (i % cable->kernel->vectors == 0 ? e[d] : 0.0);
            value += S[i] * at;
            slope += S_x[i] * at;
            bend += S_xx[i] * at;
            rate += S[i] * v[i * dim + d];
            slope_rate += S_x[i] * v[i * dim + d];
            w->rows[(k * dim + d) * n_columns + i * dim + d] = S[i];
        }
        w->value[k][d] = value;
        w->rate[k][d] = rate + slope * s_rate;
        w->second[k][d] = (2.0 * slope_rate + bend * s_rate) * s_rate;
        if (on_slide) w->rows[(k * dim + d) * n_columns + n * dim] = slope;
    }
}

enum { ROPE_NODE = 2, ROPE_ELEMENT = 2 * ROPE_NODE, SPAN_ENDS = 2 }; /* vectors of a node and of an element; s1, s2 */

/* A place on a rope at a configuration: its material coordinate, the first dof of its element, the shares of its nodes,
 * s1 and s2. */
typedef struct {
    int first;
    const double *share;
    double material, s[SPAN_ENDS], s_rate[SPAN_ENDS];
} rope_place;

static rope_place place_on_rope(int dim, const fu_attachment *on, const fu_state *state)
{
    rope_place at = {.material = on->slide >= 0 ? state->s[on->slide] : on->material};
    int element = on->slide >= 0 ? state->segment[on->slide] : 0;
    for (int i = 0; i < SPAN_ENDS; ++i) {
        at.s[i] = state->q[on->span_s[i]];
        at.s_rate[i] = state->v[on->span_s[i]];
    }
    const double beyond = at.material - at.s[0], length = at.s[1] - at.s[0];
    while (on->slide < 0 && element < on->span_elements - 1 && on->share[element + 1] * length < beyond) ++element;
    at.first = on->node + element * ROPE_NODE * dim;
    at.share = on->share + element;
    return at;
}

/* Computes the slope of a rope at a slide, the first vector of its frame. */
static void slope_of_rope(const fu_attachment *on, const rope_place *at, const fu_state *state, double s_rate,
                          frame_vectors *w)
{
    on->rope->slope(state->q + at->first, state->v + at->first, at->s, at->s_rate, at->share, at->material, s_rate,
                    w->value[0], w->rows, w->rate[0], w->second[0]);
}

static void vectors_of(const fu_model *model, const fu_attachment *on, const fu_state *state, double s_rate,
                       int n_columns, frame_vectors *w)
{
    const int on_slide = on->slide >= 0, dim = model->dim;
    memset(w->rows, 0, sizeof(double) * 2 * (size_t)(dim * n_columns));
    for (int k = 0; k < 2; ++k) {
        const double *fixed =
            on->slopes[k] == FU_CARRIED ? fu_slide_numbers_of(model, state, on->slide)->director : on->up;
        for (int d = 0; d < dim; ++d) {
            w->value[k][d] = fixed[d];
            w->rate[k][d] = w->second[k][d] = 0.0;
        }
    }
    if (on->rope) {
        const rope_place at = place_on_rope(dim, on, state);
        slope_of_rope(on, &at, state, s_rate, w);
        return;
    }
    const fu_cable *cable = &model->cables[on->cable];
    const int n = cable->coordinates / dim;
    const int element = on_slide ? state->segment[on->slide] : on->element;
    const double *e = state->q + fu_element_entry(cable, element);
    const double *v = state->v + fu_element_entry(cable, element);
    double every[9 * FU_MAX_COORDINATES];
    if (on_slide)
        cable->kernel->slopes(fu_element_length(cable, element),
                              state->s[on->slide] - fu_element_start(model, state, on->slide, element), every);
    for (int k = 0; k < 2; ++k) {
        if (on->slopes[k] < 0) {
            memset(w->S[k], 0, sizeof w->S[k]);
            continue;
        }
        if (on_slide) memcpy(w->S[k], every + 3 * n * on->slopes[k], sizeof(double) * 3 * (size_t)n);
        else {
            memcpy(w->S[k], on->S + k * n, sizeof(double) * (size_t)n);
            memset(w->S[k] + n, 0, sizeof(double) * 2 * (size_t)n);
        }
        add_vector(cable, e, v, s_rate, on_slide, n_columns, k, w);
    }
}

/* Returns the number of coordinates of an attachment, and their numbers for fu_add; on a slide the last of them is
 * s, on a rope s1 and s2 stand before it. */
int fu_attachment_coordinates(const fu_model *model, const fu_attachment *on, const fu_state *state, int *at)
{
    if (on->body >= 0) {
        const fu_body *body = &model->bodies[on->body];
        const int n = fu_body_dofs(body);
        for (int i = 0; i < n; ++i) at[i] = body->dof + i;
        return n;
    }
    if (on->rope) {
        const int n = ROPE_ELEMENT * model->dim, first = place_on_rope(model->dim, on, state).first;
        for (int i = 0; i < n; ++i) at[i] = first + i;
        for (int i = 0; i < SPAN_ENDS; ++i) at[n + i] = on->span_s[i];
        if (on->slide < 0) return n + SPAN_ENDS;
        at[n + SPAN_ENDS] = fu_extra(model, model->slides[on->slide].base.unknown);
        return n + SPAN_ENDS + 1;
    }
    if (on->node >= 0) {
        for (int d = 0; d < model->dim; ++d) at[d] = on->node + d;
        return model->dim;
    }
    if (on->cable < 0) return 0;
    const fu_cable *cable = &model->cables[on->cable];
    const int element = on->slide >= 0 ? state->segment[on->slide] : on->element, n = cable->coordinates;
    for (int i = 0; i < n; ++i) at[i] = fu_element_entry(cable, element) + i;
    if (on->slide < 0) return n;
    at[n] = fu_extra(model, model->slides[on->slide].base.unknown);
    return n + 1;
}

static void point_of(const fu_model *model, const fu_attachment *on, const fu_state *state, int rates,
                     fu_attachment_state *out)
{
    const int dim = model->dim, n = out->n;
    for (int d = 0; d < 3; ++d) out->v[d] = out->bias[d] = 0.0;
    memcpy(out->p, on->u, sizeof out->p);
    if (on->body >= 0) {
        const fu_body *body = &model->bodies[on->body];
        const double *b = state->q + body->configuration;
        if (rates) body->kernel->point(b, on->u, state->v + body->dof, out->p, out->P, out->v, out->bias);
        else body->kernel->place(b, on->u, out->p, out->P);
        return;
    }
    if (on->rope && on->slide < 0) {
        const rope_place at = place_on_rope(dim, on, state);
        on->rope->point(state->q + at.first, state->v + at.first, at.s, at.s_rate, at.share, at.material, out->p,
                        out->P, out->v, out->bias);
        return;
    }
    memset(out->P, 0, sizeof(double) * (size_t)(dim * n));
    for (int d = 0; on->node >= 0 && !on->rope && d < dim; ++d) {
        out->P[d * n + d] = 1.0;
        out->p[d] = state->q[on->node + d];
        out->v[d] = state->v[on->node + d];
    }
    if (on->cable >= 0 && on->slide < 0) {
        const fu_cable *cable = &model->cables[on->cable];
        const int first = fu_element_entry(cable, on->element);
        for (int d = 0; d < dim; ++d)
            for (int k = 0; k < n / dim; ++k) out->P[d * n + k * dim + d] = on->N[k];
        fu_interpolate(dim, n, on->N, state->q + first, out->p);
        fu_interpolate(dim, n, on->N, state->v + first, out->v);
    }
}

static void axes_of(const fu_model *model, const fu_attachment *on, const fu_state *state, double s_rate,
                    fu_attachment_state *out)
{
    const int dim = model->dim, n = out->n, turns = dim == 3 ? 3 : 1;
    double A[9];
    memcpy(A, unit_axes, sizeof A);
    for (int d = 0; d < 3; ++d) out->omega[d] = out->alpha[d] = 0.0;
    memset(out->T, 0, sizeof(double) * (size_t)(turns * n));
    if (on->body >= 0) {
        const fu_body *body = &model->bodies[on->body];
        body->kernel->frame(state->q + body->configuration, A, out->T);
        multiply(turns, n, 1, out->T, state->v + body->dof, out->omega); /* at omega' = 0 the axes' own bias is zero */
    } else if (on->frame) {
        frame_vectors w;
        double T[18];
        vectors_of(model, on, state, s_rate, n, &w);
        on->frame->axes(w.value[0], w.value[1], A, T);
        on->frame->motion(w.value[0], w.value[1], w.rate[0], w.rate[1], w.second[0], w.second[1], out->omega,
                          out->alpha);
        multiply(turns, 2 * dim, n, T, w.rows, out->T);
    } else if (dim == 2) {
        A[1] = A[2] = 0.0;
        A[3] = 1.0;
    }
    multiply(dim, dim, dim, A, on->axes, out->A);
}

/* Computes the state of a node of a modal body: of its point and its axes together. */
static void of_modes(const fu_model *model, const fu_attachment *on, const fu_state *state, fu_attachment_state *out)
{
    const fu_body *body = &model->bodies[on->body];
    const int dim = model->dim;
    fu_modal_point at;
    fu_modal_attachment_state(body, &on->modal, state->q + body->configuration, state->v + body->dof, &at, out->P,
                              out->T);
    memset(out->p, 0, sizeof out->p);
    memset(out->v, 0, sizeof out->v);
    memset(out->bias, 0, sizeof out->bias);
    memcpy(out->p, at.p, sizeof(double) * (size_t)dim);
    memcpy(out->v, at.velocity, sizeof(double) * (size_t)dim);
    memcpy(out->bias, at.bias, sizeof(double) * (size_t)dim);
    memcpy(out->omega, at.omega, sizeof out->omega);
    memcpy(out->alpha, at.omega_bias, sizeof out->alpha);
    multiply(dim, dim, dim, at.axes, on->axes, out->A);
}

/* Computes the state of an attachment: of its point, its axes, or both; s_rate: of its slide, if velocities count. */
void fu_attachment_at(const fu_model *model, const fu_attachment *on, const fu_state *state, double s_rate, int what,
                      fu_attachment_state *out)
{
    out->n = fu_attachment_coordinates(model, on, state, out->at);
    if (on->body >= 0 && model->bodies[on->body].modes) {
        of_modes(model, on, state, out);
        return;
    }
    if (what & FU_PLACE) point_of(model, on, state, what & FU_RATES, out);
    if (what & FU_AXES) axes_of(model, on, state, s_rate, out);
}

void fu_discrete_point(const fu_model *model, const fu_attachment *on, const fu_state *now, const fu_state *next,
                       double *P)
{
    if (on->body < 0) return;
    const fu_body *body = &model->bodies[on->body];
    body->kernel->discrete_point(now->q + body->configuration, on->u, next->q + body->configuration, P);
}

/* Computes the Cayley vector of the rotation between two frames. */
static void cayley_vector(int dim, const double *from, const double *to, double theta[3])
{
    double R[9] = {0.0}, trace = 1.0;
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) R[i * 3 + j] = fu_dot(dim, to + i * dim, from + j * dim);
    for (int d = 0; d < dim; ++d) trace += R[4 * d];
    theta[0] = theta[1] = theta[2] = 0.0;
    if (dim == 2) theta[0] = 4.0 * R[3] / (trace + 1.0); /* trace: 1 + 2 cos */
    else
        for (int d = 0; d < 3; ++d) {
            const int i = (d + 1) % 3, j = (d + 2) % 3;
            theta[d] = 2.0 * (R[j * 3 + i] - R[i * 3 + j]) / trace;
        }
}

/* Turns of the frame of a cable change with its vectors w; dw: their change over the step. The derivatives T half-way
 * have the rest of the turn added along dw: a discrete gradient (Gonzalez 1996). */
static void correct_turn(const fu_model *model, const fu_attachment *on, const fu_state *now, const fu_state *next,
                         const double *psi, const double *theta, fu_attachment_state *middle)
{
    const int dim = model->dim, n = middle->n, turns = fu_turns(dim);
    double change[2 * 3], along[FU_ATTACHMENT_COORDINATES] = {0.0}, size = 0.0;
    frame_vectors from, to;
    vectors_of(model, on, now, 0.0, n, &from);
    vectors_of(model, on, next, 0.0, n, &to);
    for (int k = 0; k < 2; ++k)
        for (int d = 0; d < dim; ++d) {
            change[k * dim + d] = to.value[k][d] - from.value[k][d];
            size += change[k * dim + d] * change[k * dim + d];
        }
    if (size < LEAST_CORRECTED * LEAST_CORRECTED) return;
    for (int r = 0; r < 2 * dim; ++r)
        for (int i = 0; i < n; ++i) along[i] += change[r] * from.rows[r * n + i] / size;
    for (int d = 0; d < turns; ++d) {
        double rest = theta[d];
        for (int i = 0; i < n; ++i) rest -= middle->T[d * n + i] * psi[middle->at[i]];
        for (int i = 0; i < n; ++i) middle->T[d * n + i] += rest * along[i];
    }
}

void fu_discrete_turn(const fu_model *model, const fu_attachment *on, const fu_state *now, const fu_state *next,
                      const double *psi, const fu_attachment_state *from, const fu_attachment_state *to,
                      fu_attachment_state *middle, double theta[3])
{
    const int dim = model->dim, n = from->n, turns = fu_turns(dim);
    theta[0] = theta[1] = theta[2] = 0.0;
    if (on->body < 0) {
        if (!on->frame) return;
        cayley_vector(dim, from->A, to->A, theta);
        correct_turn(model, on, now, next, psi, theta, middle);
        return;
    }
    for (int d = 0; d < turns; ++d)
        for (int i = 0; i < n; ++i) theta[d] += from->T[d * n + i] * psi[from->at[i]];
    for (int i = 0; i < n; ++i) {
        double column[3] = {0.0}, turned[3] = {0.0};
        for (int d = 0; d < turns; ++d) column[d] = from->T[d * n + i];
        if (dim == 3) fu_cross(theta, column, turned);
        for (int d = 0; d < turns; ++d) middle->T[d * n + i] = column[d] + 0.5 * turned[d];
    }
}

/* fu_wrench_derivatives for an attachment to a body. */
static void derivatives_on_body(const fu_model *model, const fu_attachment *on, const fu_state *state, const double *f,
                                const double *m, double *K, double *v_q, double *omega_q)
{
    const fu_body *body = &model->bodies[on->body];
    const double *b = state->q + body->configuration, *w = state->v + body->dof, none[3] = {0.0};
    double unused[2][3 * FU_ATTACHMENT_COORDINATES];
    if (!f) f = none;
    if (!m) m = none;
    if (!v_q) v_q = unused[0];
    if (!omega_q) omega_q = unused[1];
    if (body->modes) fu_modal_attachment_wrench(body, &on->modal, b, w, f, m, K, v_q, omega_q);
    else body->kernel->wrench(b, on->u, w, f, m, K, v_q, omega_q);
}

/* fu_wrench_derivatives for a material point of a rope, on which no moment acts. */
static void derivatives_on_rope(const fu_model *model, const fu_attachment *on, const fu_state *state, const double *f,
                                double *K, double *v_q)
{
    const rope_place at = place_on_rope(model->dim, on, state);
    const double none[3] = {0.0};
    double unused[3 * FU_ATTACHMENT_COORDINATES];
    on->rope->wrench(state->q + at.first, state->v + at.first, at.s, at.s_rate, at.share, at.material, f ? f : none, K,
                     v_q ? v_q : unused);
}

/* Adds the terms with s of the frame at a slide; g: derivatives of the moment's work by the frame's two vectors. */
static void add_stiffness_of_s(const fu_model *model, const fu_attachment *on, const fu_state *state,
                               const frame_vectors *w, const double *g, int n, double *K)
{
    const fu_cable *cable = &model->cables[on->cable];
    const int dim = model->dim, vectors = cable->coordinates / dim, s = n - 1;
    const double *e = state->q + fu_element_entry(cable, state->segment[on->slide]);
    for (int k = 0; k < 2; ++k)
        for (int d = 0; d < dim; ++d) {
            const double pull = g[k * dim + d], *S_x = w->S[k] + vectors, *S_xx = w->S[k] + 2 * vectors;
            for (int i = 0; i < vectors; ++i) {
                K[(i * dim + d) * n + s] += pull * S_x[i];
                K[s * n + i * dim + d] += pull * S_x[i];
                K[s * n + s] += pull * S_xx[i] * (e[i * dim + d] - (i % cable->kernel->vectors == 0 ? e[d] : 0.0));
            }
        }
}

/* Adds the second derivatives of the slope of a rope. */
static void add_stiffness_of_slope(int dim, const fu_attachment *on, const fu_state *state, const double *g, int n,
                                   double *K)
{
    const rope_place at = place_on_rope(dim, on, state);
    double part[FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES];
    on->rope->slope_stiffness(state->q + at.first, state->v + at.first, at.s, at.s_rate, at.share, at.material, 0.0, g,
                              part);
    for (int i = 0; i < n * n; ++i) K[i] += part[i];
}

void fu_wrench_derivatives(const fu_model *model, const fu_attachment *on, const fu_state *state, const double *f,
                           const double *m, int n, double *K, double *v_q, double *omega_q)
{
    const int dim = model->dim;
    frame_vectors w;
    double g[6], of_frame[36], half[6 * FU_ATTACHMENT_COORDINATES];
    if (on->body >= 0) {
        derivatives_on_body(model, on, state, f, m, K, v_q, omega_q);
        return;
    }
    if (on->rope && on->slide < 0) {
        derivatives_on_rope(model, on, state, f, K, v_q);
        return;
    }
    memset(K, 0, sizeof(double) * (size_t)(n * n));
    if (!m || !on->frame) return;
    vectors_of(model, on, state, 0.0, n, &w);
    on->frame->moment(w.value[0], w.value[1], m, g, of_frame);
    multiply(2 * dim, 2 * dim, n, of_frame, w.rows, half);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            double sum = 0.0;
            for (int l = 0; l < 2 * dim; ++l) sum += w.rows[l * n + i] * half[l * n + j];
            K[i * n + j] += sum;
        }
    if (on->rope) add_stiffness_of_slope(dim, on, state, g, n, K);
    else if (on->slide >= 0) add_stiffness_of_s(model, on, state, &w, g, n, K);
}

void fu_turn_attachment(const fu_model *model, const fu_attachment *on, const double *psi, double *rows, int n_rows,
                        int n_columns, int first)
{
    if (!psi || on->body < 0) return;
    const fu_body *body = &model->bodies[on->body];
    fu_turn_columns(body->kernel, rows, n_rows, n_columns, first, psi + body->dof);
}
