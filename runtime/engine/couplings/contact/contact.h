/* Public: contact of a cable, or of points of a body, with a surface, by penalty: couplings/contact/contact.c. */
#ifndef FUNICULAR_COUPLINGS_CONTACT_CONTACT_H
#define FUNICULAR_COUPLINGS_CONTACT_CONTACT_H

#include "couplings/common/coupling.h"
#include "couplings/common/span_elements.h"
#include "couplings/common/stick_friction.h"
#include "couplings/common/surfaces.h"

#define FU_CONTACT_POINTS 16 /* of a body */

/* Normal force by the penetration d: stiffness d^e (1 + damping d'), e 3/2 if hertz is nonzero. Friction has the
 * coefficient `friction` and a spring along the surface, whose stretch is among the numbers of a state:
 * fu_friction_mark. */
typedef struct {
    double stiffness, damping, friction, tangential;
    int hertz;
} fu_contact_law;

/* History of friction in a state, from the last step. Of each point, along the shape's axes: the stretch of the spring,
 * the position, the normal (zero as drawn, where it is unknown) and its rate, the velocity relative to the surface at
 * the point of contact, the gap, and its rate. After those of all points, of the contact: the axes of the body along
 * the shape's; the time, s (FU_NO_TIME as drawn, before any step). */
typedef struct {
    double stretch[3], place[3], normal[3], normal_rate[3], rate[3], gap, gap_rate;
} fu_friction_mark;
typedef struct {
    double axes[9], time;
} fu_friction_begin;
#define FU_FRICTION_MARK 17 /* numbers of a point */
_Static_assert(sizeof(fu_friction_mark) == FU_FRICTION_MARK * sizeof(double), "numbers of a state are doubles");

/* Points of a cable are those of quadrature on its elements, with weights in m; those of a body have the weight 1. */
typedef struct {
    fu_coupling base;
    fu_surface surface;
    fu_contact_law law;
    int cable;             /* -1: points of a body */
    double radius;         /* of the cable, or of the spheres about the points, m */
    int n_points;          /* of an element; of the body */
    int stride;            /* of shape functions and weights from one element's to the next's: 0 for equal elements */
    int first, n_elements; /* elements of the cable on which it acts; the arrays begin at the first */
    const double *weights, *N, *arc; /* arc: arc-lengths of all points on the cable, m */
    double start, stop;              /* arc-lengths of the ends of these elements, m */
    int n_hull; /* points whose hull contains an element, from its vectors by `hull` (n_hull x vectors of an element) */
    const double *hull;
    /* of each vector of an element: its largest share in a point of the hull; of a body: the largest distance of its
     * points from its origin, m */
    const double *spread;
    const double *marks; /* numbers of a state as drawn */
    fu_attachment attachments[FU_CONTACT_POINTS];
} fu_contact;
extern const fu_coupling_type fu_contact_type;

/* Contact of a span of a rope: couplings/contact/span_contact.c. Of the contact, `arc` and `weights` have the shares of
 * the points and of their weights in the length of an element. Friction is that of the contact's law, with a spring of
 * the material; or regularised: `friction` is its coefficient, `slip_velocity` that at which it is 0.7 of its limit,
 * m/s. */
typedef struct {
    fu_contact contact;
    fu_span_elements on;
    double friction, slip_velocity;
} fu_rope_contact;
extern const fu_coupling_type fu_rope_contact_type;

/* Returns the contact as that of a span; null: it is of a cable or a body. */
static inline const fu_rope_contact *fu_contact_on_span(const fu_contact *contact)
{
    return contact->base.type == &fu_rope_contact_type ? (const fu_rope_contact *)contact : 0;
}

/* History of friction on a span, from the last step: the position of the surface and its motion, the material
 * coordinates of both ends, m, with their rates, and the time, s (FU_NO_TIME: none, before any step). Before it among
 * the numbers of a state: the stretch of each point (3), as many numbers for its update, and the dofs of the span's
 * nodes with their rates. */
typedef struct {
    double p[3], v[3], A[9], omega[3], s[FU_SPAN_ENDS], s_rate[FU_SPAN_ENDS], time;
} fu_span_begin;
#define FU_SPAN_BEGIN 23  /* numbers of it */
#define FU_SPAN_STRETCH 6 /* numbers of a point */
_Static_assert(sizeof(fu_span_begin) == FU_SPAN_BEGIN * sizeof(double), "numbers of a state are doubles");

