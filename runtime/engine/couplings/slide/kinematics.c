/* A slide's kernels over its coordinates, for any rider: the element's, the rider's, s.
 *
 * A rigid body has kernels of its own; any other rider is a point of a part, and the chain rule converts derivatives by
 * that point to those by its coordinates: dp = P dq, p'' = P q'' + bias. On a rope the kernels take the material
 * coordinates of an element's ends, which follow from those of the span's ends.
 */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/accelerator.h"
#include "couplings/slide/slide.h"

#include <string.h>

/* Arguments of the kernels of a slide at a state. */
typedef struct {
    double length, x;
    const double *e, *v, *b, *u, *w;
    double rates[FU_SPAN_LOCAL]; /* on a rope: v */
    fu_attachment_state rider;   /* if it is a point */
} slide_view;

static const double no_arm[3];

static void look_at_cable(const fu_model *model, const fu_state *state, int j, slide_view *view)
{
    const fu_cable *cable = &model->cables[model->slides[j].cable];
    const int at = fu_element_entry(cable, state->segment[j]);
    view->length = fu_element_length(cable, state->segment[j]);
    view->x = state->s[j] - fu_element_start(model, state, j, state->segment[j]);
    view->e = state->q + at;
    view->v = state->v + at;
}

static void look_at_rope(const fu_model *model, const fu_state *state, int j, slide_view *view)
{
    const fu_span_elements *on = &model->slides[j].on;
    const fu_span_element it = fu_span_element_at(model, on, state->segment[j], state->q, state->v, 0);
    const int n = on->kernel->coordinates;
    view->length = it.l;
    view->x = state->s[j] - it.s[0];
    view->e = it.e;
    view->v = view->rates;
    memcpy(view->rates, it.v, sizeof(double) * (size_t)n);
    memcpy(view->rates + n, it.s_rate, sizeof it.s_rate);
}

static void look(const fu_model *model, const fu_state *state, int j, slide_view *view)
{
    const fu_slide *slide = &model->slides[j];
    if (slide->cable < 0) look_at_rope(model, state, j, view);
    else look_at_cable(model, state, j, view);
    if (slide->rider_is_rigid) {
        const fu_body *body = &model->bodies[slide->rider.body];
        view->b = state->q + body->configuration;
        view->w = state->v + body->dof;
        view->u = slide->rider.u;
        return;
    }
    fu_attachment_at(model, &slide->rider, state, 0.0, FU_POINT, &view->rider);
    view->b = view->rider.p;
    view->w = view->rider.v;
    view->u = no_arm;
}

void fu_slide_to_ends_of_span(const fu_slide *slide, int element, double *derivatives, int n, int stride, int beside)
{
    if (!slide->on.kernel) return;
    double *first = derivatives + slide->on.kernel->coordinates * beside;
    fu_to_ends_of_span(&slide->on, element, first, first + beside, n, stride);
}

static void to_ends_of_span(const fu_model *model, const fu_state *state, int j, double *derivatives, int n, int stride,
                            int beside)
{
    fu_slide_to_ends_of_span(&model->slides[j], state->segment[j], derivatives, n, stride, beside);
}

/* Expands rows over (element, point, `more`) to rows over (element, rider, `more`). */
static void expand(const fu_slide *slide, const slide_view *view, int n_rows, int n_element, int more,
                   const double *given, double *rows)
{
    const int dim = slide->kernel->dim, n = view->rider.n;
    const int from = n_element + dim + more, to = n_element + n + more;
    for (int r = 0; r < n_rows; ++r) {
        const double *row = given + r * from;
        double *out = rows + r * to;
        memcpy(out, row, sizeof(double) * (size_t)n_element);
        for (int k = 0; k < n; ++k) {
            double sum = 0.0;
            for (int d = 0; d < dim; ++d) sum += row[n_element + d] * view->rider.P[d * n + k];
            out[n_element + k] = sum;
        }
        for (int k = 0; k < more; ++k) out[n_element + n + k] = row[n_element + dim + k];
    }
}

/* Computes the numbers for fu_add of a slide's coordinates, and of s after them; the force follows s. Returns the
 * number of coordinates before s. */
int fu_slide_coordinates(const fu_model *model, const fu_state *state, int j, int *at)
{
    const fu_slide *slide = &model->slides[j];
    const fu_span_elements *on = &slide->on;
    const fu_cable *cable = slide->cable < 0 ? 0 : &model->cables[slide->cable];
    const int n = fu_slide_element_coordinates(model, j), of_nodes = cable ? n : on->kernel->coordinates;
    const int segment = state->segment[j], first = cable ? fu_element_entry(cable, segment)
                                                         : on->first + segment * on->kernel->coordinates / FU_SPAN_ENDS;
    for (int i = 0; i < of_nodes; ++i) at[i] = first + i;
    for (int i = of_nodes; i < n; ++i) at[i] = on->s[i - of_nodes];
    const int all = n + fu_attachment_coordinates(model, &slide->rider, state, at + n);
    at[all] = fu_extra(model, slide->base.unknown);
    return all;
}

