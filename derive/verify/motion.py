"""Finite motions of riders and the frame of a curve, in any kind of number: the paths of verification.

A modal rider joins by an entry in RIDERS with the same members.
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

from ..bodies import planar_rigid, rigid
from ..bodies.point import POINTS


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the vector product in any kind of number."""
    return np.array([a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)])


def complex_product(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return the product of complex numbers, real part first."""
    return np.array([p[0] * q[0] - p[1] * q[1], p[0] * q[1] + p[1] * q[0]])


def quaternion_product(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return Hamilton's product p o q, scalar first."""
    return np.concatenate([[p[0] * q[0] - p[1:].dot(q[1:])], p[0] * q[1:] + q[0] * p[1:] + cross(p[1:], q[1:])])


def turned(q: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """Return a vector turned from body to global axes: q o (0, vector) o q*."""
    conjugate = np.concatenate([q[:1], -q[1:]])
    return quaternion_product(quaternion_product(q, np.concatenate([[0 * q[0]], vector])), conjugate)[1:]


def exponential(numbers: Any, theta: np.ndarray) -> np.ndarray:
    """Return the quaternion of the finite rotation vector theta."""
    square = theta.dot(theta) / 4
    if square == 0:
        return np.concatenate([[1 + square], theta / 2])
    half = numbers.sqrt(square)
    return np.concatenate([[numbers.cos(half)], numbers.sin(half) / half * theta / 2])


class Motions(Protocol):
    """Finite motions of a rider with configurations b, whose points are u, along its n_velocity velocities."""

    @property
    def dim(self) -> int:
        """Return the dimension of space."""

    @property
    def n_velocity(self) -> int:
        """Return the number of velocities, those of translation first."""

    @property
    def rotations(self) -> slice:
        """Return where the rotations are among the velocities."""

    def sample(self, random: np.random.Generator, near: np.ndarray) -> dict[str, np.ndarray]:
        """Return b, u, w, wdot: an attitude, a point not far from `near` and off it, velocities, accelerations."""

    def at_rest(self, point: np.ndarray) -> dict[str, np.ndarray]:
        """Return b and u with the point here and no rotation."""

    def point(self, b: np.ndarray, u: np.ndarray) -> np.ndarray:
        """Return the rider's point in global axes."""

    def moved(self, numbers: Any, b: np.ndarray, motion: np.ndarray) -> np.ndarray:
        """Return the configuration after a finite motion."""

    def step(self, b: np.ndarray, b_next: np.ndarray) -> np.ndarray:
        """Return translation and Cayley vector from one configuration to another."""

    def turn(self, b: np.ndarray, motion: np.ndarray) -> np.ndarray:
        """Return the rotation vector of a motion in global axes."""

    def frame(self, random: np.random.Generator) -> tuple[Any, ...]:
        """Return a turn of the global frame: its matrix, and what it makes of a configuration."""

    def bracket(self, g: np.ndarray) -> np.ndarray:
        """Return K - K' of second derivatives by the rotations of the rider."""


class Rigid:
    """bodies/rigid.py: b = (R, quaternion), velocities (R', body-axis omega)."""

    dim, n_velocity = rigid.DIM, rigid.N_VELOCITY
    rotations = slice(3, 6)

    @staticmethod
    def sample(random: np.random.Generator, near: np.ndarray) -> dict[str, np.ndarray]:
        """Return an attitude, a point and velocities, the point not far from `near` and off it."""
        q = random.normal(size=4)
        q /= np.linalg.norm(q)
        u = random.normal(size=3) / 3
        R = near - turned(q, u) + random.normal(size=3) / 8  # far below radii of curvature: no fold of s(q)
        return {"b": np.concatenate([R, q]), "u": u, "w": random.normal(size=6), "wdot": random.normal(size=6)}

    @staticmethod
    def at_rest(point: np.ndarray) -> dict[str, np.ndarray]:
        """Return a body that is not turned and has a point u here."""
        u = np.array([0.0, 0.25, 0.125])
        return {"b": np.concatenate([point - u, [1.0, 0.0, 0.0, 0.0]]), "u": u}

    @staticmethod
    def point(b: np.ndarray, u: np.ndarray) -> np.ndarray:
        """Return the rider's point in global axes."""
        return np.asarray(b[:3] + turned(b[3:], u))

    @staticmethod
    def moved(numbers: Any, b: np.ndarray, motion: np.ndarray) -> np.ndarray:
        """Return the configuration after the translation motion[:3] and the rotation vector motion[3:] in body axes."""
        return np.concatenate([b[:3] + motion[:3], quaternion_product(b[3:], exponential(numbers, motion[3:]))])

    @staticmethod
    def step(b: np.ndarray, b_next: np.ndarray) -> np.ndarray:
        """Return the translation, and Cayley vector of the rotation in body axes, from one configuration to another."""
        turn = quaternion_product(np.concatenate([b[3:4], -b[4:]]), b_next[3:])
        return np.concatenate([b_next[:3] - b[:3], 2 * turn[1:] / turn[0]])

    @staticmethod
    def turn(b: np.ndarray, motion: np.ndarray) -> np.ndarray:
        """Return the rotation vector of a motion in global axes."""
        return turned(b[3:], motion[3:])

    @staticmethod
    def frame(random: np.random.Generator) -> tuple[Any, ...]:
        """Return a turn of the global frame: its matrix, and what it makes of a configuration."""
        p = exponential(np, random.normal(size=3))
        Q = np.stack([turned(p, column) for column in np.eye(3)], axis=1)
        return Q, lambda b: np.concatenate([Q @ b[:3], quaternion_product(p, b[3:])])

    @staticmethod
    def bracket(g: np.ndarray) -> np.ndarray:
        """Return K - K' of second derivatives by rotations about body axes: (j, i) differs from (i, j) by g along j x
        i.
        """
        units = np.eye(3)
        return np.array([[g @ cross(units[j], units[i]) for j in range(3)] for i in range(3)])


class PlanarRigid:
    """bodies/planar_rigid.py: b = (R, cosine, sine), velocities (R', omega)."""

    dim, n_velocity = planar_rigid.DIM, planar_rigid.N_VELOCITY
    rotations = slice(2, 3)

    @staticmethod
    def sample(random: np.random.Generator, near: np.ndarray) -> dict[str, np.ndarray]:
        """Return an attitude, a point and velocities, the point not far from `near` and off it."""
        angle, u = random.uniform(-np.pi, np.pi), random.normal(size=2) / 3
        turn = np.array([np.cos(angle), np.sin(angle)])
        R = near - complex_product(turn, u) + random.normal(size=2) / 8
        return {"b": np.concatenate([R, turn]), "u": u, "w": random.normal(size=3), "wdot": random.normal(size=3)}

    @staticmethod
    def at_rest(point: np.ndarray) -> dict[str, np.ndarray]:
        """Return a body that is not turned and has a point u here."""
        u = np.array([0.0, 0.25])
        return {"b": np.concatenate([point - u, [1.0, 0.0]]), "u": u}

    @staticmethod
    def point(b: np.ndarray, u: np.ndarray) -> np.ndarray:
        """Return the rider's point in global axes."""
        return np.asarray(b[:2] + complex_product(b[2:], u))

    @staticmethod
    def moved(numbers: Any, b: np.ndarray, motion: np.ndarray) -> np.ndarray:
        """Return the configuration after the translation motion[:2] and the rotation by the angle motion[2]."""
        turn = np.array([numbers.cos(motion[2]), numbers.sin(motion[2])])
        return np.concatenate([b[:2] + motion[:2], complex_product(b[2:], turn)])

    @staticmethod
    def step(b: np.ndarray, b_next: np.ndarray) -> np.ndarray:
        """Return the translation, and twice the tangent of half the angle, from one configuration to another."""
        turn = complex_product(np.array([b[2], -b[3]]), b_next[2:])
        return np.concatenate([b_next[:2] - b[:2], 2 * turn[1:] / (1 + turn[0])])

    @staticmethod
    def turn(b: np.ndarray, motion: np.ndarray) -> np.ndarray:
        """Return the rotation vector of a motion in global axes."""
        return spin(motion, 2)

    @staticmethod
    def frame(random: np.random.Generator) -> tuple[Any, ...]:
        """Return a turn of the global frame: its matrix, and what it makes of a configuration."""
        angle = random.uniform(-np.pi, np.pi)
        p = np.array([np.cos(angle), np.sin(angle)])
        Q = np.array([[p[0], -p[1]], [p[1], p[0]]])
        return Q, lambda b: np.concatenate([Q @ b[:2], complex_product(p, b[2:])])

    @staticmethod
    def bracket(g: np.ndarray) -> np.ndarray:
        """Return zero: one rotation commutes with itself."""
        return np.zeros((1, 1))


class Point:
    """bodies/point.py: b where the arm u starts, both in global axes."""

    def __init__(self, dim: int):
        self.dim = self.n_velocity = dim
        self.rotations = slice(dim, dim)

    def sample(self, random: np.random.Generator, near: np.ndarray) -> dict[str, np.ndarray]:
        """Return a point not far from `near` and off it, and velocities."""
        n, u, off = self.dim, random.normal(size=self.dim) / 3, random.uniform(0.5, 1.5, self.dim) / 8
        return {"b": near - u + off, "u": u, "w": 1 + random.normal(size=n), "wdot": random.normal(size=n)}

    def at_rest(self, point: np.ndarray) -> dict[str, np.ndarray]:
        """Return a point whose arm starts below it."""
        u = np.array([0.0, 0.25, 0.125])[: self.dim]
        return {"b": point - u, "u": u}

    def point(self, b: np.ndarray, u: np.ndarray) -> np.ndarray:
        """Return the rider's point in global axes."""
        return np.asarray(b + u)

    def moved(self, numbers: Any, b: np.ndarray, motion: np.ndarray) -> np.ndarray:
        """Return the origin after a translation."""
        return np.asarray(b + motion)

    def step(self, b: np.ndarray, b_next: np.ndarray) -> np.ndarray:
        """Return the translation from one configuration to another."""
        return np.asarray(b_next - b)

    def turn(self, b: np.ndarray, motion: np.ndarray) -> np.ndarray:
        """Return zero: a point does not turn."""
        return np.concatenate([0 * b, 0 * b])[:3]

    def frame(self, random: np.random.Generator) -> tuple[Any, ...]:
        """Return a turn of the global frame: its matrix, and what it makes of a configuration."""
        Q, _ = (Rigid if self.dim == 3 else PlanarRigid).frame(random)
        return Q, lambda b: Q @ b

    def bracket(self, g: np.ndarray) -> np.ndarray:
        """Return an empty matrix: a point has no rotations."""
        return np.zeros((0, 0))


RIDERS: dict[str, Motions] = {rigid.NAME: Rigid, planar_rigid.NAME: PlanarRigid,
                              **{name: Point(p.DIM) for name, p in POINTS.items()}}


def spin(w: np.ndarray, dim: int) -> np.ndarray:
    """Return the angular velocity, with zeros for the axes about which nothing turns in the plane."""
    return np.concatenate([w[:1] * 0] * (3 - len(w[dim:])) + [w[dim:]])


def swung(theta: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """Return theta x vector, the vector in the plane or in space."""
    return cross(theta, np.concatenate([vector, vector[:1] * 0])[:3])[: len(vector)]


def frame(numbers: Any, tangent: np.ndarray, director: np.ndarray | None) -> np.ndarray:
    """Return the tangent frame by Gram-Schmidt: i along the tangent, j in the plane of tangent and director, k = i x j.

    In the plane i and j; in space without a director i alone.
    """
    i = tangent / numbers.sqrt(tangent.dot(tangent))
    if len(tangent) == 2:
        return np.stack([i, np.array([-i[1], i[0]])], axis=1)
    if director is None:
        return np.asarray(i[:, None])
    j = director - i.dot(director) * i
    j = j / numbers.sqrt(j.dot(j))
    return np.stack([i, j, cross(i, j)], axis=1)


def spatial(vector: np.ndarray) -> np.ndarray:
    """Return a rotation in three dimensions: about z where it is one number."""
    zero = 0 * vector[:1]
    return {1: lambda: np.concatenate([zero, zero, vector]), 2: lambda: np.concatenate([vector, zero]),
            3: lambda: vector}[len(vector)]()


def turned_axes(numbers: Any, theta: np.ndarray, A: np.ndarray) -> np.ndarray:
    """Return the axes after a finite rotation about global axes."""
    q = exponential(numbers, spatial(theta))
    return np.stack([turned(q, spatial(column))[: len(column)] for column in A.T], axis=1)


def swung_axes(theta: np.ndarray, A: np.ndarray) -> np.ndarray:
    """Return theta~ A: the rate of axes that turn with theta."""
    return np.stack([cross(spatial(theta), spatial(column))[: len(column)] for column in A.T], axis=1)
