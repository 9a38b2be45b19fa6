"""Rigid body: position R and unit quaternion; velocities R' and body-axis angular velocity (6 coordinates).

A change of configuration is a translation and a rotation about body axes, R + dR, A exp(dtheta~): no constraint
on the quaternion and no singular attitude. Derivatives by these six are derivations on R and the nine entries of
A, through which alone everything depends on the quaternion: dA = A dtheta~ is two products an entry.
"""

from __future__ import annotations

import numpy as np
import sympy as sp
from funicular.derive.frames import cross
from funicular.derive.stages import Derivation, Program

NAME, DIM, N_CONFIGURATION, N_VELOCITY = "rigid", 3, 7, 6
SOURCE = "paper eq 12 (q_r); Haug 1989, ch. 9"


def configuration(program: Program) -> np.ndarray:
    """Input b: position of the mass centre and unit quaternion (w, x, y, z)."""
    return program.input("b", N_CONFIGURATION, "m, 1", "position of the mass centre, unit quaternion w x y z")


def velocity(program: Program) -> np.ndarray:
    """Input w: velocity of the mass centre and angular velocity."""
    return program.input("w", N_VELOCITY, "m/s, rad/s", "velocity of the mass centre, body-axis angular velocity")


def attachment(program: Program) -> np.ndarray:
    """Input u: a point of the body."""
    return program.input("u", 3, "m", "point in body axes from the mass centre")


def rotation(q: np.ndarray) -> np.ndarray:
    """A(q), body to global axes."""
    w, v = q[0], q[1:]
    skew = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3, dtype=int) + 2 * (w * skew + skew.dot(skew))


def axes(program: Program, b: np.ndarray) -> np.ndarray:
    """Stage: A."""
    return np.array([program.vector(f"A{i + 1}", row) for i, row in enumerate(rotation(b[3:]))])


def rate(b: np.ndarray, A: np.ndarray, w: np.ndarray) -> dict[sp.Symbol, sp.Expr]:
    """Value on R and A of the derivation along the velocity w: R' and A omega~."""
    turning = np.array([cross(row, w[3:]) for row in A])
    return dict(zip([*b[:3], *A.ravel()], [*w[:3], *turning.ravel()], strict=True))


def tangents(program: Program, b: np.ndarray, A: np.ndarray) -> list[Derivation]:
    """The six derivations: three translations, three rotations about body axes."""
    units = np.eye(N_VELOCITY, dtype=int)
    return [Derivation(program, f"d_{name}", rate(b, A, units[k]))
            for k, name in enumerate(("X", "Y", "Z", "th1", "th2", "th3"))]


def origin(b: np.ndarray) -> np.ndarray:
    """R."""
    return b[:3]


def arm(program: Program, A: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Stage: A u, the point from the origin."""
    return program.vector("arm", A.dot(u))


def build() -> list[Program]:
    """The kernels of a rigid body."""
    return [_point(), _inertia_force(), _inertia_tangent(), _kinetic_energy()]


def _point() -> Program:
    p = Program("rigid_point", "position, Jacobian, velocity and acceleration bias of a point", SOURCE)
    b, u, w = configuration(p), attachment(p), velocity(p)
    p.stage("position")
    A = axes(p, b)
    at = p.vector("p", origin(b) + arm(p, A, u))
    p.stage("derivatives")
    p_q = np.stack([d.array(at) for d in tangents(p, b, A)], axis=1)
    along = Derivation(p, "dt", rate(b, A, w))
    speed = along.array(at)
    p.output("p", at, "m", "position R + A u")
    p.output("p_q", p_q, "1, m", "derivatives by translation and rotation about body axes")
    p.output("v", speed, "m/s", "velocity")
    p.output("bias", along.array(speed), "m/s^2", "acceleration at zero R'' and zero omega'")
    return p


def _inertia(p: Program):
    return (p.input("mass", (), "kg", "mass"),
            p.input("J", (3, 3), "kg m^2", "inertia about the mass centre in body axes, symmetric"))


def _inertia_force() -> Program:
    p = Program("rigid_inertia_force", "m R'' and J omega' + omega x J omega", "M q'' of eq 12")
    mass, J = _inertia(p)
    w, a = velocity(p), p.input("a", N_VELOCITY, "m/s^2, rad/s^2", "accelerations R'', omega'")
    p.stage("angular momentum")
    h = p.vector("h", J.dot(w[3:]))
    p.output("f", np.concatenate([mass * a[:3], J.dot(a[3:]) + cross(w[3:], h)]), "N, N m", "inertia force")
    return p


def _inertia_tangent() -> Program:
    p = Program("rigid_inertia_tangent", "mass matrix and derivative of the inertia force by velocity",
                "derivative of M q''")
    mass, J = _inertia(p)
    w = velocity(p)
    p.stage("gyroscopic moment")
    h = p.vector("h", J.dot(w[3:]))
    force = np.concatenate([[0, 0, 0], p.vector("gyro", cross(w[3:], h))])
    M = np.zeros((6, 6), dtype=object)
    M[:3, :3], M[3:, 3:] = mass * np.eye(3, dtype=int), J
    D = np.stack([Derivation(p, f"d_w{k}", {w[k]: 1}).array(force) for k in range(6)], axis=1)
    p.output("M", M, "kg, kg m^2", "mass matrix")
    p.output("D", D, "kg m/s", "derivative of the inertia force by w")
    return p


def _kinetic_energy() -> Program:
    p = Program("rigid_kinetic_energy", "kinetic energy", "eq 3 for a rigid body")
    mass, J = _inertia(p)
    w = velocity(p)
    p.output("T", [(mass * w[:3].dot(w[:3]) + w[3:].dot(J.dot(w[3:]))) / 2], "J", "kinetic energy")
    return p
