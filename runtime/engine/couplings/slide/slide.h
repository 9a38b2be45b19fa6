/* Slides: couplings/slide/kinematics.c has their kernels over their coordinates, couplings/slide/slide.c what couplings
 * do. */
#ifndef FUNICULAR_COUPLINGS_SLIDE_SLIDE_H
#define FUNICULAR_COUPLINGS_SLIDE_SLIDE_H

#include "couplings/common/attachments.h"
#include "couplings/common/constraints.h"
#include "couplings/common/coupling.h"
#include "couplings/common/coupling_events.h"
#include "couplings/slide/end_stops.h"

/* A slide's own part of a state: its flags, and its numbers.
 *
 * mode: it slides; s is locked, at a signal or where it stands; the rider has left the cable. slip_direction: 1 or -1
 * where friction is against that direction whatever the speed. contact: 1 or -1 where it lies against what is at the
 * end or at the start. locked_s: s where it is locked, m. director: a unit vector across the tangent, carried along
 * with the slide. */
enum { FU_SLIDES, FU_LOCKED, FU_LEFT };
typedef struct {
    int mode, slip_direction, contact;
} fu_slide_flags;
typedef struct {
    double locked_s, director[FU_SPACE];
} fu_slide_numbers;

struct fu_slide {
    fu_coupling base; /* one coordinate, s; as many forces as dimensions, on the rider */
    const fu_slide_kernels *kernel;
    int cable;
    fu_attachment rider;
    int rider_is_rigid;                      /* the kernels take the rider's own configuration: it is a rigid body */
    int drive;                               /* signal that s follows, -1 */
    int carries_director;                    /* the element has none of its own */
    const fu_resistance_kernels *resistance; /* null where there are neither friction nor buffers */
    int sticks;                              /* friction holds it at rest, else it rises with the speed */
    double friction, static_friction, viscous, velocity; /* coefficients sliding and at rest; N s/m; m/s */
    fu_end_stop stops[2];                                /* at the start and at the end */
    double start_s, director[FU_SPACE];                  /* of the state in the initial configuration, as is the next */
    int start_segment;
};
extern const fu_coupling_type fu_slide_type;

/* How a slide moves at a state (eq 20-37), and its resistance R there. */
typedef struct {
    double C[3], G[FU_SLIDE_COORDINATES], s_rate, s_bias;
    double by_point[9];  /* derivatives of the rows in use by the rider's point, row by row */
    double R, driven_R;  /* of one that slides; of one that is driven */
    double power;        /* W: that goes to heat */
    double step, change; /* of R: the last step, and the change that the law asked for */
} fu_slide_state;

/* A slide's numbers in a row of output. traction: the force on the rider along the cable; of a slide that is driven
 * what its drive gives, over s: times s_rate it is the drive's power. */
typedef struct {
    double s_rate, s_acceleration, force[3], multiplier[2], traction, residual[3];
} fu_slide_output;

/* Those parts of a state, and of the work space of eq 38, that belong to slide number j. */
fu_slide_flags *fu_slide_flags_of(const fu_model *model, const fu_state *state, int j);
fu_slide_numbers *fu_slide_numbers_of(const fu_model *model, const fu_state *state, int j);
fu_slide_state *fu_slide_state_of(const fu_model *model, const fu_accelerator *work, int j);

int fu_slide_coordinates(const fu_model *model, const fu_state *state, int j, int *at);
double fu_slide_locked_s(const fu_model *model, const fu_state *state, int j, double *rate, double *second);
void fu_slide_residual(const fu_model *model, const fu_state *state, int j, double *phi, double *g);
void fu_slide_tangent(const fu_model *model, const fu_state *state, int j, const double *f, double *J, double *K);
void fu_slide_terms(const fu_model *model, const fu_state *state, int j, fu_rows *rows, fu_slide_state *slide_state);
double fu_slide_frame(const fu_model *model, const fu_state *state, int j, double A_t[9]);
double fu_slide_step(const fu_model *model, const fu_state *state, int j, double s, double A_t[9]);

/* couplings/slide/energy_step.c: residual and tangent over a step that conserves energy. */
void fu_slide_over_step(const fu_model *model, const fu_coupling *coupling, const fu_equations *step, double *f,
                        double *own);
void fu_slide_over_step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *step,
                                fu_system *system);

/* couplings/slide/position.c: s where C_l = 0, eq 21, nonzero where there is none; and the director that goes with it.
 */
int fu_find_arc_length(const fu_model *model, const fu_state *state, int slide, double *s);
void fu_update_director(const fu_model *model, const fu_coupling *coupling, fu_state *state);

/* couplings/slide/slide.c: how one slide moves, its ds/dt, and its numbers in a row of output. */
void fu_slide_now(const fu_model *model, const fu_state *state, int slide, fu_slide_state *slide_state);
double fu_slide_rate(const fu_model *model, const fu_state *state, int slide);
void fu_slide_outputs(const fu_model *model, const fu_state *state, int j, const double *acceleration,
                      const fu_accelerator *work, fu_slide_output *out);
/* couplings/slide/kinematics.c: the force on the rider by these multipliers. */
void fu_slide_force(const fu_model *model, const fu_accelerator *work, int j, const double *lambda, double *f);

/* couplings/slide/state.c */
double fu_length(const fu_model *model, int slide);
double fu_element_start(const fu_model *model, int slide, int element);

#endif