/* Computes phi and the gradient of f . phi over the slide's coordinates and s. */
void fu_slide_residual(const fu_model *model, const fu_state *state, int j, double *phi, double *g)
{
    const fu_slide *slide = &model->slides[j];
    double of_point[FU_MAX_COORDINATES];
    slide_view v;
    look(model, state, j, &v);
    slide->kernel->residual(v.length, v.x, v.e, v.b, v.u, state->forces + slide->base.force, phi,
                            slide->rider_is_rigid ? g : of_point);
    if (!slide->rider_is_rigid) expand(slide, &v, 1, fu_slide_element_coordinates(model, j), 1, of_point, g);
    to_ends_of_span(model, state, j, g, 1, 0, 1);
}

/* Computes the derivatives of both over the same, for a rider that is a point. */
static void tangent_of_point(const fu_model *model, const fu_state *state, int j, const slide_view *v, const double *f,
                             double *J, double *K)
{
    const fu_slide *slide = &model->slides[j];
    const int n_element = fu_slide_element_coordinates(model, j), dim = slide->kernel->dim, from = n_element + dim + 1;
    double of_point[FU_MAX_COORDINATES * FU_MAX_COORDINATES];
    double J_point[3 * FU_MAX_COORDINATES], pull[3], part[FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES];
    const int n_rider = v->rider.n, n = n_element + n_rider + 1;
    slide->kernel->tangent(v->length, v->x, v->e, v->b, v->u, f, J_point, of_point);
    expand(slide, v, dim, n_element, 1, J_point, J);
    /* the rider's point appears linearly in phi = r - p: second derivatives are those of the point itself */
    memset(K, 0, sizeof(double) * (size_t)(n * n));
    for (int i = 0; i <= n_element; ++i)
        for (int k = 0; k <= n_element; ++k) {
            const int a = i < n_element ? i : from - 1, b = k < n_element ? k : from - 1;
            K[(i < n_element ? i : n - 1) * n + (k < n_element ? k : n - 1)] = of_point[a * from + b];
        }
    for (int d = 0; d < dim; ++d) pull[d] = -f[d];
    fu_wrench_derivatives(model, &slide->rider, state, pull, 0, n_rider, part, 0, 0);
    for (int i = 0; i < n_rider; ++i)
        for (int k = 0; k < n_rider; ++k) K[(n_element + i) * n + n_element + k] = part[i * n_rider + k];
}

/* Computes the derivatives of both over the same, at a force f. */
void fu_slide_tangent(const fu_model *model, const fu_state *state, int j, const double *f, double *J, double *K)
{
    const fu_slide *slide = &model->slides[j];
    slide_view v;
    look(model, state, j, &v);
    if (slide->rider_is_rigid) slide->kernel->tangent(v.length, v.x, v.e, v.b, v.u, f, J, K);
    else tangent_of_point(model, state, j, &v, f, J, K);
    const int n =
        (slide->rider_is_rigid ? slide->kernel->coordinates : fu_slide_element_coordinates(model, j) + v.rider.n) + 1;
    to_ends_of_span(model, state, j, J, slide->kernel->dim, n, 1);
    to_ends_of_span(model, state, j, K, n, n, 1);
    to_ends_of_span(model, state, j, K, n, 1, n);
}

/* Adds the row that locks s to the rows across the cable: s of the slide less its signal or its place. */
static void add_lock(const fu_model *model, const fu_state *state, int j, const fu_slide_state *slide_state, int across,
                     fu_rows *rows)
{
    double rate, second;
    memcpy(rows->H + across * rows->n, slide_state->G, sizeof(double) * (size_t)rows->n);
    rows->C[across] = state->s[j] - fu_slide_locked_s(model, state, j, &rate, &second);
    rows->rate[across] = -rate;
    rows->W[across] = second - slide_state->s_bias;
}

