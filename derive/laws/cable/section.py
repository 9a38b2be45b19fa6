"""Force and moment resultants of a cable at a point of its axis, from the energy W(r', r'') per length.

A virtual displacement does the work W_r'.dr' + W_r''.dr''; by parts, what passes through a section is the force
W_r' - (W_r'')' on its position and W_r'' on its slope, whose part across the tangent is the moment r' x W_r''. With the
linear curvature W_r'' also has a part along the tangent, which no moment stands for.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import sympy as sp

from ...algebra.gram_point import axis
from ...algebra.tangent_frame import cross, spatial
from ...codegen.program import DirectionalDerivative, Program, jacobian


def resultants(law: Any, program: Program, S: np.ndarray, c: np.ndarray, X: sp.Expr, w: sp.Expr,
               c0: np.ndarray | None = None) -> tuple[Any, ...]:
    """Return force and moment in space, and strain; c0 of the stress-free shape where it is curved."""
    program.stage("derivatives of the axis by x")
    r = [program.vector(f"r{order}", axis(law.gram, c, X, w, order)) for order in (1, 2, 3)]
    along = _along_x(r)
    program.stage("energy per length through its invariants")
    a1, b, squared = (program.define(name, value) for name, value in
                      (("a1", r[0].dot(r[0]) - 1), ("b", r[0].dot(r[1])), ("c", r[1].dot(r[1]))))
    kappa0 = sp.S.Zero
    if c0 is None:
        at_point, k2, scale = law.measures(program, "", (a1, b, squared))
        axial, constant, strain = law.membrane(program, S, c, X, at_point)
        density = axial + S[1] * k2 / 2
    else:
        r0 = [program.vector(f"r0{order}", axis(law.gram, c0, X, w, order)) for order in (1, 2, 3)]
        along |= _along_x(r0)
        reference = law.reference(program, "", r0[0], r0[1], law.floor * (2 * w) ** 2)
        density, strain, scale = law.curved_density(program, "", *S, (a1, b, squared), reference)
        constant = []
        kappa0 = _size(program, "0", program.vector("n0", cross(spatial(r0[0]), spatial(r0[1]))), reference.inverse**3)
    W = jacobian(program, np.array([density]), [a1, b, squared], constant)[0]
    by_a, by_b, by_c = (program.define(f"W_{name}", value) for name, value in zip("abc", W, strict=True))
    program.stage("forces on r' and r''")
    slope = program.vector("slope", by_b * r[0] + 2 * by_c * r[1])
    change = DirectionalDerivative(program, "dx", along).array(slope)
    force = 2 * by_a * r[0] + by_b * r[1] - change
    program.stage("moment and curvature")
    normal = program.vector("n", cross(spatial(r[0]), spatial(r[1])))
    kappa = sp.sqrt(squared) if scale is None else _size(program, "", normal, scale)
    return spatial(force), 2 * by_c * normal, [strain, 0, 0, 0, 0, kappa - kappa0]


def _along_x(r: list[np.ndarray]) -> dict[sp.Symbol, sp.Expr]:
    """Return the derivatives by x of r', r''; r''' is not asked for."""
    along = {s: 0 for s in r[2] if s.is_Symbol}
    return along | {s: v for near, far in pairwise(r) for s, v in zip(near, far, strict=True)}


def _size(program: Program, tag: str, normal: np.ndarray, scale: sp.Expr) -> sp.Expr:
    """Return the curvature from r' x r'': a sum of squares, never below zero by rounding."""
    return sp.sqrt(program.define(f"size2{tag}", normal.dot(normal) * scale))
