/* Joints between two attachments: couplings/joints.c. */
#ifndef FUNICULAR_JOINTS_H
#define FUNICULAR_JOINTS_H

#include "attachments.h"
#include "constraints.h"
#include "slides.h"

/* A joint between two ends; c = base + its signal drives it. */
typedef struct {
    const fu_joint_kernels *kernel;
    fu_attachment ends[2];
    int unknown, multiplier, signal;
    int redundant_rows; /* bits of the rows that other joints' imply: their multipliers are nil */
    double base, scale[6]; /* scale of its rows, kg or kg m */
} fu_joint;

int fu_joint_is_inactive(const fu_joint *joint, const fu_state *state);
int fu_joint_residual(const fu_model *model, const fu_joint *joint, const fu_state *state, double *phi, int *at, double *J);
int fu_between_cables(const fu_joint *joint);
int fu_ties_a_frame(const fu_model *model, int which);
int fu_joint_tangent(const fu_model *model, const fu_joint *joint, const fu_state *state, int *at, double *J, double *K);
void fu_joint_terms(const fu_model *model, const fu_joint *joint, const fu_state *state, const fu_slide_state *slide_states,
                   const fu_rows *of_slides, fu_rows *rows);

#endif
