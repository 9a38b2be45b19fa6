"""Unit quaternions (w, x, y, z) that take body axes to the ground's."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # 9 ms, and for type checkers alone

def rotate(quaternion: ArrayLike, vector: ArrayLike) -> np.ndarray:
    """Return vectors (..., 3) given in body axes in the ground's, by unit quaternions (..., 4)."""
    components, drawn = np.asarray(quaternion), np.asarray(vector)
    w, axis = components[..., :1], components[..., 1:]
    turn = 2 * np.cross(axis, drawn)
    return drawn + w * turn + np.cross(axis, turn)
