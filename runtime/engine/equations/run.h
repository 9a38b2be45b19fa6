/* A run, and its time loop: run/. */
#ifndef FUNICULAR_EQUATIONS_RUN_H
#define FUNICULAR_EQUATIONS_RUN_H

#include "base/event.h"
#include "couplings/common/accelerator.h"
#include "couplings/common/coupling.h"
#include "equations/energy_balance.h"
#include "equations/failure.h"
#include "equations/integrator.h"
#include "linear/linear.h"
#include "bodies/model.h"
#include "bodies/record.h"
#include "bodies/state.h"

typedef struct {
    long steps, rejected, newton_iterations, factorisations, node_passages, newton_failures, evaluations;
    double h_min, h_max, error_sum;
    /* s, each without the others: of output; of steps, apart from residuals, matrices and solutions; of error
     * estimates */
    double time_factor, time_solve, time_residual, time_output, time_step, time_error;
} fu_statistics;

enum {
    FU_RUNNING = 0,
    FU_DONE = 1,
    FU_END_OF_CABLE = 2,
    FU_NO_CONVERGENCE = 3,
    FU_SINGULAR = 4,
    FU_EVENT = 5,
    FU_UNSTABLE = 6,
    FU_ROPE_LEFT = 7
};

#define FU_AT_ONCE 1e-12 /* of the duration: largest distance of simultaneous instants (model/knots.py) */

/* A run, in sections by subject, with the files that write them. */
/* Why a rope has left what it runs over: its wrap angle; its normal force; in space the fleet angle of a short span;
 * the length of a span; something that holds to a span and reaches its first or its last end; a drum that has run
 * empty; without mass: it meets a sheave from its other side, or starts with unknown turns; in space it returns beside
 * a groove, leaves it with a kink, or without mass starts on it at an unknown place. */
enum {
    FU_LEFT_BY_WRAP,
    FU_LEFT_BY_PRESSURE,
    FU_LEFT_BY_FLEET,
    FU_LEFT_BY_SPAN,
    FU_LEFT_BY_GRIP,
    FU_LEFT_BY_LAST_GRIP,
    FU_LEFT_BY_EMPTY,
    FU_LEFT_BY_SIDE,
    FU_LEFT_BY_TURNS,
    FU_LEFT_BESIDE,
    FU_LEFT_BY_KINK,
    FU_LEFT_BY_PLACE
};

struct fu_run {
    /* Problem: written by the caller before fu_prepare; absolute_tol, lever and first by run/start.c. */
    const fu_model *model;
    const fu_integrator *integrator;
    const double *parameters;  /* of the integrator */
    double *scratch;           /* of the integrator, its only writer */
    fu_linear_model *linear;   /* of motion about the start; null for the scene's equations */
    int order;                 /* of the controlled error of positions */
    double retry_factor;       /* upper bound of the steps after a failed one, relative to it; 0 for cheap failures */
    double error_overestimate; /* estimate of the local error over that error */
    double duration, output_step, fixed_step, tol;
    /* m: error permitted beside tol times the motion; negative until the start: a part of the scene's size */
    double absolute_tol;
    /* m: the longest length from which constraints compute positions, the scale of rounding of distances */
    double lever;
    const double *controlled; /* n_dof: model->weight of dofs in the error of tol, 0 of the others */
    const double *counted;    /* n_dof: the weight of each in the error, with that of parts that act on named ones */
    double *first;            /* n_q: the configuration at the start */
    int n_breakpoints;
    const fu_breakpoint *breakpoints; /* increasing; steps end there */
    fu_inputs *inputs;                /* null without; by run/inputs.c */
    long most_evaluations;            /* number at which fu_advance returns; 0: unlimited */

    /* Step: written by the integrators and equations/. */
    fu_state now, next;
    fu_system newton;
    fu_accelerator accelerator;
    double *rhs;                         /* unknowns, and FU_BAND_BEYOND */
    double *psi, *force, *work, *before; /* n_dof; force is that of supports and motions after Newton's iteration */
    double *s_slope;                     /* per slide: predicts ds/dt; by run/steps.c */
    double *path_rate;                   /* per slide: on its path at `now`; by fu_time_to_boundary */

