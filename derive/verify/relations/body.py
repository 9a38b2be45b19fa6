"""Relations of the kernels of bodies: points along finite motions, and Newton-Euler from momentum."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...codegen.family import BodyFamily
from ..methods import Relation
from ..motion import RIDERS, cross, exponential, spin, swung_axes, turned
from .moves import moves
from .paths import entry, from_kernel, unit


def body(family: BodyFamily) -> list[Relation]:
    """Return the relations of a body's kernels: points along finite motions, Newton-Euler from momentum."""
    rider = RIDERS[family.rider]
    n, dim = rider.n_velocity, rider.dim

    def point(k, s, motion):
        return rider.point(rider.moved(k, s["b"], motion), s["u"])

    def by_coordinate(k, s, t, j):
        return point(k, s, t * unit(s["w"], j))

    def moved(kernel, k, s, t, j):
        return k(kernel, s, b=rider.moved(k, s["b"], t * unit(s["w"], j)))

    def force_of_wrench(k, s, t, j):
        return moved("point", k, s, t, j)["p_q"].T.dot(s["f"]) + moved("frame", k, s, t, j)["T"].T.dot(s["m"])

    def momentum(k, s, t, j):
        """Return momenta in the axes of t = 0: mass velocity, A J omega about the axes of rotation."""
        velocity = s["w"] + t * s["a"]
        turn = exponential(k, t * spin(s["w"], dim))
        return np.concatenate([s["mass"] * velocity[:dim],
                               turned(turn, s["J"].dot(spin(velocity, dim)))[dim - n:]])

    def kinetic_energy(k, s, t, j):
        """Return the kinetic energy of point masses with the same inertia: J = sum m (p.p I - p p')."""
        spread = (s["J"].trace() / 2) * np.eye(3, dtype=int) - s["J"]
        return sum(s["mass"] * s["w"][i] ** 2 for i in range(dim)) / 2 + _spinning(spread, spin(s["w"], dim))

    at = Relation("point", "p", "R + A u by quaternions or complex numbers", 0,
                  lambda k, s, t, j: rider.point(s["b"], s["u"]))
    p_q = Relation("point", "p_q", "dp by translation and rotation about body axes", 1, by_coordinate, n)
    return [
        at,
        p_q,
        Relation("point", "v", "dp/dt", 1, lambda k, s, t, j: point(k, s, t * s["w"])),
        Relation("point", "bias", "d²p/dt² at constant velocities", 2, lambda k, s, t, j: point(k, s, t * s["w"])),
        replace(at, kernel="place"),
        replace(p_q, kernel="place"),
        *_frame(rider),
        Relation("wrench", "K", "d(p_q' f + T' m) by translation and rotation", 1, force_of_wrench, n),
        Relation("wrench", "v_q", "dv by translation and rotation at fixed rates", 1,
                 lambda k, s, t, j: moved("point", k, s, t, j)["v"], n),
        Relation("wrench", "omega_q", "d(T w) by translation and rotation at fixed rates", 1,
                 lambda k, s, t, j: moved("frame", k, s, t, j)["T"].dot(s["w"]), n),
        Relation("discrete_point", "P", "P step is p_next - p", 0,
                 lambda k, s, t, j: rider.point(s["b_next"], s["u"]) - rider.point(s["b"], s["u"]),
                 of=lambda k, s: k("discrete_point", s)["P"].dot(rider.step(s["b"], s["b_next"]))),
        Relation("discrete_point", "P", "dp by translation and rotation where b_next is b", 1, by_coordinate, n,
                 of=lambda k, s: k("discrete_point", s, b_next=s["b"])["P"]),
        Relation("inertia_force", "f", "rate of momentum", 1, momentum),
        Relation("inertia_tangent", "M", "df/da", 1, from_kernel("inertia_force", "f", a=entry("a")), n),
        Relation("inertia_tangent", "D", "df/dw", 1, from_kernel("inertia_force", "f", w=entry("w")), n),
        Relation("kinetic_energy", "T", "Σ ½ m v² of point masses", 0, kinetic_energy),
        *moves(rider),
    ]


def _spinning(spread: np.ndarray, omega: np.ndarray):
    """Return the kinetic energy of rotation, from S = sum m p p': each column p of a root of S moves with omega x p."""
    columns = np.stack([cross(omega, c) for c in spread.T], axis=1)  # omega~ S, and T = -1/2 tr(omega~ omega~ S)
    return -sum(cross(omega, columns[:, i])[i] for i in range(3)) / 2


def _frame(rider) -> list[Relation]:
    """Return the relations of the axes of a body and of moments on them."""
    n, dim = rider.n_velocity, rider.dim

    def moved(k, s, t, j):
        return k("frame", s, b=rider.moved(k, s["b"], t * np.eye(n, dtype=int)[j]))

    def axes(k, s, t, j):
        origin = 0 * s["b"][:dim]
        return np.stack([rider.point(np.concatenate([origin, s["b"][dim:]]), axis) for axis in np.eye(dim, dtype=int)],
                        axis=1)

    def turn(k, s):
        out = k("frame", s)
        return np.stack([swung_axes(column, out["A"]) for column in out["T"].T], axis=-1)

    return [
        Relation("frame", "A", "axes by quaternions or complex numbers", 0, axes),
        Relation("frame", "T", "dA is T's turn of A", 1, lambda k, s, t, j: moved(k, s, t, j)["A"], n, of=turn),
    ]
