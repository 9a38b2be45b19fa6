/* Joints between two attachments: equations phi of the gap between their points and of their axes
 * (derive/couplings/joint.py), over the coordinates of their carriers. For an attachment on a slide s is one of
 * them. */
#include "base/simd.h"
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/accelerator.h"
#include "couplings/joint/joint.h"
#include "couplings/slide/slide.h"

#include <math.h>
#include <string.h>

enum {
    MAX_MOVES = 9
}; /* gap, rotation of the first attachment, rotation of the second: three components each in space */

/* A joint at a state. */
typedef struct {
    fu_attachment_state at[2];
    const double *A[2]; /* axes of both; null for a joint without rotations */
    double gap[3], c[3], rate, second;
    int moves, turns; /* columns of the kernel's derivatives; those of each rotation, 0 for a joint without */
} joint_view;

static const double nil[9] = {0.0};

/* Computes the cosine and the sine of the angle of the second frame, from x of the first towards y. */
static void find_angle(int dim, joint_view *view)
{
    double cosine = 0.0, sine = 0.0;
    for (int d = 0; d < dim; ++d) {
        cosine += view->A[0][d * dim] * view->A[1][d * dim];
        sine += view->A[0][d * dim + 1] * view->A[1][d * dim];
    }
    const double size = hypot(cosine, sine);
    view->c[1] = size > 0.0 ? cosine / size : 1.0;
    view->c[2] = size > 0.0 ? sine / size : 0.0;
}

/* Computes the arguments of a joint at a state; s_rate: of the slides at its ends, null without velocities. */
static void look(const fu_model *model, const fu_joint *joint, const fu_state *state, const double s_rate[2],
                 joint_view *view)
{
    const int dim = model->dim, turns = dim == 3 ? 3 : 1;
    const int what = (s_rate ? FU_POINT : FU_PLACE) | (joint->of_points ? 0 : FU_AXES);
    for (int e = 0; e < 2; ++e) {
        fu_attachment_at(model, &joint->attachments[e], state, s_rate ? s_rate[e] : 0.0, what, &view->at[e]);
        view->A[e] = joint->of_points ? nil : view->at[e].A;
    }
    view->moves = dim + 2 * turns;
    view->turns = joint->of_points ? 0 : turns;
    for (int d = 0; d < 3; ++d) view->gap[d] = view->at[1].p[d] - view->at[0].p[d];
    view->rate = view->second = 0.0;
    view->c[0] = joint->c0;
    if (joint->signal >= 0)
        view->c[0] += fu_signal_at(&model->signals[joint->signal], state->t, &view->rate, &view->second);
    const int is_turned = view->c[0] != 0.0; /* most joints have no angle */
    view->c[1] = is_turned ? cos(view->c[0]) : 1.0;
    view->c[2] = is_turned ? sin(view->c[0]) : 0.0;
    if (!joint->is_free) return;
    const double *locked = fu_joint_locked(joint, state);
    if (locked) memcpy(view->c, locked, sizeof view->c);
    else find_angle(dim, view);
}

/* Adds a value times a row of n numbers to another. */
FU_INLINE void add_row(int n, double value, const double *row, double *restrict to)
{
    for (int i = 0; i < n; ++i) to[i] += value * row[i];
}

/* over_coordinates for n coordinates. */
FU_INLINE void over_n(int n, int dim, const joint_view *view, int e, int rows, const double *by_moves, double *J)
{
    const fu_attachment_state *at = &view->at[e];
    const int first = dim + e * view->turns;
    for (int r = 0; r < rows; ++r, by_moves += view->moves, J += n) {
        for (int i = 0; i < n; ++i) J[i] = 0.0;
        for (int d = 0; d < dim; ++d)
            if (by_moves[d] != 0.0) add_row(n, e ? by_moves[d] : -by_moves[d], at->P + d * n, J);
        for (int d = 0; d < view->turns; ++d)
            if (by_moves[first + d] != 0.0) add_row(n, by_moves[first + d], at->T + d * n, J);
    }
}

/* Computes J (rows x n) over an attachment's n coordinates from that over gap and rotations. */
static void over_coordinates(int dim, const joint_view *view, int e, int rows, const double *by_moves, double *J)
{
    const int n = view->at[e].n;
    if (n == FU_FRAME_DOFS) over_n(FU_FRAME_DOFS, dim, view, e, rows, by_moves, J); /* its loops have no remainders */
    else over_n(n, dim, view, e, rows, by_moves, J);
}

