"""Coulomb friction with stick, by a spring along the contact.

In stick the spring is elastic. In sliding its stretch is the one at which its force is the friction (return mapping,
Wriggers, Computational Contact Mechanics, 2nd ed. 2006, section 5.2). The stretch is that of a point from its anchor on
a surface, or of the particles of two lines that have met.
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..codegen.program import Program


def sticking_force(p: Program, stretch: np.ndarray, stiffness: sp.Expr) -> np.ndarray:
    """Return the force of the spring while it sticks, against the stretch."""
    return p.vector("F", -stiffness * stretch)


def sliding_force(p: Program, stretch: np.ndarray, most: sp.Expr) -> np.ndarray:
    """Return the force of the spring while it slides: friction of the size ``most``, against the stretch."""
    return sliding_force_at(p, stretch, most, p.define("size", sp.sqrt(stretch.dot(stretch))))


def sliding_force_at(p: Program, stretch: np.ndarray, most: sp.Expr, size: sp.Symbol) -> np.ndarray:
    """Return the force of the size ``most`` times the stretch over ``size``, against the stretch."""
    inverse = p.define("inv_size", 1 / size)
    return p.vector("F", -most * inverse * stretch)
