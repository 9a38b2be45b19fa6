/* Boundaries between the segments of couplings' paths: couplings outside of their segments, and the times of
 * deferred events. */
#include "equations/run.h"
#include "events/events.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* of a segment: smaller distances beyond a boundary are rounding */
#define BOUNDARY_TOLERANCE 1e-11

/* Returns the permitted distance of a coordinate beyond its segment. */
double fu_boundary_tolerance(fu_path path)
{
    return BOUNDARY_TOLERANCE * path.length;
}

/* Returns the start of the k-th segment of a path, the end of the one before. */
double fu_boundary(fu_path path, int k)
{
    return path.boundaries ? path.boundaries[k] : k * path.length;
}

/* Returns the length of the k-th segment of a path. */
double fu_path_segment_length(fu_path path, int k)
{
    return path.boundaries ? path.boundaries[k + 1] - path.boundaries[k] : path.length;
}

double fu_path_coordinate(fu_path path, const fu_coupling *coupling, const fu_state *state)
{
    return (state->s[coupling->coordinate] - path.origin) / path.unit;
}

double fu_path_rate(fu_path path, const fu_run *run, const fu_coupling *c, const fu_state *state)
{
    const double rate = c->events->path->rate(run->model, c, state);
    return (rate - path.origin_rate - path.unit_rate * fu_path_coordinate(path, c, state)) / path.unit;
}

static int segment_of(const fu_coupling *coupling, const fu_state *state)
{
    return state->segment[coupling->coordinate];
}

/* Returns the distance of a coupling's coordinate outside its segment, negative inside, and the nearer side. */
double fu_outside(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int *side)
{
    const fu_path path = fu_path_of(model, coupling, state);
    const double length = fu_path_segment_length(path, segment_of(coupling, state));
    const double x = fu_path_coordinate(path, coupling, state) - fu_boundary(path, segment_of(coupling, state));
    *side = x > 0.5 * length ? 1 : -1;
    return *side > 0 ? x - length : -x;
}

/* Returns whether steps must end where a coupling passes a boundary, with any integrator. */
int fu_stop_at_boundaries(const fu_model *model)
{
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active) {
        const fu_coupling_events *events = c->events;
        if (events && events->path && events->path->stops_at_boundaries(model, c)) return 1;
    }
    return 0;
}

/* Assigns the couplings of `next` to the segments of their coordinates, unless they must keep those of `now`. The
 * matrix belongs to the segments with which it was computed. */
void fu_choose_path_segments(fu_run *run)
{
    const fu_model *model = run->model;
    if (run->keep_segments) return;
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active) {
        const fu_path path = fu_path_of(model, c, &run->next);
        int side, *segment = &run->next.segment[c->coordinate];
        if (!path.n || !(fu_outside(model, c, &run->next, &side) > fu_boundary_tolerance(path))) continue;
        const double s = fu_path_coordinate(path, c, &run->next);
        const double holds = path.boundaries ? fu_last_reached(path.boundaries, 0, path.n, s)
                                             : fmin(fmax(s / path.length, 0.0), path.n - 1.0);
        if ((int)holds != *segment) run->factored = 0;
        *segment = (int)holds;
    }
}

/* Assigns the couplings of a state to the segments of their coordinates, except those that are on one already, its ends
 * included. */
void fu_find_path_segments(const fu_model *model, fu_state *state)
{
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active) {
        const fu_path path = fu_path_of(model, c, state);
        const double s = path.n ? fu_path_coordinate(path, c, state) : 0.0;
        int *segment = &state->segment[c->coordinate];
        if (!path.n || (fu_boundary(path, *segment) <= s && s <= fu_boundary(path, *segment + 1))) continue;
        const double holds = path.boundaries
                                 ? fu_last_reached(path.boundaries, 0, path.n, s)
                                 : round((s - fmod(s, path.length)) / path.length); /* a quotient may be rounded up */
        *segment = (int)fmin(fmax(holds, 0.0), path.n - 1.0);
    }
}

