/* Forces between the points of two attachments by the kernels of a law (derive/couplings/point_law.py). In a Newton
 * system the force is an internal unknown, so that two points far apart on cables do not widen the band. */
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/common/attachments.h"
#include "couplings/force/force.h"

#include <math.h>
#include <string.h>

/* Computes the force on the first point by the law of a segment. */
static void force_of_segment(const fu_point_force *between, const double *q, int segment, const double gap[3],
                             const double rate[3], double force[3])
{
    double scaled[FU_MAX_LAW_PARAMETERS];
    if (between->senses[segment] == FU_HAS_NO_FORCE) memset(force, 0, sizeof(double[3]));
    else between->law->force(fu_segment_parameters(between, q, segment, scaled), gap, rate, force);
}

/* Computes the force on the first point by the law. */
static void force_at(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double force[3])
{
    const fu_point_force *between = (const fu_point_force *)coupling;
    double gap[3], rate[3];
    fu_gap(model, between, state, gap, rate);
    force_of_segment(between, state->q, fu_force_segment(between, state), gap, rate, force);
}

static double length(int dim, const double *gap)
{
    return sqrt(fu_dot(dim, gap, gap));
}

/* A step as a path of the distance that the law takes: that at its ends, m, the mean tension, N, the power that it
 * dissipates, W, and the mean direction from point to point, whose product with the change of the gap between them is
 * the change of their distance. */
typedef struct {
    double from, to, tension, power, along[3], apart; /* apart: twice the mean distance of the points, m */
} point_motion;

/* Returns the path of a step without its tension. */
static point_motion path_of(const fu_model *model, const fu_point_force *between, const fu_equations *at)
{
    const int dim = between->dim;
    double gap[3], gap_next[3];
    point_motion w = {.power = 0.0};
    fu_gap(model, between, at->now, gap, 0);
    fu_gap(model, between, at->next, gap_next, 0);
    w.from = length(dim, gap), w.to = length(dim, gap_next);
    if (between->length_dof >= 0) {
        fu_gap_of_points(model, between, at->now, gap, 0);
        fu_gap_of_points(model, between, at->next, gap_next, 0);
    }
    w.apart = length(dim, gap) + length(dim, gap_next);
    for (int d = 0; d < dim; ++d) w.along[d] = (gap[d] + gap_next[d]) / w.apart;
    return w;
}

/* Returns the mean tension over a path, the power of which is in `power`. */
static double tension_in(const fu_point_force *between, const double *q, int segment, double h, double from, double to,
                         double *power)
{
    const double start[3] = {from, 0.0, 0.0}, end[3] = {to, 0.0, 0.0};
    double tension[3], scaled[FU_MAX_LAW_PARAMETERS];
    *power = 0.0;
    if (between->senses[segment] == FU_HAS_NO_FORCE) return 0.0;
    between->law->discrete_force(fu_segment_parameters(between, q, segment, scaled), h, start, end, tension, power);
    return tension[0];
}

/* Returns the mean tension over a path through several segments of a law without a damper. Each counts by its share of
 * the path: the work of the mean on the path is the change of the energy. */
static double tension_over(const fu_point_force *between, const double *q, const point_motion *w)
{
    const double low = fmin(w->from, w->to), high = fmax(w->from, w->to);
    double work = 0.0, unused;
    for (int segment = 0; segment < between->n_segments; ++segment) {
        const double a = segment > 0 ? fmax(low, between->bounds[segment - 1]) : low;
        const double b = segment < between->n_segments - 1 ? fmin(high, between->bounds[segment]) : high;
        if (b > a) work += tension_in(between, q, segment, 1.0, a, b, &unused) * (b - a);
    }
    return work / (high - low);
}

/* Computes the derivatives of the mean force by the gap in the middle, which moves by half of its end: those across the
 * mean direction belong to the mean tension. */
static void mean_stiffness(const fu_model *model, const fu_point_force *between, const fu_equations *at, int segment,
                           double by_gap[9])
{
    const point_motion w = path_of(model, between, at);
    const int dim = between->dim;
    const double end[3] = {w.to, 0.0, 0.0}, rate[3] = {0.0, 0.0, 0.0}, *e = w.along;
    double tension[3];
    force_of_segment(between, at->middle->q, segment, end, rate, tension);
    const double mean = tension_over(between, at->middle->q, &w);
    const double along = 2.0 * (tension[0] - mean) / (w.to - w.from), across = 2.0 * mean / w.apart;
    for (int d = 0; d < dim; ++d)
        for (int k = 0; k < dim; ++k) by_gap[d * dim + k] = (along - across) * e[d] * e[k] + (d == k ? across : 0.0);
}

