/* Joints between two attachments: equations phi of the gap between their points and of their axes (derive/couplings/
 * joint.py), made equations over the coordinates of what carries them. Of an attachment on a slide s is one of them.
 */
#include "engine.h"

#include <string.h>

enum { MOVES = 9 }; /* gap, turn of the first attachment, turn of the second: as many in space, fewer in the plane */

/* A joint at a state. */
typedef struct {
    fu_attachment_state at[2];
    double gap[3], c[3], rate, second;
    double B[MOVES * 2 * FU_ATTACHMENT_COORDINATES]; /* derivatives of gap and turns by the coordinates of both */
    int moves, used, n; /* columns of the kernel's derivatives, and of these the first that are not nil */
} joint_view;

static void look(const fu_model *model, const fu_joint *joint, const fu_state *state, const double s_rate[2],
                 joint_view *view)
{
    const int dim = model->dim, turns = dim == 3 ? 3 : 1;
    for (int e = 0; e < 2; ++e)
        fu_attachment_at(model, &joint->attachments[e], state, s_rate ? s_rate[e] : 0.0,
                         joint->of_points ? FU_POINT : FU_POINT | FU_AXES, &view->at[e]);
    const fu_attachment_state *one = &view->at[0], *two = &view->at[1];
    const int n1 = one->n, n2 = two->n, n = n1 + n2;
    view->n = n;
    view->moves = dim + 2 * turns;
    view->used = joint->of_points ? dim : view->moves;
    for (int e = 0; e < 2 && joint->of_points; ++e) {
        memset(view->at[e].A, 0, sizeof view->at[e].A);
        memset(view->at[e].omega, 0, sizeof view->at[e].omega);
        memset(view->at[e].alpha, 0, sizeof view->at[e].alpha);
    }
    for (int d = 0; d < 3; ++d) view->gap[d] = two->p[d] - one->p[d];
    view->rate = view->second = 0.0;
    view->c[0] = joint->c0;
    if (joint->signal >= 0)
        view->c[0] += fu_signal_at(&model->signals[joint->signal], state->t, &view->rate, &view->second);
    view->c[1] = cos(view->c[0]);
    view->c[2] = sin(view->c[0]);
    memset(view->B, 0, sizeof(double) * (size_t)(view->used * n));
    for (int d = 0; d < dim; ++d) {
        for (int i = 0; i < n1; ++i) view->B[d * n + i] = -one->P[d * n1 + i];
        for (int i = 0; i < n2; ++i) view->B[d * n + n1 + i] = two->P[d * n2 + i];
    }
    for (int d = 0; d < turns && !joint->of_points; ++d) {
        memcpy(view->B + (dim + d) * n, one->T + d * n1, sizeof(double) * (size_t)n1);
        memcpy(view->B + (dim + turns + d) * n + n1, two->T + d * n2, sizeof(double) * (size_t)n2);
    }
}

/* Makes J (rows x n) over coordinates from that over gap and turns. */
static void over_coordinates(const joint_view *view, int rows, const double *by_moves, double *J)
{
    const int n = view->n;
    memset(J, 0, sizeof(double) * (size_t)(rows * n));
    for (int r = 0; r < rows; ++r)
        for (int m = 0; m < view->used; ++m) {
            const double value = by_moves[r * view->moves + m];
            if (value == 0.0) continue;
            for (int i = 0; i < n; ++i) J[r * n + i] += value * view->B[m * n + i];
        }
}

static int coordinates(const joint_view *view, int *at)
{
    memcpy(at, view->at[0].at, sizeof(int) * (size_t)view->at[0].n);
    memcpy(at + view->at[0].n, view->at[1].at, sizeof(int) * (size_t)view->at[1].n);
    return view->n;
}

/* Returns whether the slide that a joint is on has left its cable. */
int fu_joint_is_inactive(const fu_model *model, const fu_joint *joint, const fu_state *state)
{
    for (int e = 0; e < 2; ++e) {
        const int slide = joint->attachments[e].slide;
        if (slide >= 0 && fu_slide_flags_of(model, state, slide)->mode == FU_LEFT) return 1;
    }
    return 0;
}

/* Makes phi and its derivatives J over the joint's coordinates, with the numbers of these for fu_add; returns how many they are. */
int fu_joint_equations(const fu_model *model, const fu_joint *joint, const fu_state *state, double *phi, int *at, double *J)
{
    double by_moves[6 * MOVES], K[MOVES * MOVES];
    const double *multipliers = state->forces + joint->base.force;
    joint_view view;
    look(model, joint, state, 0, &view);
    joint->kernel->force(view.gap, view.at[0].A, view.at[1].A, view.c, multipliers, phi, by_moves, K);
    over_coordinates(&view, joint->kernel->rows, by_moves, J);
    return coordinates(&view, at);
}

