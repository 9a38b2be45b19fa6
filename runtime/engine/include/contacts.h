/* Contact of a cable, or of points of a body, with a surface, by penalty: couplings/contacts.c. */
#ifndef FUNICULAR_CONTACTS_H
#define FUNICULAR_CONTACTS_H

#include "coupling.h"
#include "surfaces.h"

#define FU_CONTACT_POINTS 16 /* of a body */
#define FU_CONTACT_OUTPUTS 10

/* What presses, by its depth d: stiffness d^e (1 + damping d'), e 3/2 where hertz is not zero. Friction has the coefficient
 * `friction` and a spring along the surface, from anchors in the numbers of a state, dim for each point, along the shape's axes. */
typedef struct {
    double stiffness, damping, friction, tangential;
    int hertz;
} fu_contact_law;

/* Points of a cable are those of quadrature on its elements, with weights in m; those of a body have the weight 1. */
typedef struct {
    fu_coupling base;
    fu_surface surface;
    fu_contact_law law;
    int cable;           /* -1: points of a body */
    double radius;       /* of the cable, or of the spheres about the points, m */
    int n_points;        /* of an element; of the body */
    int stride;          /* of shape functions and weights from one element's to the next's: 0 where they are equal */
    const double *weights, *N, *arc; /* arc: arc-lengths of all points of the cable, m */
    double length;       /* of the cable, m */
    int n_hull;          /* points between which an element lies, made of its vectors by `hull` (n_hull x vectors of an element) */
    const double *hull;
    const double *spread; /* of each vector of an element: the largest share of it in a point of the hull; of a body: how far from its
                           * origin its points are at most, m */
    const double *anchors; /* as drawn */
    fu_attachment attachments[FU_CONTACT_POINTS];
} fu_contact;
extern const fu_coupling_type fu_contact_type;
extern const fu_coupling_events fu_contact_events;

/* A point that may touch: where it is, how it moves; its anchor, null without friction; and how it touches: how deep it is, the
 * normal, the force on it (a length) with its part that is friction, derivatives by its place and by its velocity past the surface,
 * the stored energy and the power that goes to heat in the normal force, what friction's spring is stretched by, along the shape's
 * axes, and whether friction slides. */
typedef struct {
    double r[3], v[3];
    const double *anchor;
    double depth, press, f[3], friction[3], by_place[9], by_rate[9], energy, power, stretch[3];
    fu_distance distance;
    int slides;
} fu_touch_point;

/* couplings/contact_points.c; fu_contact_press: what presses on a point at a depth, N (a length). */
double fu_contact_press(const fu_contact *contact, double depth, double rate);
int fu_contact_touches(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, fu_touch_point *point);
void fu_contact_derivatives(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, fu_touch_point *point);
double fu_contact_step(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, double h,
                       const fu_touch_point *now, const fu_touch_point *next, double f[3], double by_next[9]);

/* couplings/contacts.c */
int fu_contact_elements(const fu_model *model, const fu_contact *contact);
int fu_contact_may_touch(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, const fu_state *state, int element,
                         double below);
double fu_contact_weight(const fu_contact *contact, int element, int point);
void fu_contact_place(const fu_model *model, const fu_contact *contact, const fu_state *state, int element, int point, fu_touch_point *out);

const double *fu_contact_shapes(const fu_contact *contact, int n, int element, int point);
int fu_contact_first(const fu_model *model, const fu_contact *contact, int element);
void fu_contact_add_force(const fu_model *model, const fu_contact *contact, const fu_state *state, const fu_attachment_state *on, int element,
                          int point, const double *r, const double *force, double *f);
void fu_contact_add_along(int dim, int n, const int *at, const double *P, const double *f, double factor, double *sum);

/* couplings/contact_results.c: makes the gap of a point, and its rate; where it is and how it moves along the shape's axes, unless that
 * is null. */
double fu_contact_gap(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, const fu_state *state, int element,
                      int number, double *rate, fu_surface_end *end);
/* couplings/friction_paths.c */
double fu_contact_carried_error(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to);

/* Calls `visit` with each point that touches. */
typedef void fu_contact_visitor(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, int element, int number,
                                const fu_touch_point *point, void *context);
void fu_contact_visit(const fu_model *model, const fu_contact *contact, const fu_state *state, fu_contact_visitor *visit, void *context);

/* couplings/contact_derivatives.c: adds to a system the derivatives of what a point that touches, and its reaction, put on the left
 * of the equations of motion; psi as in fu_equations. */
void fu_contact_add_derivatives(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, const fu_state *state,
                                int element, int number, const fu_touch_point *point, const double *psi, fu_weights weights,
                                fu_system *system);

/* couplings/contact_steps.c */
void fu_contact_step_residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, double *f, double *own);
void fu_contact_step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system);
double fu_contact_step_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_equations *at);

/* couplings/contact_results.c */
void fu_contact_outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const double *acceleration,
                        const fu_accelerator *work, double *out);
double fu_contact_energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
double fu_contact_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const fu_accelerator *work);
double fu_contact_lost(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to, int by_ends);
void fu_contact_densities(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *out);
void fu_contact_reset(const fu_coupling *coupling, fu_state *state);
void fu_contact_carry(const fu_model *model, const fu_coupling *coupling, fu_state *state);

/* Returns when the first point is below the surface in a step of h at both ends of which it is off it, s, else 0. */
double fu_contact_pass(const fu_run *run, const fu_contact *contact, double h);

/* couplings/clearances.c */
fu_clearance fu_contact_clearance(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
void fu_contact_between(const fu_model *model, const fu_coupling *coupling, int between[2]);

#endif
