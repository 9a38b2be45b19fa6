"""The kernels of a modal body: inertia of its frame's rows, of a mode's, of two modes; energies; points with axes.

The number of modes is known at run time: the engine sums moments over modes (bodies/modal.py says which) and calls the
kernels of a mode for each, those of a pair for each pair.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..codegen.program import DirectionalDerivative, Program
from .body import Body
from .modal import (
    SOURCE,
    ModeMoments,
    Moments,
    Motion,
    axial,
    body_force,
    contraction,
    mode_force,
    skew,
    vector_product,
)


def build(name: str, frame: Body) -> list[Program]:
    """Return the programs of every kernel of a modal body on a frame."""
    return [make(name, frame) for make in (
        inertia_force, mass_matrix, inertia_tangent, mode_force_, mode_mass, mode_tangent, pair_tangent,
        kinetic_energy, potential_energy, attachment, attachment_mode, attachment_wrench, attachment_mode_wrench,
        attachment_pair_wrench)]


def inertia_force(name: str, frame: Body) -> Program:
    """Return the kernel of the inertia force less weight in the frame's rows."""
    p = Program(f"{name}_inertia_force", "inertia and weight of a modal body: force, moment about its origin",
                SOURCE)
    motion = Motion(p, frame)
    force = body_force(motion, Moments.given(p, frame.DIM))
    p.output("f", force, "N, N m", "inertia force less weight")
    return p


def mass_matrix(name: str, frame: Body) -> Program:
    """Return the kernel of the frame's block M_rr of the mass matrix (eq 12): (6, 6), in the plane (3, 3)."""
    p = Program(f"{name}_mass_matrix", "M_rr: the frame's part of the mass matrix", "paper eq 12")
    dim = frame.DIM
    b, of = frame.configuration(p), Moments.given(p, dim, rates=1)
    p.stage("axes")
    A = frame.axes(p, b)
    S, X = of.first[0], of.second[0]
    spins = [skew(e) for e in np.eye(frame.N_VELOCITY - dim, dtype=int)]
    coupling = np.stack([A.dot(spin.dot(S)) for spin in spins], axis=1)
    turning = np.stack([axial(X.dot(spin.T)) for spin in spins], axis=1)
    p.output("M", np.block([[of.mass * np.eye(dim, dtype=int), coupling], [coupling.T, turning]]), "kg, kg m, kg m^2",
             "by translation and rotation about body axes")
    return p


def inertia_tangent(name: str, frame: Body) -> Program:
    """Return the kernel of the derivatives of inertia_force by the frame's motion."""
    p = Program(f"{name}_inertia_tangent", "derivatives of inertia_force by the frame's motion", SOURCE)
    motion = Motion(p, frame)
    force = body_force(motion, Moments.given(p, frame.DIM))
    p.stage("derivatives")
    p.output("D", motion.by_velocity(force), "kg/s", "by w")
    p.output("K", motion.by_configuration(force), "N/m, N", "by translation and rotation about body axes")
    return p


def mode_force_(name: str, frame: Body) -> Program:
    """Return the kernel of the inertia force less weight in the row of a mode."""
    p = Program(f"{name}_mode_force", "inertia and weight of a mode", SOURCE)
    motion = Motion(p, frame)
    force = mode_force(motion, ModeMoments.given(p, frame.DIM))
    p.output("f", force, "N", "inertia force less weight, of a unit of eta")
    return p


def mode_mass(name: str, frame: Body) -> Program:
    """Return the kernel of a mode's column of M_rf, of eq 12."""
    p = Program(f"{name}_mode_mass", "column of a mode in M_rf: it couples its acceleration with the frame's",
                "paper eq 12")
    dim = frame.DIM
    b = frame.configuration(p)
    s, Y = p.input("s", dim, "kg m", "int rho phi of the mode"), p.input("Y", (dim, dim), "kg m^2", "int rho phi u^T")
    p.stage("axes")
    p.output("M", np.concatenate([frame.axes(p, b).dot(s), axial(Y.T)]), "kg, kg m", "by eta''")
    return p


