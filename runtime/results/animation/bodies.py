"""Rigid bodies in a picture: their frames over time, and their given shape or one of plausible size."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...errors import FunicularError
from ...parts.rigid_body import RigidBody
from ...parts.solids import Box, Cylinder, MeshShape, Solid, Sphere
from ...view.animation import BodyShape
from ...view.mesh_files import read_mesh
from ...view.surfaces import BOX
from .frames import Frames, one_or_all

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # 9 ms, for type checkers alone

MAX_DENSITY, MIN_DENSITY = 7850.0, 50.0
"""Bounds of the density of a plausible shape, of steel and of a mostly hollow body, kg/m³."""
PRINCIPAL_TOLERANCE = 1e-9
"""Products of inertia over the largest moment of inertia up to which body axes are principal axes."""


def body_shape(frames: Frames, refs: Frames, name: str, notes: list[str]) -> BodyShape:
    """Return a rigid body of the scene; notes: receives failures; refs: see `references`."""
    body = frames.scene.bodies[name]
    assert isinstance(body, RigidBody)
    shape = None
    if body.shape is not None:
        try:
            shape = given_shape(body.shape)
        except FunicularError as error:
            notes.append(f'body "{name}" is drawn as a box of its inertia: {error}')
    quantities = {}
    for key, label, unit in (("velocity", "speed", "m/s"), ("acceleration", "acceleration", "m/s²")):
        if frames.has(f"{name}.{key}"):
            quantities[label] = unit, np.linalg.norm(frames.value(f"{name}.{key}"), axis=-1)
    return BodyShape(name, frames.value(f"{name}.position"), frames.value(f"{name}.orientation"),
                     plausible_shape(body) if shape is None else shape, one_or_all(refs.value(f"{name}.position")),
                     quantities)


def given_shape(solid: Solid) -> dict[str, object]:
    """Return the given shape of a body for pictures. Raises FunicularError for an unreadable mesh file."""
    offset = list(solid.at)
    match solid:
        case Box():
            return box_shape(solid, offset)
        case Sphere():
            return {"kind": "sphere", "radius": solid.radius, "offset": offset}
        case Cylinder():
            axis = np.array(solid.axis) / np.linalg.norm(solid.axis)
            return {"kind": "cylinder", "radius": solid.radius, "length": solid.length, "axis": axis.tolist(),
                    "offset": offset}
        case MeshShape():
            vertices, triangles = read_mesh(solid.file)
            return mesh_shape(solid.scale * vertices, triangles, solid.at)
    raise FunicularError(f"pictures know no shape of the kind {solid.kind!r}")


def mesh_shape(vertices: np.ndarray, triangles: np.ndarray, offset: ArrayLike) -> dict[str, object]:
    """Return a mesh for pictures, with an offset (3,) in m."""
    return {"kind": "mesh", "vertices": vertices, "triangles": triangles, "offset": np.asarray(offset).tolist()}


def box_shape(box: Box, offset: list[float]) -> dict[str, object]:
    """Return a box for pictures, its middle at an offset (3,) in m."""
    if np.array_equal(box.axes, np.eye(3)):
        return {"kind": "box", "size": list(box.size), "offset": offset}
    vertices, triangles = BOX
    return mesh_shape((vertices * box.size) @ box.axes.T, triangles, offset)


def plausible_shape(body: RigidBody) -> dict[str, object]:
    """Return the box of a body's mass and inertia for pictures: about the mass centre, along the principal axes."""
    inertia = np.array(body.inertia)
    products = inertia - np.diag(np.diag(inertia))
    if np.abs(products).max() <= PRINCIPAL_TOLERANCE * np.abs(inertia).max():
        return {"kind": "box", "size": plausible_size(body.mass, np.diag(inertia)).tolist(),
                "offset": list(body.centre)}
    moments, axes = np.linalg.eigh(inertia)
    if np.linalg.det(axes) < 0:
        axes[:, 0] *= -1
    vertices, triangles = BOX
    return mesh_shape((vertices * plausible_size(body.mass, moments)) @ axes.T, triangles, body.centre)


def plausible_size(mass: float, moments: np.ndarray) -> np.ndarray:
    """Return the lengths (3,) in m of a box for a mass in kg and principal moments of inertia (3,) in kg m².

    It is the homogeneous box of that inertia. Above `MAX_DENSITY`, as for a thin rod or a mass point, its short sides
    grow; below `MIN_DENSITY`, all sides shrink.
    """
    squares = np.maximum(6.0 / mass * (moments.sum() - 2 * moments), 0.0)
    size = np.sqrt(squares)
    min_volume = mass / MAX_DENSITY
    order = np.argsort(size)
    for thin in (1, 2, 3):  # sides that grow to one length
        others = np.prod(size[order[thin:]])
        side = (min_volume / others) ** (1 / thin) if others > 0 else np.inf
        if thin == 3 or side <= size[order[thin]]:
            size[order[:thin]] = np.maximum(size[order[:thin]], side)
            break
    return np.asarray(size * min(1.0, float(np.cbrt(mass / MIN_DENSITY / np.prod(size)))))
