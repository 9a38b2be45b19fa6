"""A point as rider: the origin of its body and the arm from there, in global axes.

Any point can be a rider, of a cable as well as of a modal body. The engine applies the chain rule through the point's
Jacobian (dp = P dq) and the bias of its acceleration.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import sympy as sp

from ..codegen.program import AXES, DirectionalDerivative, Program


@dataclass(frozen=True)
class Point:
    """The interface of a body's module (bodies/rigid.py), for a point in space or in the plane."""

    NAME: str
    DIM: int
    N_CONFIGURATION: int
    N_VELOCITY: int

    def configuration(self, program: Program) -> np.ndarray:
        """Declare the input b, where the arm starts, and return it."""
        return program.input("b", self.DIM, "m", "origin of what carries the point")

    def velocity(self, program: Program) -> np.ndarray:
        """Declare the input w, velocity of the point, and return it."""
        return program.input("w", self.DIM, "m/s", "velocity of the point")

    def attachment(self, program: Program) -> np.ndarray:
        """Declare the input u, the point as seen from its origin, and return it."""
        return program.input("u", self.DIM, "m", "point from the origin, in global axes")

    def axes(self, program: Program, b: np.ndarray) -> None:
        """Return None: a point has no attitude."""

    def rate(self, b: np.ndarray, A: None, w: np.ndarray) -> dict[sp.Symbol, sp.Expr]:
        """Return the rates of b at the velocity w."""
        return dict(zip(b, w, strict=True))

    def tangents(self, program: Program, b: np.ndarray, A: None) -> list[DirectionalDerivative]:
        """Return the derivatives along the axes."""
        units = np.eye(self.DIM, dtype=int)
        return [DirectionalDerivative(program, f"d_{AXES[k].upper()}", self.rate(b, A, units[k]))
                for k in range(self.DIM)]

    def origin(self, b: np.ndarray) -> np.ndarray:
        """Return where the arm starts, (dim,), m."""
        return b

    def arm(self, program: Program, A: None, u: np.ndarray) -> np.ndarray:
        """Return the point as seen from there, (dim,), m."""
        return u

    def step_turn(self, program: Program, b: np.ndarray, A: None, b_next: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return no turn, about no axes."""
        return np.zeros(3 if self.DIM == 3 else 1, dtype=int), np.zeros((self.DIM, 0), dtype=int)


POINTS = {point.NAME: point for point in (Point("point", 3, 3, 3), Point("planar_point", 2, 2, 2))}
