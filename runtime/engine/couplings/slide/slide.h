/* Slides: couplings/slide/kinematics.c has their kernels over their coordinates, couplings/slide/slide.c their
 * operations as couplings, couplings/slide/resistance.c friction and buffers; events/end_stops.c has the actions of end
 * stops. */
#ifndef FUNICULAR_COUPLINGS_SLIDE_SLIDE_H
#define FUNICULAR_COUPLINGS_SLIDE_SLIDE_H

#include "couplings/common/attachments.h"
#include "couplings/common/accelerator.h"
#include "couplings/common/coupling.h"
#include "couplings/common/coupling_events.h"
#include "couplings/common/span_elements.h"
#include "couplings/common/sticking.h"

/* End stop at an end of a cable: the restitution of a hard stop; the length before the end, m, the stiffness, N/m, and
 * the damping, N s/m, of a buffer. */
enum { FU_END_IS_ERROR, FU_END_IS_OPEN, FU_END_IS_HARD, FU_END_IS_BUFFERED };
typedef struct {
    int kind;
    double restitution, length, stiffness, damping;
} fu_end_stop;

extern const char *const fu_end_stop_kinds[]; /* their words: couplings/slide/state.c */

/* A slide's part of a state: its flags, and its numbers.
 *
 * mode, slip_direction: those of fu_sticking_flags, which they begin with; s is locked. contact: 1 or -1 in contact
 * with the stop at the end or at the start. locked_s: s of a locked slide, m. director: a unit vector normal to the
 * tangent that follows the slide. */
typedef struct {
    int mode, slip_direction, contact;
} fu_slide_flags;
typedef struct {
    double locked_s, director[FU_SPACE];
} fu_slide_numbers;

struct fu_slide {
    fu_coupling base; /* one coordinate, s; as many forces as dimensions, on the rider */
    const fu_slide_kernels *kernel;
    int cable;           /* -1 on a rope */
    fu_span_elements on; /* elements of the span of a rope, whose kernel is null on a cable; s is material */
    fu_attachment rider;
    int rider_is_rigid;                      /* the kernels take the rider's own configuration: it is a rigid body */
    int drive;                               /* signal of s, -1 */
    int carries_director;                    /* the element has no director */
    const fu_resistance_kernels *resistance; /* null without friction and buffers */
    int sticks;                              /* friction holds it at rest, else friction rises with the speed */
    double friction, static_friction, viscous, velocity; /* coefficients sliding and at rest; N s/m; m/s */
    int friction_scale;                                  /* signal of a factor of the former three, -1 */
    fu_end_stop stops[2];                                /* at the start and at the end */
    /* of the state in the initial configuration, as the next members */
    double start_s, director[FU_SPACE];
    int start_segment;
};
extern const fu_coupling_type fu_slide_type;

/* Motion of a slide at a state (eq 20-37), and its resistance R there. */
typedef struct {
    double C[3], G[FU_SLIDE_COORDINATES], s_rate, s_bias;
    double by_point[9];  /* derivatives of the active rows by the rider's point, row by row */
    double R, driven_R;  /* of a sliding one; of a driven one */
    double power;        /* W: dissipated */
    double step, change; /* of R: the last step, and the change by the law */
} fu_slide_state;

/* A slide's numbers in a row of output. traction: the force on the rider along the cable; for a driven slide that of
 * its drive, over s: times s_rate it is the drive's power. */
typedef struct {
    double s_rate, s_acceleration, force[3], multiplier[2], traction, residual[3];
} fu_slide_output;

/* The parts of a state, and of the work space of eq 38, of slide number j. */
fu_slide_flags *fu_slide_flags_of(const fu_model *model, const fu_state *state, int j);
fu_slide_numbers *fu_slide_numbers_of(const fu_model *model, const fu_state *state, int j);
fu_slide_state *fu_slide_state_of(const fu_model *model, const fu_accelerator *work, int j);

