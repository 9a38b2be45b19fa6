"""Surfaces in a picture: of contact, as a part of a plane or height field, boxes and round shapes; of fluids.
"""

from __future__ import annotations

import numpy as np

from ...base.linear_waves import moved_to
from ...parts.fluid import Fluid
from ...parts.solids import Box, Sphere
from ...parts.surface import Surface
from ...parts.surface_shapes import Geometry
from ...view.animation import BodyShape
from ...view.surfaces import Surface as Mesh
from ...view.surfaces import grid_mesh, square_to
from .bodies import box_shape, mesh_shape
from .frames import Frames, one_or_all
from .hollows import hollow_mesh

GRID_CELLS = 12
"""Cells of a plane to each side of its middle."""
CELLS_A_WAVE, MAX_CELLS = 10, 160
"""Of the surface of a fluid: cells for the shortest wave, and the largest number along a side."""
MAX_DISTANCE = 2.0
"""Distance from the centre, in sizes of the scene, within which the surface of a fluid is drawn."""


def surface_shape(frames: Frames, name: str, centre: np.ndarray, size: float) -> BodyShape:
    """Return a surface of the scene as a body, at rest or moving with the body that carries it.

    centre (3,), size: of the scene, in m; an unbounded surface is drawn to this distance from the centre.
    """
    surface = frames.scene.surfaces[name]
    shape, times = surface.geometry, len(frames.time)
    if surface.on is None:
        origin = centre - shape.distance(centre) * shape.direction if shape.word == "flat" else shape.origin
        return _at_rest(name, origin, times, _drawn(surface, shape, size, np.zeros(3)))
    position, orientation = (frames.value(f"{surface.on}.{what}") for what in ("position", "orientation"))
    return BodyShape(name, position, orientation, _drawn(surface, shape, size, shape.origin), one_or_all(position))


def _at_rest(name: str, origin: np.ndarray, times: int, shape: dict[str, object]) -> BodyShape:
    """Return a body at rest with this origin (3,), along the ground's axes."""
    position = np.broadcast_to(origin, (times, 3))
    return BodyShape(name, position, np.broadcast_to([1.0, 0.0, 0.0, 0.0], (times, 4)), shape, one_or_all(position))


def level_shapes(frames: Frames, centre: np.ndarray, size: float) -> list[BodyShape]:
    """Return the surfaces of fluids near the scene, level or with their waves; centre (3,), size: of the scene, m."""
    up, found = frames.scene.up, []
    for name, fluid in frames.scene.fluids.items():
        if fluid.surface is not None and abs(above := fluid.surface - up @ centre) <= MAX_DISTANCE * size:
            origin = centre + above * up
            found.append(_at_rest(name, origin, len(frames.time), _water(frames, fluid, origin, size)))
    return found


def _water(frames: Frames, fluid: Fluid, origin: np.ndarray, size: float) -> dict[str, object]:
    """Return the shape of the surface of a fluid about an origin (3,): level, or with waves where time passes."""
    up = frames.scene.up
    gravity = float(np.linalg.norm(frames.scene.gravity))
    waves = moved_to(fluid.components(gravity), origin) if frames.moves and gravity else np.zeros((0, 6))
    sides = square_to(up)
    cells = [_cells(float(np.abs(waves[:, 3:] @ side).max(initial=0)), size) for side in sides]
    along, across = (side.tolist() for side in sides)
    return {"kind": "water", "sheet": "water", "size": float(size), "along": along, "across": across, "cells": cells,
            "up": up.tolist(), "waves": waves}


def _cells(wave_number: float, size: float) -> int:
    """Return the number of cells along a side that show waves of up to a number, 1/m, along it."""
    return int(np.clip(np.ceil(CELLS_A_WAVE * wave_number * size / np.pi), 2 * GRID_CELLS, MAX_CELLS))


def _drawn(surface: Surface, shape: Geometry, size: float, offset: np.ndarray) -> dict[str, object]:
    """Return the shape for pictures."""
    if shape.inside:
        return mesh_shape(*hollow_mesh(shape), offset)
    if isinstance(surface.shape, Sphere):
        return {"kind": "sphere", "radius": shape.radius, "offset": offset.tolist()}
    if isinstance(surface.shape, Box):
        return box_shape(surface.shape, offset.tolist())
    if shape.word in ("round", "capsule"):
        length = getattr(surface.shape, "length", 0.0) + (2 * shape.radius if shape.word == "capsule" else 0.0)
        return {"kind": "cylinder", "radius": shape.radius, "length": length, "axis": shape.direction.tolist(),
                "offset": offset.tolist()}
    sheet = _plane(shape.direction, size) if shape.word == "flat" else _height_field(shape, size)
    return mesh_shape(*sheet, offset) | {"sheet": "ground"}


def _plane(normal: np.ndarray, size: float) -> Mesh:
    """Return a square part of a plane about the origin."""
    along, across = square_to(normal)
    u = np.linspace(-size, size, 2 * GRID_CELLS + 1)
    return grid_mesh(u[:, None, None] * along + u[None, :, None] * across)


def _height_field(shape: Geometry, size: float) -> Mesh:
    """Return a height field within its table; across, half the size of the scene without a table."""
    assert shape.first is not None
    x = np.linspace(shape.first[0], shape.first[-1], 4 * GRID_CELLS + 1)
    across = (np.linspace(-size / 4, size / 4, 3) if shape.second is None else
              np.linspace(shape.second[0], shape.second[-1], 4 * GRID_CELLS + 1))
    heights = shape.heights(x[:, None], across[None, :])[0]
    points = np.stack(np.broadcast_arrays(x[:, None], heights, across[None, :]), axis=-1)
    return grid_mesh(points @ shape.axes.T)
