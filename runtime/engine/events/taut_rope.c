/* Ropes without mass: a rope becomes slack or taut; a wrap leaves and returns, which changes its geometry alone, but in
 * space it may leave with a kink along the axis, and becomes shorter; a rope breaks loose on a sheave, where its
 * tensions differ by more than friction holds, and sticks where sliding stops. A run ends where a rope leaves a sheave
 * with friction, meets one from the other side or beside its groove, has run off a drum, or where a straight part
 * becomes too short. */
#include "couplings/common/coupling_events.h"
#include "couplings/taut_rope/taut_rope.h"
#include "equations/equations.h"
#include "equations/run.h"
#include "events/events.h"

#include <math.h>

#define MAX_CHANGES 1000       /* of points at one instant */
#define ROUNDING_OF_DEPTH 1e-9 /* of the radius: by which a straight line touches a groove again as it leaves it */

enum { OF_WRAP, OF_GRIP, OF_FLEET };
enum { OF_TENSION, OF_PARTS };

static const fu_taut_point *point_of(const fu_coupling *coupling)
{
    return (const fu_taut_point *)coupling;
}

static const fu_taut_rope *rope_of(const fu_coupling *coupling)
{
    return (const fu_taut_rope *)coupling;
}

static int list(int n, int direction, fu_event_function *out)
{
    for (int k = 0; out && k < n; ++k) out[k] = (fu_event_function){.which = k, .direction = direction};
    return n;
}

/* --- points ----------------------------------------------------------------------------------------------------- */

static int is_sheave(const fu_taut_point *point)
{
    return point->radius != 0.0 && point->ropes[0] >= 0 && point->ropes[1] >= 0;
}

static int holds(const fu_taut_point *point)
{
    return point->friction > 0.0;
}

static int can_act(const fu_coupling *coupling)
{
    return point_of(coupling)->radius != 0.0;
}

static int functions_of_point(const fu_coupling *coupling, fu_event_function *out)
{
    const fu_taut_point *point = point_of(coupling);
    if (!can_act(coupling)) return 0;
    if (point->in_space) return list(OF_FLEET + 1, 1, out);
    return list(is_sheave(point) && holds(point) ? OF_GRIP + 1 : OF_WRAP + 1, 1, out);
}

/* Of a rope that sticks by how much it does so too little; of one that slips the speed against its direction. A slack
 * one that slips does so until it is taut. */
static double value_of_grip(const fu_model *model, const fu_taut_point *point, const fu_state *state)
{
    const int slips = fu_taut_slips(point, state);
    if (!slips) return fu_taut_grip(model, point, state);
    return fu_is_taut(fu_taut_beside(model, point, 1), state) ? -slips * fu_taut_slip(model, point, state) : -1.0;
}

static double value_of_point(const fu_run *run, const fu_coupling *coupling, const fu_state *state, int which)
{
    const fu_taut_point *point = point_of(coupling);
    fu_taut_passage at;
    if (which == OF_GRIP) return is_sheave(point) && holds(point) ? value_of_grip(run->model, point, state) : -1.0;
    if (which == OF_FLEET) return -fu_taut_fleet_margin(run->model, point, state);
    if (!is_sheave(point)) return -fu_taut_store(run->model, point, state);
    if (fu_touches(point, state)) return fu_taut_wrap(run->model, point, state);
    fu_taut_pass(run->model, point, state, &at);
    return at.depth;
}

/* Lets a rope slip on a sheave. */
static void break_loose(fu_run *run, const fu_taut_point *point)
{
    fu_taut_set_slip(run->model, point, &run->now, fu_taut_pulled(run->model, point, &run->now));
    fu_taut_close(run->model, point, &run->now);
    fu_taut_find_taut(run->model, fu_taut_beside(run->model, point, 1), &run->now);
}

static int act_of_grip(fu_run *run, const fu_taut_point *point, const char **what)
{
    const int slips = fu_taut_slips(point, &run->now);
    *what = 0;
    if (!slips && fu_taut_is_held(run->model, point, &run->now)) { /* by another change */
        fu_restart_event_functions(run, point->base.number);
        return FU_RUNNING;
    }
    *what = slips ? "sticks" : "slips";
    if (slips) fu_taut_set_slip(run->model, point, &run->now, 0);
    else break_loose(run, point);
    return FU_RUNNING;
}

