"""Rigid body: position R and unit quaternion; velocities R' and body-axis angular velocity (6 coordinates).

A change of configuration is a translation and a rotation about body axes, R + dR, A exp(dtheta~): no constraint
on the quaternion and no singular attitude. Derivatives by these six are derivations on R and the nine entries of
A, through which alone everything depends on the quaternion: dA = A dtheta~ is two products an entry.
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..algebra.stumpff import stumpff
from ..algebra.tangent_frame import cross
from ..codegen.program import DirectionalDerivative, Program

NAME, DIM, N_CONFIGURATION, N_VELOCITY = "rigid", 3, 7, 6
WINDING = 2  # the body's angle over the quaternion's
DOC, SOURCE = "rigid body", "paper eq 12 (q_r); Haug 1989, ch. 9"


def configuration(program: Program) -> np.ndarray:
    """Declare the input b, position of the mass centre and unit quaternion (w, x, y, z), and return it."""
    return program.input("b", N_CONFIGURATION, "m, 1", "position of the mass centre, unit quaternion w x y z")


def velocity(program: Program) -> np.ndarray:
    """Declare the input w, velocity of the mass centre and angular velocity in body axes, and return it."""
    return program.input("w", N_VELOCITY, "m/s, rad/s", "velocity of the mass centre, body-axis angular velocity")


def attachment(program: Program) -> np.ndarray:
    """Declare the input u, a point of the body, and return it."""
    return program.input("u", 3, "m", "point in body axes from the mass centre")


def rotation(q: np.ndarray) -> np.ndarray:
    """Return A(q) (3, 3), from body to global axes."""
    w, v = q[0], q[1:]
    across = skew(v)
    return np.asarray(np.eye(3, dtype=int) + 2 * (w * across + across.dot(across)))


def skew(v: np.ndarray) -> np.ndarray:
    """Return v~ (3, 3), with v~ u = v x u."""
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def product(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return Hamilton's product of quaternions: the rotation q in body axes after p."""
    return np.concatenate([[p[0] * q[0] - p[1:].dot(q[1:])], p[0] * q[1:] + q[0] * p[1:] + cross(p[1:], q[1:])])


def exponential(program: Program, psi: np.ndarray) -> np.ndarray:
    """Return the unit quaternion of a rotation vector: cosine, and sine along its direction, of half its length."""
    program.stage("half of the rotation vector")
    half = program.vector("half", psi / 2)
    square = program.define("square", half.dot(half))
    root = program.define("angle", sp.sqrt(square))
    program.stage("its quaternion")
    sine = stumpff(program, "c1", 1, square, root)
    return np.array([stumpff(program, "c0", 0, square, root), *program.vector("sine", sine * half)])


def exponential_tangent(program: Program, psi: np.ndarray) -> np.ndarray:
    """Return T = sum_k (-psi~)^k/(k + 1)!, which psi~^3 = -psi.psi psi~ makes I - c_2 psi~ + c_3 psi~^2."""
    program.stage("rotation vector")
    square = program.define("square", psi.dot(psi))
    root = program.define("angle", sp.sqrt(square))
    c2, c3 = (stumpff(program, f"c{k}", k, square, root) for k in (2, 3))
    across = skew(psi)
    return np.asarray(np.eye(3, dtype=int) - c2 * across + c3 * across.dot(across))


def cayley(half: np.ndarray) -> np.ndarray:
    """Return the quaternion of half of a Cayley vector, not of unit size."""
    return np.array([1, *half])


def axes(program: Program, b: np.ndarray) -> np.ndarray:
    """Return A (3, 3), from body to global axes, its entries named."""
    return np.array([program.vector(f"A{i + 1}", row) for i, row in enumerate(rotation(b[3:]))])


def rate(b: np.ndarray, A: np.ndarray, w: np.ndarray) -> dict[sp.Symbol, sp.Expr]:
    """Return the rates of R and A at the velocity w: R' and A omega~."""
    turning = np.array([cross(row, w[3:]) for row in A])
    return dict(zip([*b[:3], *A.ravel()], [*w[:3], *turning.ravel()], strict=True))


def tangents(program: Program, b: np.ndarray, A: np.ndarray) -> list[DirectionalDerivative]:
    """Return the six derivatives: by three translations and three rotations about body axes."""
    units = np.eye(N_VELOCITY, dtype=int)
    return [DirectionalDerivative(program, f"d_{name}", rate(b, A, units[k]))
            for k, name in enumerate(("X", "Y", "Z", "th1", "th2", "th3"))]


def origin(b: np.ndarray) -> np.ndarray:
    """Return the position R of the mass centre, (3,), m."""
    return b[:3]


def arm(program: Program, A: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Return A u, the point as seen from the origin in global axes, (3,), m."""
    return program.vector("arm", A.dot(u))


def step_turn(program: Program, b: np.ndarray, A: np.ndarray, b_next: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return theta with A_next u - A u = theta x (A + A_next) u/2, and axes half-way by columns.

    A_next = A cay(Theta), Theta/2 the vector of the relative quaternion over its scalar, theta = A Theta. Along the
    columns of A (I + Theta~/2) the balance of A J omega is inertia_force as it stands, at the mean velocity Theta/h.
    """
    q, q_next = b[3:], b_next[3:]
    inverse = program.define("inv_p", 1 / program.define("p_scalar", q.dot(q_next)))
    half = program.vector("half", inverse * (q[0] * q_next[1:] - q_next[0] * q[1:] - cross(q[1:], q_next[1:])))
    between = np.array([program.vector(f"B{i + 1}", row + cross(row, half)) for i, row in enumerate(A)])
    return program.vector("theta", 2 * A.dot(half)), between


def turning_inertia(J: np.ndarray) -> np.ndarray:
    """Return the inertia."""
    return J


def gyroscopic_moment(program: Program, J: np.ndarray, omega: np.ndarray) -> np.ndarray:
    """Return omega x J omega, (3,), N m."""
    return program.vector("gyro", cross(omega, program.vector("h", J.dot(omega))))
