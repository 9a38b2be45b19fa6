/* Wheels with inertia of ropes without mass, which spin about an axis that turns with what carries them
 * (derive/couplings/taut_part.py). */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/taut_rope/taut_rope.h"

#include <string.h>

enum { SPACE = 3 };

/* A wheel that spins: its centre, its axis, in the plane out of that, and the angular velocity of its carrier; of the
 * rates of coordinates of the centre, the shares in the rate about the axis; its own rate; the acceleration about the
 * axis at zero accelerations. */
typedef struct {
    fu_attachment_state centre;
    double axis[SPACE], omega[SPACE], share[FU_ATTACHMENT_COORDINATES], own, bias;
} spinning;

static void find_spinning(const fu_model *model, const fu_taut_point *point, const fu_state *state, spinning *out)
{
    const fu_attachment_state *at = &out->centre;
    const int turns = fu_turns(model->dim);
    fu_taut_centre(model, point, state, &out->centre);
    for (int d = 0; d < SPACE; ++d) out->axis[d] = turns == SPACE ? at->A[d * SPACE + 2] : d == 2 ? 1.0 : 0.0;
    fu_turn_in_space(model->dim, at->omega, out->omega);
    const double *axis = out->axis + (turns == SPACE ? 0 : 2);
    for (int i = 0; i < at->n; ++i) {
        out->share[i] = 0.0;
        for (int d = 0; d < turns; ++d) out->share[i] += axis[d] * at->T[d * at->n + i];
    }
    out->own = state->v && point->turn >= 0 ? state->v[point->turn] : 0.0;
    out->bias = fu_dot(turns, axis, at->alpha);
}

/* Returns the acceleration about the axis by those of the dofs. */
static double spinning_up(const fu_taut_point *point, const spinning *of, const double *a)
{
    double acceleration = a[point->turn];
    for (int i = 0; i < of->centre.n; ++i) acceleration += of->share[i] * a[of->centre.at[i]];
    return acceleration;
}

double fu_taut_spinning_up(const fu_model *model, const fu_taut_point *point, const fu_state *state, const double *a)
{
    spinning of;
    find_spinning(model, point, state, &of);
    return of.bias + spinning_up(point, &of, a);
}

static void inertial_force(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                           const double *a, double *f)
{
    (void)t;
    const fu_taut_point *point = (const fu_taut_point *)coupling;
    const fu_state state = {.q = (double *)q};
    spinning of;
    find_spinning(model, point, &state, &of);
    const double moment = point->inertia * spinning_up(point, &of, a);
    f[point->turn] += moment;
    for (int i = 0; i < of.centre.n; ++i) f[of.centre.at[i]] += of.share[i] * moment;
}

static void mass_matrix(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double scale,
                        fu_system *system)
{
    (void)t;
    const fu_taut_point *point = (const fu_taut_point *)coupling;
    const fu_state state = {.q = (double *)q};
    const double mass = scale * point->inertia;
    spinning of;
    find_spinning(model, point, &state, &of);
    fu_add(model, system, point->turn, point->turn, mass);
    for (int i = 0; i < of.centre.n; ++i) {
        if (of.share[i] == 0.0) continue;
        fu_add(model, system, point->turn, of.centre.at[i], mass * of.share[i]);
        fu_add(model, system, of.centre.at[i], point->turn, mass * of.share[i]);
        for (int j = 0; j < of.centre.n; ++j)
            if (of.share[j] != 0.0)
                fu_add(model, system, of.centre.at[i], of.centre.at[j], mass * of.share[i] * of.share[j]);
    }
}

static double kinetic_energy(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                             const double *v, int past_fluid)
{
    const fu_taut_point *point = (const fu_taut_point *)coupling;
    const fu_state state = {.q = (double *)q, .v = (double *)v};
    double energy, force, moment[SPACE];
    spinning of;
    (void)t, (void)past_fluid;
    find_spinning(model, point, &state, &of);
    point->wheel->spin(point->inertia, of.axis, of.omega, of.own, 0.0, &energy, &force, moment);
    return energy;
}

void fu_taut_add_gyration(const fu_model *model, const fu_taut_point *point, const fu_state *state, double *f)
{
    const int first = model->dim == SPACE ? 0 : SPACE - 1;
    double energy, force, moment[SPACE];
    spinning of;
    if (point->inertia == 0.0 || !state->v) return;
    find_spinning(model, point, state, &of);
    point->wheel->spin(point->inertia, of.axis, of.omega, of.own, of.bias, &energy, &force, moment);
    f[point->turn] += force;
    fu_add_wrench(model->dim, &of.centre, 0, moment + first, 1.0, f);
}

void fu_taut_add_gyration_tangent(const fu_model *model, const fu_taut_point *point, const fu_equations *equations,
                                  fu_system *system)
{
    enum { RATES = 2 * SPACE + 1, VECTORS = 4 * SPACE };
    const fu_state *next = equations->next;
    const fu_weights w = equations->weights;
    double energy, force, moment[SPACE], K[SPACE * RATES], by[SPACE * VECTORS],
        changes[SPACE * FU_ATTACHMENT_COORDINATES];
    spinning of;
    fu_point_motion motion;
    if (point->inertia == 0.0 || model->dim != SPACE) return;
    find_spinning(model, point, next, &of);
    const double *a = next->acceleration ? next->acceleration : model->zero;
    const double acceleration = of.bias + spinning_up(point, &of, a);
    point->wheel->spin(point->inertia, of.axis, of.omega, of.own, acceleration, &energy, &force, moment);
    point->wheel->spin_tangent(point->inertia, of.axis, of.omega, of.own, acceleration, K);
    fu_point_motion_at(model, &point->attachments[0], next, FU_POINT | FU_AXES, 0, moment, equations->psi, w.rate,
                       &motion);
    memset(by, 0, sizeof by);
    for (int d = 0; d < SPACE; ++d)
        for (int j = 0; j < 2 * SPACE; ++j) by[d * VECTORS + 2 * SPACE + j] = K[d * RATES + j];
    fu_changes(&motion, SPACE, by, changes);
    fu_add_wrench_tangent(model, &motion.at, &motion.at, 0, changes, fu_stiffness_of(&motion), w.stiffness, system);
    for (int i = 0; i < motion.at.n; ++i) {
        double change = 0.0;
        for (int d = 0; d < SPACE; ++d) change += motion.at.T[d * motion.at.n + i] * K[d * RATES + 2 * SPACE];
        if (change != 0.0) fu_add(model, system, motion.at.at[i], point->turn, w.stiffness * w.rate * change);
    }
}

const fu_inertia_operations fu_taut_wheel_inertia = {
    .force = inertial_force, .matrix = mass_matrix, .kinetic_energy = kinetic_energy};
