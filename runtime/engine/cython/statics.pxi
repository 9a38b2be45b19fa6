# Statics, and matrices for tests: `next` is the state, changed by increments of the unknowns.

cdef class Statics(Translation):
    """Residual and matrix of a state."""

    cdef object spreads
    cdef object corner  # rows and columns of the border's entries
    cdef dict weight  # gravity's forces as the model has them
    cdef dict held  # of signals that are held: pieces, amplitude, angular frequency and phase as the model has them

    cdef _entries(self):
        """Return rows, columns and values of the non-zero entries of the unfactored Newton matrix."""
        cdef fu_system *system = &self.run.newton
        cdef int n = system.n, width = system.width, m = system.m
        band = np.asarray(<double[:n * (3 * width + 1)]>system.K).reshape(n, 3 * width + 1) if n else np.zeros((0, 1))
        columns, diagonals = np.nonzero(band)
        entries = [(columns + diagonals - 2 * width, columns, band[columns, diagonals])]
        if m:
            if self.corner is None:
                self.corner = self.newton_elimination.entries()
            corner = np.asarray(<double[:system.fronts.size]>system.D)
            used = np.flatnonzero(corner)
            entries.append((n + self.corner[0][used], n + self.corner[1][used], corner[used]))
        if system.n_strip_rows:
            strips = np.asarray(<int[:system.n_strips, :5]><int *>system.strips)
            chains = np.array([system.chains[i] for i in range(system.n_chains + 1)])
            lengths = np.diff(chains)[strips[:, 1]]
            in_band = np.concatenate([np.arange(*chains[chain:chain + 2]) for chain in strips[:, 1]])
            at, beside = in_band + np.repeat(strips[:, 2], lengths), n + np.repeat(strips[:, 0], lengths)
            right = np.asarray(<double[:system.n_strip_rows]>system.B)[at]
            below = np.asarray(<double[:system.n_strip_rows]>system.C)[at]
            used = np.flatnonzero(right)
            entries.append((in_band[used], beside[used], right[used]))
            used = np.flatnonzero(below)
            entries.append((beside[used], in_band[used], below[used]))
        return [np.concatenate(part) for part in zip(*entries)]

    cdef _matrix(self):
        """The unfactored Newton matrix, (unknowns, unknowns) sparse."""
        from scipy.sparse import coo_array

        cdef int total = self.run.newton.n + self.run.newton.m
        row, column, value = self._entries()
        return coo_array((value, (row, column)), shape=(total, total)).tocsc()

    def linearise(self, double h, change):
        """Return residual and Newton matrix of a step h, its prediction changed by `change`; for tests.

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
        """Solve once with the matrix of `linearise`, (unknowns,) to (unknowns,); return the method of factorisation, too:
        "symmetric", "unpivoted", "pivoted", or several. For tests.

        Raises ArithmeticError where the matrix is singular.
        """
        cdef double[::1] given = np.ascontiguousarray(right, dtype=float)
        cdef int i, total = self.run.newton.n + self.run.newton.m
        if given.shape[0] != total:
            raise ValueError(f"right must have {total} entries")
        for i in range(total):
            self.run.rhs[i] = given[i]
        if fu_system_factor_band(&self.run.newton) or fu_system_factor_border(&self.run.newton, &LAPACK):
            raise ArithmeticError("singular")
        fu_system_solve(&self.run.newton, &LAPACK, self.run.rhs)
        used = {self.run.newton.factorisations[c] for c in range(self.run.newton.n_chains)}
        how = " and ".join(name for k, name in enumerate(("symmetric", "unpivoted", "pivoted")) if k in used)
        return np.array([self.run.rhs[i] for i in range(total)]), how

    @property
    def banded_front(self):
        """Unknowns of the border's front that was factored as a band, 0 for none, and its diagonals on both sides; for tests."""
        cdef const fu_banded_front *banded = &self.run.newton.factors.banded
        return banded.n, banded.lower, banded.upper

    def set_state(self, double t=0.0, q=None, s=None, prescribe=True, **given):
        """Set the static state: time, configuration (n_q,), arc-lengths, by default as built; by the name of a kind the
        internal forces of its couplings, (n, largest number of one), by default zero.

        prescribe: whether prescribed dofs take their values at t instead of those in q.
        """
        cdef fu_state *state = &self.run.next
        cdef int i
        state.t = t
        self._view(state, "q")[:] = self._view(&self.run.now, "q") if q is None else q
        self._rest(state)
        if prescribe:
            fu_prescribe(&self.model, state)
        self._rest(state)
        self._view(state, "s")[:] = self._view(&self.run.now, "s") if s is None else s
        fu_find_path_segments(&self.model, state)
        forces = self._view(state, "forces")
        for i in range(self.model.n_couplings):
            c = self.couplings[i]
            values = given.get(self._kind(c))
            for k in range(c.n_forces):
                forces[c.force + k] = 0.0 if values is None or k >= values.shape[1] else values[c.index][k]
        fu_detect_contact(&self.model, state)

    cdef _rest(self, fu_state *state):
        self._view(state, "v")[:] = 0.0
        self._view(state, "acceleration")[:] = 0.0

    def state(self):
        """Return the static state as the arguments of `set_state`, without t."""
        cdef fu_state *state = &self.run.next
        forces = self._view(state, "forces")
        own = {kind: self._own(kind, forces, width) for kind, width in self.static_forces.items()}
        return {"q": self._view(state, "q").copy(), "s": self._view(state, "s").copy()} | own

    cdef _own(self, str kind, forces, int width):
        """Return (couplings of a kind, width): entries of `forces`, padded with zeros."""
        cdef int i, k
        found = []
        for i in self._of(kind):
            c = self.couplings[i]
            found.append([forces[c.force + k] if k < c.n_forces else 0.0 for k in range(width)])
        return np.array(found).reshape(len(found), width)

    def load(self, double fraction, gravity=True):
        """Scale the loads by a fraction in static states; gravity: whether it is scaled, too.

        Loads are forces and moments on cables and bodies, without prescribed motions, springs and stresses at rest.
        """
        cdef fu_model *m = &self.model
        cdef double weight = fraction if gravity else 1.0
        cdef int i, k
        if self.weight is None:
            self.weight = {"dofs": [m.gravity[i] for i in range(m.n_dof)],
                           "shapes": [[self.shapes[i].g[k] for k in range(3)] for i in range(m.n_bodies)]}
        m.load_fraction = fraction
        cdef double *dof_gravity = <double *>m.gravity
        for i, value in enumerate(self.weight["dofs"]):
            dof_gravity[i] = weight * value
        for i in range(m.n_bodies):
            for k in range(3):
                self.shapes[i].g[k] = weight * self.weight["shapes"][i][k]

    def vibrate(self, on):
        """Let tangents be those of small vibrations about the static state, where these differ from those of loading."""
        self.model.vibrates = on

    def impend(self, double slip):
        """Let ropes be about to slide on their sheaves in static states: speed in their order over the slip velocity."""
        self.model.impending = slip

    def hold_wraps(self):
        """Let ropes stick to the sheaves with sticking friction in static states, where they lie in the present one."""
        for number in self._of("wrap_point"):
            fu_hold_point(&self.model, self.couplings[<int>number], &self.run.next)

    def held_wraps(self):
        """Return the points where ropes stick to sheaves in static states: whether they stick, 2, or slide, 1 or -1 (n,);
        friction and its limit in N, and the sliding since `hold_wraps` in m (n, 3).
        """
        cdef fu_held_friction of
        numbers = self._of("wrap_point")
        modes, found = np.zeros(len(numbers), dtype=int), np.zeros((len(numbers), 3))
        for k, number in enumerate(numbers):
            fu_held_point(&self.model, self.couplings[<int>number], &self.run.next, &of)
            modes[k] = of.mode
            found[k] = of.f, of.limit, of.slip
        return modes, found

    def set_held_wraps(self, modes):
        """Let these points stick or slide: modes (n,), as `held_wraps` returns them."""
        for number, mode in zip(self._of("wrap_point"), modes):
            fu_set_held_mode(self.couplings[<int>number], &self.run.next, mode)

    def hold(self, int signal, value):
        """Fix the value of a signal; None restores that of the model."""
        cdef fu_signal *g = &self.signals[signal]
        self.held = self.held or {}
        own = self.held.setdefault(signal, (g.n, g.amplitude, g.angular_frequency, g.phase))
        g.n, g.amplitude, g.angular_frequency, g.phase = own if value is None else (0, value, 0.0, M_PI_2)  # sine is 1

    def stiffen(self, int cable, A):
        """Set other constants of a cable's law: A (1 or elements, constants), as in the model."""
        cdef fu_cable *c = &self.cables[cable]
        cdef double[::1] given = np.ascontiguousarray(A, dtype=float).ravel()
        cdef double *own = <double *>c.A
        cdef int i
        for i in range(given.shape[0]):
            own[i] = given[i]

    def move(self, change):
        """Move the static state by unknowns (n,): coordinates and rotations, s, forces."""
        cdef double[::1] moved = np.ascontiguousarray(change, dtype=float)
        if moved.shape[0] != self.run.newton.n + self.run.newton.m:
            raise ValueError(f"change must have {self.run.newton.n + self.run.newton.m} entries")
        if moved.shape[0]:
            fu_static_move(&self.run, &moved[0])

    def static_residual(self):
        """Return (n,): residual of equilibrium over the unknowns: internal minus external forces; constraints."""
        cdef int total = self.run.newton.n + self.run.newton.m
        fu_static_residual(&self.run)
        return -np.asarray(<double[:total]>self.run.rhs) if total else np.zeros(0)

    def set_rates(self, v, acceleration):
        """Set velocities and accelerations (n_dof,) of the static state, which `set_state` sets to zero."""
        self._view(&self.run.next, "v")[:] = v
        self._view(&self.run.next, "acceleration")[:] = acceleration

    def forces_in_motion(self):
        """Return (n_dof,): forces of the static state with its rates: inertial and internal less external ones."""
        cdef fu_equations at
        memset(&at, 0, sizeof(at))
        at.now, at.next = &self.run.now, &self.run.next
        at.weights.inertia, at.weights.rate, at.weights.stiffness = 1.0, 0.0, 1.0
        fu_residual(&self.run, &at)
        return self.reaction()

    def outputs_in_motion(self, str kind):
        """Return `static_outputs` of the static state with its rates."""
        numbers = self._of(kind)
        out = np.zeros((len(numbers), fu_n_outputs(fu_coupling_type_of(kind.encode()))))
        cdef double[:, ::1] view = out
        cdef double[::1] acceleration = self._view(&self.run.next, "acceleration")
        cdef int k, number
        for k, number in enumerate(numbers if self.model.n_dof else []):
            c = self.couplings[number]
            c.type.outputs(&self.model, c, &self.run.next, &acceleration[0], NULL, &view[k, 0])
        return out

    def external_forces(self, int first, int stop):
        """Return (stop - first, n_dof): contributions of loads first..stop to the residual in the static state."""
        out = np.zeros((stop - first, self.model.n_dof))
        cdef double[:, ::1] view = out
        cdef double[::1] q = self._view(&self.run.next, "q")
        cdef fu_coupling *c
        cdef int k
        for k in range(first, stop if self.model.n_dof else first):
            c = self.couplings[k]
            c.type.supply.force(&self.model, c, self.run.next.t, &q[0], &view[k - first, 0])
        return out

    def reaction(self):
        """Return (n_dof,): after `static_residual`, reactions of supports, the residual at free dofs."""
        return np.asarray(<double[:self.model.n_dof]>self.run.force).copy() if self.model.n_dof else np.zeros(0)

    def matrix(self, double inertia, double rate, double stiffness):
        """Return inertia M + stiffness (K + rate D) in the static state, (n, n) sparse; constraints if stiffness is not 0."""
        self._weigh(inertia, rate, stiffness)
        between = self._between_cables() if stiffness else None
        return self._matrix() if between is None else self._matrix() + stiffness * between

    def dense_matrix(self, double inertia, double rate, double stiffness):
        """Return the same as an array (n, n), which is faster for few unknowns."""
        cdef int total = self.run.newton.n + self.run.newton.m
        self._weigh(inertia, rate, stiffness)
        full = np.zeros((total, total))
        self._fill(full)
        between = self._between_cables() if stiffness else None
        return full if between is None else full + stiffness * between.toarray()

    cdef _fill(self, double[:, ::1] full):
        """Put the entries of the unfactored Newton matrix into an array of zeros."""
        cdef const fu_system *system = &self.run.newton
        cdef const fu_fronts *fronts = system.fronts
        cdef int n = system.n, width = system.width, k, i, j, p, s, row
        cdef const double *D
        cdef const int *at
        for j in range(n):
            for row in range(max(0, j - 2 * width), min(n, j + width + 1)):
                full[row, j] = system.K[<long>j * (3 * width + 1) + row - j + 2 * width]
        for k in range(fronts.n if system.m else 0):
            D, at, p, s = system.D + fronts.start[k], fronts.unknown + fronts.first[k], fronts.pivots[k], fronts.neighbours[k]
            for j in range(p):
                for i in range(p + s):
                    full[n + at[i], n + at[j]] = D[j * (p + s) + i]
                for i in range(s):
                    full[n + at[j], n + at[p + i]] = D[p * (p + s) + i * p + j]
        for k in range(system.n_strips):
            j = n + system.strips[k].k
            for row in range(system.chains[system.strips[k].chain], system.chains[system.strips[k].chain + 1]):
                full[row, j] += system.B[system.strips[k].at + row]
                full[j, row] += system.C[system.strips[k].at + row]

    cdef _weigh(self, double inertia, double rate, double stiffness):
        cdef fu_weights weights
        weights.inertia, weights.rate, weights.stiffness = inertia, rate, stiffness
        fu_matrix_of_weights(&self.run, weights)

    def _between_cables(self):
        """Return (n, n) sparse: stiffness of joints between two cables, which Newton's method in time omits; else None."""
        joints = [k for k in self._of("joint") if fu_between_cables(<fu_joint *>self.couplings[<int>k])]
        if not joints:
            return None
        from scipy.sparse import coo_array, csr_array

        cdef fu_joint_derivatives by
        cdef fu_joint *joint
        cdef int k, i, e, n_dof = self.model.n_dof, total = self.run.newton.n + self.run.newton.m
        whole = n_dof + self.model.n_extra
        stiffness = csr_array((whole, whole))
        for k in joints:
            joint = <fu_joint *>self.couplings[k]
            fu_joint_tangent(&self.model, joint, &self.run.next, self.run.next.forces + joint.base.force, &by)
            places = [np.array([by.at[e][i] for i in range(by.n[e])]) for e in range(2)]
            for e in range(2):
                block = np.array([by.K[1 - e][e][i] for i in range(by.n[0] * by.n[1])]).reshape(by.n[1 - e], by.n[e])
                # a fixed s has no equilibrium equation
                moves = [[fu_joint_moves(&self.model, joint, &self.run.next, at) for at in side] for side in places]
                block = block * np.outer(moves[1 - e], moves[e])
                rows, columns = np.repeat(places[1 - e], by.n[e]), np.tile(places[e], by.n[1 - e])
                stiffness = stiffness + coo_array((block.ravel(), (rows, columns)), shape=(whole, whole)).tocsr()
        if not stiffness.nnz:
            return None
        if self.spreads is None:
            unit = [self.spread(x) for x in np.eye(total)[:total - self.model.n_extra]]
            dofs = np.array(unit).reshape(-1, n_dof).T
            self.spreads = csr_array(np.block([[dofs, np.zeros((n_dof, self.model.n_extra))],
                                               [np.zeros((self.model.n_extra, dofs.shape[1])), np.eye(self.model.n_extra)]]))
        return self.spreads.T @ stiffness @ self.spreads

    def spread(self, unknowns):
        """Return (n_dof,): changes of the dofs by changes of the unknowns."""
        cdef double[::1] x = np.ascontiguousarray(unknowns, dtype=float)
        cdef double[::1] dofs = np.zeros(max(1, self.model.n_dof))
        fu_spread(&self.model, &x[0], &dofs[0])
        return np.asarray(dofs)[:self.model.n_dof]