    /* Events: written by events/. */
    int n_event_functions;
    const fu_event_function *event_functions; /* the caller's, then those of couplings */
    double (*call)(void *context, int function, const fu_state *state);
    void *context;
    double *event_values;    /* per event function: its value at `now`, 0 just after its event */
    int *late;               /* per event function: the side to which it passed together with another event */
    int may_be_late;         /* whether one of them may differ from zero */
    double *deferred_at;     /* per event function: time of a deferred event for the caller, s; negative for none */
    const char **deferred;   /* per event function: that event in words */
    fu_slackness *slackness; /* per cable */
    double *deepest;         /* per coupling: the deepest penetration since the start, or a checkpoint, m */
    double *farthest;        /* per coupling: the farthest contact beyond the ends of its surface since then, m */
    double *event_work;      /* n_dof + n_outputs: accelerations and a row of output for an event function */
    int event_solution;      /* state of these accelerations: FU_SOLVE_ANEW and the like */
    fu_event event;          /* at which the run has stopped; by run/ */
    double event_time;       /* s: its instant, of couplings */

    /* Counters and rows: written by run/; statistics by all. */
    fu_record record;
    fu_statistics statistics;

    /* From here to the end numbers alone, which a checkpoint copies unchanged. */

    /* Step: h, usual and ceiling by equations/step_control.c and run/steps.c, the matrix by equations/newton.c and the
     * integrators. */
    double h, h_factored, contraction;
    double since;       /* s: time between the instant of the acceleration and `now`; by integrators/energy.c */
    double usual;       /* s: the intended step without events and output times */
    double ceiling;     /* s: upper bound of steps after a failed one */
    double matrix_cost; /* of the factored matrix and of its steps, in iterations */
    double residual_at; /* s: where run->force is M q'' - Q of the state; NAN if nowhere */
    int matrix_steps;   /* number of these steps */
    int mass_is_near;   /* the mass matrix of eq 38 has been factored at a row since the last pause */
    int factored;
    /* the step taken is shorter for an output time or a boundary of a path segment alone: no force changes faster in
     * it */
    int is_remainder;
    int turned;
    int net_rejections; /* recently rejected steps less accepted ones */

    /* Error: written by equations/step_control.c, run/start.c and run/steps.c. */
    double last_error, allowed;          /* m: of the step */
    double newton_tolerance, round_off;  /* of increments, m: where Newton may stop, and the limit by rounding */
    double motion, least_motion, extent; /* m: largest so far, least assumed, largest coordinate of a position */
    double controlled_motion;            /* m: largest so far of the dofs in the error of tol */
    double size;                         /* m: of the scene at the start, at any position */
    double closed;                       /* m: gaps at the start; by equations/projection.c */
    fu_failure failure;                  /* of the last step that failed; by equations/failure.c */

    /* Energy: written by equations/energy_balance.c and the integrators. */
    double dissipated, dissipated_power, external, external_power; /* J, W */
    double
        /* J: energy returned by steps beyond their stability limit, which later dissipation compensates first
         * (explicit.c) */
        heat_owed;
    /* W, W, s: of drives; a step before; the length of that step, 0 if only the first is known, -1 if none */
    double drive_power, drive_power_before, drive_step;
    fu_energy_balance balance;

    /* Events: written by run/event_handling.c, run/steps.c and events/. */
    double acted; /* s: last change of state of a coupling */
    int acts, stopped_slide;
    int left, left_by;       /* number of the coupling of a rope that has left a sheave, and why (FU_LEFT_BY_WRAP...) */
    int last_event_deferred; /* the last event to which a step led was deferred */
    int max_deferred;        /* of any stage of a step, or of its end for other integrators */
    int keep_forces;         /* couplings have no deferred event in a step, which ends at one */
    int keep_segments;       /* couplings keep their path segments in a step, which ends where one leaves its segment */

    double recorded; /* s: time of the last row; by run/record.c */
    int rest_start;  /* for order.py only: start the scheme from zero accelerations */
};

/* Returns the largest length, the scale of rounding of distances in the scene, m. */
static inline double fu_largest_length(const fu_run *run)
{
    return fmax(run->lever, fmax(run->extent, run->motion));
}

/* Returns the coupling of an event function; null for one of another kind. */
static inline const fu_coupling *fu_event_coupling(const fu_run *run, int function)
{
    return run->event_functions[function].kind == FU_EVENT_OF_COUPLING
               ? run->model->couplings[run->event_functions[function].index]
               : 0;
}

/* Ends a run as a rope has left what it runs over, for a reason FU_LEFT_BY_...; returns its status. */
static inline int fu_leave(fu_run *run, const fu_coupling *coupling, int reason)
{
    run->left = coupling->number;
    run->left_by = reason;
    return FU_ROPE_LEFT;
}

#endif
