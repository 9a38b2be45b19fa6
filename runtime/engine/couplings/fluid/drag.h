/* Public: forces of a moving fluid, drag, buoyancy and added mass: couplings/fluid/drag.c,
 * couplings/fluid/added_mass.c. */
#ifndef FUNICULAR_COUPLINGS_FLUID_DRAG_H
#define FUNICULAR_COUPLINGS_FLUID_DRAG_H

#include "base/common.h"
#include "couplings/common/attachments.h"
#include "couplings/common/coupling.h"
#include "couplings/common/span_elements.h"

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

#define FU_NO_SURFACE 1e300          /* m: beyond all heights (runtime/parts/fluid.py) */
#define FU_SURFACE_EVENT_FUNCTIONS 4 /* events of its two surfaces */

/* Wetted part of a cable's section or of a body's volume: all, or the part between surface and bottom of the fluid, of
 * a circle, a sphere, or a column (couplings/fluid/wetness.c). */
enum { FU_ALL_WET, FU_WET_SECTION, FU_WET_SPHERE, FU_WET_COLUMN };

/* The force of a fluid on a whole cable, on a span of a rope, or on a point of a body. */
typedef struct {
    fu_coupling base; /* base.has_inertia: with added mass */
    const fu_drag_kernels *kernel;
    fu_flow flow;
    int cable;              /* -1: at a point of a body, or along a span */
    fu_span_elements on;    /* the span of a rope; without kernels: none */
    double coefficients[3]; /* as the kernel takes them */
    double lift[2];         /* of a cable, arguments of the kernel: no lift if the first is zero */
    int is_foil; /* nonzero: forces depend on the angle of attack, of a body with a span or of a beam with a chord */
    double foil[2], span[3],
        chord[3];      /* of a body: arguments of the kernel; along its axes; in the plane span[0] is the sense */
    double foil_lift;  /* coefficient of lift without a polar; drag then has `coefficients` */
    double section[3]; /* of a beam, arguments of the kernel */
    int n_angles;      /* segments of the polynomials of the coefficients by the angle, in the form of a signal; */
    const double *angles, *polar_drag, *polar_lift, *polar_moment; /* polar_moment: of a beam alone */
    double buoyancy[3];     /* N/m a length of the undeformed cable, N on a body */
    int wet;                /* FU_ALL_WET, ..., FU_WET_COLUMN */
    double extent;          /* half the height of the wetted shape, m */
    double surface, bottom; /* heights of the fluid, m */
    double displaced;       /* mass of the fluid displaced: kg/m, kg */
    double added[9]; /* added mass: of a cable across and along it, kg/m; of a body in its axes (dim x dim), kg */
    int n_points;    /* of quadrature on an element */
    int stride;      /* points from one element's tables to the next's: 0 for equal elements */
    const double *weights, *N, *N_x, *N_chord; /* weights in m; shape functions, their slopes; of a beam's foil those of
                                                  the director along the chord */
    fu_attachment attachments[1];
} fu_drag;
extern const fu_coupling_type fu_drag_type;

/* A point of quadrature on an element: its weight in m, shape functions, their slopes, and those of the chord or null.
 */
typedef struct {
    double weight;
    const double *N, *N_x, *N_chord;
} fu_quadrature_point;

/* The points of quadrature of an element: shape functions of those beyond the tables, positions in the element, m, and
 * numbers of the parts between two cuts. */
#define FU_DRAG_POINTS 200
typedef struct {
    int n;
    int part[FU_DRAG_POINTS];
    fu_quadrature_point at[FU_DRAG_POINTS];
    double x[FU_DRAG_POINTS];
    double shapes[FU_DRAG_POINTS * FU_MAX_COORDINATES];
} fu_drag_points;

/* A wet part, and its derivatives by the height of the point, 1/m and 1/m^2. */
typedef struct {
    double part, slope, curvature;
} fu_wetness;

/* A point of a cable's axis, or of a body, in the fluid. r_x, its rate, and `a`, acceleration, of a cable only; the
 * director along the chord and its rate of a beam's foil only. Sums over shape functions fill whole blocks of numbers:
 * r to a, r_x and its rate, chord and its rate. */
enum { FU_DRAG_MOTION = 12, FU_DRAG_SLOPES = 8 };
typedef struct {
    union {
        struct {
            double r[3], v[3], a[3];
        };
        double by_N[FU_DRAG_MOTION];
    };
    union {
        struct {
            double r_x[3], r_x_rate[3];
        };
        double by_N_x[FU_DRAG_SLOPES];
    };
    union {
        struct {
            double chord[3], chord_rate[3];
        };
        double by_N_chord[FU_DRAG_SLOPES];
    };
} fu_drag_place;

