/* Public: two lines in contact at their closest points, a cable and another one or a bar:
 * couplings/crossing/crossing.c, couplings/crossing/closest_points.c, couplings/crossing/continuous_detection.c,
 * couplings/crossing/friction.c, events/crossing.c. */
#ifndef FUNICULAR_COUPLINGS_CROSSING_CROSSING_H
#define FUNICULAR_COUPLINGS_CROSSING_CROSSING_H

#include "couplings/common/attachments.h"
#include "couplings/common/coupling.h"
#include "couplings/common/stick_friction.h"

enum { FU_LINES = 2, FU_CROSSING_LAW = 8, FU_LAW_DAMPING = 4, FU_LAW_REGULARISATION, FU_LAW_FRICTION };
#define FU_INSTANT 1e-3 /* s: converts velocities to lengths, for comparison */

/* The first line is a cable, the second another one, or a bar through the attachment's point; in the plane the bar is
 * normal to it and has no axis. Numbers of a state: the arc-lengths of the closest points, the energy stored by contact
 * at its end, J, and the normal; with sticking friction, those of FU_CROSSING_STICK; the flag: whether the lines are in
 * contact. */
typedef struct {
    fu_coupling base;
    const fu_crossing_kernels *kernel;
    int cables[FU_LINES]; /* the second -1 for a bar */
    fu_attachment attachments[1];
    double axis[3];                       /* of the bar, along the axes of its carrier, of unit length */
    double low[FU_LINES], high[FU_LINES]; /* the ends of the lines, m; infinite in the plane, for a bar */
    double law[FU_CROSSING_LAW];          /* arguments of the kernels */
    double start[FU_LINES];               /* the arc-lengths as drawn, m */
    double separation[3];                 /* between the points as drawn, from the second, m */
    double slopes[6];                     /* of the lines there, as drawn */
    double friction, tangential;          /* of sticking friction: its coefficient, 0 for none, and its spring, N/m */
    double stiffness;                     /* N/m: converts lengths to forces, to scale equations */
} fu_crossing;
extern const fu_coupling_type fu_crossing_type;

/* Of the numbers of a state. */
enum {
    FU_CROSSING_S,
    FU_CROSSING_LEFT_BEHIND = FU_LINES,
    FU_CROSSING_NORMAL,
    FU_CROSSING_NUMBERS = FU_CROSSING_NORMAL + 3,
    FU_CROSSING_STICK = 30
};

/* A point of a line, and its derivatives by arc-length and in time. */
typedef struct {
    double r[3], t[3], k[3], v[3], w[3];
    int element; /* of a cable */
    double N[FU_MAX_COORDINATES], N_x[FU_MAX_COORDINATES];
    fu_attachment on; /* of a bar: its point */
} fu_line_point;

/* Both closest points in the form of the kernels; found: nonzero if they are the closest. Else apart: lower bound of
 * the distance of the lines, by samples, m; 0 if they may be in contact. */
typedef struct {
    int found;
    double apart;
    double s[FU_LINES];
    fu_line_point line[FU_LINES];
    double d[3], u[3], t[6], k[6], w[6];
} fu_closest_points;

/* Changes of the curvatures of both lines along them, r_xxx, in time, and with each nodal vector of a cable's
 * element. */
typedef struct {
    double third[6], rate[6], N_xx[FU_LINES][FU_MAX_COORDINATES];
} fu_line_bends;

/* Values of kernel->contact, and sticking friction, which force and energy include. */
typedef struct {
    double normal[3], depth[2], size, force[3], energy, dissipated; /* depth: penetration and its rate */
    double friction[3];
    int sticks;
} fu_crossing_contact;

/* Sticking friction: the stretch of its spring, that without sliding, that of the last step rotated with the lines; the
 * direction of the last line with a slope; force on the first line, energy; whether it slides, and whether it has stuck
 * now and since the last step. */
typedef struct {
    double stretch[3], without_sliding[3], old[3], along[3], force[3], energy;
    fu_friction_end end;
    int slides, sticks, turns; /* the last: its direction follows the slip */
} fu_crossing_stick;

/* The force of friction on the first line and its derivatives, from kernels. */
typedef struct {
    double F[3], F_d[9], F_t[18], F_u[9], F_w[18], F_k[18];
} fu_crossing_stick_changes;

/* Motion of a point with its n coordinates: dr = P dq, dt = T dq; the numbers of these for fu_add in `at`. */
typedef struct {
    int n, at[FU_ATTACHMENT_COORDINATES];
    double P[3 * FU_ATTACHMENT_COORDINATES], T[3 * FU_ATTACHMENT_COORDINATES];
} fu_line_moves;

