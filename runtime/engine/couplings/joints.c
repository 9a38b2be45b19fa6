/* Joints between two ends: equations phi of the gap between their points and of their axes (derive/couplings/joint.py), made
 * equations over the coordinates of what carries the ends. Of an end on a slide s is one of them.
 */
#include "engine.h"

#include <string.h>

enum { MOVES = 9 }; /* gap, turn of the first end, turn of the second: as many in space, fewer in the plane */

/* A joint where its state stands. */
typedef struct {
    fu_attachment_state place[2];
    double gap[3], c[3], rate, second;
    double B[MOVES * 2 * FU_ATTACHMENT_COORDINATES]; /* derivatives of gap and turns by the coordinates of both ends */
    int moves, n;
} link_view;

static void look(const fu_model *model, const fu_joint *joint, const fu_state *state, const double s_rate[2],
                 link_view *view)
{
    const int dim = model->dim, turns = dim == 3 ? 3 : 1;
    for (int e = 0; e < 2; ++e)
        fu_attachment_at(model, &joint->ends[e], state, s_rate ? s_rate[e] : 0.0, FU_POINT | FU_AXES, &view->place[e]);
    const fu_attachment_state *one = &view->place[0], *two = &view->place[1];
    const int n1 = one->n, n2 = two->n, n = n1 + n2;
    view->n = n;
    view->moves = dim + 2 * turns;
    for (int d = 0; d < 3; ++d) view->gap[d] = two->p[d] - one->p[d];
    view->rate = view->second = 0.0;
    view->c[0] = joint->base;
    if (joint->signal >= 0)
        view->c[0] += fu_signal_at(&model->signals[joint->signal], state->t, &view->rate, &view->second);
    view->c[1] = cos(view->c[0]);
    view->c[2] = sin(view->c[0]);
    memset(view->B, 0, sizeof(double) * (size_t)(view->moves * n));
    for (int d = 0; d < dim; ++d) {
        for (int i = 0; i < n1; ++i) view->B[d * n + i] = -one->P[d * n1 + i];
        for (int i = 0; i < n2; ++i) view->B[d * n + n1 + i] = two->P[d * n2 + i];
    }
    for (int d = 0; d < turns; ++d) {
        memcpy(view->B + (dim + d) * n, one->T + d * n1, sizeof(double) * (size_t)n1);
        memcpy(view->B + (dim + turns + d) * n + n1, two->T + d * n2, sizeof(double) * (size_t)n2);
    }
}

/* J (rows x n) over coordinates from that over gap and turns */
static void over_coordinates(const link_view *view, int rows, const double *by_moves, double *J)
{
    const int n = view->n;
    memset(J, 0, sizeof(double) * (size_t)(rows * n));
    for (int r = 0; r < rows; ++r)
        for (int m = 0; m < view->moves; ++m) {
            const double value = by_moves[r * view->moves + m];
            if (value == 0.0) continue;
            for (int i = 0; i < n; ++i) J[r * n + i] += value * view->B[m * n + i];
        }
}

static int coordinates(const link_view *view, int *at)
{
    memcpy(at, view->place[0].at, sizeof(int) * (size_t)view->place[0].n);
    memcpy(at + view->place[0].n, view->place[1].at, sizeof(int) * (size_t)view->place[1].n);
    return view->n;
}

/* whether the slide that it stands beside has left its cable */
int fu_joint_is_inactive(const fu_joint *joint, const fu_state *state)
{
    for (int e = 0; e < 2; ++e)
        if (joint->ends[e].slide >= 0 && state->mode[joint->ends[e].slide] == FU_LEFT) return 1;
    return 0;
}

/* phi, its derivatives J over the joint's coordinates, and their numbers for fu_add; returns how many they are */
int fu_joint_residual(const fu_model *model, const fu_joint *joint, const fu_state *state, double *phi, int *at, double *J)
{
    double by_moves[6 * MOVES], K[MOVES * MOVES];
    const double *multipliers = state->multipliers + 6 * (joint - model->joints);
    link_view view;
    look(model, joint, state, 0, &view);
    joint->kernel->force(view.gap, view.place[0].A, view.place[1].A, view.c, multipliers, phi, by_moves, K);
    over_coordinates(&view, joint->kernel->rows, by_moves, J);
    return coordinates(&view, at);
}

