/* Public: forces of a moving fluid, drag, buoyancy and added mass: couplings/fluid/drag.c,
 * couplings/fluid/added_mass.c. */
#ifndef FUNICULAR_COUPLINGS_FLUID_DRAG_H
#define FUNICULAR_COUPLINGS_FLUID_DRAG_H

#include "base/common.h"
#include "bodies/cables.h"
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

/* Linear waves on the surface of a fluid: the vectors of n (n x dim), and their numbers as the kernels take them; the
 * reciprocal of the depth, 0 for infinite depth; the sum of the amplitudes, which no elevation exceeds, m. move_fluid:
 * zero in the fluid above the surface. */
#define FU_WAVE_NUMBERS 5
#define FU_MAX_WAVES 1000
typedef struct {
    int n_waves, move_fluid;
    const double *wave_vectors, *wave_numbers;
    double inv_depth, max_elevation;
} fu_waves;

/* The elevation of a surface at a place, m, its rate there, and its derivatives by the place. */
typedef struct {
    double eta, rate, slope[3];
} fu_elevation;

#define FU_NO_SURFACE 1e300          /* m: beyond all heights (runtime/parts/fluid.py) */
#define FU_SURFACE_EVENT_FUNCTIONS 4 /* events of its two surfaces */

/* Wetted part of a cable's section or of a body's volume: all, or the part between surface and bottom of the fluid, of
 * a circle, a sphere, or a column (couplings/fluid/wetness.c). */
enum { FU_ALL_WET, FU_WET_SECTION, FU_WET_SPHERE, FU_WET_COLUMN };

/* A ring of ice on a cable, see couplings/ice/ice.h: whether there is one, and its thickness, a signal times a factor.
 * Diameters of drag and of the cable under the ice, m; buoyancy of a ring by thickness (diameter + thickness), N/m^3.
 */
typedef struct {
    int has_ice, signal;
    double factor, width, diameter, buoyancy[3];
} fu_iced;

