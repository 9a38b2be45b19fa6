"""Force and moment resultants of a cable at a point of its axis, from the energy W(r', r'') per length.

A virtual displacement does the work W_r'.dr' + W_r''.dr''; by parts, what passes through a section is the force
W_r' - (W_r'')' on its position and W_r'' on its slope, whose part across the tangent is the moment r' x W_r''. With the
linear curvature W_r'' also has a part along the tangent, which no moment stands for.
"""

from __future__ import annotations

import numpy as np
import sympy as sp
from funicular.derive.frames import cross, spatial
from funicular.derive.gram_point import axis
from funicular.derive.stages import Derivation, Program, jacobian


def resultants(law, program: Program, S: np.ndarray, c: np.ndarray, X: sp.Expr, w: sp.Expr) -> tuple:
    """Stages: force and moment in space, and strain."""
    program.stage("derivatives of the axis by x")
    r1, r2, r3 = (program.vector(f"r{order}", axis(law.gram, c, X, w, order)) for order in (1, 2, 3))
    program.stage("energy per length through its invariants")
    a1 = program.define("a1", r1.dot(r1) - 1)
    b, squared = program.define("b", r1.dot(r2)), program.define("c", r2.dot(r2))
    strain, k2, scale = law.measures(program, "", a1, b, squared)
    W = jacobian(program, np.array([S[0] * strain**2 / 2 + S[1] * k2 / 2]), [a1, b, squared])[0]
    by_a, by_b, by_c = (program.define(f"W_{name}", value) for name, value in zip("abc", W, strict=True))
    program.stage("forces on r' and r''")
    slope = program.vector("slope", by_b * r1 + 2 * by_c * r2)
    along = {s: v for near, far in ((r1, r2), (r2, r3)) for s, v in zip(near, far, strict=True)}
    change = Derivation(program, "dx", along | {s: 0 for s in r3 if s not in along}).array(slope)
    force = 2 * by_a * r1 + by_b * r2 - change
    program.stage("moment and curvature")
    normal = program.vector("n", cross(spatial(r1), spatial(r2)))
    kappa2 = k2 if scale is None else normal.dot(normal) * scale
    return spatial(force), 2 * by_c * normal, [strain, 0, 0, 0, 0, sp.sqrt(program.define("kappa2", kappa2))]
