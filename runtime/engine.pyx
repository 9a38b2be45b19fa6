# cython: language_level=3
"""The Cython interface of the engine: arrays of a model in, recorded rows out. The algorithms are in engine/*.c.

The engine is C and not Cython, as `cimport` does not work across the mapped packages; the interface between generated
kernels and the engine is a C header.
"""

from collections import namedtuple
from math import prod

import numpy as np

cimport cython
from cpython.exc cimport PyErr_CheckSignals
from cpython.mem cimport PyMem_Calloc, PyMem_Free
from cpython.pycapsule cimport PyCapsule_GetName, PyCapsule_GetPointer
from libc.float cimport DBL_MIN
from libc.math cimport INFINITY, M_PI_2, acos, asin, fabs, fmax, fmin, sin, sqrt
from libc.stdlib cimport calloc, free, realloc
from libc.string cimport memcpy, memset

from funicular.base.interruptions import check_interrupted
from funicular.base.operating_system import machine_memory

include "engine/cython/engine.pxi"

cdef fu_lapack LAPACK
cdef bint has_lapack = False


cdef size_t _own_tables() except 0:
    """Return the address of the tables of this package's kernels.

    Runs call this, not `import funicular`: `funicular derive` must start where generated/ is broken.
    """
    from funicular.generated import kernels

    return <size_t>PyCapsule_GetPointer(kernels.tables, "funicular.generated.kernels.tables")


cdef _take_lapack():
    """Attach the functions of LAPACK that the engine names, those of SciPy.

    Models with large borders call this, not all, which would load SciPy and start its threads.
    """
    global has_lapack
    cdef int k = 0
    if has_lapack:
        return
    from funicular.base.lapack import cython_lapack

    table = cython_lapack().__pyx_capi__
    while fu_lapack_name(k) != NULL:
        function = table[fu_lapack_name(k).decode()]
        fu_lapack_attach(&LAPACK, k, PyCapsule_GetPointer(function, PyCapsule_GetName(function)))
        k += 1
    has_lapack = True


Output = namedtuple("Output", "first size units turns")
Output.__doc__ = """A number or vector of a coupling in a row of output (base/fields.h): position of its first number, their count, unit,
and transformation to other axes: as a "point", a "direction", a direction in "body axes", or "" for none."""


def _coupling_types():
    cdef size_t k = 0
    names = []
    while fu_coupling_type_at(k) != NULL:
        names.append(fu_coupling_type_at(k).name.decode())
        k += 1
    return tuple(names)


def _described_outputs():
    """Return the fields of rows of output by kind and name, from the types of couplings."""
    cdef size_t k = 0
    cdef const fu_coupling_type *type = fu_coupling_type_at(0)
    cdef const fu_output *field
    found = {}
    while type != NULL:
        fields, field = {}, type.output_fields
        while field != NULL and field.name != NULL:
            if field.first != sum([each.size for each in fields.values()]):
                raise ValueError(f"{type.name.decode()}: outputs before {field.name.decode()} are not in the order of the "
                                 "structure")
            fields[field.name.decode()] = Output(field.first, field.size, field.unit.decode(),
                                                 "" if field.turns == NULL else field.turns.decode())
            field += 1
        if fields:
            if fu_n_outputs(type) != sum([each.size for each in fields.values()]):
                raise ValueError(f"{type.name.decode()}: its structure has outputs without a field")
            found[type.name.decode()] = fields
        k += 1
        type = fu_coupling_type_at(k)
    return found


def outputs_by_name(str kind, numbers):
    """Return the outputs of couplings of a kind by name, from rows (..., numbers of one): views, (...) of numbers,
    (..., size) of vectors.
    """
    size = sum([each.size for each in OUTPUTS[kind].values()])
    if numbers.shape[-1] != size:
        raise ValueError(f"a {kind} has {size} numbers, not {numbers.shape[-1]}")
    return {name: numbers[..., each.first] if each.size == 1 else numbers[..., each.first:each.first + each.size]
            for name, each in OUTPUTS[kind].items()}


