# cython: language_level=3
"""The compiled engine's face: arrays of a model in, recorded rows out. The work is in engine/*.c.

The engine is C and not Cython because `cimport` does not work across the mapped packages; what passes between
generated kernels and the engine is a C header.
"""

import numpy as np

from cpython.exc cimport PyErr_CheckSignals
from cpython.mem cimport PyMem_Calloc, PyMem_Free
from cpython.pycapsule cimport PyCapsule_GetPointer
from scipy.linalg cimport cython_lapack

from funicular.generated import kernels

include "engine/engine.pxi"

cdef const fu_tables *TABLES = <const fu_tables *>PyCapsule_GetPointer(kernels.tables,
                                                                      "funicular.generated.kernels.tables")
cdef fu_lapack LAPACK
LAPACK.dgbtrf = <void *>cython_lapack.dgbtrf
LAPACK.dgbtrs = <void *>cython_lapack.dgbtrs
LAPACK.dpbtrf = <void *>cython_lapack.dpbtrf
LAPACK.dgetrf = <void *>cython_lapack.dgetrf
LAPACK.dgetrs = <void *>cython_lapack.dgetrs
LAPACK.zgbtrf = <void *>cython_lapack.zgbtrf
LAPACK.zgbtrs = <void *>cython_lapack.zgbtrs
LAPACK.zgetrf = <void *>cython_lapack.zgetrf
LAPACK.zgetrs = <void *>cython_lapack.zgetrs

STATUS = {FU_DONE: "completed", FU_END_OF_CABLE: "end_of_cable", FU_NO_CONVERGENCE: "no_convergence",
          FU_SINGULAR: "singular", FU_EVENT: "event",
          FU_UNSTABLE: "unstable"}
CAUSES = {FU_NO_FAILURE: None, FU_ITERATION: "iteration", FU_MATRIX: "matrix", FU_ERROR: "error",
          FU_LOST_RIDER: "lost_rider", FU_NOT_FINITE: "not_finite", FU_JAM: "jam"}
ACTIONS = {FU_STUCK: "stuck", FU_BROKE_LOOSE: "broke loose", FU_TURNED: "turned round", FU_STRUCK: "struck the end",
           FU_RESTS: "came to rest at the end", FU_FREED: "left the end", FU_FLEW: "left", FU_ENTERED: "entered the buffer",
           FU_CAME_OUT: "left the buffer"}
ENDS = {"error": FU_END_IS_ERROR, "leave": FU_END_IS_OPEN, "hard": FU_END_IS_HARD, "buffer": FU_END_IS_BUFFERED}
JOINT_OUTPUTS = ("s_rate", "s_acceleration", "force", "multiplier", "traction", "residual")


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


