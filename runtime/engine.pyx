# cython: language_level=3
"""The compiled engine's face: arrays of a model in, recorded rows out. The work is in engine/*.c.

The engine is C and not Cython because `cimport` does not work across the mapped packages; what passes between
generated kernels and the engine is a C header.
"""

import numpy as np

from cpython.exc cimport PyErr_CheckSignals
from cpython.mem cimport PyMem_Calloc, PyMem_Free
from cpython.pycapsule cimport PyCapsule_GetPointer
from libc.string cimport strcmp
from scipy.linalg cimport cython_blas, cython_lapack

from funicular.generated import kernels

cdef extern from "kernels.h" nogil:
    ctypedef struct fu_element:
        const char *name
        int vectors, dim, nodes
    ctypedef struct fu_slide:
        const char *name
        int coordinates
    ctypedef struct fu_law:
        const char *name
    ctypedef struct fu_tables:
        int n_elements, n_laws, n_slides
        const fu_element *elements
        const fu_law *laws
        const fu_slide *slides

cdef extern from "engine.h" nogil:
    int FU_JOINT_TERMS, FU_JOINT_OUTPUTS, FU_MAX_COORDINATES
    int FU_RUNNING, FU_DONE, FU_END_OF_CABLE, FU_NO_CONVERGENCE, FU_SINGULAR
    ctypedef struct fu_cable:
        const fu_element *kernel
        const fu_law *law
        int n_elements, first, coordinates, per_node
        double length, tau
        const double *m
        const double *A
        const double *gravity
    ctypedef struct fu_rigid:
        int configuration, dof
        double mass
        double J[9]
        double gravity[3]
    ctypedef struct fu_joint:
        const fu_slide *kernel
        int cable, rider
        double u[3]
        double mass
    ctypedef struct fu_lapack:
        void *dgbtrf
        void *dgbtrs
        void *dgetrf
        void *dgetrs
        void *dgemm
        void *dgemv
    ctypedef struct fu_system:
        int n, width, m
        double *K
        double *B
        double *C
        double *D
        double *X
        int *pivot_band
        int *pivot_border
    ctypedef struct fu_model:
        int n_cables, n_rigids, n_joints
        const fu_cable *cables
        const fu_rigid *rigids
        const fu_joint *joints
        int n_q, n_dof, n_band, n_border_dof
        const int *place
        const double *weight
        const fu_lapack *lapack
    ctypedef struct fu_state:
        double t
        double *q
        double *v
        double *acceleration
        double *a
        double *s
        double *f
        int *element
        double *director
    ctypedef struct fu_accelerator:
        fu_system mass
        double *rhs
        double *terms
        double *force
        double *work
        double *joints
    ctypedef struct fu_genalpha:
        double alpha_m, alpha_f, beta, gamma
    ctypedef struct fu_statistics:
        long steps, rejected, newton_iterations, factorisations, crossings, newton_failures
        double h_min, h_max, error_sum, time_factor, time_solve, time_residual, time_output
    ctypedef struct fu_record:
        int n
        double *time
        double *q
        double *v
        double *acceleration
        double *reaction
        double *s
        double *joint
        double *kinetic
        double *elastic
        double *potential
        double *dissipated
    ctypedef struct fu_run:
        const fu_model *model
        fu_genalpha scheme
        double duration, output_step, fixed_step, tol
        fu_state now, next
        fu_system newton
        fu_accelerator accelerator
        fu_record record
        fu_statistics statistics
        double *rhs
        double *psi
        double *force
        double *work
        double *before
        double *first
        double *s_slope
        double h, h_factored, contraction, motion
        int factored, stopped_joint, rest_start
    void fu_linearise(fu_run *run, double h, const double *change)
    int fu_start(fu_run *run)
    int fu_advance(fu_run *run, double seconds)

cdef const fu_tables *TABLES = <const fu_tables *>PyCapsule_GetPointer(kernels.tables,
                                                                      "funicular.generated.kernels.tables")
