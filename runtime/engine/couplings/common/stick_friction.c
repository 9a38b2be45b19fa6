/* Sticking friction beside a penalty force: of contact with surfaces and of crossings.
 *
 * A spring is stretched by the displacement along the contact, and slides where its stretch exceeds the bound b of
 * friction. Along one direction, with the stretch a(x) as without sliding since the beginning of a step, the stretch
 * at its end is
 *     a(1) + min(0, min over x of b(x) - a(x)),
 * and likewise for sliding backwards. If it slides until the end of the step the minimum is at the end: the spring
 * then has the length of the friction limit. If it slid within the step and then sticks, the minimum is at the
 * transition. With the cubics through positions and velocities at both ends of the step that error is of the fourth
 * order in the step; by the ends alone it is of the second. */
#include "base/common.h"
#include "couplings/common/stick_friction.h"

#include <math.h>
#include <string.h>

/* parts of a step at whose ends the margin to the bound is evaluated, for the cubic through it */
#define BOUND_SAMPLES 3
#define REFINEMENTS 2 /* of the position of the least margin */
#define WORK_PARTS 8  /* of a step: intervals of the sum of friction's work */

int fu_limit_stretch(int dim, double stiffness, double most, double *stretch)
{
    const double size = stiffness * sqrt(fu_dot(dim, stretch, stretch));
    if (!(size > most)) return 0;
    for (int d = 0; d < dim; ++d) stretch[d] *= most / size;
    return 1;
}

/* Returns the position of the minimum of the cubic through values at equal distances on [0, 1], or 1. */
static double least_of(const double g[BOUND_SAMPLES + 1])
{
    const double a = 0.5 * (-11.0 * g[0] + 18.0 * g[1] - 9.0 * g[2] + 2.0 * g[3]);
    const double b = 0.5 * (18.0 * g[0] - 45.0 * g[1] + 36.0 * g[2] - 9.0 * g[3]);
    const double c = 0.5 * (-9.0 * g[0] + 27.0 * g[1] - 27.0 * g[2] + 9.0 * g[3]);
    const double square = b * b - 3.0 * a * c, below = b + sqrt(fmax(square, 0.0)), x = -a / below;
    if (!(square > 0.0) || !(below != 0.0) || !(x > 0.0 && x < 1.0)) return 1.0;
    return g[0] + x * (a + x * (b + x * c)) < g[BOUND_SAMPLES] ? x : 1.0;
}

double fu_bound_within(const fu_friction_path *path, double x)
{
    const double depth = fu_value_within(&path->depth, path->h, x);
    return depth > 0.0 ? path->bound(path->of, depth, fu_rate_within(&path->depth, path->h, x)) : 0.0;
}

/* Returns the bound at a part of the step, m, and computes the stretch as without sliding. */
static double bound_at(const fu_friction_path *path, double x, double *stretch)
{
    *stretch = fu_value_within(&path->stretch, path->h, x);
    return fu_bound_within(path, x) / path->stiffness;
}

static double room_at(const fu_friction_path *path, double x, int side)
{
    double stretch;
    const double bound = bound_at(path, x, &stretch);
    return bound - side * stretch;
}

/* Returns the least margin to a side near x, refined by parabolas. */
static double least_room(const fu_friction_path *path, int side, double *x)
{
    double width = 0.1 * (1.0 - path->from), least = room_at(path, *x, side);
    for (int i = 0; i < REFINEMENTS; ++i) {
        const double low = fmax(*x - width, path->from), high = fmin(*x + width, 1.0);
        const double g[3] = {room_at(path, low, side), least, room_at(path, high, side)};
        const double left = (g[1] - g[0]) / (*x - low), right = (g[2] - g[1]) / (high - *x);
        if (!(right > left)) break;
        const double next = fmin(fmax(0.5 * (low + *x) - left * 0.5 * (high - low) / (right - left), low), high);
        const double value = room_at(path, next, side);
        if (!(value < least)) break;
        *x = next;
        least = value;
        width *= 0.1;
    }
    return least;
}

