# A model as the engine's C structures.

cdef class Translation(Arrays):
    """Bodies, cables, slides, joints, springs, loads and motions of a model, and the work space of a run of it."""

    cdef fu_cable *cables
    cdef fu_body *bodies
    cdef fu_shape *shapes
    cdef fu_slide *slides
    cdef fu_joint *joints
    cdef fu_point_force *point_forces
    cdef fu_motion *motions
    cdef fu_dead_load *dead_loads
    cdef fu_load *loads
    cdef fu_signal *signals
    cdef fu_knot *knots
    cdef fu_coupling **couplings
    cdef fu_watch *watches
    cdef fu_model model
    cdef fu_run run

    def __cinit__(self, model, blocks=True):
        self.cables = <fu_cable *>PyMem_Calloc(len(model.cables) + 1, sizeof(fu_cable))
        self.bodies = <fu_body *>PyMem_Calloc(len(model.bodies) + 1, sizeof(fu_body))
        self.shapes = <fu_shape *>PyMem_Calloc(len(model.bodies) + 1, sizeof(fu_shape))
        self.slides = <fu_slide *>PyMem_Calloc(len(model.slides) + 1, sizeof(fu_slide))
        self.joints = <fu_joint *>PyMem_Calloc(len(model.joints) + 1, sizeof(fu_joint))
        self.point_forces = <fu_point_force *>PyMem_Calloc(len(model.point_forces) + 1, sizeof(fu_point_force))
        self.motions = <fu_motion *>PyMem_Calloc(len(model.motions) + 1, sizeof(fu_motion))
        self.dead_loads = <fu_dead_load *>PyMem_Calloc(len(model.dead_loads) + 1, sizeof(fu_dead_load))
        self.loads = <fu_load *>PyMem_Calloc(len(model.loads) + 1, sizeof(fu_load))
        self.signals = <fu_signal *>PyMem_Calloc(len(model.signals) + 1, sizeof(fu_signal))
        n_couplings = len(model.loads) + len(model.slides) + len(model.joints) + len(model.point_forces)
        self.couplings = <fu_coupling **>PyMem_Calloc(n_couplings + 1, sizeof(fu_coupling *))
        if not (self.cables and self.bodies and self.shapes and self.slides and self.joints and self.point_forces
                and self.motions and self.dead_loads and self.loads and self.signals and self.couplings):
            raise MemoryError

    def __dealloc__(self):
        for pointer in (<size_t>self.cables, <size_t>self.bodies, <size_t>self.shapes, <size_t>self.slides,
                        <size_t>self.joints, <size_t>self.point_forces, <size_t>self.motions, <size_t>self.dead_loads,
                        <size_t>self.loads, <size_t>self.signals, <size_t>self.knots, <size_t>self.couplings,
                        <size_t>self.watches):
            PyMem_Free(<void *><size_t>pointer)

    def __init__(self, model, blocks=True):
        tables = [<size_t>TABLES, *model.tables]
        self._bodies_and_cables(model, tables, blocks)
        m = &self.model
        m.dim, m.n_q, m.n_dof = model.dim, model.n_q, model.n_dof
        self._slides_joints_and_point_forces(model, tables)
        self._loads_and_motions(model)
        self._list_couplings(model)
        m.n_band, m.n_border_dof = model.n_band, model.n_border_dof
        m.n_extra, m.n_multipliers = model.n_extra, model.n_multipliers
        m.unknown_of_dof, m.weight, m.lapack = self._ints(model.unknown_of_dof), self._doubles(model.weight), &LAPACK
        m.combination_start = self._ints(model.combinations.indptr)
        m.combination_unknown = self._ints(model.combinations.indices)
        m.combination_value = self._doubles(model.combinations.data)
        m.threads, m.parts = 1, NULL
        m.gravity, m.zero = self._doubles(model.gravity), self._doubles(np.zeros(model.n_dof))
        self._work_space(model)

    def _bodies_and_cables(self, model, list tables, blocks):
        cdef int i, k, numbers = 0
        for i, cable in enumerate(model.cables):
            c = &self.cables[i]
            c.kernel = <const fu_element_kernels *>_found(tables, "element", cable.element)
            c.law = <const fu_law_kernels *>_found(tables, "law", f"{cable.element}_{cable.law}")
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
            c.dissipation_state, numbers = numbers, numbers + c.n_elements * (c.law.rates + 1)
        for i, body in enumerate(model.bodies):
            r = &self.bodies[i]
            r.kernel = <const fu_body_kernels *>_found(tables, "body", body.kernel)
            r.configuration, r.dof, r.mass = body.configuration, body.dof, body.mass
            r.matter, r.modes, r.shape = &fu_rigid_matter, 0, NULL
            for k in range(9):
                r.J[k] = body.inertia.flat[k]
            if body.shape is not None:
                self._shape(r, &self.shapes[i], body, tables)
        self.model.n_cables, self.model.n_bodies = len(model.cables), len(model.bodies)
        self.model.cables, self.model.bodies = self.cables, self.bodies

    cdef int _shape(self, fu_body *r, fu_shape *h, body, list tables) except -1:
        shape, n = body.shape, body.modes
        cdef int k
        r.matter, r.modes, r.shape = &fu_modal_matter, n, h
        h.kernel = <const fu_modal_kernels *>_found(tables, "modal", body.modal_kernel)
        h.S, h.X = self._doubles(shape.S), self._doubles(shape.X)
        h.mass = self._doubles(np.einsum("klii->kl", shape.X)[1:, 1:])
        h.stiffness, h.damping = self._doubles(shape.stiffness), self._doubles(shape.damping)
        dofs = r.kernel.velocity + n
        h.zero, h.matrices = self._doubles(np.zeros(dofs)), self._doubles(np.zeros(3 * dofs * dofs))
        h.sums = self._doubles(np.zeros(3 * (n + 1) * r.kernel.dim * r.kernel.dim))
        for k in range(len(shape.gravity)):
            h.g[k] = shape.gravity[k]
        return 0

    def modal_attachment(self, int index, x, phi, psi, b, w, f, m):
        """A point of modal body `index` with its axes, as engine/bodies/modal.c has it; for tests.

        x (dim,), phi (modes, dim), psi (modes, turns); b, w: the body's entries of q and v. Returns what `fu_modal_point`
        holds, P, T, and K for a force f and a moment m on the point.
        """
        cdef fu_body *r = &self.bodies[index]
        cdef fu_modal_attachment modal
        cdef fu_modal_point out
        cdef int n = fu_body_dofs(r), dim = r.kernel.dim, turns = r.kernel.velocity - r.kernel.dim
        modal.x, modal.phi, modal.psi = self._doubles(x), self._doubles(phi), self._doubles(psi)
        P, T, K = np.zeros((dim, n)), np.zeros((turns, n)), np.zeros((n, n))
        cdef double[:, ::1] P_view = P, T_view = T, K_view = K
        fu_modal_attachment_state(r, &modal, self._doubles(b), self._doubles(w), &out, &P_view[0, 0], &T_view[0, 0])
        fu_modal_attachment_force(r, &modal, self._doubles(b), self._doubles(f), self._doubles(m), &K_view[0, 0])
        return {"p": np.array(out.p)[:dim], "axes": np.array(out.axes)[:dim * dim].reshape(dim, dim), "P": P, "T": T, "K": K,
                "velocity": np.array(out.velocity)[:dim], "omega": np.array(out.omega)[:turns],
                "bias": np.array(out.bias)[:dim], "omega_bias": np.array(out.omega_bias)[:turns]}

    cdef int _modal_attachment(self, fu_modal_attachment *to, int body, modal) except -1:
        to.x, to.phi, to.psi = self._doubles(modal[0]), self._doubles(modal[1]), self._doubles(modal[2])
        if fu_body_dofs(&self.bodies[body]) > FU_ATTACHMENT_COORDINATES:
            raise ValueError(f"more modes than the engine's {FU_ATTACHMENT_COORDINATES - 6}")
        return 0

    cdef int _end(self, fu_attachment *to, end, list tables) except -1:
        cdef int k
        to.cable, to.body, to.element, to.slide = end.cable, end.body, end.element, end.slide
        to.frame = NULL
        for k in range(len(end.u)):
            to.u[k] = end.u[k]
        for k in range(len(end.N)):
            to.N[k] = end.N[k]
        if end.modal is not None:
            self._modal_attachment(&to.modal, end.body, end.modal)
        if end.axes is None:
            return 0
        if end.frame:
            to.frame = <const fu_frame_kernels *>_found(tables, "frame", end.frame)
        for k in range(2):
            to.slopes[k] = end.slopes[k]
        for k in range(3):
            to.up[k] = end.up[k]
        for k in range(end.S.size):
            to.S[k] = end.S.flat[k]
        for k in range(end.axes.size):
            to.axes[k] = end.axes.flat[k]
        return 0

    cdef int _coupling(self, fu_coupling *base, str type, int index, int unknown, scale) except -1:
        """Fill in what all couplings have; own forces are one a row of `scale`."""
        cdef int k
        base.type = fu_coupling_type_of(type.encode())
        if base.type == NULL:
            raise ValueError(f"the engine has no coupling {type!r}")
        base.index, base.unknown, base.n_forces = index, unknown, len(scale)
        for k in range(len(scale)):
            base.scale[k] = scale[k]
        return 0

    def _list_couplings(self, model):
        """The list that the engine loops over: contributions are added up in its order."""
        cdef int i, n = 0
        for i in range(len(model.loads)):
            self.couplings[n], n = &self.loads[i].base, n + 1
        for i in range(len(model.slides)):
            self.couplings[n], n = &self.slides[i].base, n + 1
        for i in range(len(model.joints)):
            self.couplings[n], n = &self.joints[i].base, n + 1
        for i in range(len(model.point_forces)):
            self.couplings[n], n = &self.point_forces[i].base, n + 1
        fu_number_couplings(self.couplings, n, &self.model)

    def _slides_joints_and_point_forces(self, model, list tables):
        cdef int i, k
        for i, slide in enumerate(model.slides):
            j = &self.slides[i]
            j.kernel = <const fu_slide_kernels *>_found(tables, "slide", slide.kernel)
            if j.kernel.coordinates + 1 > FU_MAX_COORDINATES:
                raise ValueError(f"{slide.kernel}: more coordinates than the engine's {FU_MAX_COORDINATES}")
            self._coupling(&j.base, "slide", i, slide.unknown, [slide.mass] * model.dim)
            j.base.n_coordinates, j.base.multiplier, j.base.n_multipliers = 1, slide.multiplier, slide.n_multipliers
            for k in range(model.dim, slide.n_multipliers):
                j.base.scale[k] = slide.mass
            j.cable, j.rider_is_rigid, j.drive = slide.cable, slide.rider_is_rigid, slide.drive
            j.carries_director = slide.carries_director
            self._end(&j.rider, slide.rider, tables)
            j.resistance = <const fu_resistance_kernels *>_found(tables, "resistance", slide.resistance) if slide.resistance else NULL
            j.base.reacts = j.base.is_damped = bool(slide.resistance)
            j.base.is_driven = slide.drive >= 0
            j.velocity = 1.0  # of no friction
            if slide.friction is not None:
                j.sticks, j.viscous, j.velocity = slide.friction.sticks, slide.friction.viscous, slide.friction.velocity
                j.friction, j.static_friction = slide.friction.sliding, slide.friction.static_friction
            for k, end in enumerate(slide.end_stops):
                e = &j.stops[k]
                e.kind = ENDS[end if isinstance(end, str) else end.stop]
                if e.kind == FU_END_IS_HARD:
                    e.restitution = end.restitution
                if e.kind == FU_END_IS_BUFFERED:
                    e.length, e.stiffness, e.damping = end.length, end.stiffness, end.damping
        for i, joint in enumerate(model.joints):
            l = &self.joints[i]
            l.kernel = <const fu_joint_kernels *>_found(tables, "joint", joint.kernel)
            self._coupling(&l.base, "joint", i, joint.unknown, joint.scale)
            l.base.multiplier, l.base.n_multipliers, l.base.is_driven = joint.multiplier, joint.rows, joint.signal >= 0
            l.signal, l.c0 = joint.signal, joint.base
            for k in range(2):
                self._end(&l.attachments[k], joint.attachments[k], tables)
        for i, force in enumerate(model.point_forces):
            p = &self.point_forces[i]
            self._coupling(&p.base, force.type, i, force.unknown, [force.mass] * force.dim)
            p.kernels = _found(tables, force.type, force.kernel) if force.kernel else NULL
            p.base.is_damped, p.dim = force.is_damped, force.dim
            if len(force.parameters) > FU_MAX_PARAMETERS:
                raise ValueError(f"{force.type}: more parameters than the engine's {FU_MAX_PARAMETERS}")
            for k in range(len(force.parameters)):
                p.parameters[k] = force.parameters[k]
            for k in range(2):
                self._end(&p.attachments[k], force.attachments[k], tables)
        self.model.n_slides, self.model.slides = len(model.slides), self.slides

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
            self._coupling(&n.base, "load", i, 0, ())
            n.kind, n.signal, n.on, n.element, n.x = load.kind, load.signal, load.on, load.element, load.x
            for k in range(3):
                n.u[k], n.c[k] = load.u[k], load.c[k]
            if load.modal is not None:
                self._modal_attachment(&n.modal, load.on, load.modal)
        m = &self.model
        m.n_motions, m.n_dead_loads = len(model.motions), len(model.dead_loads)
        m.motions, m.dead_loads, m.signals = self.motions, self.dead_loads, self.signals

    cdef void _system(self, fu_system *system, model, int width, int m):
        cdef int n = model.n_band, chains = len(model.chains) - 1
        system.n, system.width, system.m, system.n_chains = n, width, m, chains
        system.chains = self._ints(model.chains)
        middles = (model.chains[:-1] + model.chains[1:]) // 2
        system.half = self._ints(np.searchsorted(np.sort([*model.chains[:-1], *middles]), np.arange(n), "right") - 1)
        system.D, system.L = self._zeros(<double>m * m), self._zeros((width + 1.0) * (n + FU_BAND_GROUP * chains))
        system.B, system.C = self._zeros(<double>n * m), self._zeros(<double>n * m)
        system.X = self._zeros(<double>FU_BAND_LENGTH(n, width) * m)
        system.span_B = <fu_span *>self._ints(np.zeros(2 * 2 * m * chains))
        system.span_C = <fu_span *>self._ints(np.zeros(2 * 2 * m * chains))
        system.columns = <fu_piece *>self._ints(np.zeros(3 * 2 * m * chains))
        system.rows = <fu_piece *>self._ints(np.zeros(3 * 2 * m * chains))
        system.pivot_band, system.pivot_border = self._ints(np.zeros(n)), self._ints(np.zeros(m))

    cdef _state(self, fu_state *state, model):
        """Give a state its arrays (state.h), and in them the model as it is drawn."""
        drawn = {"q": model.q, "v": model.v, "s": [slide.s for slide in model.slides],
                 "element": [slide.element for slide in model.slides],
                 "mode": [FU_LOCKED if slide.drive >= 0 else FU_SLIDES for slide in model.slides],
                 "director": np.ravel([slide.director for slide in model.slides])}
        cdef int k
        for k in range(FU_N_STATE_ARRAYS):
            self._attach(state, k)
        for name, values in drawn.items():
            self._view(state, name)[:] = values

    cdef int _attach(self, fu_state *state, int k) except -1:
        """Give a state its k-th array, of zeros."""
        cdef fu_array array = fu_state_array(&self.model, state, k)
        if array.is_real:
            fu_state_attach(state, k, self._zeros(array.items))
        else:
            fu_state_attach(state, k, self._ints(np.zeros(array.items)))
        return 0

    cdef _view(self, const fu_state *state, str name):
        """Return an array of a state by its name in state.h; what is written to it is written to the state."""
        cdef int k
        cdef fu_array array
        for k in range(FU_N_STATE_ARRAYS):
            array = fu_state_array(&self.model, state, k)
            if array.name == name.encode():
                if array.items == 0:
                    return np.zeros(0)
                if array.is_real:
                    return np.asarray(<double[:array.items]><double *>array.data)
                return np.asarray(<int[:array.items]><int *>array.data)
        raise KeyError(name)

    def _work_space(self, model):
        n_slides, n_dof = len(model.slides), model.n_dof
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
        run.newton.K = a.mass.K = self._zeros((3.0 * width + 1) * model.n_band)
        a.corner = self._zeros(<double>a.mass.m * a.mass.m)
        a.rhs = self._zeros(unknowns + model.n_multipliers + FU_BAND_BEYOND(width))
        a.rows = <fu_rows *>self._zeros(self.model.n_rows * sizeof(fu_rows) // sizeof(double) + 1)
        a.slide_states = <fu_slide_state *>self._zeros(n_slides * sizeof(fu_slide_state) // sizeof(double) + 1)
        a.multipliers = self._zeros(model.n_multipliers)
        a.self_locking = -1
        a.force, a.work = self._doubles(np.zeros(n_dof)), self._doubles(np.zeros(n_dof))
        a.prescribed = self._doubles(np.zeros(n_dof))
        run.rhs = self._zeros(unknowns + model.n_extra + FU_BAND_BEYOND(width))
        run.psi, run.force = self._doubles(np.zeros(n_dof)), self._doubles(np.zeros(n_dof))
        run.work, run.before = self._doubles(np.zeros(n_dof)), self._doubles(np.zeros(n_dof))
        run.first, run.s_slope = self._doubles(np.zeros(model.n_q)), self._zeros(self.model.n_coordinates)
        self._watch([])