static void take_coordinates(const joint_view *view, int e, int *n, int *at)
{
    *n = view->at[e].n;
    for (int i = 0; i < *n; ++i) at[i] = view->at[e].at[i];
}

/* Returns whether the slide of a joint has left its cable. */
int fu_joint_is_inactive(const fu_model *model, const fu_joint *joint, const fu_state *state)
{
    for (int e = 0; e < 2; ++e) {
        const int slide = joint->attachments[e].slide;
        if (slide >= 0 && fu_slide_flags_of(model, state, slide)->mode == FU_LEFT) return 1;
    }
    return 0;
}

/* Computes a joint's equations at a state. */
void fu_joint_equations(const fu_model *model, const fu_joint *joint, const fu_state *state, fu_joint_rows_at *out)
{
    double by_moves[6 * MAX_MOVES], K[MAX_MOVES * MAX_MOVES];
    joint_view view;
    look(model, joint, state, 0, &view);
    joint->kernel->force(view.gap, view.A[0], view.A[1], view.c, state->forces + joint->base.force, out->phi, by_moves,
                         K);
    for (int e = 0; e < 2; ++e) {
        take_coordinates(&view, e, &out->n[e], out->at[e]);
        over_coordinates(model->dim, &view, e, joint->kernel->rows, by_moves, out->J[e]);
    }
}

/* Computes c of a free motion at a state: the displacement, and the cosine and the sine of the angle. */
void fu_joint_free_place(const fu_model *model, const fu_joint *joint, const fu_state *state, double c[3])
{
    double by_moves[6 * MAX_MOVES], K[MAX_MOVES * MAX_MOVES], phi[6];
    joint_view view;
    look(model, joint, state, 0, &view);
    find_angle(model->dim, &view);
    view.c[0] = 0.0;
    joint->kernel->force(view.gap, view.A[0], view.A[1], view.c, state->forces + joint->base.force, phi, by_moves, K);
    c[0] = phi[0]; /* of an angle that is its own: zero */
    c[1] = view.c[1];
    c[2] = view.c[2];
}

/* Returns whether a joint is between two cables. */
int fu_between_cables(const fu_joint *joint)
{
    return joint->attachments[0].cable >= 0 && joint->attachments[1].cable >= 0;
}

/* Returns whether any of n numbers is nonzero. */
static int any(int n, const double *numbers)
{
    for (int i = 0; i < n; ++i)
        if (numbers[i] != 0.0) return 1;
    return 0;
}

/* Adds to K (n_f x n_e) the contribution of an attachment f to the derivative by the coordinates of e; `half` (moves x
 * n_e) is that of the work by the moves. */
static void add_elastic(int dim, const joint_view *view, int f, int n_e, const double *half, double *K)
{
    const fu_attachment_state *at = &view->at[f];
    for (int d = 0; d < dim + view->turns; ++d) {
        const double *by = d < dim ? at->P + d * at->n : at->T + (d - dim) * at->n;
        const double *row = half + (d < dim ? d : d + f * view->turns) * n_e;
        for (int i = 0; i < at->n; ++i)
            if (by[i] != 0.0) add_row(n_e, d < dim && !f ? -by[i] : by[i], row, K + i * n_e);
    }
}

