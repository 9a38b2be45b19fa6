/* The engine: what is integrated, and the work space of integrating it.
 *
 * Coordinates. q is the configuration: for each cable its nodal vectors node by node, then for each body position and
 * attitude (unit quaternion; in the plane unit complex number) and, of a modal one, the coordinates of its modes. v, accelerations and increments have one entry a degree
 * of freedom (dof): the cables' as in q, then the bodies' (translation; rotation about body axes; modes).
 *
 * Unknowns of a linear system: the free coordinates of the cables ("band"), then the border: those of nodes where cables
 * meet, if that is cheaper (model/unknowns.py), those of the bodies, then what each joint and spring adds. Supports make dofs
 * linear in the unknowns, dofs = T unknowns + what motions prescribe; place[dof] is the place of the unknown that the dof
 * is, -1 where it is held or prescribed, -2 - k where it is the k-th combination of unknowns (reduce.c).
 *
 * Every array belongs to the caller; nothing here allocates.
 */
#ifndef FUNICULAR_ENGINE_H
#define FUNICULAR_ENGINE_H

#include "blocks.h"
#include "kernels.h"

#define FU_MAX_COORDINATES 32 /* of one element, or of the kernels of a slide on it; model/build.py checks */
#define FU_ATTACHMENT_COORDINATES 40 /* of what an end is on, s among them; model/build.py checks */
#define FU_SLIDE_COORDINATES (FU_MAX_COORDINATES + FU_ATTACHMENT_COORDINATES)
#define FU_ROW_COORDINATES (2 * (FU_ATTACHMENT_COORDINATES + FU_SLIDE_COORDINATES))
#define FU_MAX_RATES 128 /* of strain, of one element; engine.pyx checks */
#define FU_SIGNAL_TERMS 7 /* coefficients of a piece of a signal */

typedef struct {
    const fu_element_kernels *kernel;
    const fu_law_kernels *law;
    const fu_law_blocks *blocks; /* null where there are none */
    int n_elements;
    int first;        /* first dof and first entry in q */
    int coordinates;  /* of an element */
    int per_node;     /* coordinates of a node */
    double length;    /* of an element, m */
    double tau;       /* Kelvin-Voigt retardation time, s */
    double mass_damping; /* 1/s */
    const double *m;  /* mass matrix of an element over nodal vectors */
    const double *A;  /* constants of the law, of the first element */
    int A_stride;     /* from one element's to the next's: zero where they are equal */
    int memory;       /* first number in the memory of algorithmic dissipation: law->rates + 1 an element */
} fu_cable;

/* A body as seen at an instant: its part of q, of v, of the accelerations. */
typedef struct {
    const double *b, *w, *a;
} fu_instant;

/* What bodies are made of: bodies.c, modal.c. b, w, a and f begin with the body's own entries. */
typedef struct fu_body fu_body;
typedef struct {
    int constant; /* its M is, in body axes, and it has no K */
    void (*mass_times)(const fu_body *body, const double *b, const double *a, double *f); /* f = M a */
    void (*forces)(const fu_body *body, const double *b, const double *w, double *f); /* f += what is left without a */
    void (*mass)(const fu_body *body, const double *b, double *M);
    void (*tangent)(const fu_body *body, const fu_instant *at, double *D, double *K);
    double (*kinetic_energy)(const fu_body *body, const double *b, const double *w);
    double (*elastic_energy)(const fu_body *body, const double *b);
    double (*potential_energy)(const fu_body *body, const double *b); /* less what model->gravity gives */
    double (*dissipation)(const fu_body *body, const double *b, const double *w);
} fu_matter;
extern const fu_matter fu_rigid_matter, fu_modal_matter;

/* Modes of a body; index 0 of S and X is the undeformed place (derive/bodies/modal.py). */
typedef struct {
    const fu_modal_kernels *kernel;
    const double *S, *X;               /* (n + 1) x dim; (n + 1) x (n + 1) x dim x dim */
    const double *mass, *stiffness, *damping; /* n x n */
    const double *zero;                /* as many as it has dofs */
    double *sums, *matrices;           /* work space: 3 (n + 1) dim^2; 3 dofs^2 (mass_times takes the first) */
    double g[3];
} fu_shape;

