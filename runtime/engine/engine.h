/* The engine: what is integrated, and the work space of integrating it.
 *
 * Coordinates. q is the configuration: for each cable its nodal vectors node by node, then for each rigid body
 * position and unit quaternion. v, accelerations and increments have one entry a degree of freedom (dof): the
 * cables' as in q, then six a rigid body (translation; rotation about body axes).
 *
 * Unknowns of a linear system: the free dofs of the cables ("band"), then the border: free dofs of the rigid
 * bodies, then what each joint adds. place[dof] is the place of a dof among them, -1 where it is fixed.
 *
 * Every array belongs to the caller; nothing here allocates.
 */
#ifndef FUNICULAR_ENGINE_H
#define FUNICULAR_ENGINE_H

#include "kernels.h"

#define FU_MAX_COORDINATES 32                        /* of one element or one joint; model.py checks */
#define FU_JOINT_TERMS (13 + 6 * FU_MAX_COORDINATES) /* numbers of one joint in fu_accelerator.terms */

typedef struct {
    const fu_element *kernel;
    const fu_law *law;
    int n_elements;
    int first;        /* first dof and first entry in q */
    int coordinates;  /* of an element */
    int per_node;     /* coordinates of a node */
    double length;    /* of an element, m */
    double tau;       /* Kelvin-Voigt retardation time, s */
    const double *m;       /* mass matrix of an element over nodal vectors */
    const double *A;       /* constants of the law */
    const double *gravity; /* generalised force on an element */
} fu_cable;

typedef struct {
    int configuration; /* first entry in q */
    int dof;           /* first dof */
    double mass;
    double J[9];
    double gravity[3]; /* force, N */
} fu_rigid;

typedef struct {
    const fu_slide *kernel;
    int cable, rider;
    double u[3]; /* the rider's point in body axes, m */
    double mass; /* scale of the constraint rows, kg */
} fu_joint;

/* LAPACK and BLAS, as scipy hands them out. */
typedef struct {
    void (*dgbtrf)(int *, int *, int *, int *, double *, int *, int *, int *);
    void (*dgbtrs)(char *, int *, int *, int *, int *, double *, int *, int *, double *, int *, int *);
    void (*dgetrf)(int *, int *, double *, int *, int *, int *);
    void (*dgetrs)(char *, int *, int *, double *, int *, int *, double *, int *, int *);
    void (*dgemm)(char *, char *, int *, int *, int *, double *, double *, int *, double *, int *, double *, double *,
                  int *);
    void (*dgemv)(char *, int *, int *, double *, double *, int *, double *, int *, double *, double *, int *);
} fu_lapack;

/* A banded matrix with a border: [K B; C D]. Only K is large. */
typedef struct {
    int n, width;      /* band part: size, half bandwidth */
    int m;             /* border */
    double *K;         /* LAPACK band storage, (3 width + 1) x n */
    double *B;         /* n x m, column by column */
    double *C;         /* the border's rows, transposed: n x m */
    double *D;         /* m x m, column by column */
    double *X;         /* K^-1 B */
    int *pivot_band, *pivot_border;
} fu_system;

typedef struct {
    int n_cables, n_rigids, n_joints;
    const fu_cable *cables;
    const fu_rigid *rigids;
    const fu_joint *joints;
    int n_q, n_dof, n_band, n_border_dof;
    const int *place;
    const double *weight; /* length that a unit of each dof moves a point by: makes norms of increments metres */
    const fu_lapack *lapack;
} fu_model;

/* State of the motion at one instant. */
typedef struct {
    double t;
    double *q, *v, *acceleration;
    double *a;       /* the integrator's auxiliary acceleration */
    double *s;       /* per joint: arc-length */
    double *f;       /* per joint: force on the rider, 3 */
    int *element;    /* per joint: element that holds s */
    double *director; /* per joint: unit vector across the tangent, carried along with the slide */
} fu_state;

/* linear.c */
void fu_system_clear(fu_system *system);
void fu_system_add(fu_system *system, int row, int column, double value);
int fu_system_factor_band(fu_system *system, const fu_lapack *lapack);
int fu_system_factor_border(fu_system *system, const fu_lapack *lapack);
void fu_system_solve(const fu_system *system, const fu_lapack *lapack, double *x);

