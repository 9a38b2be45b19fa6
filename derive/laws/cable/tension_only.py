"""Cable that resists stretching and gives way in compression: a rope, a chain, the wire of a dropper.

The force is EA strain in tension, and hardly any in compression. With a transition strain strain_t and
s = sqrt(strain^2 + strain_t^2), twice the energy per length over EA is

    strain^2 (rho + (1 - rho)/2 (1 + strain/(s + strain_t))),

which is nil at strain 0 and grows to both sides. Beyond a few transition strains the force is EA strain in tension, and
in compression rho EA strain, each less (1 - rho)/4 EA strain_t: the most that an ideal cable, of rho = 0, bears in
compression. Bending is that of the full law.

Damping is that of Kelvin and Voigt with the stiffness at the strain, the second derivative of the energy: a slack cable
is damped by the part rho. It never feeds energy, as the stiffness is nowhere negative: with u = strain/s it is
EA (rho + (1 - rho)/4 (1 + u)^2 (2 - u)).
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ...algebra.gram import Gram
from ...codegen.program import Program, jacobian
from ...spec import LawTraits
from .cable import Cable
from .damping import Share


def traits(strain: str, curvature: str) -> LawTraits:
    """Return the traits of the law with these measures; algorithmic dissipation has the stiffness of the full law."""
    return LawTraits("cable", strain, curvature, membrane="tension_only", relaxed_like=f"{strain}_exact")


class TensionOnlyCable(Cable):
    """The law over an element's strain vectors."""

    stiffness_units = "N, N m^2, 1, 1"
    stiffness_doc = "axial and bending stiffness EA, EI; part of EA that is left in compression; transition strain"

    def __init__(self, gram: Gram, strain: str, curvature: str):
        super().__init__(gram, strain, curvature)
        self.name += "_tension_only"
        self.doc += ", which gives way in compression"

    def twice_axial_energy(self, program: Program, tag: str, A: np.ndarray, stiffness: sp.Expr,
                           strain: sp.Expr) -> sp.Expr:
        """Return the energy of the module docstring, stiffness in place of EA."""
        lost = program.define_once("half_lost", (1 - A[2]) / 2)
        square = program.define_once("transition2", A[3] ** 2)
        smooth = program.define(f"smooth{tag}", sp.sqrt(strain**2 + square))
        inverse = program.define(f"inv_smooth{tag}", 1 / (smooth + A[3]))
        return stiffness * strain**2 * (A[2] + lost * (1 + strain * inverse))

    def stiffness_share(self, program: Program, A: np.ndarray) -> Share:
        """Return the function for the second and the third derivative of the energy by the strain over EA."""
        square = program.define_once("transition2", A[3] ** 2)
        quarter = program.define_once("quarter_lost", (1 - A[2]) / 4)

        def at(tag: str, r: np.ndarray) -> tuple[sp.Expr, sp.Expr]:
            strain = self._axial_strain(program, tag, program.define(f"a1{tag}", r.dot(r) - 1))
            smooth = program.define(f"smooth{tag}", sp.sqrt(strain**2 + square))
            u = program.define(f"u{tag}", strain * program.define(f"inv_smooth{tag}", 1 / smooth))
            share = program.define(f"share{tag}", A[2] + quarter * (1 + u) ** 2 * (2 - u))
            return share, jacobian(program, np.array([share]), [strain])[0, 0]

        return at