/* Forces of the fluid at a point: the fluid's velocity with derivatives, and that relative to the point; drag and lift
 * with their derivatives, and buoyancy, all of the wet part; by_wet: derivative of their sum by position through the
 * wet part. of_section: of a beam's foil the forces on r, r_x and chord, with their derivatives by r_x, chord and w; f
 * includes the first. */
typedef struct {
    fu_flow_state flow;
    double w[3], f[3], buoyancy[3], by_wet[9], by_slope[9], by_w[9], by_turn[9], of_section[9], section_by[81];
} fu_drag_action;

/* Dissipated power, and external power by the fluid, W. */
typedef struct {
    double dissipated, external;
} fu_drag_powers;

/* Sums of forces, each of which may be null. f: on the left of the equations of motion; total: on the cable or body. */
typedef struct {
    double *f, *total;
    fu_drag_powers *power;
} fu_drag_sums;

/* Returns whether the forces act on a beam and depend on the angle of attack of its section. */
static inline int fu_drag_on_section(const fu_drag *drag)
{
    return drag->cable >= 0 && drag->is_foil;
}

/* A point of quadrature on an element whose first dof is `first`: number of its part between two cuts, and position in
 * the element, m. */
typedef struct {
    int element, first, part;
    double x;
    fu_quadrature_point point;
    fu_drag_place at;
} fu_drag_site;

/* Arguments and results of a loop over points: a visitor uses those of its purpose. rows: the next row of densities;
 * energy: a kinetic energy, J, relative to the fluid or in a fluid at rest. */
typedef struct {
    double t;
    const fu_drag_sums *sums;
    int has_matrix;
    fu_weights weights;
    double *rows;
    int n_rows;
    double energy;
    int past_fluid;
} fu_drag_loop;
typedef void fu_drag_visitor(const fu_model *model, const fu_drag *drag, const fu_drag_site *site, fu_drag_loop *loop,
                             double *K);

/* couplings/fluid/quadrature.c */
fu_quadrature_point fu_drag_point(const fu_drag *drag, int n, int element, int point);
/* Return the number of nodes of the cable or the span, and the place of one. */
int fu_drag_nodes(const fu_model *model, const fu_drag *drag);
const double *fu_drag_node(const fu_model *model, const fu_drag *drag, int k, const double *q);
/* The motion of an element of a cable, a row for each nodal vector: coordinates, rates and accelerations (zero
 * without); coordinates and rates relative to the first node, for slopes: they do not depend on its position, and no
 * digits are lost far from the origin. */
typedef struct {
    int n;
    double by_N[FU_MAX_COORDINATES / 2][FU_DRAG_MOTION], by_N_x[FU_MAX_COORDINATES / 2][FU_DRAG_SLOPES];
} fu_drag_motion;
void fu_drag_motion_of(const fu_cable *cable, const double *e, const double *v, const double *a, fu_drag_motion *out);
/* Computes the motion of a point of quadrature on an element; that of the chord if the point has its shape functions.
 */
void fu_drag_place_on_axis(const fu_drag_motion *of, const fu_quadrature_point *point, fu_drag_place *at);

/* couplings/fluid/point_loop.c: calls `visit` at each point of a cable with the coordinates q, rates v and
 * accelerations a (null: none). K: matrix of the element, which is added to the system (or to none, null) after its
 * points if loop->has_matrix. */
void fu_drag_visit(const fu_model *model, const fu_drag *drag, const double *q, const double *v, const double *a,
                   fu_drag_visitor *visit, fu_drag_loop *loop, fu_system *system);

/* couplings/fluid/wetness.c: the wet part at a height; the height of a point, m; the points of quadrature of an element
 * at the coordinates e, on a span without shape functions, and over a step between two coordinates. */
fu_wetness fu_wet_at_height(const fu_drag *drag, double height);
fu_wetness fu_wet_part(const fu_model *model, const fu_drag *drag, const double *r); /* at a point */
double fu_wet_reach(const fu_drag *drag); /* largest distance from a surface at which the wet part changes, m */
double fu_drag_height(const fu_model *model, const fu_drag *drag, const double *r);
void fu_drag_points_on(const fu_model *model, const fu_drag *drag, int element, const double *e, fu_drag_points *out);
void fu_drag_points_on_span(const fu_model *model, const fu_drag *drag, const fu_span_element *on, fu_drag_points *out);
void fu_drag_points_over(const fu_model *model, const fu_drag *drag, int element, const double *e, const double *e_next,
                         fu_drag_points *out);

