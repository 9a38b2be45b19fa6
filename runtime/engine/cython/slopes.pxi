# Measures of many elements in many rows, for the notes on a run: NumPy takes ten times as long for few elements.

@cython.boundscheck(False)  # the shapes are checked
@cython.wraparound(False)
def slope_lengths(const double[:, :, :] shapes, const double[:, :, :, :] first, const double[:, :, :, :] last):
    """Return (parts, T, n): lengths of the sums of the vectors of two nodes (T, n, vectors, dim), weighted by shapes
    (parts, 1 or n, vectors of both). Vectors without weight in all parts do not count, even if they are not finite.
    """
    cdef Py_ssize_t parts = shapes.shape[0], rows = first.shape[0], n = first.shape[1]
    cdef Py_ssize_t vectors = first.shape[2], dim = first.shape[3], p, t, e, k, d, own
    cdef double square, at_first, at_last
    cdef unsigned long long counted = 0
    if not (shapes.shape[2] == 2 * vectors and (shapes.shape[1] == 1 or shapes.shape[1] == n) and dim in (2, 3)
            and last.shape[0] == rows and last.shape[1] == n and last.shape[2] == vectors and last.shape[3] == dim
            and 2 * vectors <= 64):
        raise ValueError("the shapes of functions and vectors differ")
    found = np.empty((parts, rows, n))
    cdef double[:, :, ::1] lengths = found
    cdef double squares[3]
    with nogil:
        for k in range(2 * vectors):
            for p in range(parts):
                for own in range(shapes.shape[1]):
                    if shapes[p, own, k] != 0.0:
                        counted |= <unsigned long long>1 << k
        for p in range(parts):
            for t in range(rows):
                for e in range(n):
                    own = e if shapes.shape[1] > 1 else 0
                    squares[2] = 0.0
                    for d in range(dim):
                        at_first = at_last = 0.0
                        for k in range(vectors):
                            if counted >> k & 1:
                                at_first = at_first + shapes[p, own, k] * first[t, e, k, d]
                            if counted >> (vectors + k) & 1:
                                at_last = at_last + shapes[p, own, vectors + k] * last[t, e, k, d]
                        square = at_first + at_last
                        squares[d] = square * square
                    lengths[p, t, e] = sqrt(squares[0] + squares[1] + squares[2])
    return found


def moments_along(const double[:, :, :] values, const double[:] positions, const double[:] weights):
    """Return (3, T, n): the mean over each element of values (points, T, n), that of their squares, and that of the
    squares of their differences from the line of best fit; positions, weights: of the points, as in `gauss_rule`.
    """
    cdef Py_ssize_t points = values.shape[0], rows = values.shape[1], n = values.shape[2], p, t, e
    cdef double mean, slope, square, difference, apart
    if not positions.shape[0] == weights.shape[0] == points:
        raise ValueError("positions, weights and values differ in number")
    found = np.empty((3, rows, n))
    cdef double[:, :, ::1] moments = found
    with nogil:
        for t in range(rows):
            for e in range(n):
                mean = slope = square = difference = 0.0
                for p in range(points):
                    mean = mean + weights[p] * values[p, t, e]
                    slope = slope + weights[p] * (2 * positions[p] - 1) * values[p, t, e]
                    square = square + weights[p] * values[p, t, e] * values[p, t, e]
                for p in range(points):
                    apart = values[p, t, e] - mean - 3 * (2 * positions[p] - 1) * slope
                    difference = difference + weights[p] * apart * apart
                moments[0, t, e], moments[1, t, e], moments[2, t, e] = mean, square, difference
    return found


def chord_lengths(const double[:, :, :] r, nodes=None):
    """Return (T, n): distances of consecutive nodes, of all or of those with these numbers, at r (T, nodes, dim)."""
    cdef Py_ssize_t rows = r.shape[0], n = (r.shape[1] if nodes is None else len(nodes)) - 1, t, k, d, a, b
    cdef int number[2]
    cdef double square
    found = np.empty((rows, n))
    cdef double[:, ::1] lengths = found
    for k in range(n):
        a, b = (k, k + 1) if nodes is None else (nodes[k], nodes[k + 1])
        if not (0 <= a < r.shape[1] and 0 <= b < r.shape[1]):
            raise ValueError("there are no such nodes")
        for t in range(rows):
            square = 0.0
            for d in range(r.shape[2]):
                square = square + (r[t, b, d] - r[t, a, d]) * (r[t, b, d] - r[t, a, d])
            lengths[t, k] = sqrt(square)
    return found


def straight_rows(const double[:, :, :] r, double most, bint before):
    """Return (T,): whether the middle node lies near the line from the first to the last one, at r (T, nodes, dim), in
    two rows in turn; before: in the row before the first one. The last one counts beside the row to come.

    most: the squared distance over that of the first and the last one; where that is zero, a row counts.
    """
    cdef Py_ssize_t rows = r.shape[0], last = r.shape[1] - 1, middle = r.shape[1] // 2, t, d
    cdef double square, other, product, chord, arm
    cdef bint here
    found = np.zeros(rows, dtype=bool)
    cdef char[::1] straight = found.view(np.int8)
    for t in range(rows):
        square = other = product = 0.0
        for d in range(r.shape[2]):
            chord, arm = r[t, last, d] - r[t, 0, d], r[t, middle, d] - r[t, 0, d]
            square, other, product = square + chord * chord, other + arm * arm, product + arm * chord
        here = not other * square - product * product > most * square * square
        if here and (before or t == rows - 1):
            straight[t] = True
        if here and before and t > 0:
            straight[t - 1] = True
        before = here
    return found