/* Numbers of a row of output: the force on the cable or body, and its friction; the largest penetration; the length in
 * contact, of a body the number of points; the arc-lengths of its ends. */
typedef struct {
    double force[3], friction_force[3], penetration, touching, first, last;
} fu_contact_output;
extern const fu_output fu_contact_output_fields[];

/* A point that may be in contact: its position and velocity; its history, null without friction; the time since, s,
 * the rotation of its body relative to the surface since then, and its rate, along the shape's axes. In contact:
 * penetration and its rate, the normal, its rate along the shape's axes, the arm from the point to the contact of
 * its sphere, the velocity there relative to the surface, along the shape's axes, `past`, that of the point itself,
 * along the ground's, the force on it (a length) with its friction, derivatives by its position, by its velocity
 * relative to the surface and by the stretch alone, the stored energy and the dissipated power of the normal force, the
 * energy of friction's spring, its stretch, along the shape's axes, its path, and whether friction slides. On a span:
 * the part of the step after which the material there entered the span, 0 if it was there before, the history of the
 * material, and changes of its stretch and place by the material coordinate, along the shape's axes. */
typedef struct {
    double r[3], v[3];
    const fu_friction_mark *mark;
    double since, turn[3], spin[3], arm[3], slip[3], normal_rate[3];
    double past[3], depth, sinking, normal_force, f[3], friction[3], by_place[9], by_rate[9], by_stretch[9], energy,
        power, spring_energy, stretch[3];
    fu_distance distance;
    fu_friction_end friction_end;
    int slides;
    double entered;
    fu_friction_mark of_material;
    double stretch_by_S[3], place_by_S[3];
} fu_contact_point;

/* The normal force at a penetration, with its derivatives, its elastic part, the stored energy; the mean of that part
 * on the path to another penetration. */
typedef struct {
    double p, by_depth, by_rate, elastic, energy, mean;
} fu_normal_force;

/* couplings/contact/friction.c: friction of a point in contact, and its derivatives, added to those of the normal
 * force. */
void fu_contact_stretch(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                        fu_contact_point *point);
/* Returns the largest error of the stretch at the end of the step by the intervals of the sum of its direction, m. */
double fu_contact_turn_error(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                             const fu_contact_point *point);
/* Computes the path of a point through a step as fu_contact_stretch does, and the direction of its spring, along the
 * shape's axes. */
void fu_contact_path(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                     const fu_contact_point *point, fu_friction_path *path, double along[3]);
/* Returns the path of a point's spring through a step without the stretch: its penetration. */
fu_friction_path fu_contact_normal_path(const fu_contact *contact, const fu_contact_point *point);
/* Computes the displacement of a point along the surface since its mark, m: along the shape's axes, normal to the
 * present normal. */
void fu_contact_change(int dim, const fu_contact *contact, const fu_contact_point *point, const double *normal,
                       double change[3]);
void fu_contact_friction_derivatives(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                                     fu_contact_point *point);

/* couplings/contact/normal_force.c */
fu_normal_force fu_normal_force_at(const fu_contact *contact, double depth, double rate, double depth_next);

/* couplings/contact/point.c; fu_contact_slip: computes distance, penetration and velocities of a point, in contact or
 * not. */
void fu_contact_slip(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                     fu_contact_point *point);
/* Computes the history of a point with these, except for the stretch, which is zero. */
void fu_contact_note(int dim, const fu_attachment_state *on, const fu_contact_point *point, fu_friction_mark *mark);
int fu_contact_is_active(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                         fu_contact_point *point);
/* Computes the forces on a point whose penetration is positive. */
void fu_contact_press(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                      fu_contact_point *point);
void fu_contact_derivatives(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                            fu_contact_point *point);
double fu_contact_step(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, double h,
                       const fu_contact_point *now, const fu_contact_point *next, double f[3], double friction[3],
                       double by_next[9], double by_stretch[9]);

/* couplings/contact/heights.c: the penetrations of all points of an element, m, and the largest of them; with the rates
 * of its n nodal vectors along the normal and the points' shape functions (points x n), if that is positive. Known of a
 * cable on a plane that does not move, without friction. Then a point's contact by its height, as fu_contact_is_active
 * has it, without its position and velocity, whose part along the normal is in `past`. */
typedef struct {
    int is_known, n;
    const double *N;
    double normal[3], deepest, depth[FU_CONTACT_POINTS], rate[FU_MAX_COORDINATES];
} fu_contact_heights;
void fu_contact_compute_heights(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                                const fu_state *state, int element, fu_contact_heights *out);
int fu_contact_is_pressed(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, int number,
                          const fu_contact_heights *heights, fu_contact_point *point);