/* Returns the segment at the end of a step: without a damper that of the distance, as in the energy. */
static int step_segment(const fu_model *model, const fu_point_force *between, const fu_equations *at)
{
    return between->base.is_damped ? fu_force_segment(between, at->next) : fu_segment_at(model, between, at->next);
}

/* Returns whether the force over a step belongs to several segments: of a law without a damper whose distance crosses
 * bounds. */
static int is_of_several(const fu_model *model, const fu_point_force *between, const fu_equations *at)
{
    if (between->base.is_damped || between->n_segments == 1) return 0;
    return fu_segment_at(model, between, at->now) != fu_segment_at(model, between, at->next);
}

/* Computes the force over a step; returns the power that it dissipates, W. */
static double step_force(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double force[3])
{
    const fu_point_force *between = (const fu_point_force *)coupling;
    const int several = is_of_several(model, between, at), segment = step_segment(model, between, at);
    double gap[3], gap_next[3], power = 0.0, scaled[FU_MAX_LAW_PARAMETERS];
    if (!several && between->senses[segment] == FU_HAS_NO_FORCE) {
        memset(force, 0, sizeof(double[3]));
        return 0.0;
    }
    if (several || between->length_dof >= 0) {
        const point_motion w = path_of(model, between, at);
        const double tension = several ? tension_over(between, at->middle->q, &w)
                                       : tension_in(between, at->middle->q, segment, at->h, w.from, w.to, &power);
        for (int d = 0; d < between->dim; ++d) force[d] = tension * w.along[d];
        return power;
    }
    fu_gap(model, between, at->now, gap, 0);
    fu_gap(model, between, at->next, gap_next, 0);
    between->law->discrete_force(fu_segment_parameters(between, at->middle->q, segment, scaled), at->h, gap, gap_next,
                                 force, &power);
    return power;
}

/* Returns the energy stored at a state, J, by the law at its own stiffness or at that of the configuration q: of the
 * segment of the points' distance, whether the force follows its law or not. */
static double stored(const fu_model *model, const fu_point_force *between, const fu_state *state, const double *q)
{
    const int segment = fu_segment_at(model, between, state);
    double gap[3], energy, scaled[FU_MAX_LAW_PARAMETERS];
    const double *parameters = between->parameters + (long)segment * between->n_parameters;
    if (between->senses[segment] == FU_HAS_NO_FORCE) return 0.0;
    if (q) parameters = fu_segment_parameters(between, q, segment, scaled);
    fu_gap(model, between, state, gap, 0);
    between->law->energy(parameters, gap, &energy);
    return energy;
}

/* Adds the derivative of the energy by the factor of the stiffness to the force on its dof: at a state, or the mean of
 * both ends of a step, whose work is the change of the energy beyond that by the mean stiffness. */
static void add_stiffness_force(const fu_model *model, const fu_point_force *between, const fu_state *state,
                                const fu_state *next, double *f)
{
    if (between->stiffness_dof < 0) return;
    const double here = stored(model, between, state, 0);
    f[between->stiffness_dof] += next ? 0.5 * (here + stored(model, between, next, 0)) : here;
}

/* Adds minus the tension of a force on the first point to the force on the dof of the length. */
static void add_length_force(const fu_model *model, const fu_point_force *between, const fu_state *state,
                             const fu_state *next, const double *force, double *f)
{
    if (between->length_dof < 0) return;
    const fu_equations step = {.now = state, .next = next ? next : state};
    const double *along = path_of(model, between, &step).along;
    f[between->length_dof] -= fu_dot(between->dim, force, along) / fu_dot(between->dim, along, along);
}

/* Adds a force on the first point, and its opposite on the second, to the left side of the equations of motion: at a
 * state, or over a step to `next`, where its work is that on the change of the gap. */
static void add_forces(const fu_model *model, const fu_point_force *between, const fu_state *state,
                       const fu_state *next, const double *force, double *f)
{
    for (int e = 0; e < 2; ++e) {
        const fu_attachment *on = &between->attachments[e];
        const double sign = e ? 1.0 : -1.0;
        if (next) fu_add_point_over_step(model, on, state, next, force, sign, f);
        else fu_add_force_at(model, on, state, force, sign, f);
    }
    add_length_force(model, between, state, next, force, f);
}

void fu_add_force_change(const fu_model *model, const fu_point_force *between, const fu_state *state, int segment,
                         double factor, double *f)
{
    double gap[3], rate[3], force[3], other[3];
    fu_gap(model, between, state, gap, rate);
    force_of_segment(between, state->q, fu_force_segment(between, state), gap, rate, force);
    force_of_segment(between, state->q, segment, gap, rate, other);
    for (int d = 0; d < between->dim; ++d) force[d] = factor * (force[d] - other[d]);
    add_forces(model, between, state, 0, force, f);
}

