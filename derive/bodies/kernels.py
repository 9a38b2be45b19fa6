"""The kernels of a body with a frame, planar or spatial: its points, the forces on them, its inertia.

A body (bodies/) gives its configuration and the derivations along its velocities; u, p, f have its dim.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sp

from ..algebra.tangent_frame import cross
from ..codegen.program import DirectionalDerivative, Program
from . import moves
from .body import Body, Rider


def build(body: Body) -> list[Program]:
    """Return the programs of every kernel of a body."""
    return [place(body), point(body), frame(body), wrench(body), inertia_force(body), inertia_tangent(body),
            kinetic_energy(body), discrete_point(body), *moves.build(body)]


def _position(p: Program, body: Body, b: np.ndarray, u: np.ndarray) -> tuple[Any, np.ndarray,
              list[DirectionalDerivative]]:
    """Return A (dim, dim), the position p of the point u (dim,) in m, and the derivatives by translation and rotation.
    """
    p.stage("position")
    A = body.axes(p, b)
    at = p.vector("p", body.origin(b) + body.arm(p, A, u))
    p.stage("derivatives")
    return A, at, body.tangents(p, b, A)


def _jacobian(p: Program, at: np.ndarray, by: list[DirectionalDerivative]) -> np.ndarray:
    p_q = np.stack([d.array(at) for d in by], axis=1)
    p.output("p", at, "m", "position R + A u")
    p.output("p_q", p_q, "1, m", "derivatives by translation and rotation about body axes")
    return p_q


def place(body: Body) -> Program:
    """Return the kernel of the position R + A u and its Jacobian, for the equations of a joint."""
    p = Program(f"{body.NAME}_place", "position and Jacobian of a point", body.SOURCE)
    b, u = body.configuration(p), body.attachment(p)
    _, at, by = _position(p, body, b, u)
    _jacobian(p, at, by)
    return p


def point(body: Body) -> Program:
    """Return the kernel of the position R + A u, its Jacobian, velocity and acceleration bias."""
    p = Program(f"{body.NAME}_point", "position, Jacobian, velocity and acceleration bias of a point", body.SOURCE)
    b, u, w = body.configuration(p), body.attachment(p), body.velocity(p)
    A, at, by = _position(p, body, b, u)
    _jacobian(p, at, by)
    along = DirectionalDerivative(p, "dt", body.rate(b, A, w))
    speed = along.array(at)
    p.output("v", speed, "m/s", "velocity")
    p.output("bias", along.array(speed), "m/s^2", "acceleration at zero accelerations of the coordinates")
    return p


def _turns(body: Body, A: np.ndarray) -> np.ndarray:
    """Return T: the turn of the body about global axes by translation and rotation."""
    turns = body.N_VELOCITY - body.DIM
    T = np.zeros((turns, body.N_VELOCITY), dtype=object)
    T[:, body.DIM :] = A if turns == body.DIM else 1
    return T


def frame(body: Body) -> Program:
    """Return the kernel of the body's axes and their turn."""
    p = Program(f"{body.NAME}_frame", "axes of the body, and their turn", body.SOURCE)
    b = body.configuration(p)
    p.stage("axes")
    A = body.axes(p, b)
    p.output("A", A, "1", "axes of the body by columns")
    p.output("T", _turns(body, A), "rad", "dA = (T dq)~ A: turn about global axes by translation and rotation")
    return p


def wrench(body: Body) -> Program:
    """Return the kernel of the derivatives by the configuration of the generalised force of a force and a moment at a
    point, and of the velocities there at fixed rates.
    """
    p = Program(f"{body.NAME}_wrench", "derivatives of the generalised force of a wrench, and of velocities at a point",
                body.SOURCE)
    b, u, w = body.configuration(p), body.attachment(p), body.velocity(p)
    f = p.input("f", body.DIM, "N", "force on the point, held fixed")
    m = p.input("m", body.N_VELOCITY - body.DIM, "N m", "moment in global axes, held fixed")
    A, at, by = _position(p, body, b, u)
    p_q, T = np.stack([d.array(at) for d in by], axis=1), _turns(body, A)
    p.stage("generalised force")
    force = np.array([p.define(f"g{k}", f.dot(p_q[:, k]) + m.dot(T[:, k])) for k in range(body.N_VELOCITY)])
    p.stage("velocities")
    v = p.vector("speed", DirectionalDerivative(p, "dt", body.rate(b, A, w)).array(at))
    omega = np.array([p.define(f"spin{k}", row.dot(w)) for k, row in enumerate(T)])
    p.stage("derivatives by translation and rotation")
    for name, values, unit, doc in (("K", force, "N/m, N, N m", "derivatives of p_q' f + T' m"),
                                    ("v_q", v, "1/s, m/s", "derivatives of the velocity of the point at fixed rates"),
                                    ("omega_q", omega, "1/(m s), 1/s", "derivatives of the angular velocity")):
        p.output(name, np.stack([d.array(values) for d in by], axis=1), unit, f"{doc} by translation and rotation")
    return p


