# Arrays that the engine's structures point to.

INDICES = 2**31 - 1  # of C's int
MACHINE_MEMORY = machine_memory()


cdef class Arrays:
    """Keeps them as long as it lives; `arrays` are those with names.

    They never take more than the machine has: a system that lends more than that ends the process when it is used.
    """

    cdef list kept
    cdef readonly dict arrays
    cdef double bytes_kept

    def __cinit__(self, *args, **kwargs):
        self.kept, self.arrays, self.bytes_kept = [], {}, 0.0

    cdef _keep(self, array):
        self.bytes_kept += array.nbytes
        if self.bytes_kept > MACHINE_MEMORY:
            raise MemoryError
        self.kept.append(array)

    cdef double *_doubles(self, values) except NULL:
        array = np.array(values, dtype=float, order="C").ravel()
        if array.size == 0:
            array = np.zeros(1)
        cdef double[::1] view = array
        self._keep(array)
        return &view[0]

    cdef double *_zeros(self, double size) except NULL:
        # kept as they come: memory that nothing is written to is not taken from the machine
        if size > INDICES or 8.0 * size > MACHINE_MEMORY:
            raise MemoryError
        array = np.zeros(max(1, int(size)))
        cdef double[::1] view = array
        self._keep(array)
        return &view[0]

    cdef int *_ints(self, values) except NULL:
        array = np.array(values, dtype=np.intc).ravel()
        if array.size == 0:
            array = np.zeros(1, dtype=np.intc)
        cdef int[::1] view = array
        self._keep(array)
        return &view[0]

    cdef double *_named(self, name, shape) except NULL:
        array = np.zeros(shape)
        cdef double *pointer = self._doubles(array)
        self.arrays[name] = self.kept[-1].reshape(shape) if array.size else array
        return pointer
