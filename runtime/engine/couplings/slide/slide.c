/* A slide as a coupling. Internal unknowns: s and the force f on the rider. Their equations are f . r_x = R,
 * equilibrium along the cable, eq 30, and phi = r - p = 0. */
#include "base/workspace.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/joint/joint.h"
#include "couplings/slide/slide.h"

#include <math.h>
#include <string.h>

/* Computes t = r_x and u, as in couplings/slide/resistance.c, from the derivatives J of phi by the coordinates and s,
 * and R by the internal force. */
static void resistance_of(const fu_model *model, const fu_state *state, int j, const double *J,
                          fu_resistance *resistance)
{
    double t[3], u[3];
    fu_slide_motion(model, state, j, J, t, u);
    fu_resistance_at(model, state, j, t, u, state->forces + model->slides[j].base.force, resistance);
}

/* Returns R of a slide in a Newton system. */
static double resisted(const fu_model *model, const fu_state *state, int j)
{
    double J[3 * (FU_SLIDE_COORDINATES + 1)], K[(FU_SLIDE_COORDINATES + 1) * (FU_SLIDE_COORDINATES + 1)];
    fu_resistance resistance;
    fu_slide_tangent(model, state, j, state->forces + model->slides[j].base.force, J, K);
    resistance_of(model, state, j, J, &resistance);
    return resistance.R;
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations, double *f,
                     double *internal)
{
    const fu_slide *slide = (const fu_slide *)coupling;
    const fu_state *next = equations->next;
    const int j = coupling->index, mode = fu_slide_flags_of(model, next, j)->mode;
    const double scale = equations->weights.stiffness,
                 unit = fu_row_unit(equations->weights.inertia, slide->base.scale[0]);
    double phi[3], g[FU_SLIDE_COORDINATES + 1], rate, second;
    int at[FU_SLIDE_COORDINATES + 1];
    const int s = fu_slide_coordinates(model, next, j, at);
    internal += coupling->unknown;
    fu_slide_residual(model, next, j, phi, g);
    for (int i = 0; i < s; ++i) f[at[i]] += g[i];
    internal[0] = mode == FU_SLIDES
                      ? -scale * g[s]
                      : -unit * (next->s[j] - (mode == FU_LOCKED ? fu_slide_locked_s(model, next, j, &rate, &second)
                                                                 : equations->now->s[j]));
    if (slide->resistance && mode == FU_SLIDES) internal[0] += scale * resisted(model, next, j);
    for (int d = 0; d < slide->kernel->dim; ++d)
        internal[1 + d] = mode == FU_LEFT ? -scale * next->forces[coupling->force + d] : -unit * phi[d];
}

/* Adds the derivatives of R to the row of s; J: derivatives of phi by the coordinates themselves. */
static void resistance_matrix(const fu_model *model, int j, const fu_equations *equations, const double *J,
                              fu_system *system)
{
    const fu_slide *slide = &model->slides[j];
    const fu_weights w = equations->weights;
    double by_place[FU_SLIDE_COORDINATES + 1], by_rate[FU_SLIDE_COORDINATES + 1];
    int at[FU_SLIDE_COORDINATES + 1];
    const int s = fu_slide_coordinates(model, equations->next, j, at), n = s + 1;
    fu_resistance resistance;
    resistance_of(model, equations->next, j, J, &resistance);
    fu_resistance_rows(model, equations->next, j, J, &resistance, by_place, by_rate);
    fu_turn_attachment(model, &slide->rider, equations->psi, by_place, 1, n, fu_slide_element_coordinates(model, j));
    for (int k = 0; k < n; ++k) fu_add(model, system, at[s], at[k], -w.stiffness * (by_place[k] + w.rate * by_rate[k]));
    for (int d = 0; d < model->dim; ++d)
        fu_add(model, system, at[s], at[s] + 1 + d, -fu_row_unit(w.inertia, slide->base.scale[0]) * resistance.by_f[d]);
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations,
                    fu_system *system)
{
    const fu_slide *slide = (const fu_slide *)coupling;
    const fu_state *next = equations->next;
    const fu_weights w = equations->weights;
    const int j = coupling->index, element = fu_slide_element_coordinates(model, j);
    const fu_slide_flags *flags = fu_slide_flags_of(model, next, j);
    const int slides = flags->mode == FU_SLIDES;
    const double mass = fu_row_unit(w.inertia, slide->base.scale[0]);
    double J[3 * (FU_SLIDE_COORDINATES + 1)], K[(FU_SLIDE_COORDINATES + 1) * (FU_SLIDE_COORDINATES + 1)];
    int at[FU_SLIDE_COORDINATES + 1];
    const int s = fu_slide_coordinates(model, next, j, at), n = s + 1, dim = slide->kernel->dim;
    const int row = at[s], force = row + 1;
    fu_slide_tangent(model, next, j, next->forces + coupling->force, J, K);
    if (slide->resistance && slides) resistance_matrix(model, j, equations, J, system);
    for (int d = 0; d < dim; ++d) fu_add_line(model, system, force + d, 0, s + slides, at, J + d * n, mass);
    fu_turn_attachment(model, &slide->rider, equations->psi, J, dim, n, element);
    fu_turn_attachment(model, &slide->rider, equations->psi, K, n, n, element);
    if (!slides) fu_add(model, system, row, row, mass);
    for (int d = 0; d < dim; ++d) {
        if (flags->mode != FU_LEFT) fu_add_line(model, system, force + d, 1, n, at, J + d * n, mass);
        else fu_add(model, system, force + d, force + d, mass);
    }
    for (int i = 0; i < s; ++i) {
        fu_add(model, system, at[i], row, w.stiffness * K[i * n + s]);
        for (int k = 0; k < s; ++k)
            if (K[i * n + k] != 0.0) fu_add(model, system, at[i], at[k], w.stiffness * K[i * n + k]);
    }
    if (slides) fu_add_line(model, system, row, 1, n, at, K + s * n, w.stiffness);
}

