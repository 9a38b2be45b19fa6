"""Shape functions of the centreline over a step, in which place and length may change: means and divided differences.

With means ~ and changes d, the place r = N(x; l) e has

    r_next - r = N~ de + (D_x dx + D_l dl) e~,   (r_next + r)/2 = N~ e~ + (D_x dx + D_l dl) de/4.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import sympy as sp

from ..codegen.program import Program
from ..spec import Element
from .axis import Axis
from .discrete_gradient import STATES, DiscreteGradient


class DiscreteShapes:
    """Shape functions at both ends of a step. `flows`: the length of the element changes, too."""

    def __init__(self, program: Program, element: Element, flows: bool, length: Sequence[sp.Expr] = (),
                 place: Sequence[sp.Expr] = ()):
        """Take length and place at both ends of the step, or declare inputs."""
        self.program, self.element, self.flows = program, element, flows
        self._law = Program("axis", "shape functions at one place", "")
        self._axis = Axis(self._law, element)
        self._shape = self._axis.shape()
        if not length:
            length = [program.input("l", (), "m", "length of the element")]
            length += [program.input("l_next", (), "m", "l at the end of the step") if flows else length[0]]
        self._pairs = {self._axis.length: tuple(length)}
        if not place:
            place = (program.input("x", (), "m", "arc-length from the element's first node"),
                     program.input("x_next", (), "m", "x at the end of the step"))
        self._pairs[self._axis.x] = tuple(place)

    def shapes(self) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        """Stage and return the means N~, and the divided differences by x, with the name "", and by l, "_l"."""
        p, names = self.program, self.element.names
        discrete = DiscreteGradient(p, self._law, self._pairs)
        p.stage("mean shape functions, and their divided differences")
        mean = np.array([p.define(f"mean_N_{node}", discrete.mean(n))
                         for node, n in zip(names, self._shape, strict=True)])
        by = {"": self._axis.x} | ({"_l": self._axis.length} if self.flows else {})
        found = [discrete.gradient(n, [*by.values()]) for n in self._shape]
        return mean, {tag: np.array([p.define(f"D{tag}_N_{node}", of[k])
                                     for node, of in zip(names, found, strict=True)])
                      for k, tag in enumerate(by)}


def middle_and_change(p: Program, element: Element, e: np.ndarray, e_next: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return means and changes of nodal vectors over a step, with positions relative to the first node."""
    first = np.array(element.is_position, dtype=int)
    now, then = (_named_rows(p, element, state, vectors - np.outer(first, vectors[0]))
                 for state, vectors in zip(STATES, (e, e_next), strict=True))
    return _named_rows(p, element, "mean", (now + then) / 2), _named_rows(p, element, "change", then - now)


def _named_rows(p: Program, element: Element, name: str, vectors: np.ndarray) -> np.ndarray:
    return np.array([p.vector(f"{name}_{node}", v) for node, v in zip(element.names, vectors, strict=True)])
