# Lengths of slopes of many elements in many rows, for the notes on a run: NumPy takes ten times as long for few elements.

def slope_lengths(const double[:, :, :] shapes, const double[:, :, :, :] first, const double[:, :, :, :] last):
    """Return (parts, T, n): lengths of the sums of the vectors of two nodes (T, n, vectors, dim), weighted by shapes
    (parts, 1 or n, vectors of both). Vectors without weight in all parts do not count, even if they are not finite.
    """
    cdef Py_ssize_t parts = shapes.shape[0], rows = first.shape[0], n = first.shape[1]
    cdef Py_ssize_t vectors = first.shape[2], dim = first.shape[3], p, t, e, k, d, own
    cdef double square, at_first, at_last
    if not (shapes.shape[2] == 2 * vectors and (shapes.shape[1] == 1 or shapes.shape[1] == n) and dim in (2, 3)
            and last.shape[0] == rows and last.shape[1] == n and last.shape[2] == vectors and last.shape[3] == dim):
        raise ValueError("the shapes of functions and vectors differ")
    found = np.empty((parts, rows, n))
    cdef double[:, :, ::1] lengths = found
    cdef char[::1] counted = np.any(shapes, axis=(0, 1)).view(np.int8)
    cdef double squares[3]
    with nogil:
        for p in range(parts):
            for t in range(rows):
                for e in range(n):
                    own = e if shapes.shape[1] > 1 else 0
                    squares[2] = 0.0
                    for d in range(dim):
                        at_first = at_last = 0.0
                        for k in range(vectors):
                            if counted[k]:
                                at_first = at_first + shapes[p, own, k] * first[t, e, k, d]
                            if counted[vectors + k]:
                                at_last = at_last + shapes[p, own, vectors + k] * last[t, e, k, d]
                        square = at_first + at_last
                        squares[d] = square * square
                    lengths[p, t, e] = sqrt(squares[0] + squares[1] + squares[2])
    return found