/* A body with a frame: rigid, or modal with so many modes. */
struct fu_body {
    const fu_body_kernels *kernel; /* of its frame */
    const fu_matter *matter;
    int configuration; /* first entry in q: the frame's, then the modes' */
    int dof;           /* first dof: likewise */
    int modes;
    double mass;
    double J[9];
    const fu_shape *shape; /* of the modes; null without */
};

/* A point of a modal body: where it is undeformed, and the modes' displacements and turns there. */
typedef struct {
    const double *x, *phi, *psi; /* dim; modes x dim; modes x turns */
} fu_modal_attachment;
typedef struct {
    double p[3], axes[9], velocity[3], omega[3], bias[3], omega_bias[3];
} fu_modal_point;

/* One end of a spring or a joint: a point with axes of the ground (cable and body -1), of a cable's element, of a body; or
 * axes alone, of the cable where a slide is. */
enum { FU_UP = -1, FU_CARRIED = -2 };
typedef struct {
    int cable, body, element, slide; /* -1 where it is not on one */
    double u[3];                     /* the point: of the ground; of the body in its axes */
    double N[FU_MAX_COORDINATES];    /* shape functions at the point of the element */
    const fu_frame_kernels *frame;           /* of a cable; null where there are no axes */
    int slopes[2];                   /* its vectors: 0 1 2 for r_x r_y r_z; FU_UP; FU_CARRIED for the slide's director */
    double S[2 * FU_MAX_COORDINATES]; /* derivatives of the shape functions for both, unless on a slide */
    double up[3];
    double axes[9]; /* in those of what carries it, by columns */
    fu_modal_attachment spot;   /* the point of a modal body, instead of u */
} fu_attachment;

/* Where an end stands and how it moves with its own n coordinates (numbers for fu_add in `at`): dp = P dq, and axes turn
 * by T dq about global axes; velocities, and accelerations where those of the coordinates are zero. */
enum { FU_POINT = 1, FU_AXES = 2 };
typedef struct {
    int n, at[FU_ATTACHMENT_COORDINATES];
    double p[3], v[3], bias[3], P[3 * FU_ATTACHMENT_COORDINATES];
    double A[9], omega[3], alpha[3], T[3 * FU_ATTACHMENT_COORDINATES];
} fu_attachment_state;

/* What waits for a slide at an end of its cable, and what it does in its own way: restitution of a hard stop; length
 * before the end, stiffness and damping of a buffer. */
enum { FU_END_IS_ERROR, FU_END_IS_OPEN, FU_END_IS_HARD, FU_END_IS_BUFFERED };
typedef struct {
    int kind;
    double restitution, length, stiffness, damping;
} fu_end_stop;

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

/* A joint between two ends; c = base + its signal drives it. */
typedef struct {
    const fu_joint_kernels *kernel;
    fu_attachment ends[2];
    int unknown, multiplier, signal;
    int redundant_rows; /* bits of the rows that other joints' imply: their multipliers are nil */
    double base, scale[6]; /* scale of its rows, kg or kg m */
} fu_joint;

/* f(t) = a polynomial of t - breaks[i] in each interval (the first and the last go on beyond the breaks)
 *        + amplitude sin(angular_frequency t + phase) */
typedef struct {
    int n;
    const double *breaks;       /* n + 1 */
    const double *coefficients; /* n rows of FU_SIGNAL_TERMS, ascending powers */
    double amplitude, angular_frequency, phase;
} fu_signal;

/* A dof that follows signals: q = base + linear f + cosine cos f + sine sin f */
typedef struct {
    int dof, signal, first; /* first: of those of its dof, whose work is counted once */
    double base, linear, cosine, sine;
} fu_motion;

/* Constant direction in the dofs: value[first ... first + n) on dof[first ...), times a signal */
typedef struct {
    int signal, first, n;
} fu_dead_load;

/* A load that turns with what it acts on: at x of a cable's element, at the point u of a body, at that of a modal one. */
enum { FU_CABLE_FOLLOWER, FU_CABLE_MOMENT, FU_BODY_FORCE, FU_BODY_FOLLOWER, FU_BODY_MOMENT };
typedef struct {
    int kind, signal, on; /* `on`: the cable or the body */
    int element;
    double x, u[3], c[3]; /* c: components, N or N m */
    fu_modal_attachment spot;
} fu_load;