/* Returns whether a slide, or any where `which` is -1, ties its rider's axes to the cable: their turn jumps where its curvature
 * does. */
int fu_ties_a_frame(const fu_model *model, int which)
{
    for (int k = 0; k < model->n_couplings; ++k) {
        if (model->couplings[k]->type != &fu_joint_type) continue;
        const fu_joint *joint = (const fu_joint *)model->couplings[k];
        for (int e = 0; e < 2; ++e) {
            const int slide = joint->attachments[e].slide;
            if (slide >= 0 && (which < 0 || slide == which)) return 1;
        }
    }
    return 0;
}

/* Returns whether a joint is between two cables. */
int fu_between_cables(const fu_joint *joint)
{
    return joint->attachments[0].cable >= 0 && joint->attachments[1].cable >= 0;
}

/* Returns whether any of n numbers is not zero. */
static int any(int n, const double *numbers)
{
    for (int i = 0; i < n; ++i)
        if (numbers[i] != 0.0) return 1;
    return 0;
}

/* Makes J, and K, the derivative of J' multipliers, over the joint's coordinates, with their numbers; returns how many they are. */
int fu_joint_tangent(const fu_model *model, const fu_joint *joint, const fu_state *state, int *at, double *J, double *K)
{
    const int rows = joint->kernel->rows, dim = model->dim, turns = dim == 3 ? 3 : 1;
    double phi[6], by_moves[6 * MOVES], of_moves[MOVES * MOVES], g[MOVES] = {0.0};
    double half[MOVES * 2 * FU_ATTACHMENT_COORDINATES];
    const double *multipliers = state->forces + joint->base.force;
    joint_view view;
    look(model, joint, state, 0, &view);
    const int n = coordinates(&view, at), n1 = view.at[0].n;
    joint->kernel->force(view.gap, view.at[0].A, view.at[1].A, view.c, multipliers, phi, by_moves, of_moves);
    over_coordinates(&view, rows, by_moves, J);
    over_coordinates(&view, view.used, of_moves, half);
    for (int r = 0; r < rows; ++r)
        for (int m = 0; m < view.moves; ++m) g[m] += by_moves[r * view.moves + m] * multipliers[r];
    memset(K, 0, sizeof(double) * (size_t)(n * n));
    for (int m = 0; m < view.used; ++m)
        for (int i = 0; i < n && any(view.moves, of_moves + m * view.moves); ++i) {
            const double by = view.B[m * n + i];
            for (int j = 0; j < n && by != 0.0; ++j) K[i * n + j] += by * half[m * n + j];
        }
    for (int e = 0; e < 2; ++e) {
        double pull[3], part[FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES];
        const int m = view.at[e].n, from = e ? n1 : 0;
        for (int d = 0; d < dim; ++d) pull[d] = e ? g[d] : -g[d];
        memset(part, 0, sizeof(double) * (size_t)(m * m));
        fu_geometric_stiffness(model, &joint->attachments[e], state, pull, joint->of_points ? 0 : g + dim + e * turns, m, part);
        for (int i = 0; i < m; ++i)
            for (int j = 0; j < m; ++j) K[(from + i) * n + from + j] += part[i * m + j];
    }
    return n;
}

static const fu_rows *rows_of_slide(const fu_model *model, const fu_joint *joint, int e, const fu_accelerator *work)
{
    return &work->rows[model->slides[joint->attachments[e].slide].base.row];
}