/* Writes minus the residuals of the internal unknowns: the forces less those of the law. */
static void internal_residual(const fu_coupling *coupling, const fu_equations *at, const double *force,
                              double *internal)
{
    const double *unknown = at->next->forces + coupling->force;
    for (int d = 0; d < coupling->n_forces; ++d)
        internal[coupling->unknown + d] = -at->weights.stiffness * (unknown[d] - force[d]);
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                     double *internal)
{
    double force[3];
    add_forces(model, (const fu_point_force *)coupling, at->next, 0, at->next->forces + coupling->force, f);
    add_stiffness_force(model, (const fu_point_force *)coupling, at->next, 0, f);
    force_at(model, coupling, at->next, force);
    internal_residual(coupling, at, force, internal);
}

static void step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                          double *internal)
{
    double force[3];
    add_forces(model, (const fu_point_force *)coupling, at->now, at->next, at->next->forces + coupling->force, f);
    add_stiffness_force(model, (const fu_point_force *)coupling, at->now, at->next, f);
    step_force(model, coupling, at, force);
    internal_residual(coupling, at, force, internal);
}

/* Makes derivatives by the gap that the law takes those by the gap of the points, `ratio` of which it is: along the
 * line from point to point both change alike. */
static void by_points(int dim, const double *gap, double ratio, double by_gap[9])
{
    const double square = fu_dot(dim, gap, gap);
    for (int d = 0; d < dim; ++d) {
        const double along = fu_dot(dim, by_gap + d * dim, gap) / square;
        for (int k = 0; k < dim; ++k)
            by_gap[d * dim + k] = ratio * by_gap[d * dim + k] + (1.0 - ratio) * along * gap[k];
    }
}

/* Adds the derivatives of the equations at a state to a system, by the law of a segment; internal: the forces; psi as
 * in fu_equations; known: the derivatives by the gap of a force that does not follow that law, else null. */
static void matrix(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int segment,
                   const double *internal, const double *psi, const double *known, fu_weights weights,
                   fu_system *system)
{
    const fu_point_force *between = (const fu_point_force *)coupling;
    const int dim = between->dim, row = fu_extra(model, coupling->unknown);
    const double unit = fu_row_unit(weights.inertia, coupling->scale[0]), stiffness = weights.stiffness;
    double gap[3], rate[3], force[3], by_gap[9] = {0.0}, by_rate[9] = {0.0}, by[18];
    double changes[3 * FU_ATTACHMENT_COORDINATES], scaled[FU_MAX_LAW_PARAMETERS];
    fu_point_motion motions[2];
    for (int e = 0; e < 2; ++e)
        fu_point_motion_at(model, &between->attachments[e], state, FU_POINT, internal, 0, psi, weights.rate,
                           &motions[e]);
    for (int d = 0; d < dim; ++d) {
        gap[d] = motions[1].at.p[d] - motions[0].at.p[d];
        rate[d] = motions[1].at.v[d] - motions[0].at.v[d];
    }
    const double taken = between->length_dof < 0 ? 1.0 : fu_shorten_gap(between, state, gap, rate);
    if (known) memcpy(by_gap, known, sizeof by_gap);
    else if (between->senses[segment] != FU_HAS_NO_FORCE)
        between->law->tangent(fu_segment_parameters(between, state->q, segment, scaled), gap, rate, force, by_gap,
                              by_rate);
    if (!known && between->length_dof >= 0) by_points(dim, gap, taken, by_gap);
    for (int d = 0; d < dim; ++d) {
        memcpy(by + 2 * d * dim, by_gap + d * dim, sizeof(double) * (size_t)dim);
        memcpy(by + (2 * d + 1) * dim, by_rate + d * dim, sizeof(double) * (size_t)dim);
        fu_add(model, system, row + d, row + d, unit);
    }
    for (int e = 0; e < 2; ++e) {
        const fu_attachment_state *at = &motions[e].at;
        const int n = at->n;
        const double sign = e ? 1.0 : -1.0;
        fu_changes(&motions[e], dim, by, changes);
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n && motions[e].is_stiff; ++j)
                fu_add(model, system, at->at[i], at->at[j], sign * stiffness * motions[e].K[i * n + j]);
            for (int d = 0; d < dim; ++d) {
                fu_add(model, system, row + d, at->at[i], -sign * stiffness * changes[d * n + i]);
                fu_add(model, system, at->at[i], row + d, sign * unit * at->P[d * n + i]);
            }
        }
    }
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    const int segment = fu_force_segment((const fu_point_force *)coupling, at->next);
    matrix(model, coupling, at->next, segment, at->next->forces + coupling->force, at->psi, 0, at->weights, system);
}