/* Lays a rope on a sheave that it passes. */
static int touch(fu_run *run, const fu_taut_point *point, const char **what)
{
    fu_taut_passage at;
    fu_taut_pass(run->model, point, &run->now, &at);
    if (at.side < 0) return fu_leave(run, &point->base, FU_LEFT_BY_SIDE);
    if (fabs(at.aside) > point->mouth) {
        *what = "passed beside the groove";
        return fu_leave(run, &point->base, FU_LEFT_BESIDE);
    }
    fu_taut_touch(point, &at, &run->now);
    *what = fu_taut_aside(point, at.aside) == 0.0 ? "returned" : "returned beside the middle of the groove";
    return FU_RUNNING;
}

/* Lets a rope leave a sheave as its wrap ends. With a kink along the axis it becomes shorter, and its straight line may
 * be in the groove at another place. Waves take the energy of that, which a rope without mass does not have. */
static int leave(fu_run *run, const fu_taut_point *point, const char **what)
{
    fu_taut_passage at;
    if (holds(point)) return fu_leave(run, &point->base, FU_LEFT_BY_WRAP);
    if (!point->in_space) {
        fu_taut_leave(point, &run->now);
        return FU_RUNNING;
    }
    if (fu_taut_kink(run->model, point, &run->now) > point->kink) {
        *what = "left the groove along the axis";
        return fu_leave(run, &point->base, FU_LEFT_BY_KINK);
    }
    const double stored = fu_elastic_energy(run->model, &run->now);
    int status = FU_RUNNING;
    fu_taut_leave(point, &run->now);
    fu_taut_pass(run->model, point, &run->now, &at);
    if (at.depth > ROUNDING_OF_DEPTH * fabs(point->radius)) {
        status = touch(run, point, what);
        if (status == FU_RUNNING) *what = "moved along the groove";
    }
    fu_taut_recount(run->model, point, &run->now);
    run->dissipated += stored - fu_elastic_energy(run->model, &run->now);
    return status;
}

static int act_of_point(fu_run *run, const fu_coupling *coupling, int which, int side, const char **what)
{
    const fu_taut_point *point = point_of(coupling);
    (void)side;
    if (which == OF_GRIP) return act_of_grip(run, point, what);
    if (which == OF_FLEET) {
        *what = "slides along the groove";
        return fu_leave(run, coupling, FU_LEFT_BY_FLEET);
    }
    const int touches = fu_touches(point, &run->now);
    *what = !is_sheave(point) ? "ran empty" : touches ? "left the sheave" : "returned";
    if (!is_sheave(point)) return fu_leave(run, coupling, FU_LEFT_BY_EMPTY);
    return touches ? leave(run, point, what) : touch(run, point, what);
}

static int begin_point(fu_run *run, const fu_coupling *coupling)
{
    const char *what;
    if (!can_act(coupling)) return FU_RUNNING;
    if (point_of(coupling)->in_space && value_of_point(run, coupling, &run->now, OF_FLEET) > 0.0)
        return fu_leave(run, coupling, FU_LEFT_BY_FLEET);
    if (value_of_point(run, coupling, &run->now, OF_WRAP) <= 0.0) return FU_RUNNING;
    const int status = act_of_point(run, coupling, OF_WRAP, 1, &what);
    const int is_aside = run->now.numbers[coupling->numbers + FU_ASIDE] != 0.0;
    return status == FU_RUNNING && is_aside ? fu_leave(run, coupling, FU_LEFT_BY_PLACE) : status;
}

const fu_coupling_events fu_taut_point_events = {.functions = functions_of_point,
                                                 .value = value_of_point,
                                                 .act = act_of_point,
                                                 .can_act = can_act,
                                                 .begin = begin_point};

/* --- ropes ------------------------------------------------------------------------------------------------------ */