/* Makes H and W over the joint's coordinates those over the dofs: s of an attachment on a slide follows (eq 24, 31, 37). */
static void replace_s(const fu_model *model, const fu_joint *joint, const joint_view *view, const double *J,
                      const fu_accelerator *work, fu_rows *rows)
{
    const int m = joint->kernel->rows;
    int every[2 * FU_ATTACHMENT_COORDINATES], column[2 * FU_ATTACHMENT_COORDINATES], n = 0;
    coordinates(view, every);
    for (int i = 0; i < view->n; ++i)
        if (every[i] < model->n_dof) {
            column[n] = i;
            rows->at[n++] = every[i];
        }
    rows->n = n;
    for (int e = 0; e < 2; ++e)
        if (joint->attachments[e].slide >= 0) rows->n += rows_of_slide(model, joint, e, work)->n;
    for (int r = 0; r < m; ++r)
        for (int i = 0; i < n; ++i) rows->H[r * rows->n + i] = J[r * view->n + column[i]];
    for (int e = 0, to = n; e < 2; ++e) {
        const int slide = joint->attachments[e].slide;
        if (slide < 0) continue;
        const fu_rows *of = rows_of_slide(model, joint, e, work);
        const fu_slide_state *slide_state = fu_slide_state_of(model, work, slide);
        const int s = (e ? view->n : view->at[0].n) - 1;
        rows->slide = slide;
        memcpy(rows->at + to, of->at, sizeof(int) * (size_t)of->n);
        for (int r = 0; r < m; ++r) {
            const double by_s = J[r * view->n + s];
            rows->by_s[r] = joint->redundant_rows >> r & 1 ? 0.0 : by_s;
            for (int i = 0; i < of->n; ++i) rows->H[r * rows->n + to + i] = by_s * slide_state->G[i];
            rows->W[r] -= by_s * slide_state->s_bias;
        }
        to += of->n;
    }
}

/* Makes H q'' = W, what is left of phi, and its rate at rest; s of an attachment on a slide follows (eq 24, 31, 37):
 * H = C_q + C_s G, W = -Q_d - C_s (s'' - G q''). The rows of that slide are there. */
void fu_joint_rows(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_accelerator *work)
{
    const fu_joint *joint = (const fu_joint *)coupling;
    fu_rows *rows = &work->rows[coupling->row];
    const int m = joint->kernel->rows, dim = model->dim;
    double by_moves[6 * MOVES], K[MOVES * MOVES], J[6 * 2 * FU_ATTACHMENT_COORDINATES], s_rate[2], gap_rate[3];
    joint_view view;
    if (fu_joint_is_inactive(model, joint, state)) {
        rows->n = rows->rows = 0;
        return;
    }
    for (int e = 0; e < 2; ++e) {
        const int slide = joint->attachments[e].slide;
        s_rate[e] = slide >= 0 ? fu_slide_state_of(model, work, slide)->s_rate : 0.0;
    }
    look(model, joint, state, s_rate, &view);
    const fu_attachment_state *one = &view.at[0], *two = &view.at[1];
    joint->kernel->force(view.gap, one->A, two->A, view.c, state->forces + joint->base.force, rows->C,
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
    replace_s(model, joint, &view, J, work, rows);
    rows->redundant_rows = joint->redundant_rows;
    for (int r = 0; r < m; ++r)
        if (joint->redundant_rows >> r & 1) {
            memset(rows->H + r * rows->n, 0, sizeof(double) * (size_t)rows->n);
            rows->W[r] = rows->C[r] = rows->rate[r] = 0.0;
        }
}

/* Returns whether an unknown that the joint touches moves: all do but s of a slide that does not slide, whose row says so. */
int fu_joint_moves(const fu_model *model, const fu_joint *joint, const fu_state *state, int at)
{
    for (int e = 0; e < 2 && at >= model->n_dof; ++e) {
        const int slide = joint->attachments[e].slide;
        if (slide >= 0 && fu_extra(model, model->slides[slide].base.unknown) == at)
            return fu_slide_flags_of(model, state, slide)->mode == FU_SLIDES;
    }
    return 1;
}

/* Makes the force and moment of the joint on its second attachment by these multipliers. */
void fu_joint_outputs(const fu_model *model, const fu_joint *joint, const fu_state *state, const double *multipliers,
                      fu_joint_output *out)
{
    const int dim = model->dim, turns = dim == 3 ? 3 : 1;
    double phi[6], by_moves[6 * MOVES], K[MOVES * MOVES];
    joint_view view;
    *out = (fu_joint_output){0};
    if (fu_joint_is_inactive(model, joint, state)) return;
    look(model, joint, state, 0, &view);
    joint->kernel->force(view.gap, view.at[0].A, view.at[1].A, view.c, multipliers, phi, by_moves, K);
    for (int r = 0; r < joint->kernel->rows; ++r) {
        const double *J = by_moves + r * view.moves;
        out->residual = fmax(out->residual, fabs(phi[r]));
        for (int d = 0; d < dim; ++d) out->force[d] -= J[d] * multipliers[r];
        for (int d = 0; d < turns; ++d) out->moment[3 - turns + d] -= J[dim + turns + d] * multipliers[r];
    }
}