/* Computes a joint's derivatives at a state. */
void fu_joint_tangent(const fu_model *model, const fu_joint *joint, const fu_state *state, const double *multipliers,
                      fu_joint_derivatives *out)
{
    const int rows = joint->kernel->rows, dim = model->dim;
    double phi[6], by_moves[6 * MAX_MOVES], of_moves[MAX_MOVES * MAX_MOVES],
        g[MAX_MOVES] = {0.0}, half[MAX_MOVES * FU_ATTACHMENT_COORDINATES];
    joint_view view;
    look(model, joint, state, 0, &view);
    joint->kernel->force(view.gap, view.A[0], view.A[1], view.c, multipliers, phi, by_moves, of_moves);
    out->across = any(view.moves * view.moves, of_moves);
    for (int r = 0; r < rows; ++r)
        for (int m = 0; m < view.moves; ++m) g[m] += by_moves[r * view.moves + m] * multipliers[r];
    for (int e = 0; e < 2; ++e) {
        take_coordinates(&view, e, &out->n[e], out->at[e]);
        over_coordinates(dim, &view, e, rows, by_moves, out->J[e]);
    }
    for (int e = 0; e < 2; ++e) {
        const int n = out->n[e];
        double pull[3], part[FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES];
        for (int d = 0; d < dim; ++d) pull[d] = e ? g[d] : -g[d];
        for (int f = 0; f < 2; ++f) {
            out->K[f][e] = out->J[e] + (rows + (f ? out->n[0] : 0)) * n;
            memset(out->K[f][e], 0, sizeof(double) * (size_t)(out->n[f] * n));
        }
        fu_wrench_derivatives(model, &joint->attachments[e], state, pull, view.turns ? g + dim + e * view.turns : 0, n,
                              out->K[e][e], 0, 0);
        if (!out->across) continue;
        over_coordinates(dim, &view, e, view.moves, of_moves, half);
        add_elastic(dim, &view, !e, n, half, out->K[!e][e]);
        memset(part, 0, sizeof(double) * (size_t)(n * n));
        add_elastic(dim, &view, e, n, half, part);
        for (int i = 0; i < n * n; ++i) out->K[e][e][i] += part[i];
    }
}

static const fu_rows *rows_of_slide(const fu_model *model, const fu_joint *joint, int e, const fu_accelerator *work)
{
    return &work->rows[model->slides[joint->attachments[e].slide].base.row];
}

/* Converts H and W over the joint's coordinates to those over the dofs: s of an attachment on a slide follows (eq 24,
 * 31, 37). */
static void replace_s(const fu_model *model, const fu_joint *joint, const joint_view *view,
                      double J[2][6 * FU_ATTACHMENT_COORDINATES], const fu_accelerator *work, fu_rows *rows)
{
    const int m = joint->kernel->rows;
    int n = 0, n_dofs[2]; /* coordinates that are dofs: all but s, which is the last */
    for (int e = 0; e < 2; ++e) {
        n_dofs[e] = view->at[e].n - (joint->attachments[e].slide >= 0);
        for (int i = 0; i < n_dofs[e]; ++i) rows->at[n++] = view->at[e].at[i];
    }
    rows->n = n;
    for (int e = 0; e < 2; ++e)
        if (joint->attachments[e].slide >= 0) rows->n += rows_of_slide(model, joint, e, work)->n;
    for (int r = 0; r < m; ++r)
        for (int e = 0; e < 2; ++e)
            memcpy(rows->H + r * rows->n + (e ? n_dofs[0] : 0), J[e] + r * view->at[e].n,
                   sizeof(double) * (size_t)n_dofs[e]);
    for (int e = 0, to = n; e < 2; ++e) {
        const int slide = joint->attachments[e].slide;
        if (slide < 0) continue;
        const fu_rows *of = rows_of_slide(model, joint, e, work);
        const fu_slide_state *slide_state = fu_slide_state_of(model, work, slide);
        rows->slide = slide;
        memcpy(rows->at + to, of->at, sizeof(int) * (size_t)of->n);
        for (int r = 0; r < m; ++r) {
            const double by_s = J[e][(r + 1) * view->at[e].n - 1];
            rows->by_s[r] = joint->redundant_rows >> r & 1 ? 0.0 : by_s;
            for (int i = 0; i < of->n; ++i) rows->H[r * rows->n + to + i] = by_s * slide_state->G[i];
            rows->W[r] -= by_s * slide_state->s_bias;
        }
        to += of->n;
    }
}

/* Subtracts the accelerations of gap and rotations at zero accelerations of the coordinates, times J, from W. */
static void subtract_bias(int dim, int m, const joint_view *view, const double *by_moves, double *W)
{
    const fu_attachment_state *one = &view->at[0], *two = &view->at[1];
    double bias[MAX_MOVES] = {0.0};
    for (int d = 0; d < dim; ++d) bias[d] = two->bias[d] - one->bias[d];
    for (int d = 0; d < view->turns; ++d) {
        bias[dim + d] = one->alpha[d];
        bias[dim + view->turns + d] = two->alpha[d];
    }
    for (int r = 0; r < m; ++r)
        for (int k = 0; k < view->moves; ++k) W[r] -= by_moves[r * view->moves + k] * bias[k];
}

