# From a model to the C structures of the engine.

cdef int INVERSE_SIZE_FACTOR = 4  # unknowns over width of a band: longer bands are solved faster than multiplied by an inverse

cdef const fu_coupling_type *_type_of(coupling) except NULL:
    """Return the engine's type of a coupling of a model."""
    type = fu_coupling_type_of(coupling.type.encode())
    if type == NULL:
        raise ValueError(f"the engine has no coupling {coupling.type!r}")
    return type


cdef class Translation(Arrays):
    """Bodies, cables, slides, joints, springs, loads and motions of a model, and the work space of a run of it."""

    cdef fu_cable *cables
    cdef fu_body *bodies
    cdef fu_shape *shapes
    cdef fu_motion *motions
    cdef fu_signal *signals
    cdef fu_breakpoint *breakpoints
    cdef fu_coupling **couplings  # in the order of the engine's sums
    cdef char *coupling_memory  # their structures, one behind the other
    cdef readonly bint needs_lapack
    cdef fu_event_function *event_functions
    cdef fu_model model
    cdef fu_run run
    cdef fu_fronts newton_fronts, mass_fronts
    cdef object newton_elimination
    cdef dict static_forces  # by kind of coupling: largest number of internal forces in static states
    cdef dict numbers  # of the couplings of each kind
    cdef dict kernels  # role and name of the tables of kernels that the structures point to, by address

    def __cinit__(self, model, blocks=True):
        self.kernels = {}
        self.cables = <fu_cable *>PyMem_Calloc(len(model.cables) + 1, sizeof(fu_cable))
        self.bodies = <fu_body *>PyMem_Calloc(len(model.bodies) + 1, sizeof(fu_body))
        self.shapes = <fu_shape *>PyMem_Calloc(len(model.bodies) + 1, sizeof(fu_shape))
        self.motions = <fu_motion *>PyMem_Calloc(len(model.motions) + 1, sizeof(fu_motion))
        self.signals = <fu_signal *>PyMem_Calloc(len(model.signals) + 1, sizeof(fu_signal))
        self.couplings = <fu_coupling **>PyMem_Calloc(len(model.couplings) + 1, sizeof(fu_coupling *))
        coupling_bytes = sum([_type_of(c).size for c in model.couplings])
        self.coupling_memory = <char *>PyMem_Calloc(1, 1 + coupling_bytes)
        if not (self.cables and self.bodies and self.shapes and self.motions and self.signals and self.couplings
                and self.coupling_memory):
            raise MemoryError
        self.blocks += [(<size_t>self.cables, (len(model.cables) + 1) * sizeof(fu_cable)),
                        (<size_t>self.bodies, (len(model.bodies) + 1) * sizeof(fu_body)),
                        (<size_t>self.shapes, (len(model.bodies) + 1) * sizeof(fu_shape)),
                        (<size_t>self.motions, (len(model.motions) + 1) * sizeof(fu_motion)),
                        (<size_t>self.signals, (len(model.signals) + 1) * sizeof(fu_signal)),
                        (<size_t>self.couplings, (len(model.couplings) + 1) * sizeof(fu_coupling *)),
                        (<size_t>self.coupling_memory, coupling_bytes)]

    def __dealloc__(self):
        fu_threads_end(self.model.threads)
        PyMem_Free(self.model.threads)
        for pointer in (<size_t>self.cables, <size_t>self.bodies, <size_t>self.shapes, <size_t>self.motions,
                        <size_t>self.signals, <size_t>self.breakpoints, <size_t>self.couplings,
                        <size_t>self.coupling_memory, <size_t>self.event_functions):
            PyMem_Free(<void *><size_t>pointer)

    def __init__(self, model, blocks=True):
        tables = [_own_tables(), *model.tables]
        self._bodies_and_cables(model, tables, blocks)
        m = &self.model
        m.dim, m.n_q, m.n_dof = model.dim, model.n_q, model.n_dof
        self._signals_and_motions(model)
        self._couplings(model, tables)
        m.n_band, m.n_border_dof = model.n_band, model.n_border_dof
        m.n_extra, m.n_multipliers = model.n_extra, model.n_multipliers
        m.unknown_of_dof, m.weight, m.lapack = self._ints(model.unknown_of_dof), self._doubles(model.weight), &LAPACK
        self.run.controlled = self.run.counted = m.weight
        m.combination_start = self._ints(model.combinations.start)
        m.combination_unknown = self._ints(model.combinations.unknown)
        m.combination_value = self._doubles(model.combinations.value)
        m.threads = NULL
        m.gravity, m.zero = self._doubles(model.gravity), self._zeros(model.n_dof)
        self._work_space(model)

    cdef const void *_found(self, list tables, str role, str name) except NULL:
        """Return the kernels of a role by name, from the first of the tables (addresses) with them."""
        cdef const void *entry
        for address in tables:
            entry = fu_find(<const fu_tables *><size_t>address, role.encode(), name.encode())
            if entry != NULL:
                self.kernels[<size_t>entry] = role, name
                return entry
        raise ValueError(f"no kernels for the {role} {name}")

    def _bodies_and_cables(self, model, list tables, blocks):
        cdef int i, k, numbers = 0
        for i, cable in enumerate(model.cables):
            c = &self.cables[i]
            c.kernel = <const fu_element_kernels *>self._found(tables, "element", cable.element)
            c.law = <const fu_law_kernels *>self._found(tables, "law", f"{cable.element}_{cable.law}")
            c.blocks = fu_blocks_of(c.law.name) if blocks and cable.library is None else NULL
            mesh = cable.mesh
            c.n_elements, c.first, c.length = mesh.n_elements, cable.first, mesh.mean
            c.lengths, c.l_stride = self._doubles(mesh.lengths), 0 if mesh.is_even else 1
            c.nodes = NULL if mesh.is_even else self._doubles(mesh.boundaries)
            c.share = NULL if cable.share is None else self._doubles(cable.share)
            c.tension_only = cable.gives_way
            c.growth, c.orders = cable.growth, self._ints(cable.orders)
            c.growth_constants = NULL if cable.growth_constants is None else self._doubles(cable.growth_constants)
            c.growth_series, c.A_size, c.terms = NULL, cable.A.shape[1], 0
            if cable.growth_series is not None:
                if c.A_size > FU_MAX_CONSTANTS:
                    raise ValueError(f"{cable.element}: more constants than the engine's {FU_MAX_CONSTANTS}")
                c.growth_series = self._doubles(cable.growth_series)
                c.terms = (cable.growth_series.shape[1] - FU_SERIES_HEAD) // c.A_size
            c.grows = c.growth_constants != NULL or c.growth_series != NULL
            c.per_node, c.n_nodes = c.kernel.vectors * c.kernel.dim, mesh.n_nodes
            self._pieces(c, cable)
            c.coordinates = c.kernel.nodes * c.per_node
            if c.coordinates > FU_MAX_COORDINATES:
                raise ValueError(f"{cable.element}: more coordinates than the engine's {FU_MAX_COORDINATES}")
            c.m, c.A = self._doubles(cable.m), self._doubles(cable.A)
            c.A_stride = cable.A.shape[1] if len(cable.A) > 1 else 0
            c.m_stride = cable.m[0].size if len(cable.m) > 1 else 0
            if c.law.rates > FU_MAX_RATES:
                raise ValueError(f"{cable.element}: more rates of strain than the engine's {FU_MAX_RATES}")
            c.dissipation_state, numbers = numbers, numbers + c.n_elements * (c.law.rates + 1)
        for i, body in enumerate(model.bodies):
            r = &self.bodies[i]
            r.kernel = <const fu_body_kernels *>self._found(tables, "body", body.kernel)
            r.configuration, r.dof, r.mass = body.configuration, body.dof, body.mass
            r.matter, r.modes, r.shape = &fu_rigid_matter, 0, NULL
            for k in range(9):
                r.J[k] = body.inertia.flat[k]
            if body.shape is not None:
                self._shape(r, &self.shapes[i], body, tables)
        self.model.n_cables, self.model.n_bodies = len(model.cables), len(model.bodies)
        self.model.cables, self.model.bodies = self.cables, self.bodies

    cdef int _pieces(self, fu_cable *c, cable) except -1:
        cdef fu_cable_piece *pieces = <fu_cable_piece *>self._memory(len(cable.pieces) * sizeof(fu_cable_piece))
        cdef int k
        for k, piece in enumerate(cable.pieces):
            pieces[k].end, pieces[k].first = piece.end, c.first + piece.doubled * c.per_node
            pieces[k].tau, pieces[k].mass_damping, pieces[k].growth = piece.tau, piece.mass_damping, piece.growth
        c.pieces, c.tau, c.mass_damping = pieces, cable.tau, cable.mass_damping
        return 0

    cdef int _shape(self, fu_body *r, fu_shape *h, body, list tables) except -1:
        shape, n = body.shape, body.modes
        cdef int k
        r.matter, r.modes, r.shape = &fu_modal_matter, n, h
        h.kernel = <const fu_modal_kernels *>self._found(tables, "modal", body.modal_kernel)
        h.S, h.X = self._doubles(shape.S), self._doubles(shape.X)
        h.mass = self._doubles(np.einsum("klii->kl", shape.X)[1:, 1:])
        h.stiffness, h.damping = self._doubles(shape.stiffness), self._doubles(shape.damping)
        dofs = r.kernel.velocity + n
        h.zero, h.matrices = self._zeros(dofs), self._zeros(3 * dofs * dofs)
        h.sums = self._zeros(3 * (n + 1) * r.kernel.dim * r.kernel.dim)
        for k in range(len(shape.gravity)):
            h.g[k] = shape.gravity[k]
        return 0

    def modal_attachment(self, int index, x, phi, psi, b, w, f, m):
        """Evaluate a point of modal body `index` with its axes (engine/bodies/modal.c); for tests.

        x (dim,), phi (modes, dim), psi (modes, turns); b, w: the body's entries of q and v. Returns the members of
        `fu_modal_point`, P, T, K for a force f and a moment m on the point, and the derivatives of its velocities.
        """
        cdef fu_body *r = &self.bodies[index]
        cdef fu_modal_attachment modal
        cdef fu_modal_point out
        cdef int n = fu_body_dofs(r), dim = r.kernel.dim, turns = r.kernel.velocity - r.kernel.dim
        modal.x, modal.phi, modal.psi = self._doubles(x), self._doubles(phi), self._doubles(psi)
        P, T, K, v_q, omega_q = (np.zeros((rows, n)) for rows in (dim, turns, n, dim, turns))
        cdef double[:, ::1] P_view = P, T_view = T, K_view = K, v_view = v_q, omega_view = omega_q
        fu_modal_attachment_state(r, &modal, self._doubles(b), self._doubles(w), &out, &P_view[0, 0], &T_view[0, 0])
        fu_modal_attachment_wrench(r, &modal, self._doubles(b), self._doubles(w), self._doubles(f), self._doubles(m),
                                   &K_view[0, 0], &v_view[0, 0], &omega_view[0, 0])
        return {"p": np.array(out.p)[:dim], "axes": np.array(out.axes)[:dim * dim].reshape(dim, dim), "P": P, "T": T, "K": K,
                "v_q": v_q, "omega_q": omega_q,
                "velocity": np.array(out.velocity)[:dim], "omega": np.array(out.omega)[:turns],
                "bias": np.array(out.bias)[:dim], "omega_bias": np.array(out.omega_bias)[:turns]}

    cdef int _modal_attachment(self, fu_modal_attachment *to, modal) except -1:
        to.x, to.phi, to.psi = self._doubles(modal[0]), self._doubles(modal[1]), self._doubles(modal[2])
        if len(modal[1]) + (6 if self.model.dim == 3 else 3) > FU_ATTACHMENT_COORDINATES:
            raise ValueError(f"more modes than the engine's {FU_ATTACHMENT_COORDINATES - 6}")
        return 0

    cdef int _end(self, fu_attachment *to, end, list tables) except -1:
        cdef int k
        to.cable, to.body, to.element, to.slide, to.node = end.cable, end.body, end.element, end.slide, end.node
        to.frame, to.rope = NULL, NULL
        if end.span is not None:
            to.rope = <const fu_rope_point_kernels *>self._found(tables, "rope_point", end.rope_point)
            to.node, to.span_elements, to.material = end.span.first, end.span.n_elements, end.material
            to.share = self._doubles(end.span.share)
            for k in range(2):
                to.span_s[k] = end.span.s[k]
        for k in range(len(end.u)):
            to.u[k] = end.u[k]
        for k in range(len(end.N)):
            to.N[k] = end.N[k]
        if end.modal is not None:
            self._modal_attachment(&to.modal, end.modal)
        if end.axes is None:
            return 0
        if end.frame:
            to.frame = <const fu_frame_kernels *>self._found(tables, "frame", end.frame)
        for k in range(2):
            to.slopes[k] = end.slopes[k]
        for k in range(3):
            to.up[k] = end.up[k]
        for k in range(end.S.size):
            to.S[k] = end.S.flat[k]
        for k in range(end.axes.size):
            to.axes[k] = end.axes.flat[k]
        return 0

    def _couplings(self, model, list tables):
        """Fill in the structures of all couplings by the fields of their types, and number them."""
        cdef size_t at = 0
        cdef fu_coupling *coupling
        cdef int n = len(model.couplings)
        self.numbers, self.static_forces = {}, dict.fromkeys(OUTPUTS, 0)
        for k, given in enumerate(model.couplings):
            coupling = self.couplings[k] = <fu_coupling *>(self.coupling_memory + at)
            coupling.type = _type_of(given)
            fu_bind_events(coupling)
            kind = self._kind(coupling)
            coupling.index = len(self.numbers.setdefault(kind, []))
            self.numbers[kind].append(k)
            self._fields(<char *>coupling, fu_coupling_fields, given, tables)
            self._fields(<char *>coupling, coupling.type.fields, given, tables)
            start = coupling.type.start
            if start != NULL and start.excess != NULL and start.excess(coupling) != NULL:
                raise ValueError(f"{given.type} {given.name!r}: more {start.excess(coupling).decode()} than the "
                                 "engine has room for")
            if given.keeps_forces and given.n_forces:
                self.static_forces[kind] = max(self.static_forces.get(kind, 0), given.n_forces)
            at += coupling.type.size
        fu_number_couplings(self.couplings, n, <const fu_coupling **>self._memory(2.0 * n * sizeof(fu_coupling *)), &self.model)

    cdef str _kind(self, const fu_coupling *coupling):
        """Return the name of a coupling's type, such as "load", "slide", "joint" or "point_force"."""
        return coupling.type.name.decode()

    cdef list _of(self, str kind):
        """Return the numbers of the couplings of a kind."""
        return self.numbers.get(kind, [])

    cdef int _fields(self, char *structure, const fu_field *field, given, list tables) except -1:
        """Fill in the fields of a list, which ends with one without a name, from the entries or attributes of these names."""
        while field.name != NULL:
            name = field.name.decode()
            value = given.entries[name] if name in given.entries else getattr(given, name)
            if field.stride:
                if len(value) > field.most:
                    raise ValueError(f"{given.type}: {len(value)} {field.name.decode()}, the engine has {field.most}")
                for k, item in enumerate(value):
                    self._field(structure + field.offset + <size_t>k * field.stride, field, item, given.type, tables)
            else:
                self._field(structure + field.offset, field, value, given.type, tables)
            field += 1
        return 0

    cdef int _field(self, char *to, const fu_field *field, value, str type, list tables) except -1:
        """Fill in one item of a field (base/fields.h)."""
        cdef int k
        if field.kind == FU_INTEGER:
            (<int *>to)[0] = value
        elif field.kind == FU_REAL or field.kind == FU_LENGTH:
            (<double *>to)[0] = value
        elif field.kind == FU_INTEGERS:
            (<const int **>to)[0] = self._ints(value)
        elif field.kind == FU_REALS:
            (<const double **>to)[0] = self._doubles(value)
        elif field.kind == FU_ATTACHMENT:
            self._end(<fu_attachment *>to, value, tables)
        elif field.kind == FU_KERNELS:
            role = type if field.words == NULL else field.words[0].decode()
            (<const void **>to)[0] = self._found(tables, role, value) if value else NULL
        elif field.kind == FU_WORD:
            k = 0
            while field.words[k] != NULL and field.words[k] != <bytes>value.encode():
                k += 1
            if field.words[k] == NULL:
                raise ValueError(f"{type}: {field.name.decode()} {value!r} is not known")
            (<int *>to)[0] = k
        return 0

    def _signals(self, model):
        cdef int i
        for i, signal in enumerate(model.signals):
            g = &self.signals[i]
            g.n = len(signal.coefficients)
            if g.n and signal.coefficients.shape[1] != FU_SIGNAL_TERMS:
                raise ValueError(f"a signal's pieces need {FU_SIGNAL_TERMS} coefficients")
            g.breaks, g.coefficients = self._doubles(signal.breaks), self._doubles(signal.coefficients)
            g.amplitude, g.angular_frequency, g.phase = signal.amplitude, signal.angular_frequency, signal.phase

    def _signals_and_motions(self, model):
        cdef int i
        self._signals(model)
        moved = set()
        for i, motion in enumerate(model.motions):
            o = &self.motions[i]
            o.dof, o.signal, o.base, o.linear = motion.dof, motion.signal, motion.base, motion.linear
            o.cosine, o.sine, o.first = motion.cosine, motion.sine, motion.dof not in moved
            moved.add(motion.dof)
        m = &self.model
        m.n_motions, m.motions, m.signals, m.load_fraction = len(model.motions), self.motions, self.signals, 1.0

    cdef _fronts(self, fu_fronts *fronts, elimination, const int *numbers, dict first):
        """Fill in the elimination of a border; numbers, first: of its layout."""
        fronts.m, fronts.n, fronts.size = elimination.m, elimination.n, elimination.size
        fronts.solves = elimination.solves
        fronts.start, fronts.first = numbers + <int>first["start"], numbers + <int>first["first"]
        fronts.pivots, fronts.neighbours = numbers + <int>first["pivots"], numbers + <int>first["neighbours"]
        fronts.unknown, fronts.in_parent = numbers + <int>first["unknown"], numbers + <int>first["in_parent"]
        fronts.parent, fronts.child = numbers + <int>first["parent"], numbers + <int>first["child"]
        fronts.sibling = numbers + <int>first["sibling"]
        fronts.front, fronts.place = numbers + <int>first["front"], numbers + <int>first["place"]

    cdef _factors(self, fu_factors *factors, elimination):
        """Allocate the factors of a border, unless they replace the matrix."""
        cdef int n = elimination.n, m = elimination.m
        self._banded_front(&factors.banded, elimination)
        if n == 1:
            return
        factors.most_numbers = min(elimination.most_numbers(FU_UNPACKED_FRONT), MAX_INT)
        factors.most_unknowns = min(2 * elimination.most_sizes.sum(), MAX_INT)
        factors.numbers, factors.x = self._zeros(factors.most_numbers), self._zeros(2.0 * m)
        factors.unknowns, factors.map = self._int_zeros(factors.most_unknowns), self._int_zeros(m)
        factors.start, factors.first = self._int_zeros(n), self._int_zeros(n)
        factors.size, factors.pivots, factors.done = self._int_zeros(n), self._int_zeros(n), self._int_zeros(n)
        factors.complement = self._int_zeros(n)

    cdef _banded_front(self, fu_banded_front *banded, elimination):
        """Allocate the front that may be a band of at most half of its size."""
        banded.front = elimination.banded_front
        if banded.front < 0:
            return
        cdef int most = elimination.pivots[banded.front]
        banded.most_entries = self._counted(most * most // 2 + most)
        banded.most_numbers = self._counted(most * most // 2 + (1 + FU_BANDED_PADDING) * most)
        banded.first, banded.rows = self._int_zeros(most + 1), self._int_zeros(banded.most_entries)
        banded.child, banded.order = self._int_zeros(most), self._int_zeros(most)
        banded.place, banded.pivot = self._int_zeros(most), self._int_zeros(most)
        banded.band = self._zeros(banded.most_numbers)

    cdef _strips(self, fu_system *system, layout, int *numbers):
        """Fill in the coupling of the border with chains, and allocate its memory; numbers: of the layout."""
        cdef int n = layout.n_strips, chains = system.n_chains
        cdef dict first = layout.first
        system.n_strips, system.n_strip_rows = n, self._counted(layout.rows)
        system.strips = <fu_strip *>(numbers + <int>first["strips"])
        system.first_strip = numbers + <int>first["first_strip"]
        system.on_chain, system.chain_start = self._int_zeros(n), self._int_zeros(chains + 1)
        system.B, system.C = self._zeros(system.n_strip_rows), self._zeros(system.n_strip_rows)
        system.X = self._zeros(self._counted(layout.rows_of_x))
        system.span_B, system.span_C = <fu_span *>self._int_zeros(2 * 2 * n), <fu_span *>self._int_zeros(2 * 2 * n)
        system.span_X = <fu_span *>self._int_zeros(2 * 2 * n)
        system.columns, system.rows = <fu_matrix_block *>self._int_zeros(4 * 2 * n), <fu_matrix_block *>self._int_zeros(4 * 2 * n)
        system.factorisations = self._int_zeros(chains)
        system.n_columns, system.n_rows = self._int_zeros(chains), self._int_zeros(chains)

    cdef int _counted(self, double n) except -1:
        """Return a count as C's int. Raises MemoryError on overflow."""
        if n > MAX_INT:
            raise MemoryError
        return <int>n

    cdef _system(self, fu_system *system, fu_fronts *fronts, model, elimination, int width):
        cdef int n = model.n_band, m = elimination.m, chains = len(model.chains) - 1
        layout = elimination.layout(model.chains, FU_BAND_BEYOND(width))
        cdef int *numbers = self._ints(layout.numbers)
        system.n, system.width, system.m, system.n_chains = n, width, m, chains
        self._fronts(fronts, elimination, numbers, layout.first)
        self._factors(&system.factors, elimination)
        self._strips(system, layout, numbers)
        system.fronts, system.chains = fronts, numbers + <int>layout.first["chains"]
        if fu_needs_lapack(system):
            _take_lapack()
            self.needs_lapack = True
        system.half = numbers + <int>layout.first["half"]
        system.D, system.mirror = self._zeros(elimination.size + 1.0), self._zeros(n)
        factor = (width + 1.0) * (n + <double>FU_BAND_MORE(width) * chains)
        system.L, system.U = self._zeros(factor), self._zeros(factor)
        system.pivot_band, system.pivot_border = self._int_zeros(n), self._int_zeros(m)

    cdef _full(self, fu_system *system):
        """Allocate the full matrix of a system of few unknowns with a dense border."""
        cdef int n = system.n + system.m
        if system.m and n <= FU_MAX_SMALL and system.fronts.n == 1:
            system.full, system.pivot_full = self._zeros(n * n), self._int_zeros(n)

    cdef _state(self, fu_state *state, model):
        """Allocate the arrays of a state (state.h), with the model as drawn."""
        cdef int k
        for k in range(FU_N_STATE_ARRAYS):
            self._attach(state, k)
        self._view(state, "q")[:], self._view(state, "v")[:] = model.q, model.v
        fu_reset(&self.model, state)

    cdef int _attach(self, fu_state *state, int k) except -1:
        """Allocate the k-th array of a state, zeros."""
        cdef fu_array array = fu_state_array(&self.model, state, k)
        if array.is_real:
            fu_state_attach(state, k, self._zeros(array.items))
        else:
            fu_state_attach(state, k, self._int_zeros(array.items))
        return 0

    cdef _view(self, const fu_state *state, str name):
        """Return an array of a state by its name in state.h, a view."""
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
        n_dof = model.n_dof
        unknowns = model.n_band + model.n_border_dof
        run = &self.run
        run.model = &self.model
        self._state(&run.now, model)
        self._state(&run.next, model)
        width = max(model.width, FU_BAND_GROUP - 1)
        self.newton_elimination, accelerations = model.newton, model.accelerations
        self._system(&run.newton, &self.newton_fronts, model, model.newton, width)
        self._full(&run.newton)
        a = &run.accelerator
        self._system(&a.mass, &self.mass_fronts, model, accelerations, width)
        sizes = np.diff(model.chains).tolist()
        if max(sizes, default=0) <= min(FU_MAX_INVERTED, INVERSE_SIZE_FACTOR * (width + 1)):
            a.mass.inverse = self._zeros(sum(n * FU_INVERSE_ROWS(n) for n in sizes))
        # shared: the mass matrix is factored elsewhere before the first Newton matrix is made
        run.newton.K = a.mass.K = self._zeros((3.0 * width + 1) * model.n_band)
        if self.model.n_inertial:  # the mass matrix is factored repeatedly
            a.mass.K = self._zeros((3.0 * width + 1) * model.n_band)
        a.corner = self._zeros(accelerations.size)
        a.rhs = self._zeros(unknowns + model.n_multipliers + FU_BAND_BEYOND(width))
        a.rows = <fu_rows *>self._zeros(self.model.n_rows * sizeof(fu_rows) // sizeof(double) + 1)
        for k in range(self.model.n_couplings):
            c = self.couplings[<int>k]
            if c.row >= 0:
                a.rows[c.row].H = self._zeros(FU_ROW_ENTRIES_OF(max(c.n_multipliers, 1)))
        a.scratch = self._zeros(self.model.n_scratch)
        a.multipliers = self._zeros(model.n_multipliers)
        a.self_locking = -1
        a.force, a.work = self._zeros(n_dof), self._zeros(n_dof)
        a.prescribed = self._zeros(n_dof)
        run.slackness = <fu_slackness *>self._memory(<double>self.model.n_cables * sizeof(fu_slackness))
        run.deepest = self._zeros(self.model.n_couplings)
        run.farthest = self._zeros(self.model.n_couplings)
        run.rhs = self._zeros(unknowns + model.n_extra + FU_BAND_BEYOND(width))
        run.psi, run.force = self._zeros(n_dof), self._zeros(n_dof)
        run.work, run.before = self._zeros(n_dof), self._zeros(n_dof)
        run.first, run.s_slope = self._zeros(model.n_q), self._zeros(self.model.n_coordinates)
        run.path_rate = self._zeros(self.model.n_coordinates)
        self._set_event_functions([])
