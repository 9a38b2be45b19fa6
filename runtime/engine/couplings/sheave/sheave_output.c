/* Tensions of a rope at a sheave, its normal forces and margins, and numbers of results. */
#include "bodies/model.h"
#include "couplings/rope/rope.h"
#include "couplings/sheave/sheave.h"

#include <math.h>

typedef struct {
    double tension_on, tension_off, wrap_angle, force[3], material_speed, slip, slip_angle, normal_force, torque, angle,
        residual, fleet_angle_on, fleet_angle_off, gap;
} sheave_output;

/* Returns the stretch of the span at a tangent point, in the plane along the groove. */
static double stretch_along(const fu_sheave *sheave, const fu_sheave_state *at, int k, const double t[DIM])
{
    return is_in_space(sheave) ? at->slope[k][0] : fu_dot(DIM, t, at->slope[k]);
}

/* Returns the arm of a force along the groove over that of the tension, which in space leaves it at a fleet angle. */
static double arm_over_radius(const fu_sheave *sheave, const fu_sheave_state *at, int k)
{
    return is_in_space(sheave) ? sqrt(fu_dot(DIM, at->x[k], at->x[k])) / sheave->tangent_radius[k] : 1.0;
}

/* Computes the tension at both tangent points from the balance of momentum at the nodes, through which material passes,
 * along the groove in the sense of travel, with the accelerations of `at`; the speed of the material past the centre;
 * and all forces by y. sticking: friction at points to which the rope may stick. */
static void tensions(const fu_sheave *sheave, const fu_sheave_state *at, const double *multipliers,
                     const fu_wrap_force *sticking, double tension[ENDS], double speed[ENDS],
                     double phi[MAX_CONDITIONS], double y[Y])
{
    const fu_wheel *wheel = &sheave->wheel;
    fu_sheave_forces(sheave, at, y);
    fu_sheave_add_multipliers(sheave, at, multipliers, phi, y);
    for (int j = 0; j <= sheave->n_zones && sticks(sheave); ++j)
        fu_wrap_force_by_y(sheave, at, j, sticking[j].f, sticking[j].at.column, y);
    for (int k = 0; k < ENDS; ++k) {
        const double s_rate = at->s_rate[k ? sheave->n_zones : 0];
        const double t[DIM] = {-wheel->sense * sin(at->phi[k]), wheel->sense * cos(at->phi[k])};
        const double along = arm_over_radius(sheave, at, k) * fu_dot(DIM, t, y + k * NODE);
        speed[k] = fu_dot(DIM, t, at->x_rate[k]) - stretch_along(sheave, at, k, t) * s_rate;
        const double velocity = speed[k] + fu_dot(DIM, t, at->wheel.c_rate);
        tension[k] = (k ? along : -along) - wheel->rho * s_rate * velocity;
    }
}

/* Returns the stretch of a zone. */
static double stretch_of(const fu_sheave *sheave, const fu_zone *zone)
{
    return sheave->wheel.sense * sheave->wheel.radius * (zone->phi[1] - zone->phi[0]) / zone->l;
}

/* Returns the tension at an angle of a zone with this mean: it grows with the height, as on a smooth groove. */
static double tension_in(const fu_sheave *sheave, const fu_sheave_state *at, const fu_zone *of, double phi, double mean)
{
    const double half = 0.5 * (of->phi[1] - of->phi[0]), middle = 0.5 * (of->phi[0] + of->phi[1]);
    const double below = fu_wheel_outwards(&at->wheel, phi) - sin(half) / half * fu_wheel_outwards(&at->wheel, middle);
    return mean - sheave->wheel.rho * sheave->wheel.radius * below;
}

/* Returns the least normal force on an angle, N: of the zones at ends and middle, and of both tangent points with these
 * tensions. */