typedef struct {
    const fu_spring_kernels *kernel;
    fu_attachment ends[2];
    int dim, unknown;
    double stiffness, damping, length, mass; /* N/m, N s/m, m; kg: scale of its rows */
} fu_spring;

/* LAPACK, as scipy hands it out. */
typedef struct {
    void (*dgbtrf)(int *, int *, int *, int *, double *, int *, int *, int *);
    void (*dgbtrs)(char *, int *, int *, int *, int *, double *, int *, int *, double *, int *, int *);
    void (*dpbtrf)(char *, int *, int *, double *, int *, int *);
    void (*dgetrf)(int *, int *, double *, int *, int *, int *);
    void (*zgbtrf)(int *, int *, int *, int *, void *, int *, int *, int *);
    void (*zgbtrs)(char *, int *, int *, int *, int *, void *, int *, int *, void *, int *, int *);
    void (*zgetrf)(int *, int *, void *, int *, int *, int *);
    void (*zgetrs)(char *, int *, int *, void *, int *, int *, void *, int *, int *);
    void (*dgetrs)(char *, int *, int *, double *, int *, int *, double *, int *, int *);
} fu_lapack;

/* band.c eliminates so many columns at once (a band is one less wide at least), and touches so many numbers beyond the
 * end of a column of n. */
#define FU_BAND_GROUP 4
#define FU_BAND_BEYOND(width) ((width) + FU_BAND_GROUP)
#define FU_BAND_LENGTH(n, width) ((long)(n) + FU_BAND_BEYOND(width))

/* rows [first, end) of a column */
typedef struct {
    int first, end;
} fu_span;

/* What column k of X, or row k of C, has in half a chain: of what closes a ring, both ends count and not the middle. */
typedef struct {
    int k;
    fu_span rows;
} fu_piece;

/* A banded matrix with a border: [K B; C D]. Only K is large. It falls into chains, which the border alone ties. */
typedef struct {
    int n, width;      /* band part: size, half bandwidth */
    int m;             /* border */
    int n_chains;
    int constant, constant_columns, constant_rows; /* of the border, from the first on, that stay; their pieces */
    int definite;      /* the band is factored in L (band.c), else in K (dgbtrf) */
    int n_columns, n_rows; /* pieces */
    const int *chains; /* n_chains + 1: the first row of each, and n */
    const int *half;   /* of each row of the band: 2 chain, and 1 more from the middle on */
    double *K;         /* LAPACK band storage, (3 width + 1) x n; of all systems of a run the same */
    double *L;         /* (width + 1) x n, and a group more for each chain */
    double *B;         /* n x m, column by column */
    double *C;         /* the border's rows, transposed: n x m */
    double *D;         /* m x m, column by column */
    double *X;         /* K^-1 B in the chains that B touches, FU_BAND_LENGTH a column */
    fu_span *span_B, *span_C; /* 2 n_chains x m: rows of each half that are not zero; end 0 where none is */
    fu_piece *columns, *rows; /* of X and C */
    int *pivot_band, *pivot_border;
} fu_system;

typedef struct {
    int dim, n_cables, n_bodies, n_slides, n_joints, n_springs, n_motions, n_dead_loads, n_loads;
    const fu_cable *cables;
    const fu_body *bodies;
    const fu_slide *slides;
    const fu_joint *joints;
    const fu_spring *springs;
    const fu_motion *motions;
    const fu_dead_load *dead_loads;
    const fu_load *loads;
    const fu_signal *signals;
    int n_q, n_dof, n_band, n_border_dof;
    int n_resistances; /* slides that have one */
    int n_memory; /* zero without algorithmic dissipation */
    int n_extra, n_multipliers; /* unknowns of slides, joints and springs in a Newton system, of the former in eq 38 */
    const int *place;
    const int *combination_start, *combination_place; /* combinations, row by row */
    const double *combination_value;
    const double *weight;  /* length that a unit of each dof moves a point by: makes norms of increments metres */
    const double *gravity; /* generalised force on each dof */
    const double *zero;    /* n_dof zeros: a velocity at rest */
    const int *dead_dof;
    const double *dead_value;
    const fu_lapack *lapack;
    int threads;   /* over elements */
    double *parts; /* what a cable's elements give, with more than one: forces or tangents */
} fu_model;

