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
    int moves, n;
} joint_view;

static void look(const fu_model *model, const fu_joint *joint, const fu_state *state, const double s_rate[2],
                 joint_view *view)
{
    const int dim = model->dim, turns = dim == 3 ? 3 : 1;
    for (int e = 0; e < 2; ++e)
        fu_attachment_at(model, &joint->attachments[e], state, s_rate ? s_rate[e] : 0.0, FU_POINT | FU_AXES, &view->at[e]);
    const fu_attachment_state *one = &view->at[0], *two = &view->at[1];
    const int n1 = one->n, n2 = two->n, n = n1 + n2;
    view->n = n;
    view->moves = dim + 2 * turns;
    for (int d = 0; d < 3; ++d) view->gap[d] = two->p[d] - one->p[d];
    view->rate = view->second = 0.0;
    view->c[0] = joint->c0;
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
static void over_coordinates(const joint_view *view, int rows, const double *by_moves, double *J)
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

static int coordinates(const joint_view *view, int *at)
{
    memcpy(at, view->at[0].at, sizeof(int) * (size_t)view->at[0].n);
    memcpy(at + view->at[0].n, view->at[1].at, sizeof(int) * (size_t)view->at[1].n);
    return view->n;
}

/* whether the slide that it is on has left its cable */
static int is_inactive(const fu_joint *joint, const fu_state *state)
{
    for (int e = 0; e < 2; ++e)
        if (joint->attachments[e].slide >= 0 && state->mode[joint->attachments[e].slide] == FU_LEFT) return 1;
    return 0;
}

/* phi, its derivatives J over the joint's coordinates, and their numbers for fu_add; returns how many they are */
static int equations_of(const fu_model *model, const fu_joint *joint, const fu_state *state, double *phi, int *at, double *J)
{
    double by_moves[6 * MOVES], K[MOVES * MOVES];
    const double *multipliers = state->forces + joint->base.force;
    joint_view view;
    look(model, joint, state, 0, &view);
    joint->kernel->force(view.gap, view.at[0].A, view.at[1].A, view.c, multipliers, phi, by_moves, K);
    over_coordinates(&view, joint->kernel->rows, by_moves, J);
    return coordinates(&view, at);
}

/* whether a slide, or any where `which` is -1, ties its rider's axes to the cable: their turn jumps where its curvature
 * does */
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

int fu_between_cables(const fu_joint *joint)
{
    return joint->attachments[0].cable >= 0 && joint->attachments[1].cable >= 0;
}

/* the same with K, the derivative of J' multipliers */
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
        const int m = view.at[e].n, from = e ? n1 : 0;
        for (int d = 0; d < dim; ++d) pull[d] = e ? g[d] : -g[d];
        memset(part, 0, sizeof(double) * (size_t)(m * m));
        fu_geometric_stiffness(model, &joint->attachments[e], state, pull, g + dim + e * turns, m, part);
        for (int i = 0; i < m; ++i)
            for (int j = 0; j < m; ++j) K[(from + i) * n + from + j] += part[i * m + j];
    }
    return n;
}

static const fu_rows *rows_of_slide(const fu_model *model, const fu_joint *joint, int e, const fu_accelerator *work)
{
    return &work->rows[model->slides[joint->attachments[e].slide].base.row];
}

/* H and W over the joint's coordinates made those over the dofs: s of an attachment on a slide follows (eq 24, 31, 37). */
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
        const fu_slide_state *slide_state = &work->slide_states[slide];
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

/* H q'' = W, what is left of phi, and its rate at rest; s of an attachment on a slide follows (eq 24, 31, 37):
 * H = C_q + C_s G, W = -Q_d - C_s (s'' - G q''). The rows of that slide are there. */