cdef class Engine:
    """One run of a model (see model.py for the fields that it reads).

    blocks: take kernels of several elements at once where there are.
    """

    cdef fu_cable *cables
    cdef fu_rigid *rigids
    cdef fu_shape *shapes
    cdef fu_joint *joints
    cdef fu_link *links
    cdef fu_spring *springs
    cdef fu_motion *motions
    cdef fu_dead_load *dead_loads
    cdef fu_load *loads
    cdef fu_signal *signals
    cdef fu_watch *watches
    cdef object watcher, error, spreads
    cdef fu_model model
    cdef fu_run run
    cdef list kept
    cdef readonly dict arrays

    def __cinit__(self, model, blocks=True):
        self.cables = <fu_cable *>PyMem_Calloc(len(model.cables) + 1, sizeof(fu_cable))
        self.rigids = <fu_rigid *>PyMem_Calloc(len(model.rigids) + 1, sizeof(fu_rigid))
        self.shapes = <fu_shape *>PyMem_Calloc(len(model.rigids) + 1, sizeof(fu_shape))
        self.joints = <fu_joint *>PyMem_Calloc(len(model.joints) + 1, sizeof(fu_joint))
        self.links = <fu_link *>PyMem_Calloc(len(model.links) + 1, sizeof(fu_link))
        self.springs = <fu_spring *>PyMem_Calloc(len(model.springs) + 1, sizeof(fu_spring))
        self.motions = <fu_motion *>PyMem_Calloc(len(model.motions) + 1, sizeof(fu_motion))
        self.dead_loads = <fu_dead_load *>PyMem_Calloc(len(model.dead_loads) + 1, sizeof(fu_dead_load))
        self.loads = <fu_load *>PyMem_Calloc(len(model.loads) + 1, sizeof(fu_load))
        self.signals = <fu_signal *>PyMem_Calloc(len(model.signals) + 1, sizeof(fu_signal))
        if not (self.cables and self.rigids and self.shapes and self.joints and self.links and self.springs
                and self.motions and self.dead_loads
                and self.loads and self.signals):
            raise MemoryError

    def __dealloc__(self):
        for pointer in (<size_t>self.cables, <size_t>self.rigids, <size_t>self.shapes, <size_t>self.joints,
                        <size_t>self.links, <size_t>self.springs,
                        <size_t>self.motions, <size_t>self.dead_loads, <size_t>self.loads, <size_t>self.signals, <size_t>self.watches):
            PyMem_Free(<void *><size_t>pointer)

    def __init__(self, model, blocks=True):
        self.kept, self.arrays = [], {}
        tables = [<size_t>TABLES, *model.tables]
        self._bodies_and_cables(model, tables, blocks)
        self._joints_and_springs(model, tables)
        self._loads_and_motions(model)
        m = &self.model
        m.dim, m.n_q, m.n_dof = model.dim, model.n_q, model.n_dof
        m.n_band, m.n_border_dof = model.n_band, model.n_border_dof
        m.n_extra, m.n_multipliers = model.n_extra, model.n_multipliers
        m.place, m.weight, m.lapack = self._ints(model.place), self._doubles(model.weight), &LAPACK
        m.combination_start = self._ints(model.combinations.indptr)
        m.combination_place = self._ints(model.combinations.indices)
        m.combination_value = self._doubles(model.combinations.data)
        m.threads, m.parts = 1, NULL
        m.gravity, m.zero = self._doubles(model.gravity), self._doubles(np.zeros(model.n_dof))
        self._work_space(model)
        self.spreads = None

    def _bodies_and_cables(self, model, list tables, blocks):
        cdef int i, k, memory = 0
        for i, cable in enumerate(model.cables):
            c = &self.cables[i]
            c.kernel = <const fu_element *>_found(tables, "element", cable.element)
            c.law = <const fu_law *>_found(tables, "law", f"{cable.element}_{cable.law}")
            c.blocks = fu_blocks_of(c.law.name) if blocks and cable.library is None else NULL
            c.n_elements, c.first, c.length = cable.n_elements, cable.first, cable.length
            c.tau, c.mass_damping = cable.tau, cable.mass_damping
            c.per_node = c.kernel.vectors * c.kernel.dim
            c.coordinates = c.kernel.nodes * c.per_node
            if c.coordinates > FU_MAX_COORDINATES:
                raise ValueError(f"{cable.element}: more coordinates than the engine's {FU_MAX_COORDINATES}")
            c.m, c.A = self._doubles(cable.m), self._doubles(cable.A)
            c.A_stride = cable.A.shape[1] if len(cable.A) > 1 else 0
            if c.law.rates > FU_MAX_RATES:
                raise ValueError(f"{cable.element}: more rates of strain than the engine's {FU_MAX_RATES}")
            c.memory, memory = memory, memory + c.n_elements * (c.law.rates + 1)
        for i, body in enumerate(model.rigids):
            r = &self.rigids[i]
            r.kernel = <const fu_body *>_found(tables, "body", body.kernel)
            r.configuration, r.dof, r.mass = body.configuration, body.dof, body.mass
            r.matter, r.modes, r.shape = &fu_rigid_matter, 0, NULL
            for k in range(9):
                r.J[k] = body.inertia.flat[k]
            if body.shape is not None:
                self._shape(r, &self.shapes[i], body, tables)
        self.model.n_cables, self.model.n_rigids = len(model.cables), len(model.rigids)
        self.model.cables, self.model.rigids = self.cables, self.rigids

    cdef int _shape(self, fu_rigid *r, fu_shape *h, body, list tables) except -1:
        shape, n = body.shape, body.modes
        cdef int k
        r.matter, r.modes, r.shape = &fu_modal_matter, n, h
        h.kernel = <const fu_modal *>_found(tables, "modal", body.modal_kernel)
        h.S, h.X = self._doubles(shape.S), self._doubles(shape.X)
        h.mass = self._doubles(np.einsum("klii->kl", shape.X)[1:, 1:])
        h.stiffness, h.damping = self._doubles(shape.stiffness), self._doubles(shape.damping)
        dofs = r.kernel.velocity + n
        h.zero, h.matrices = self._doubles(np.zeros(dofs)), self._doubles(np.zeros(3 * dofs * dofs))
        h.sums = self._doubles(np.zeros(3 * (n + 1) * r.kernel.dim * r.kernel.dim))
        for k in range(len(shape.gravity)):
            h.g[k] = shape.gravity[k]
        return 0

    def anchor(self, int index, x, phi, psi, b, w, f, m):
        """A point of modal body `index` with its axes, as engine/modal.c has it; for tests.

        x (dim,), phi (modes, dim), psi (modes, turns); b, w: the body's entries of q and v. Returns what `fu_modal_point`
        holds, P, T, and K for a force f and a moment m on the point.
        """
        cdef fu_rigid *r = &self.rigids[index]
        cdef fu_spot spot
        cdef fu_modal_point out
        cdef int n = fu_body_dofs(r), dim = r.kernel.dim, turns = r.kernel.velocity - r.kernel.dim
        spot.x, spot.phi, spot.psi = self._doubles(x), self._doubles(phi), self._doubles(psi)
        P, T, K = np.zeros((dim, n)), np.zeros((turns, n)), np.zeros((n, n))
        cdef double[:, ::1] P_view = P, T_view = T, K_view = K
        fu_modal_anchor(r, &spot, self._doubles(b), self._doubles(w), &out, &P_view[0, 0], &T_view[0, 0])
        fu_modal_anchor_force(r, &spot, self._doubles(b), self._doubles(f), self._doubles(m), &K_view[0, 0])
        return {"p": np.array(out.p)[:dim], "axes": np.array(out.axes)[:dim * dim].reshape(dim, dim), "P": P, "T": T, "K": K,
                "velocity": np.array(out.velocity)[:dim], "omega": np.array(out.omega)[:turns],
                "bias": np.array(out.bias)[:dim], "omega_bias": np.array(out.omega_bias)[:turns]}

    cdef int _spot(self, fu_spot *to, int body, spot) except -1:
        to.x, to.phi, to.psi = self._doubles(spot[0]), self._doubles(spot[1]), self._doubles(spot[2])
        if fu_body_dofs(&self.rigids[body]) > FU_END_COORDINATES:
            raise ValueError(f"more modes than the engine's {FU_END_COORDINATES - 6}")
        return 0

    cdef int _end(self, fu_end *to, end, list tables) except -1:
        cdef int k
        to.cable, to.body, to.element, to.slide = end.cable, end.body, end.element, end.slide
        to.frame = NULL
        for k in range(len(end.u)):
            to.u[k] = end.u[k]
        for k in range(len(end.N)):
            to.N[k] = end.N[k]
        if end.spot is not None:
            self._spot(&to.spot, end.body, end.spot)
        if end.axes is None:
            return 0
        if end.frame:
            to.frame = <const fu_frame *>_found(tables, "frame", end.frame)
        for k in range(2):
            to.slopes[k] = end.slopes[k]
        for k in range(3):
            to.up[k] = end.up[k]
        for k in range(end.S.size):
            to.S[k] = end.S.flat[k]
        for k in range(end.axes.size):
            to.axes[k] = end.axes.flat[k]
        return 0

    def _joints_and_springs(self, model, list tables):
        cdef int i, k, brakes = 0
        for i, joint in enumerate(model.joints):
            j = &self.joints[i]
            j.kernel = <const fu_slide *>_found(tables, "slide", joint.kernel)
            if j.kernel.coordinates + 1 > FU_MAX_COORDINATES:
                raise ValueError(f"{joint.kernel}: more coordinates than the engine's {FU_MAX_COORDINATES}")
            j.cable, j.native, j.room, j.drive = joint.cable, joint.native, joint.room, joint.drive
            j.unknown, j.multiplier, j.carries_director = joint.unknown, joint.multiplier, joint.carries_director
            j.mass = joint.mass
            self._end(&j.rider, joint.rider, tables)
            j.brake = <const fu_brake *>_found(tables, "brake", joint.brake) if joint.brake else NULL
            brakes += bool(joint.brake)
            j.velocity = 1.0  # of no friction
            if joint.friction is not None:
                j.sticks, j.viscous, j.velocity = joint.friction.sticks, joint.friction.viscous, joint.friction.velocity
                j.friction, j.holding = joint.friction.sliding, joint.friction.holding
            for k, end in enumerate(joint.ends):
                e = &j.stops[k]
                e.kind = ENDS[end if isinstance(end, str) else end.stop]
                if e.kind == FU_END_IS_HARD:
                    e.restitution = end.restitution
                if e.kind == FU_END_IS_BUFFERED:
                    e.length, e.stiffness, e.damping = end.length, end.stiffness, end.damping
        for i, link in enumerate(model.links):
            l = &self.links[i]
            l.kernel = <const fu_pair *>_found(tables, "pair", link.kernel)
            l.unknown, l.multiplier, l.signal, l.base = link.unknown, link.multiplier, link.signal, link.base
            for k in range(link.rows):
                l.scale[k] = link.scale[k]
            for k in range(2):
                self._end(&l.ends[k], link.ends[k], tables)
        for i, spring in enumerate(model.springs):
            p = &self.springs[i]
            p.dim, p.unknown, p.mass = spring.dim, spring.unknown, spring.mass
            p.stiffness, p.damping, p.length = spring.stiffness, spring.damping, spring.length
            for k in range(2):
                self._end(&p.ends[k], spring.ends[k], tables)
        m = &self.model
        m.n_joints, m.n_links, m.n_springs = len(model.joints), len(model.links), len(model.springs)
        m.n_brakes = brakes
        m.joints, m.links, m.springs = self.joints, self.links, self.springs

    def _loads_and_motions(self, model):
        cdef int i, k, at = 0
        for i, signal in enumerate(model.signals):
            g = &self.signals[i]
            g.n = len(signal.coefficients)
            if g.n and signal.coefficients.shape[1] != FU_SIGNAL_TERMS:
                raise ValueError(f"a signal's pieces need {FU_SIGNAL_TERMS} coefficients")
            g.breaks, g.coefficients = self._doubles(signal.breaks), self._doubles(signal.coefficients)
            g.amplitude, g.angular_frequency, g.phase = signal.amplitude, signal.angular_frequency, signal.phase
        moved = set()
        for i, motion in enumerate(model.motions):
            o = &self.motions[i]
            o.dof, o.signal, o.base, o.linear = motion.dof, motion.signal, motion.base, motion.linear
            o.cosine, o.sine, o.first = motion.cosine, motion.sine, motion.dof not in moved
            moved.add(motion.dof)
        dofs, values = [], []
        for i, load in enumerate(model.dead_loads):
            d = &self.dead_loads[i]
            d.signal, d.first, d.n = load.signal, at, len(load.dofs)
            at += d.n
            dofs.extend(load.dofs)
            values.extend(load.values)
        self.model.dead_dof, self.model.dead_value = self._ints(dofs), self._doubles(values)
        for i, load in enumerate(model.loads):
            n = &self.loads[i]
            n.kind, n.signal, n.on, n.element, n.x = load.kind, load.signal, load.on, load.element, load.x
            for k in range(3):
                n.u[k], n.c[k] = load.u[k], load.c[k]
            if load.spot is not None:
                self._spot(&n.spot, load.on, load.spot)
        m = &self.model
        m.n_motions, m.n_dead_loads, m.n_loads = len(model.motions), len(model.dead_loads), len(model.loads)
        m.motions, m.dead_loads, m.loads, m.signals = self.motions, self.dead_loads, self.loads, self.signals

    cdef double *_doubles(self, values):
        array = np.array(values, dtype=float, order="C").ravel()
        if array.size == 0:
            array = np.zeros(1)
        cdef double[::1] view = array
        self.kept.append(array)
        return &view[0]

    cdef double *_zeros(self, long size):
        # kept as they come: memory that nothing is written to is not taken from the machine
        array = np.zeros(max(1, size))
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
        array = np.zeros(shape)
        cdef double *pointer = self._doubles(array)
        self.arrays[name] = self.kept[-1].reshape(shape) if array.size else array
        return pointer

    cdef void _system(self, fu_system *system, model, int width, int m):
        cdef int n = model.n_band, chains = len(model.chains) - 1
        system.n, system.width, system.m, system.n_chains = n, width, m, chains
        system.chains = self._ints(model.chains)
        middles = (model.chains[:-1] + model.chains[1:]) // 2
        system.half = self._ints(np.searchsorted(np.sort([*model.chains[:-1], *middles]), np.arange(n), "right") - 1)
        system.D, system.L = self._zeros(m * m), self._zeros((width + 1) * (n + FU_BAND_GROUP * chains))
        system.B, system.C = self._zeros(n * m), self._zeros(n * m)
        system.X = self._zeros(FU_BAND_LENGTH(n, width) * m)
        system.span_B = <fu_span *>self._ints(np.zeros(2 * 2 * m * chains))
        system.span_C = <fu_span *>self._ints(np.zeros(2 * 2 * m * chains))
        system.columns = <fu_piece *>self._ints(np.zeros(3 * 2 * m * chains))
        system.rows = <fu_piece *>self._ints(np.zeros(3 * 2 * m * chains))
        system.pivot_band, system.pivot_border = self._ints(np.zeros(n)), self._ints(np.zeros(m))

    cdef void _state(self, fu_state *state, model):
        state.q, state.v = self._doubles(model.q), self._doubles(model.v)
        state.acceleration, state.a = self._doubles(np.zeros(model.n_dof)), self._doubles(np.zeros(model.n_dof))
        joints = len(model.joints)
        state.s, state.f = self._doubles([j.s for j in model.joints]), self._doubles(np.zeros(3 * joints))
        state.spring, state.t = self._doubles(np.zeros(3 * len(model.springs))), 0.0
        state.multipliers = self._doubles(np.zeros(6 * len(model.links)))
        state.hold = self._doubles(np.zeros(joints))
        state.element = self._ints([j.element for j in model.joints])
        state.mode = self._ints([FU_HELD if j.drive >= 0 else FU_SLIDES for j in model.joints])
        state.way, state.contact = self._ints(np.zeros(joints)), self._ints(np.zeros(joints))
        state.director = self._doubles([j.director for j in model.joints])
        state.memory = self._zeros(0)

    def _work_space(self, model):
        n_joints, n_dof = len(model.joints), model.n_dof
        unknowns = model.n_band + model.n_border_dof
        run = &self.run
        run.model = &self.model
        self._state(&run.now, model)
        self._state(&run.next, model)
        width = max(model.width, FU_BAND_GROUP - 1)
        self._system(&run.newton, model, width, model.n_border_dof + model.n_extra)
        a = &run.accelerator
        self._system(&a.mass, model, width, model.n_border_dof + model.n_multipliers)
        # that of the mass is factored elsewhere, before the first of Newton is made
        run.newton.K = a.mass.K = self._zeros((3 * width + 1) * model.n_band)
        a.corner = self._zeros(a.mass.m * a.mass.m)
        a.rhs = self._zeros(unknowns + model.n_multipliers + FU_BAND_BEYOND(width))
        rows = n_joints + len(model.links)
        a.rows = <fu_rows *>self._zeros(rows * sizeof(fu_rows) // sizeof(double) + 1)
        a.slides = <fu_slide_state *>self._zeros(n_joints * sizeof(fu_slide_state) // sizeof(double) + 1)
        a.multipliers = self._zeros(model.n_multipliers)
        a.braking, a.jammed = self._zeros(3 * n_joints + 1), -1
        a.joints = self._doubles(np.zeros(n_joints * FU_JOINT_OUTPUTS))
        a.force, a.work = self._doubles(np.zeros(n_dof)), self._doubles(np.zeros(n_dof))
        a.prescribed = self._doubles(np.zeros(n_dof))
        run.rhs = self._zeros(unknowns + model.n_extra + FU_BAND_BEYOND(width))
        run.psi, run.force = self._doubles(np.zeros(n_dof)), self._doubles(np.zeros(n_dof))
        run.work, run.before = self._doubles(np.zeros(n_dof)), self._doubles(np.zeros(n_dof))
        run.first, run.s_slope = self._doubles(np.zeros(model.n_q)), self._doubles(np.zeros(n_joints))
        self._watch([])

    def _algorithmic(self, method):
        cdef int i
        a = &self.run.algorithmic
        a.lag, a.viscosity, a.inertia, a.weight = method.parameters
        if a.weight:
            self.model.n_memory = sum([self.cables[i].n_elements * (self.cables[i].law.rates + 1)
                                       for i in range(self.model.n_cables)])
        self.run.now.memory, self.run.next.memory = self._zeros(self.model.n_memory), self._zeros(self.model.n_memory)
        a.expected = self._zeros(self.model.n_memory)

    def held_strains(self):
        """Per cable (elements, rates + 1): g and the energy of r of algorithmic dissipation (engine/algorithmic.c)."""
        cdef const double[::1] memory = <double[:max(1, self.model.n_memory)]>self.run.now.memory
        numbers, ends = np.array(memory), np.cumsum([self.cables[i].n_elements * (self.cables[i].law.rates + 1)
                                                     for i in range(self.model.n_cables)])
        return [part.reshape(self.cables[i].n_elements, -1)
                for i, part in enumerate(np.split(numbers[:self.model.n_memory], ends[:-1]))]

    def without_algorithmic_force(self):
        """Numbers of the cables whose law has no kernel for algorithmic dissipation."""
        return [i for i in range(self.model.n_cables) if self.cables[i].law.algorithmic_force == NULL]

    def _tableau(self, method):
        t = &self.run.tableau
        t.stages = len(method.b)
        t.A, t.b, t.c = self._doubles(method.A), self._doubles(method.b), self._doubles(method.c)
        t.error, t.coarse = self._doubles(method.error), self._doubles(method.coarse)
        stage = self.model.n_q + self.model.n_dof
        self.run.scratch = self._zeros((t.stages + 2) * stage + 2 * (t.stages + 1))

    def _collocation(self, method):
        o, system = &self.run.collocation, &self.run.newton
        cdef int k
        for k in range(9):
            o.A[k], o.A_inverse[k] = method.A.flat[k], method.A_inverse.flat[k]
            o.T[k], o.T_inverse[k] = method.T.flat[k], method.T_inverse.flat[k]
        for k in range(3):
            o.c[k], o.error[k] = method.c[k], method.error[k]
        o.gamma, o.alpha, o.beta = method.gamma, method.alpha, method.beta
        n, m, rows = system.n, system.m, 3 * system.width + 1
        c = &self.run.complex_newton
        c.K, c.D, c.x = self._zeros(2 * rows * n), self._zeros(2 * m * m), self._zeros(2 * (n + m))
        c.B, c.C, c.X = self._zeros(2 * n * m), self._zeros(2 * n * m), self._zeros(2 * n * m)
        c.columns = <fu_piece *>self._ints(np.zeros(3 * 2 * m * system.n_chains))
        c.D_real, c.pivot_band, c.pivot_border = self._zeros(m * m), self._ints(np.zeros(n)), self._ints(np.zeros(m))
        self.run.scratch = self._zeros(12 * self.model.n_dof + 3 * self.model.n_q + 7 + n + m)

    cdef _matrix(self):
        """The unfactored Newton matrix, (unknowns, unknowns) sparse."""
        from scipy.sparse import coo_array

        cdef fu_system *system = &self.run.newton
        cdef int n = system.n, width = system.width, m = system.m
        band = np.asarray(<double[:n * (3 * width + 1)]>system.K).reshape(n, 3 * width + 1).copy() if n else np.zeros((0, 1))
        columns, diagonals = np.nonzero(band)
        entries = [(columns + diagonals - 2 * width, columns, band[columns, diagonals])]
        if m:
            corner = np.asarray(<double[:m * m]>system.D).reshape(m, m)
            rows, at = np.nonzero(corner.T)
            entries.append((n + rows, n + at, corner.T[rows, at]))
        if n and m:
            right = np.asarray(<double[:m * n]>system.B).reshape(m, n)
            below = np.asarray(<double[:m * n]>system.C).reshape(m, n)
            at, rows = np.nonzero(right)
            entries.append((rows, n + at, right[at, rows]))
            rows, at = np.nonzero(below)
            entries.append((n + rows, at, below[rows, at]))
        row, column, value = (np.concatenate(part) for part in zip(*entries))
        return coo_array((value, (row, column)), shape=(n + m, n + m)).tocsc()

    def linearise(self, double h, change):
        """Residual and Newton matrix of a step h after moving its prediction by `change`; for tests.

        change (unknowns,): psi of the free dofs, then s and the scaled force of each slide.
        Returns (unknowns,) and (unknowns, unknowns), d residual/d change.
        """
        cdef double[::1] moved = np.ascontiguousarray(change, dtype=float)
        cdef int i, total = self.run.newton.n + self.run.newton.m
        if moved.shape[0] != total:
            raise ValueError(f"change must have {total} entries")
        fu_linearise(&self.run, h, &moved[0])
        return -np.array([self.run.rhs[i] for i in range(total)]), self._matrix().toarray()

    def solve(self, right):
        """Solve with the matrix that `linearise` has left, once: (unknowns,) to (unknowns,); and whether the band was
        positive definite. For tests.

        Raises ArithmeticError where the matrix is singular.
        """
        cdef double[::1] given = np.ascontiguousarray(right, dtype=float)
        cdef int i, total = self.run.newton.n + self.run.newton.m
        if given.shape[0] != total:
            raise ValueError(f"right must have {total} entries")
        for i in range(total):
            self.run.rhs[i] = given[i]
        if fu_system_factor_band(&self.run.newton, &LAPACK) or fu_system_factor_border(&self.run.newton, &LAPACK):
            raise ArithmeticError("singular")
        fu_system_solve(&self.run.newton, &LAPACK, self.run.rhs)
        return np.array([self.run.rhs[i] for i in range(total)]), bool(self.run.newton.definite)

    # --- statics: `next` is the state, moved by unknowns ---------------------------------------------------------

    def place(self, double t=0.0, q=None, s=None, force=None, multipliers=None, spring=None):
        """Set the static state: time, configuration (n_q,), arc-lengths, forces of slides (n, 3), multipliers of joints
        (n, 6), forces of springs (n, 3); None: as built.

        Prescribed dofs take their values at t.
        """
        cdef fu_state *state = &self.run.next
        cdef int i
        state.t = t
        for i in range(self.model.n_dof):
            state.v[i] = state.acceleration[i] = 0.0
        for i in range(self.model.n_q):
            state.q[i] = self.run.now.q[i] if q is None else q[i]
        fu_prescribe(&self.model, state)
        for i in range(self.model.n_dof):
            state.v[i] = state.acceleration[i] = 0.0
        for i in range(self.model.n_joints):
            state.s[i] = self.run.now.s[i] if s is None else s[i]
            n, length = self.cables[self.joints[i].cable].n_elements, self.cables[self.joints[i].cable].length
            if not length * state.element[i] <= state.s[i] <= length * (state.element[i] + 1):
                state.element[i] = min(max(int(state.s[i] // length), 0), n - 1)
            for k in range(3):
                state.f[3 * i + k] = 0.0 if force is None else force[i][k]
        if self.model.n_brakes:
            fu_touch_buffers(&self.model, state)
        for i in range(self.model.n_links):
            for k in range(6):
                state.multipliers[6 * i + k] = 0.0 if multipliers is None else multipliers[i][k]
        for i in range(self.model.n_springs):
            for k in range(3):
                state.spring[3 * i + k] = 0.0 if spring is None else spring[i][k]

    def placed(self):
        """The static state as the arguments of `place` (but t)."""
        cdef fu_state *state = &self.run.next
        cdef int i, joints = self.model.n_joints, links = self.model.n_links, springs = self.model.n_springs
        return {"q": np.array([state.q[i] for i in range(self.model.n_q)]),
                "s": np.array([state.s[i] for i in range(joints)]),
                "force": np.array([state.f[i] for i in range(3 * joints)]).reshape(joints, 3),
                "multipliers": np.array([state.multipliers[i] for i in range(6 * links)]).reshape(links, 6),
                "spring": np.array([state.spring[i] for i in range(3 * springs)]).reshape(springs, 3)}

    def move(self, change):
        """Move the static state by unknowns (n,): coordinates and rotations, s, forces."""
        cdef double[::1] moved = np.ascontiguousarray(change, dtype=float)
        if moved.shape[0] != self.run.newton.n + self.run.newton.m:
            raise ValueError(f"change must have {self.run.newton.n + self.run.newton.m} entries")
        fu_static_move(&self.run, &moved[0])

    def static_residual(self):
        """(n,): left side of equilibrium over the unknowns: internal minus external forces; constraints."""
        cdef int i
        fu_static_residual(&self.run)
        return -np.array([self.run.rhs[i] for i in range(self.run.newton.n + self.run.newton.m)])

    def reaction(self):
        """(n_dof,): after `static_residual`, what supports give to each dof, the residual where it is free."""
        cdef int i
        return np.array([self.run.force[i] for i in range(self.model.n_dof)])

    def matrix(self, double inertia, double rate, double stiffness):
        """inertia M + stiffness (K + rate D) at the static state, (n, n) sparse; constraints where stiffness is not 0."""
        cdef fu_weights weights
        weights.inertia, weights.rate, weights.stiffness = inertia, rate, stiffness
        fu_matrix(&self.run, weights)
        return self._matrix() + stiffness * self._between_cables() if stiffness and self.model.n_links else self._matrix()

    def _between_cables(self):
        """(n, n) sparse: what joints between two cables add to the stiffness and Newton in time does without."""
        from scipy.sparse import coo_array, csr_array

        cdef int[::1] at = np.zeros(2 * FU_END_COORDINATES, dtype=np.intc)
        cdef double[::1] J = np.zeros(6 * 2 * FU_END_COORDINATES), K = np.zeros(4 * FU_END_COORDINATES ** 2)
        cdef int k, i, n, first, n_dof = self.model.n_dof, total = self.run.newton.n + self.run.newton.m
        whole = n_dof + self.model.n_extra
        stiffness = csr_array((whole, whole))
        for k in range(self.model.n_links):
            if not fu_between_cables(&self.links[k]):
                continue
            first = fu_end_coordinates(&self.model, &self.links[k].ends[0], &self.run.next, &at[0])
            n = fu_link_tangent(&self.model, &self.links[k], &self.run.next, &at[0], &J[0], &K[0])
            block = np.array(K[:n * n]).reshape(n, n)
            block[:first, :first] = block[first:, first:] = 0
            places = np.array([at[i] for i in range(n)])
            for i in range(n):  # an s that is held has no equilibrium of its own
                if places[i] >= n_dof and self._is_held(places[i] - n_dof):
                    block[i] = block[:, i] = 0
            rows, columns = np.repeat(places, n), np.tile(places, n)
            stiffness = stiffness + coo_array((block.ravel(), (rows, columns)), shape=(whole, whole)).tocsr()
        if not stiffness.nnz:
            return csr_array((total, total))
        if self.spreads is None:
            unit = [self.spread(x) for x in np.eye(total)[:total - self.model.n_extra]]
            dofs = np.array(unit).reshape(-1, n_dof).T
            self.spreads = csr_array(np.block([[dofs, np.zeros((n_dof, self.model.n_extra))],
                                               [np.zeros((self.model.n_extra, dofs.shape[1])), np.eye(self.model.n_extra)]]))
        return self.spreads.T @ stiffness @ self.spreads

    def _is_held(self, int extra):
        return any([self.joints[j].unknown == extra and self.run.next.mode[j] != FU_SLIDES
                    for j in range(self.model.n_joints)])

    def elastic_energy(self):
        """J, of the static state."""
        cdef double buffers = fu_brake_energy(&self.model, &self.run.next) if self.model.n_brakes else 0.0
        return fu_elastic_energy(&self.model, self.run.next.q) + buffers

    def spread(self, unknowns):
        """(n_dof,): what unknowns move the dofs by."""
        cdef double[::1] x = np.ascontiguousarray(unknowns, dtype=float)
        cdef double[::1] dofs = np.zeros(max(1, self.model.n_dof))
        fu_spread(&self.model, &x[0], &dofs[0])
        return np.asarray(dofs)[:self.model.n_dof]

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
        kinds = {"q": FU_WATCH_Q, "v": FU_WATCH_V, "s": FU_WATCH_S, "function": FU_WATCH_CALL}
        numbers = [(kinds[watch.kind], watch.index, watch.direction, watch.value) for watch in watches]
        cdef int i, k, side
        for i in range(self.model.n_joints):
            j = &self.joints[i]
            if j.drive < 0 and (j.sticks or FU_END_IS_HARD in (j.stops[0].kind, j.stops[1].kind)):
                numbers.append((FU_WATCH_GRIP, i, 1, 0.0))
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

    cdef _snapshot(self, const fu_state *state):
        """t, q, v, s of a state."""
        m = &self.model
        return (state.t, np.array([state.q[i] for i in range(m.n_q)]), np.array([state.v[i] for i in range(m.n_dof)]),
                np.array([state.s[i] for i in range(m.n_joints)]))

    def start(self, *, duration, output_step, tol, step, method, first_step, room=None, rest_start=False):
        """Allocate output rows, `room` of them or all, and compute the consistent start; method: see integrators.py.

        Returns a status where that failed, else None, and the change of velocities that the joints asked for.
        """
        run = &self.run
        run.duration, run.output_step, run.tol = duration, output_step, tol
        run.fixed_step, run.h, run.rest_start = step, first_step, rest_start
        run.order, run.slack, run.caution = method.order, method.slack, method.caution
        if method.name == "explicit":
            run.integrator = &fu_explicit_method
            self._tableau(method)
        elif method.name == "radau":
            run.integrator = &fu_radau_method
            self._collocation(method)
        elif method.name == "energy":
            run.integrator = &fu_energy_method
            run.scratch = self._zeros(self.model.n_q + 2 * self.model.n_dof)
            self._algorithmic(method)
        else:
            run.integrator = &fu_genalpha_method
            run.scheme.alpha_m, run.scheme.alpha_f, run.scheme.beta, run.scheme.gamma = method.parameters
        rows = int(np.ceil(duration / output_step * (1 - 1e-12))) + 2 if room is None else room
        m = &self.model
        r = &run.record
        r.time, r.kinetic, r.elastic = self._named("time", rows), self._named("kinetic", rows), self._named("elastic", rows)
        r.potential, r.dissipated = self._named("potential", rows), self._named("dissipated", rows)
        r.q, r.v = self._named("q", (rows, m.n_q)), self._named("v", (rows, m.n_dof))
        r.acceleration = self._named("acceleration", (rows, m.n_dof))
        r.reaction, r.external = self._named("reaction", (rows, m.n_dof)), self._named("external", rows)
        r.spring = self._named("spring", (rows, m.n_springs, 3))
        r.s, r.joint = self._named("s", (rows, m.n_joints)), self._named("joint", (rows, m.n_joints, FU_JOINT_OUTPUTS))
        r.link = self._named("link", (rows, m.n_links, FU_LINK_OUTPUTS))
        cdef int status = fu_start(run)
        if status:
            return STATUS[status], np.zeros(m.n_dof)
        return None, np.array([run.before[i] for i in range(m.n_dof)])

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
                        self.watcher.acts(run.event.which, ACTIONS[run.event.side], run.now.t, run.now.s[run.event.which])
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

    def restore(self, bytes checkpoint):
        """Go on from a checkpoint; after `start` with the same arguments."""
        if len(checkpoint) != fu_save(&self.run, NULL):
            raise ValueError("the checkpoint is of another model")
        fu_restore(&self.run, checkpoint)

    @property
    def n_rows(self):
        """Number of output rows since the start."""
        return self.run.record.n

    def joint_row(self, joints):
        """Split joint numbers (..., FU_JOINT_OUTPUTS) by name; see fu_joint_output."""
        sizes = (1, 1, 3, 2, 1, 3)
        ends = np.cumsum(sizes)
        return {name: joints[..., end - size:end] if size > 1 else joints[..., end - 1]
                for name, size, end in zip(JOINT_OUTPUTS, sizes, ends)}

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
        """(slides + joints,): what each takes of a step, in seconds, timed by itself in less than 1 ms; see costs.c."""
        cdef double[::1] seconds = np.zeros(self.model.n_joints + self.model.n_links + 1)
        fu_costs(&self.run, &seconds[0])
        return np.asarray(seconds)[:-1]

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
        """Of the last step that failed: why (see CAUSES), and the dof and joint (or None) where that shows most."""
        f = self.run.failure
        return CAUSES[f.cause], f.dof, f.joint if f.joint >= 0 else None

    @property
    def jammed(self):
        """Index of the slide whose friction has no solution, -1."""
        return self.run.accelerator.jammed

    @property
    def books(self):
        """Energy that has come from nowhere, that went there, and that was exchanged or in motion, J."""
        b = self.run.books
        return b.grown, b.lost, b.exchanged

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

    def idle(self, rows):
        """Let no multiplier stand for these rows of joints, (link, row) each, which others imply."""
        for link, row in rows:
            self.links[link].idle |= 1 << row

    def wander(self, along):
        """What is left of the joints' equations, (links, 6), after a small way `along` (n_dof,) the freedom that they
        leave; None where no way leads back onto them. See fu_wander.
        """
        cdef double[::1] way = np.ascontiguousarray(along, dtype=float)
        cdef double[::1] left = np.zeros(6 * self.model.n_links + 1)
        if fu_wander(&self.run, &way[0], &left[0]):
            return None
        return np.asarray(left)[:6 * self.model.n_links].reshape(-1, 6)

    def held(self):
        """(links, FU_LINK_OUTPUTS): force and moment of joints on their second ends, and residual, in the static state."""
        cdef int k, r
        cdef double[::1] out = np.zeros(FU_LINK_OUTPUTS * self.model.n_links + 1)
        for k in range(self.model.n_links):
            for r in range(self.links[k].kernel.rows):
                self.run.accelerator.multipliers[self.links[k].multiplier + r] = self.run.next.multipliers[6 * k + r]
        fu_link_outputs(&self.model, &self.run.next, &self.run.accelerator, <fu_link_output *>&out[0])
        return np.asarray(out)[:FU_LINK_OUTPUTS * self.model.n_links].reshape(-1, FU_LINK_OUTPUTS)

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
    def stopped_joint(self):
        """Index of the slide that ran off its cable."""
        return self.run.stopped_joint

    @property
    def stopped_s(self):
        """Arc-length of that slide, m."""
        return self.run.now.s[self.run.stopped_joint]
