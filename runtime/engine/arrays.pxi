# Arrays that the engine's structures point to.

cdef class Arrays:
    """Keeps them as long as it lives; `arrays` are those with names."""

    cdef list kept
    cdef readonly dict arrays

    def __cinit__(self, *args, **kwargs):
        self.kept, self.arrays = [], {}

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
