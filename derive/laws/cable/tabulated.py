"""Cable with an axial force that is a function of the strain by cubic segments, as of a rope on a test machine.

The energy per length is the integral of the force; bending is that of the full law. Damping and algorithmic dissipation
are those of the full law with EA, the first constant.
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ...algebra.gram import Gram
from ...codegen.piecewise import SEGMENT, CubicIntegral
from ...codegen.program import Program
from ...spec import MAX_SEGMENTS, LawTraits
from .cable import Cable

TABLE = 2
"""Where the segments begin among the constants."""


def traits(strain: str, curvature: str) -> LawTraits:
    """Return the traits of the law with these measures; it is damped like the full law."""
    return LawTraits("cable", strain, curvature, membrane="tabulated", damped_like=f"{strain}_exact")


class TabulatedCable(Cable):
    """The law over an element's strain vectors."""

    axial_name = "length"
    stiffness_units = "N, N m^2, 1, then 1, N, N, N, N, N a segment"
    stiffness_doc = ("axial stiffness EA of damping, bending stiffness EI; segments, and of each the strain at its "
                     "start, energy per length, force, slope, and the factors of the square and of the cube there")

    def __init__(self, gram: Gram, strain: str, curvature: str):
        super().__init__(gram, strain, curvature)
        self.name += "_tabulated"
        self.doc += ", the axial force by cubic segments"

    def _stiffness(self, program: Program, name: str) -> np.ndarray:
        return program.input(name, TABLE + 1 + SEGMENT * MAX_SEGMENTS, self.stiffness_units, self.stiffness_doc)

    def axial_factor(self, A: np.ndarray) -> sp.Expr:
        """Return 1: the energy itself is tabulated."""
        return sp.S.One

    def twice_axial_energy(self, program: Program, tag: str, A: np.ndarray, stiffness: sp.Expr,
                           strain: sp.Expr) -> sp.Expr:
        """Return twice the integral of the force, times the factor that `stiffness` is."""
        return 2 * stiffness * program.define(f"W{tag}", CubicIntegral(A[TABLE], strain))