def quadratic_forms(const double[:, :, :] m, const double[:, :, :, :] nodal):
    """Return (T,): half the sums of e m e over the elements of a cable with nodal vectors (T, nodes, vectors, dim), e
    those of an element; m (1 or elements, vectors of both nodes, the same).
    """
    cdef Py_ssize_t rows = nodal.shape[0], n = nodal.shape[1] - 1, vectors = nodal.shape[2], t, e, a, b, d, own
    cdef double value
    if not ((m.shape[0] == 1 or m.shape[0] == n) and m.shape[1] == m.shape[2] == 2 * vectors):
        raise ValueError("the shapes of matrix and vectors differ")
    found = np.empty(rows)
    cdef double[::1] sums = found
    for t in range(rows):
        value = 0.0
        for e in range(n):
            own = e if m.shape[0] > 1 else 0
            for a in range(2 * vectors):
                for b in range(2 * vectors):
                    for d in range(nodal.shape[3]):
                        value = value + m[own, a, b] * (nodal[t, e + a // vectors, a % vectors, d]
                                                        * nodal[t, e + b // vectors, b % vectors, d])
        sums[t] = 0.5 * value
    return found


def tension_work(const double[:, :] strain, const double[:] EA, const double[:] h, const double[:, :] apart, first):
    """Return (T,): the work of the tension of a line, see solve/notes/coarse_meshes.py: at mean strains of its elements
    (T, n), whose lengths are h, by spans, whose ends are apart (T, spans); first: of each span its first element.
    """
    cdef Py_ssize_t rows = strain.shape[0], n = strain.shape[1], spans = apart.shape[1], t, k, e, begin, end
    cdef double force, along, unrolling
    found = np.zeros(rows)
    cdef double[::1] work = found
    if not (len(first) == spans and EA.shape[0] == h.shape[0] == n and apart.shape[0] == rows):
        raise ValueError("elements and spans differ in number")
    for k in range(spans):
        begin, end = first[k], first[k + 1] if k + 1 < spans else n
        if not 0 <= begin < end <= n:
            raise ValueError("a span has no such elements")
        for t in range(rows):
            force = along = 0.0
            for e in range(begin, end):
                work[t] += EA[e] * strain[t, e] * strain[t, e] * h[e]
                force = force + fabs(EA[e] * strain[t, e]) * h[e] * (1 + strain[t, e])
                along = along + h[e] * (1 + strain[t, e])
            unrolling = force - force / (along if along > 0.0 else 1.0) * apart[t, k]
            if not unrolling <= 0.0:
                work[t] += unrolling
    return found


def around_elements(const double[:, :, :, :] nodal, int slope, const double[:, :] strain, const Py_ssize_t[:] element):
    """Return (2, T): about one element of a cable in each row, (T,), with those beside it, the cosine of the angle by
    which the slope turns, and the mean strain; slope: its number among nodal vectors (T, nodes, vectors, dim), strain:
    of elements (T, n).
    """
    cdef Py_ssize_t rows = nodal.shape[0], n = strain.shape[1], t, e, d, first, last
    cdef double square, other, product, total
    found = np.empty((2, rows))
    cdef double[:, ::1] around = found
    if not (strain.shape[0] == element.shape[0] == rows and nodal.shape[1] == n + 1 and 0 <= slope < nodal.shape[2]):
        raise ValueError("rows, elements and vectors differ in number")
    for t in range(rows):
        first, last = max(element[t] - 1, 0), min(element[t] + 2, n)
        square = other = product = total = 0.0
        for d in range(nodal.shape[3]):
            square = square + nodal[t, first, slope, d] * nodal[t, first, slope, d]
            other = other + nodal[t, last, slope, d] * nodal[t, last, slope, d]
            product = product + nodal[t, first, slope, d] * nodal[t, last, slope, d]
        for e in range(first, last):
            total = total + strain[t, e]
        around[0, t] = product / fmax(sqrt(square) * sqrt(other), DBL_MIN)
        around[1, t] = total / (last - first)
    return found


def turned_tension(const double[:] cosine, const double[:] strain, const double[:] force, const double[:] h, double EA,
                   double EI, double length_factor, double angle_factor, double least_angle):
    """Return the sums over rows (T,) of the error of the tension of a line beside a slide, of the angle in rad by which
    the line turns there, and of the tension in N, see solve/notes/coarse_slides.py.

    cosine: of the angle between the slopes beside the slide; force: on its rider, in N; h (1 or T,): lengths of elements.
    """
    cdef Py_ssize_t rows = cosine.shape[0], t
    cdef double tension, angle, longer, error_sum = 0.0, angle_sum = 0.0, tension_sum = 0.0
    if not (strain.shape[0] == force.shape[0] == rows and h.shape[0] in (1, rows)):
        raise ValueError("rows differ in number")
    for t in range(rows):
        angle = fmax(acos(fmin(fmax(cosine[t], -1.0), 1.0)) / 2, least_angle)
        tension = fmax(fmax(EA * strain[t], force[t] / (2 * sin(angle))), 1e-300)
        angle = 2 * asin(fmin(force[t] / (2 * tension), 1.0))
        longer = h[t if h.shape[0] > 1 else 0] * sqrt(tension / EI) if EI > 0.0 else INFINITY
        if longer > 1:
            error_sum = error_sum + fmin(length_factor * longer, angle_factor) * angle * angle
        angle_sum, tension_sum = angle_sum + angle, tension_sum + tension
    return error_sum, angle_sum, tension_sum