/* couplings/contact/places.c */
int fu_contact_elements(const fu_contact *contact);
int fu_contact_may_be_active(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                             const fu_state *state, int element, double below);
double fu_contact_weight(const fu_contact *contact, int element, int point);
fu_friction_mark *fu_contact_mark(const fu_contact *contact, const fu_state *state, int element, int point);
void fu_contact_place(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                      const fu_state *state, int element, int point, fu_contact_point *out);
const double *fu_contact_shapes(const fu_contact *contact, int n, int element, int point);
int fu_contact_first(const fu_model *model, const fu_contact *contact, int element);
void fu_contact_add_force(const fu_model *model, const fu_contact *contact, const fu_state *state,
                          const fu_attachment_state *on, int element, int number, const fu_contact_point *point,
                          double *f);
void fu_contact_add_on_cable(const fu_model *model, const fu_contact *contact, int element, int number,
                             const double *force, double *f);

/* Computes the heights of an element if they are known; returns whether they are. */
static inline int fu_contact_heights_of(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                                        const fu_state *state, int element, fu_contact_heights *out)
{
    out->is_known = !(contact->law.friction > 0.0) && contact->cable >= 0 && contact->surface.shape == FU_FLAT &&
                    !contact->surface.inside && contact->surface.on->body < 0 && contact->n_points <= FU_CONTACT_POINTS;
    if (out->is_known) fu_contact_compute_heights(model, contact, on, state, element, out);
    return out->is_known;
}

/* Computes them; returns whether any point of the element may be in contact, known or not. */
static inline int fu_contact_begin_element(const fu_model *model, const fu_contact *contact,
                                           const fu_attachment_state *on, const fu_state *state, int element,
                                           fu_contact_heights *out)
{
    if (fu_contact_heights_of(model, contact, on, state, element, out)) return out->deepest > 0.0;
    return fu_contact_may_be_active(model, contact, on, state, element, 0.0);
}

/* Returns whether a point of the element is in contact, and computes its contact. */
static inline int fu_contact_is_active_at(const fu_model *model, const fu_contact *contact,
                                          const fu_attachment_state *on, const fu_state *state, int element, int number,
                                          const fu_contact_heights *heights, fu_contact_point *point)
{
    if (heights->is_known) return fu_contact_is_pressed(model, contact, on, number, heights, point);
    fu_contact_place(model, contact, on, state, element, number, point);
    return fu_contact_is_active(model, contact, on, point);
}

/* couplings/contact/rolling.c: whether friction acts off the points, on spheres of a body; the axes of a body along the
 * shape's, and their angular velocity, along the shape's axes; the rotation since the mark, and its rate. */
int fu_contact_rolls(const fu_contact *contact);
void fu_contact_axes(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                     const fu_state *state, double axes[9], double spin[3]);
void fu_contact_turning(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                        const fu_state *state, fu_contact_point *point);
fu_friction_begin *fu_contact_begin_of(const fu_contact *contact, const fu_state *state);
/* Computes the displacement of a sphere's point of contact by rotation alone, along the shape's axes. */
void fu_contact_roll(int dim, const fu_contact *contact, const double turn[3], const double *normal,
                     const fu_friction_mark *mark, double out[3]);

/* couplings/contact/friction_error.c */
int fu_contact_quadrature_error(const fu_model *model, const fu_coupling *coupling, const fu_state *from,
                                const fu_state *to, int n, const double *b, const double *c, double *f);

/* couplings/contact/friction_work.c */
double fu_contact_lost(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                       int by_ends);
double fu_contact_history_error(const fu_model *model, const fu_coupling *coupling, const fu_state *from,
                                const fu_state *to);

/* couplings/contact/places.c: calls `visit` with each point in contact. */
typedef void fu_contact_visitor(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                                int element, int number, const fu_contact_point *point, void *context);
void fu_contact_visit(const fu_model *model, const fu_contact *contact, const fu_state *state,
                      fu_contact_visitor *visit, void *context);

/* couplings/contact/derivatives.c: adds to a system the derivatives of the force on a point in contact, and of its
 * reaction, with the signs of the left side of the equations of motion; psi as in fu_equations. */
void fu_contact_add_derivatives(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on,
                                const fu_state *state, int element, int number, const fu_contact_point *point,
                                const double *psi, fu_weights weights, fu_system *system);

