/* Ropes: spans with moving material coordinates, and how far ropes are from leaving what they run over. */
#ifndef FUNICULAR_COUPLINGS_ROPE_ROPE_H
#define FUNICULAR_COUPLINGS_ROPE_ROPE_H

#include "couplings/common/attachments.h"
#include "couplings/common/coupling.h"
#include "couplings/common/span_elements.h"

#define FU_ROPE_CONSTANTS 4 /* of a law, at most */

/* A span (derive/couplings/span.py). */
typedef struct {
    fu_coupling base;
    fu_span_elements on;
    double rho, tau, g[3], A[FU_ROPE_CONSTANTS];
    double least_length; /* m: stress-free, of a span that can be modelled */
    int is_gripped;      /* whether joints or springs hold to material points within it */
    double grips[2];     /* m: the first and the last material coordinate of these */
} fu_span_coupling;
extern const fu_coupling_type fu_span_type, fu_sheave_type;

/* Return how far a rope is from leaving: its wrap above the least one, rad, of a short wrap above zero, or of a rope
 * that has left its distance from touching, m; the least normal force, times the radius on an angle, N; the length of a
 * span above the least one, m; in space that of both spans beside a sheave above the one at which a rope with their
 * fleet angles slides out of the groove, m. Growth: how far a short wrap is from one that stretches, or in space one
 * with slopes from one with chords, rad. may_change: whether the method of the run admits changes of the sheave's mode.
 */
double fu_wrap_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int may_change);
double fu_wrap_growth_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
/* Return whether a rope may leave a sheave and touch it again; whether it has left; whether a span with this dof of s
 * at an end ends at the sheave; whether its wrap stretches; and whether it has left after the change of the sheave's
 * mode where its wrap margin, or the one of growth, has reached zero. */
int fu_wrap_may_leave(const fu_coupling *coupling);
int fu_wrap_has_left(const fu_coupling *coupling, const fu_state *state);
int fu_wrap_is_beside_span(const fu_coupling *coupling, int s);
int fu_wrap_stretches(const fu_coupling *coupling, const fu_state *state);
int fu_wrap_change(const fu_model *model, const fu_coupling *coupling, fu_state *now, int grows);
/* Returns whether a rope in space that is about to leave a sheave, or to touch it again, does so beside the plane of
 * its groove. */
int fu_wrap_is_beside(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
double fu_wrap_pressure(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
double fu_fleet_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
double fu_span_fleet_margin(double length, double radius, double fleet);
double fu_drum_fleet_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
double fu_span_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
/* Returns the stress-free length between an end of a span, 0 or 1, and the next material point that something holds to,
 * m. */
double fu_grip_margin(const fu_coupling *coupling, const fu_state *state, int end);
/* Return the wound length of a drum, m, and the normal force as above, N, or 1 where the rope has left it; whether the
 * rope leaves the empty drum. Lets it leave. */
double fu_drum_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
int fu_drum_leaves(const fu_coupling *coupling);
void fu_drum_leave(const fu_model *model, const fu_coupling *coupling, fu_state *state);
double fu_drum_pressure(const fu_model *model, const fu_coupling *coupling, const fu_state *state);

/* Returns whether anything holds to material points of a span. */
static inline int fu_is_gripped(const fu_coupling *span)
{
    return ((const fu_span_coupling *)span)->is_gripped;
}

/* Return whether a sheave or a drum is one in space. */
int fu_is_in_space(const fu_coupling *sheave);
int fu_drum_is_in_space(const fu_coupling *drum);

static inline const fu_span_coupling *fu_span_of(const fu_coupling *coupling)
{
    return (const fu_span_coupling *)coupling;
}

/* --- span_step.c --- */

int fu_span_history_size(const fu_coupling *coupling);
void fu_span_history_over_step(const fu_model *model, const fu_coupling *coupling, const fu_equations *at);
void fu_span_velocities(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double since);
void fu_span_history_jump(const fu_model *model, const fu_coupling *coupling, fu_state *state, const double *change);
double fu_span_energy_beyond_velocities(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
void fu_span_step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                           double *internal);
double fu_span_step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at);

#endif
