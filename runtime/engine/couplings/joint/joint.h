/* Public: joints between two attachments: couplings/joint/equations.c has their equations, couplings/joint/joint.c
 * their operations as couplings. */
#ifndef FUNICULAR_COUPLINGS_JOINT_JOINT_H
#define FUNICULAR_COUPLINGS_JOINT_JOINT_H

#include "couplings/common/attachments.h"
#include "couplings/common/coupling.h"
#include "couplings/common/sticking.h"

/* A joint between two attachments; the drive sets c = distance or angle to its base + its signal. */
typedef struct {
    fu_coupling base; /* as many forces, multipliers, as equations */
    const fu_joint_kernels *kernel;
    fu_attachment attachments[2];
    int signal;
    int of_points;      /* its equations contain the two points alone, without rotations */
    int redundant_rows; /* bits of rows that depend on other joints' rows: their multipliers are zero */
    int is_free;        /* they are motions that a joint leaves free: the angle is that of the state */
    double c0;          /* m or rad: c without the signal */
} fu_joint;
extern const fu_coupling_type fu_joint_type;

/* Friction of a joint, couplings/joint/friction.c, against the motions that it leaves free. Each has an arm, from its
 * rate to the speed of sliding: m for a rotation, 1 for a displacement. The normal force is that of the joint, a
 * coupling of this number, or the given one, N, for -1. */
typedef struct {
    fu_joint free; /* the free motions as equations; as many internal forces, of friction */
    int pressed_by;
    double normal_force, arms[2];
    double coefficient, static_coefficient, viscous, velocity; /* sliding and at rest; N s/m; m/s */
    int scale;                                                 /* signal of a factor of the former three, -1 */
} fu_joint_friction;
extern const fu_coupling_type fu_joint_friction_type, fu_joint_sticking_type;

/* The part of a state of friction that sticks, of one free motion: c of its joint while it is locked, m or rad. */
typedef struct {
    double locked[3]; /* c, its cosine and sine */
} fu_joint_sticking_numbers;

/* The numbers of a joint, and of its friction, in a row of output. */
typedef struct {
    double force[3], moment[3], residual; /* on the second attachment, at its point; the largest of phi */
} fu_joint_output;

/* A joint's equations at a state: phi; for both attachments the numbers of their n coordinates for fu_add, and the
 * derivatives J of phi by these (rows x n). */
typedef struct {
    int n[2], at[2][FU_ATTACHMENT_COORDINATES];
    double phi[6], J[2][6 * FU_ATTACHMENT_COORDINATES];
} fu_joint_rows_at;

/* Derivatives for both attachments likewise; K[f][e]: those of J[f]' multipliers by the coordinates of e (n[f] x n[e]),
 * which are stored behind J[e]; zero between two attachments unless `across`. */
typedef struct {
    int n[2], at[2][FU_ATTACHMENT_COORDINATES], across;
    double *K[2][2], J[2][(6 + 2 * FU_ATTACHMENT_COORDINATES) * FU_ATTACHMENT_COORDINATES];
} fu_joint_derivatives;

int fu_joint_is_inactive(const fu_model *model, const fu_joint *joint, const fu_state *state);
void fu_joint_equations(const fu_model *model, const fu_joint *joint, const fu_state *state, fu_joint_rows_at *out);
void fu_joint_rows(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_accelerator *work);
/* The multipliers are those whose forces J' multipliers are differentiated. */
void fu_joint_tangent(const fu_model *model, const fu_joint *joint, const fu_state *state, const double *multipliers,
                      fu_joint_derivatives *out);
void fu_joint_outputs(const fu_model *model, const fu_joint *joint, const fu_state *state, const double *multipliers,
                      fu_joint_output *out);
/* Friction that sticks, couplings/joint/state.c: its flags and numbers; c of its joint if it is locked, else null. */
fu_sticking_flags *fu_joint_sticking_flags(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
fu_joint_sticking_numbers *fu_joint_sticking_numbers_of(const fu_coupling *coupling, const fu_state *state);
const double *fu_joint_locked(const fu_joint *joint, const fu_state *state);
/* Locks it at its place in a state; the rate of its motion; the force of its lock, `pull`, and the excess of that at
 * the radius over what can hold it, N, by the multipliers of all couplings, null: by the forces of the state. */
void fu_joint_lock(const fu_model *model, const fu_coupling *coupling, fu_state *state);
double fu_joint_free_rate(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
double fu_joint_excess(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const double *lambda,
                       double *pull);
void fu_joint_free_place(const fu_model *model, const fu_joint *joint, const fu_state *state, double c[3]);
int fu_joint_moves(const fu_model *model, const fu_joint *joint, const fu_state *state, int at);
int fu_between_cables(const fu_joint *joint);
int fu_ties_a_frame(const fu_model *model, int which);

#endif