/* The middle moves by half of psi, which is in weights.stiffness. */
static void step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    const fu_point_force *between = (const fu_point_force *)coupling;
    const int several = is_of_several(model, between, at), segment = step_segment(model, between, at);
    double by_gap[9];
    if (several) mean_stiffness(model, between, at, segment, by_gap);
    matrix(model, coupling, at->middle, segment, at->next->forces + coupling->force, 0, several ? by_gap : 0,
           at->weights, system);
}

static double step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at)
{
    double force[3];
    return at->h * step_force(model, coupling, at, force);
}

static void add_force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    double force[3];
    force_at(model, coupling, state, force);
    add_forces(model, (const fu_point_force *)coupling, state, 0, force, f);
    add_stiffness_force(model, (const fu_point_force *)coupling, state, 0, f);
}

/* work: null in equilibrium, where the force is an unknown. */
static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    (void)acceleration;
    if (work) force_at(model, coupling, state, out);
    else memcpy(out, state->forces + coupling->force, sizeof(double) * (size_t)coupling->n_forces);
}

static void take_forces(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work, fu_state *state)
{
    outputs(model, coupling, state, 0, work, state->forces + coupling->force);
}

static double energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    return stored(model, (const fu_point_force *)coupling, state, state->q);
}

static double dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const fu_accelerator *work)
{
    const fu_point_force *between = (const fu_point_force *)coupling;
    const int segment = fu_force_segment(between, state);
    double gap[3], rate[3], power, scaled[FU_MAX_LAW_PARAMETERS];
    (void)work;
    if (!coupling->is_damped || between->senses[segment] == FU_HAS_NO_FORCE) return 0.0;
    fu_gap(model, between, state, gap, rate);
    between->law->dissipation(fu_segment_parameters(between, state->q, segment, scaled), gap, rate, &power);
    return power;
}

/* Returns the stored energy that is dissipated, J: of a spring whose damper would push, so that it has no force. */
static double energy_without_force(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_point_force *between = (const fu_point_force *)coupling;
    const int has_none = between->senses[fu_force_segment(between, state)] == FU_HAS_NO_FORCE;
    return has_none ? energy(model, coupling, state) : 0.0;
}

static double lost_in_step(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                           int by_ends)
{
    (void)by_ends;
    if (!coupling->is_damped || ((const fu_point_force *)coupling)->n_segments == 1) return 0.0;
    return energy_without_force(model, coupling, from) - energy_without_force(model, coupling, to);
}

static const char *const role[] = {"point_law", 0};
static const fu_field fields[] = {
    FU_FIELD(fu_point_force, law, FU_KERNELS, role),
    FU_FIELD(fu_point_force, parameters, FU_REALS, 0),
    FU_FIELD_ARRAY(fu_point_force, attachments, FU_ATTACHMENT),
    FU_FIELD(fu_point_force, dim, FU_INTEGER, 0),
    FU_FIELD(fu_point_force, n_segments, FU_INTEGER, 0),
    FU_FIELD(fu_point_force, n_parameters, FU_INTEGER, 0),
    FU_FIELD(fu_point_force, bounds, FU_REALS, 0),
    FU_FIELD(fu_point_force, senses, FU_INTEGERS, 0),
    FU_FIELD(fu_point_force, compliance, FU_REAL, 0),
    FU_FIELD(fu_point_force, length_dof, FU_INTEGER, 0),
    FU_FIELD(fu_point_force, stiffness_dof, FU_INTEGER, 0),
    FU_FIELD(fu_point_force, stiffnesses, FU_INTEGERS, 0),
    {0},
};

typedef struct {
    double force[3]; /* on the first end */
} fu_point_force_output;
static const fu_output output_fields[] = {
    FU_OUTPUT(fu_point_force_output, force, "N", "direction"),
    FU_LAST_OUTPUT(fu_point_force_output),
};

const fu_coupling_type fu_point_force_type = {.name = "point_force",
                                              .size = sizeof(fu_point_force),
                                              .fields = fields,
                                              .output_fields = output_fields,
                                              .n_flags = 1,
                                              .detect = fu_detect_segment,
                                              .residual = residual,
                                              .tangent = tangent,
                                              .step_residual = step_residual,
                                              .step_tangent = step_tangent,
                                              .step_dissipation = step_dissipation,
                                              .force = add_force,
                                              .take_forces = take_forces,
                                              .outputs = outputs,
                                              .energy = energy,
                                              .dissipation = dissipation,
                                              .lost_in_step = lost_in_step};