/* Changes by each unknown of a motion, in column i of all: of the force on a point, and of its moments about the point
 * and about the origin of the surface. Computes them by the unknowns of the point or, if is_surface is nonzero, of the
 * surface. */
typedef struct {
    double force[3 * FU_ATTACHMENT_COORDINATES], near[3 * FU_ATTACHMENT_COORDINATES],
        far[3 * FU_ATTACHMENT_COORDINATES];
} fu_contact_changes;
void fu_contact_changes_by(int dim, const fu_contact *contact, const fu_attachment_state *on,
                           const fu_contact_point *point, const fu_point_motion *of, int is_surface,
                           fu_contact_changes *out);

/* couplings/contact/span_marks.c: friction's history of the material at S, m, in the span; the element that holds S may
 * be near the e-th. */
void fu_span_mark(const fu_model *model, const fu_rope_contact *rope, const fu_state *state, int e, double S,
                  fu_contact_point *of);
fu_span_begin *fu_span_begin_of(const fu_rope_contact *rope, const fu_state *state);
/* The stretch of each point (3), then the numbers for its update. */
double *fu_span_stretch_of(const fu_rope_contact *rope, const fu_state *state);
/* The dofs of the nodes, then their rates. */
double *fu_span_nodes_of(const fu_rope_contact *rope, const fu_state *state);

/* couplings/contact/span_history.c */
void fu_rope_contact_reset(const fu_coupling *coupling, fu_state *state);
void fu_rope_contact_update_history(const fu_model *model, const fu_coupling *coupling, fu_state *state);
double fu_rope_contact_released(const fu_model *model, const fu_coupling *coupling, const fu_state *from,
                                const fu_state *to, int by_ends);

/* couplings/contact/span_contact_point.c: the place of a point, with its history; whether any point of an element may
 * be nearer to the surface than the radius. */
void fu_rope_contact_place(const fu_model *model, const fu_rope_contact *rope, const fu_state *state,
                           const fu_span_element *it, int k, fu_contact_point *point);
int fu_rope_contact_may_be_active(int dim, const fu_rope_contact *rope, const fu_attachment_state *on,
                                  const fu_span_element *it);
/* Adds the reaction at a point on the body of the surface, to the left side of the equations; the force on the material
 * at a point with its reaction. */
void fu_rope_contact_add_reaction(int dim, const fu_attachment_state *on, const fu_contact_point *point, double weight,
                                  double *f);
void fu_rope_contact_add_force(const fu_model *model, const fu_rope_contact *rope, const fu_attachment_state *on,
                               const fu_span_element *it, int k, const fu_contact_point *point, double *f);
/* Calls `visit` with each point in contact; after the last one of an element
 * with none. */
typedef void fu_rope_contact_visitor(const fu_model *model, const fu_rope_contact *rope, const fu_attachment_state *on,
                                     const fu_span_element *it, int k, fu_contact_point *point, void *context);
void fu_rope_contact_visit(const fu_model *model, const fu_rope_contact *rope, const fu_state *state,
                           fu_rope_contact_visitor *visit, void *context);
/* Computes the elastic part of the normal force at a point, with its derivatives by the place. */
void fu_rope_contact_elastic(const fu_rope_contact *rope, const fu_contact_point *point, double F[3],
                             double by_place[9]);
/* Computes friction at a point, with its derivatives by place and velocity; returns the dissipated power, W/m. */
double fu_rope_contact_friction(int dim, const fu_rope_contact *rope, const fu_attachment_state *on,
                                const fu_contact_point *point, double f[3], double by_place[9], double by_rate[9]);

/* couplings/contact/span_contact_matrix.c */
void fu_rope_contact_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at,
                             fu_system *system);

/* couplings/contact/energy_step.c */
void fu_contact_step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f,
                              double *internal);
void fu_contact_step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at,
                             fu_system *system);
double fu_contact_step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at);

/* couplings/contact/results.c */
void fu_contact_outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                        const double *acceleration, const fu_accelerator *work, double *out);
double fu_contact_energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
double fu_contact_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                              const fu_accelerator *work);
void fu_contact_densities(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *out);
void fu_contact_reset(const fu_coupling *coupling, fu_state *state);
void fu_contact_update_history(const fu_model *model, const fu_coupling *coupling, fu_state *state);

/* couplings/contact/clearance.c */
fu_clearance fu_contact_clearance(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
void fu_contact_between(const fu_model *model, const fu_coupling *coupling, int between[2]);

#endif