/* Instant of an evaluation: at a state; or, if `next` is not null, after the part x of a step of h, s, along the cubics
 * of positions and velocities at both ends. */
typedef struct {
    const fu_state *now, *next;
    double h, x;
} fu_moment;

/* couplings/crossing/closest_points.c; the first: from arc-lengths s. */
void fu_find_closest_within(const fu_model *model, const fu_crossing *crossing, const fu_moment *moment,
                            const double s[FU_LINES], fu_closest_points *out);
void fu_find_closest(const fu_model *model, const fu_crossing *crossing, const fu_state *state, fu_closest_points *out);
/* The same at a state that may be far from that of the numbers: the closer of two solutions. */
void fu_find_closest_anew(const fu_model *model, const fu_crossing *crossing, const fu_state *state,
                          fu_closest_points *out);
/* Computes a line's point at an arc-length. */
void fu_line_point_of(const fu_model *model, const fu_crossing *crossing, int line, const fu_state *state, double s,
                      fu_line_point *out);
/* Computes the changes of the curvatures at closest points of a state. */
void fu_line_bends_at(const fu_model *model, const fu_crossing *crossing, const fu_state *state,
                      const fu_closest_points *points, fu_line_bends *out);
/* Returns the size of a line's segments, m. */
double fu_line_size(const fu_model *model, const fu_crossing *crossing, int line);
void fu_line_moves_at(const fu_model *model, const fu_crossing *crossing, int line, const fu_state *state,
                      const fu_line_point *point, fu_line_moves *out);

/* couplings/crossing/contact_force.c: the margin of contact of the lines, m, negative without contact; NaN without
 * closest points of lines that may be in contact. */
double fu_crossing_distance_to_ends(const fu_crossing *crossing, const fu_closest_points *points);
double fu_crossing_margin(const fu_model *model, const fu_crossing *crossing, const fu_state *state);
double fu_crossing_margin_of(const fu_crossing *crossing, const fu_closest_points *points,
                             const fu_crossing_contact *contact);

/* couplings/crossing/continuous_detection.c: the time of contact within a step of h of lines that are apart at its
 * ends, by more than `least`, m: half-way from the first contact to the separation or to the passage of their axes, or
 * at a graze, s after the start of the step; 0 if none is predicted. */
double fu_crossing_detect_within(const fu_model *model, const fu_crossing *crossing, const fu_state *now,
                                 const fu_state *next, double h, double least);

/* couplings/crossing/friction.c */
void fu_crossing_stick_at(const fu_crossing *crossing, const fu_state *state, const fu_closest_points *points,
                          const fu_crossing_contact *contact, fu_crossing_stick *out);
void fu_crossing_stick_derivatives(const fu_crossing *crossing, const fu_state *state, const fu_closest_points *points,
                                   const fu_line_bends *has_accelerations, const fu_crossing_contact *contact,
                                   fu_crossing_stick_changes *by);
/* Returns the dissipation of friction from one state of lines in contact to another, J; by_ends: by these alone. */
double fu_crossing_slip_work(const fu_model *model, const fu_crossing *crossing, const fu_state *from,
                             const fu_state *to, int by_ends);
double fu_crossing_history_error(const fu_model *model, const fu_coupling *coupling, const fu_state *from,
                                 const fu_state *to);
/* Start the spring at a state, without stretch; update its stretch to a state; start as drawn. */
void fu_crossing_begin_stick(const fu_crossing *crossing, const fu_closest_points *points, fu_state *state);
void fu_crossing_update_stick(const fu_crossing *crossing, const fu_closest_points *points,
                              const fu_crossing_contact *contact, fu_state *state);
void fu_crossing_reset_stick(const fu_crossing *crossing, fu_state *state);

/* couplings/crossing/contact_force.c; the second: whether the normal has reversed since the last state, as after
 * parallel lines. */
void fu_crossing_contact_at(const fu_crossing *crossing, const fu_closest_points *points, fu_crossing_contact *out);
int fu_crossing_swung(const fu_crossing *crossing, const fu_state *state, const fu_crossing_contact *contact);

/* couplings/crossing/energy_step.c; the first: the middle of a step, with the numbers and the flags of its end. */
fu_state fu_crossing_middle(const fu_equations *at);
void fu_crossing_step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                               double *internal);
double fu_crossing_step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at);

/* couplings/crossing/clearance.c */
fu_clearance fu_crossing_clearance(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
void fu_crossing_between(const fu_model *model, const fu_coupling *coupling, int between[2]);

#endif
