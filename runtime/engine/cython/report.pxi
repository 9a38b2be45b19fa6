# Reports of a run: counts, sizes, progress, causes of failure.

cdef class Report(LinearModels):
    """Numbers of a run, read only."""

    def relaxed_strains(self):
        """Return, for each cable, (elements, rates + 1): g and the energy of r of algorithmic dissipation, as in
        engine/integrators/algorithmic_dissipation.c.
        """
        numbers = self._view(&self.run.now, "dissipation_state").copy()
        ends = np.cumsum([self.cables[i].n_elements * (self.cables[i].law.rates + 1) for i in range(self.model.n_cables)])
        return [part.reshape(self.cables[i].n_elements, -1)
                for i, part in enumerate(np.split(numbers, ends[:-1]))]

    def without_algorithmic_force(self):
        """Return the numbers of the cables whose law has no kernel for algorithmic dissipation."""
        return [i for i in range(self.model.n_cables) if self.cables[i].law.algorithmic_force == NULL]

    def without_step_equations(self):
        """Return the numbers of the couplings with equations at an instant, but not over a step that conserves energy."""
        return [i for i in range(self.model.n_couplings)
                if self.couplings[i].type.residual != NULL and not fu_has_step(self.couplings[i])]

    @property
    def breakpoints_passed(self):
        """Return the number of breakpoints of signals passed."""
        cdef int k, passed = 0
        for k in range(self.run.n_breakpoints):
            passed += self.run.breakpoints[k].t <= self.run.now.t
        return passed

    @property
    def row_bytes(self):
        """Bytes of a row of output."""
        return 8 * sum([fu_record_array(&self.model, &self.run.record, k).items for k in range(FU_N_RECORD_ARRAYS)])

    cdef _snapshot(self, const fu_state *state):
        """t, q, v, s of a state."""
        return state.t, *(self._view(state, name).copy() for name in ("q", "v", "s"))

    @property
    def n_rows(self):
        """Number of output rows since the start."""
        return self.run.record.n

    @property
    def n_steps(self):
        """Number of steps since the start, which `statistics` has with much else."""
        return self.run.statistics.steps

    @property
    def statistics(self):
        """Counts, step sizes, error estimates and seconds by part."""
        s = self.run.statistics
        return {"steps": s.steps, "rejected_steps": s.rejected, "newton_iterations": s.newton_iterations,
                "factorisations": s.factorisations, "newton_failures": s.newton_failures, "evaluations": s.evaluations,
                "element_crossings": s.node_passages, "smallest_step_s": s.h_min, "largest_step_s": s.h_max,
                **self._of_linear_model(), "sum_of_local_error_estimates_m": s.error_sum, "largest_motion_m": self.run.motion,
                "time_s": {"residual": s.time_residual, "factorisation": s.time_factor, "solve": s.time_solve,
                           "step": s.time_step, "error": s.time_error, "output": s.time_output}}

    def costs(self):
        """Return (couplings,): seconds of each per step, measured in 0.1 ms or 2 % of the run (run/part_timing.c)."""
        cdef double[::1] seconds = np.zeros(self.model.n_couplings + 1)
        fu_part_timing(&self.run, &seconds[0])
        return np.asarray(seconds)[:self.model.n_couplings]

    def deepest(self, str kind):
        """Return (couplings,): largest penetration of each of a kind since the start or a checkpoint, m."""
        return np.array([self.run.deepest[<int>number] for number in self._of(kind)])

    def farthest(self, str kind):
        """Return (couplings,): largest distance of contact beyond the ends of the surface since then, m."""
        return np.array([self.run.farthest[<int>number] for number in self._of(kind)])

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
        return int(self.bytes_allocated)

    @property
    def time(self):
        """Time reached, s."""
        return self.run.now.t

    @property
    def failure(self):
        """Cause (CAUSES) of the last failed step, with the dof and the coupling (or None) of the largest residual.

        The cause is None where energy grew, and where no step failed.
        """
        f = self.run.failure
        return CAUSES[f.cause], f.dof, f.coupling if f.cause != FU_NO_FAILURE and f.coupling >= 0 else None

    @property
    def self_locking(self):
        """Number of the coupling whose friction has no solution, or -1."""
        return self.run.accelerator.self_locking

    cdef dict _of_linear_model(self):
        return {} if self.linear_error is None else {"linear_model_error_m": self.linear_error[0]}

    @property
    def balance(self):
        """Energy gained and lost by errors, exchanged, kinetic, and of rounding, J."""
        b = self.run.balance
        return b.grown, b.lost, b.exchanged, b.in_motion, b.rounding

    @property
    def absolute_tol(self):
        """Error allowed in addition to tol times the motion, m."""
        return self.run.absolute_tol

    @property
    def controlled_motion(self):
        """Largest motion so far of the controlled quantities, m."""
        return self.run.controlled_motion

    @property
    def moves(self):
        """Whether anything has moved beyond rounding."""
        return bool(fu_moves(&self.run))

    @property
    def extent(self):
        """Largest extent of the scene, m."""
        return self.run.extent

    @property
    def closed(self):
        """Displacement at the start that closed the gaps of joints, m."""
        return self.run.closed

    def history(self, k):
        """Return the history variables of a coupling at the time reached."""
        cdef const fu_coupling *c = self.couplings[k]
        return self._view(&self.run.now, "numbers")[c.numbers : c.numbers + c.type.n_numbers + c.n_numbers].copy()

    def now(self):
        """t, q, v, s at the time reached."""
        return self._snapshot(&self.run.now)

    @property
    def left(self):
        """Number of the coupling of a rope that has left a sheave, and the reason (equations/run.h)."""
        return self.run.left, self.run.left_by

    @property
    def stopped_slide(self):
        """Index of the slide that ran off its cable."""
        return self.run.stopped_slide

    @property
    def stopped_s(self):
        """Arc-length of that slide, m."""
        return self._view(&self.run.now, "s")[self.run.stopped_slide]
