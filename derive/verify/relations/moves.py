"""Moves of bodies under verification: by quaternions and complex numbers in any kind of number."""

from __future__ import annotations

import numpy as np

from ..methods import Relation
from ..numbers import Numbers


def moves(rider) -> list[Relation]:
    """Return the relations of the kernels of moves."""
    n, dim = rider.n_velocity, rider.dim
    turns = n - dim

    def stepped(kernel):
        """Return the turn that a change of the step's turn j makes, in body axes."""
        def path(k, s, t, j):
            change = t * np.eye(n, dtype=int)[dim + j]
            at, then = (moved[kernel](k, s["b"], step) for step in (s["step"], s["step"] + change))
            return rider.step(at, then)[dim:]
        return path

    moved = {"move_tangent": rider.moved,
             "cayley_tangent": lambda k, b, step: _normalised(k, _cayley(rider, b, step), dim)}

    def velocity(k, s):
        return k("increment", s, change=k("rate", s)["b_rate"])["step"]

    def increment(k, s, t, j):
        """Return the increment of the part of the change that turns: the rest of it makes the attitude longer."""
        attitude, change = s["b"][dim:], s["change"][dim:]
        along = change - attitude * (attitude.dot(change) / attitude.dot(attitude))
        return k("increment", s, change=np.concatenate([s["change"][:dim], along]))["step"]

    def first_half(k, s):
        return rider.step(s["b"], k("halfway", s)["b_half"])

    return [
        Relation("move", "b_next", "by the exponential of a quaternion or complex number", 0,
                 lambda k, s, t, j: rider.moved(k, s["b"], s["step"])),
        Relation("move_tangent", "T", "turn by the change of the rotation vector", 1, stepped("move_tangent"), turns),
        Relation("cayley_move", "b_next", "by Cayley's map, of unit size", 0,
                 lambda k, s, t, j: _normalised(k, _cayley(rider, s["b"], s["step"]), dim)),
        Relation("cayley_tangent", "T", "turn by the change of the Cayley vector", 1, stepped("cayley_tangent"), turns),
        Relation("cayley_error", "error", "(Magnus) w x a + |w|^2 w, over -12", 0, lambda k, s, t, j: _cayley_error(
            s["w"][dim:], s["a"][dim:])),
        Relation("halfway", "b_half", "the second half of the step is the first", 0,
                 lambda k, s, t, j: rider.step(k("halfway", s)["b_half"], s["b_next"]), of=first_half),
        Relation("rate", "b_rate", "db/dt", 1, lambda k, s, t, j: rider.moved(k, s["b"], t * s["w"])),
        Relation("increment", "step", "w of db/dt", 0, lambda k, s, t, j: s["w"], of=velocity),
        Relation("increment", "step", "what makes the attitude longer does not count", 0, increment),
    ]


def _cayley(rider, b: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Return b moved by a Cayley vector, its attitude not of unit size."""
    still, half = np.concatenate([0 * b[: rider.dim], b[rider.dim :]]), step[rider.dim :] / 2
    size = half.dot(half)
    if rider.dim == 2:
        turn = np.array([1 - size, 2 * half[0]])
        c, s = still[2:]
        attitude = np.array([c * turn[0] - s * turn[1], s * turn[0] + c * turn[1]])
    else:
        w, v = still[3], still[4:]
        attitude = np.concatenate([[w - v.dot(half)], v + w * half
                                   + np.array([v[i - 2] * half[i - 1] - v[i - 1] * half[i - 2] for i in range(3)])])
    return np.concatenate([b[: rider.dim] + step[: rider.dim], attitude])


def _cayley_error(w: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Return the error of Cayley's map, -|w|^2 w/12, less the second term of Magnus' series, w x a/12."""
    return -(w.dot(w) * w + (np.cross(w, a) if len(w) == 3 else 0)) / 12


def _normalised(k: Numbers, b: np.ndarray, dim: int) -> np.ndarray:
    return np.concatenate([b[:dim], b[dim:] / k.sqrt(b[dim:].dot(b[dim:]))])
