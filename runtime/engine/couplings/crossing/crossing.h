/* Two lines that touch at their closest points, a cable and another one or a bar: couplings/crossing/crossing.c,
 * couplings/crossing/closest_points.c, couplings/crossing/continuous_detection.c, couplings/crossing/friction.c,
 * events/crossing.c. */
#ifndef FUNICULAR_COUPLINGS_CROSSING_CROSSING_H
#define FUNICULAR_COUPLINGS_CROSSING_CROSSING_H

#include "couplings/common/attachments.h"
#include "couplings/common/coupling.h"
#include "couplings/common/stick_friction.h"

enum { FU_LINES = 2, FU_CROSSING_LAW = 8, FU_LAW_DAMPING = 4, FU_LAW_LEAST, FU_LAW_FRICTION };
#define FU_INSTANT 1e-3 /* s: makes lengths of velocities, to compare them */

/* The first line is a cable, the second another one, or a bar through the attachment's point; in the plane the bar is
 * square to it and has no axis. Numbers of a state: the arc-lengths of the closest points, the energy that contact had
 * stored when it ended, J, and the normal; where friction sticks, so many more as FU_CROSSING_STICK; the flag: whether
 * the lines touch. */
typedef struct {
    fu_coupling base;
    const fu_crossing_kernels *kernel;
    int cables[FU_LINES]; /* the second -1 for a bar */
    fu_attachment attachments[1];
    double axis[3];                       /* of the bar, in the axes of what carries it, of unit length */
    double low[FU_LINES], high[FU_LINES]; /* where the lines end, m; infinite in the plane, for a bar */
    double law[FU_CROSSING_LAW];          /* as the kernels take them */
    double start[FU_LINES];               /* the arc-lengths as drawn, m */
    double way[3];                        /* between the points as drawn, from the second, m */
    double slopes[6];                     /* of the lines there, as drawn */
    double friction, tangential; /* of friction that sticks: its coefficient, 0 for none, and its spring, N/m */
    double stiffness;            /* N/m: makes forces of lengths, to scale equations */
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

/* Both closest points, as the kernels take them; found: not zero where they are the closest. Else apart: how far the
 * lines are apart at least, by samples, m; 0 where they may touch. */
typedef struct {
    int found;
    double apart;
    double s[FU_LINES];
    fu_line_point line[FU_LINES];
    double d[3], u[3], t[6], k[6], w[6];
} fu_closest_points;

/* How the curvatures of both lines change along them, r_xxx, in time, and with each nodal vector of a cable's element.
 */
typedef struct {
    double third[6], rate[6], N_xx[FU_LINES][FU_MAX_COORDINATES];
} fu_line_bends;

/* What kernel->contact tells, and friction that sticks: force and energy have it in them. */
typedef struct {
    double normal[3], depth[2], size, force[3], energy, dissipated; /* depth: penetration and its rate */
    double friction[3];
    int sticks;
} fu_crossing_contact;

/* Friction that sticks: the stretch of its spring, that without sliding, that of the last step turned with the lines;
 * the direction of the last line that has a slope; force on the first line, energy; whether it slides, and whether it
 * holds now and has since the last step. */
typedef struct {
    double stretch[3], without_sliding[3], old[3], along[3], force[3], energy;
    fu_friction_end end;
    int slides, sticks, turns; /* the last: its direction follows the slip */
} fu_crossing_stick;

/* The force of friction on the first line and its derivatives, as kernels give them. */
typedef struct {
    double F[3], F_d[9], F_t[18], F_u[9], F_w[18], F_k[18];
} fu_crossing_stick_changes;

/* Makes how a point moves with its n coordinates: dr = P dq, dt = T dq; the numbers of these for fu_add in `at`. */
typedef struct {
    int n, at[FU_ATTACHMENT_COORDINATES];
    double P[3 * FU_ATTACHMENT_COORDINATES], T[3 * FU_ATTACHMENT_COORDINATES];
} fu_line_moves;

/* When lines are looked at: at a state; or, where `next` is not null, after the part x of a step of h, s, along the
 * cubics of places and velocities at both ends. */
typedef struct {
    const fu_state *now, *next;
    double h, x;
} fu_moment;

/* couplings/crossing/closest_points.c; the first: from arc-lengths s. */
void fu_find_closest_within(const fu_model *model, const fu_crossing *crossing, const fu_moment *moment,
                            const double s[FU_LINES], fu_closest_points *out);
void fu_find_closest(const fu_model *model, const fu_crossing *crossing, const fu_state *state, fu_closest_points *out);
/* Does the same at a state that may be far from the one that the numbers are of: of two finds it takes the closer one.
 */
void fu_find_closest_anew(const fu_model *model, const fu_crossing *crossing, const fu_state *state,
                          fu_closest_points *out);
/* Makes a line's point at an arc-length. */
void fu_line_point_of(const fu_model *model, const fu_crossing *crossing, int line, const fu_state *state, double s,
                      fu_line_point *out);
/* Computes how the curvatures change at closest points of a state. */
void fu_line_bends_at(const fu_model *model, const fu_crossing *crossing, const fu_state *state,
                      const fu_closest_points *points, fu_line_bends *out);
/* Returns the size of a line's pieces, m. */
double fu_line_size(const fu_model *model, const fu_crossing *crossing, int line);
void fu_line_moves_at(const fu_model *model, const fu_crossing *crossing, int line, const fu_state *state,
                      const fu_line_point *point, fu_line_moves *out);

/* couplings/crossing/contact_force.c: how far the lines are in contact, m, negative where they are not; not a number
 * where no points are the closest, though the lines may touch. */
double fu_crossing_distance_to_ends(const fu_crossing *crossing, const fu_closest_points *points);
double fu_crossing_margin(const fu_model *model, const fu_crossing *crossing, const fu_state *state);
double fu_crossing_margin_of(const fu_crossing *crossing, const fu_closest_points *points,
                             const fu_crossing_contact *contact);

/* couplings/crossing/continuous_detection.c: when lines that do not touch at the ends of a step of h do within it, by
 * more than `least`, m: half-way from the touch to where they part or their axes meet, or at the bottom of a dip, s
 * after the start of the step; 0 where they are not predicted to touch. */
double fu_crossing_detect_within(const fu_model *model, const fu_crossing *crossing, const fu_state *now,
                                 const fu_state *next, double h, double least);

/* couplings/crossing/friction.c */
void fu_crossing_stick_at(const fu_crossing *crossing, const fu_state *state, const fu_closest_points *points,
                          const fu_crossing_contact *contact, fu_crossing_stick *out);
void fu_crossing_stick_derivatives(const fu_crossing *crossing, const fu_state *state, const fu_closest_points *points,
                                   const fu_line_bends *bends, const fu_crossing_contact *contact,
                                   fu_crossing_stick_changes *by);
/* Returns what friction takes from one state of lines that touch to another, J; by_ends: by these alone. */
double fu_crossing_slip_work(const fu_model *model, const fu_crossing *crossing, const fu_state *from,
                             const fu_state *to, int by_ends);
double fu_crossing_history_error(const fu_model *model, const fu_coupling *coupling, const fu_state *from,
                                 const fu_state *to);
/* Lets the spring begin at a state, without stretch; take its stretch along to a state; begin as drawn. */
void fu_crossing_begin_stick(const fu_crossing *crossing, const fu_closest_points *points, fu_state *state);
void fu_crossing_update_stick(const fu_crossing *crossing, const fu_closest_points *points,
                              const fu_crossing_contact *contact, fu_state *state);
void fu_crossing_reset_stick(const fu_crossing *crossing, fu_state *state);

/* couplings/crossing/contact_force.c; the second: whether the normal has swung round since the last state, as where the
 * lines have been parallel. */
void fu_crossing_contact_at(const fu_crossing *crossing, const fu_closest_points *points, fu_crossing_contact *out);
int fu_crossing_swung(const fu_crossing *crossing, const fu_state *state, const fu_crossing_contact *contact);

/* couplings/crossing/energy_step.c; the first: the middle of a step, with the numbers and the flags of its end. */
fu_state fu_crossing_middle(const fu_equations *at);
void fu_crossing_step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                               double *own);
double fu_crossing_step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at);

/* couplings/crossing/clearance.c */
fu_clearance fu_crossing_clearance(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
void fu_crossing_between(const fu_model *model, const fu_coupling *coupling, int between[2]);

#endif
