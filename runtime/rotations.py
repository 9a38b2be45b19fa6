"""Unit quaternions (w, x, y, z) that take body axes to the ground's."""

from __future__ import annotations

import numpy as np


def rotate(quaternion: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """A vector (..., 3) of body axes in the ground's, by unit quaternions (..., 4)."""
    quaternion, vector = np.asarray(quaternion), np.asarray(vector)
    w, axis = quaternion[..., :1], quaternion[..., 1:]
    turn = 2 * np.cross(axis, vector)
    return vector + w * turn + np.cross(axis, turn)