STATUS = {FU_DONE: "completed", FU_END_OF_CABLE: "end_of_cable", FU_NO_CONVERGENCE: "no_convergence",
          FU_SINGULAR: "singular", FU_EVENT: "event",
          FU_UNSTABLE: "unstable", FU_ROPE_LEFT: "rope_left"}
CAUSES = {FU_NO_FAILURE: None, FU_ITERATION: "iteration", FU_MATRIX: "matrix", FU_ERROR: "error",
          FU_LOST_RIDER: "lost_rider", FU_NOT_FINITE: "not_finite", FU_SELF_LOCKING: "self_locking",
          FU_NOT_KNOWN: "not_known"}
COUPLING_TYPES = _coupling_types()
"""Names of the types of couplings, in the order in which the engine adds up their forces."""
OUTPUTS = _described_outputs()
"""Fields of a row of output by name, of each kind of coupling with outputs; a state of rest has them, too."""
SLACK_STRAIN = FU_SLACK_STRAIN
"""Least compression of a slack element in its middle."""
MAX_HARD_CONTACTS = FU_MAX_HARD_CONTACTS
"""Largest number of points in hard contact of a scene."""
MAX_WAVES = FU_MAX_WAVES
"""Largest number of waves on a fluid."""
CROSSING_STICK, FRICTION_MARK = FU_CROSSING_STICK, FU_FRICTION_MARK
SPAN_BEGIN, SPAN_STRETCH = FU_SPAN_BEGIN, FU_SPAN_STRETCH
"""Numbers that a state keeps of friction: of a crossing that sticks, of a point of a contact."""
NO_TIME = FU_NO_TIME
"""Time of the last step in a state as drawn, s."""


cdef double _call(void *context, int which, const fu_state *state) noexcept with gil:
    """Call the function of a user's event; the engine keeps an exception until it returns."""
    engine = <Engine>context
    if engine.error is not None:
        return 0.0
    try:
        return engine.event_handler.call(which, *engine._snapshot(state))
    except BaseException as error:
        engine.error = error
        return 0.0


include "engine/cython/slopes.pxi"
include "engine/cython/arrays.pxi"
include "engine/cython/translation.pxi"
include "engine/cython/statics.pxi"
include "engine/cython/linear_model.pxi"
include "engine/cython/report.pxi"
include "engine/cython/packed.pxi"