cdef fu_lapack LAPACK
LAPACK.dgbtrf = <void *>cython_lapack.dgbtrf
LAPACK.dgbtrs = <void *>cython_lapack.dgbtrs
LAPACK.dgetrf = <void *>cython_lapack.dgetrf
LAPACK.dgetrs = <void *>cython_lapack.dgetrs
LAPACK.dgemm = <void *>cython_blas.dgemm
LAPACK.dgemv = <void *>cython_blas.dgemv

STATUS = {FU_DONE: "completed", FU_END_OF_CABLE: "end_of_cable", FU_NO_CONVERGENCE: "no_convergence",
          FU_SINGULAR: "singular"}
JOINT_OUTPUTS = ("s_rate", "s_acceleration", "force", "multiplier", "residual")


cdef const void *_table(address, role, name) except NULL:
    """Kernels of an element, law or slide by name, in a library's fu_all at an address, or in this package's (0)."""
    cdef const fu_tables *tables = <const fu_tables *><size_t>address if address else TABLES
    cdef int k
    wanted = name.encode()
    if role == "element":
        for k in range(tables.n_elements):
            if strcmp(tables.elements[k].name, wanted) == 0:
                return &tables.elements[k]
    elif role == "law":
        for k in range(tables.n_laws):
            if strcmp(tables.laws[k].name, wanted) == 0:
                return &tables.laws[k]
    else:
        for k in range(tables.n_slides):
            if strcmp(tables.slides[k].name, wanted) == 0:
                return &tables.slides[k]
    raise ValueError(f"no kernels for {role} {name}")


