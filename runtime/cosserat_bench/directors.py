"""Directors of rods: a material direction of each element, across it, over the frames of a motion.

Beams have sections that turn; cables have none: their directors turn with the line and about it nowhere (Bishop's
frame), since a round rod without torsion does not twist.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ..base.rotations import cross


def tangents_of(positions: np.ndarray) -> np.ndarray:
    """Return (..., elements, 3): unit vectors along the chords between nodes (..., nodes, 3)."""
    chords = np.diff(positions, axis=-2)
    return chords / np.linalg.norm(chords, axis=-1, keepdims=True)


def transported(directors: np.ndarray, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Return directions (..., 3) turned by the smallest rotation that takes unit tangents to others, none of which may
    be opposite.
    """
    axis = cross(before, after)
    cosine = np.sum(before * after, axis=-1, keepdims=True)
    along = np.sum(axis * directors, axis=-1, keepdims=True)
    return directors * cosine + cross(axis, directors) + axis * along / (1 + cosine)


def of_sections(heights: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """Return (frames, elements, 3): directors of beams, from their sections' heights (frames, nodes, 3)."""
    tangents = tangents_of(positions)
    middle = heights[:, :-1] + heights[:, 1:]
    across = middle - np.sum(middle * tangents, axis=-1, keepdims=True) * tangents
    return across / np.linalg.norm(across, axis=-1, keepdims=True)


def untwisted(first: np.ndarray, positions: np.ndarray, clamped: int | None) -> np.ndarray:
    """Return (frames, elements, 3): directors of a rod without twist, in frames with nodes at positions.

    first: those (elements, 3) that it starts with; clamped: the element at a clamp, 0 or -1, None where there is none.
    An element at a clamp turns as its tangent does since the start. Without a clamp the first one keeps its director
    from frame to frame but for the turn of its tangent. The other elements follow along the rod.
    """
    tangents, turned = tangents_of(positions), np.empty((len(positions), *first.shape))
    order = range(len(first))[::-1 if clamped == -1 else 1]
    at = order[0]
    turned[0] = first
    if clamped is None:
        for frame in range(1, len(positions)):
            turned[frame, at] = transported(turned[frame - 1, at], tangents[frame - 1, at], tangents[frame, at])
    else:
        turned[1:, at] = transported(first[at], tangents[0, at], tangents[1:, at])
    for here, there in pairwise(order):
        turned[1:, there] = transported(turned[1:, here], tangents[1:, here], tangents[1:, there])
    return turned