static double least_pressure(const fu_sheave *sheave, const fu_sheave_state *at, const double tension[ENDS],
                             const double speeds[ENDS])
{
    const fu_wheel *wheel = &sheave->wheel;
    double least = INFINITY;
    for (int k = 0; k < ENDS; ++k)
        least =
            fmin(least, fu_wheel_pressure(wheel, &at->wheel, at->phi[k], tension[k], speeds[k], fu_stretch_at(at, k)));
    for (int j = 0; fu_stretches(at->mode) && j < sheave->n_zones; ++j) {
        const fu_zone of = fu_zone_at(at, j);
        const double stretch = stretch_of(sheave, &of);
        const double inside = wheel->A[0] * (stretch - 1.0);
        for (int part = j ? 0 : 1; part < (j + 1 < sheave->n_zones ? 3 : 2); ++part) { /* its inner end, the middle */
            const double x = 0.5 * part, rate = (1.0 - x) * of.phi_rate[0] + x * of.phi_rate[1];
            const double flow = (1.0 - x) * of.s_rate[0] + x * of.s_rate[1];
            const double speed = wheel->sense * wheel->radius * rate - stretch * flow;
            const double phi = (1.0 - x) * of.phi[0] + x * of.phi[1];
            const double tension = tension_in(sheave, at, &of, phi, inside);
            least = fmin(least, fu_wheel_pressure(wheel, &at->wheel, phi, tension, speed, stretch));
        }
    }
    return least;
}

/* Returns the distance of the axis of a rope that has left from that of one in the groove, m. */
static double gap_of(const fu_sheave *sheave, const fu_sheave_state *at)
{
    return sqrt(fu_dot(DIM, at->x[0], at->x[0])) - sheave->tangent_radius[0];
}

double fu_wrap_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int may_change)
{
    const fu_sheave *sheave = sheave_of(coupling);
    fu_sheave_state at;
    fu_sheave_at(model, sheave, state, 0, &at);
    const double wrap = sheave->wheel.sense * (at.phi[1] - at.phi[0]);
    if (at.mode == FU_LIFTED) return gap_of(sheave, &at);
    if (at.mode == FU_SHORT) return wrap;
    return wrap - (at.mode == FU_CHORDED && may_change && fu_may_leave(sheave) ? FU_LEAST_CHORDED : sheave->least_wrap);
}

/* Returns the fleet angle at a tangent point, in space. */
static double fleet_angle(const fu_sheave *sheave, const fu_sheave_state *at, int k)
{
    const fu_foot foot = fu_foot_of(sheave, at, k);
    return fu_fleet_angle(&foot, at->q, at->wheel.axis);
}

/* Returns how far a tangent point across the slope is from one of which rest is a saddle of the energy, where its
 * element has the length 6 R tan^2 f at the fleet angle f, over 6 R; with a reserve
 * (derive/couplings/tangent_point.md). */
static double slope_margin(const fu_sheave *sheave, const fu_sheave_state *at, int k)
{
    const double reserve = 2.0, slant = tan(fleet_angle(sheave, at, k));
    const int *s = sheave->span_s + ENDS * k;
    const double share = k ? sheave->share_after[1] : 1.0 - sheave->share_before[sheave->span_elements[0] - 1];
    return share * (at->q[s[1]] - at->q[s[0]]) / (6.0 * sheave->wheel.radius) - reserve * slant * slant;
}

double fu_wrap_growth_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const double reserve = 2.0;
    fu_sheave_state at;
    fu_sheave_at(model, sheave, state, 0, &at);
    const double wrap = sheave->wheel.sense * (at.phi[1] - at.phi[0]);
    if (at.mode == FU_SHORT) return reserve * sheave->least_wrap - wrap;
    if (at.mode != FU_WRAPPED || !is_in_space(sheave)) return 1.0;
    return fmax(reserve * FU_LEAST_CHORDED - wrap, fmin(slope_margin(sheave, &at, 0), slope_margin(sheave, &at, 1)));
}

int fu_wrap_may_leave(const fu_coupling *coupling)
{
    return fu_may_leave(sheave_of(coupling));
}

int fu_wrap_stretches(const fu_coupling *coupling, const fu_state *state)
{
    return !fu_may_leave(sheave_of(coupling)) || fu_stretches(*fu_wrap_flag(sheave_of(coupling), state));
}

int fu_wrap_has_left(const fu_coupling *coupling, const fu_state *state)
{
    return *fu_wrap_flag(sheave_of(coupling), state) == FU_LIFTED;
}

int fu_wrap_is_beside_span(const fu_coupling *coupling, int s)
{
    const fu_sheave *sheave = sheave_of(coupling);
    return s == sheave->s[0] || s == sheave->s[sheave->n_zones];
}