/* State of the motion at one instant. */
typedef struct {
    double t;
    double *q, *v, *acceleration;
    double *a;       /* the integrator's auxiliary acceleration */
    double *s;       /* per slide: arc-length */
    double *f;       /* per slide: force on the rider, 3 */
    double *spring;  /* per spring: force on its first end, 3 */
    double *multipliers; /* per joint: 6 */
    double *locked_s;    /* per slide: s where it is held */
    int *element;    /* per slide: element that holds s */
    int *mode;       /* per slide: FU_SLIDES and so on */
    int *slip_direction;        /* per slide: 1 or -1 where friction is against that direction whatever the speed */
    int *contact;    /* per slide: 1 or -1 where it lies against what is at the end or at the start */
    double *director; /* per slide: unit vector across the tangent, carried along with the slide */
    double *memory;  /* of algorithmic dissipation */
} fu_state;

/* band.c */
int fu_band_factor(const fu_lapack *lapack, int n, int width, double *A);
void fu_band_solve(int n, int width, const double *A, int first, double *x);

/* linear.c */
void fu_system_clear(fu_system *system);
void fu_system_clear_border(fu_system *system);
fu_span fu_common(fu_span one, fu_span other);
int fu_pieces(const fu_system *system, int k, int chain, const double *x, fu_piece *pieces);
int fu_system_factor_band(fu_system *system, const fu_lapack *lapack);
void fu_system_keep_border(fu_system *system, const fu_lapack *lapack, int columns);
int fu_system_factor_border(fu_system *system, const fu_lapack *lapack);
void fu_system_solve(const fu_system *system, const fu_lapack *lapack, double *x);

/* reduce.c: dofs and unknowns */
void fu_gather(const fu_model *model, const double *force, double *x);
void fu_spread(const fu_model *model, const double *x, double *dofs);
void fu_add(const fu_model *model, fu_system *system, int i, int j, double value);
int fu_extra(const fu_model *model, int k);
double fu_size(const fu_model *model, const double *dofs);

/* assembly.c */
int fu_has_threads(void);
void fu_mass_times(const fu_model *model, const double *q, const double *a, double *f);
void fu_internal_forces(const fu_model *model, const double *q, const double *v, double *f);
void fu_rate_forces(const fu_model *model, const double *q, const double *v, double *f);
void fu_discrete_forces(const fu_model *model, const double *q, const double *q_next, double *f);
void fu_dynamic_matrix(const fu_model *model, const double *q, const double *v, double inertia, double rate,
                       double stiffness, fu_system *system);
double fu_kinetic_energy(const fu_model *model, const double *q, const double *v);
double fu_elastic_energy(const fu_model *model, const double *q);
double fu_potential_energy(const fu_model *model, const double *q);
double fu_dissipation(const fu_model *model, const double *q, const double *v);
double fu_length(const fu_model *model, int slide);
double fu_element_start(const fu_model *model, int slide, int element);

/* Newton matrix = inertia M + stiffness (K + rate D); statics has no inertia */
typedef struct {
    double inertia, rate, stiffness;
} fu_weights;

/* bodies.c: rigid and modal */
int fu_body_dofs(const fu_body *body);
void fu_bodies_mass_times(const fu_model *model, const double *q, const double *a, double *f);
void fu_bodies_forces(const fu_model *model, const double *q, const double *v, double *f);
void fu_bodies_matrix(const fu_model *model, const fu_state *at, const double *psi, fu_weights weights, fu_system *system);
void fu_bodies_mass(const fu_model *model, const double *q, int constant, fu_system *system);
double fu_bodies_kinetic_energy(const fu_model *model, const double *q, const double *v);
double fu_bodies_elastic_energy(const fu_model *model, const double *q);
double fu_bodies_potential_energy(const fu_model *model, const double *q);
double fu_bodies_dissipation(const fu_model *model, const double *q, const double *v);

/* modal.c: points */
void fu_modal_attachment_state(const fu_body *body, const fu_modal_attachment *spot, const double *b, const double *w, fu_modal_point *out,
                     double *P, double *T);
void fu_modal_attachment_force(const fu_body *body, const fu_modal_attachment *spot, const double *b, const double *f, const double *m,
                           double *K);
void fu_modal_attachment_follower(const fu_body *body, const fu_modal_attachment *spot, const double *b, const double *c,
                                  double *g, double *K);

/* motions.c */
double fu_signal_at(const fu_signal *signal, double t, double *rate, double *second);
void fu_prescribe(const fu_model *model, fu_state *state);