/* Returns the number of boundaries that the couplings have passed at `next`. */
int fu_count_changes(const fu_run *run)
{
    int count = 0;
    for (int i = 0; i < run->model->n_coordinates; ++i) count += abs(run->next.segment[i] - run->now.segment[i]);
    return count;
}

/* Assigns the couplings of `next` to their segments of `now`. */
void fu_restore_path_segments(fu_run *run)
{
    memcpy(run->next.segment, run->now.segment, sizeof(int) * (size_t)run->model->n_coordinates);
}

/* Returns the time until the first coupling reaches a boundary of its segment at its present rate, s. */
double fu_time_to_boundary(const fu_run *run)
{
    double least = INFINITY;
    FU_EACH_COUPLING(c, run->model->always_active, run->model->n_always_active) {
        const fu_path path = fu_path_of(run->model, c, &run->now);
        if (!path.n) continue;
        const double rate = run->path_rate[c->coordinate] = fu_path_rate(path, run, c, &run->now);
        const double end = fu_boundary(path, segment_of(c, &run->now) + (rate > 0.0));
        const double distance = fabs(end - fu_path_coordinate(path, c, &run->now));
        if (distance > fu_boundary_tolerance(path)) least = fmin(least, distance / fabs(rate));
    }
    return least;
}

/* Returns the part of a step after which the coordinate of a coupling turns back beyond a boundary, by the parabola
 * through both ends of the step; 0 if it does not. At `next` the coordinate is within its segment again, or beyond the
 * boundary on which it stood at `now`. */
static double part_to_turn(const fu_run *run, const fu_coupling *c, fu_path path, double h)
{
    const fu_path next = fu_path_of(run->model, c, &run->next);
    const double rise = h * run->path_rate[c->coordinate], tolerance = fu_boundary_tolerance(path);
    const double moved = fu_path_coordinate(next, c, &run->next) - fu_path_coordinate(path, c, &run->now);
    const double part = 0.5 * rise / (rise - moved), s = fu_path_coordinate(path, c, &run->now);
    const int up = rise > 0.0, segment = segment_of(c, &run->now);
    const double ahead = fabs(fu_boundary(path, segment + up) - s), behind = fabs(fu_boundary(path, segment + !up) - s);
    const double forward = (up ? 1.0 : -1.0) * moved;
    const int returns = 0.5 * fabs(rise) * part > ahead + tolerance && forward < ahead;
    const int leaves = behind <= tolerance && forward < -behind - tolerance;
    return part > 0.0 && part < 1.0 && (returns || leaves) ? part : 0.0;
}

/* Returns the time after `now` of the first such reversal of all couplings, s; 0 for none. fu_time_to_boundary has
 * computed their rates at `now`. */
double fu_time_of_turn(const fu_run *run, double h)
{
    FU_EACH_COUPLING(c, run->model->always_active, run->model->n_always_active) {
        const fu_path path = fu_path_of(run->model, c, &run->now);
        const double part = path.n ? part_to_turn(run, c, path, h) : 0.0;
        if (part > 0.0) return part * h;
    }
    return 0.0;
}

/* Returns whether a coupling is on the boundary at `now`: its segment then changes without a step. */
int fu_stands_on_boundary(const fu_run *run, fu_event event)
{
    if (event.kind != FU_PATH_BOUNDARY) return 0;
    const fu_coupling *c = run->model->couplings[event.which];
    const double tolerance = fu_boundary_tolerance(fu_path_of(run->model, c, &run->now));
    int side;
    return fu_outside(run->model, c, &run->now, &side) >= -tolerance && side == event.side;
}

/* Returns whether all couplings are within this part of a segment of their segments. */
int fu_are_on_path_segments(const fu_model *model, const fu_state *state, double aside)
{
    FU_EACH_COUPLING(c, model->always_active, model->n_always_active) {
        const fu_path path = fu_path_of(model, c, state);
        if (!path.n) continue;
        const double x = fu_path_coordinate(path, c, state) - fu_boundary(path, segment_of(c, state));
        const double length = fu_path_segment_length(path, segment_of(c, state));
        if (!(x >= -aside * length && x <= (1.0 + aside) * length)) return 0;
    }
    return 1;
}
