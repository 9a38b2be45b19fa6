"""The shape at rest of strings: links that bear only tension, bend elastically, and lie on planes.

Its potential energy is convex. A link of length l has the Green strain energy EA l/2 max(0, (d²/l² - 1)/2)² of the
distance d of its nodes; bending has EI/2 |r''|², without the division by |r'|, and loads are constant. There is one
minimum for any first shape, and where all links are in tension it is a stable state of rest of lines that resist
compression, too. The multipliers of the links are their tensions, so that stiff links cost no more than soft ones.

The method is a primal-dual one of interior points (Wright, Primal-Dual Interior-Point Methods, SIAM 1997, ch. 1; for
convex constraints Boyd & Vandenberghe, Convex Optimization, ch. 11.7). A link is the constraint

    c = (1 - d²/l²)/2 + x/(EA l) >= 0, whose multiplier x >= 0 is tension times length,

and a node over a plane the constraint that its height plus the deflection of the plane is not negative.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError
from scipy.linalg.lapack import dpbtrf, dpbtrs

FORCE_TOLERANCE = 1e-8
"""Residual forces, and tensions of links that are not taut, as a fraction of the sum of all loads."""
MAX_ITERATIONS = 60
MAX_BOUNDARY_FRACTION = 0.95
"""Upper bound of a step, as a fraction of the distance to a zero of a constraint or multiplier."""
SLACK_TOLERANCE = 1e-4
"""Links are taut if their slack is below this fraction of half the squared length."""
DIVISION_GUARD = 1e-300


@dataclass
class Strings:
    """Nodes, links, bending and planes, and loads.

    r (n, dim): positions of nodes in m; fixed (n, dim): which of these coordinates are fixed; load (n, dim) in N. links
    (m, 2): their nodes; length (m,): unstretched, in m; axial (m,): EA in N. bends (b, 3): nodes, whose positions times
    the factors (b, 3) in 1/m², less natural (b, dim) in 1/m, are a curvature; bending (b,): EI times its length in N
    m³. resting (k,): nodes over planes with unit normals (k, dim), heights (k,) along these in m, and compliances (k,)
    in m/N.
    """

    r: np.ndarray
    fixed: np.ndarray
    load: np.ndarray
    links: np.ndarray
    length: np.ndarray
    axial: np.ndarray
    bends: np.ndarray
    factors: np.ndarray
    natural: np.ndarray
    bending: np.ndarray
    resting: np.ndarray
    normals: np.ndarray
    heights: np.ndarray
    compliances: np.ndarray

    @property
    def width(self) -> int:
        """Return the largest difference of the numbers of nodes of a link or a bend."""
        return max(int(np.ptp(nodes, axis=1).max(initial=0)) for nodes in (self.links, self.bends))

    def renumbered(self, order: np.ndarray) -> Strings:
        """Return the same strings with node order[k] as the k-th node."""
        number = np.empty_like(order)
        number[order] = np.arange(len(order))
        return replace(self, r=self.r[order], fixed=self.fixed[order], load=self.load[order], links=number[self.links],
                       bends=number[self.bends], resting=number[self.resting])

    def stretched_evenly(self, system: _Banded) -> np.ndarray:
        """Return (n, dim): positions of nodes with links as springs of one stiffness per length, without loads."""
        stiffness = np.broadcast_to((1 / self.length)[:, None, None], (len(self.links), 1, 1)) * np.eye(self.r.shape[1])
        start = np.where(self.fixed, self.r, 0.0)
        pull = (start[self.links[:, 1]] - start[self.links[:, 0]]) / self.length[:, None]
        force = _Scatter(self.links.T.ravel(), start.shape).sums(pull, -pull)
        return np.asarray(start + system.solve(system.factor(system.of_links(stiffness) + system.held), force))


@dataclass
class Rest:
    """Positions of nodes at rest (n, dim) in m; whether links are taut (m,), to about the tolerance; the smallest
    distance of the nodes of a link over its length; the number of iterations.
    """

    r: np.ndarray
    taut: np.ndarray
    shortest: float
    iterations: int


class _Scatter:
    """Sums of vectors over the nodes at which they act."""

    def __init__(self, nodes: np.ndarray, shape: tuple[int, int]):
        """nodes: of each vector; shape: of the sums, nodes and components."""
        self.shape, self.at = shape, np.add.outer(nodes * shape[1], np.arange(shape[1])).ravel()

    def sums(self, *vectors: np.ndarray) -> np.ndarray:
        """Return (n, dim): sums of vectors (..., dim), in the order of the nodes given."""
        parts = [each.reshape(-1) for each in vectors]
        return np.bincount(self.at, np.concatenate(parts), self.shape[0] * self.shape[1]).reshape(self.shape)


class _Banded:
    """Symmetric matrices over the coordinates of nodes, by their upper diagonals, zero where a coordinate is fixed."""

    def __init__(self, strings: Strings):
        n, dim = strings.r.shape
        self.n, self.above = n * dim, (strings.width + 1) * dim - 1
        self.free = ~strings.fixed.ravel()
        self.strings = strings
        self._axis = np.arange(dim)
        row, column = np.divmod(np.arange(dim * dim), dim)
        upper = row <= column
        i, j = np.sort(strings.links, axis=1).T
        self._link_blocks = np.concatenate([np.flatnonzero(upper)] * 2 + [np.arange(dim * dim)])
        sign = np.where(np.arange(len(self._link_blocks)) < 2 * upper.sum(), 1.0, -1.0)
        self._link_at, self._link_mask = self._places(
            np.concatenate([np.add.outer(i * dim, row[upper]), np.add.outer(j * dim, row[upper]),
                            np.add.outer(i * dim, row)], axis=1),
            np.concatenate([np.add.outer(i * dim, column[upper]), np.add.outer(j * dim, column[upper]),
                            np.add.outer(j * dim, column)], axis=1), sign)
        self._upper = np.flatnonzero(upper)
        on = strings.resting * dim
        self._rest_at, self._rest_mask = self._places(np.add.outer(on, row[upper]), np.add.outer(on, column[upper]),
                                                      np.ones(len(self._upper)))

    def _places(self, rows: np.ndarray, columns: np.ndarray, sign: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        at = (self.above + rows - columns) * self.n + columns
        return at.ravel(), sign * (self.free[rows] & self.free[columns])

    def _filled(self, at: np.ndarray, values: np.ndarray) -> np.ndarray:
        return np.bincount(at, values.ravel(), minlength=(self.above + 1) * self.n)

    @property
    def held(self) -> np.ndarray:
        """Return the matrix that is one where a coordinate is fixed, else zero."""
        return self._filled(self.above * self.n + np.flatnonzero(~self.free), np.ones(np.count_nonzero(~self.free)))

    def of_links(self, blocks: np.ndarray) -> np.ndarray:
        """Return the matrix of blocks (links, dim, dim), symmetric, over the differences of the links' nodes."""
        values = blocks.reshape(len(blocks), -1)[:, self._link_blocks]
        return self._filled(self._link_at, self._link_mask * values)

    def of_planes(self, stiffness: np.ndarray) -> np.ndarray:
        """Return the matrix of stiffnesses (k,) along the normals of planes, in N/m."""
        normals = self.strings.normals
        blocks = (normals[:, :, None] * normals[:, None]).reshape(len(normals), -1)[:, self._upper]
        return self._filled(self._rest_at, self._rest_mask * stiffness[:, None] * blocks)

    def of_bends(self) -> np.ndarray:
        """Return the matrix of the bending energy."""
        strings, found = self.strings, np.zeros((self.above + 1) * self.n)
        dim = len(self._axis)
        for a in range(3):
            for b in range(3):
                use = strings.bends[:, a] <= strings.bends[:, b]
                values = (strings.bending * strings.factors[:, a] * strings.factors[:, b])[use]
                rows = np.add.outer(strings.bends[use, a] * dim, self._axis)
                columns = np.add.outer(strings.bends[use, b] * dim, self._axis)
                at, mask = self._places(rows, columns, np.ones(dim))
                found += self._filled(at, mask * values[:, None])
        return found

    def factor(self, matrix: np.ndarray) -> np.ndarray:
        """Return the factor of a matrix. Raises LinAlgError where that is not positive definite."""
        found, minor = dpbtrf(matrix.reshape(self.above + 1, self.n), overwrite_ab=True)
        if minor:
            raise LinAlgError(f"the minor of order {minor} is not positive")
        return np.asarray(found)

    def solve(self, factor: np.ndarray, force: np.ndarray) -> np.ndarray:
        """Return (n, dim): displacements under forces (n, dim), by the factor of a matrix."""
        right = np.where(self.free, force.ravel(), 0.0)
        return np.asarray(dpbtrs(factor, right, overwrite_b=True)[0]).reshape(force.shape)