/* loads.c */
void fu_external_forces(const fu_model *model, double t, const double *q, double *f);
void fu_loads(const fu_model *model, double t, const double *q, double *f);
void fu_loads_matrix(const fu_model *model, double t, const double *q, const double *psi, double stiffness,
                     fu_system *system);

/* ends.c */
int fu_attachment_coordinates(const fu_model *model, const fu_attachment *end, const fu_state *state, int *at);
void fu_attachment_at(const fu_model *model, const fu_attachment *end, const fu_state *state, double s_rate, int what,
                  fu_attachment_state *place);
void fu_geometric_stiffness(const fu_model *model, const fu_attachment *end, const fu_state *state, const double *f, const double *m,
                      int n, double *K);

/* Constraints H q'' = W over the dofs `at`, with what is left of them C, and their rate at rest: `rows` of them now, from
 * the multiplier `first` on, which has `room` for some more; those of the bits `idle` are nil. */
typedef struct {
    int first, max_multipliers, rows, redundant_rows, n, at[FU_ROW_COORDINATES];
    int slide; /* that an end of a joint is on, -1; by_s: derivatives by its s */
    double by_s[6];
    double H[6 * FU_ROW_COORDINATES], W[6], C[6], rate[6], scale[6];
} fu_rows;

/* slides.c */
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

/* resistances.c: R of a slide, the force along its cable times r_x, and its derivatives */
typedef struct {
    double R, by_t[3], by_u[3], by_f[3], by_s;
} fu_resistance;
int fu_has_resistance(const fu_model *model, const fu_state *state, int j);
void fu_resistance_at(const fu_model *model, const fu_state *state, int j, const double *t, const double *u, const double *f,
              fu_resistance *resistance);
double fu_resistance_power(const fu_model *model, const fu_state *state, int j, const double *t, const double *u,
                      const double *f);
double fu_buffer_energy(const fu_model *model, const fu_state *state);
double fu_lost_in_buffers(const fu_model *model, const fu_state *from, const fu_state *to);
void fu_touch_buffers(const fu_model *model, fu_state *state);
double fu_compression(const fu_model *model, const fu_state *state, int j, int side);
void fu_slide_motion(const fu_model *model, const fu_state *state, int j, const double *J, double *t, double *u);
void fu_resistance_rows(const fu_model *model, const fu_state *state, int j, const double *J, const fu_resistance *resistance,
                   double *by_place, double *by_rate);

/* links.c */
int fu_joint_is_inactive(const fu_joint *joint, const fu_state *state);
int fu_joint_residual(const fu_model *model, const fu_joint *joint, const fu_state *state, double *phi, int *at, double *J);
int fu_between_cables(const fu_joint *joint);
int fu_ties_a_frame(const fu_model *model, int which);
int fu_joint_tangent(const fu_model *model, const fu_joint *joint, const fu_state *state, int *at, double *J, double *K);
void fu_joint_terms(const fu_model *model, const fu_joint *joint, const fu_state *state, const fu_slide_state *slide_states,
                   const fu_rows *of_slides, fu_rows *rows);

/* springs.c */
void fu_spring_force(const fu_model *model, const fu_spring *spring, const double *q, const double *v, double force[3],
                     double by_gap[9], double by_rate[9]);
void fu_spring_forces_of(const fu_model *model, const fu_state *state, double *forces);
void fu_spring_forces(const fu_model *model, const double *q, const double *v, double *f);
void fu_spring_pull(const fu_model *model, const fu_spring *spring, const double *q, const double force[3], double *f);
void fu_spring_matrix(const fu_model *model, const fu_spring *spring, const fu_state *state, const double *psi,
                      double rate, double stiffness, double unit, fu_system *system);
double fu_discrete_spring(const fu_model *model, const fu_spring *spring, const double *q, const double *q_next, double h,
                          double force[3]);
void fu_discrete_pull(const fu_model *model, const fu_spring *spring, const double *q, const double *q_next,
                      const double force[3], double *f);
double fu_spring_energy(const fu_model *model, const double *q);
double fu_spring_dissipation(const fu_model *model, const double *q, const double *v);

