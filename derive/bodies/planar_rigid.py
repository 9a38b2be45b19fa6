"""Planar rigid body: position R and unit complex number c + i s; velocities R' and angular velocity (3 coordinates).

As in space, a change of configuration is a translation and a rotation: no constraint, no angle that grows with every
turn, and A is linear in (c, s), which turn as dc = -s dtheta, ds = c dtheta.
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..codegen.program import DirectionalDerivative, Program

NAME, DIM, N_CONFIGURATION, N_VELOCITY = "planar_rigid", 2, 4, 3
WINDING = 1  # the body's angle over the complex number's
DOC, SOURCE = "planar rigid body", "paper eq 12 (q_r) in the plane"


def configuration(program: Program) -> np.ndarray:
    """Declare the input b, position of the mass centre and unit complex number, and return it."""
    return program.input("b", N_CONFIGURATION, "m, 1", "position of the mass centre, cosine and sine of the angle")


def velocity(program: Program) -> np.ndarray:
    """Declare the input w, velocity of the mass centre and angular velocity, and return it."""
    return program.input("w", N_VELOCITY, "m/s, rad/s", "velocity of the mass centre, angular velocity")


def attachment(program: Program) -> np.ndarray:
    """Declare the input u, a point of the body, and return it."""
    return program.input("u", DIM, "m", "point in body axes from the mass centre")


def product(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return the product of complex numbers: the rotation q after p."""
    return np.array([p[0] * q[0] - p[1] * q[1], p[0] * q[1] + p[1] * q[0]])


def exponential(program: Program, psi: np.ndarray) -> np.ndarray:
    """Return the unit complex number of an angle."""
    program.stage("complex number of the angle")
    return np.array([program.define("cosine", sp.cos(psi[0])), program.define("sine", sp.sin(psi[0]))])


def exponential_tangent(program: Program, psi: np.ndarray) -> np.ndarray:
    """Return one: angles add up."""
    return np.eye(1, dtype=int)


def cayley(half: np.ndarray) -> np.ndarray:
    """Return the complex number of the tangent of half an angle, not of unit size."""
    return np.array([1 - half[0] ** 2, 2 * half[0]])


def axes(program: Program, b: np.ndarray) -> np.ndarray:
    """Return A (2, 2), from body to global axes."""
    return np.array([[b[2], -b[3]], [b[3], b[2]]])


def rate(b: np.ndarray, A: np.ndarray, w: np.ndarray) -> dict[sp.Symbol, sp.Expr]:
    """Return the rates of b at the velocity w."""
    return dict(zip(b, [*w[:2], *(w[2] * A[:, 1])], strict=True))


def tangents(program: Program, b: np.ndarray, A: np.ndarray) -> list[DirectionalDerivative]:
    """Return the three derivatives: by two translations and the rotation."""
    units = np.eye(N_VELOCITY, dtype=int)
    return [DirectionalDerivative(program, f"d_{name}", rate(b, A, units[k]))
            for k, name in enumerate(("X", "Y", "th"))]


def origin(b: np.ndarray) -> np.ndarray:
    """Return the position R of the mass centre, (2,), m."""
    return b[:2]


def arm(program: Program, A: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Return A u, the point as seen from the origin in global axes, (2,), m."""
    return program.vector("arm", A.dot(u))


def step_turn(program: Program, b: np.ndarray, A: np.ndarray, b_next: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return theta = 2 tan(half the turn), with A_next u - A u = theta x (A + A_next) u/2, and the axis across."""
    sine = program.define("turn_sine", b[2] * b_next[3] - b[3] * b_next[2])
    theta = program.define("theta", 2 * sine / (1 + program.define("turn_cosine", b[2:].dot(b_next[2:]))))
    return np.array([theta]), np.array([[1]])


def turning_inertia(J: np.ndarray) -> np.ndarray:
    """Return the moment of inertia about z."""
    return J[2:, 2:]


def gyroscopic_moment(program: Program, J: np.ndarray, omega: np.ndarray) -> np.ndarray:
    """Return zero: in the plane there is no gyroscopic moment."""
    return np.zeros(1, dtype=int)
