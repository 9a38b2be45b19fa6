# The memory of a run before its start, for packed scenes (funicular/export), and packed scenes in this process.

cdef class Packable(Report):
    """The memory that a run consists of, and the tables of the program to which it points."""

    cdef list _all_blocks(self):
        """Return the address and the size in bytes of all memory of a run, but for its breakpoints."""
        return self.blocks + [
            (<size_t>&self.model, sizeof(fu_model)), (<size_t>&self.run, sizeof(fu_run)),
            (<size_t>&self.linear, sizeof(fu_linear_model)), (<size_t>&self.newton_fronts, sizeof(fu_fronts)),
            (<size_t>&self.mass_fronts, sizeof(fu_fronts)),
            (<size_t>self.event_functions, (self.run.n_event_functions + 1) * sizeof(fu_event_function))]

    def memory_blocks(self):
        """Return the blocks of memory of a run that is ready, (address, words (n,) as unsigned integers) each, in the order
        in which they were made.

        Pointers to functions of Python and to what the program keeps are null in them.
        """
        run = &self.run
        run.call, run.context = NULL, NULL
        breakpoints = <size_t>self.breakpoints, (run.n_breakpoints + 1) * sizeof(fu_breakpoint)
        return [(address, np.asarray(<unsigned long long[:size // 8]><unsigned long long *><size_t>address).copy())
                for address, size in [*self._all_blocks(), breakpoints] if size]

    @property
    def run_address(self):
        """Return the address of the structure of the run, in one of the blocks."""
        return <size_t>&self.run

    @property
    def has_lapack(self):
        """Return whether the run calls LAPACK."""
        return bool(fu_needs_lapack(&self.run.newton) or fu_needs_lapack(&self.run.accelerator.mass))

    def program_tables(self):
        """Return role and name, by address, of the tables of the program to which the memory may point."""
        cdef int k
        found = dict(self.kernels)
        found[<size_t>&LAPACK] = "lapack", ""
        found[<size_t>&fu_rigid_matter], found[<size_t>&fu_modal_matter] = ("matter", "rigid"), ("matter", "modal")
        found[<size_t>self.run.integrator] = "integrator", self.run.integrator.name.decode()
        for k in range(self.model.n_cables):
            if self.cables[k].blocks != NULL:
                found[<size_t>self.cables[k].blocks] = "blocks", self.cables[k].law.name.decode()
        for k in range(self.model.n_couplings):
            name = self.couplings[k].type.name.decode()
            found[<size_t>self.couplings[k].type] = "coupling", name
            if self.couplings[k].events != NULL:
                found[<size_t>self.couplings[k].events] = "events", name
        return found

    def record_arrays(self):
        """Return the arrays of a row by name, flat, in the order of the engine."""
        cdef int k
        return {fu_record_array(&self.model, &self.run.record, k).name.decode(): self.named[k]
                for k in range(FU_N_RECORD_ARRAYS)}


def packed_format():
    """Return version, magic word, layout of the structures and alignment of packed scenes of this engine."""
    return FU_PACKED_VERSION, FU_PACKED_MAGIC, fu_packed_layout(), FU_PACKED_ALIGNMENT


cdef class PackedRun:
    """A run of a packed scene in this process, without Python in it.

    digest: of the scene that is accepted; kernels: roles and names of the tables that it needs; plain_lapack: whether it
    takes the engine's own functions, as a program does. Raises ValueError for a scene that is refused.
    """

    cdef funicular *run
    cdef fu_linked *linked
    cdef fu_registry registry
    cdef funicular_scene scene
    cdef object kept

    def __cinit__(self, packed, bytes digest, kernels, bint plain_lapack=False):
        cdef char message[FUNICULAR_MESSAGE]
        cdef size_t k, n = len(kernels)
        cdef const unsigned long long[::1] words
        padded = np.zeros(-(-len(packed) // 8) + 1, dtype=np.uint64)  # aligned
        padded.view(np.uint8)[:len(packed)] = np.frombuffer(packed, dtype=np.uint8)
        words = padded
        names = [(role.encode(), name.encode()) for role, name in kernels]
        self.kept = padded, digest, names
        self.linked = <fu_linked *>calloc(n + 1, sizeof(fu_linked))
        if self.linked == NULL:
            raise MemoryError
        for k in range(n):
            self.linked[k].role, self.linked[k].name = names[k][0], names[k][1]
            self.linked[k].entry = fu_find(<const fu_tables *>_own_tables(), names[k][0], names[k][1])
        if not plain_lapack:
            _take_lapack()
        self.registry.digest, self.registry.kernels = <const unsigned char *><const char *>digest, self.linked
        self.registry.lapack = &fu_plain_lapack if plain_lapack else &LAPACK
        self.scene.bytes, self.scene.size, self.scene.registry = &words[0], len(packed), &self.registry
        self.run = funicular_open(&self.scene, NULL, message)
        if self.run == NULL:
            raise ValueError(message.decode())

    def __dealloc__(self):
        funicular_close(self.run)
        free(self.linked)

    @property
    def message(self):
        """Return the last message."""
        return funicular_message(self.run).decode()

    @property
    def time(self):
        """Return the time of the last row in s."""
        return funicular_time(self.run)

    @property
    def pause_rows(self):
        """Return the number of rows between pauses."""
        return funicular_pause_rows(self.run)

    def values(self):
        """Return names and units of all values, in the order of their references."""
        cdef int k
        return [(funicular_name(self.run, k).decode(), funicular_unit(self.run, k).decode())
                for k in range(funicular_count(self.run))]

    def step(self):
        """Compute the next row; return the status."""
        cdef int status
        with nogil:
            status = funicular_step(self.run)
        return status

    def advance(self, double time):
        """Compute the rows until a time in s; return the status."""
        return funicular_advance(self.run, time)

    def reach(self, double time):
        """Continue to a time in s; return the status."""
        return funicular_reach(self.run, time)

    def inputs(self):
        """Return names, units and values of all inputs."""
        cdef int k
        return [(funicular_input_name(self.run, k).decode(), funicular_input_unit(self.run, k).decode(),
                 funicular_input(self.run, k)) for k in range(funicular_inputs(self.run))]

    def set_input(self, str name, double value, double rate=0.0):
        """Give an input a value and a rate."""
        if funicular_set_input(self.run, funicular_find_input(self.run, name.encode()), value, rate):
            raise ValueError(self.message)

    def _reference(self, str name):
        cdef int found = funicular_find(self.run, name.encode())
        if found < 0:
            raise KeyError(name)
        return found

    def __getitem__(self, str name):
        cdef int reference = self._reference(name)
        cdef double value
        if funicular_get(self.run, &reference, 1, &value):
            raise ValueError(self.message)
        return value

    def __setitem__(self, str name, double value):
        cdef int reference = self._reference(name)
        if funicular_set(self.run, &reference, 1, &value):
            raise ValueError(self.message)

    def row(self):
        """Return all values of the last row."""
        cdef int n = funicular_count(self.run)
        cdef int[::1] references = np.arange(n + 1, dtype=np.intc)
        values = np.zeros(n + 1)
        cdef double[::1] view = values
        if funicular_get(self.run, &references[0], n, &view[0]):
            raise ValueError(self.message)
        return values[:n]

    def save(self):
        """Return the bytes of the state."""
        cdef bytearray taken = bytearray(funicular_saved(self.run))
        if funicular_save(self.run, <char *>taken):
            raise ValueError(self.message)
        return bytes(taken)

    def restore(self, bytes saved):
        """Continue from saved bytes."""
        if funicular_restore(self.run, <const char *>saved, len(saved)):
            raise ValueError(self.message)