def mode_tangent(name: str, frame: Body) -> Program:
    """Return the kernel of the derivatives that couple a mode with the frame."""
    p = Program(f"{name}_mode_tangent", "derivatives of a mode's force by the frame's motion, and the other way round",
                SOURCE)
    motion = Motion(p, frame)
    mode = ModeMoments.given(p, frame.DIM)
    force = np.array([mode_force(motion, mode)])
    p.stage("derivatives")
    p.output("D", motion.by_velocity(force)[0], "kg/s", "of the mode's force by w")
    p.output("K", motion.by_configuration(force)[0], "N/m, N", "of the mode's force by translation and rotation")
    p.output("D_frame", body_force(motion, mode.of_body(1)), "kg/s", "of the frame's force by the mode's eta'")
    p.output("K_frame", body_force(motion, mode.of_body(0)), "N/m, N", "of the frame's force by the mode's eta")
    return p


def pair_tangent(name: str, frame: Body) -> Program:
    """Return the kernel of the derivatives that couple two modes."""
    p = Program(f"{name}_pair_tangent", "derivatives of mode k's force by the motion of mode l", SOURCE)
    motion = Motion(p, frame)
    dim = frame.DIM
    X = p.input("X_kl", (dim, dim), "kg m^2", "int rho phi_k phi_l^T")
    p.output("D", 2 * contraction(motion.spin, X), "kg/s", "by eta'")
    p.output("K", contraction(motion.W, X), "N/m", "by eta")
    return p


def kinetic_energy(name: str, frame: Body) -> Program:
    """Return the kernel of the kinetic energy int rho v.v/2 in J, with v = A'R' + omega~ u + u'."""
    p = Program(f"{name}_kinetic_energy", "kinetic energy", "eq 3 for a modal body")
    dim = frame.DIM
    b, w = frame.configuration(p), frame.velocity(p)
    of = Moments.given(p, dim, rates=2)
    rates = p.input("X11", (), "kg m^2/s^2", "int rho u'.u'")
    p.stage("velocity of the origin in body axes")
    v = p.vector("v", frame.axes(p, b).T.dot(w[:dim]))
    S, S1 = of.first
    X, X1 = of.second
    spin = skew(w[dim:])
    twice = (of.mass * v.dot(v) + contraction(spin.dot(X), spin) + rates
             + 2 * (v.dot(spin.dot(S) + S1) + w[dim:].dot(axial(X1))))
    p.output("T", twice / 2, "J", "kinetic energy")
    return p


def potential_energy(name: str, frame: Body) -> Program:
    """Return the kernel of the potential energy of gravity, -g . int rho p, in J."""
    p = Program(f"{name}_potential_energy", "potential energy of gravity", SOURCE)
    dim = frame.DIM
    b = frame.configuration(p)
    g = p.input("g", dim, "m/s^2", "gravity")
    mass, S = p.input("mass", (), "kg", "mass"), p.input("S", dim, "kg m", "int rho u")
    p.stage("axes")
    A = frame.axes(p, b)
    p.output("V", -g.dot(mass * frame.origin(b) + A.dot(S)), "J", "potential energy, zero at the origin of the ground")
    return p


