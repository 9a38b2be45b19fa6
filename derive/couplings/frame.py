"""The frame of two vectors, [i j k] of eq 18: its attitude, its turn, and the force of a moment on it.

With r_x and a director (eq 13-17) it follows the tangent, with r_y and r_z the cross-section, whose normal is k x j.
The inputs are vectors; the engine applies the chain rule through the shape functions to the coordinates.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..algebra.tangent_frame import cross, tangent_frame, turning
from ..codegen.family import CouplingFamily
from ..codegen.program import DirectionalDerivative, Program

FRAMES = {3: "frame", 2: "planar_frame"}
TURNS = {3: 3, 2: 1}


def families() -> list[CouplingFamily]:
    """Return the families in space and in the plane."""
    return CouplingFamily.each("frame", "frame of two vectors", FRAMES, build)


def build(dim: int) -> list[Program]:
    """Return the kernels of the frame in space, or in the plane, where b is not used."""
    return [axes(dim), motion(dim), moment(dim)]


class _Frame:
    """Inputs a and b; A, and its turn by each entry of both."""

    def __init__(self, kernel: str, dim: int, doc: str):
        self.program = p = Program(f"{FRAMES[dim]}_{kernel}", doc, "eq 13-18")
        self.dim = dim
        self.a = p.input("a", dim, "1", "vector along i")
        self.b = p.input("b", dim, "1", "vector in the plane of i and j; not used in the plane")
        p.stage("frame")
        director = [self.b] if dim == 3 else []
        self.A = tangent_frame(p, self.a, director[0] if director else None)
        p.stage("its turn by the vectors")
        T = turning(p, self.A, self.a, *director)
        still = [np.zeros(TURNS[dim], dtype=int)] * (2 * dim - len(T))
        self.T = np.stack([*T, *still], axis=1)

    def entries(self) -> list[Any]:
        """Return the entries of a, then those of b."""
        return [*self.a, *self.b]


def axes(dim: int) -> Program:
    """Return the kernel of the frame A and of its turn T by the entries of both vectors."""
    f = _Frame("axes", dim, "frame of two vectors, and its turn by them")
    f.program.output("A", f.A, "1", "columns i j k")
    f.program.output("T", f.T, "rad", "dA = (T d(a, b))~ A")
    return f.program


def motion(dim: int) -> Program:
    """Return the kernel of omega, and of its rate at given accelerations of the vectors."""
    f = _Frame("motion", dim, "angular velocity and acceleration of the frame")
    p = f.program
    rates = [p.input(f"{name}_rate", dim, "1/s", f"rate of {name}") for name in "ab"]
    seconds = [p.input(f"{name}_second", dim, "1/s^2", f"second rate of {name}") for name in "ab"]
    rate, second = np.concatenate(rates), np.concatenate(seconds)
    p.stage("angular velocity")
    omega = [p.define(f"omega_{k}", row.dot(rate)) for k, row in enumerate(f.T)]
    p.stage("angular acceleration")
    along = DirectionalDerivative(p, "dt", dict(zip([*f.entries(), *rate], [*rate, *second], strict=True)))
    p.output("omega", omega, "rad/s", "angular velocity in global axes")
    p.output("alpha", along.array(np.array(omega, dtype=object)), "rad/s^2", "its rate")
    return p


def moment(dim: int) -> Program:
    """Return the kernel of T' m, the generalised force of a moment on the vectors, and of its derivative."""
    f = _Frame("moment", dim, "generalised force of a moment on the frame, and its derivative")
    p = f.program
    m = p.input("m", TURNS[dim], "N m", "moment in global axes, held fixed")
    p.stage("force on the vectors, and its derivative")
    g = np.array([p.define(f"g_{k}", m.dot(column)) for k, column in enumerate(f.T.T)])
    by = [DirectionalDerivative(p, f"d{k}", {symbol: 1}) for k, symbol in enumerate(f.entries())]
    p.output("g", g, "N m", "T' m")
    p.output("K", np.stack([d.array(g) for d in by], axis=1), "N m", "derivatives of T' m by a and b")
    return p


def spun(omega: np.ndarray, A: np.ndarray) -> np.ndarray:
    """Return the rate of axes that turn with omega, both in global axes."""
    return np.stack([cross(omega, column) for column in A.T], axis=1)
