/* Ropes that leave what they run over: a run ends there, as the equations do not hold beyond, but where a rope may
 * leave a sheave and touch it again. The reasons are the wrap angle, the normal force, in space the fleet angle of a
 * short span, the length of a span, a material point of a span that something holds to and that reaches its first or
 * its last end, and the length of the rope on a drum. */
#include "couplings/common/coupling_events.h"
#include "couplings/rope/rope.h"
#include "equations/equations.h"
#include "equations/run.h"
#include "events/wrap_points.h"

/* Event functions, the first of which have the numbers of their reasons. */
enum { WRAP = FU_LEFT_BY_WRAP, PRESSURE = FU_LEFT_BY_PRESSURE, FLEET = FU_LEFT_BY_FLEET, GROWTH };

static int list(int n, fu_event_function *out)
{
    for (int k = 0; out && k < n; ++k) out[k] = (fu_event_function){.which = k, .direction = -1};
    return n;
}

static void add(int which, int *n, fu_event_function *out)
{
    if (out) out[*n] = (fu_event_function){.which = which, .direction = -1};
    ++*n;
}

static int functions(const fu_coupling *coupling, fu_event_function *out)
{
    int n = list(FLEET, out);
    if (fu_is_in_space(coupling)) add(FLEET, &n, out);
    if (fu_wrap_may_leave(coupling)) add(GROWTH, &n, out);
    return n;
}

static double value(const fu_run *run, const fu_coupling *coupling, const fu_state *state, int which)
{
    if (which == FLEET) return fu_fleet_margin(run->model, coupling, state);
    if (which == PRESSURE) return fu_wrap_pressure(run->model, coupling, state);
    const int may_change = !run->integrator->keeps_energy;
    if (which == WRAP) return fu_wrap_margin(run->model, coupling, state, may_change);
    return may_change ? fu_wrap_growth_margin(run->model, coupling, state) : 1.0;
}

/* Changes the conditions of a sheave that a rope leaves or touches. The error of the step is projected away before.
 * What the rope then loses is the kinetic energy of the jump of its velocities: waves shorter than its elements; in
 * space also the elastic energy of what the groove turns or moves along its axis. */
static int pass(fu_run *run, const fu_coupling *coupling, int grows, const char **what)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    const int had_left = fu_wrap_has_left(coupling, now);
    if (fu_project_velocities(model, now, &run->accelerator, run->work)) return FU_SINGULAR;
    for (int i = 0; i < model->n_dof; ++i) now->v[i] += run->work[i];
    const int has_left = fu_wrap_change(model, coupling, now, grows);
    *what = has_left ? "left the sheave" : had_left ? "touched the sheave" : "";
    const double stored = fu_elastic_energy(model, now);
    fu_change_points(run, coupling);
    if (fu_close(run)) return FU_NO_CONVERGENCE;
    if (fu_is_in_space(coupling)) run->dissipated += stored - fu_elastic_energy(model, now);
    if (fu_project_velocities(model, now, &run->accelerator, run->work)) return FU_SINGULAR;
    fu_impact(run, run->work, 0.0);
    return fu_settle_points(run);
}

static int act(fu_run *run, const fu_coupling *coupling, int which, int side, const char **what)
{
    (void)side;
    if ((which == WRAP || which == GROWTH) && fu_wrap_may_leave(coupling) && !run->integrator->keeps_energy) {
        const int returns = fu_wrap_has_left(coupling, &run->now);
        if (which == GROWTH || !fu_wrap_is_beside(run->model, coupling, &run->now))
            return pass(run, coupling, which == GROWTH, what);
        *what = returns ? "passed beside the groove" : "left the groove along the axis";
        return fu_leave(run, coupling, returns ? FU_LEFT_BESIDE : FU_LEFT_BY_KINK);
    }
    *what = which == WRAP ? "left the sheave" : which == PRESSURE ? "lifted off" : "left the groove";
    return fu_leave(run, coupling, which);
}

/* Margins are positive again after a change of the sheave's conditions. */
static int sign(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int which)
{
    (void)model, (void)coupling, (void)state, (void)which;
    return 1;
}

/* Ends a run at its start where the event has happened before; of sheaves, spans and drums. */
static int begin(fu_run *run, const fu_coupling *coupling)
{
    const fu_coupling_events *events = coupling->events;
    fu_event_function of[GROWTH + 1];
    const int n = events->functions(coupling, of);
    const char *what;
    for (int k = 0; k < n; ++k)
        if (events->value(run, coupling, &run->now, of[k].which) < 0.0)
            return events->act(run, coupling, of[k].which, -1, &what);
    return FU_RUNNING;
}

/* The same of a sheave; a method that conserves energy ends at a wrap that does not stretch, too. */
static int begin_sheave(fu_run *run, const fu_coupling *coupling)
{
    const int wrapped = fu_wrap_stretches(coupling, &run->now);
    return run->integrator->keeps_energy && !wrapped ? fu_leave(run, coupling, WRAP) : begin(run, coupling);
}

const fu_coupling_events fu_sheave_events = {
    .functions = functions, .value = value, .sign = sign, .act = act, .begin = begin_sheave};

static double margin(const fu_run *run, const fu_coupling *coupling, const fu_state *state, int which)
{
    return which ? fu_grip_margin(coupling, state, which - 1) : fu_span_margin(run->model, coupling, state);
}

static int vanish(fu_run *run, const fu_coupling *coupling, int which, int side, const char **what)
{
    (void)side;
    *what = which ? "brought what holds to it to an end" : "became too short";
    return fu_leave(run, coupling, which ? FU_LEFT_BY_GRIP + which - 1 : FU_LEFT_BY_SPAN);
}

static int functions_of_span(const fu_coupling *coupling, fu_event_function *out)
{
    return list(fu_is_gripped(coupling) ? 3 : 1, out);
}

const fu_coupling_events fu_span_events = {
    .functions = functions_of_span, .value = margin, .act = vanish, .begin = begin};

static double value_of_drum(const fu_run *run, const fu_coupling *coupling, const fu_state *state, int which)
{
    if (which == FLEET) return fu_drum_fleet_margin(run->model, coupling, state);
    return which == WRAP ? fu_drum_margin(run->model, coupling, state) : fu_drum_pressure(run->model, coupling, state);
}

static int functions_of_drum(const fu_coupling *coupling, fu_event_function *out)
{
    return list(fu_drum_is_in_space(coupling) ? FLEET + 1 : FLEET, out);
}

/* Frees the end of a rope whose drum is empty. Its material keeps its velocity, while the node there no longer flows
 * along it; what is lost is the kinetic energy of the jump, see `pass`. */
static int release(fu_run *run, const fu_coupling *coupling)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    fu_drum_leave(model, coupling, now);
    if (fu_close(run)) return FU_NO_CONVERGENCE;
    if (fu_project_velocities(model, now, &run->accelerator, run->work)) return FU_SINGULAR;
    fu_impact(run, run->work, 0.0);
    return FU_RUNNING;
}

static int act_of_drum(fu_run *run, const fu_coupling *coupling, int which, int side, const char **what)
{
    (void)side;
    if (which == WRAP && fu_drum_leaves(coupling)) {
        *what = "left the drum";
        return release(run, coupling);
    }
    *what = which == WRAP ? "ran empty" : which == PRESSURE ? "lifted off" : "left the groove";
    return fu_leave(run, coupling, which == WRAP ? FU_LEFT_BY_EMPTY : which);
}

const fu_coupling_events fu_drum_events = {
    .functions = functions_of_drum, .value = value_of_drum, .sign = sign, .act = act_of_drum, .begin = begin};