/* whether a slide, or any where `joint` is -1, ties its rider's axes to the cable: their turn jumps where its curvature does */
int fu_ties_a_frame(const fu_model *model, int which)
{
    for (int k = 0; k < model->n_joints; ++k)
        for (int e = 0; e < 2; ++e) {
            const int slide = model->joints[k].ends[e].slide;
            if (slide >= 0 && (which < 0 || slide == which)) return 1;
        }
    return 0;
}

int fu_between_cables(const fu_joint *joint)
{
    return joint->ends[0].cable >= 0 && joint->ends[1].cable >= 0;
}

/* the same with K, the derivative of J' multipliers */
int fu_joint_tangent(const fu_model *model, const fu_joint *joint, const fu_state *state, int *at, double *J, double *K)
{
    const int rows = joint->kernel->rows, dim = model->dim, turns = dim == 3 ? 3 : 1;
    double phi[6], by_moves[6 * MOVES], of_moves[MOVES * MOVES], g[MOVES] = {0.0};
    double half[MOVES * 2 * FU_ATTACHMENT_COORDINATES];
    const double *multipliers = state->multipliers + 6 * (joint - model->joints);
    link_view view;
    look(model, joint, state, 0, &view);
    const int n = coordinates(&view, at), n1 = view.place[0].n;
    joint->kernel->force(view.gap, view.place[0].A, view.place[1].A, view.c, multipliers, phi, by_moves, of_moves);
    over_coordinates(&view, rows, by_moves, J);
    over_coordinates(&view, view.moves, of_moves, half);
    for (int r = 0; r < rows; ++r)
        for (int m = 0; m < view.moves; ++m) g[m] += by_moves[r * view.moves + m] * multipliers[r];
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            K[i * n + j] = 0.0;
            for (int m = 0; m < view.moves; ++m) K[i * n + j] += view.B[m * n + i] * half[m * n + j];
        }
    for (int e = 0; e < 2; ++e) {
        double pull[3], part[FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES];
        const int m = view.place[e].n, from = e ? n1 : 0;
        for (int d = 0; d < dim; ++d) pull[d] = e ? g[d] : -g[d];
        memset(part, 0, sizeof(double) * (size_t)(m * m));
        fu_geometric_stiffness(model, &joint->ends[e], state, pull, g + dim + e * turns, m, part);
        for (int i = 0; i < m; ++i)
            for (int j = 0; j < m; ++j) K[(from + i) * n + from + j] += part[i * m + j];
    }
    return n;
}

/* H q'' = W, what is left of phi, and its rate at rest; where an end is on a slide its s follows (eq 24, 31, 37):
 * H = C_q + C_s G, W = -Q_d - C_s (s'' - G q''). `slides` and `of_slides` are those of the slides. */