static void constraint_rows(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_accelerator *work)
{
    const fu_joint *joint = (const fu_joint *)coupling;
    const fu_slide_state *slide_states = work->slide_states;
    fu_rows *rows = &work->rows[coupling->row];
    const int m = joint->kernel->rows, dim = model->dim;
    double by_moves[6 * MOVES], K[MOVES * MOVES], J[6 * 2 * FU_ATTACHMENT_COORDINATES], s_rate[2], gap_rate[3];
    joint_view view;
    if (is_inactive(joint, state)) {
        rows->n = rows->rows = 0;
        return;
    }
    for (int e = 0; e < 2; ++e) s_rate[e] = joint->attachments[e].slide >= 0 ? slide_states[joint->attachments[e].slide].s_rate : 0.0;
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

/* Whether an unknown that the joint touches moves: all do but s of a slide that does not slide, whose row says so. */
static int moves(const fu_model *model, const fu_joint *joint, const fu_state *state, int at)
{
    for (int e = 0; e < 2 && at >= model->n_dof; ++e) {
        const int slide = joint->attachments[e].slide;
        if (slide >= 0 && fu_extra(model, model->slides[slide].base.unknown) == at) return state->mode[slide] == FU_SLIDES;
    }
    return 1;
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations, double *f,
                     double *own)
{
    const fu_joint *joint = (const fu_joint *)coupling;
    const fu_state *next = equations->next;
    const double *multipliers = next->forces + coupling->force, scale = equations->weights.stiffness;
    double phi[6], J[6 * 2 * FU_ATTACHMENT_COORDINATES];
    int at[2 * FU_ATTACHMENT_COORDINATES];
    if (is_inactive(joint, next)) {
        for (int r = 0; r < joint->kernel->rows; ++r) own[coupling->unknown + r] = -scale * multipliers[r];
        return;
    }
    const int n = equations_of(model, joint, next, phi, at, J);
    for (int r = 0; r < joint->kernel->rows; ++r) {
        if (joint->redundant_rows >> r & 1) phi[r] = 0.0;
        own[coupling->unknown + r] = -fu_row_unit(equations->weights.inertia, coupling->scale[r]) * phi[r];
        for (int i = 0; i < n; ++i) {
            const double pull = J[r * n + i] * multipliers[r];
            if (at[i] < model->n_dof) f[at[i]] += pull;
            else if (moves(model, joint, next, at[i])) own[at[i] - model->n_dof] -= scale * pull;
        }
    }
}

/* Rows that are not in use: their multipliers are nil. */
static void unit_rows(const fu_model *model, const fu_joint *joint, int which, double inertia, fu_system *system)
{
    const int first = fu_extra(model, joint->base.unknown);
    for (int r = 0; r < joint->kernel->rows; ++r)
        if (which >> r & 1) fu_add(model, system, first + r, first + r, fu_row_unit(inertia, joint->base.scale[r]));
}

/* Derivatives by the coordinates of both attachments, made those by psi. */
static void turn_ends(const fu_model *model, const fu_joint *joint, const double *psi, double *rows, int n_rows, int n,
                      int n_first)
{
    for (int e = 0; e < 2; ++e) fu_turn_attachment(model, &joint->attachments[e], psi, rows, n_rows, n, e ? n_first : 0);
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations, fu_system *system)
{
    const fu_joint *joint = (const fu_joint *)coupling;
    const fu_state *next = equations->next;
    const fu_weights w = equations->weights;
    const int rows = joint->kernel->rows, first = fu_extra(model, coupling->unknown);
    double J[6 * 2 * FU_ATTACHMENT_COORDINATES], K[4 * FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES];
    int at[2 * FU_ATTACHMENT_COORDINATES], unused[FU_ATTACHMENT_COORDINATES];
    if (is_inactive(joint, next)) {
        unit_rows(model, joint, ~0, w.inertia, system);
        return;
    }
    const int n = fu_joint_tangent(model, joint, next, at, J, K);
    const int n_first = fu_attachment_coordinates(model, &joint->attachments[0], next, unused);
    for (int r = 0; r < rows; ++r)
        if (joint->redundant_rows >> r & 1) memset(J + r * n, 0, sizeof(double) * (size_t)n);
    unit_rows(model, joint, joint->redundant_rows, w.inertia, system);
    for (int r = 0; r < rows; ++r)
        for (int i = 0; i < n; ++i)
            if (moves(model, joint, next, at[i]))
                fu_add(model, system, at[i], first + r, fu_row_unit(w.inertia, coupling->scale[r]) * J[r * n + i]);
    turn_ends(model, joint, equations->psi, J, rows, n, n_first);
    turn_ends(model, joint, equations->psi, K, n, n, n_first);
    for (int i = 0; i < n; ++i) {
        for (int r = 0; r < rows; ++r)
            fu_add(model, system, first + r, at[i], fu_row_unit(w.inertia, coupling->scale[r]) * J[r * n + i]);
        if (!moves(model, joint, next, at[i])) continue;
        for (int m = 0; m < n; ++m) {
            /* what is between two cables would widen the band: Newton converges without */
            if (K[i * n + m] == 0.0 || (fu_between_cables(joint) && (i < n_first) != (m < n_first))) continue;
            fu_add(model, system, at[i], at[m], w.stiffness * K[i * n + m]);
        }
    }
}

static void gaps(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *phi)
{
    double J[6 * 2 * FU_ATTACHMENT_COORDINATES];
    int at[2 * FU_ATTACHMENT_COORDINATES];
    equations_of(model, (const fu_joint *)coupling, state, phi, at, J);
}

static int may_start_open(const fu_coupling *coupling, const fu_state *state)
{
    (void)coupling, (void)state;
    return 1;
}

static void take_forces(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work, fu_state *state)
{
    (void)model;
    memcpy(state->forces + coupling->force, work->multipliers + coupling->multiplier,
           sizeof(double) * (size_t)coupling->n_forces);
}

/* Force and moment of the joint on its second attachment by these multipliers. */
void fu_joint_outputs(const fu_model *model, const fu_joint *joint, const fu_state *state, const double *multipliers,
                      fu_joint_output *out)
{
    const int dim = model->dim, turns = dim == 3 ? 3 : 1;
    double phi[6], by_moves[6 * MOVES], K[MOVES * MOVES];
    joint_view view;
    *out = (fu_joint_output){0};
    if (is_inactive(joint, state)) return;
    look(model, joint, state, 0, &view);
    joint->kernel->force(view.gap, view.at[0].A, view.at[1].A, view.c, multipliers, phi, by_moves, K);
    for (int r = 0; r < joint->kernel->rows; ++r) {
        const double *J = by_moves + r * view.moves;
        out->residual = fmax(out->residual, fabs(phi[r]));
        for (int d = 0; d < dim; ++d) out->force[d] -= J[d] * multipliers[r];
        for (int d = 0; d < turns; ++d) out->moment[3 - turns + d] -= J[dim + turns + d] * multipliers[r];
    }
}

static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const double *acceleration,
                    const fu_accelerator *work, double *out)
{
    (void)acceleration;
    fu_joint_outputs(model, (const fu_joint *)coupling, state, work->multipliers + coupling->multiplier,
                     (fu_joint_output *)out);
}

const fu_coupling_type fu_joint_type = {
    .name = "joint",
    .n_outputs = (int)(sizeof(fu_joint_output) / sizeof(double)),
    .residual = residual,
    .tangent = tangent,
    .rows = constraint_rows,
    .take_forces = take_forces,
    .outputs = outputs,
    .gaps = gaps,
    .may_start_open = may_start_open,
};
