# cython: language_level=3
"""The compiled engine's face: arrays of a model in, recorded rows out. The work is in engine/*.c.

The engine is C and not Cython because `cimport` does not work across the mapped packages; what passes between
generated kernels and the engine is a C header.
"""

import numpy as np

from cpython.exc cimport PyErr_CheckSignals
from cpython.mem cimport PyMem_Calloc, PyMem_Free
from cpython.pycapsule cimport PyCapsule_GetName, PyCapsule_GetPointer

from funicular.generated import kernels
from funicular.operating_system import machine_memory
from scipy.linalg import cython_lapack

include "engine/cython/engine.pxi"

cdef const fu_tables *TABLES = <const fu_tables *>PyCapsule_GetPointer(kernels.tables,
                                                                      "funicular.generated.kernels.tables")
cdef fu_lapack LAPACK


cdef _take_lapack():
    """Fill in the functions of LAPACK that the engine names, as scipy has them."""
    cdef int k = 0
    while fu_lapack_name(k) != NULL:
        function = cython_lapack.__pyx_capi__[fu_lapack_name(k).decode()]
        fu_lapack_attach(&LAPACK, k, PyCapsule_GetPointer(function, PyCapsule_GetName(function)))
        k += 1


_take_lapack()

STATUS = {FU_DONE: "completed", FU_END_OF_CABLE: "end_of_cable", FU_NO_CONVERGENCE: "no_convergence",
          FU_SINGULAR: "singular", FU_EVENT: "event",
          FU_UNSTABLE: "unstable"}
CAUSES = {FU_NO_FAILURE: None, FU_ITERATION: "iteration", FU_MATRIX: "matrix", FU_ERROR: "error",
          FU_LOST_RIDER: "lost_rider", FU_NOT_FINITE: "not_finite", FU_SELF_LOCKING: "self_locking"}
ACTIONS = {FU_STUCK: "stuck", FU_BROKE_LOOSE: "broke loose", FU_TURNED: "turned round", FU_STRUCK: "struck the end",
           FU_RESTS: "came to rest at the end", FU_FREED: "left the end", FU_FLEW: "left", FU_ENTERED: "entered the buffer",
           FU_CAME_OUT: "left the buffer"}
ENDS = {"error": FU_END_IS_ERROR, "leave": FU_END_IS_OPEN, "hard": FU_END_IS_HARD, "buffer": FU_END_IS_BUFFERED}
SLIDE_OUTPUTS = ("s_rate", "s_acceleration", "force", "multiplier", "traction", "residual")


cdef const void *_found(list tables, str role, str name) except NULL:
    """Kernels of a role by name, from the first of the tables (addresses) that has them."""
    cdef const void *entry
    for address in tables:
        entry = fu_find(<const fu_tables *><size_t>address, role.encode(), name.encode())
        if entry != NULL:
            return entry
    raise ValueError(f"no kernels for the {role} {name}")


cdef double _call(void *context, int which, const fu_state *state) noexcept with gil:
    """The function of an event of the user's; what it raises waits in the engine."""
    engine = <Engine>context
    if engine.error is not None:
        return 0.0
    try:
        return engine.watcher.call(which, *engine._snapshot(state))
    except BaseException as error:
        engine.error = error
        return 0.0


include "engine/cython/arrays.pxi"
include "engine/cython/translation.pxi"
include "engine/cython/statics.pxi"


