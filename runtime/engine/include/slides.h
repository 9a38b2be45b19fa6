/* Slides: couplings/slides.c. */
#ifndef FUNICULAR_SLIDES_H
#define FUNICULAR_SLIDES_H

#include "attachments.h"
#include "constraints.h"
#include "end_stops.h"

/* A slide_state. It slides, or s is held, at a signal or where it stands, or the rider has left the cable. */
enum { FU_SLIDES, FU_LOCKED, FU_LEFT };
typedef struct {
    const fu_slide_kernels *kernel;
    int cable;
    fu_attachment rider;
    int rider_is_rigid;              /* the kernels take the rider's own configuration: it is a rigid body */
    int unknown, multiplier; /* places beyond the border's dofs: of s and the force, of the multipliers of eq 38 */
    int max_multipliers;                /* multipliers that it has: one more where it may be held */
    int drive;               /* signal that s follows, -1 */
    int carries_director;    /* the element has none of its own */
    double mass; /* scale of the constraint rows, kg */
    const fu_resistance_kernels *resistance;   /* null where there are neither friction nor buffers */
    int sticks;              /* friction holds it at rest, else it rises with the speed */
    double friction, static_friction, viscous, velocity; /* coefficients sliding and at rest; N s/m; m/s */
    fu_end_stop stops[2];        /* at the start and at the end */
} fu_slide;

typedef struct {
    double C[3], G[FU_SLIDE_COORDINATES], s_rate, s_bias;
    double by_point[9]; /* derivatives of the rows in use by the rider's point, row by row */
} fu_slide_state;
int fu_slide_coordinates(const fu_model *model, const fu_state *state, int j, int *at);
double fu_slide_held(const fu_model *model, const fu_state *state, int j, double *rate, double *second);
void fu_slide_residual(const fu_model *model, const fu_state *state, int j, double *phi, double *g);
void fu_slide_tangent(const fu_model *model, const fu_state *state, int j, const double *f, double *J, double *K);
void fu_slide_terms(const fu_model *model, const fu_state *state, int j, fu_rows *rows, fu_slide_state *slide_state);
double fu_slide_step(const fu_model *model, const fu_state *state, int j, double s, double A_t[9]);

#endif