static void rows(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_accelerator *work)
{
    const int j = coupling->index;
    fu_slide_terms(model, state, j, &work->rows[coupling->row], fu_slide_state_of(model, work, j));
}

void fu_slide_now(const fu_model *model, const fu_state *state, int j, fu_slide_state *slide_state)
{
    double H[FU_ROW_ENTRIES];
    fu_rows unused;
    unused.H = H;
    fu_slide_terms(model, state, j, &unused, slide_state);
}

/* Returns ds/dt, m/s, zero for s locked at rest. */
double fu_slide_rate(const fu_model *model, const fu_state *state, int j)
{
    fu_slide_state slide_state;
    if (fu_slide_flags_of(model, state, j)->mode == FU_LOCKED && model->slides[j].drive < 0) return 0.0;
    fu_slide_now(model, state, j, &slide_state);
    return slide_state.s_rate;
}

static void rates(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work, double *rate)
{
    *rate = fu_slide_state_of(model, work, coupling->index)->s_rate;
}

/* Adds the force along the cable on a slide's rider by joints whose frame follows the slide: the contribution of their
 * moments to s, which is in their rows as G. */
static void add_force_of_frame(const fu_model *model, const fu_accelerator *work, int j, const double *lambda,
                               double *f)
{
    const int dim = model->dim;
    const double *G = fu_slide_state_of(model, work, j)->by_point + (dim - 1) * dim;
    for (const fu_rows *rows = work->rows; rows < work->rows + model->n_rows; ++rows)
        for (int c = 0; c < rows->rows && rows->slide == j; ++c)
            for (int d = 0; d < dim; ++d) f[d] -= G[d] * rows->by_s[c] * lambda[rows->first + c];
}

static void take_forces(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work, fu_state *state)
{
    double *f = state->forces + coupling->force;
    fu_slide_force(model, work, coupling->index, work->multipliers, f);
    add_force_of_frame(model, work, coupling->index, work->multipliers, f);
}

void fu_slide_outputs(const fu_model *model, const fu_state *state, int j, const double *acceleration,
                      const fu_accelerator *work, fu_slide_output *out)
{
    const fu_slide *slide = &model->slides[j];
    const fu_rows *rows = &work->rows[slide->base.row];
    const fu_slide_state *slide_state = fu_slide_state_of(model, work, j);
    const double *lambda = work->multipliers;
    const int dim = model->dim;
    double pull = 0.0, square = 0.0;
    *out = (fu_slide_output){0};
    out->s_rate = slide_state->s_rate;
    out->s_acceleration = slide_state->s_bias;
    for (int k = 0; k < rows->n; ++k) out->s_acceleration += slide_state->G[k] * acceleration[rows->at[k]];
    for (int c = 0; c < dim - 1 && c < rows->rows; ++c) out->multiplier[c] = lambda[rows->first + c];
    fu_slide_force(model, work, j, lambda, out->force);
    for (int d = 0; d < dim; ++d) {
        const double G = slide_state->by_point[(dim - 1) * dim + d]; /* along the tangent */
        out->residual[d] = slide_state->C[d];
        pull += G * out->force[d];
        square += G * G;
    }
    if (square > 0.0) out->traction = pull / sqrt(square);
    if (slide->drive >= 0 && fu_slide_flags_of(model, state, j)->mode == FU_LOCKED)
        out->traction = -lambda[rows->first + dim - 1] - slide_state->driven_R;
    add_force_of_frame(model, work, j, lambda, out->force);
}

