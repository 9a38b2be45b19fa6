# What kernels.h, blocks.h and the headers of the engine declare, as far as engine.pyx uses it.

cdef extern from "kernels.h" nogil:
    ctypedef struct fu_element_kernels:
        const char *name
        int vectors, dim, nodes
    ctypedef struct fu_body_kernels:
        const char *name
        int dim, configuration, velocity
    ctypedef struct fu_modal_kernels:
        const char *name
    ctypedef struct fu_law_kernels:
        const char *name
        int rates
        void *algorithmic_force
    ctypedef struct fu_frame_kernels:
        const char *name
    ctypedef struct fu_rope_point_kernels:
        const char *name
    ctypedef struct fu_tables:
        pass
    const void *fu_find(const fu_tables *tables, const char *role, const char *name)

cdef extern from "blocks.h" nogil:
    ctypedef struct fu_law_blocks:
        pass
    const fu_law_blocks *fu_blocks_of(const char *law)

cdef extern from * nogil:
    """
    #include "bodies/unknowns.h"
    #include "couplings/common/couplings.h"
    #include "couplings/common/proximity.h"
    #include "couplings/contact/contact.h"
    #include "couplings/crossing/crossing.h"
    #include "couplings/fluid/drag.h"
    #include "couplings/hard_contact/hard_contact.h"
    #include "couplings/joint/joint.h"
    #include "equations/equations.h"
    #include "events/events.h"
    #include "events/list.h"
    #include "events/slack_cables.h"
    #include "host/funicular.h"
    #include "host/packed.h"
    #include "integrators/list.h"
    #include "run/run.h"
    """
    double FU_SLACK_STRAIN, FU_NO_TIME
    int FU_CROSSING_STICK, FU_FRICTION_MARK, FU_SPAN_BEGIN, FU_SPAN_STRETCH, FU_MAX_HARD_CONTACTS, FU_MAX_WAVES
    int FU_MAX_COORDINATES, FU_MAX_CONSTANTS, FU_MAX_RATES, FU_SERIES_HEAD, FU_ATTACHMENT_COORDINATES
    int FU_RUNNING, FU_DONE, FU_END_OF_CABLE, FU_NO_CONVERGENCE, FU_SINGULAR, FU_EVENT, FU_UNSTABLE, FU_ROPE_LEFT
    int FU_NO_FAILURE, FU_ITERATION, FU_MATRIX, FU_ERROR, FU_LOST_RIDER, FU_NOT_FINITE, FU_SELF_LOCKING, FU_NOT_KNOWN
    int FU_EVENT_OF_Q, FU_EVENT_OF_V, FU_EVENT_OF_S, FU_EVENT_OF_RATE, FU_EVENT_OF_OUTPUT, FU_EVENT_OF_CALL
    int FU_ACTED, FU_DEFERRED, FU_WENT_SLACK
    int FU_INTEGER, FU_REAL, FU_LENGTH, FU_WORD, FU_KERNELS, FU_ATTACHMENT, FU_INTEGERS, FU_REALS
    int FU_SIGNAL_TERMS, FU_BAND_GROUP, FU_UNPACKED_FRONT, FU_BANDED_PADDING
    int FU_BAND_MORE(int width)
    long FU_BAND_BEYOND(int width)
    ctypedef struct fu_cable_piece:
        int end, first, growth
        double tau, mass_damping
    ctypedef struct fu_cable:
        const fu_element_kernels *kernel
        const fu_law_kernels *law
        const fu_law_blocks *blocks
        int n_elements, n_nodes, first, coordinates, per_node, l_stride, m_stride, A_stride, dissipation_state, tension_only
        int growth, grows, A_size, terms
        const int *orders
        const double *growth_constants, *growth_series
        const double *share
        const fu_cable_piece *pieces
        double length, tau, mass_damping
        const double *lengths, *nodes, *m, *A
    ctypedef struct fu_matter:
        pass
    const fu_matter fu_rigid_matter, fu_modal_matter
    ctypedef struct fu_shape:
        const fu_modal_kernels *kernel
        const double *S, *X, *mass, *stiffness, *damping, *zero
        double *sums, *matrices
        double g[3]
    ctypedef struct fu_body:
        const fu_body_kernels *kernel
        const fu_matter *matter
        int configuration, dof, modes
        double mass
        double J[9]
        const fu_shape *shape
    ctypedef struct fu_modal_attachment:
        const double *x, *phi, *psi
    ctypedef struct fu_attachment:
        int cable, body, element, slide, node
        const fu_rope_point_kernels *rope
        int span_s[2]
        int span_elements
        const double *share
        double material
        double u[3]
        double N[32]
        const fu_frame_kernels *frame
        int slopes[2]
        double S[64]
        double up[3]
        double axes[9]
        fu_modal_attachment modal
    ctypedef struct fu_modal_point:
        double p[3]
        double axes[9]
        double velocity[3]
        double omega[3]
        double bias[3]
        double omega_bias[3]
    int fu_body_dofs(const fu_body *body)
    void fu_modal_attachment_state(const fu_body *body, const fu_modal_attachment *attachment, const double *b, const double *w,
                         fu_modal_point *out, double *P, double *T)
    void fu_modal_attachment_wrench(const fu_body *body, const fu_modal_attachment *attachment, const double *b,
                                    const double *w, const double *f, const double *m, double *K, double *v_q,
                                    double *omega_q)
    ctypedef struct fu_field:
        const char *name
        int kind, most
        size_t offset, stride
        const char *const *words
    ctypedef struct fu_output:
        const char *name
        int first, size
        const char *unit, *turns
    const fu_field *fu_coupling_fields
    ctypedef struct fu_supply_operations:
        void (*force)(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double *f)
    ctypedef struct fu_start_operations:
        const char *(*excess)(const fu_coupling *coupling)
    ctypedef struct fu_coupling_type:
        const char *name
        size_t size
        int n_numbers
        const fu_field *fields
        const fu_output *output_fields
        const fu_supply_operations *supply
        const fu_start_operations *start
        void (*residual)(const fu_model *model, const fu_coupling *coupling, const void *at, double *f, double *internal)
        void (*outputs)(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                        const double *acceleration, const void *work, double *out)
    ctypedef struct fu_coupling:
        const fu_coupling_type *type
        const void *events
        int index, number, unknown, n_coordinates, coordinate, n_forces, force, n_multipliers, multiplier, row, output
        int numbers, n_numbers
    void fu_contact_densities(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *out)
    int FU_ADDED_MASS_DENSITIES, FU_DRAG_DENSITIES, FU_DRAG_POINTS
    int fu_drag_densities(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *out)
    void fu_added_mass_densities(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *out)
    const fu_coupling_type *fu_coupling_type_of(const char *name)
    const fu_coupling_type *fu_coupling_type_at(size_t k)
    int fu_n_outputs(const fu_coupling_type *type)
    int fu_has_step(const fu_coupling *coupling)
    void fu_bind_events(fu_coupling *coupling)
    ctypedef struct fu_joint:
        fu_coupling base
        int redundant_rows
    ctypedef struct fu_signal:
        int n
        const double *breaks, *coefficients
        double amplitude, angular_frequency, phase
    ctypedef struct fu_breakpoint:
        double t
        int jumps
    ctypedef struct fu_motion:
        int dof, signal, first
        double base, linear, cosine, sine
    ctypedef struct fu_lapack:
        pass
    const char *fu_lapack_name(int k)
    void fu_lapack_attach(fu_lapack *lapack, int k, const void *function)
    ctypedef struct fu_threads:
        pass
    int fu_has_threads()
    long fu_threads_size(int n)
    int fu_threads_start(fu_threads *threads, int n)
    void fu_threads_end(fu_threads *threads)
    ctypedef struct fu_span:
        int first, end
    ctypedef struct fu_strip:
        int k, chain, at, x, room
    ctypedef struct fu_matrix_block:
        int k, strip
        fu_span rows
    ctypedef struct fu_fronts:
        int m, n, size
        double solves
        const int *start, *first, *pivots, *neighbours, *unknown, *in_parent, *parent, *child, *sibling
        const int *front, *place
    ctypedef struct fu_banded_front:
        int front, most_entries, most_numbers, n, lower, upper
        int *first, *rows, *child, *order, *place, *pivot
        double *band
    ctypedef struct fu_factors:
        double *numbers, *x
        int *unknowns, *map, *start, *first, *size, *pivots, *done, *complement
        int most_numbers, most_unknowns
        fu_banded_front banded
    ctypedef struct fu_system:
        int n, width, m, n_chains, n_strips, n_strip_rows
        fu_strip *strips
        const int *first_strip
        int *chain_start, *on_chain, *factorisations, *n_columns, *n_rows
        const fu_fronts *fronts
        fu_factors factors
        const int *chains, *half
        double *K, *L, *U, *B, *C, *D, *X, *inverse, *mirror
        fu_span *span_B, *span_C, *span_X
        fu_matrix_block *columns, *rows
        int *pivot_band, *pivot_border, *pivot_full
        double *full
        fu_threads *threads
    int FU_MAX_INVERTED, FU_MAX_SMALL
    long FU_INVERSE_ROWS(long n)
    ctypedef struct fu_model:
        int dim, n_cables, n_bodies, n_couplings, n_motions
        const fu_cable *cables
        const fu_body *bodies
        const fu_coupling *const *couplings
        const fu_motion *motions
        const fu_signal *signals
        int n_q, n_dof, n_band, n_border_dof, n_dissipation_state, n_extra, n_multipliers
        int n_coordinates, n_forces, n_rows, n_outputs, n_scratch, n_inertial
        const int *unknown_of_dof, *combination_start, *combination_unknown
        const double *combination_value, *weight, *gravity, *zero
        double load_fraction, impending
        int vibrates
        const fu_lapack *lapack
        fu_threads *threads
        double *thread_work
        const int *is_shared, *shared_dofs, *shared_unknowns
        int n_shared_dofs, n_shared_unknowns
    ctypedef struct fu_array:
        const char *name
        void *data
        long items
        size_t size
        int is_real, axes
    int FU_N_STATE_ARRAYS, FU_N_RECORD_ARRAYS
    ctypedef struct fu_state:
        double t
        double *forces
    fu_array fu_state_array(const fu_model *model, const fu_state *state, int k)
    void fu_state_attach(fu_state *state, int k, void *data)
    ctypedef struct fu_rows:
        int first, rows, redundant_rows, n, slide
        int *at
        double *H
    int FU_ROW_ENTRIES_OF(int multipliers)
    ctypedef struct fu_accelerator:
        fu_system mass
        double *corner, *rhs, *scratch, *force, *work, *prescribed, *multipliers
        fu_rows *rows
        int self_locking
    ctypedef struct fu_event_function:
        int kind, index, which, direction
        double value
    ctypedef struct fu_slackness:
        int pending
    ctypedef struct fu_event:
        int kind, which, side
        const char *what
    ctypedef struct fu_failure:
        int cause, dof, coupling
    ctypedef struct fu_energy_balance:
        double exchanged, in_motion, grown, lost, rounding
    ctypedef struct fu_statistics:
        long steps, rejected, newton_iterations, factorisations, node_passages, newton_failures, evaluations
        double h_min, h_max, error_sum, time_factor, time_solve, time_residual, time_output, time_step, time_error
    ctypedef struct fu_record:
        int n, first, pause, every
    fu_array fu_record_array(const fu_model *model, const fu_record *record, int k)
    void fu_record_attach(fu_record *record, int k, double *data)
    ctypedef struct fu_weights:
        double inertia, rate, stiffness
    ctypedef struct fu_equations:
        const fu_state *now, *next
        fu_weights weights
    ctypedef struct fu_sparse:
        int rows
        const int *row, *start, *column
        const double *value
    int FU_MATRICES
    int FU_STEP_FACTORS
    ctypedef struct fu_step_factor:
        double *L
    ctypedef struct fu_linear_model:
        int n, width, stride, n_moving
        const int *moves, *dof, *mixed
        int *moving_start, *moving_column
        fu_sparse combinations, closing, read, held, joints
        fu_sparse *exact
        const double **matrices
        double **cables
        const double *weight
        double *force
        fu_step_factor *factors
        fu_step_factor at_rest, of_mass
        double *error
    ctypedef enum fu_at_rest:
        FU_MASS_AT_REST, FU_DAMPING_AT_REST, FU_STIFFNESS_AT_REST
    void fu_add_cables_at_rest(const fu_model *model, const double *q, fu_at_rest which, int stride, double *band)
    int FU_HALF_BAND_ROWS(int n)
    void fu_evaluate_rows(const fu_model *model, const fu_state *state, fu_accelerator *work)
    ctypedef struct fu_integrator
    ctypedef struct fu_input:
        double value
    ctypedef struct fu_input_term:
        int input, is_integral
        double factor
    ctypedef struct fu_input_signal:
        int signal, drives, first, n
        double constant
    ctypedef struct fu_inputs:
        int n, n_signals
        fu_input *inputs
        const fu_input_signal *signals
        const fu_input_term *terms
    ctypedef struct fu_run:
        const fu_model *model
        const fu_integrator *integrator
        int order
        const double *parameters
        double retry_factor, error_overestimate
        double *scratch
        fu_linear_model *linear
        fu_inputs *inputs
        int n_event_functions
        const fu_event_function *event_functions
        double *event_values, *event_work, *deepest, *farthest, *deferred_at
        int *late
        fu_slackness *slackness
        const char **deferred
        double (*call)(void *context, int function, const fu_state *state) noexcept nogil
        void *context
        fu_event event
        double event_time
        int n_breakpoints
        const fu_breakpoint *breakpoints
        long most_evaluations
        double duration, output_step, fixed_step, tol, absolute_tol
        const double *controlled, *counted
        fu_state now, next
        fu_system newton
        fu_accelerator accelerator
        fu_record record
        fu_statistics statistics
        double *rhs, *psi, *force, *work, *before, *first, *s_slope, *path_rate
        double h, motion, extent, controlled_motion, closed
        int stopped_slide, left, left_by, rest_start
        fu_failure failure
        fu_energy_balance balance
    ctypedef struct fu_integrator:
        const char *name
        long (*n_parameters)(const double *parameters) noexcept nogil
        long (*n_scratch)(const fu_run *run) noexcept nogil
        long (*n_dissipation_state)(const fu_run *run) noexcept nogil
    const fu_integrator *fu_integrator_of(const char *name)
    void fu_linearise(fu_run *run, double h, const double *change)
    bint fu_needs_lapack(const fu_system *system)
    int fu_system_factor_band(fu_system *system)
    int fu_system_factor_border(fu_system *system, const fu_lapack *lapack)
    void fu_system_solve(const fu_system *system, const fu_lapack *lapack, double *x)
    void fu_static_move(fu_run *run, const double *change)
    void fu_static_residual(fu_run *run)
    void fu_residual(fu_run *run, const fu_equations *at)
    void fu_matrix_of_weights(fu_run *run, fu_weights weights)
    void fu_spread(const fu_model *model, const double *x, double *dofs)
    void fu_prescribe(const fu_model *model, fu_state *state)
    void fu_number_couplings(fu_coupling *const *couplings, int n, const fu_coupling **lists, fu_model *model)
    size_t fu_proximity_size(const fu_model *model, int n_event_functions)
    void fu_proximity_place(fu_model *model, int n_event_functions, void *memory)
    int fu_coupling_event_functions(const fu_model *model, fu_event_function *out)
    void fu_reset(const fu_model *model, fu_state *state)
    void fu_find_path_segments(const fu_model *model, fu_state *state)
    void fu_outputs_at_rest(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *out)
    double fu_beyond(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
    void fu_detect_contact(const fu_model *model, fu_state *state)
    int fu_moves(const fu_run *run)
    int fu_compliance(const fu_model *model, const fu_state *state, fu_accelerator *work, const int *at, int n, double *S)
    int fu_prepare(fu_run *run)
    int fu_probe_mechanism(fu_run *run, const double *along, double *left)
    int fu_joint_moves(const fu_model *model, const fu_joint *joint, const fu_state *state, int at)
    int fu_between_cables(const fu_joint *joint)
    ctypedef struct fu_held_friction:
        int mode
        double f, limit, slip
    void fu_hold_point(const fu_model *model, fu_coupling *coupling, const fu_state *state)
    void fu_held_point(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_held_friction *out)
    void fu_set_held_mode(const fu_coupling *coupling, const fu_state *state, int mode)
    ctypedef struct fu_joint_derivatives:
        int n[2]
        int **at
        double *K[2][2]
    void fu_joint_tangent(const fu_model *model, const fu_joint *joint, const fu_state *state, const double *multipliers,
                          fu_joint_derivatives *out)
    int fu_start(fu_run *run)
    int FU_ACCELERATION_JUMPS, FU_RATE_JUMPS
    double FU_AT_ONCE
    double fu_signal_at(const fu_signal *signal, double t, double *rate, double *second)
    int fu_pass_breakpoint(fu_run *run, const fu_breakpoint *breakpoint, int event)
    int fu_advance(fu_run *run, double seconds)
    int fu_reach(fu_run *run, double time, double seconds)
    void fu_pause(fu_run *run)
    int fu_has_worked(const fu_run *run)
    long fu_save(const fu_run *run, char *bytes)
    int fu_restore(fu_run *run, const char *bytes, int rows, int between)
    void fu_set_input(fu_run *run, int k, double value, double rate)
    double fu_input_value(const fu_run *run, int k)
    int fu_is_position(const fu_run *run, int k)
    int fu_give_inputs(fu_run *run, double until)
    int fu_stop(fu_run *run)
    int fu_take_deferred(fu_run *run)
    void fu_part_timing(fu_run *run, double *seconds)
    int FU_PACKED_VERSION, FU_PACKED_ALIGNMENT
    const char *FU_PACKED_MAGIC
    const fu_lapack fu_plain_lapack
    unsigned int fu_packed_layout()
    ctypedef struct fu_linked:
        const char *role
        const char *name
        const void *entry
    ctypedef struct fu_registry:
        const unsigned char *digest
        const fu_linked *kernels
        const fu_lapack *lapack
    enum: FUNICULAR_MESSAGE
    ctypedef struct funicular_scene:
        const void *bytes
        size_t size
        const void *registry
    ctypedef struct funicular:
        pass
    funicular *funicular_open(const funicular_scene *scene, void *memory, char *message)
    void funicular_close(funicular *f)
    int funicular_step(funicular *f)
    int funicular_reach(funicular *f, double time)
    int funicular_inputs(const funicular *f)
    int funicular_find_input(const funicular *f, const char *name)
    const char *funicular_input_name(const funicular *f, int k)
    const char *funicular_input_unit(const funicular *f, int k)
    double funicular_input(const funicular *f, int k)
    int funicular_set_input(funicular *f, int k, double value, double rate)
    int funicular_advance(funicular *f, double time)
    double funicular_time(const funicular *f)
    const char *funicular_message(const funicular *f)
    int funicular_count(const funicular *f)
    int funicular_find(const funicular *f, const char *name)
    const char *funicular_name(const funicular *f, int reference)
    const char *funicular_unit(const funicular *f, int reference)
    int funicular_get(funicular *f, const int *references, size_t n, double *values)
    int funicular_set(funicular *f, const int *references, size_t n, const double *values)
    size_t funicular_saved(const funicular *f)
    int funicular_pause_rows(const funicular *f)
    int funicular_save(funicular *f, void *bytes)
    int funicular_restore(funicular *f, const void *bytes, size_t size)