class Step:
    """Input b_next and stages: the turn theta of a body over a step, and axes half-way."""

    def __init__(self, p: Program, body: Rider, b: np.ndarray):
        self.b_next = p.input("b_next", body.N_CONFIGURATION, "m, 1", "b at the end of the step")
        p.stage("attitudes at both ends of the step")
        self.ends = [body.axes(p, b), body.axes(p, self.b_next)]
        p.stage("turn, and axes half-way")
        self.theta, self.axes = body.step_turn(p, b, self.ends[0], self.b_next)

    def jacobian(self, arm: np.ndarray) -> np.ndarray:
        """Return the Jacobian, by translation and Cayley vector, of a point on this arm."""
        turns = np.array([cross(axis, arm) for axis in self.axes.T], dtype=object).reshape(-1, len(arm)).T
        return np.concatenate([np.eye(len(arm), dtype=int), turns], axis=1)


def discrete_point(body: Body) -> Program:
    """Return the kernel of the Jacobian P of a point over a step psi: p_next - p = P psi."""
    p = Program(f"{body.NAME}_discrete_point", "Jacobian of a point over a step psi: p_next - p = P psi",
                f"{body.SOURCE}; Simo & Wong, Int. J. Numer. Meth. Eng. 31 (1991) 19-52")
    b, u = body.configuration(p), body.attachment(p)
    step = Step(p, body, b)
    p.stage("mean arm")
    first, last = (body.arm(p, A, u) for A in step.ends)
    arm = p.vector("mean_arm", (first + last) / 2)
    p.output("P", step.jacobian(arm), "1, m",
             "by translation and Cayley vector; P' f is the force f on the point along axes half-way")
    return p


def _inertia(p: Program, body: Body) -> tuple[sp.Symbol, np.ndarray]:
    mass = p.input("mass", (), "kg", "mass")
    J = p.input("J", (3, 3), "kg m^2", "inertia about the mass centre in body axes, symmetric")
    return mass, body.turning_inertia(J)


def _mass_matrix(body: Body, mass: sp.Expr, J: np.ndarray) -> np.ndarray:
    M = np.zeros((body.N_VELOCITY, body.N_VELOCITY), dtype=object)
    M[: body.DIM, : body.DIM], M[body.DIM :, body.DIM :] = mass * np.eye(body.DIM, dtype=int), J
    return M


def _gyroscopic(p: Program, body: Body, J: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Return the inertia force at zero accelerations (velocities,), N and N m."""
    p.stage("gyroscopic moment")
    return np.concatenate([np.zeros(body.DIM, dtype=int), body.gyroscopic_moment(p, J, w[body.DIM :])])


def inertia_force(body: Body) -> Program:
    """Return the kernel of the inertia force: m R'' in N, and J omega' + omega x J omega in N m."""
    p = Program(f"{body.NAME}_inertia_force", "m R'' and J omega' + omega x J omega", "M q'' of eq 12")
    mass, J = _inertia(p, body)
    w, a = body.velocity(p), p.input("a", body.N_VELOCITY, "m/s^2, rad/s^2", "accelerations R'', omega'")
    force = _mass_matrix(body, mass, J).dot(a) + _gyroscopic(p, body, J, w)
    p.output("f", force, "N, N m", "inertia force")
    return p


def inertia_tangent(body: Body) -> Program:
    """Return the kernel of the mass matrix M and of the derivative D of the inertia force by the velocity."""
    p = Program(f"{body.NAME}_inertia_tangent", "mass matrix and derivative of the inertia force by velocity",
                "derivative of M q''")
    mass, J = _inertia(p, body)
    w = body.velocity(p)
    force = _gyroscopic(p, body, J, w)
    p.output("M", _mass_matrix(body, mass, J), "kg, kg m^2", "mass matrix")
    columns = [DirectionalDerivative(p, f"d_w{k}", {symbol: 1}).array(force) for k, symbol in enumerate(w)]
    p.output("D", np.stack(columns, axis=1),
             "kg m/s", "derivative of the inertia force by w")
    return p


def kinetic_energy(body: Body) -> Program:
    """Return the kernel of the kinetic energy of translation and rotation, J."""
    p = Program(f"{body.NAME}_kinetic_energy", "kinetic energy", "eq 3 for a rigid body")
    mass, J = _inertia(p, body)
    w = body.velocity(p)
    v, omega = w[: body.DIM], w[body.DIM :]
    p.output("T", [(mass * v.dot(v) + omega.dot(J.dot(omega))) / 2], "J", "kinetic energy")
    return p
