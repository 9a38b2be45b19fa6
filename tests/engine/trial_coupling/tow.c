/* A tow: a spring of no length from an attachment to a point that moves at a constant velocity. It breaks at a force.
 * The flag of a state: whether it has; the number: what it stored then, J.
 */
#include "events/tow.h"
#include "bodies/unknowns.h"
#include "couplings/common/attachments.h"
#include "equations/run.h"

#include <math.h>

typedef struct {
    fu_coupling base;
    fu_attachment attachments[1];
    double start[3], velocity[3], stiffness, strength;
} fu_tow;

typedef struct {
    double force[3], position[3], stretch; /* on the attachment; of the moving point; their distance */
} fu_tow_output;

static const fu_tow *tow_of(const fu_coupling *coupling)
{
    return (const fu_tow *)coupling;
}

/* Makes how the attachment moves and, of a tow that holds, the force on it; returns the distance to the moving point,
 * m. */
static double pull(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_attachment_state *at,
                   double f[3])
{
    const fu_tow *tow = tow_of(coupling);
    double square = 0.0;
    fu_attachment_at(model, &tow->attachments[0], state, 0.0, FU_POINT, at);
    for (int d = 0; d < 3; ++d) {
        const double way = tow->start[d] + tow->velocity[d] * state->t - at->p[d];
        square += way * way;
        f[d] = state->flags[coupling->flags] ? 0.0 : tow->stiffness * way;
    }
    return sqrt(square);
}

static void add(const fu_model *model, const fu_attachment_state *at, const double *force, double *f)
{
    for (int i = 0; i < at->n; ++i)
        for (int d = 0; d < model->dim; ++d) f[at->at[i]] -= at->P[d * at->n + i] * force[d];
}

static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    fu_attachment_state at;
    double on[3];
    pull(model, coupling, state, &at, on);
    add(model, &at, on, f);
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f, double *own)
{
    (void)own;
    force(model, coupling, at->next, f);
}

/* Makes the mean force over a step: what it does on the way of the attachment is the change of the energy, less the
 * work. */
static void mean_force(const fu_model *model, const fu_coupling *coupling, const fu_equations *at,
                       fu_attachment_state *on, double f[3])
{
    double now[3], next[3];
    pull(model, coupling, at->now, on, now);
    pull(model, coupling, at->next, on, next);
    for (int d = 0; d < 3; ++d) f[d] = 0.5 * (now[d] + next[d]);
}

static void step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                          double *own)
{
    fu_attachment_state on;
    double mean[3];
    (void)own;
    mean_force(model, coupling, at, &on, mean);
    add(model, &on, mean, f);
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    fu_attachment_state on;
    double f[3];
    pull(model, coupling, at->next, &on, f);
    if (at->next->flags[coupling->flags]) return;
    for (int i = 0; i < on.n; ++i)
        for (int j = 0; j < on.n; ++j) {
            double sum = 0.0;
            for (int d = 0; d < model->dim; ++d) sum += on.P[d * on.n + i] * on.P[d * on.n + j];
            if (sum != 0.0)
                fu_add(model, system, on.at[i], on.at[j], at->weights.stiffness * tow_of(coupling)->stiffness * sum);
        }
}

static double energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    fu_attachment_state at;
    double f[3];
    const double stretch = pull(model, coupling, state, &at, f);
    if (state->flags[coupling->flags]) return state->numbers[coupling->numbers];
    return 0.5 * tow_of(coupling)->stiffness * stretch * stretch;
}

static double power(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    fu_attachment_state at;
    double f[3], sum = 0.0;
    pull(model, coupling, state, &at, f);
    for (int d = 0; d < 3; ++d) sum += f[d] * tow_of(coupling)->velocity[d];
    return sum;
}

static double step_work(const fu_model *model, const fu_coupling *coupling, const fu_equations *at)
{
    fu_attachment_state on;
    double f[3], sum = 0.0;
    mean_force(model, coupling, at, &on, f);
    for (int d = 0; d < 3; ++d) sum += at->h * f[d] * tow_of(coupling)->velocity[d];
    return sum;
}

static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    fu_tow_output *numbers = (fu_tow_output *)out;
    fu_attachment_state at;
    (void)acceleration, (void)work;
    numbers->stretch = pull(model, coupling, state, &at, numbers->force);
    for (int d = 0; d < 3; ++d)
        numbers->position[d] = tow_of(coupling)->start[d] + tow_of(coupling)->velocity[d] * state->t;
}

static int watches(const fu_coupling *coupling, fu_event_function *out)
{
    (void)coupling;
    if (out) *out = (fu_event_function){.which = 0, .direction = 1};
    return 1;
}

static double watched(const fu_run *run, const fu_coupling *coupling, const fu_state *state, int which)
{
    fu_attachment_state at;
    double f[3];
    (void)which;
    if (run->now.flags[coupling->flags]) return -1.0;
    return tow_of(coupling)->stiffness * pull(run->model, coupling, state, &at, f) - tow_of(coupling)->strength;
}

static int act(fu_run *run, const fu_coupling *coupling, int which, int side, const char **what)
{
    (void)which, (void)side;
    run->now.numbers[coupling->numbers] = energy(run->model, coupling, &run->now);
    run->now.flags[coupling->flags] = 1;
    *what = "broke";
    return FU_RUNNING;
}

static int begin(fu_run *run, const fu_coupling *coupling)
{
    (void)run, (void)coupling;
    return FU_RUNNING;
}

static const fu_field fields[] = {
    FU_FIELD_ARRAY(fu_tow, attachments, FU_ATTACHMENT),
    FU_FIELD_ARRAY(fu_tow, start, FU_REAL),
    FU_FIELD_ARRAY(fu_tow, velocity, FU_REAL),
    FU_FIELD(fu_tow, stiffness, FU_REAL, 0),
    FU_FIELD(fu_tow, strength, FU_REAL, 0),
    {0},
};

static const fu_output output_fields[] = {
    FU_OUTPUT(fu_tow_output, force, "N", "direction"),
    FU_OUTPUT(fu_tow_output, position, "m", "point"),
    FU_OUTPUT(fu_tow_output, stretch, "m", NULL),
    FU_LAST_OUTPUT(fu_tow_output),
};

static const fu_supply_operations supply = {.power = power, .step_work = step_work};

const fu_coupling_type fu_tow_type = {.name = "tow",
                                      .size = sizeof(fu_tow),
                                      .fields = fields,
                                      .output_fields = output_fields,
                                      .n_numbers = 1,
                                      .n_flags = 1,
                                      .residual = residual,
                                      .tangent = tangent,
                                      .step_residual = step_residual,
                                      .step_tangent = tangent,
                                      .force = force,
                                      .outputs = outputs,
                                      .energy = energy,
                                      .supply = &supply};

const fu_coupling_events fu_tow_events = {.watches = watches, .watched = watched, .act = act, .begin = begin};
