"""Cable with a curved stress-free shape e0: strain and curvature are measured along r0 and against its curvature.

ds0 = |r0'| dx; the strain is Green's or the engineering one of |r'|/|r0'|; the bending energy is
1/2 EI (kappa - kappa0)^2 with the sizes of the curvatures: a cable has no material frame. It is a rod without torsional
stiffness, whose sections turn about the tangent until the curvature points where kappa0 does; the energy is the least
over these turns. Hence
- in the plane of a curved shape it is a curved rod, as long as its curvature keeps its side;
- across that plane tension alone resists: bending there keeps the size of the curvature to first order, and a ring may
  become any curve of the same curvature. A line that holds its shape in space is a beam;
- where the cable is straight the energy has a kink, for the curvature may leave to any side. It is rounded within
  kappa < kappa0/1000, which takes 1e-6 off the bending stiffness elsewhere.
A kappa0 below 2e-6/l is none: the straight law.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import astuple, dataclass
from typing import Any

import numpy as np
import sympy as sp

from ...codegen.program import Program
from ...spec import LawTraits
from .. import stress_free
from .cable import Cable, Term

CURVATURE_TOLERANCE = sp.Rational(1, 10**6)  # squared, of kappa0
MIN_CURVATURE = sp.Rational(1, 10**12)  # squared, of 2/l: below it, a curvature of the stress-free shape is none


@dataclass(frozen=True)
class Reference:
    """The data of the stress-free shape at a point: |r0'|, 1/r0'.r0', kappa0^2, the square that rounds the kink, the
    rounded kappa0, and its remainder where the shape is straight.
    """

    stretch: sp.Expr
    inverse: sp.Expr
    kappa2: sp.Expr
    rounding: sp.Expr
    kappa: sp.Expr
    straight: sp.Expr


N_REFERENCE = 6


def traits(strain: str, curvature: str) -> LawTraits:
    """Return the traits of the law with these measures; it is damped like the law for a straight shape."""
    straight = f"{strain}_{curvature}"
    return LawTraits("cable", strain, curvature, "full", straight, takes_shape=True, damped_like=straight)


class CurvedCable(Cable):
    """The law with e0; the damping is that of the straight law."""

    floor = MIN_CURVATURE

    def __init__(self, gram: Any, strain: str, curvature: str):
        super().__init__(gram, strain, curvature)
        self.name += "_curved"
        self.doc += ", its stress-free shape curved"

    def _size(self) -> int:
        return 2 + N_REFERENCE * len(self.bending_points)

    def constants(self, program: Program) -> np.ndarray:
        """Declare the input A: EA, EI, and six numbers of the stress-free shape for each Gauss point; return it."""
        return program.input("A", self._size(), "N, N m^2, 1", "EA, EI, and the stress-free shape at each Gauss point")

    def set_up(self, program: Program) -> None:
        """Declare the inputs l, e0 and S, and the output A."""
        length = program.input("l", (), "m", "length of the element")
        e0 = stress_free.shape(program, self.gram.element)
        S = self.section_stiffness(program)
        program.stage("stress-free shape at the quadrature points")
        c = self.gram.differences(program, e0, program.define("w", 1 / length))
        found = list(S)
        for g, point in enumerate(self.bending_points):
            r1, r2 = (program.vector(f"r{k}_{g}", sum(f * v for f, v in zip(series, c, strict=True)))
                      for k, series in ((1, point.value), (2, point.slope)))
            found += astuple(self.reference(program, f"_{g}", r1, r2, MIN_CURVATURE))
        program.output("A", found, "N, N m^2, 1", "EA, EI, and the stress-free shape at each Gauss point")

    def reference(self, program: Program, tag: str, r1: np.ndarray, r2: np.ndarray, floor: sp.Expr) -> Reference:
        """Return the reference from r0' and r0''; floor is MIN_CURVATURE in the units of r0''."""
        a, b, c = (program.define(f"{name}0{tag}", value) for name, value in
                   (("a", r1.dot(r1)), ("b", r1.dot(r2)), ("c", r2.dot(r2))))
        inverse = program.define(f"inv_a0{tag}", 1 / a)
        k2 = program.define(f"k02{tag}", (a * c - b * b) * inverse**3)
        rounding = program.define(f"round{tag}", CURVATURE_TOLERANCE * k2 + floor)
        kappa = program.define(f"k0{tag}", sp.sqrt(k2 + rounding))
        none = program.define(f"none{tag}", 1 / (k2**2 + floor**2))
        return Reference(program.define(f"j0{tag}", sp.sqrt(a)), inverse, k2, rounding, kappa,
                         program.define(f"k0_none{tag}", floor**2 * none * kappa))

    def _terms(self, program: Program, A: np.ndarray, c: np.ndarray, w: sp.Expr) -> Iterator[Term]:
        """Yield the energy point by point."""
        program.stage("strain at the quadrature points")
        EA, EI = program.define("EA_l", A[0] / (2 * w)), program.define("EI_l", 2 * A[1] * w)
        points = self.bending_points
        for g, (invariants, *vectors) in enumerate(self._at_points(program, "", "abc", points, c)):
            at = Reference(*A[2 + N_REFERENCE * g : 2 + N_REFERENCE * (g + 1)])
            density, _, _ = self.curved_density(program, f"_{g}", EA, EI, invariants, at)
            yield Term("abc", 2 * points[g].weight * density, invariants, *vectors)

    def curved_density(self, program: Program, tag: str, EA: sp.Expr, EI: sp.Expr, invariants: Any,
                       at: Reference) -> tuple[Any, ...]:
        """Return energy per x, axial strain, and what leads from |r' x r''|^2 to the squared curvature."""
        a1, b, c = invariants
        relative = program.define(f"a1r{tag}", a1 * at.inverse + (at.inverse - 1))  # r'.r' / r0'.r0' - 1
        strain = self._axial_strain(program, tag, relative)
        inverse = program.define(f"inv_a{tag}", at.inverse / (1 + relative))
        scale = program.define(f"scale{tag}", inverse**3 if self.strain == "green" else at.inverse * inverse**2)
        k2 = program.define(f"k2{tag}", ((1 + a1) * c - b * b) * scale)
        kappa = program.define(f"kappa{tag}", sp.sqrt(k2 + at.rounding))
        change = program.define(f"dk{tag}", (k2 - at.kappa2) / (kappa + at.kappa), derivative_of=kappa - at.kappa)
        return at.stretch * (EA * strain**2 / 2 + EI * change * (change / 2 + at.straight)), strain, scale
