# An engine that steps to times given one after the other.

cdef class SteppedEngine(Engine):
    """One run of a model whose end, loads and drives are not known at its start."""

    cdef int last  # place of the last row in the arrays

    def reach(self, double time):
        """Step to a time in s, at most the duration, and record its row; return None, or the status of a run that ends
        before. Raises KeyboardInterrupt after a step.
        """
        cdef int status = FU_RUNNING
        run = &self.run
        if run.record.n - run.record.first + 2 > self.arrays["time"].shape[0]:
            raise RuntimeError("the arrays are full of rows; call take_rows first")
        while status == FU_RUNNING:
            with nogil:
                status = fu_reach(run, time, 0.05)
            if self.error is not None:
                raise self.error
            if status == FU_EVENT:
                status = self._after_event()
                if status:
                    break
            if status == FU_RUNNING:
                PyErr_CheckSignals()
                check_interrupted()
        return None if status == FU_DONE else STATUS[status]

    @property
    def n_rows_kept(self):
        """Number of output rows in the arrays."""
        return self.run.record.n - self.run.record.first

    def pause(self):
        """Drop what no checkpoint has, as a run does at its pauses."""
        fu_pause(&self.run)

    def last_row(self):
        """Return copies of the recorded arrays, of the last row alone."""
        self._note_last()
        return {name: array[self.last:self.last + 1].copy() for name, array in self.arrays.items()}

    def take_rows(self):
        """Release the rows in the arrays, but the last one, until there is a new one."""
        self._note_last()
        Engine.take_rows(self)

    cdef _note_last(self):
        if self.run.record.n > self.run.record.first:
            self.last = self.run.record.n - self.run.record.first - 1

    def extend(self, double duration, breakpoints):
        """Take a later end, in s, with the breakpoints until there. Raises ArithmeticError where the equations are
        singular at one that has been the end.
        """
        cdef int k
        run = &self.run
        run.duration = duration
        self._breakpoints(*breakpoints)
        for k in range(run.n_breakpoints):
            if fabs(run.breakpoints[k].t - run.now.t) <= FU_AT_ONCE * duration:
                self._pass(run.breakpoints[k].jumps)

    def signal_at(self, int number):
        """Return the value of a signal, its rate and second derivative at the time reached."""
        cdef double rate, second
        value = fu_signal_at(&self.signals[number], self.run.now.t, &rate, &second)
        return value, rate, second

    def set_input(self, int k, double value, double rate):
        """Give input k a value from the time reached on, and a rate."""
        fu_set_input(&self.run, k, value, rate)

    def input_value(self, int k):
        """Return the value of input k at the time reached, or that it has after the next step."""
        return fu_input_value(&self.run, k)

    def is_position(self, int k):
        """Return whether input k prescribes a position, which cannot jump."""
        return bool(fu_is_position(&self.run, k))

    def give_inputs(self, double until):
        """Give the signals of inputs their values for a step until a time in s. Raises ArithmeticError where the equations
        are singular then.
        """
        if fu_give_inputs(&self.run, until):
            raise ArithmeticError("the equations are singular")

    cdef _pass(self, int jumps):
        cdef fu_breakpoint now
        now.t, now.jumps = self.run.now.t, jumps
        if fu_pass_breakpoint(&self.run, &now, 0):
            raise ArithmeticError("the equations are singular")

    def image(self):
        """Return all that changes in a run, for this engine alone: bytes of blocks of memory, the breakpoints, and the place
        of the last row.
        """
        cdef size_t address, size, at = 0
        blocks = self._all_blocks()
        cdef bytearray taken = bytearray(sum([size for _, size in blocks]))
        cdef char *image = taken
        for address, size in blocks:
            memcpy(image + at, <void *>address, size)
            at += size
        points = [(self.run.breakpoints[k].t, self.run.breakpoints[k].jumps) for k in range(self.run.n_breakpoints)]
        self._note_last()
        return taken, blocks, points, self.last

    def take_image(self, image):
        """Return to the state of an image of this engine, with the same bits."""
        cdef size_t address, size, at = 0
        cdef bytearray taken = image[0]
        cdef const char *memory = taken
        for address, size in image[1]:
            memcpy(<void *>address, memory + at, size)
            at += size
        self._breakpoints(*(zip(*image[2]) if image[2] else ((), ())))
        self.run.record.first, self.last = self.run.record.n, image[3]
