"""Rounding of every kernel in C against 50 digits, in units of what its conditioning allows.

The kernel and the 50-digit program get the same doubles. An entry y_i of an output is allowed what rounding once each
input and the result may change it by,

    u (sum_j |dy_i/dx_j| |x_j| + |y_i|),   u = 2^-53,

dy/dx by complex step. One unit is the error of exact arithmetic on rounded inputs. Coordinates of
positions count here by their size near the origin: far from it their differences are as exact, and a kernel must not
lose digits there.

`entry` is the worst over single entries. It is hard on entries in which the contributions of quadrature points or of
the axes of a frame cancel; `norm`, the largest error of an output over the largest that is allowed in it, is the
error for its user.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import mpmath
import numpy as np

from ..codegen.family import Family
from ..codegen.program import Program
from .inputs import Input, inputs
from .numbers import EPS, Numbers, State

STEP = 1e-30
# Three times the worst seen on ten times as many inputs as are tried here: 20 by entry and 10 by output, both on the
# quintic cable (stiffness summed over quadrature points; shape functions by Horner's rule). Digits lost to a formula
# show as thousands and more.
ENTRY, NORM = 64.0, 32.0


@dataclass(frozen=True)
class Rounding:
    """Worst rounding of a kernel on inputs of one kind, and the entry where it is worst."""

    kernel: str
    kind: str
    entry: float
    norm: float
    place: str = ""
    computed: float = 0.0
    error: float = 0.0

    @property
    def failed(self) -> bool:
        """Return whether it is above a ceiling, or not a number."""
        return not (self.entry <= ENTRY and self.norm <= NORM)


def roundings(family: Family, kinds: dict[str, Numbers], samples: list[State]) -> Iterator[Rounding]:
    """Yield the worst of each kernel by kind of input; kinds that make no difference to a kernel are left out."""
    every = list(inputs(family, samples))
    for kernel, program in kinds["exact"].programs.items():
        arguments = {a.name for a in program.inputs}
        worst: dict[str, Rounding] = {}
        for given, sample in every:
            if given.kind == "ordinary" or arguments & given.changed(sample):
                found = measure(program, kernel, kinds, given)
                last = worst.get(given.kind, found)
                by_entry = max(last, found, key=lambda r: r.entry)
                worst[given.kind] = Rounding(found.kernel, given.kind, by_entry.entry, max(last.norm, found.norm),
                                             by_entry.place, by_entry.computed, by_entry.error)
        yield from worst.values()


def measure(program: Program, kernel: str, kinds: dict[str, Numbers], given: Input) -> Rounding:
    """Return the rounding of a kernel at one input."""
    real, exact = kinds["real"], kinds["exact"]
    computed, truth = real(kernel, real.state(given.state)), exact(kernel, exact.state(given.state))
    allowed = _allowed(program, kernel, kinds["complex"], given)
    entry, norm, where = 0.0, 0.0, ("", 0.0, 0.0)
    for output in program.outputs:
        value = computed[output.name].ravel()
        error = np.array([_distance(v, t) for v, t in zip(value, truth[output.name].ravel(), strict=True)])
        unit = EPS / 2 * (allowed[output.name].ravel() + np.abs(value))
        multiples = np.where(error == 0, 0.0, error / np.where(unit > 0, unit, np.finfo(float).tiny))
        worst = int(np.argmax(multiples))
        if multiples[worst] >= entry:
            at = ", ".join(str(int(i)) for i in np.unravel_index(worst, output.shape))
            entry, where = float(multiples[worst]), (f"{output.name}[{at}]", float(value[worst]), float(error[worst]))
        if error.any():
            norm = max(norm, float(error.max() / unit.max()) if unit.max() > 0 else np.inf)
    return Rounding(program.name, given.kind, entry, norm, *where)


def _distance(computed: float, truth: mpmath.mpf) -> float:
    return float(abs(mpmath.mpf(float(computed)) - truth)) if np.isfinite(computed) else np.inf


def _allowed(program: Program, kernel: str, complex_: Numbers, given: Input) -> dict[str, np.ndarray]:
    """Return sum_j |dy/dx_j| |x_j| for every output."""
    state = complex_.state(given.state)
    total = {a.name: np.zeros(a.shape) for a in program.outputs}
    for argument in program.inputs:
        sizes = np.abs(np.asarray(given.sizes[argument.name], dtype=float)).ravel()
        for j in np.flatnonzero(sizes):
            moved = state[argument.name].copy().reshape(-1)
            moved[j] += 1j * STEP
            for name, value in complex_(kernel, state, **{argument.name: moved}).items():
                total[name] += np.abs(value.imag) / STEP * sizes[j]
    return total