int fu_wrap_change(const fu_model *model, const fu_coupling *coupling, fu_state *now, int grows)
{
    const fu_sheave *sheave = sheave_of(coupling);
    int *mode = fu_wrap_flag(sheave, now);
    if (*mode == FU_LIFTED && is_in_space(sheave)) {
        fu_sheave_state at;
        fu_sheave_at(model, sheave, now, 0, &at);
        fu_place_in(sheave, now)->aside = at.rise[0];
    }
    *mode += grows || *mode == FU_LIFTED ? 1 : -1;
    return *mode == FU_LIFTED;
}

int fu_wrap_is_beside(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_sheave *sheave = sheave_of(coupling);
    fu_sheave_state at;
    if (!is_in_space(sheave)) return 0;
    fu_sheave_at(model, sheave, state, 0, &at);
    if (at.mode == FU_LIFTED) return fabs(at.rise[0]) > sheave->mouth;
    return at.mode == FU_SHORT && fabs(fleet_angle(sheave, &at, 0) + fleet_angle(sheave, &at, 1)) > sheave->kink;
}

/* A span is a minimum of the energy R phi + l while its length along the groove is above R tan f: else the tangent
 * point runs away along the groove. The margin has a reserve. */
double fu_span_fleet_margin(double length, double radius, double fleet)
{
    const double reserve = 3.0;
    return length * cos(fleet) - reserve * radius * tan(fabs(fleet));
}

double fu_fleet_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_sheave *sheave = sheave_of(coupling);
    double least = INFINITY;
    fu_sheave_state at;
    fu_sheave_at(model, sheave, state, 0, &at);
    for (int k = 0; k < ENDS && at.mode != FU_LIFTED; ++k) {
        const double fleet = fleet_angle(sheave, &at, k);
        const double length = state->q[sheave->span_s[ENDS * k + 1]] - state->q[sheave->span_s[ENDS * k]];
        least = fmin(least, fu_span_fleet_margin(length, sheave->wheel.radius, fleet));
    }
    return least;
}

/* Computes the tensions at both tangent points from the stretch of the spans there, and the speeds of the material. */
static void elastic_tensions(const fu_sheave *sheave, const fu_sheave_state *at, double tension[ENDS],
                             double speed[ENDS])
{
    const fu_wheel *wheel = &sheave->wheel;
    for (int k = 0; k < ENDS; ++k) {
        const double t[DIM] = {-wheel->sense * sin(at->phi[k]), wheel->sense * cos(at->phi[k])};
        const double stretch = stretch_along(sheave, at, k, t);
        speed[k] = fu_dot(DIM, t, at->x_rate[k]) - stretch * at->s_rate[k ? sheave->n_zones : 0];
        tension[k] = wheel->A[0] * (stretch - 1.0);
    }
}

#define MOST_INERTIA 0.02 /* of half a zone over the tension; above it is that of a vibration */

/* Returns the mean acceleration of the material along the wrap, in the sense of travel: that of a point of a light rope
 * follows friction there at once. */
static double mean_acceleration(const fu_sheave *sheave, const fu_sheave_state *at)
{
    const fu_wheel *wheel = &sheave->wheel;
    const int n = sheave->n_zones;
    const double arm = wheel->sense * wheel->radius,
                 stretch = arm * (at->phi[1] - at->phi[0]) / wrap_length(sheave, at);
    double sum = 0.0;
    for (int j = 0; j <= n; ++j) sum += arm * at->angle_acc[j] - stretch * at->s_acc[j];
    return sum / (n + 1);
}

/* Returns friction at a point between zones, at most its limit: multipliers of short steps have little accuracy. */
static double friction_at(const fu_model *model, const fu_sheave *sheave, const fu_sheave_state *at,
                          const fu_state *state, int j)
{
    double F[3], numbers[3], power;
    fu_wrap_force of;
    if (sticks(sheave)) {
        fu_wrap_force_at(model, sheave, at, j, state, 0, &of);
        return fmax(-of.at.limit, fmin(of.at.limit, of.f));
    }
    fu_friction_at(sheave, at, j, F, numbers, &power);
    return numbers[2];
}