/* Returns the force of joints whose frame follows a slide in the balance along its cable. */
static double of_frame(const fu_model *model, const fu_state *state, int j)
{
    double sum = 0.0;
    FU_EACH_COUPLING(c, model->couplings, model->n_couplings) {
        if (c->type != &fu_joint_type) continue;
        const fu_joint *joint = (const fu_joint *)c;
        if (joint->attachments[0].slide != j && joint->attachments[1].slide != j) continue;
        fu_joint_rows_at at;
        fu_joint_equations(model, joint, state, &at);
        for (int e = 0; e < 2; ++e)
            for (int r = 0; r < joint->kernel->rows && joint->attachments[e].slide == j; ++r)
                if (!(joint->redundant_rows >> r & 1))
                    sum += at.J[e][(r + 1) * at.n[e] - 1] * state->forces[joint->base.force + r];
    }
    return sum;
}

/* Computes the outputs of a slide in equilibrium, with its force along the axes of the ground. */
static void outputs_at_rest(const fu_model *model, const fu_state *state, int j, fu_slide_output *out)
{
    const fu_slide *slide = &model->slides[j];
    const double *force = state->forces + slide->base.force;
    const int dim = model->dim, mode = fu_slide_flags_of(model, state, j)->mode;
    double phi[3], g[FU_SLIDE_COORDINATES + 1], A_t[9];
    int at[FU_SLIDE_COORDINATES + 1];
    *out = (fu_slide_output){0};
    if (mode == FU_LEFT) return;
    fu_slide_residual(model, state, j, phi, g);
    const double stretch = fu_slide_frame(model, state, j, A_t);
    for (int d = 0; d < dim; ++d) {
        out->force[d] = force[d];
        out->residual[d] = phi[d];
        for (int c = 0; c < dim - 1; ++c) out->multiplier[c] += A_t[d * dim + 1 + c] * force[d];
    }
    out->traction = g[fu_slide_coordinates(model, state, j, at)] + of_frame(model, state, j);
    if (slide->drive < 0) out->traction /= stretch; /* of a drive: the power over the rate of s */
}

/* work: null in equilibrium. */
static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    if (work == 0) outputs_at_rest(model, state, coupling->index, (fu_slide_output *)out);
    else fu_slide_outputs(model, state, coupling->index, acceleration, work, (fu_slide_output *)out);
}

/* A rigid body is placed on its cable in the drawing; s of a slide that is not locked follows. */
static int may_be_open(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const int locked = fu_slide_flags_of(model, state, coupling->index)->mode == FU_LOCKED;
    return locked || !((const fu_slide *)coupling)->rider_is_rigid;
}

/* Solves C_l = 0 for s, eq 21. */
static int solve(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    const int j = coupling->index;
    return fu_slide_flags_of(model, state, j)->mode != FU_LEFT && fu_find_arc_length(model, state, j, &state->s[j]);
}

static void reset(const fu_coupling *coupling, fu_state *state)
{
    const fu_slide *slide = (const fu_slide *)coupling;
    fu_slide_numbers *numbers = (fu_slide_numbers *)(state->numbers + coupling->numbers);
    fu_slide_flags *flags = (fu_slide_flags *)(state->flags + coupling->flags);
    *flags = (fu_slide_flags){.mode = slide->drive >= 0 ? FU_LOCKED : FU_SLIDES};
    *numbers = (fu_slide_numbers){0};
    memcpy(numbers->director, slide->director, sizeof numbers->director);
    state->s[coupling->coordinate] = slide->start_s;
    state->segment[coupling->coordinate] = slide->start_segment;
}

static int in_range(int value, int least, int most)
{
    return value >= least && value <= most;
}

/* Returns whether a slide permits its mode: only then is there a multiplier that locks it. */
static int is_possible_mode(const fu_slide *slide, int mode)
{
    const int kinds[2] = {slide->stops[0].kind, slide->stops[1].kind};
    if (mode == FU_LEFT) return kinds[0] == FU_END_IS_OPEN || kinds[1] == FU_END_IS_OPEN;
    if (slide->drive >= 0) return mode == FU_LOCKED;
    if (mode == FU_LOCKED) return slide->sticks || kinds[0] == FU_END_IS_HARD || kinds[1] == FU_END_IS_HARD;
    return mode == FU_SLIDES;
}

