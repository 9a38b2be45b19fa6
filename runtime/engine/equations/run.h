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
    long steps, rejected, newton_iterations, factorisations, crossings, newton_failures, evaluations;
    double h_min, h_max, error_sum;
    /* s, each without what the others count: of output; of steps, where residuals, matrices and solutions are counted
     * by themselves; of estimates of the error */
    double time_factor, time_solve, time_residual, time_output, time_step, time_error;
} fu_statistics;

enum {
    FU_RUNNING = 0,
    FU_DONE = 1,
    FU_END_OF_CABLE = 2,
    FU_NO_CONVERGENCE = 3,
    FU_SINGULAR = 4,
    FU_EVENT = 5,
    FU_UNSTABLE = 6
};

#define FU_AT_ONCE 1e-12 /* of the duration: instants that are no farther apart are one (model/knots.py) */

/* A run, in sections: what each is about, and which files write it. */
struct fu_run {
    /* Problem: written by the caller before fu_prepare; absolute_tol, lever and first by run/start.c. */
    const fu_model *model;
    const fu_integrator *integrator;
    const double *parameters;  /* of the integrator */
    double *scratch;           /* of the integrator, which alone writes it */
    int order;                 /* of the error in positions as controlled */
    double retry_factor;       /* upper bound of the steps after a failed one, over it; 0 where failures are cheap */
    double error_overestimate; /* estimate of the local error over that error */
    double duration, output_step, fixed_step, tol;
    double absolute_tol; /* m: error allowed beside tol times the motion; negative until the start: a part of the
                            scene's size */
    double lever; /* m: the longest length from which constraints compute positions; distances are rounded relative to
                     it */
    const double *controlled; /* n_dof: model->weight of what tol is the error of, 0 of the rest */
    const double *counted;    /* n_dof: the weight of each in the error, that of what acts on it included */
    double *first;            /* n_q: the configuration at the start */
    int n_knots;
    const fu_breakpoint *knots; /* increasing; steps end there */
    long most_evaluations;      /* after which fu_advance returns; 0: after any number */

    /* Step: written by the integrators and equations/. */
    fu_state now, next;
    fu_system newton;
    fu_accelerator accelerator;
    double *rhs;                         /* unknowns, and FU_BAND_BEYOND */
    double *psi, *force, *work, *before; /* n_dof; force is what supports and motions give, once Newton is done */
    double *s_slope;                     /* per slide: predicts ds/dt; by run/steps.c */

    /* Events: written by events/. */
    int n_watches;
    const fu_event_function *watches; /* the caller's, then those of couplings */
    double (*call)(void *context, int watch, const fu_state *state);
    void *context;
    double *watched;   /* per watch: its value at `now`, 0 where it has just passed */
    int *late;         /* per watch: the side to which it passed together with another event */
    double *passed_at; /* per watch: when a step has gone over it, s, for the caller to learn of it; negative where none
                          has */
    const char **passed;     /* per watch: what has happened then, in words */
    fu_slackness *slackness; /* per cable */
    double *deepest;         /* per coupling: the deepest penetration since the start, or a checkpoint, m */
    double *farthest;        /* per coupling: the farthest contact beyond the ends of its surface since then, m */
    double *watch_work;      /* n_dof + n_outputs: accelerations and a row of output that a watched number is of */
    int watch_solution;      /* what is known of these accelerations: FU_SOLVE_ANEW and the like */
    fu_event event;          /* that the run has stopped at; by run/ */
    double event_time;       /* s: when it has happened, of couplings */

    /* Counters and rows: written by run/; statistics by all. */
    fu_record record;
    fu_statistics statistics;

    /* From here to the end numbers alone, which a checkpoint copies as they are. */

    /* Step: h, usual and ceiling by equations/step_control.c and run/steps.c, the matrix by equations/newton.c and the
     * integrators. */
    double h, h_factored, contraction;
    double since;       /* s: how long before `now` the acceleration there belongs; by integrators/energy.c */
    double usual;       /* s: the step that is wanted, were it not for an event or an output time */
    double ceiling;     /* s: that steps stay below, after one that failed */
    double matrix_cost; /* of the factored matrix and of the steps made with it, in iterations */
    int matrix_steps;   /* how many these are */
    int factored;
    int is_remainder; /* the step taken is shorter for an output time or a boundary of a piece alone: no force changes
                         faster in it */
    int turned;
    int net_rejections; /* steps rejected of late, less those taken */

    /* Error: written by equations/step_control.c, run/start.c and run/steps.c. */
    double last_error, allowed;          /* m: of the step */
    double newton_tolerance, round_off;  /* of increments, m: where Newton may stop, and where it cannot go on */
    double motion, least_motion, extent; /* m: largest so far, assumed at least, largest coordinate of a position */
    double controlled_motion;            /* m: largest so far of what tol is the error of */
    double size;                         /* m: of the scene as it is at the start, wherever it lies */
    double closed;                       /* m: gaps at the start; by equations/projection.c */
    fu_failure failure;                  /* of the last step that failed; by equations/failure.c */

    /* Energy: written by equations/energy_balance.c and the integrators. */
    double dissipated, dissipated_power, external, external_power; /* J, W */
    double
        heat_owed; /* J: what steps beyond their stability limit gave back, which later heat pays first (explicit.c) */
    double drive_power, drive_power_before, drive_step; /* W, W, s: of drives; a step before; how long that
                                                         * was, 0 where only the first is known, -1 none */
    fu_energy_balance balance;

    /* Events: written by run/event_handling.c, run/steps.c and events/. */
    double acted; /* s: when a coupling has last changed by itself */
    int acts, stopped_slide;
    int goes_over;     /* the last deferred event that a step led to was gone over */
    int most_deferred; /* of any stage of a step, of those of other integrators of its end */
    int keep_forces;   /* couplings pass nothing in a step, which ends where one of them would */
    int keep_pieces;   /* couplings keep their pieces in a step, which ends where one of them leaves its piece */

    double recorded; /* s: time of the last row; by run/record.c */
    int rest_start;  /* for order.py only: start the scheme from zero accelerations */
};

/* Returns the largest length that distances in the scene are rounded relative to, m. */
static inline double fu_largest_length(const fu_run *run)
{
    return fmax(run->lever, fmax(run->extent, run->motion));
}

/* Returns the coupling whose own a watch is; null where it is another one. */
static inline const fu_coupling *fu_event_coupling(const fu_run *run, int watch)
{
    return run->watches[watch].kind == FU_EVENT_OF_COUPLING ? run->model->couplings[run->watches[watch].index] : 0;
}

#endif