/* Computes eq 20-37 over the slide's coordinates: H and W of the active constraints, and the coefficients of s. */
void fu_slide_terms(const fu_model *model, const fu_state *state, int j, fu_rows *rows, fu_slide_state *slide_state)
{
    const fu_slide *slide = &model->slides[j];
    const int n_element = fu_slide_element_coordinates(model, j), dim = slide->kernel->dim;
    double C_q[3 * FU_SLIDE_COORDINATES], C_s[3], Q_d[3], H[2 * FU_SLIDE_COORDINATES], G[FU_SLIDE_COORDINATES];
    slide_view v;
    const fu_slide_flags *flags = fu_slide_flags_of(model, state, j);
    if (flags->mode == FU_LEFT) { /* far from the cable, its values have no meaning */
        memset(slide_state, 0, sizeof *slide_state);
        rows->n = rows->rows = 0;
        return;
    }
    look(model, state, j, &v);
    const int n = fu_slide_coordinates(model, state, j, rows->at), across = dim - 1;
    slide->kernel->terms(v.length, v.x, v.e, v.b, v.u, v.v, v.w, fu_slide_numbers_of(model, state, j)->director,
                         slide_state->C, C_q, C_s, G, &slide_state->s_rate, Q_d, H, rows->W, &slide_state->s_bias);
    const int stride = slide->rider_is_rigid ? n : n_element + dim;
    for (int d = 0; d < dim; ++d) {
        for (int c = 0; c < across; ++c) slide_state->by_point[c * dim + d] = H[c * stride + n_element + d];
        slide_state->by_point[across * dim + d] = G[n_element + d];
    }
    if (slide->rider_is_rigid) {
        memcpy(rows->H, H, sizeof(double) * (size_t)(across * n));
        memcpy(slide_state->G, G, sizeof(double) * (size_t)n);
    } else {
        expand(slide, &v, across, n_element, 0, H, rows->H);
        expand(slide, &v, 1, n_element, 0, G, slide_state->G);
        for (int d = 0; d < dim; ++d) {
            for (int c = 0; c < across; ++c) rows->W[c] -= slide_state->by_point[c * dim + d] * v.rider.bias[d];
            slide_state->s_bias += slide_state->by_point[across * dim + d] * v.rider.bias[d];
        }
    }
    to_ends_of_span(model, state, j, rows->H, across, n, 1);
    to_ends_of_span(model, state, j, slide_state->G, 1, 0, 1);
    rows->n = n;
    rows->rows = flags->mode == FU_LOCKED ? dim : across;
    for (int c = 0; c < across; ++c) {
        rows->C[c] = slide_state->C[1 + c];
        rows->rate[c] = 0.0;
    }
    if (flags->mode == FU_LOCKED) add_lock(model, state, j, slide_state, across, rows);
}

/* Returns s of a locked slide, m, with its rate and its second rate. */
double fu_slide_locked_s(const fu_model *model, const fu_state *state, int j, double *rate, double *second)
{
    *rate = *second = 0.0;
    if (model->slides[j].drive < 0) return fu_slide_numbers_of(model, state, j)->locked_s;
    return fu_signal_at(&model->signals[model->slides[j].drive], state->t, rate, second);
}

/* Computes the derivatives of the constraints by s at this s, m, and the tangent frame there; returns the Newton step
 * for s. */
static double constraints_at(const fu_model *model, const fu_state *state, int j, double s, double C_s[3],
                             double A_t[9])
{
    const fu_slide *slide = &model->slides[j];
    double C[3], step;
    slide_view v;
    look(model, state, j, &v);
    slide->kernel->constraint(v.length, s - fu_element_start(model, state, j, state->segment[j]), v.e, v.b, v.u,
                              fu_slide_numbers_of(model, state, j)->director, C, C_s, &step, A_t);
    return step;
}

/* Returns the Newton step for s from this s, m, and computes the tangent frame there. */
double fu_slide_step(const fu_model *model, const fu_state *state, int j, double s, double A_t[9])
{
    double C_s[3];
    return constraints_at(model, state, j, s, C_s, A_t);
}

/* Computes the tangent frame at a slide, and returns the length of the centreline there relative to that without
 * stress. */
double fu_slide_frame(const fu_model *model, const fu_state *state, int j, double A_t[9])
{
    double C_s[3];
    constraints_at(model, state, j, state->s[j], C_s, A_t);
    return C_s[0];
}

void fu_slide_force(const fu_model *model, const fu_accelerator *work, int j, const double *lambda, double *f)
{
    const fu_slide_state *slide_state = fu_slide_state_of(model, work, j);
    const fu_rows *rows = &work->rows[model->slides[j].base.row];
    const int dim = model->dim;
    for (int d = 0; d < dim; ++d) {
        f[d] = 0.0;
        for (int c = 0; c < rows->rows; ++c) f[d] -= slide_state->by_point[c * dim + d] * lambda[rows->first + c];
        if (model->slides[j].resistance) f[d] += slide_state->by_point[(dim - 1) * dim + d] * slide_state->R;
    }
}
