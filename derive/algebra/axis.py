"""The centreline of an element, r(x) = r(x, 0, 0): its shape functions and vectors."""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..codegen.program import Program
from ..spec import COORDINATES, Element, l, x, y, z


class Axis:
    """Inputs l, x of a kernel at a point of the centreline, in a stage of their own."""

    def __init__(self, program: Program, element: Element):
        self.program, self.element = program, element
        self.length = program.input("l", (), "m", "length of the element")
        self.x = program.input("x", (), "m", "arc-length from the element's first node")
        program.stage("place on the centreline")
        self._inverse = program.define("inv_l", 1 / self.length)
        self._xi = program.define("xi", self.x * self._inverse)

    def coordinates(self) -> np.ndarray:
        """Declare the input e (vectors, dim) and return it."""
        return self.program.input("e", (self.element.n_vectors, self.element.dim), "m, 1", "nodal vectors e, eq 1")

    def shape(self, by: str = "") -> np.ndarray:
        """Return N_k(x, 0, 0), or derivatives there by the coordinates `by`: powers of l times polynomials in x/l."""
        return np.array([self._function(f"N{by}_{name}", sp.diff(f, *map(COORDINATES.get, by)) if by else f,
                                        name.count("x") - by.count("x"))
                         for name, f in zip(self.element.names, self.element.shape_functions, strict=True)])

    def _function(self, name: str, f: sp.Expr, power: int) -> sp.Expr:
        polynomial = sp.horner(sp.expand(f.subs({y: 0, z: 0, x: self._xi * l}) / l**power), self._xi)
        scale = self.length**power if power >= 0 else self._inverse**-power
        # apart from the power of l: derivatives by x are of the polynomial alone
        return self.program.define(name, scale * self.program.define(f"P{name[1:]}", polynomial))

    def vector(self, name: str, shape: np.ndarray, e: np.ndarray) -> np.ndarray:
        """Return the sum of shape functions times nodal vectors, with positions relative to the first node.

        Digits are kept far from the origin. Derivatives of the shape functions do not change.
        """
        return self.program.vector(name, shape.dot(e - np.outer(np.array(self.element.is_position, dtype=int), e[0])))
