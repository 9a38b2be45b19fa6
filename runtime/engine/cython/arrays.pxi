# Arrays that the engine's structures point to.

MAX_INT = 2**31 - 1  # of C
MACHINE_MEMORY = machine_memory()

cdef size_t CHUNK = 1 << 16  # bytes of a block of small arrays
cdef size_t ALIGNED = 64  # alignment of arrays, a cache line


cdef class Arrays:
    """Owns arrays; `arrays` holds those with names.

    Their total size is limited to the memory of the machine: a system that overcommits would end the process later.
    """

    cdef list named, blocks  # blocks: address and size in bytes of all memory
    cdef readonly dict arrays
    cdef double bytes_allocated
    cdef void **chunks
    cdef size_t n_chunks, left
    cdef char *at

    def __cinit__(self, *args, **kwargs):
        self.named, self.blocks, self.arrays, self.bytes_allocated = [], [], {}, 0.0

    def __dealloc__(self):
        cdef size_t k
        for k in range(self.n_chunks):
            free(self.chunks[k])
        free(self.chunks)

    cdef int _count(self, double size) except -1:
        """Add to the bytes owned. Raises MemoryError."""
        self.bytes_allocated += size
        if self.bytes_allocated > MACHINE_MEMORY:
            raise MemoryError
        return 0

    cdef char *_chunk(self, size_t size) except NULL:
        """Return new memory, zeros; the system provides pages when they are written."""
        cdef void **more = <void **>realloc(self.chunks, (self.n_chunks + 1) * sizeof(void *))
        if not more:
            raise MemoryError
        self.chunks = more
        cdef char *begin = <char *>calloc(1, size + ALIGNED)
        if not begin:
            raise MemoryError
        self.chunks[self.n_chunks] = begin
        self.n_chunks += 1
        begin += ALIGNED - <size_t>begin % ALIGNED
        self.blocks.append((<size_t>begin, size))
        return begin

    cdef void *_memory(self, double size) except NULL:
        """Return memory of this size in bytes, zeros."""
        self._count(size)
        cdef size_t bytes = (<size_t>size // ALIGNED + 1) * ALIGNED
        if bytes > CHUNK // 4:
            return self._chunk(bytes)
        if bytes > self.left:
            self.at, self.left = self._chunk(CHUNK), CHUNK
        cdef char *array = self.at
        self.at, self.left = array + bytes, self.left - bytes
        return array

    cdef double *_doubles(self, values) except NULL:
        cdef const double[::1] given = np.asarray(values, dtype=float, order="C").ravel()
        cdef size_t size = given.shape[0] * sizeof(double)
        cdef double *array = <double *>self._memory(size)
        if size:
            memcpy(array, &given[0], size)
        return array

    cdef double *_zeros(self, double size) except NULL:
        if size > MAX_INT:
            raise MemoryError
        return <double *>self._memory(size * sizeof(double))

    cdef int *_ints(self, values) except NULL:
        cdef const int[::1] given = np.asarray(values, dtype=np.intc, order="C").ravel()
        cdef size_t size = given.shape[0] * sizeof(int)
        cdef int *array = <int *>self._memory(size)
        if size:
            memcpy(array, &given[0], size)
        return array

    cdef int *_int_zeros(self, double size) except NULL:
        if size > MAX_INT:
            raise MemoryError
        return <int *>self._memory(size * sizeof(int))

    cdef double *_named(self, name, shape) except NULL:
        """Make an array with a name; Python code may keep it."""
        size = prod(shape)
        self._count(8.0 * size)
        array = np.zeros(max(1, size))
        cdef double[::1] view = array
        self.named.append(array)
        self.blocks.append((<size_t>&view[0], <size_t>array.nbytes))
        self.arrays[name] = array[:size].reshape(shape)
        return &view[0]