/* couplings/fluid/drag.c: computes out (points x FU_DRAG_DENSITIES), of each point of quadrature of a cable: number of
 * the element, number of the part, position in the element, m, weight, m, and drag with buoyancy, N/m (3). Returns the
 * number of points. */
#define FU_DRAG_DENSITIES 7
int fu_drag_densities(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *out);

/* couplings/fluid/drag_force.c: computes the forces of the fluid at a point; A: axes of the body. */
void fu_drag_act(const fu_model *model, const fu_drag *drag, double t, const fu_drag_place *at, const double *A,
                 fu_drag_action *out);
/* Compute the derivative of drag by position (dim x dim); the force of drag and buoyancy, N/m or N, times the load
 * fraction. Adds the powers at a point of this weight to `sum`. */
void fu_drag_by_place(int dim, const fu_drag_action *a, double out[9]);
void fu_drag_whole_force(const fu_model *model, const fu_drag_action *a, double force[3]);
void fu_drag_add_powers(const fu_model *model, const fu_drag_place *at, const fu_drag_action *a, double weight,
                        fu_drag_powers *sum);

/* couplings/fluid/span_drag.c: add drag and buoyancy on the material in a span of a rope, and their derivatives. */
void fu_add_span_drag(const fu_model *model, const fu_drag *drag, const fu_state *state, const fu_drag_sums *sums);
void fu_add_span_drag_matrix(const fu_model *model, const fu_drag *drag, const fu_state *state, fu_weights weights,
                             fu_system *system);

/* couplings/fluid/span_added_mass.c: the same as of cables, below, along a span of a rope. */
void fu_span_added_mass_forces(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *a,
                               const fu_drag_sums *sums);
void fu_span_added_mass_tangent(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *a,
                                fu_weights weights, fu_system *system);
void fu_span_added_mass_force(const fu_model *model, const fu_drag *drag, const double *q, const double *a, double *f);
void fu_span_added_mass_matrix(const fu_model *model, const fu_drag *drag, const double *q, double scale,
                               fu_system *system);
double fu_span_added_mass_kinetic_energy(const fu_model *model, const fu_drag *drag, double t, const double *q,
                                         const double *v, int past_fluid);

/* couplings/fluid/section_moment.c: forces on slope and chord of a beam's foil at a point of quadrature, their power,
 * and their derivatives. */
double fu_section_power(const fu_drag_place *at, const fu_drag_action *action);
void fu_section_forces(const fu_drag_action *action, fu_quadrature_point point, double part, int n, double *f);
void fu_section_matrix(const fu_drag_action *action, fu_quadrature_point point, double scale, double rate, int all,
                       double *K);

/* flags of a state: one of the table, one of each event function of surfaces */
#define FU_DRAG_FLAGS (1 + FU_SURFACE_EVENT_FUNCTIONS)

/* couplings/fluid/added_mass.c: inertial forces of the fluid at a point of a cable, and their derivatives; on spans and
 * bodies with the accelerations `a` of the dofs (null: zero). */
fu_drag_visitor fu_added_mass_at, fu_added_mass_tangent_at;
void fu_added_mass_forces(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *a,
                          const fu_drag_sums *sums);
void fu_added_mass_tangent(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *a,
                           const double *psi, fu_weights weights, fu_system *system);
/* Computes the inertial forces of the fluid per length of a cable at zero accelerations, at all points of quadrature:
 * out (points x FU_ADDED_MASS_DENSITIES), the force (3) and the force on the slope (3) on the cable, and the added mass
 * (dim x dim of 9). */
#define FU_ADDED_MASS_DENSITIES 15
void fu_added_mass_densities(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *out);
/* Adds a force on the particles and one on the slope, at a point of quadrature, to the forces on an element's dofs. */
void fu_fluid_on_element(const fu_model *model, const fu_drag *drag, int first, fu_quadrature_point point,
                         const double *left, const double *on_slope, const fu_drag_sums *sums);

/* couplings/fluid/added_mass_matrix.c */
void fu_added_mass_force(const fu_model *model, const fu_coupling *coupling, const double *q, const double *a,
                         double *f);
void fu_added_mass_matrix(const fu_model *model, const fu_coupling *coupling, const double *q, double scale,
                          fu_system *system);
double fu_added_mass_kinetic_energy(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                                    const double *v, int past_fluid);

/* couplings/fluid/added_mass_energy_step.c */
void fu_added_mass_step_forces(const fu_model *model, const fu_drag *drag, const fu_equations *at,
                               const fu_drag_sums *sums);

#endif
