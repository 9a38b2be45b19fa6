"""Where the surfaces of bodies are at a frame, and their outlines in a picture."""

from __future__ import annotations

import numpy as np

from ..base.rotations import rotate
from .animation import BodyShape
from .surfaces import Surface, surface


def placed_surface(body: BodyShape, frame: int) -> Surface:
    """Return the surface of a body at a frame: vertices (V, 3) in m along the ground's axes, and triangles."""
    vertices, triangles = surface(body.shape)
    return body.position[frame] + rotate(body.orientation[frame], vertices), triangles


def outline(points: np.ndarray) -> np.ndarray:
    """Return the corners (n, 2) of the convex hull of points (N, 2) in order; the points where they are on a line."""
    from scipy.spatial import ConvexHull, QhullError  # for pictures alone

    try:
        return points[ConvexHull(points).vertices]
    except QhullError:
        return points
