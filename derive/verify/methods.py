"""A relation between a kernel's output and a derivative along a path, and the four methods that check it.

rounding       the output in C against the same expression at 50 digits
50 digits      the output in C against differences at 50 digits of what it is the derivative of
complex step   ... against Im F(ih)/h, h = 1e-30, in C; second derivatives by Cauchy's integral on a circle, its radius
               by a study that does not see the output
central        ... against five-point central differences in C, the step by such a study
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import mpmath
import numpy as np

from .numbers import Numbers, State

METHODS = ("rounding", "50 digits", "complex step", "central")
# What each method can give, by (method, order of derivative): some times the worst seen, as compilers differ.
CEILINGS = {
    ("rounding", 0): 5e-15, ("rounding", 1): 5e-15, ("rounding", 2): 1e-14,
    ("50 digits", 0): 5e-15, ("50 digits", 1): 5e-15, ("50 digits", 2): 1e-14,
    ("complex step", 1): 2e-14, ("complex step", 2): 5e-12,
    ("central", 1): 1e-10, ("central", 2): 5e-8,
}
ZERO_SCALE = 1e-20  # far below any output of a sample, far above differences of zero at 50 digits
_FIRST = ((-2, 1 / 12), (-1, -8 / 12), (1, 8 / 12), (2, -1 / 12))
_SECOND = ((-2, -1 / 12), (-1, 16 / 12), (0, -30 / 12), (1, 16 / 12), (2, -1 / 12))
_STEPS = tuple(10.0**-k for k in np.arange(1.5, 5.1, 0.5))
_RADII, _ON_CIRCLE = (0.03, 0.01, 0.003, 0.001), 24


@dataclass(frozen=True)
class Relation:
    """`output` of `kernel` is the derivative of order `order` at t = 0 of path(numbers, state, t, j), j = 0 ... n-1.

    Order 0 is a plain equality with the path's value, known at 50 digits only. The n derivatives stand along the
    last axis. `of` replaces the output where the relation is about something made of it.
    """

    kernel: str
    output: str
    text: str
    order: int
    path: Callable[[Numbers, State, object, int], object] | None
    n: int = 1
    of: Callable[[Numbers, State], object] | None = None

    def value(self, numbers: Numbers, state: State) -> np.ndarray:
        """Return what is verified, flat."""
        value = self.of(numbers, state) if self.of else numbers(self.kernel, state)[self.output]
        return np.asarray(value).ravel()

    def along(self, numbers: Numbers, state: State, t: Any) -> np.ndarray:
        """Return the paths' values at t -> (any, n)."""
        assert self.path is not None  # None only in findings from another process
        return np.stack([np.asarray(self.path(numbers, state, t, j)).ravel() for j in range(self.n)], axis=-1)


@dataclass
class Finding:
    """The worst error of a relation over all states, by method, relative to the largest entry of the output."""

    kernel: str
    relation: Relation
    errors: dict[str, float] = field(default_factory=dict)
    samples: dict[str, list[tuple[int, float, float]]] = field(default_factory=dict)
    shape: tuple[int, ...] | None = None  # of the output; None where the relation is about something made of it
    step: float | None = None

    def ceiling(self, method: str) -> float:
        """Return the error that a method may show here."""
        return CEILINGS[method, self.relation.order]

    @property
    def failed(self) -> list[str]:
        """Return the methods whose error is above its ceiling, or not a number."""
        return [m for m, error in self.errors.items() if not error <= self.ceiling(m)]

    def plain(self) -> Finding:
        """Return the same without the functions, which do not pass between processes."""
        return replace(self, relation=replace(self.relation, path=None, of=None))

    @property
    def worst_entry(self) -> int:
        """Return the entry of the worst error by the first method that failed, else at 50 digits."""
        return self.samples[(self.failed or ["50 digits"])[0]][0][0]

    def place(self, entry: int) -> str:
        """Return the name of an entry of the output, such as K[3, 17]."""
        if self.shape is None:
            return f"of {self.relation.output}"
        return f"{self.relation.output}[{', '.join(str(int(i)) for i in np.unravel_index(entry, self.shape))}]"

    def take(self, method: str, analytic: np.ndarray, other: np.ndarray, scale: float) -> None:
        """Compare; keep the worst error and the entries where it is worst."""
        difference = np.abs(analytic - other) / scale
        difference = np.where(np.isfinite(difference), difference, np.inf)
        error = float(difference.max())
        if error > self.errors.get(method, -1.0):
            self.errors[method] = error
            self.samples[method] = [(int(k), analytic[k], other[k]) for k in np.argsort(-difference)[:5]]


def examine(kernel: str, relation: Relation, kinds: dict[str, Numbers], states: list[State]) -> Finding:
    """Try a relation by every method that its order allows."""
    shapes = {a.name: a.shape for a in kinds["exact"].programs[relation.kernel].outputs}
    finding = Finding(kernel, relation, shape=None if relation.of else shapes[relation.output])
    for values in states:
        real, exact = kinds["real"], kinds["exact"]
        analytic = relation.value(real, real.state(values))
        s = exact.state(values)
        truth = _exact(relation, exact, s)
        scale = float(np.abs(truth).max())
        scale = scale if scale > ZERO_SCALE else 1.0  # the samples are of order one
        finding.take("rounding", analytic, relation.value(exact, s).astype(float), scale)
        finding.take("50 digits", analytic, truth, scale)
        if relation.order:
            finding.take("complex step", analytic, _complex(relation, kinds["complex"], values), scale)
            central, step = _central(relation, real, values)
            finding.take("central", analytic, central, scale)
            finding.step = step if finding.step is None else max(step, finding.step)
    return finding


def _exact(relation: Relation, exact: Numbers, s: State) -> np.ndarray:
    if relation.order == 0:
        return relation.along(exact, s, mpmath.mpf(0)).ravel().astype(float)
    h = mpmath.mpf(10) ** (-16 if relation.order == 1 else -12)
    after, before = relation.along(exact, s, h), relation.along(exact, s, -h)
    if relation.order == 1:
        return np.asarray(((after - before) / (2 * h)).ravel().astype(float))
    return np.asarray(((after - 2 * relation.along(exact, s, mpmath.mpf(0)) + before) / h**2).ravel().astype(float))


def _complex(relation: Relation, numbers: Numbers, values: State) -> np.ndarray:
    s = numbers.state(values)
    if relation.order == 1:
        return (relation.along(numbers, s, 1e-30j).imag / 1e-30).ravel()
    turns = [np.exp(2j * math.pi * k / _ON_CIRCLE) for k in range(_ON_CIRCLE)]
    tried = [2 * sum(relation.along(numbers, s, radius * turn) / turn**2 for turn in turns).real.ravel()
             / _ON_CIRCLE / radius**2 for radius in _RADII]
    return np.asarray(tried[_least_change(tried)])


def _central(relation: Relation, numbers: Numbers, values: State) -> tuple[np.ndarray, float]:
    """Return the difference that changes least from its neighbour's step, and that step."""
    s = numbers.state(values)
    weights = _FIRST if relation.order == 1 else _SECOND
    tried = [np.asarray(sum(w * relation.along(numbers, s, k * h) for k, w in weights)).ravel() / h**relation.order
             for h in _STEPS]
    best = _least_change(tried)
    return tried[best], _STEPS[best]


def _least_change(tried: list[np.ndarray]) -> int:
    """Return which of a sequence changes least to the next."""
    return int(np.argmin([float(np.abs(a - b).max()) for a, b in pairwise(tried)]))