/* Computes the tensions at both tangent points from those of the zones beside them, the inertia of half of these, and
 * friction there. */
static void tensions_beside_zones(const fu_model *model, const fu_sheave *sheave, const fu_sheave_state *at,
                                  const fu_state *state, double tension[ENDS])
{
    const fu_wheel *wheel = &sheave->wheel;
    const double acceleration = mean_acceleration(sheave, at);
    for (int k = 0; k < ENDS; ++k) {
        const fu_zone of = fu_zone_at(at, k ? sheave->n_zones - 1 : 0);
        const double stretch = stretch_of(sheave, &of);
        const double friction = friction_at(model, sheave, at, state, k ? sheave->n_zones : 0);
        const double mean = wheel->A[0] * (stretch - 1.0), most = MOST_INERTIA * fabs(mean);
        const double inertia = fmax(-most, fmin(most, 0.5 * wheel->rho * of.l * acceleration));
        tension[k] = tension_in(sheave, at, &of, of.phi[k], mean) + (k ? 1.0 : -1.0) * (friction + inertia);
    }
}

/* Without friction the tension at the tangent points is from the balance of the arc alone: multipliers of short steps
 * have little accuracy. With friction it is from the zones: friction on a light rope accelerates its nodes at once. */
static double wrap_pressure(const fu_model *model, const fu_sheave *sheave, const fu_sheave_state *at,
                            const fu_state *state)
{
    const double none[MAX_CONDITIONS] = {0.0};
    double tension[ENDS], speed[ENDS], phi[MAX_CONDITIONS], y[Y];
    if (at->mode == FU_LIFTED) return 0.0;
    if (at->mode == FU_SHORT || has_friction(sheave)) elastic_tensions(sheave, at, tension, speed);
    else tensions(sheave, at, none, 0, tension, speed, phi, y);
    if (fu_stretches(at->mode) && has_friction(sheave)) tensions_beside_zones(model, sheave, at, state, tension);
    return least_pressure(sheave, at, tension, speed);
}

double fu_wrap_pressure(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_sheave *sheave = sheave_of(coupling);
    fu_sheave_state at;
    fu_sheave_at(model, sheave, state, state->acceleration, &at);
    return at.mode == FU_LIFTED ? 1.0 : wrap_pressure(model, sheave, &at, state);
}

/* Returns the angle over which friction at its limit changes the tension as a point of the wrap does, of whose numbers
 * the limit is P- + P+ and the friction f: the share of the point where it slides. */
static double slipping(const fu_sheave *sheave, const double numbers[3])
{
    return numbers[1] > 0.0 ? 2.0 / sheave->friction * atanh(fabs(numbers[2]) / numbers[1]) : 0.0;
}

/* Computes friction at all points of a wrap to which the rope may stick. */
static void find_sticking(const fu_model *model, const fu_sheave *sheave, const fu_sheave_state *at,
                          const fu_state *state, const fu_accelerator *work, fu_wrap_force *points)
{
    for (int j = 0; j <= sheave->n_zones; ++j)
        fu_wrap_force_at(model, sheave, at, j, state, work ? work->multipliers : 0, &points[j]);
}

static void add_smooth_friction(const fu_sheave *sheave, const fu_sheave_state *at, sheave_output *numbers)
{
    for (int j = 0; j < friction_points(sheave, at); ++j) {
        double F[3], of[3], power;
        fu_friction_at(sheave, at, j, F, of, &power);
        if (at->spin_below == at->wheel.turn_rate && fabs(of[0]) > fabs(numbers->slip)) numbers->slip = of[0];
        numbers->slip_angle += slipping(sheave, of);
        numbers->torque -= F[1];
    }
}

/* Returns the share of the wrap that belongs to a point. */
static double share_of_point(const fu_sheave *sheave, const fu_sheave_state *at, int j)
{
    const double zone = 1.0 / sheave->n_zones;
    return at->mode == FU_SHORT ? 1.0 : j == 0 || j == sheave->n_zones ? 0.5 * zone : zone;
}