/* rotation.c */
void fu_move(const fu_model *model, double *q, const double *dofs);
void fu_body_rate(const fu_body_kernels *kernel, const double *b, const double *w, double *rate);
void fu_body_increment(const fu_body_kernels *kernel, const double *b, const double *change, double *increment);
void fu_cayley_move(const fu_model *model, double *q, const double *psi);
void fu_cayley_columns(const fu_body_kernels *kernel, double *rows, int n_rows, int n_columns, int first, const double *psi);
void fu_between(const fu_model *model, const double *q, const double *q_next, double *between);
void fu_turn_columns(const fu_body_kernels *kernel, double *rows, int n_rows, int n_columns, int first, const double *psi);

/* acceleration.c: eq 38 and what comes out of it */
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

typedef struct {
    double alpha_m, alpha_f, beta, gamma;
} fu_genalpha;

/* Of the energy-momentum method, algorithmic.c; weight: of a change of strain in the stress, zero: there is none. */
typedef struct {
    double lag, viscosity, inertia, weight;
    double *expected; /* like the memory: what the velocities at the start of the step would change, and its energy */
} fu_algorithmic;

/* Explicit Runge-Kutta method with two embedded error estimates. */
typedef struct {
    int stages;
    const double *A, *b, *c;          /* stages x stages, row by row; stages; stages */
    const double *error, *coarse;     /* stages + 1: the last is of the state at the end */
} fu_tableau;

/* Implicit Runge-Kutta method of three stages, stiffly accurate: A^-1 = T L T^-1 with L = gamma beside the block of
 * alpha +- i beta; `error` over the stages' increments, beside gamma0 = 1/gamma times the rate at the start. */
typedef struct {
    double A[9], A_inverse[9], c[3], T[9], T_inverse[9], gamma, alpha, beta, error[3];
} fu_collocation;

/* A complex matrix laid out as an fu_system; real systems of two steps combine to it. */
typedef struct {
    void *K, *B, *C, *D, *X, *x; /* double _Complex; x: right side and solution */
    double *D_real;              /* the real system's border before it was factored */
    int n_columns;
    fu_piece *columns;           /* of X; those of C are the real system's */
    int *pivot_band, *pivot_border;
} fu_complex_system;

/* What the user watches: an entry of the state less a value, a slide's rate or traction less a value, or a function of
 * his; what stops.c watches on a slide: whether it stays as it is, and its buffer at the end that `value` is the side of.
 * A traction is of the accelerations, which eq 38 gives anew at each state that is looked at. */
enum { FU_WATCH_Q, FU_WATCH_V, FU_WATCH_S, FU_WATCH_RATE, FU_WATCH_TRACTION, FU_WATCH_CALL, FU_WATCH_STICK,
       FU_WATCH_BUFFER };
typedef struct {
    int kind, index, direction; /* direction: 1 rising, -1 falling, 0 both */
    double value;
} fu_watch;

/* FU_ACTED: a slide, `which`, has done what `side` says: engine.pyx has words for it */
enum { FU_NO_EVENT = 0, FU_CROSSING, FU_WATCHED, FU_ACTED };
enum { FU_NOTHING, FU_STUCK, FU_BROKE_LOOSE, FU_TURNED, FU_STRUCK, FU_FREED, FU_FLEW, FU_ENTERED, FU_CAME_OUT, FU_RESTS };
typedef struct {
    int kind, which, side;
} fu_event;

typedef struct {
    long steps, rejected, newton_iterations, factorisations, crossings, newton_failures, evaluations;
    double h_min, h_max, error_sum, time_factor, time_solve, time_residual, time_output;
} fu_statistics;

enum { FU_RUNNING = 0, FU_DONE = 1, FU_END_OF_CABLE = 2, FU_NO_CONVERGENCE = 3, FU_SINGULAR = 4, FU_EVENT = 5,
       FU_UNSTABLE = 6 };

/* Why a step failed, and where that shows most: a dof, and a joint or -1. */
enum { FU_NO_FAILURE = 0, FU_ITERATION, FU_MATRIX, FU_ERROR, FU_LOST_RIDER, FU_NOT_FINITE, FU_JAM };
typedef struct {
    int cause, dof, slide;
} fu_failure;

/* The energy balance since the start, J: energies then, the most exchanged between them and in motion, the most that came
 * from nowhere and that went there, and what rounding may make of it. */
#define FU_ENERGIES 5
typedef struct {
    double first[FU_ENERGIES], exchanged, in_motion, grown, lost, rounding;
} fu_energy_balance;