/* Computes H q'' = W, the residual phi, and its rate at rest; s of an attachment on a slide follows (eq 24, 31, 37): H
 * = C_q + C_s G, W = -Q_d - C_s (s'' - G q''). The rows of that slide exist already. */
void fu_joint_rows(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_accelerator *work)
{
    const fu_joint *joint = (const fu_joint *)coupling;
    fu_rows *rows = &work->rows[coupling->row];
    const int m = joint->kernel->rows, dim = model->dim;
    double by_moves[6 * MAX_MOVES], K[MAX_MOVES * MAX_MOVES], J[2][6 * FU_ATTACHMENT_COORDINATES], s_rate[2],
        gap_rate[3];
    joint_view view;
    if (fu_joint_is_inactive(model, joint, state) || (joint->is_free && !fu_joint_locked(joint, state))) {
        rows->n = rows->rows = 0;
        return;
    }
    for (int e = 0; e < 2; ++e) {
        const int slide = joint->attachments[e].slide;
        s_rate[e] = slide >= 0 ? fu_slide_state_of(model, work, slide)->s_rate : 0.0;
    }
    look(model, joint, state, s_rate, &view);
    const fu_attachment_state *one = &view.at[0], *two = &view.at[1];
    const double *turning[2] = {joint->of_points ? nil : one->omega, joint->of_points ? nil : two->omega};
    joint->kernel->force(view.gap, view.A[0], view.A[1], view.c, state->forces + joint->base.force, rows->C, by_moves,
                         K);
    for (int e = 0; e < 2; ++e) over_coordinates(dim, &view, e, m, by_moves, J[e]);
    for (int d = 0; d < 3; ++d) gap_rate[d] = two->v[d] - one->v[d];
    const double driving[2] = {view.rate, view.second};
    double Q_d[6];
    joint->kernel->motion(view.gap, view.A[0], view.A[1], view.c, gap_rate, turning[0], turning[1], driving, rows->rate,
                          Q_d);
    for (int r = 0; r < m; ++r) rows->W[r] = -Q_d[r];
    subtract_bias(dim, m, &view, by_moves, rows->W);
    replace_s(model, joint, &view, J, work, rows);
    rows->redundant_rows = joint->redundant_rows;
    for (int r = 0; r < m; ++r)
        if (joint->redundant_rows >> r & 1) {
            memset(rows->H + r * rows->n, 0, sizeof(double) * (size_t)rows->n);
            rows->W[r] = rows->C[r] = rows->rate[r] = 0.0;
        }
}

/* Returns whether an unknown of the joint moves: all do except s of a locked slide, whose row says so. */
int fu_joint_moves(const fu_model *model, const fu_joint *joint, const fu_state *state, int at)
{
    for (int e = 0; e < 2 && at >= model->n_dof; ++e) {
        const int slide = joint->attachments[e].slide;
        if (slide >= 0 && fu_extra(model, model->slides[slide].base.unknown) == at)
            return fu_slide_flags_of(model, state, slide)->mode == FU_SLIDES;
    }
    return 1;
}

/* Computes the force and moment of the joint on its second attachment by these multipliers. */
void fu_joint_outputs(const fu_model *model, const fu_joint *joint, const fu_state *state, const double *multipliers,
                      fu_joint_output *out)
{
    const int dim = model->dim, turns = dim == 3 ? 3 : 1;
    double phi[6], by_moves[6 * MAX_MOVES], K[MAX_MOVES * MAX_MOVES];
    joint_view view;
    *out = (fu_joint_output){0};
    if (fu_joint_is_inactive(model, joint, state)) return;
    look(model, joint, state, 0, &view);
    joint->kernel->force(view.gap, view.A[0], view.A[1], view.c, multipliers, phi, by_moves, K);
    for (int r = 0; r < joint->kernel->rows; ++r) {
        const double *J = by_moves + r * view.moves;
        out->residual = fmax(out->residual, fabs(phi[r]));
        for (int d = 0; d < dim; ++d) out->force[d] -= J[d] * multipliers[r];
        for (int d = 0; d < turns; ++d) out->moment[3 - turns + d] -= J[dim + turns + d] * multipliers[r];
    }
}
