/* The velocity of a fluid by position and time: couplings/fluid/velocity_field.c. */
#ifndef FUNICULAR_COUPLINGS_FLUID_VELOCITY_FIELD_H
#define FUNICULAR_COUPLINGS_FLUID_VELOCITY_FIELD_H

#include "base/common.h"

#define FU_FLOW_AXES 4   /* of a table: time, and three directions of the ground */
#define FU_FLOW_DEGREE 3 /* largest degree of its splines */

/* Profiles of the velocity over height: constant; a power of the height; a table. */
enum { FU_UNIFORM, FU_POWER, FU_TABLE };

/* The velocity of a fluid: a signal (-1: one) times `velocity` times the profile at the height base + up . r, or times
 * a table. */
typedef struct {
    double velocity[3], up[3], base; /* base: height of the origin, m */
    int signal, profile;
    double reference, exponent, least; /* of a power: (max(height, least)/reference)^exponent, heights in m */
    int n_segments;                    /* of a table over height: polynomials, in the form of a signal */
    const double *breaks, *coefficients;
    /* Of a table over time and position: degree of its B-splines, 0 without a table; along each axis their number and
     * their knots, one axis after the other; a single spline without knots if the velocity does not depend on the axis;
     * their coefficients (t, x, y, z, dim). Coordinates on the table's axes: origin + axes r, axes (3 x 3) by rows. */
    int degree, n_splines[FU_FLOW_AXES];
    const double *knots, *table;
    double origin[3], axes[9];
} fu_flow;

/* The velocity at a point, its rate there, and its gradient by r (dim x dim), row i of component i. */
typedef struct {
    double U[3], rate[3], gradient[9];
} fu_flow_state;

void fu_flow_at(const fu_model *model, const fu_flow *flow, double t, const double *r, fu_flow_state *out);
double fu_flow_margin(const fu_model *model, const fu_flow *flow, double t, const double *r);

#endif
