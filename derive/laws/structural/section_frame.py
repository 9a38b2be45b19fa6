"""The frame of a section from its directors, and how it turns: t2 along r_y, t3 in the plane of both, t1 = t2 x t3.

Planar elements are the spatial ones with r_z = t3 = (0, 0, 1): every vector here has three components, and what stays
in the plane drops out of the expressions by itself.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sp

from ...algebra.tangent_frame import cross
from ...codegen.program import Program


def turned(k: int, values: np.ndarray) -> np.ndarray:
    """Return the rates under a unit spin about axis k: of the frame's vectors, or of components along them of a fixed
    vector.
    """
    rate = np.zeros_like(values) + sp.S.Zero
    i, j = (k + 1) % 3, (k + 2) % 3
    rate[i], rate[j] = values[j], -values[i]
    return np.asarray(rate)


class SectionFrame:
    """t (3, 3), its rows t1, t2, t3; y = a t2, z = b t2 + c t3."""

    def __init__(self, program: Program, tag: str, y: np.ndarray, z: np.ndarray):
        self.y, self.z = y, z
        self.inverse_a = program.define(f"inv_a{tag}", 1 / program.define(f"a{tag}", sp.sqrt(y.dot(y))))
        t2 = program.vector(f"t2_{tag}", self.inverse_a * y)
        self.b = program.define(f"b{tag}", z.dot(t2))
        off = program.vector(f"off{tag}", z - self.b * t2)
        self.c = program.define(f"c{tag}", sp.sqrt(off.dot(off)))
        self.inverse_c = program.define(f"inv_c{tag}", 1 / self.c)
        t3 = program.vector(f"t3_{tag}", self.inverse_c * off)
        self.t = np.array([program.vector(f"t1_{tag}", cross(t2, t3)), t2, t3])
        self.slant = program.define(f"slant{tag}", self.b * self.inverse_c)

    def spin(self, dy: np.ndarray, dz: np.ndarray) -> np.ndarray:
        """Return the components in the frame of its spin, when the directors move: from dt2 = spin x t2 and z.t1 = 0.
        """
        t1, _, t3 = self.t
        about1, about3 = self.inverse_a * t3.dot(dy), -self.inverse_a * t1.dot(dy)
        return np.array([about1, self.inverse_c * t1.dot(dz) + self.slant * about3, about3])

    def forces(self, program: Program, tag: str, moment: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the forces on y and z that do the work of a moment, its components in the frame, on every spin."""
        t1, _, t3 = self.t
        along1 = program.define(f"y1_{tag}", -self.inverse_a * (moment[2] + self.slant * moment[1]))
        along3 = program.define(f"y3_{tag}", self.inverse_a * moment[0])
        return along1 * t1 + along3 * t3, program.define(f"z1_{tag}", self.inverse_c * moment[1]) * t1

    def rates(self, spin: np.ndarray | list[Any], dy: np.ndarray, dz: np.ndarray) -> dict[sp.Symbol, sp.Expr]:
        """Return the rates of everything named here, when the directors move."""
        _, t2, t3 = self.t
        db, dc = dz.dot(t2) + self.c * spin[0], dz.dot(t3) - self.b * spin[0]
        turn = sum((spin[k] * turned(k, self.t) for k in range(3)), np.zeros((3, 3), dtype=object))
        values = {self.inverse_a: -self.inverse_a**2 * t2.dot(dy), self.b: db, self.c: dc,
                  self.inverse_c: -self.inverse_c**2 * dc,
                  self.slant: self.inverse_c * (db - self.slant * dc)}
        values |= zip(self.t.ravel(), turn.ravel(), strict=True)
        return {s: sp.sympify(rate) for s, rate in values.items() if sp.sympify(s).is_Symbol}
