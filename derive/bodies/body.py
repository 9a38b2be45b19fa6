"""The interface of the modules of bodies, such as bodies/rigid.py, and of riders, such as bodies/point.py.

Configurations b have N_CONFIGURATION entries and velocities w N_VELOCITY: the translation first, then the rotation.
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
import sympy as sp

from ..codegen.program import DirectionalDerivative, Program


class Rider(Protocol):
    """The rider of a slide: a point, its derivatives along its velocities, and its change over a step."""

    @property
    def NAME(self) -> str:  # noqa: N802
        """Return its name, part of the names of its kernels."""

    @property
    def DIM(self) -> int:  # noqa: N802
        """Return the dimension of space, 2 or 3."""

    @property
    def N_CONFIGURATION(self) -> int:  # noqa: N802
        """Return the length of b."""

    @property
    def N_VELOCITY(self) -> int:  # noqa: N802
        """Return the length of w."""

    def configuration(self, program: Program) -> np.ndarray:
        """Declare the input b and return it."""

    def velocity(self, program: Program) -> np.ndarray:
        """Declare the input w and return it."""

    def attachment(self, program: Program) -> np.ndarray:
        """Declare the input u, a point, and return it."""

    def axes(self, program: Program, b: np.ndarray) -> Any:
        """Return the matrix A (DIM, DIM) from body to global axes, None for a point that has no axes."""

    def rate(self, b: np.ndarray, A: Any, w: np.ndarray) -> dict[sp.Symbol, sp.Expr]:
        """Return the rates of b, and of A where it has symbols of its own, at the velocity w."""

    def tangents(self, program: Program, b: np.ndarray, A: Any) -> list[DirectionalDerivative]:
        """Return the derivatives along each velocity, N_VELOCITY of them."""

    def origin(self, b: np.ndarray) -> np.ndarray:
        """Return the position (DIM,) of the origin of the body."""

    def arm(self, program: Program, A: Any, u: np.ndarray) -> np.ndarray:
        """Return the point u as seen from the origin, in global axes (DIM,)."""

    def step_turn(self, program: Program, b: np.ndarray, A: Any, b_next: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the turn theta over a step and the axes half-way, by columns: see bodies/rigid.py."""


class Body(Rider, Protocol):
    """A rider with mass and axes."""

    @property
    def DOC(self) -> str:  # noqa: N802
        """Return what it is."""

    @property
    def SOURCE(self) -> str:  # noqa: N802
        """Return where its equations are from."""

    @property
    def WINDING(self) -> int:  # noqa: N802
        """Return the angle of the body over that of its attitude: 2 for quaternions, 1 for complex numbers."""

    def product(self, p: np.ndarray, q: np.ndarray) -> np.ndarray:
        """Return the product of two attitudes: the rotation q in body axes after p."""

    def exponential(self, program: Program, psi: np.ndarray) -> np.ndarray:
        """Return the attitude, of unit size, of the rotation vector psi."""

    def exponential_tangent(self, program: Program, psi: np.ndarray) -> np.ndarray:
        """Return T, the turn in body axes by a change of psi: dtheta = T dpsi."""

    def cayley(self, half: np.ndarray) -> np.ndarray:
        """Return the attitude, not of unit size, of half of a Cayley vector."""

    def turning_inertia(self, J: np.ndarray) -> np.ndarray:
        """Return the part of the inertia J (3, 3) for the rotations of this body, kg m^2."""

    def gyroscopic_moment(self, program: Program, J: np.ndarray, omega: np.ndarray) -> np.ndarray:
        """Return omega x J omega, N m, for the rotations of this body."""