/* Rows of output, one an output time; joint: FU_SLIDE_OUTPUTS numbers a joint in the order of fu_slide_output. */
#define FU_SLIDE_OUTPUTS 11
#define FU_JOINT_OUTPUTS 7
typedef struct {
    int n;     /* rows recorded since the start */
    int first; /* the row that stands first in the arrays: those before it were taken away */
    int pause; /* at so many rows fu_advance returns, for the caller to call fu_pause */
    double *time, *q, *v, *acceleration, *reaction, *s, *slide, *joint;
    double *kinetic, *elastic, *potential, *dissipated, *external, *spring;
} fu_record;

/* newton.c: what implicit integrators have in common. `predict` makes a first `next`; `kinematics` completes it from the
 * unknowns; `residual` leaves minus the scaled residual in run->rhs, `matrix` its derivative in run->newton; `apply` adds
 * the solution in run->rhs and returns its size as a length. */
typedef struct fu_run fu_run;
typedef struct {
    void (*predict)(fu_run *run, double h);
    void (*kinematics)(fu_run *run, double h);
    void (*residual)(fu_run *run, double h);
    void (*matrix)(fu_run *run, double h);
    double (*apply)(fu_run *run, double h);
    int most_iterations, to_rounding; /* the latter: go on below the rounding of positions, until increments shrink no more */
} fu_newton;

/* A way through time. `now` has consistent v, accelerations and forces when `start` is called; `step` makes `next` from
 * it and is not zero where that failed; `error` is the local error of positions of the step just made, m; `book` adds
 * what that step, now accepted, has dissipated and got from outside. */
typedef struct {
    const char *name;
    int (*start)(fu_run *run);
    int (*step)(fu_run *run, double h);
    double (*error)(fu_run *run, double h);
    void (*book)(fu_run *run, double h);
    int conserves; /* energy: velocities stay as they are where the scheme starts anew, projecting them would cost some */
    int straddles; /* steps may go over boundaries of elements: the slides' elements are found within the iteration */
    const fu_newton *newton; /* null where there is none */
} fu_integrator;
extern const fu_integrator fu_genalpha_method, fu_explicit_method, fu_energy_method, fu_radau_method;

struct fu_run {
    const fu_model *model;
    const fu_integrator *integrator;
    int order;           /* of the error in positions as controlled */
    fu_genalpha scheme;
    fu_algorithmic algorithmic;
    fu_tableau tableau;
    fu_collocation collocation;
    fu_complex_system complex_newton;
    double retry_factor;      /* of a step that failed: what the next ones stay below, 0 where failures are cheap */
    double error_overestimate;        /* how much larger the estimate of the local error is than that error */
    double *scratch;     /* of the integrator: checkpoints do not hold it */
    int n_watches;
    const fu_watch *watches;
    double *watched;     /* per watch: its value at `now`, 0 where it has just passed */
    int *late;           /* per watch: the side to which it passed together with another event */
    double *watch_work;  /* n_dof: accelerations that a watched traction is of */
    double (*call)(void *context, int watch, const fu_state *state);
    void *context;
    fu_event event;      /* that the run has stopped at */
    double duration, output_step, fixed_step, tol;
    fu_state now, next;
    fu_system newton;
    fu_accelerator accelerator;
    fu_record record;
    fu_statistics statistics;
    double *rhs;                              /* unknowns, and FU_BAND_BEYOND */
    double *psi, *force, *work, *before;      /* n_dof; force is what supports and motions give, once Newton is done */
    double *first;                            /* n_q: the configuration at the start */
    double *s_slope;                          /* per slide: predicts ds/dt */
    /* From here to the end numbers alone, which a checkpoint copies as they are. */
    double h, h_factored, contraction, last_error;
    double since; /* energy.c: how long before `now` the acceleration there belongs, s */
    double dissipated, dissipated_power, external, external_power; /* J, W */
    double drive_power, drive_power_before, drive_step; /* W, W, s: of drives; a step before; how long that
                                                          * was, 0 where only the first is known, -1 none */
    double recorded; /* s: time of the last row */
    double usual; /* s: the step that is wanted, were it not for an event or an output time */
    double motion, least_motion, extent; /* m: largest so far, assumed at least, largest coordinate of a position */
    double size; /* m: of the scene as it is at the start, wherever it lies */
    double allowed; /* m: error of the step */
    double closed;  /* m: gaps at the start */
    double ceiling; /* s: that steps stay below, after one that failed */
    double newton_tolerance, round_off; /* of increments, m: where Newton may stop, and where it cannot go on */
    double acted; /* s: when a slide has last stuck, broken loose, or come to an end of its cable */
    int factored, stopped_joint, turned, acts;
    int holds; /* slides keep their elements in a step, which ends where one of these does */
    int net_rejections; /* steps rejected of late, less those taken */
    fu_failure failure; /* of the last step that failed */
    fu_energy_balance balance;
    int predictor; /* the scratch holds a last step's stages */
    int rest_start; /* for order.py only: start the scheme from zero accelerations */
};