cdef class Engine(Statics):
    """One run of a model (see model/build.py for the fields that it reads).

    blocks: take kernels of several elements at once where there are.
    """

    cdef object watcher, error

    def _take_integrator(self, method):
        """Let the run take an integrator (package integrators): its parameters, its work space, what it keeps."""
        cdef int k
        run = &self.run
        run.integrator = fu_integrator_of(method.name.encode())
        if run.integrator == NULL:
            raise ValueError(f"the engine has no integrator {method.name}")
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

    def relaxed_strains(self):
        """Return, for each cable, (elements, rates + 1): g and the energy of r of algorithmic dissipation, as in
        engine/integrators/algorithmic_dissipation.c.
        """
        numbers, ends = self._view(&self.run.now, "dissipation_state").copy(), np.cumsum([self.cables[i].n_elements * (self.cables[i].law.rates + 1)
                                                     for i in range(self.model.n_cables)])
        return [part.reshape(self.cables[i].n_elements, -1)
                for i, part in enumerate(np.split(numbers, ends[:-1]))]

    def without_algorithmic_force(self):
        """Numbers of the cables whose law has no kernel for algorithmic dissipation."""
        return [i for i in range(self.model.n_cables) if self.cables[i].law.algorithmic_force == NULL]

    def use_threads(self, int threads):
        """Let so many threads share the elements; whether that is possible: OpenMP was there when this was built."""
        cdef int i
        if not fu_has_threads():
            return False
        self.model.threads = threads
        if threads > 1:
            self.model.parts = self._zeros(max([1] + [self.cables[i].n_elements * self.cables[i].coordinates ** 2
                                                      for i in range(self.model.n_cables)]))
        return True

    def watch(self, watcher):
        """Watch for the events of a `Watcher`; call it before `start`."""
        self.watcher, self.error = watcher, None
        self._watch(watcher.watches)
        self.run.call, self.run.context = &_call, <void *>self

    def _watch(self, watches):
        """Watch for these, and after them for what the slides do."""
        kinds = {"q": FU_WATCH_Q, "v": FU_WATCH_V, "s": FU_WATCH_S, "s_rate": FU_WATCH_RATE,
                 "traction": FU_WATCH_TRACTION, "function": FU_WATCH_CALL}
        numbers = [(kinds[watch.kind], watch.index, watch.direction, watch.value) for watch in watches]
        cdef int i, k, side
        for i in range(self.model.n_slides):
            j = &self.slides[i]
            if j.drive < 0 and (j.sticks or FU_END_IS_HARD in (j.stops[0].kind, j.stops[1].kind)):
                numbers.append((FU_WATCH_STICK, i, 1, 0.0))
            for k, side in enumerate((-1, 1)):
                if j.drive < 0 and j.stops[k].kind == FU_END_IS_BUFFERED:
                    numbers.append((FU_WATCH_BUFFER, i, 0, side))
        PyMem_Free(self.watches)
        self.watches = <fu_watch *>PyMem_Calloc(len(numbers) + 1, sizeof(fu_watch))
        if not self.watches:
            raise MemoryError
        for i, (kind, index, direction, value) in enumerate(numbers):
            w = &self.watches[i]
            w.kind, w.index, w.direction, w.value = kind, index, direction, value
        run = &self.run
        run.n_watches, run.watches = len(numbers), self.watches
        run.watched, run.late = self._doubles(np.zeros(run.n_watches)), self._ints(np.zeros(run.n_watches))
        run.watch_work = self._doubles(np.zeros(self.model.n_dof))

    def _knots(self, times, jumps):
        """Let steps end at these instants."""
        PyMem_Free(self.knots)
        self.knots = <fu_knot *>PyMem_Calloc(len(times) + 1, sizeof(fu_knot))
        if not self.knots:
            raise MemoryError
        for i, (time, jump) in enumerate(zip(times, jumps, strict=True)):
            self.knots[i].t, self.knots[i].jumps = time, jump
        self.run.n_knots, self.run.knots = len(times), self.knots

    @property
    def knots_passed(self):
        """Return at how many knots of signals steps have ended, if they are not of a fixed length."""
        cdef int k, passed = 0
        for k in range(self.run.n_knots):
            passed += self.run.knots[k].t <= self.run.now.t
        return passed

    @property
    def row_bytes(self):
        """Bytes of a row of output."""
        return 8 * sum([fu_record_array(&self.model, &self.run.record, k).items for k in range(FU_N_RECORD_ARRAYS)])

    cdef _snapshot(self, const fu_state *state):
        """t, q, v, s of a state."""
        return state.t, *(self._view(state, name).copy() for name in ("q", "v", "s"))

    def start(self, *, duration, output_step, tol, step, method, first_step, knots=((), ()), capacity=None,
              rest_start=False):
        """Allocate output rows, `capacity` of them or all, and compute the consistent start; method: one of integrators/.

        knots: times at which steps end, increasing, and what jumps there; see model/knots.py.
        Returns a status where that failed, else None, and the change of velocities that the joints asked for.
        """
        cdef int k
        cdef fu_array array
        run = &self.run
        run.duration, run.output_step, run.tol = duration, output_step, tol
        run.fixed_step, run.h, run.rest_start = step, first_step, rest_start
        self._knots(*knots)
        self._take_integrator(method)
        rows = int(np.ceil(duration / output_step * (1 - 1e-12))) + 2 if capacity is None else capacity
        m = &self.model
        for k in range(FU_N_RECORD_ARRAYS):
            array = fu_record_array(&self.model, &run.record, k)
            shape = (rows, array.items) if array.axes == 2 else rows
            fu_record_attach(&run.record, k, self._named(array.name.decode(), shape))
        output = self.arrays.pop("output")
        for kind in ("slide", "joint", "point_force"):
            self.arrays[kind] = self._outputs(kind, output)
        cdef int status = fu_start(run)
        if status:
            return STATUS[status], np.zeros(m.n_dof)
        return None, np.array([run.before[i] for i in range(m.n_dof)])

    def _outputs(self, str kind, output):
        """The part of rows of output that couplings of a kind have: a view, (rows, couplings, numbers of one)."""
        cdef int i, first = 0, width = 0
        count = self._count(kind)
        for i in range(self.model.n_couplings - 1, -1, -1):
            if self._kind(self.couplings[i]) == kind:
                first, width = self.couplings[i].output, self.couplings[i].type.n_outputs
        return output[:, first:first + count * width].reshape(len(output), count, width)

    def advance(self, on_progress, int every=0, stream=None, double interval=0.05):
        """Run to the end; returns the status, "interrupted" after Ctrl-C.

        every: at each so many output rows the run pauses, which leaves it in a state that `checkpoint` holds in full, and
        calls stream.pause(); otherwise stream.between() now and then, which may take rows.
        """
        cdef int status = FU_RUNNING
        run = &self.run
        try:
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
                PyErr_CheckSignals()
                if status == FU_EVENT and run.event.kind == FU_ACTED:
                    if self.watcher is not None:
                        self.watcher.acts(run.event.which, ACTIONS[run.event.side], run.now.t,
                                          self._view(&run.now, "s")[run.event.which])
                    status = FU_RUNNING
                if status == FU_EVENT:
                    if not self.watcher.happens(run.event.which, *self._snapshot(&run.now)):
                        with nogil:
                            status = fu_stop(run)
                        break
                    status = FU_RUNNING
                on_progress(run.now.t)
        except KeyboardInterrupt:
            return "interrupted"
        return STATUS[status]

    def rows(self):
        """Recorded arrays by name, cut to the rows that are in them."""
        return {name: array[:self.run.record.n - self.run.record.first] for name, array in self.arrays.items()}

    def take_rows(self):
        """Make room: the rows that are in the arrays count as taken, and the next ones are written over them."""
        self.run.record.first = self.run.record.n

    def checkpoint(self):
        """Bytes from which `restore` goes on exactly; at a pause only."""
        cdef bytearray taken = bytearray(fu_save(&self.run, NULL))
        fu_save(&self.run, taken)
        return bytes(taken)

    def restore(self, bytes checkpoint, int rows):
        """Go on from a checkpoint that was taken after so many rows; after `start` with the same arguments.

        Raises ValueError for one of another model, or of a run that could not have paused there; it must not go on then.
        """
        if len(checkpoint) != fu_save(&self.run, NULL):
            raise ValueError("the checkpoint is of another model")
        if fu_restore(&self.run, checkpoint, rows):
            raise ValueError("the checkpoint is of no state that a run can pause in")

    @property
    def n_rows(self):
        """Number of output rows since the start."""
        return self.run.record.n

    def slide_row(self, slides):
        """Split slides' numbers (..., numbers of a slide) by name; see fu_slide_output."""
        sizes = (1, 1, 3, 2, 1, 3)
        ends = np.cumsum(sizes)
        if slides.shape[-1] != ends[-1]:
            raise ValueError(f"a slide has {slides.shape[-1]} numbers, not {ends[-1]}")
        return {name: slides[..., end - size:end] if size > 1 else slides[..., end - 1]
                for name, size, end in zip(SLIDE_OUTPUTS, sizes, ends)}

    @property
    def statistics(self):
        """Counts, step sizes, error estimate and seconds by part."""
        s = self.run.statistics
        return {"steps": s.steps, "rejected_steps": s.rejected, "newton_iterations": s.newton_iterations,
                "factorisations": s.factorisations, "newton_failures": s.newton_failures, "evaluations": s.evaluations,
                "element_crossings": s.crossings, "smallest_step_s": s.h_min, "largest_step_s": s.h_max,
                "sum_of_local_error_estimates_m": s.error_sum, "largest_motion_m": self.run.motion,
                "time_s": {"residual": s.time_residual, "factorisation": s.time_factor, "solve": s.time_solve,
                           "output": s.time_output}}

    def costs(self):
        """(slides + joints,): what each takes of a step, in seconds, timed by itself in less than 1 ms; see run/part_timing.c."""
        cdef double[::1] seconds = np.zeros(self.model.n_couplings + 1)
        cdef int first = self._count("load"), n = self._count("slide") + self._count("joint")
        fu_part_timing(&self.run, &seconds[0])
        return np.asarray(seconds)[first:first + n]

    @property
    def integrator(self):
        """Name of the integrator."""
        return self.run.integrator.name.decode()

    @property
    def unknowns(self):
        """Number of unknowns of a Newton system."""
        return self.run.newton.n + self.run.newton.m

    @property
    def in_blocks(self):
        """Whether cables have kernels for several elements at once."""
        return [self.cables[i].blocks != NULL for i in range(self.model.n_cables)]

    @property
    def band(self):
        """Unknowns in the band of a Newton system, its half width, and unknowns in its border."""
        return self.run.newton.n, self.run.newton.width, self.run.newton.m

    @property
    def memory(self):
        """Bytes of the engine's arrays; recorded rows count only after `start`."""
        return sum(array.nbytes for array in self.kept)

    @property
    def time(self):
        """Time reached, s."""
        return self.run.now.t

    @property
    def failure(self):
        """Of the last step that failed: why (see CAUSES), and the dof and slide (or None) where that shows most.

        Why is None where energy grew, and where no step was tried that failed.
        """
        f = self.run.failure
        return CAUSES[f.cause], f.dof, f.slide if f.cause != FU_NO_FAILURE and f.slide >= 0 else None

    @property
    def self_locking(self):
        """Index of the slide whose friction has no solution, -1."""
        return self.run.accelerator.self_locking

    @property
    def balance(self):
        """Energy that has come from nowhere, that went there, was exchanged, in motion, and what rounding makes, J."""
        b = self.run.balance
        return b.grown, b.lost, b.exchanged, b.in_motion, b.rounding

    @property
    def moves(self):
        """Whether anything has moved beyond rounding."""
        return bool(fu_moves(&self.run))

    def compliance(self):
        """(multipliers, multipliers): H M^-1 H' at the time reached, singular where joints hold the same."""
        cdef int n = self.model.n_multipliers
        cdef double[:, ::1] S = np.zeros((max(n, 1), max(n, 1)))
        if fu_compliance(&self.model, &self.run.now, &self.run.accelerator, &S[0, 0]):
            raise ArithmeticError("the mass matrix is singular")
        return np.asarray(S)[:n, :n]

    def prepare(self):
        """What `compliance` needs before `start`; whether there are consistent slides and a mass matrix."""
        return fu_prepare(&self.run) == FU_RUNNING

    def redundant_rows(self, rows):
        """Let no multiplier stand for these rows of joints, (link, row) each, which others imply."""
        for joint, row in rows:
            self.joints[joint].redundant_rows |= 1 << row

    def probe_mechanism(self, along):
        """What is left of the joints' equations, (links, 6), after a small way `along` (n_dof,) the freedom that they
        leave; None where no way leads back onto them. See fu_probe_mechanism.
        """
        cdef double[::1] path = np.ascontiguousarray(along, dtype=float)
        cdef double[::1] left = np.zeros(self.model.n_forces + 1)
        if fu_probe_mechanism(&self.run, &path[0], &left[0]):
            return None
        return self._own("joint", left, 6)

    def joint_forces(self):
        """(joints, 7): force and moment of joints on their second ends, and residual, in the static state."""
        cdef int k, n = self._count("joint")
        out = np.zeros((n, fu_coupling_type_of(b"joint").n_outputs))
        cdef double[:, ::1] view = out
        for k in range(n):
            fu_joint_outputs(&self.model, &self.joints[k], &self.run.next,
                             self.run.next.forces + self.joints[k].base.force, <fu_joint_output *>&view[k, 0])
        return out

    @property
    def extent(self):
        """Largest size of what coordinates are, m."""
        return self.run.extent

    @property
    def closed(self):
        """How far, in m, things moved at the start to close the gaps of joints."""
        return self.run.closed

    def now(self):
        """t, q, v, s at the time reached."""
        return self._snapshot(&self.run.now)

    @property
    def stopped_slide(self):
        """Index of the slide that ran off its cable."""
        return self.run.stopped_slide

    @property
    def stopped_s(self):
        """Arc-length of that slide, m."""
        return self._view(&self.run.now, "s")[self.run.stopped_slide]
