"""Working curves of a rope: its axial force below the highest strain H that it has had, at a point.

On first loading the force is a table of the strain, N_0(e), the law of the cable. Below H the rope unloads and reloads
along a curve of a given shape g(x), g(0) = 0, g(1) = 1, from a permanent strain p H to the point (H, N_0(H)):

    W(e; H) = N_0(H) g(x),   x = (e - p H)/((1 - p) H).

The coupling adds n = W - N_0 to the law of the cable. Its stored energy U has n = dU/de; the loss of first loading is
minus U at e = H.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sp

from ..codegen.family import CouplingFamily
from ..codegen.piecewise import SEGMENT, CubicIntegral, CubicValue
from ..codegen.program import DirectionalDerivative, Program, jacobian
from ..spec import MAX_SEGMENTS

WORKING_CURVES = {3: "working_curve", 2: "planar_working_curve"}
SOURCE = "Falkenberg, Åhjem & Yang, OTC-27761-MS (2017)"
TABLE = 1 + SEGMENT * MAX_SEGMENTS
"""Numbers of a table (codegen/piecewise.py)."""


def families() -> list[CouplingFamily]:
    """Return the families in space and in the plane."""
    return CouplingFamily.each("working_curve", "working curves of a rope", WORKING_CURVES, build)


def build(dim: int) -> list[Program]:
    """Return the kernels in space or in the plane."""
    return [measure(dim), change(dim), force(dim), tangent(dim)]


def _strain(dim: int, kernel: str, doc: str) -> tuple[Program, np.ndarray, sp.Expr]:
    """Return a program, its input r', and the strain."""
    p = Program(f"{WORKING_CURVES[dim]}_{kernel}", doc, SOURCE)
    a = p.input("a", dim, "1", "slope r'")
    p.stage("strain")
    over = p.define("over", a.dot(a) - 1)
    length = p.define("length", sp.sqrt(1 + over))
    return p, a, p.define("strain", over / (1 + length), derivative_of=length)


def measure(dim: int) -> Program:
    """Return the kernel of the strain."""
    p, _, strain = _strain(dim, "measure", "strain of a point")
    p.output("e", strain, "1", "strain |r'| - 1")
    return p


def change(dim: int) -> Program:
    """Return the kernel of the force along a working curve, less that of first loading."""
    p = Program(f"{WORKING_CURVES[dim]}_change", "force along a working curve less that of first loading", SOURCE)
    e = p.input("e", (), "1", "strain, at most the highest one")
    highest = p.input("highest", (), "1", "highest strain so far, positive")
    permanent = p.input("permanent", (), "1", "permanent strain by the highest one")
    first = p.input("first", TABLE, "1, then 1, N, N, N, N, N a segment", "force of first loading by strain")
    shape = p.input("shape", TABLE, "1", "share of the force at the highest strain by the share x of the way to it")
    p.stage("shares of the strain and of the force")
    reach = p.define("reach", (1 - permanent) * highest)
    top = p.define("top", CubicValue(first[0], highest))
    x = p.define("x", (e - permanent * highest) / reach)
    p.stage("stored energy and force")
    stored = p.define("stored", reach * top * CubicIntegral(shape[0], x) - CubicIntegral(first[0], e))
    n = p.define("change", top * CubicValue(shape[0], x) - CubicValue(first[0], e))
    p.output("n", n, "N", "change of the force")
    p.output("D", jacobian(p, np.array([n]), np.array([e])).item(), "N", "its derivative by e")
    p.output("U", stored, "N", "energy per length, J/m")
    return p


def force(dim: int) -> Program:
    """Return the kernel of the force on r' of an axial force."""
    p, a, strain = _strain(dim, "force", "force of an axial force on the slope")
    n = p.input("n", (), "N", "axial force")
    p.stage("force")
    p.output("g", n * jacobian(p, np.array([strain]), a)[0], "N", "derivative of n e by r'")
    return p


def tangent(dim: int) -> Program:
    """Return the kernel of the derivatives of this force, with the axial force that depends on the strain."""
    p, a, strain = _strain(dim, "tangent", "derivatives of the force by the slope")
    n, D = p.input("n", (), "N", "axial force"), p.input("D", (), "N", "derivative of n by e")
    p.stage("derivatives of the strain")
    J: Any = jacobian(p, np.array([strain]), a)[0]
    J = np.array([p.define(f"e_{k}", J[k]) for k in range(dim)])
    p.stage("second derivatives of n e")
    second = [DirectionalDerivative(p, f"d{j}", dict.fromkeys(a, 0) | {symbol: 1}).array(n * J)
              for j, symbol in enumerate(a)]
    p.output("K", D * np.outer(J, J) + np.stack(second, axis=-1), "N", "derivatives of g by r'")
    return p