/* Returns the stretch at the end of a path in time. */
static fu_friction_end end_of(const fu_friction_path *path)
{
    const double all = path->stretch.value[1];
    double room[2][BOUND_SAMPLES + 1], bound = 0.0;
    fu_friction_end end = {all, 1.0, 0};
    for (int i = 0; i <= BOUND_SAMPLES; ++i) {
        double stretch;
        bound =
            bound_at(path, i == BOUND_SAMPLES ? 1.0 : path->from + (1.0 - path->from) * i / BOUND_SAMPLES, &stretch);
        room[0][i] = bound - stretch;
        room[1][i] = bound + stretch;
    }
    for (int k = 0; k < 2; ++k) {
        const int side = k ? -1 : 1;
        double part = least_of(room[k]), least = room[k][BOUND_SAMPLES];
        if (part < 1.0) {
            part = path->from + (1.0 - path->from) * part;
            least = least_room(path, side, &part);
        }
        if (least < 0.0 && side * (all + side * least) < side * end.stretch)
            end = (fu_friction_end){all + side * least, part, side};
    }
    if (fabs(end.stretch) > bound)
        end = (fu_friction_end){copysign(bound, end.stretch), 1.0, end.stretch > 0.0 ? 1 : -1};
    return end;
}

fu_friction_end fu_end_of_friction(const fu_friction_path *path, double most)
{
    const double size = path->stretch.value[1];
    return path->h > 0.0 ? end_of(path) : (fu_friction_end){fmin(size, most), 1.0, size > most};
}

/* Returns the cubic of values from the beginning of a step to a part of it. */
static fu_step_ends first_part(const fu_step_ends *ends, double h, double x)
{
    return (fu_step_ends){{ends->value[0], fu_value_within(ends, h, x)}, {ends->rate[0], fu_rate_within(ends, h, x)}};
}

double fu_friction_within(const fu_friction_path *path, double x)
{
    if (!(x > path->from)) return 0.0;
    fu_friction_path part = *path;
    part.stretch = first_part(&path->stretch, path->h, x);
    part.depth = first_part(&path->depth, path->h, x);
    part.h = x * path->h;
    part.from = path->from / x;
    return end_of(&part).stretch;
}

double fu_path_along(int dim, const double *change, const double *rate, const double *rate_next, double along[3],
                     fu_friction_path *path)
{
    const double size = sqrt(fu_dot(dim, along, along));
    for (int d = 0; d < dim && size > 0.0; ++d) along[d] /= size;
    path->stretch = (fu_step_ends){{size - fu_dot(dim, along, change), size},
                                   {fu_dot(dim, along, rate), fu_dot(dim, along, rate_next)}};
    return size;
}

/* Returns the work over the stiffness, m^2, summed over equal parts of the step. */
static double taken(int dim, const fu_friction_travel *travel, const fu_friction_path *path, const double *end,
                    int parts)
{
    double sum = 0.0, stretch[3], last[3] = {0.0};
    memcpy(stretch, travel->stretch, sizeof stretch);
    for (int i = 1; i <= parts; ++i) {
        const double x = (double)i / parts;
        double next[3], unused, without[3];
        for (int d = 0; d < dim; ++d) {
            const fu_step_ends ends = {{0.0, travel->change[d]}, {travel->rates[0][d], travel->rates[1][d]}};
            const double place = fu_value_within(&ends, path->h, x);
            next[d] = without[d] = stretch[d] + place - last[d];
            last[d] = place;
        }
        fu_limit_stretch(dim, 1.0, bound_at(path, x, &unused), next);
        for (int d = 0; d < dim; ++d) {
            sum += 0.5 * (stretch[d] + next[d]) * (without[d] - next[d]);
            stretch[d] = next[d];
        }
    }
    return sum + 0.5 * (fu_dot(dim, stretch, stretch) - fu_dot(dim, end, end));
}

double fu_dissipated_by_friction(int dim, const fu_friction_travel *travel, const fu_friction_path *path,
                                 const double *end, int by_ends)
{
    if (by_ends) return taken(dim, travel, path, end, 1);
    return (4.0 * taken(dim, travel, path, end, WORK_PARTS) - taken(dim, travel, path, end, WORK_PARTS / 2)) / 3.0;
}