int fu_slide_coordinates(const fu_model *model, const fu_state *state, int j, int *at);
double fu_slide_locked_s(const fu_model *model, const fu_state *state, int j, double *rate, double *second);
/* Converts n derivatives by both ends of an element of a rope, `first` and those beside it by `beside`, each `stride`
 * apart, to those by the ends of the span; on a cable there are none. */
void fu_slide_to_ends_of_span(const fu_slide *slide, int element, double *derivatives, int n, int stride, int beside);
void fu_slide_residual(const fu_model *model, const fu_state *state, int j, double *phi, double *g);
void fu_slide_tangent(const fu_model *model, const fu_state *state, int j, const double *f, double *J, double *K);
void fu_slide_terms(const fu_model *model, const fu_state *state, int j, fu_rows *rows, fu_slide_state *slide_state);
double fu_slide_frame(const fu_model *model, const fu_state *state, int j, double A_t[9]);
double fu_slide_step(const fu_model *model, const fu_state *state, int j, double s, double A_t[9]);

/* couplings/slide/energy_step.c: residual and tangent over a step that conserves energy. */
void fu_slide_over_step(const fu_model *model, const fu_coupling *coupling, const fu_equations *step, double *f,
                        double *internal);
void fu_slide_over_step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *step,
                                fu_system *system);

/* couplings/slide/position.c: s with C_l = 0, eq 21, nonzero without one; and its director. */
int fu_find_arc_length(const fu_model *model, const fu_state *state, int slide, double *s);
void fu_update_director(const fu_model *model, const fu_coupling *coupling, fu_state *state);

/* couplings/slide/slide.c: motion of one slide, its ds/dt, and its numbers in a row of output. */
void fu_slide_now(const fu_model *model, const fu_state *state, int slide, fu_slide_state *slide_state);
double fu_slide_rate(const fu_model *model, const fu_state *state, int slide);
void fu_slide_outputs(const fu_model *model, const fu_state *state, int j, const double *acceleration,
                      const fu_accelerator *work, fu_slide_output *out);
/* couplings/slide/kinematics.c: the force on the rider by these multipliers. */
void fu_slide_force(const fu_model *model, const fu_accelerator *work, int j, const double *lambda, double *f);

/* couplings/slide/state.c: s at both ends of a slide's cable or span, m, and their distance; s at the first node of an
 * element; the mean length of elements, m; the number of coordinates of an element: on a rope those of its nodes, and s
 * of both ends of the span. */
void fu_slide_ends(const fu_model *model, const fu_state *state, int slide, double ends[2]);
double fu_length(const fu_model *model, const fu_state *state, int slide);
double fu_element_start(const fu_model *model, const fu_state *state, int slide, int element);
double fu_mean_element(const fu_model *model, const fu_state *state, int slide);
int fu_slide_elements(const fu_model *model, int slide);
int fu_slide_element_coordinates(const fu_model *model, int slide);

/* R of a slide, the force along its cable times r_x, and its derivatives */
typedef struct {
    double R, by_t[3], by_u[3], by_f[3], by_s;
} fu_resistance;

void fu_resistance_at(const fu_model *model, const fu_state *state, int j, const double *t, const double *u,
                      const double *f, fu_resistance *resistance);
double fu_compression(const fu_model *model, const fu_state *state, int j, int side);
void fu_slide_motion(const fu_model *model, const fu_state *state, int j, const double *J, double *t, double *u);
void fu_resistance_rows(const fu_model *model, const fu_state *state, int j, const double *J,
                        const fu_resistance *resistance, double *by_place, double *by_rate);

/* Operations of a slide as a coupling (couplings/common/coupling.h). */
double fu_resistance_update(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                            const double *lambda, fu_accelerator *work);
void fu_resistance_accept(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const double *lambda, fu_accelerator *work);
double fu_resistance_friction_error(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int n,
                                    const double *weights, const double *multipliers, double square);
double fu_resistance_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                                 const fu_accelerator *work);
double fu_buffer_energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
double fu_lost_in_buffers(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                          int by_ends);
void fu_detect_buffers(const fu_model *model, const fu_coupling *coupling, fu_state *state);

#endif
