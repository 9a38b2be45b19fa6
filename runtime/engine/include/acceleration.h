/* Accelerations by eq 38: run/acceleration.c. */
#ifndef FUNICULAR_ACCELERATION_H
#define FUNICULAR_ACCELERATION_H

#include "constraints.h"
#include "linear.h"
#include "slides.h"

/* Eq 38 and what comes out of it */
typedef struct {
    fu_system mass;   /* [M H'; H 0], its band factored once */
    double *corner;   /* m x m: D of M, before joints are added and it is factored */
    double *rhs;      /* unknowns, and FU_BAND_BEYOND */
    fu_rows *rows;    /* of the slides, then of the joints */
    fu_slide_state *slide_states;
    double *force, *work, *prescribed; /* n_dof */
    double *multipliers;  /* of slides and joints, as eq 38 gives them */
    double *resistance;      /* per slide: R; then the power that brakes take; then of each slide's R the last step and its cause */
    double *driven_resistance;   /* per slide: R of one that is driven */
    int jammed;           /* slide whose R was not found, -1 */
    double *slides;       /* FU_SLIDE_OUTPUTS a joint */
    long evaluated;       /* how often it was */
} fu_accelerator;
/* traction: the force on the rider along the cable; of a slide that is driven what its drive gives, over s: times s_rate it is
 * the drive's power */
typedef struct {
    double s_rate, s_acceleration, force[3], multiplier[2], traction, residual[3];
} fu_slide_output;
typedef struct {
    double force[3], moment[3], residual; /* on the second end's carrier, at its point; the largest of phi */
} fu_joint_output;
int fu_accelerator_prepare(const fu_model *model, fu_accelerator *work);
int fu_accelerations(const fu_model *model, const fu_state *state, fu_accelerator *work, double *acceleration,
                     fu_slide_output *slides, double *reaction);
void fu_joint_outputs(const fu_model *model, const fu_state *state, const fu_accelerator *work, fu_joint_output *out);
int fu_compliance(const fu_model *model, const fu_state *state, fu_accelerator *work, double *S);
int fu_project_positions(const fu_model *model, const fu_state *state, fu_accelerator *work, double *change);
int fu_project_velocities(const fu_model *model, const fu_state *state, fu_accelerator *work, double *change);
int fu_strike(const fu_model *model, const fu_state *state, fu_accelerator *work, int slide, double *change);
void fu_slide_now(const fu_model *model, const fu_state *state, int slide, fu_slide_state *slide_state);
double fu_slide_rate(const fu_model *model, const fu_state *state, int slide);
int fu_find_arc_length(const fu_model *model, const fu_state *state, int slide, double *s);
void fu_carry_directors(const fu_model *model, fu_state *state);

#endif