static int is_possible(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_slide *slide = (const fu_slide *)coupling;
    const int j = coupling->index;
    const fu_slide_flags *flags = fu_slide_flags_of(model, state, j);
    return in_range(state->segment[j], 0, fu_slide_elements(model, j) - 1) && is_possible_mode(slide, flags->mode) &&
           in_range(flags->slip_direction, -1, 1) && in_range(flags->contact, -1, 1);
}

static const char *excess(const fu_coupling *coupling)
{
    return ((const fu_slide *)coupling)->kernel->coordinates >= FU_MAX_COORDINATES ? "coordinates of its kernels" : 0;
}

static const char *const role[] = {"slide", 0}, *const resistance_role[] = {"resistance", 0};

#define OF_STOPS(name, member, kind, words)                                                                            \
    {name, kind, offsetof(fu_slide, stops[0].member), 2, sizeof(fu_end_stop), words}

static const fu_field fields[] = {
    FU_FIELD(fu_slide, kernel, FU_KERNELS, role),
    FU_FIELD(fu_slide, cable, FU_INTEGER, 0),
    FU_SPAN_FIELDS(fu_slide, on),
    FU_FIELD(fu_slide, rider, FU_ATTACHMENT, 0),
    FU_FIELD(fu_slide, rider_is_rigid, FU_INTEGER, 0),
    FU_FIELD(fu_slide, drive, FU_INTEGER, 0),
    FU_FIELD(fu_slide, carries_director, FU_INTEGER, 0),
    FU_FIELD(fu_slide, resistance, FU_KERNELS, resistance_role),
    FU_FIELD(fu_slide, sticks, FU_INTEGER, 0),
    FU_FIELD(fu_slide, friction, FU_REAL, 0),
    FU_FIELD(fu_slide, static_friction, FU_REAL, 0),
    FU_FIELD(fu_slide, viscous, FU_REAL, 0),
    FU_FIELD(fu_slide, velocity, FU_REAL, 0),
    FU_FIELD(fu_slide, friction_scale, FU_INTEGER, 0),
    OF_STOPS("stop_kinds", kind, FU_WORD, fu_end_stop_kinds),
    OF_STOPS("restitutions", restitution, FU_REAL, 0),
    OF_STOPS("buffer_lengths", length, FU_REAL, 0),
    OF_STOPS("buffer_stiffnesses", stiffness, FU_REAL, 0),
    OF_STOPS("buffer_dampings", damping, FU_REAL, 0),
    FU_FIELD_AS("s", fu_slide, start_s, FU_REAL),
    FU_FIELD_ARRAY(fu_slide, director, FU_REAL),
    FU_FIELD_AS("element", fu_slide, start_segment, FU_INTEGER),
    {0},
};

static const fu_reaction_operations reaction = {.update = fu_resistance_update, .accept = fu_resistance_accept};
static const fu_error_operations errors = {.friction = fu_resistance_friction_error};
static const fu_start_operations start = {
    .excess = excess, .reset = reset, .may_be_open = may_be_open, .is_possible = is_possible};
static const fu_coordinate_operations coordinates = {.rates = rates, .solve = solve};
static const fu_history_operations history = {.update = fu_update_director};

static const fu_output output_fields[] = {
    FU_OUTPUT(fu_slide_output, s_rate, "m/s", NULL),
    FU_OUTPUT(fu_slide_output, s_acceleration, "m/s2", NULL),
    FU_OUTPUT(fu_slide_output, force, "N", "direction"),
    FU_OUTPUT(fu_slide_output, multiplier, "N", NULL),
    FU_OUTPUT(fu_slide_output, traction, "N", NULL),
    FU_OUTPUT(fu_slide_output, residual, "m", "direction"),
    FU_LAST_OUTPUT(fu_slide_output),
};

const fu_coupling_type fu_slide_type = {
    .name = "slide",
    .size = sizeof(fu_slide),
    .fields = fields,
    .output_fields = output_fields,
    .n_numbers = (int)(sizeof(fu_slide_numbers) / sizeof(double)),
    .n_flags = (int)(sizeof(fu_slide_flags) / sizeof(int)),
    .n_scratch = (int)FU_DOUBLES(1, fu_slide_state),
    .residual = residual,
    .tangent = tangent,
    .step_residual = fu_slide_over_step,
    .step_tangent = fu_slide_over_step_tangent,
    .rows = rows,
    .take_forces = take_forces,
    .outputs = outputs,
    .energy = fu_buffer_energy,
    .dissipation = fu_resistance_dissipation,
    .lost_in_step = fu_lost_in_buffers,
    .detect = fu_detect_buffers,
    .reaction = &reaction,
    .coordinates = &coordinates,
    .history = &history,
    .errors = &errors,
    .start = &start,
};
