"""Unit quaternions (w, x, y, z) that take body axes to the ground's."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # 9 ms, and for type checkers alone


NEXT, LAST = np.array([1, 2, 0]), np.array([2, 0, 1])
"""Of each component, the one after it and the one after that."""


def cross(first: ArrayLike, second: ArrayLike) -> np.ndarray:
    """Return the vector products (..., 3) of vectors (..., 3), as `numpy.cross` does, in a quarter of its time for one.
    """
    a, b = np.asarray(first), np.asarray(second)
    return a.take(NEXT, -1) * b.take(LAST, -1) - a.take(LAST, -1) * b.take(NEXT, -1)


def rotate(quaternion: ArrayLike, vector: ArrayLike) -> np.ndarray:
    """Return vectors (..., 3) given in body axes in the ground's, by unit quaternions (..., 4)."""
    if isinstance(quaternion, tuple) and isinstance(vector, tuple) and isinstance(vector[0], float):
        return np.array(_rotated(quaternion, vector))
    components, drawn = np.asarray(quaternion), np.asarray(vector)
    w, axis = components[..., :1], components[..., 1:]
    turn = 2 * cross(axis, drawn)
    return drawn + w * turn + cross(axis, turn)


def _rotated(quaternion: tuple[Any, ...], vector: tuple[Any, ...]) -> list[float]:
    """Return what `rotate` does of one vector, of numbers, in a tenth of its time."""
    (w, i, j, k), (x, y, z) = quaternion, vector
    turn = u, v, t = 2 * (j * z - k * y), 2 * (k * x - i * z), 2 * (i * y - j * x)
    twice = j * t - k * v, k * u - i * t, i * v - j * u
    return [drawn + w * once + again for drawn, once, again in zip(vector, turn, twice, strict=True)]


def product(first: ArrayLike, second: ArrayLike) -> np.ndarray:
    """Return the quaternion (..., 4) of the rotation ``second``, in the axes that ``first`` turns, after ``first``."""
    a, b = np.asarray(first), np.asarray(second)
    w = a[..., :1] * b[..., :1] - np.sum(a[..., 1:] * b[..., 1:], axis=-1, keepdims=True)
    return np.concatenate([w, a[..., :1] * b[..., 1:] + b[..., :1] * a[..., 1:] + cross(a[..., 1:], b[..., 1:])],
                          axis=-1)


def turned_by(rotation: ArrayLike) -> np.ndarray:
    """Return the unit quaternions (..., 4) of rotation vectors (..., 3) in rad."""
    vector = np.asarray(rotation, dtype=float)
    half = np.linalg.norm(vector, axis=-1, keepdims=True) / 2
    return np.concatenate([np.cos(half), vector * np.sinc(half / np.pi) / 2], axis=-1)


def quaternion(A: np.ndarray) -> np.ndarray:
    """Return (4,): unit quaternion of a rotation matrix (3, 3), by its largest component."""
    squares = np.array([A.trace(), *(2 * np.diag(A) - A.trace())]) + 1
    k = int(np.argmax(squares))
    skew = np.array([A[2, 1] - A[1, 2], A[0, 2] - A[2, 0], A[1, 0] - A[0, 1]])
    if k == 0:
        q = np.concatenate([squares[:1], skew])
    else:
        q = np.concatenate([skew[k - 1 : k], (A + A.T)[k - 1]])
        q[k] = squares[k]
    return q / np.linalg.norm(q)


def conjugate(rotation: ArrayLike) -> np.ndarray:
    """Return the unit quaternions (..., 4) of the rotations back."""
    return np.asarray(rotation) * np.array([1.0, -1.0, -1.0, -1.0])