/* assembly.c */
void fu_mass_times(const fu_model *model, const double *a, double *f);
void fu_internal_forces(const fu_model *model, const double *q, const double *v, double *f);
void fu_external_forces(const fu_model *model, double *f);
void fu_dynamic_matrix(const fu_model *model, const double *q, const double *v, double inertia, double rate,
                       double stiffness, fu_system *system);
double fu_kinetic_energy(const fu_model *model, const double *v);
double fu_elastic_energy(const fu_model *model, const double *q);
double fu_potential_energy(const fu_model *model, const double *q);
double fu_dissipation(const fu_model *model, const double *q, const double *v);
double fu_length(const fu_model *model, int joint);
double fu_element_start(const fu_model *model, int joint, int element);

/* rotation.c */
void fu_move_rigid(const double *b, const double *increment, double *moved);
void fu_exponential_tangent(const double *psi, double T[9]);

/* acceleration.c: eq 38 and what comes out of it */
typedef struct {
    fu_system mass;   /* [M H'; H 0], its band factored once */
    double *rhs;      /* unknowns */
    double *terms;    /* per joint: C, C_q, C_s, G, s_rate, Q_d, H, W, s_bias */
    double *force, *work; /* n_dof */
    double *joints;       /* FU_JOINT_OUTPUTS a joint */
} fu_accelerator;
typedef struct {
    double s_rate, s_acceleration, force[3], multiplier[2], residual[3];
} fu_joint_output;
int fu_accelerator_prepare(const fu_model *model, fu_accelerator *work);
int fu_accelerations(const fu_model *model, const fu_state *state, fu_accelerator *work, double *acceleration,
                     fu_joint_output *joints, double *reaction);
int fu_project_velocities(const fu_model *model, const fu_state *state, fu_accelerator *work, double *change);
int fu_find_arc_length(const fu_model *model, const fu_state *state, int joint, double *s);
void fu_carry_directors(const fu_model *model, fu_state *state);

/* genalpha.c: one step of the generalised-alpha method */
typedef struct {
    double alpha_m, alpha_f, beta, gamma;
} fu_genalpha;

typedef struct {
    long steps, rejected, newton_iterations, factorisations, crossings, newton_failures;
    double h_min, h_max, error_sum, time_factor, time_solve, time_residual, time_output;
} fu_statistics;

enum { FU_RUNNING = 0, FU_DONE = 1, FU_END_OF_CABLE = 2, FU_NO_CONVERGENCE = 3, FU_SINGULAR = 4 };

/* Rows of output, one an output time; joint: FU_JOINT_OUTPUTS numbers a joint in the order of fu_joint_output. */
#define FU_JOINT_OUTPUTS 10
typedef struct {
    int n;
    double *time, *q, *v, *acceleration, *reaction, *s, *joint;
    double *kinetic, *elastic, *potential, *dissipated;
} fu_record;

typedef struct {
    const fu_model *model;
    fu_genalpha scheme;
    double duration, output_step, fixed_step, tol;
    fu_state now, next;
    fu_system newton;
    fu_accelerator accelerator;
    fu_record record;
    fu_statistics statistics;
    double *rhs;                              /* unknowns */
    double *psi, *force, *work, *before;      /* n_dof */
    double *first;                            /* n_q: the configuration at the start */
    double *s_slope;                          /* per joint: predicts ds/dt */
    double h, h_factored, contraction, dissipated, power, last_error;
    double motion, least_motion, extent; /* m: largest so far, assumed at least, largest coordinate of a position */
    double newton_tolerance, round_off; /* of increments, m: where Newton may stop, and where it cannot go on */
    int factored, stopped_joint;
    int rest_start; /* for order.py only: start the scheme from zero accelerations */
} fu_run;

int fu_step(fu_run *run, double h);
void fu_linearise(fu_run *run, double h, const double *change);
double fu_step_error(fu_run *run, double h);
double fu_clock(void);

/* run.c: the time loop */
int fu_start(fu_run *run);
int fu_advance(fu_run *run, double seconds);

#endif
