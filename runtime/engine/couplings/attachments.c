/* Ends of springs and joints: a point and axes of the ground, of a cable, of a body; how they move with the coordinates
 * of what carries them, and what a force and a moment on them change with these.
 */
#include "engine.h"

#include <string.h>

static const double unit_axes[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};

/* C (n x m) = A (n x k) B (k x m) */
static void multiply(int n, int k, int m, const double *A, const double *B, double *C)
{
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) {
            double sum = 0.0;
            for (int l = 0; l < k; ++l) sum += A[i * k + l] * B[l * m + j];
            C[i * m + j] = sum;
        }
}

/* The two vectors of a cable's frame: `rows` holds their derivatives by the element's coordinates and, on a slide, by s. */
typedef struct {
    double value[2][3], rate[2][3], second[2][3], rows[6 * FU_ATTACHMENT_COORDINATES];
    double S[2][3 * FU_MAX_COORDINATES]; /* shape functions of each: themselves, their first and second derivative by x */
} frame_vectors;

static void vectors_of(const fu_model *model, const fu_attachment *end, const fu_state *state, double s_rate, int n_own,
                       frame_vectors *w)
{
    const int on_slide = end->slide >= 0;
    const fu_cable *cable = &model->cables[end->cable];
    const int dim = cable->kernel->dim, n = cable->coordinates / dim;
    const int element = on_slide ? state->element[end->slide] : end->element;
    const double *e = state->q + cable->first + element * cable->per_node;
    const double *v = state->v + cable->first + element * cable->per_node;
    double every[9 * FU_MAX_COORDINATES];
    memset(w->rows, 0, sizeof(double) * 2 * (size_t)(dim * n_own));
    if (on_slide)
        cable->kernel->slopes(cable->length, state->s[end->slide] - fu_element_start(model, end->slide, element), every);
    for (int k = 0; k < 2; ++k) {
        const double *held = end->slopes[k] == FU_CARRIED ? state->director + 3 * end->slide : end->up;
        for (int d = 0; d < dim; ++d) {
            w->value[k][d] = held[d];
            w->rate[k][d] = w->second[k][d] = 0.0;
        }
        if (end->slopes[k] < 0) {
            memset(w->S[k], 0, sizeof w->S[k]);
            continue;
        }
        if (on_slide) memcpy(w->S[k], every + 3 * n * end->slopes[k], sizeof(double) * 3 * (size_t)n);
        else {
            memcpy(w->S[k], end->S + k * n, sizeof(double) * (size_t)n);
            memset(w->S[k] + n, 0, sizeof(double) * 2 * (size_t)n);
        }
        const double *S = w->S[k], *S_x = S + n, *S_xx = S + 2 * n;
        for (int d = 0; d < dim; ++d) {
            double value = 0.0, slope = 0.0, bend = 0.0, rate = 0.0, slope_rate = 0.0;
            for (int i = 0; i < n; ++i) {
                /* from the first node: slopes do not see where that is, and no digits are lost far from the origin */
                const double at = e[i * dim + d] - (i % cable->kernel->vectors == 0 ? e[d] : 0.0);
                value += S[i] * at;
                slope += S_x[i] * at;
                bend += S_xx[i] * at;
                rate += S[i] * v[i * dim + d];
                slope_rate += S_x[i] * v[i * dim + d];
                w->rows[(k * dim + d) * n_own + i * dim + d] = S[i];
            }
            w->value[k][d] = value;
            w->rate[k][d] = rate + slope * s_rate;
            w->second[k][d] = (2.0 * slope_rate + bend * s_rate) * s_rate;
            if (on_slide) w->rows[(k * dim + d) * n_own + n * dim] = slope;
        }
    }
}

/* number of the end's own coordinates, and their numbers for fu_add; on a slide the last is s */
int fu_attachment_coordinates(const fu_model *model, const fu_attachment *end, const fu_state *state, int *at)
{
    if (end->body >= 0) {
        const fu_body *body = &model->bodies[end->body];
        const int n = fu_body_dofs(body);
        for (int i = 0; i < n; ++i) at[i] = body->dof + i;
        return n;
    }
    if (end->cable < 0) return 0;
    const fu_cable *cable = &model->cables[end->cable];
    const int element = end->slide >= 0 ? state->element[end->slide] : end->element, n = cable->coordinates;
    for (int i = 0; i < n; ++i) at[i] = cable->first + element * cable->per_node + i;
    if (end->slide < 0) return n;
    at[n] = fu_extra(model, model->slides[end->slide].unknown);
    return n + 1;
}

static void point_of(const fu_model *model, const fu_attachment *end, const fu_state *state, fu_attachment_state *place)
{
    const int dim = model->dim, n = place->n;
    for (int d = 0; d < 3; ++d) place->v[d] = place->bias[d] = 0.0;
    memcpy(place->p, end->u, sizeof place->p);
    memset(place->P, 0, sizeof(double) * (size_t)(dim * n));
    if (end->body >= 0) {
        const fu_body *body = &model->bodies[end->body];
        body->kernel->point(state->q + body->configuration, end->u, state->v + body->dof, place->p, place->P, place->v,
                            place->bias);
    } else if (end->cable >= 0 && end->slide < 0) {
        const fu_cable *cable = &model->cables[end->cable];
        const int first = cable->first + end->element * cable->per_node;
        for (int d = 0; d < dim; ++d) {
            place->p[d] = 0.0;
            for (int k = 0; k < n / dim; ++k) {
                place->P[d * n + k * dim + d] = end->N[k];
                place->p[d] += end->N[k] * state->q[first + k * dim + d];
                place->v[d] += end->N[k] * state->v[first + k * dim + d];
            }
        }
    }
}

