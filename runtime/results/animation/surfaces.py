"""Surfaces in a picture. Those that cables and bodies touch: a piece of a plane or of hills, boxes, and what is round.
Those of fluids: a net, through which one sees what is below.
"""

from __future__ import annotations

import numpy as np

from ...parts.solids import Box, Sphere
from ...parts.surface import Surface
from ...parts.surface_shapes import Geometry
from ...view.animation import BodyShape
from .bodies import box_shape
from .frames import Frames, one_or_all
from .hollows import hollow_mesh
from .meshes import grid_mesh, joined, square_to

PIECES = 12
"""Of a plane to each side, and points of a half circle."""
IN_SIGHT = 2.0
"""Sizes of the scene from its centre within which the surface of a fluid is drawn."""
STRIP = 0.05
"""Of a mesh of the net that a fluid's surface is: the width of its lines."""


def surface_shape(frames: Frames, name: str, centre: np.ndarray, size: float) -> BodyShape:
    """Return a surface of the scene as a body that stands still, or moves with the one that it is on.

    centre (3,), size: of the scene, in m; what has no end is drawn that far about it.
    """
    surface = frames.scene.surfaces[name]
    shape, times = surface.geometry, len(frames.time)
    if surface.on is None:
        origin = centre - shape.distance(centre) * shape.direction if shape.word == "flat" else shape.origin
        position = np.broadcast_to(origin, (times, 3))
        orientation = np.broadcast_to([1.0, 0.0, 0.0, 0.0], (times, 4))
        drawn = _drawn(surface, shape, size, np.zeros(3))
    else:
        position, orientation = (frames.value(f"{surface.on}.{what}") for what in ("position", "orientation"))
        drawn = _drawn(surface, shape, size, shape.origin)
    return BodyShape(name, position, orientation, drawn, one_or_all(position))


def level_shapes(frames: Frames, centre: np.ndarray, size: float) -> list[BodyShape]:
    """Return the surfaces of fluids that are in sight as nets that stand still; centre (3,), size: of the scene, m."""
    up, found = frames.scene.up, []
    for name, fluid in frames.scene.fluids.items():
        if fluid.surface is not None and abs(above := fluid.surface - up @ centre) <= IN_SIGHT * size:
            position = np.broadcast_to(centre + above * up, (len(frames.time), 3))
            orientation = np.broadcast_to([1.0, 0.0, 0.0, 0.0], (len(frames.time), 4))
            vertices, triangles = _net(up, size)
            shape = {"kind": "mesh", "vertices": vertices, "triangles": triangles, "offset": [0.0, 0.0, 0.0]}
            found.append(BodyShape(name, position, orientation, shape, one_or_all(position)))
    return found


def _net(normal: np.ndarray, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Return a square net about the origin."""
    along, across = square_to(normal)
    u, half = np.linspace(-size, size, 2 * PIECES + 1), STRIP * size / PIECES / 2
    ends = np.array([-size - half, size + half])
    return joined([grid_mesh(ends[:, None, None] * one + (at + np.array([-half, half]))[None, :, None] * other)
                   for one, other in ((along, across), (across, along)) for at in u])


def _drawn(surface: Surface, shape: Geometry, size: float, offset: np.ndarray) -> dict[str, object]:
    """Return the shape as pictures take it."""
    if shape.inside:
        vertices, triangles = hollow_mesh(shape)
        return {"kind": "mesh", "vertices": vertices, "triangles": triangles, "offset": offset.tolist()}
    if isinstance(surface.shape, Sphere):
        return {"kind": "sphere", "radius": shape.radius, "offset": offset.tolist()}
    if isinstance(surface.shape, Box):
        return box_shape(surface.shape, offset.tolist())
    if shape.word in ("round", "capsule"):
        length = getattr(surface.shape, "length", 0.0) + (2 * shape.radius if shape.word == "capsule" else 0.0)
        return {"kind": "cylinder", "radius": shape.radius, "length": length, "axis": shape.direction.tolist(),
                "offset": offset.tolist()}
    vertices, triangles = _plane(shape, size) if shape.word == "flat" else _hills(shape, size)
    return {"kind": "mesh", "vertices": vertices, "triangles": triangles, "offset": offset.tolist()}


def _plane(shape: Geometry, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Return a square piece of a plane about its origin."""
    along, across = square_to(shape.direction)
    u = np.linspace(-size, size, 2 * PIECES + 1)
    return grid_mesh(u[:, None, None] * along + u[None, :, None] * across)


def _hills(shape: Geometry, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Return a height field between the ends of its table, from side to side as wide as the scene without a table."""
    assert shape.first is not None
    x = np.linspace(shape.first[0], shape.first[-1], 4 * PIECES + 1)
    across = (np.linspace(-size / 4, size / 4, 3) if shape.second is None else
              np.linspace(shape.second[0], shape.second[-1], 4 * PIECES + 1))
    heights = shape.heights(x[:, None], across[None, :])[0]
    points = np.stack(np.broadcast_arrays(x[:, None], heights, across[None, :]), axis=-1)
    return grid_mesh(points @ shape.axes.T)