void fu_joint_terms(const fu_model *model, const fu_joint *joint, const fu_state *state, const fu_slide_state *slide_states,
                   const fu_rows *of_slides, fu_rows *rows)
{
    const int m = joint->kernel->rows, dim = model->dim;
    double by_moves[6 * MOVES], K[MOVES * MOVES], J[6 * 2 * FU_ATTACHMENT_COORDINATES], s_rate[2], gap_rate[3];
    link_view view;
    if (fu_joint_is_inactive(joint, state)) {
        rows->n = rows->rows = 0;
        rows->slide = -1;
        return;
    }
    for (int e = 0; e < 2; ++e) s_rate[e] = joint->ends[e].slide >= 0 ? slide_states[joint->ends[e].slide].s_rate : 0.0;
    look(model, joint, state, s_rate, &view);
    const fu_attachment_state *one = &view.place[0], *two = &view.place[1];
    joint->kernel->force(view.gap, one->A, two->A, view.c, state->multipliers + 6 * (joint - model->joints), rows->C,
                        by_moves, K);
    over_coordinates(&view, m, by_moves, J);
    for (int d = 0; d < 3; ++d) gap_rate[d] = two->v[d] - one->v[d];
    const double driving[2] = {view.rate, view.second};
    double Q_d[6];
    joint->kernel->motion(view.gap, one->A, two->A, view.c, gap_rate, one->omega, two->omega, driving, rows->rate, Q_d);
    double bias[MOVES];
    const int turns = dim == 3 ? 3 : 1;
    for (int d = 0; d < dim; ++d) bias[d] = two->bias[d] - one->bias[d];
    for (int d = 0; d < turns; ++d) {
        bias[dim + d] = one->alpha[d];
        bias[dim + turns + d] = two->alpha[d];
    }
    for (int r = 0; r < m; ++r) {
        rows->W[r] = -Q_d[r];
        for (int k = 0; k < view.moves; ++k) rows->W[r] -= by_moves[r * view.moves + k] * bias[k];
    }
    /* coordinates of the ends, s replaced by those of its slide */
    int every[2 * FU_ATTACHMENT_COORDINATES], column[2 * FU_ATTACHMENT_COORDINATES], n = 0;
    coordinates(&view, every);
    for (int i = 0; i < view.n; ++i)
        if (every[i] < model->n_dof) {
            column[n] = i;
            rows->at[n++] = every[i];
        }
    rows->n = n;
    rows->slide = -1;
    for (int e = 0; e < 2; ++e)
        if (joint->ends[e].slide >= 0) rows->n += of_slides[joint->ends[e].slide].n;
    for (int r = 0; r < m; ++r)
        for (int i = 0; i < n; ++i) rows->H[r * rows->n + i] = J[r * view.n + column[i]];
    for (int e = 0, to = n; e < 2; ++e) {
        const int slide = joint->ends[e].slide;
        if (slide < 0) continue;
        const fu_rows *of = &of_slides[slide];
        const int s = (e ? view.n : one->n) - 1;
        rows->slide = slide;
        memcpy(rows->at + to, of->at, sizeof(int) * (size_t)of->n);
        for (int r = 0; r < m; ++r) {
            const double by_s = J[r * view.n + s];
            rows->by_s[r] = joint->redundant_rows >> r & 1 ? 0.0 : by_s;
            for (int i = 0; i < of->n; ++i) rows->H[r * rows->n + to + i] = by_s * slide_states[slide].G[i];
            rows->W[r] -= by_s * slide_states[slide].s_bias;
        }
        to += of->n;
    }
    rows->redundant_rows = joint->redundant_rows;
    for (int r = 0; r < m; ++r)
        if (joint->redundant_rows >> r & 1) {
            memset(rows->H + r * rows->n, 0, sizeof(double) * (size_t)rows->n);
            rows->W[r] = rows->C[r] = rows->rate[r] = 0.0;
        }
}

/* what each joint puts on its second end, from the multipliers that fu_accelerations left */
void fu_joint_outputs(const fu_model *model, const fu_state *state, const fu_accelerator *work, fu_joint_output *out)
{
    const int dim = model->dim, turns = dim == 3 ? 3 : 1;
    for (int k = 0; k < model->n_joints; ++k) {
        const fu_joint *joint = &model->joints[k];
        double phi[6], by_moves[6 * MOVES], K[MOVES * MOVES];
        link_view view;
        if (fu_joint_is_inactive(joint, state)) {
            out[k] = (fu_joint_output){0};
            continue;
        }
        look(model, joint, state, 0, &view);
        joint->kernel->force(view.gap, view.place[0].A, view.place[1].A, view.c, work->multipliers + joint->multiplier, phi,
                            by_moves, K);
        out[k] = (fu_joint_output){0};
        for (int r = 0; r < joint->kernel->rows; ++r) {
            const double *J = by_moves + r * view.moves, multiplier = work->multipliers[joint->multiplier + r];
            out[k].residual = fmax(out[k].residual, fabs(phi[r]));
            for (int d = 0; d < dim; ++d) out[k].force[d] -= J[d] * multiplier;
            for (int d = 0; d < turns; ++d) out[k].moment[3 - turns + d] -= J[dim + turns + d] * multiplier;
        }
    }
}