class Point:
    """Inputs b, u, theta; stages: place and axes of a point with its section, turned by twice arctan(theta/2).

    theta = sum_k eta_k psi_k is the linear theory's rotation; taken as a Cayley vector it makes axes that are
    orthonormal without a root or a limit: C = 1 + (theta~ + theta~ theta~/2)/(1 + theta^2/4).
    """

    def __init__(self, p: Program, frame: Body):
        dim = frame.DIM
        self.program, self.frame, self.turns = p, frame, frame.N_VELOCITY - dim
        self.b = frame.configuration(p)
        self.u = p.input("u", dim, "m", "deformed place of the point in body axes")
        self.theta = p.input("theta", self.turns, "rad", "turn of the section there, in body axes")
        p.stage("axes")
        self.A = frame.axes(p, self.b)
        self.scale = p.define("inv_theta", 1 / (1 + self.theta.dot(self.theta) / 4))
        self.at = frame.origin(self.b) + frame.arm(p, self.A, self.u)

    def section(self) -> np.ndarray:
        """Return A C, by columns the axes of the section; C has them in body axes."""
        tilde = skew(self.theta)
        return np.asarray(self.A.dot(np.eye(len(tilde), dtype=int) + self.scale * (tilde + tilde.dot(tilde) / 2)))

    def relative(self, rate: np.ndarray) -> np.ndarray:
        """Turn of the section in body axes by this rate of theta."""
        return np.asarray(self.scale * (rate + (vector_product(self.theta, rate) / 2 if self.turns == 3 else 0)))

    def turned(self, vector: np.ndarray) -> np.ndarray:
        """Return the components along global axes of a turn given in body axes."""
        return self.A.dot(vector) if self.turns == 3 else vector

    def turned_back(self, vector: np.ndarray) -> np.ndarray:
        """Return the components in body axes of a turn given along global axes."""
        return self.A.T.dot(vector) if self.turns == 3 else vector

    def mode(self, suffix: str = "") -> tuple[np.ndarray, np.ndarray]:
        """Declare phi and psi, a mode at the point, as inputs and return them."""
        p = self.program
        return (p.input(f"phi{suffix}", len(self.u), "1", "displacement there by a unit of the mode, in body axes"),
                p.input(f"psi{suffix}", self.turns, "rad/m", "turn there by a unit of the mode, in body axes"))

    def loads(self) -> tuple[np.ndarray, np.ndarray]:
        """Declare f and m, force and moment on the point, as inputs and return them."""
        p = self.program
        return (p.input("f", len(self.u), "N", "force on the point, held fixed"),
                p.input("m", self.turns, "N m", "moment on it, held fixed"))

    def moving(self) -> tuple[DirectionalDerivative, np.ndarray, np.ndarray]:
        """Declare the inputs w, u1, theta1; return the derivative in time, the velocity, the angular velocity."""
        p, dim = self.program, self.frame.DIM
        w = self.frame.velocity(p)
        u1 = p.input("u1", dim, "m/s", "rate of u")
        theta1 = p.input("theta1", self.turns, "rad/s", "rate of theta")
        p.stage("along the motion")
        along = DirectionalDerivative(p, "dt", self.frame.rate(self.b, self.A, w)
                                      | dict(zip([*self.u, *self.theta], [*u1, *theta1], strict=True)))
        velocity = p.vector("v", along.array(self.at))
        return along, velocity, p.vector("spin", self.turned(w[dim:] + self.relative(theta1)))

    def frame_force(self, f: np.ndarray, m: np.ndarray) -> np.ndarray:
        """Return the rows of the frame of P' f + T' m, N and N m."""
        return np.concatenate([f, vector_product(self.u, self.A.T.dot(f)) + self.turned_back(m)])

    def mode_force(self, phi: np.ndarray, psi: np.ndarray, f: np.ndarray, m: np.ndarray) -> Any:
        """Return the row of a mode of P' f + T' m, N."""
        return phi.dot(self.A.T.dot(f)) + self.relative(psi).dot(self.turned_back(m))

    def by_frame(self, values: np.ndarray) -> np.ndarray:
        """Return the derivatives of values by translation and rotation, along a new last axis."""
        return np.stack([d.array(values) for d in self.frame.tangents(self.program, self.b, self.A)], axis=-1)

    def by_mode(self, phi: np.ndarray, psi: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Return the derivatives of values by eta of a mode."""
        along = dict(zip([*self.u, *self.theta], [*phi, *psi], strict=True))
        return DirectionalDerivative(self.program, "d_eta", along).array(values)


def attachment(name: str, frame: Body) -> Program:
    """Return the kernel of a point and its axes: positions, Jacobians P and T by the frame, velocities and biases."""
    p = Program(f"{name}_attachment", "a point and its axes: dp = P dq, d(axes) = (T dq)~ axes, with rates", SOURCE)
    point = Point(p, frame)
    dim = frame.DIM
    turns = np.zeros((point.turns, frame.N_VELOCITY), dtype=int).astype(object)
    turns[:, dim:] = np.stack([point.turned(e) for e in np.eye(point.turns, dtype=int)], axis=1)
    along, velocity, omega = point.moving()
    p.output("p", point.at, "m", "R + A u")
    p.output("axes", point.section(), "1", "axes of the section, by columns")
    p.output("P", point.by_frame(point.at), "1, m", "dp by translation and rotation about body axes")
    p.output("T", turns, "1", "turn by them, along global axes")
    p.output("velocity", velocity, "m/s", "p'")
    p.output("omega", omega, "rad/s", "angular velocity of the axes, along global ones")
    p.output("bias", along.array(velocity), "m/s^2", "p'' at zero accelerations")
    p.output("omega_bias", along.array(omega), "rad/s^2", "omega' at zero accelerations")
    return p


def attachment_mode(name: str, frame: Body) -> Program:
    """Return the kernel of the columns of P and T of a mode."""
    p = Program(f"{name}_attachment_mode", "columns of a mode in P and T", SOURCE)
    point = Point(p, frame)
    phi, psi = point.mode()
    p.output("P", point.A.dot(phi), "1", "dp by eta")
    p.output("T", point.turned(point.relative(psi)), "rad/m", "turn by eta, along global axes")
    return p


def attachment_wrench(name: str, frame: Body) -> Program:
    """Return the kernel of the derivatives by the frame of its rows of P' f + T' m, and of the velocities there."""
    p = Program(f"{name}_attachment_wrench", "derivatives by the frame of its rows of P' f + T' m, and of velocities",
                SOURCE)
    point = Point(p, frame)
    force = point.frame_force(*point.loads())
    _, velocity, omega = point.moving()
    p.stage("derivatives")
    p.output("K", point.by_frame(force), "N/m, N, N m", "by translation and rotation")
    p.output("v_q", point.by_frame(velocity), "1/s, m/s", "derivatives of p' at fixed rates")
    p.output("omega_q", point.by_frame(omega), "1/(m s), 1/s", "derivatives of the angular velocity at fixed rates")
    return p


def attachment_mode_wrench(name: str, frame: Body) -> Program:
    """Return the kernel of the derivatives of P' f + T' m that couple the frame and a mode, and of velocities by it."""
    p = Program(f"{name}_attachment_mode_wrench",
                "derivatives of P' f + T' m: the mode's row by the frame, and the reverse; of velocities by the mode",
                SOURCE)
    point = Point(p, frame)
    phi, psi = point.mode()
    f, m = point.loads()
    force = point.mode_force(phi, psi, f, m)
    _, velocity, omega = point.moving()
    p.stage("derivatives")
    p.output("K", point.by_frame(np.array([force]))[0], "N/m, N", "of the mode's row by translation and rotation")
    p.output("K_frame", point.by_mode(phi, psi, point.frame_force(f, m)), "N/m, N", "of the frame's rows by eta")
    p.output("v_eta", point.by_mode(phi, psi, velocity), "1/s", "of p' by eta at fixed rates")
    p.output("omega_eta", point.by_mode(phi, psi, omega), "1/(m s)", "of the angular velocity by eta at fixed rates")
    return p


def attachment_pair_wrench(name: str, frame: Body) -> Program:
    """Return the kernel of the derivatives of P' f + T' m that couple two modes."""
    p = Program(f"{name}_attachment_pair_wrench", "derivative of mode k's row of P' f + T' m by eta of mode l", SOURCE)
    point = Point(p, frame)
    phi, psi = point.mode()
    phi_l, psi_l = point.mode("_l")
    force = point.mode_force(phi, psi, *point.loads())
    p.stage("derivative")
    p.output("K", point.by_mode(phi_l, psi_l, np.array([force])), "N/m", "by eta_l")
    return p