cdef class Engine(Packable):
    """One run of a model (model/model.py).

    blocks: use kernels of several elements at once where they exist.
    """

    cdef object event_handler, error, __weakref__
    cdef bint has_started

    cdef int _check_started(self) except -1:
        """Raise RuntimeError before `start`, which makes the arrays."""
        if not self.has_started:
            raise RuntimeError("the engine has not started; call start first")
        return 0

    def _take_integrator(self, method):
        """Set the integrator of the run (package integrators): parameters, work space, state."""
        cdef int k
        run = &self.run
        run.integrator = fu_integrator_of(method.name.encode())
        if run.integrator == NULL:
            raise ValueError(f"the engine has no integrator {method.name}")
        if method.is_linear and run.linear == NULL:
            raise ValueError(f"integrator {method.name}: call take_linear_model first")
        parameters = method.parameters
        run.parameters = self._doubles(parameters)
        if run.integrator.n_parameters(run.parameters) != len(parameters):
            raise ValueError(f"integrator {method.name}: {run.integrator.n_parameters(run.parameters)} parameters, not "
                             f"{len(parameters)}")
        run.order, run.error_overestimate, run.retry_factor = method.order, method.error_overestimate, method.retry_factor
        if run.integrator.n_dissipation_state != NULL:
            self.model.n_dissipation_state = run.integrator.n_dissipation_state(run)
            for k in range(FU_N_STATE_ARRAYS):
                if fu_state_array(&self.model, &run.now, k).name == b"dissipation_state":
                    self._attach(&run.now, k)
                    self._attach(&run.next, k)
        run.scratch = self._zeros(run.integrator.n_scratch(run))

    def use_threads(self, int threads):
        """Start this number of threads; return the number started, one where the system has no more. Call it once."""
        cdef int i
        m = &self.model
        if m.threads:
            raise RuntimeError("the engine has its threads already; make another one of the model")
        if threads < 2 or not fu_has_threads():
            return 1
        largest = [self.cables[i].n_elements * self.cables[i].coordinates ** 2 for i in range(m.n_cables)]
        m.thread_work = self._zeros(max([2 * threads * FU_MAX_COORDINATES] + largest))
        self._shared_dofs()
        m.threads = <fu_threads *>PyMem_Calloc(1, fu_threads_size(threads))
        if not m.threads:
            raise MemoryError
        self.run.newton.threads = self.run.accelerator.mass.threads = m.threads
        return fu_threads_start(m.threads, threads)

    def _shared_dofs(self):
        """List the dofs whose unknown is shared, combined, or in the border: one thread adds to these."""
        m = &self.model
        unknown = np.asarray(<int[:m.n_dof]><int *>m.unknown_of_dof) if m.n_dof else np.zeros(0, dtype=np.intc)
        times = np.bincount(unknown[unknown >= 0], minlength=m.n_band + m.n_border_dof)
        for dof in -2 - unknown[unknown < -1]:
            times[[m.combination_unknown[k] for k in range(m.combination_start[dof], m.combination_start[dof + 1])]] += 2
        times[m.n_band:] += 2
        shared = (unknown < -1) | ((unknown >= 0) & (times[unknown] > 1))
        dofs, unknowns = np.flatnonzero(shared), np.flatnonzero(times > 1)
        m.is_shared, m.shared_dofs, m.shared_unknowns = self._ints(shared), self._ints(dofs), self._ints(unknowns)
        m.n_shared_dofs, m.n_shared_unknowns = len(dofs), len(unknowns)

    def handle_events(self, event_handler):
        """Set the `Watcher` of events; call it before `start`."""
        self.event_handler, self.error = event_handler, None
        self._set_event_functions(event_handler.event_functions)
        self.run.call, self.run.context = &_call, <void *>self

    def _set_event_functions(self, functions):
        """Set the event functions: these, and after them those of couplings."""
        kinds = {"q": FU_EVENT_OF_Q, "v": FU_EVENT_OF_V, "s": FU_EVENT_OF_S, "s_rate": FU_EVENT_OF_RATE,
                 "traction": FU_EVENT_OF_OUTPUT, "function": FU_EVENT_OF_CALL}
        cdef int i, n = len(functions), own = fu_coupling_event_functions(&self.model, NULL)
        PyMem_Free(self.event_functions)
        self.event_functions = <fu_event_function *>PyMem_Calloc(n + own + 1, sizeof(fu_event_function))
        if not self.event_functions:
            raise MemoryError
        for i, function in enumerate(functions):
            w = &self.event_functions[i]
            w.kind, w.index = kinds[function.kind], function.index
            w.direction, w.value = function.direction, function.value
            if w.kind == FU_EVENT_OF_OUTPUT:
                w.which = OUTPUTS["slide"][function.kind].first
            elif w.kind == FU_EVENT_OF_S:
                w.index = self.couplings[function.index].coordinate
        fu_coupling_event_functions(&self.model, self.event_functions + n)
        run = &self.run
        run.n_event_functions, run.event_functions = n + own, self.event_functions
        run.event_values, run.late = self._zeros(run.n_event_functions), self._int_zeros(run.n_event_functions)
        run.deferred_at = self._zeros(run.n_event_functions)
        run.deferred = <const char **>self._memory(<double>run.n_event_functions * sizeof(char *))
        run.event_work = self._zeros(self.model.n_dof + self.model.n_outputs)
        fu_proximity_place(&self.model, run.n_event_functions, self._memory(fu_proximity_size(&self.model, run.n_event_functions)))

    def change_signals(self, model, breakpoints, bint restarts):
        """Take the signals of a model, and breakpoints, once more; restarts: forces jump now, in a run, not in one that
        is restored. Raises ArithmeticError where the equations are singular then.
        """
        cdef fu_breakpoint now
        self._signals(model)
        self._breakpoints(*breakpoints)
        now.t, now.jumps = self.run.now.t, FU_ACCELERATION_JUMPS
        if restarts and fu_pass_breakpoint(&self.run, &now, 1):
            raise ArithmeticError("the equations are singular")

    def _breakpoints(self, times, jumps):
        """Set the instants at which steps end."""
        PyMem_Free(self.breakpoints)
        self.breakpoints = <fu_breakpoint *>PyMem_Calloc(len(times) + 1, sizeof(fu_breakpoint))
        if not self.breakpoints:
            raise MemoryError
        for i, (time, jump) in enumerate(zip(times, jumps, strict=True)):
            self.breakpoints[i].t, self.breakpoints[i].jumps = time, jump
        self.run.n_breakpoints, self.run.breakpoints = len(times), self.breakpoints

    def make_ready(self, *, duration, output_step, tol, step, method, first_step, breakpoints=((), ()), capacity=None,
                   rest_start=False, absolute_tol=0.0, controlled=None):
        """Take the settings of a run and allocate output rows, `capacity` of them or all; method: one of integrators/.

        breakpoints: times at which steps end, and what jumps there (model/breakpoints.py). absolute_tol in m, negative: by
        the scene's size. controlled: two arrays of weights (n_dof,), for the error that tol bounds and for all errors that
        count; by default the model's weights. Raises RuntimeError in a second call.
        """
        cdef int k
        cdef fu_array array
        if self.has_started:
            raise RuntimeError("the engine has started already; make another one of the model")
        self.has_started = True
        run = &self.run
        run.duration, run.output_step, run.tol = duration, output_step, tol
        run.fixed_step, run.h, run.rest_start = step, first_step, rest_start
        run.absolute_tol = absolute_tol
        run.controlled = run.counted = self.model.weight
        if controlled is not None:
            run.controlled, run.counted = self._doubles(controlled[0]), self._doubles(controlled[1])
        self._breakpoints(*breakpoints)
        self._take_integrator(method)
        rows = int(np.ceil(duration / output_step * (1 - 1e-12))) + 2 if capacity is None else capacity
        m = &self.model
        for k in range(FU_N_RECORD_ARRAYS):
            array = fu_record_array(&self.model, &run.record, k)
            shape = (rows, array.items) if array.axes == 2 else (rows,)
            fu_record_attach(&run.record, k, self._named(array.name.decode(), shape))
        output = self.arrays.pop("output")
        for kind in OUTPUTS:
            self.arrays[kind] = self._outputs(kind, output)

    def take_inputs(self, values, signals):
        """Take inputs, before `start`: their values, and the signals that they give.

        signals: of each its number, whether it drives a motion, a constant, and terms: number of an input, whether the
        integral of it counts, and a factor.
        """
        cdef int k, at = 0
        cdef fu_inputs *all = <fu_inputs *>self._memory(sizeof(fu_inputs))
        cdef fu_input_signal *given = <fu_input_signal *>self._memory(len(signals) * sizeof(fu_input_signal))
        cdef fu_input_term *terms = <fu_input_term *>self._memory(
            sum([len(each[3]) for each in signals]) * sizeof(fu_input_term))
        all.n, all.n_signals, all.signals, all.terms = len(values), len(signals), given, terms
        all.inputs = <fu_input *>self._memory(len(values) * sizeof(fu_input))
        for k, value in enumerate(values):
            all.inputs[k].value = value
        for k, (number, drives, constant, own) in enumerate(signals):
            given[k].signal, given[k].drives, given[k].constant, given[k].first = number, drives, constant, at
            given[k].n = len(own)
            for term in own:
                terms[at].input, terms[at].is_integral, terms[at].factor = term
                at += 1
        self.run.inputs = all

    def start(self, **settings):
        """Take the settings of `make_ready`, and compute the consistent start.

        Returns a status for a failed start, else None, and the change of velocities by the joints. Raises RuntimeError in
        a second call.
        """
        self.make_ready(**settings)
        run, m = &self.run, &self.model
        cdef int status = fu_start(run)
        if status:
            return STATUS[status], np.zeros(m.n_dof)
        return None, np.asarray(<double[:m.n_dof]>run.before).copy() if m.n_dof else np.zeros(0)

    def _outputs(self, str kind, output):
        """Return the outputs of couplings of a kind in rows of output: a view, (rows, couplings, numbers of one)."""
        numbers = self._of(kind)
        cdef int width = fu_n_outputs(fu_coupling_type_of(kind.encode()))
        if not numbers:
            return output[:, :0].reshape(len(output), 0, width)
        c = self.couplings[<int>numbers[0]]
        return output[:, c.output:c.output + len(numbers) * width].reshape(len(output), len(numbers), width)

    def advance(self, on_progress, int every=0, stream=None, double interval=0.05, long most_evaluations=0,
                bint shown=True):
        """Run to the end; return the status, "interrupted" after Ctrl-C, "running" after most_evaluations of eq 38.

        every: number of output rows after which the run pauses in a state that `checkpoint` can store, and calls
        stream.pause(). stream.between() is called at intervals (s) and may take rows. on_progress is called with the time
        reached at intervals, and if it is shown at pauses, too.
        """
        cdef int status = FU_RUNNING
        self._check_started()
        run = &self.run
        run.most_evaluations = most_evaluations
        run.record.every = 0 if shown or stream is not None else every
        try:
            if run.record.every:  # it may be done before the next look at signals
                PyErr_CheckSignals()
                check_interrupted()
            while status == FU_RUNNING:
                run.record.pause = (run.record.n // every + 1) * every if every else 0
                with nogil:
                    status = fu_advance(run, interval)
                if self.error is not None:
                    raise self.error
                if status == FU_RUNNING and run.record.n == run.record.pause:
                    fu_pause(run)
                    if stream is not None:
                        stream.pause()
                if stream is not None:
                    stream.between()
                if status == FU_EVENT:
                    status = self._after_event()
                    if status:
                        break
                if status == FU_RUNNING:
                    PyErr_CheckSignals()
                    check_interrupted()
                on_progress(run.now.t)
                if status == FU_RUNNING and fu_has_worked(run):
                    return "running"
        except KeyboardInterrupt:
            return "interrupted"
        return STATUS[status]

    cdef int _after_event(self) except -1:
        """Report an event; return FU_RUNNING, or the status of a run that ends there, with its last row."""
        cdef int status
        run = &self.run
        if run.event.kind in (FU_ACTED, FU_DEFERRED, FU_WENT_SLACK):
            self._tell()
            return FU_RUNNING
        if self.event_handler.happens(run.event.which, *self._snapshot(&run.now)):
            return FU_RUNNING
        while fu_take_deferred(run):  # of the step that ended there
            self._tell()
        with nogil:
            status = fu_stop(run)
        return status

    cdef _tell(self):
        """Report the event of a part to the event handler."""
        event = self.run.event
        if self.event_handler is None:
            return
        if event.kind == FU_WENT_SLACK:
            self.event_handler.slack_event(event.which, event.what.decode(), self.run.event_time, event.side)
            return
        c = self.couplings[event.which]
        s = self._view(&self.run.now, "s")[c.coordinate] if c.n_coordinates else None
        self.event_handler.acts(c.number, event.what.decode(), self.run.event_time, event.kind == FU_DEFERRED, s)

    def rows(self):
        """Return recorded arrays by name, cut to the rows filled."""
        return {name: array[:self.run.record.n - self.run.record.first] for name, array in self.arrays.items()}

    def take_rows(self):
        """Release the rows in the arrays: the next ones overwrite them."""
        self.run.record.first = self.run.record.n

    def checkpoint(self):
        """Return the bytes from which `restore` continues exactly; at a pause only."""
        self._check_started()
        cdef bytearray taken = bytearray(fu_save(&self.run, NULL))
        fu_save(&self.run, taken)
        return bytes(taken)

    def restore(self, bytes checkpoint, int rows):
        """Continue from a checkpoint that was taken after `rows` rows; call it after `start` with the same arguments.

        Raises ValueError for a checkpoint of another model, or of a state in which a run cannot pause; the engine is
        unusable then.
        """
        self._check_started()
        if len(checkpoint) != fu_save(&self.run, NULL):
            raise ValueError("the checkpoint is of another model")
        if fu_restore(&self.run, checkpoint, rows, 0):
            raise ValueError("the checkpoint is of no state that a run can pause in")

    def compliance(self, multipliers):
        """Return (n, n): H M^-1 H' of n multipliers at the time reached, singular for redundant constraints."""
        cdef int n = len(multipliers)
        cdef int[::1] at = np.full(self.model.n_multipliers + 1, -1, dtype=np.intc)
        np.asarray(at)[multipliers] = np.arange(n)
        cdef double[:, ::1] S = np.zeros((max(n, 1), max(n, 1)))
        if fu_compliance(&self.model, &self.run.now, &self.run.accelerator, &at[0], n, &S[0, 0]):
            raise ArithmeticError("the mass matrix is singular")
        return np.asarray(S)[:n, :n]

    def prepare(self):
        """Prepare `compliance` before `start`; return whether slides are consistent and the mass matrix is regular."""
        return fu_prepare(&self.run) == FU_RUNNING

    def redundant_rows(self, rows):
        """Remove the multipliers of redundant rows of joints, (joint, row) each."""
        numbers = self._of("joint")
        for joint, row in rows:
            (<fu_joint *>self.couplings[<int>numbers[joint]]).redundant_rows |= 1 << row

    def probe_mechanism(self, along):
        """Return the residuals of the joints, (joints, 6), after a small displacement `along` (n_dof,) that they admit;
        None where the projection onto the joints fails. See fu_probe_mechanism.
        """
        cdef double[::1] path = np.ascontiguousarray(along, dtype=float)
        cdef double[::1] left = np.zeros(self.model.n_forces + 1)
        if fu_probe_mechanism(&self.run, &path[0], &left[0]):
            return None
        return self._own("joint", left, 6)

    def contact_densities(self, int contact, int points, double t, q, v):
        """Return (points, 3): forces of a surface on the points of a contact in a state, N/m or N; friction as in statics."""
        cdef double[:, ::1] out = np.zeros((points, 3))
        self.set_state(t, q=q)
        self._view(&self.run.next, "v")[:] = v
        fu_contact_densities(&self.model, self.couplings[<int>self._of("contact")[contact]], &self.run.next, &out[0, 0])
        return np.asarray(out)

    def drag_densities(self, int drag, int elements, double t, q, v):
        """Return drag and buoyancy on the wet part of a cable in a state, a row per point of quadrature: number of the
        element, number of the part between cuts by surfaces, x in the element and weight, in m, and force (3), N/m.
        """
        found = np.zeros((elements * FU_DRAG_POINTS, FU_DRAG_DENSITIES))
        cdef double[:, ::1] out = found
        self.set_state(t, q=q)
        self._view(&self.run.next, "v")[:] = v
        n = fu_drag_densities(&self.model, self.couplings[<int>self._of("drag")[drag]], &self.run.next, &out[0, 0])
        return found[:n]

    def added_mass_densities(self, int drag, int points, double t, q, v):
        """Return the inertia forces of added mass on a cable (points, 3) and on its slope (points, 3) without
        accelerations, and the added mass (points, dim, dim), at the points of quadrature of its drag.
        """
        found = np.zeros((points, FU_ADDED_MASS_DENSITIES))
        cdef double[:, ::1] out = found
        cdef int dim = self.model.dim
        self.set_state(t, q=q)
        self._view(&self.run.next, "v")[:] = v
        fu_added_mass_densities(&self.model, self.couplings[<int>self._of("drag")[drag]], &self.run.next, &out[0, 0])
        return found[:, :3], found[:, 3:6], found[:, 6:6 + dim * dim].reshape(points, dim, dim)

    def static_outputs(self, str kind):
        """Return (couplings, numbers of one): outputs of all couplings of a kind in the static state."""
        numbers = self._of(kind)
        out = np.zeros((len(numbers), fu_n_outputs(fu_coupling_type_of(kind.encode()))))
        cdef double[:, ::1] view = out
        cdef int k, number
        for k, number in enumerate(numbers):
            c = self.couplings[number]
            fu_outputs_at_rest(&self.model, c, &self.run.next, &view[k, 0])
        return out

    def static_farthest(self, str kind):
        """Return (couplings,): largest distance of contact beyond the ends of the surface in the static state, m."""
        return np.array([fu_beyond(&self.model, self.couplings[<int>number], &self.run.next) for number in self._of(kind)])


include "engine/cython/stepping.pxi"