cdef class Engine:
    """One run of a model (see model.py for the fields that it reads)."""

    cdef fu_cable *cables
    cdef fu_rigid *rigids
    cdef fu_joint *joints
    cdef fu_model model
    cdef fu_run run
    cdef list kept
    cdef readonly dict arrays

    def __cinit__(self, model):
        self.cables = <fu_cable *>PyMem_Calloc(max(1, len(model.cables)), sizeof(fu_cable))
        self.rigids = <fu_rigid *>PyMem_Calloc(max(1, len(model.rigids)), sizeof(fu_rigid))
        self.joints = <fu_joint *>PyMem_Calloc(max(1, len(model.joints)), sizeof(fu_joint))
        if not (self.cables and self.rigids and self.joints):
            raise MemoryError

    def __dealloc__(self):
        PyMem_Free(self.cables)
        PyMem_Free(self.rigids)
        PyMem_Free(self.joints)

    def __init__(self, model):
        cdef int i, k
        self.kept, self.arrays = [], {}
        for i, cable in enumerate(model.cables):
            c = &self.cables[i]
            c.kernel = <const fu_element *>_table(cable.tables, "element", cable.element)
            c.law = <const fu_law *>_table(cable.tables, "law", f"{cable.element}_{cable.law}")
            c.n_elements, c.first, c.length, c.tau = cable.n_elements, cable.first, cable.length, cable.tau
            c.per_node = c.kernel.vectors * c.kernel.dim
            c.coordinates = c.kernel.nodes * c.per_node
            c.m, c.A, c.gravity = self._doubles(cable.m), self._doubles(cable.A), self._doubles(cable.gravity)
        for i, body in enumerate(model.rigids):
            r = &self.rigids[i]
            r.configuration, r.dof, r.mass = body.configuration, body.dof, body.mass
            for k in range(9):
                r.J[k] = body.inertia.flat[k]
            for k in range(3):
                r.gravity[k] = body.gravity[k]
        for i, joint in enumerate(model.joints):
            j = &self.joints[i]
            j.kernel = <const fu_slide *>_table(model.cables[joint.cable].tables, "slide", joint.kernel)
            if j.kernel.coordinates + 1 > FU_MAX_COORDINATES:
                raise ValueError(f"{joint.kernel}: more coordinates than the engine's {FU_MAX_COORDINATES}")
            j.cable, j.rider, j.mass = joint.cable, joint.rider, joint.mass
            for k in range(3):
                j.u[k] = joint.u[k]
        m = &self.model
        m.n_cables, m.n_rigids, m.n_joints = len(model.cables), len(model.rigids), len(model.joints)
        m.cables, m.rigids, m.joints = self.cables, self.rigids, self.joints
        m.n_q, m.n_dof = model.n_q, model.n_dof
        m.n_band, m.n_border_dof = model.n_band, model.n_border_dof
        m.place, m.weight, m.lapack = self._ints(model.place), self._doubles(model.weight), &LAPACK
        self._work_space(model)

    cdef double *_doubles(self, values):
        array = np.array(values, dtype=float, order="C").ravel()
        if array.size == 0:
            array = np.zeros(1)
        cdef double[::1] view = array
        self.kept.append(array)
        return &view[0]

    cdef int *_ints(self, values):
        array = np.array(values, dtype=np.intc).ravel()
        if array.size == 0:
            array = np.zeros(1, dtype=np.intc)
        cdef int[::1] view = array
        self.kept.append(array)
        return &view[0]

    cdef double *_named(self, name, shape):
        cdef double *pointer = self._doubles(np.zeros(shape))
        if np.prod(shape, dtype=int):
            self.arrays[name] = self.kept[-1].reshape(shape)
        else:
            self.arrays[name] = np.zeros(shape)
        return pointer

    cdef void _system(self, fu_system *system, int n, int width, int m):
        system.n, system.width, system.m = n, width, m
        system.K, system.D = self._doubles(np.zeros((3 * width + 1) * n)), self._doubles(np.zeros(m * m))
        system.B, system.C = self._doubles(np.zeros(n * m)), self._doubles(np.zeros(n * m))
        system.X = self._doubles(np.zeros(n * m))
        system.pivot_band, system.pivot_border = self._ints(np.zeros(n)), self._ints(np.zeros(m))

    cdef void _state(self, fu_state *state, model):
        state.q, state.v = self._doubles(model.q), self._doubles(model.v)
        state.acceleration, state.a = self._doubles(np.zeros(model.n_dof)), self._doubles(np.zeros(model.n_dof))
        joints = len(model.joints)
        state.s, state.f = self._doubles([j.s for j in model.joints]), self._doubles(np.zeros(3 * joints))
        state.element = self._ints([j.element for j in model.joints])
        state.director = self._doubles([j.director for j in model.joints])

    def _work_space(self, model):
        n_joints, n_dof = len(model.joints), model.n_dof
        unknowns = model.n_band + model.n_border_dof
        run = &self.run
        run.model = &self.model
        self._state(&run.now, model)
        self._state(&run.next, model)
        self._system(&run.newton, model.n_band, model.width, model.n_border_dof + 4 * n_joints)
        a = &run.accelerator
        self._system(&a.mass, model.n_band, model.width, model.n_border_dof + 2 * n_joints)
        a.rhs = self._doubles(np.zeros(unknowns + 2 * n_joints))
        a.terms = self._doubles(np.zeros(n_joints * FU_JOINT_TERMS))
        a.joints = self._doubles(np.zeros(n_joints * FU_JOINT_OUTPUTS))
        a.force, a.work = self._doubles(np.zeros(n_dof)), self._doubles(np.zeros(n_dof))
        run.rhs = self._doubles(np.zeros(unknowns + 4 * n_joints))
        run.psi, run.force = self._doubles(np.zeros(n_dof)), self._doubles(np.zeros(n_dof))
        run.work, run.before = self._doubles(np.zeros(n_dof)), self._doubles(np.zeros(n_dof))
        run.first, run.s_slope = self._doubles(np.zeros(model.n_q)), self._doubles(np.zeros(n_joints))

    def linearise(self, double h, change):
        """Residual and Newton matrix of a step h after moving its prediction by `change`; for tests.

        change (unknowns,): psi of the free dofs, then s and the scaled force of each slide.
        Returns (unknowns,) and (unknowns, unknowns), d residual/d change.
        """
        cdef double[::1] moved = np.ascontiguousarray(change, dtype=float)
        cdef fu_system *system = &self.run.newton
        cdef int i, j, n = system.n, width = system.width, m = system.m
        cdef int total = n + m, rows = 3 * width + 1
        if moved.shape[0] != total:
            raise ValueError(f"change must have {total} entries")
        fu_linearise(&self.run, h, &moved[0])
        matrix = np.zeros((total, total))
        for j in range(n):
            for i in range(max(0, j - width), min(n, j + width + 1)):
                matrix[i, j] = system.K[j * rows + 2 * width + i - j]
        for j in range(m):
            for i in range(n):
                matrix[i, n + j], matrix[n + j, i] = system.B[j * n + i], system.C[j * n + i]
            for i in range(m):
                matrix[n + i, n + j] = system.D[j * m + i]
        return -np.array([self.run.rhs[i] for i in range(total)]), matrix

    def start(self, *, duration, output_step, tol, step, scheme, first_step, rest_start=False):
        """Allocate the output rows and compute the consistent start.

        Returns a status where that failed, else None, and the change of velocities that the joints asked for.
        """
        run = &self.run
        run.duration, run.output_step, run.tol = duration, output_step, tol
        run.fixed_step, run.h, run.rest_start = step, first_step, rest_start
        run.scheme.alpha_m, run.scheme.alpha_f, run.scheme.beta, run.scheme.gamma = scheme
        rows = int(np.ceil(duration / output_step * (1 - 1e-12))) + 2
        m = &self.model
        r = &run.record
        r.time, r.kinetic, r.elastic = self._named("time", rows), self._named("kinetic", rows), self._named("elastic", rows)
        r.potential, r.dissipated = self._named("potential", rows), self._named("dissipated", rows)
        r.q, r.v = self._named("q", (rows, m.n_q)), self._named("v", (rows, m.n_dof))
        r.acceleration = self._named("acceleration", (rows, m.n_dof))
        r.reaction = self._named("reaction", (rows, m.n_dof))
        r.s, r.joint = self._named("s", (rows, m.n_joints)), self._named("joint", (rows, m.n_joints, FU_JOINT_OUTPUTS))
        cdef int status = fu_start(run)
        if status:
            return STATUS[status], np.zeros(m.n_dof)
        return None, np.array([run.before[i] for i in range(m.n_dof)])

    def advance(self, on_progress, double interval=0.05):
        """Run to the end; returns the status, "interrupted" after Ctrl-C."""
        cdef int status = FU_RUNNING
        try:
            while status == FU_RUNNING:
                with nogil:
                    status = fu_advance(&self.run, interval)
                PyErr_CheckSignals()
                on_progress(self.run.now.t)
        except KeyboardInterrupt:
            return "interrupted"
        return STATUS[status]

    def rows(self):
        """Recorded arrays by name, cut to the rows that were written."""
        return {name: array[:self.run.record.n] for name, array in self.arrays.items()}

    def joint_row(self, joints):
        """Split joint numbers (..., FU_JOINT_OUTPUTS) by name; see fu_joint_output."""
        sizes = (1, 1, 3, 2, 3)
        ends = np.cumsum(sizes)
        return {name: joints[..., end - size:end] if size > 1 else joints[..., end - 1]
                for name, size, end in zip(JOINT_OUTPUTS, sizes, ends)}

    @property
    def statistics(self):
        """Counts, step sizes, error estimate and seconds by part."""
        s = self.run.statistics
        return {"steps": s.steps, "rejected_steps": s.rejected, "newton_iterations": s.newton_iterations,
                "factorisations": s.factorisations, "newton_failures": s.newton_failures,
                "element_crossings": s.crossings, "smallest_step_s": s.h_min, "largest_step_s": s.h_max,
                "sum_of_local_error_estimates_m": s.error_sum, "largest_motion_m": self.run.motion,
                "time_s": {"residual": s.time_residual, "factorisation": s.time_factor, "solve": s.time_solve,
                           "output": s.time_output}}

    @property
    def time(self):
        """Time reached, s."""
        return self.run.now.t

    @property
    def stopped_joint(self):
        """Index of the slide that ran off its cable."""
        return self.run.stopped_joint