void fu_linearise(fu_run *run, double h, const double *change);
void fu_static_move(fu_run *run, const double *change);
void fu_static_residual(fu_run *run);
void fu_matrix(fu_run *run, fu_weights weights);
double fu_clock(void);

/* newton.c */
int fu_newton_step(fu_run *run, const fu_newton *method, double h);
void fu_predict_extra(fu_run *run, double h);
void fu_apply_extra(fu_run *run, double inertia, double scale);
double fu_spread_size(fu_run *run);
double fu_filtered_size(fu_run *run);
double fu_row_unit(double inertia, double mass);
void fu_joint_coordinates(const fu_model *model, const fu_state *state, int j, int *at);

/* algorithmic.c */
void fu_algorithmic_start(fu_run *run, double h);
void fu_algorithmic_forces(fu_run *run, const double *q, double *force);
double fu_algorithmic_account(fu_run *run, const double *q);

/* projection.c */
int fu_find_slides(fu_run *run);
int fu_close(fu_run *run);
int fu_return_to_joints(fu_run *run, fu_state *state);
int fu_probe_mechanism(fu_run *run, const double *along, double *left);
int fu_complete(fu_run *run, fu_state *state);
int fu_is_short(const fu_run *run, double h);
int fu_coast(fu_run *run, double h);

/* books.c */
double fu_dissipated_power(const fu_run *run, const fu_state *state);
double fu_external_power(fu_run *run, const fu_state *state, const double *reaction);
void fu_account_trapezoid(fu_run *run, double h);
void fu_impact(fu_run *run, const double *change, double restitution);
int fu_moves(const fu_run *run);
int fu_check_energy_balance(fu_run *run, const double energies[FU_ENERGIES], int first);

/* costs.c */
void fu_part_timing(const fu_run *run, double *seconds);

/* failure.c: why a step failed */
int fu_fail(fu_run *run, int cause, const double *dofs, int slide);
int fu_fail_at(fu_run *run, int cause, int unknown);
int fu_fail_eq38(fu_run *run);

/* events.c */
fu_event fu_find_event(const fu_run *run, fu_event known);
fu_event fu_late_event(fu_run *run);
double fu_time_to_boundary(fu_run *run);
double fu_time_of_turn(fu_run *run, double h);
void fu_seat_slides(fu_run *run);
int fu_count_changes(const fu_run *run);
void fu_keep_elements(fu_run *run);
int fu_stands_on_boundary(const fu_run *run, fu_event event);
double fu_locate(fu_run *run, fu_event event, double h);
void fu_watch_now(fu_run *run, fu_event event);
void fu_watch_anew(fu_run *run, int slide);

/* stops.c: slides that stick, break loose, and reach what is at the ends of their cables */
int fu_has_stops(const fu_model *model);
double fu_stick_margin(const fu_run *run, const fu_state *state, int slide);
double fu_buffer_margin(const fu_run *run, const fu_state *state, int slide, int side);
int fu_begin_stops(fu_run *run);
int fu_reach_end(fu_run *run, int slide, int side, int *what);
int fu_act(fu_run *run, const fu_watch *watch, int side, int *what);

/* run.c: the time loop */
int fu_all_finite(const double *numbers, long n);
int fu_prepare(fu_run *run);
int fu_start(fu_run *run);
int fu_advance(fu_run *run, double seconds);
int fu_stop(fu_run *run);

/* checkpoint.c: all that later steps depend on */
void fu_pause(fu_run *run);
long fu_save(const fu_run *run, char *bytes);
int fu_restore(fu_run *run, const char *bytes, int rows);

#endif
