# The linear model of motion about the start (solve/motion/linear_model.py).

cdef class LinearModels(Statics):
    """Matrices of a state for a linear model about it, and the model that a run takes."""

    cdef fu_linear_model linear

    cdef _moving(self):
        """Return whether constraints move along cables, row by row, and the number of their multipliers."""
        cdef const fu_coupling *coupling
        cdef int k
        moves, multipliers = np.zeros(self.model.n_rows, dtype=int), 0
        for k in range(self.model.n_couplings):
            coupling = self.model.couplings[k]
            if coupling.row >= 0 and coupling.n_coordinates:
                moves[coupling.row] = 1
                multipliers += coupling.n_multipliers
        return moves, multipliers

    def constraint_rows(self):
        """Return the rows of the joints' constraints over the dofs in the static state, as triplets: multipliers, dofs,
        and values.
        """
        cdef fu_rows *rows
        cdef int r, c, k
        found = []
        fu_evaluate_rows(&self.model, &self.run.next, &self.run.accelerator)
        moves, _ = self._moving()
        for r in np.flatnonzero(moves == 0):
            rows = &self.run.accelerator.rows[r]
            for c in range(rows.rows):
                if not rows.redundant_rows >> c & 1:
                    found += [(rows.first + c, rows.at[k], rows.H[c * rows.n + k]) for k in range(rows.n)]
        multipliers, dofs, values = zip(*found) if found else ((), (), ())
        return np.array(multipliers, dtype=int), np.array(dofs, dtype=int), np.array(values, dtype=float)

    def cables_at_rest(self, int stride):
        """Return mass, damping and stiffness of the cables in the static state, upper halves (n_dof, stride) by rows."""
        found = np.zeros((3, self.model.n_dof, stride))
        cdef double[:, :, ::1] view = found
        cdef double[::1] q = self._view(&self.run.next, "q")
        for k, which in enumerate((FU_MASS_AT_REST, FU_DAMPING_AT_REST, FU_STIFFNESS_AT_REST)):
            if self.model.n_dof:
                fu_add_cables_at_rest(&self.model, &q[0], which, stride, &view[k, 0, 0])
        return found

    cdef _sparse(self, fu_sparse *to, matrix):
        """Take a sparse matrix (rows, columns)."""
        self._rows_of(to, matrix, np.arange(matrix.shape[0]))

    cdef _filled_rows(self, fu_sparse *to, matrix):
        """Take the rows of a sparse matrix that have entries."""
        self._rows_of(to, matrix, np.flatnonzero(np.diff(matrix.indptr)))

    cdef _rows_of(self, fu_sparse *to, matrix, rows):
        """Take these rows of a sparse matrix."""
        given = matrix[rows]
        to.rows, to.row = len(rows), self._ints(rows)
        to.start, to.column, to.value = self._ints(given.indptr), self._ints(given.indices), self._doubles(given.data)

    def take_linear_model(self, model):
        """Take a linear model about the start for a run with the integrator "linear"; call it before `start`."""
        cdef fu_linear_model *m = &self.linear
        cdef int k
        m.n, m.width, m.stride = model.n, model.width, model.stride
        moves, m.n_moving = self._moving()
        m.moves = self._ints(moves)
        m.moving_start = self._ints(np.zeros(m.n_moving + 1))
        m.moving_column = self._ints(np.zeros(m.n_moving * m.n))
        m.dof, m.mixed = self._ints(model.dof), self._ints(model.mixed)
        self._sparse(&m.combinations, model.combinations)
        self._sparse(&m.closing, model.closing)
        self._sparse(&m.held, model.held)
        self._sparse(&m.read, model.read)
        self._filled_rows(&m.joints, model.joints)
        for k in range(FU_MATRICES):
            self._filled_rows(&m.exact[k], model.exact[k])
            m.matrices[k] = self._doubles(model.bands[k])
            m.cables[k] = self._zeros(<double>FU_HALF_BAND_ROWS(self.model.n_dof) * m.stride)
        m.weight, m.force = self._doubles(model.weight), self._zeros(self.model.n_dof)
        factor = (m.n + <double>FU_BAND_MORE(m.width)) * (m.width + 1)
        m.at_rest.L, m.of_mass.L = self._zeros(factor), self._zeros(factor)
        for k in range(FU_STEP_FACTORS):
            m.factors[k].L = self._zeros(factor)
        self.run.linear = m

    @property
    def linear_error(self):
        """Return the largest estimate of the linear model's error in a row of the run, m, and its time, s; None without."""
        return None if self.linear.error == NULL else (self.linear.error[0], self.linear.error[1])