static int functions_of_rope(const fu_coupling *coupling, fu_event_function *out)
{
    (void)coupling;
    return list(OF_PARTS + 1, 1, out);
}

static double value_of_rope(const fu_run *run, const fu_coupling *coupling, const fu_state *state, int which)
{
    if (which == OF_PARTS) return -fu_taut_margin(run->model, rope_of(coupling), state);
    const double slack = fu_taut_slack(run->model, rope_of(coupling), state);
    if (isnan(slack)) return -1.0; /* the first rope of a chain is slack with the others */
    return state->flags[coupling->flags] ? slack : -slack;
}

static int act_of_rope(fu_run *run, const fu_coupling *coupling, int which, int side, const char **what)
{
    int *taut = run->now.flags + coupling->flags;
    (void)side;
    *what = which == OF_PARTS ? "became too short" : *taut ? "became slack" : "taut again";
    if (which == OF_PARTS) return fu_leave(run, coupling, FU_LEFT_BY_SPAN);
    if (fu_taut_slides(run->model, rope_of(coupling), &run->now)) {
        fu_taut_set_taut(run->model, rope_of(coupling), &run->now, !*taut);
        if (*taut) fu_taut_redirect(run->model, rope_of(coupling), &run->now);
        return FU_RUNNING;
    }
    *taut = !*taut;
    return FU_RUNNING;
}

/* Returns whether a rope may start with other turns on a wheel than as drawn: it is longer or shorter by more than half
 * a turn around the smallest one. */
static int may_have_other_turns(const fu_run *run, const fu_taut_rope *rope)
{
    fu_taut_lengths now;
    double radius = INFINITY;
    for (int place = 0; place < rope->n_points; ++place) {
        const double here = fabs(fu_taut_point_of(run->model, rope, place)->radius);
        if (here > 0.0) radius = fmin(radius, here);
    }
    fu_taut_lengths_at(run->model, rope, &run->now, &now);
    const double change = now.length[FU_DRAWN] - now.free - (rope->drawn_length - rope->free_length);
    return fabs(change) > acos(-1.0) * radius;
}

/* Returns the sheave on which a rope sticks with the largest excess over what friction holds, null for none. */
static const fu_taut_point *loosest(const fu_run *run)
{
    const fu_taut_point *found = 0;
    double worst = 0.0;
    FU_EACH_COUPLING(c, run->model->couplings, run->model->n_couplings) {
        if (c->type != &fu_taut_point_type || !is_sheave(point_of(c)) || !holds(point_of(c))) continue;
        const double excess =
            fu_taut_slips(point_of(c), &run->now) ? 0.0 : fu_taut_grip(run->model, point_of(c), &run->now);
        if (excess > worst) worst = excess, found = point_of(c);
    }
    return found;
}

/* Lets ropes slip where friction does not hold them at the start. */
static int begin_slip(fu_run *run)
{
    const fu_taut_point *loose;
    for (int changes = 0; (loose = loosest(run)) != 0; ++changes) {
        if (changes == MAX_CHANGES) return FU_NO_CONVERGENCE;
        break_loose(run, loose);
    }
    return FU_RUNNING;
}

/* A rope without strain at the start is taut, to rounding. The last rope determines where all slip. */
static int begin_rope(fu_run *run, const fu_coupling *coupling)
{
    const fu_taut_rope *rope = rope_of(coupling);
    const double rounding = 1e-12;
    if (may_have_other_turns(run, rope)) return fu_leave(run, coupling, FU_LEFT_BY_TURNS);
    run->now.flags[coupling->flags] = fu_taut_slack(run->model, rope, &run->now) <= rounding * rope->free_length;
    if (fu_taut_margin(run->model, rope, &run->now) < 0.0) return fu_leave(run, coupling, FU_LEFT_BY_SPAN);
    const int next = coupling->number + 1;
    const int last = next == run->model->n_couplings || run->model->couplings[next]->type != coupling->type;
    return last ? begin_slip(run) : FU_RUNNING;
}

const fu_coupling_events fu_taut_rope_events = {
    .functions = functions_of_rope, .value = value_of_rope, .act = act_of_rope, .begin = begin_rope};