/* Of points that slide all of their share of the wrap counts. */
static void add_sticking_friction(const fu_sheave *sheave, const fu_sheave_state *at, const fu_wrap_force *points,
                                  sheave_output *numbers)
{
    const double wrap = fabs(at->phi[1] - at->phi[0]);
    for (int j = 0; j <= sheave->n_zones; ++j) {
        const fu_wrap_force *of = &points[j];
        if (fabs(of->at.w) > fabs(numbers->slip)) numbers->slip = of->at.w;
        if (of->at.limit > 0.0) numbers->slip_angle += fabs(of->slips) * share_of_point(sheave, at, j) * wrap;
        numbers->torque -= of->f * of->at.column[1];
    }
}

void fu_sheave_outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                       const double *acceleration, const fu_accelerator *work, double *out)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const double *multipliers = work ? work->multipliers + coupling->multiplier : state->forces + coupling->force;
    sheave_output *numbers = (sheave_output *)out;
    fu_sheave_state at;
    double y[Y], phi[MAX_CONDITIONS], tension[ENDS], speed[ENDS], on_centre[SPACE];
    fu_wrap_force sticking[MAX_ZONES + 1];
    fu_sheave_at(model, sheave, state, acceleration, &at);
    if (at.mode == FU_SHORT) at.tension = multipliers[short_row(sheave)];
    if (sticks(sheave)) find_sticking(model, sheave, &at, state, work, sticking);
    tensions(sheave, &at, multipliers, sticking, tension, speed, phi, y);
    if (at.mode == FU_LIFTED) elastic_tensions(sheave, &at, tension, speed);
    *numbers = (sheave_output){.tension_on = tension[0], .tension_off = tension[1]};
    numbers->wrap_angle = at.mode == FU_LIFTED ? 0.0 : sheave->wheel.sense * (at.phi[1] - at.phi[0]);
    numbers->gap = at.mode == FU_LIFTED ? gap_of(sheave, &at) : 0.0;
    fu_wheel_force(&sheave->wheel, &at.wheel, y + CENTRE, on_centre);
    for (int d = 0; d < SPACE; ++d) numbers->force[d] = -on_centre[d] + 0.0; /* no -0 */
    const int is_beside = is_in_space(sheave) && at.mode != FU_LIFTED;
    numbers->fleet_angle_on = is_beside ? fleet_angle(sheave, &at, 0) : 0.0;
    numbers->fleet_angle_off = is_beside ? fleet_angle(sheave, &at, 1) : 0.0;
    numbers->material_speed = -0.5 * (at.s_rate[0] + at.s_rate[sheave->n_zones]);
    numbers->normal_force = wrap_pressure(model, sheave, &at, state);
    numbers->angle = sheave->wheel.turn < 0 ? 0.0 : state->q[sheave->wheel.turn];
    if (has_smooth_friction(sheave)) add_smooth_friction(sheave, &at, numbers);
    else if (sticks(sheave)) add_sticking_friction(sheave, &at, sticking, numbers);
    for (int r = 0; r < fu_sheave_conditions(sheave, &at); ++r)
        numbers->residual = fmax(numbers->residual, fabs(phi[r]));
}

const fu_output fu_sheave_output_fields[] = {
    FU_OUTPUT(sheave_output, tension_on, "N", NULL),
    FU_OUTPUT(sheave_output, tension_off, "N", NULL),
    FU_OUTPUT(sheave_output, wrap_angle, "rad", NULL),
    FU_OUTPUT(sheave_output, force, "N", "direction"),
    FU_OUTPUT(sheave_output, material_speed, "m/s", NULL),
    FU_OUTPUT(sheave_output, slip, "m/s", NULL),
    FU_OUTPUT(sheave_output, slip_angle, "rad", NULL),
    FU_OUTPUT(sheave_output, normal_force, "N", NULL),
    FU_OUTPUT(sheave_output, torque, "N m", NULL),
    FU_OUTPUT(sheave_output, angle, "rad", NULL),
    FU_OUTPUT(sheave_output, residual, "m", NULL),
    FU_OUTPUT(sheave_output, fleet_angle_on, "rad", NULL),
    FU_OUTPUT(sheave_output, fleet_angle_off, "rad", NULL),
    FU_OUTPUT(sheave_output, gap, "m", NULL),
    FU_LAST_OUTPUT(sheave_output),
};
