"""Wheels of ropes in space that are on cables."""

from __future__ import annotations

import numpy as np

from ...base.rotations import unit
from ...checks.frames import draws_section
from ...checks.rope_carriers import carried_groove
from ...parts.attachment import Attachment
from .frames import Frames, along


def axes_on_cable(frames: Frames, end: Attachment, groove: np.ndarray) -> np.ndarray:
    """Return (T, 3, 3), by columns: the plane of a groove (3, 2) as drawn, and its axis, turned with the cable."""
    assert end.on is not None
    cable, carried = frames.scene.cables[end.on], carried_groove(frames.scene, end, groove)
    vectors, s = frames.value(f"{end.on}.nodal_vectors"), np.array([end.arc_length])

    def slope(k: int) -> np.ndarray:
        return along(cable, s, vectors, k)[:, 0]

    if draws_section(cable):
        height = unit(slope(1))
        normal = unit(np.cross(height, slope(2)))
        frame = np.stack([normal, height, np.cross(normal, height)], axis=-1)
    else:
        director, tangent = cable.kind_of_element.director, unit(slope(0))
        across = slope("xyz".index(director[-1])) if director else np.asarray(carried.up)
        width = unit(np.cross(tangent, across))
        frame = np.stack([tangent, np.cross(width, tangent), width], axis=-1)
    found: np.ndarray = frame @ carried.axes
    return found