@dataclass
class _Step:
    """Changes of positions, multipliers and constraints: linear, and of links a square that is subtracted."""

    x: np.ndarray
    more: np.ndarray
    rate: np.ndarray
    square: np.ndarray


class _Search:
    """The state of the iteration: positions, and the value and multiplier of each constraint, of links before planes.

    Constraints are dimensionless, with heights over the mean length of links; multipliers have the unit of energy.
    gives: change of constraints by their multipliers.
    """

    def __init__(self, strings: Strings):
        self.strings, self.system = strings, _Banded(strings)
        self.scale = float(np.abs(strings.load).sum())
        self.constant = self.system.of_bends() + self.system.held
        self.unit = float(strings.length.mean())
        self._first, self._second = np.ascontiguousarray(strings.links.T)
        multiplied = np.concatenate([strings.links.T.ravel(), strings.resting])
        self._of_multipliers = _Scatter(multiplied, strings.r.shape)
        self._of_all = _Scatter(np.concatenate([multiplied, strings.bends.ravel()]), strings.r.shape)
        self._natural = strings.natural[:, None]
        self._bending = (strings.bending[:, None] * strings.factors)[:, :, None]
        self._square = strings.length**2
        self._isotropic = np.eye(strings.r.shape[1]) / self._square[:, None, None]
        self.n = n = len(strings.links)
        self.gives = np.concatenate([1 / (strings.length * strings.axial), strings.compliances / self.unit**2])
        self.r = strings.stretched_evenly(self.system)
        self.multiplier = np.concatenate([self.scale * strings.length,
                                          np.full(len(strings.resting), 0.1 * self.scale * self.unit)])
        self._look()
        least = np.where(np.arange(len(self.value)) < n, 1e-12, 1e-3)  # first multipliers open closed constraints
        closed = self.value <= 0
        self.multiplier[closed] += 1.5 * (least - self.value)[closed] / np.maximum(self.gives[closed], DIVISION_GUARD)
        self._look()

    def _look(self) -> None:
        strings = self.strings
        self.d = self.r[self._second] - self.r[self._first]
        self.along = self.d / self._square[:, None]
        self.value = np.concatenate([(1 - np.add.reduce(self.d * self.along, axis=1)) / 2,
                                     (self._along_normals(self.r) - strings.heights) / self.unit])
        self.value += self.gives * self.multiplier
        self.left = self._out_of_balance()

    def _along_normals(self, x: np.ndarray) -> np.ndarray:
        """Return the components of vectors at the resting nodes along the normals of their planes."""
        return np.asarray(np.add.reduce(x[self.strings.resting] * self.strings.normals, axis=1))

    def _out_of_balance(self) -> np.ndarray:
        """Return (n, dim): the residual forces in N; zero where a coordinate is fixed."""
        strings = self.strings
        curvature = np.add.reduce(strings.factors[:, :, None] * self.r[strings.bends], axis=1, keepdims=True)
        force = self._of_all.sums(*self._pulls(self.multiplier), -self._bending * (curvature - self._natural))
        force += strings.load
        force[strings.fixed] = 0.0
        return force

    def _pulls(self, multiplier: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the forces of multipliers: links pull at both nodes, planes push."""
        pull = multiplier[: self.n, None] * self.along
        return pull, -pull, (multiplier[self.n :] / self.unit)[:, None] * self.strings.normals

    def step(self) -> None:
        """Take a step of Mehrotra's method: the predicted step determines the distance from the constraints."""
        system, n = self.system, self.n
        soft = self.value + self.gives * self.multiplier
        stiff = self.multiplier / soft
        blocks = (self.multiplier[:n, None, None] * self._isotropic
                  + stiff[:n, None, None] * self.along[:, :, None] * self.along[:, None])
        matrix = self.constant + system.of_links(blocks)
        if len(stiff) > n:
            matrix += system.of_planes(stiff[n:] / self.unit**2)
        factor = system.factor(matrix)

        def towards(target: np.ndarray) -> _Step:
            own = target / soft
            x = system.solve(factor, self.left + self._of_multipliers.sums(*self._pulls(own)))
            apart = x[self._second] - x[self._first]
            rate = np.concatenate([-np.add.reduce(self.along * apart, axis=1), self._along_normals(x) / self.unit])
            more = own - stiff * rate
            rate += self.gives * more
            return _Step(x, more, rate, np.add.reduce(apart * apart, axis=1) / (2 * self._square))

        there = self.multiplier * self.value
        first, mean = towards(-there), self.mean()
        size = self._length(first)
        left_then = self.value + size * first.rate
        left_then[:n] -= size**2 * first.square
        rest = self._sum(self.multiplier + size * first.more, left_then)
        aim = mean * min(1.0, max(rest / (mean * len(there)), 0.0)) ** 3
        target = aim - there - first.more * first.rate
        target[:n] += self.multiplier[:n] * first.square
        step = towards(target)
        size = self._length(step)
        self.r, self.multiplier = self.r + size * step.x, self.multiplier + size * step.more
        self._look()

    def _length(self, step: _Step) -> float:
        """Return the fraction of a step that leaves constraints and multipliers positive; links have the square, too.
        """
        n = self.n
        far, closing = MAX_BOUNDARY_FRACTION * self.value, step.rate[:n]
        roots = np.maximum(np.sqrt(closing**2 + 4 * step.square * far[:n]) - closing, DIVISION_GUARD)
        parts = [2 * far[:n] / roots,
                 MAX_BOUNDARY_FRACTION * self.multiplier / np.maximum(-step.more, DIVISION_GUARD)]
        if len(far) > n:
            parts.append(far[n:] / np.maximum(-step.rate[n:], DIVISION_GUARD))
        return min(1.0, *(float(np.minimum.reduce(part, initial=1.0)) for part in parts))

    def _sum(self, multiplier: np.ndarray, value: np.ndarray) -> float:
        """Return the sum of constraints times multipliers, J."""
        n = self.n
        return float(multiplier[:n] @ value[:n] + multiplier[n:] @ value[n:])

    def mean(self) -> float:
        """Return the mean of constraints times multipliers, J."""
        return self._sum(self.multiplier, self.value) / len(self.value)

    def slack(self) -> np.ndarray:
        """Return the values of the links' constraints."""
        return self.value[: self.n]

    def shortest(self) -> float:
        """Return the smallest distance of a link's nodes over its length."""
        return float(np.sqrt((self.d * self.along).sum(axis=1).min()))

    def is_at_rest(self) -> bool:
        """Return whether forces balance, and slack links have no tension."""
        loose = np.maximum.reduce(self.multiplier[: self.n] * self.slack() / self.strings.length, initial=0.0)
        return bool(max(np.abs(self.left).max(), loose) < FORCE_TOLERANCE * self.scale)


def rest_of(strings: Strings) -> Rest | None:
    """Return strings at rest; None where nothing loads them, nothing holds them, or rest was not found."""
    if not np.abs(strings.load).sum() > 0:
        return None
    with np.errstate(all="ignore"):  # nodes that are free in a direction diverge, which the end of a step detects
        try:
            search = _Search(strings)
            for iteration in range(MAX_ITERATIONS):
                if search.is_at_rest():
                    return Rest(search.r, search.slack() < SLACK_TOLERANCE, search.shortest(), iteration)
                search.step()
                if not np.isfinite(search.mean()):
                    return None
        except (LinAlgError, OverflowError):  # Python floats overflow
            pass
    return None