/* The force of a fluid on a whole cable, on a span of a rope, or on a point of a body. */
typedef struct {
    fu_coupling base; /* base.has_inertia: with added mass */
    const fu_drag_kernels *kernel;
    fu_flow flow;
    fu_waves waves;
    int cable;              /* -1: at a point of a body or of a cable, or along a span */
    int first, n_elements;  /* elements of the cable on which it acts */
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
    fu_iced iced;           /* of a cable, which has no inertia of the fluid and no polar, and no surface cuts it */
    int wet;                /* FU_ALL_WET, ..., FU_WET_COLUMN */
    double extent;          /* half the height of the wetted shape, m */
    double surface, bottom; /* heights of the fluid, m */
    double displaced;       /* mass of the fluid displaced: kg/m, kg */
    int is_morison;         /* nonzero: inertial forces are those of Morison's equation, not Lagrange's */
    double added[9]; /* added mass: of a cable across and along it, kg/m; of a body in its axes (dim x dim), kg */
    int n_points;    /* of quadrature on an element */
    int stride;      /* points from one element's tables to the next's: 0 for equal elements */
    const double *weights, *N, *N_x, *N_chord; /* from the first element on, weights in m; shape functions, their
                                                  slopes; of a beam's foil those of the director along the chord */
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

/* A wet part, its derivatives by the height of the point above the surface, 1/m and 1/m^2, and its rate at a fixed
 * place, 1/s; up: derivatives of that height by the place. */
typedef struct {
    double part, slope, curvature, rate, up[3];
} fu_wetness;

/* A point of a body, or of the material in a span of a rope, in the fluid. r_x, the slope, and `a`, acceleration, of a
 * span only. */
typedef struct {
    double r[3], v[3], a[3], r_x[3];
} fu_drag_place;

/* Forces of the fluid at a point: the fluid's velocity with derivatives, and that relative to the point; drag and lift
 * with their derivatives, and buoyancy, all of the wet part; by_wet: derivative of their sum by position through the
 * wet part. */
typedef struct {
    fu_flow_state flow;
    double w[3], f[3], buoyancy[3], by_wet[9], by_slope[9], by_w[9], by_turn[9];
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

/* Along a cable points of quadrature of an element are evaluated side by side, FU_BLOCK_POINTS in a block: a number of
 * each in fu_points. Points beyond the n of a block repeat the last one with the weight zero. */
enum { FU_MAX_SHAPES = FU_MAX_COORDINATES / 2 };
typedef struct {
    int n, shapes, has_chord;
    fu_points weight, N[FU_MAX_SHAPES], N_x[FU_MAX_SHAPES], N_chord[FU_MAX_SHAPES];
} fu_block_shapes;

/* Motion of the points of a block; chord and its rate of a beam's foil only. */
typedef struct {
    fu_points r[3], v[3], a[3], r_x[3], r_x_rate[3], chord[3], chord_rate[3];
} fu_block_motion;

/* The fluid at the points of a block: as fu_flow_state and fu_wetness. */
typedef struct {
    fu_points U[3], rate[3], gradient[9], wet[4], up[3]; /* wet: without its up */
} fu_block_fluid;

/* Forces at the points of a block, as fu_drag_action. of_section: of a beam's foil the forces on r, r_x and chord, with
 * their derivatives by r_x, chord and w; f includes the first. */
typedef struct {
    fu_points w[3], f[3], buoyancy[3], by_wet[9], by_slope[9], by_w[9], of_section[9], section_by[81];
} fu_block_action;

/* Kernels at blocks of points, with their arguments that are the same at all points. */
typedef struct {
    const fu_drag_blocks *kernel;
    int is_morison;
    fu_points coefficients[3], lift[2], section[3], added[2], displaced, buoyancy[3];
} fu_block_constants;

/* A block of points from the k-th of an element on, whose first dof is `first`. */
typedef struct {
    int element, first, from;
    const fu_drag_points *points;
    const fu_block_constants *constants;
    fu_block_shapes shapes;
    fu_block_motion motion;
    fu_block_fluid fluid;
} fu_drag_block;

/* Arguments and results of a loop over blocks: a visitor uses those of its purpose. has_drag, has_inertia: forces that
 * are added; rows: the next row of densities; energy: a kinetic energy, J. */
typedef struct {
    double t;
    const fu_drag_sums *sums;
    int has_drag, has_inertia, has_matrix, is_still; /* is_still: the velocity of the fluid is taken as zero */
    fu_weights weights;
    double *rows;
    int n_rows;
    double energy;
} fu_drag_loop;
typedef void fu_drag_visitor(const fu_model *model, const fu_drag *drag, const fu_drag_block *block, fu_drag_loop *loop,
                             double *K);

/* couplings/fluid/quadrature.c */
fu_quadrature_point fu_drag_point(const fu_drag *drag, int n, int element, int point);
/* Return the number of nodes of the cable or the span, and the place of one. */
int fu_drag_nodes(const fu_drag *drag);
const double *fu_drag_node(const fu_model *model, const fu_drag *drag, int k, const double *q);

/* couplings/fluid/point_block.c: the shape functions of a block of points from the k-th on; their motion by the
 * coordinates e, rates v and accelerations a (null: zero) of the element; place and velocity of one of them, with zero
 * beyond the dimension. Slopes are sums over coordinates relative to the first node: they do not depend on its
 * position, and no digits are lost far from the origin. */
void fu_block_shapes_of(const fu_drag_points *points, int from, int n_shapes, fu_block_shapes *out);
void fu_block_motion_of(const fu_cable *cable, const fu_block_shapes *shapes, const double *e, const double *v,
                        const double *a, fu_block_motion *out);
void fu_block_vector(int dim, const fu_points *of, int point, double out[3]);

/* couplings/fluid/point_loop.c: calls `visit` with each block of points of a cable with the coordinates q, rates v and
 * accelerations a (null: none). K: matrix of the element, which is added to the system (or to none, null) after its
 * points if loop->has_matrix. */
void fu_drag_visit(const fu_model *model, const fu_drag *drag, const double *q, const double *v, const double *a,
                   fu_drag_visitor *visit, fu_drag_loop *loop, fu_system *system);

/* couplings/fluid/block_force.c: drag, lift and buoyancy at a block, without derivatives; the force of the inertia of
 * the fluid on particles, on the left side of the equations of motion, and that on the slope. Adds all forces of the
 * fluid at a block that the loop has, or their derivatives to the matrix of the element. */
void fu_block_act(const fu_model *model, const fu_drag *drag, const fu_drag_block *block, fu_block_action *out);
void fu_block_inertia(const fu_drag_block *block, fu_points left[3], fu_points on_slope[3]);
fu_drag_visitor fu_block_forces, fu_block_tangent;

/* couplings/fluid/block_sums.c: sums over the points of a block. Subtract from f the forces (each of dim components) on
 * up to FU_BLOCK_FIELDS fields, place, slope and chord, times the rows of their shape functions; add to K the
 * derivatives of the forces on some of them, by some of them (rows x columns x dim x dim). Weights are in the forces.
 */
#define FU_BLOCK_FIELDS 3
double fu_block_sum(const fu_points *x);
void fu_block_subtract(int dim, const fu_block_shapes *shapes, int n_fields, const fu_points *forces, double *f);
void fu_block_add_matrix(int dim, const fu_block_shapes *shapes, int n_rows, int n_columns, const fu_points *by,
                         double *K);

/* couplings/fluid/velocity_field.c: the velocity of the fluid without waves; the distance within its table, see there.
 */
void fu_current_at(const fu_model *model, const fu_flow *flow, double t, const double *r, fu_flow_state *out);
double fu_flow_margin(const fu_model *model, const fu_flow *flow, double t, const double *r);

/* The elevation at the points of a block, as fu_elevation; cosine and sine of the phase of a wave there. */
typedef struct {
    fu_points eta, rate, slope[3];
} fu_block_elevation;
typedef struct {
    fu_points cosine, sine;
} fu_wave_phase;

/* couplings/fluid/waves.c: the elevation at a place; at the places r of a block, with the phases of the waves (n, null:
 * none); adds the motion of the fluid there to U, rate and gradient. */
fu_elevation fu_elevation_at(const fu_model *model, const fu_drag *drag, double t, const double *r);
void fu_block_elevations(const fu_model *model, const fu_drag *drag, double t, const fu_points *r,
                         fu_wave_phase *phases, fu_block_elevation *out);
void fu_block_add_waves(const fu_model *model, const fu_drag *drag, const fu_points *r, const fu_block_elevation *at,
                        const fu_wave_phase *phases, fu_block_fluid *out);

/* couplings/fluid/fluid_at.c: the velocity of the fluid at a point, and the wet part, each of which may be null; of a
 * fluid with waves at the n points of a block: adds the velocity of the waves, if it moves, and computes the wet part.
 */
void fu_fluid_at(const fu_model *model, const fu_drag *drag, double t, const double *r, fu_flow_state *flow,
                 fu_wetness *wet);
void fu_block_in_waves(const fu_model *model, const fu_drag *drag, double t, const fu_points *r, int n, int moves,
                       fu_block_fluid *out);

/* couplings/fluid/wetness.c: the wet part at a height; the height of a point above the elevation, m; the points of
 * quadrature of an element at the coordinates e, on a span without shape functions, and over a step between two
 * coordinates. */
fu_wetness fu_wet_at_height(const fu_drag *drag, double height);
/* Returns whether waves may change the wet part at a height above the origin. */
int fu_near_surface(const fu_drag *drag, double height);
double fu_wet_reach(const fu_drag *drag); /* largest distance from a surface at which the wet part changes, m */
double fu_drag_height(const fu_model *model, const fu_drag *drag, double t, const double *r);
void fu_drag_points_on(const fu_model *model, const fu_drag *drag, double t, int element, const double *e,
                       fu_drag_points *out);
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

/* couplings/fluid/drag_force.c: computes the first n of the coefficients of drag, lift and moment, each with its
 * derivative by the angle of attack, the angle about the span from the chord to the flow w. */
void fu_drag_polar(int dim, const fu_drag *drag, const double *chord, const double *span, const double *w, int n,
                   double *coefficients);

/* couplings/fluid/section_moment.c: add drag, lift and moment on a beam's section at a block, with their derivatives in
 * those of the force on the axis if with_derivatives is nonzero; the power of the forces on slope and chord, W/m.
 * Subtracts their derivatives, and that of the force on the axis by the chord, times `scale`, from the blocks by place,
 * slope and chord; rate: derivative of velocities by positions. */
void fu_section_act(const fu_drag *drag, const fu_drag_block *block, int with_derivatives, fu_block_action *out);
void fu_section_power(const fu_block_motion *at, const fu_block_action *action, fu_points *power);
void fu_section_derivatives(const fu_block_fluid *fluid, const fu_block_action *action, const fu_points *scale,
                            double rate, fu_points *by);

/* flags of a state: one of the table, one of each event function of surfaces */
#define FU_DRAG_FLAGS (1 + FU_SURFACE_EVENT_FUNCTIONS)

/* couplings/fluid/added_mass.c: inertial forces of the fluid on spans and bodies with the accelerations `a` of the dofs
 * (null: zero). */
void fu_added_mass_forces(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *a,
                          const fu_drag_sums *sums);
void fu_added_mass_tangent(const fu_model *model, const fu_drag *drag, const fu_state *state, const double *a,
                           const double *psi, fu_weights weights, fu_system *system);
/* Computes the inertial forces of the fluid per length of a cable at zero accelerations, at all points of quadrature:
 * out (points x FU_ADDED_MASS_DENSITIES), the force (3) and the force on the slope (3) on the cable, and the added mass
 * (dim x dim of 9). */
#define FU_ADDED_MASS_DENSITIES 15
void fu_added_mass_densities(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *out);

/* couplings/fluid/added_mass_matrix.c */
void fu_added_mass_force(const fu_model *model, const fu_coupling *coupling, double t, const double *q, const double *a,
                         double *f);
void fu_added_mass_matrix(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double scale,
                          fu_system *system);
double fu_added_mass_kinetic_energy(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                                    const double *v, int past_fluid);

/* couplings/fluid/added_mass_energy_step.c */
void fu_added_mass_step_forces(const fu_model *model, const fu_drag *drag, const fu_equations *at,
                               const fu_drag_sums *sums);

#endif