static void axes_of(const fu_model *model, const fu_attachment *end, const fu_state *state, double s_rate, fu_attachment_state *place)
{
    const int dim = model->dim, n = place->n, turns = dim == 3 ? 3 : 1;
    double A[9];
    memcpy(A, unit_axes, sizeof A);
    for (int d = 0; d < 3; ++d) place->omega[d] = place->alpha[d] = 0.0;
    memset(place->T, 0, sizeof(double) * (size_t)(turns * n));
    if (end->body >= 0) {
        const fu_body *body = &model->bodies[end->body];
        double unused[36];
        body->kernel->frame(state->q + body->configuration, model->zero, A, place->T, unused);
        multiply(turns, n, 1, place->T, state->v + body->dof, place->omega); /* at omega' = 0 the axes' own bias is nil */
    } else if (end->frame) {
        frame_vectors w;
        double T[18];
        vectors_of(model, end, state, s_rate, n, &w);
        end->frame->axes(w.value[0], w.value[1], A, T);
        end->frame->motion(w.value[0], w.value[1], w.rate[0], w.rate[1], w.second[0], w.second[1], place->omega,
                           place->alpha);
        multiply(turns, 2 * dim, n, T, w.rows, place->T);
    } else if (dim == 2) {
        A[1] = A[2] = 0.0;
        A[3] = 1.0;
    }
    multiply(dim, dim, dim, A, end->axes, place->A);
}

/* The node of a modal body: all at once. */
static void of_modes(const fu_model *model, const fu_attachment *end, const fu_state *state, fu_attachment_state *place)
{
    const fu_body *body = &model->bodies[end->body];
    const int dim = model->dim;
    fu_modal_point at;
    fu_modal_attachment_state(body, &end->spot, state->q + body->configuration, state->v + body->dof, &at, place->P, place->T);
    memset(place->p, 0, sizeof place->p);
    memset(place->v, 0, sizeof place->v);
    memset(place->bias, 0, sizeof place->bias);
    memcpy(place->p, at.p, sizeof(double) * (size_t)dim);
    memcpy(place->v, at.velocity, sizeof(double) * (size_t)dim);
    memcpy(place->bias, at.bias, sizeof(double) * (size_t)dim);
    memcpy(place->omega, at.omega, sizeof place->omega);
    memcpy(place->alpha, at.omega_bias, sizeof place->alpha);
    multiply(dim, dim, dim, at.axes, end->axes, place->A);
}

/* Where an end stands and how it moves: its point, its axes, or both; s_rate: of its slide, where velocities count. */
void fu_attachment_at(const fu_model *model, const fu_attachment *end, const fu_state *state, double s_rate, int what,
                  fu_attachment_state *place)
{
    place->n = fu_attachment_coordinates(model, end, state, place->at);
    if (end->body >= 0 && model->bodies[end->body].modes) {
        of_modes(model, end, state, place);
        return;
    }
    if (what & FU_POINT) point_of(model, end, state, place);
    if (what & FU_AXES) axes_of(model, end, state, s_rate, place);
}

/* K (n x n) += derivative by the end's coordinates of P' f + T' m at a fixed force f and moment m; either may be null */
void fu_geometric_stiffness(const fu_model *model, const fu_attachment *end, const fu_state *state, const double *f, const double *m,
                      int n, double *K)
{
    const int dim = model->dim;
    if (end->body >= 0) {
        const fu_body *body = &model->bodies[end->body];
        const double *b = state->q + body->configuration;
        double p[3], A[9], P[18], part[FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES];
        if (body->modes) {
            const double none[3] = {0.0};
            fu_modal_attachment_force(body, &end->spot, b, f ? f : none, m ? m : none, part);
            for (int i = 0; i < n * n; ++i) K[i] += part[i];
            return;
        }
        if (f) {
            body->kernel->point_force(b, end->u, f, p, P, part);
            for (int i = 0; i < n * n; ++i) K[i] += part[i];
        }
        if (m) {
            body->kernel->frame(b, m, A, P, part);
            for (int i = 0; i < n * n; ++i) K[i] += part[i];
        }
        return;
    }
    if (!m || !end->frame) return;
    frame_vectors w;
    double g[6], of_frame[36], half[6 * FU_ATTACHMENT_COORDINATES];
    vectors_of(model, end, state, 0.0, n, &w);
    end->frame->moment(w.value[0], w.value[1], m, g, of_frame);
    multiply(2 * dim, 2 * dim, n, of_frame, w.rows, half);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            double sum = 0.0;
            for (int l = 0; l < 2 * dim; ++l) sum += w.rows[l * n + i] * half[l * n + j];
            K[i * n + j] += sum;
        }
    if (end->slide < 0) return;
    const fu_cable *cable = &model->cables[end->cable];
    const int element = state->element[end->slide], vectors = cable->coordinates / dim, s = n - 1;
    const double *e = state->q + cable->first + element * cable->per_node;
    for (int k = 0; k < 2; ++k)
        for (int d = 0; d < dim; ++d) {
            const double pull = g[k * dim + d], *S_x = w.S[k] + vectors, *S_xx = w.S[k] + 2 * vectors;
            for (int i = 0; i < vectors; ++i) {
                K[(i * dim + d) * n + s] += pull * S_x[i];
                K[s * n + i * dim + d] += pull * S_x[i];
                K[s * n + s] += pull * S_xx[i] * (e[i * dim + d] - (i % cable->kernel->vectors == 0 ? e[d] : 0.0));
            }
        }
}
