"""Cables in a picture: the centre line at stations, the direction of the section, quantities for colours."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...base.rotations import rotate
from ...errors import FunicularError
from ...parts.cable import Cable
from ...parts.material import Material
from ...parts.modal_body import ModalBody
from ...parts.section import Circle, Rectangle, Section, Tube
from ...view.animation import CableShape, Quantity, taken
from .frames import Frames, along

CABLE_STATIONS = 120
MIN_DIVISIONS, MAX_DIVISIONS = 2, 16
"""Bounds of the stations per element, which give about `CABLE_STATIONS` on a cable."""
SLENDERNESS = 200.0
"""Length over diameter of a line of unknown section."""
MAX_DEVIATION = 0.1
"""Largest distance of the nodes of a modal body from a line, over its length, for them to be drawn as a line."""


def stations(cable: Cable) -> np.ndarray:
    """Return the arc-lengths (P,) in m at which a cable is drawn, its nodes among them."""
    return cable.divided(int(np.clip(np.ceil(CABLE_STATIONS / cable.elements), MIN_DIVISIONS, MAX_DIVISIONS)))


def cable_shapes(frames: Frames, name: str, notes: list[str]) -> Iterator[CableShape]:
    """Yield a cable of the scene, or its pieces; notes: receives failures."""
    cable, s = frames.scene.cables[name], stations(frames.scene.cables[name])
    nodal = frames.value(f"{name}.nodal_vectors")
    whole = CableShape(name, s, along(cable, s, nodal), section_direction(cable, s, nodal), {},
                       along(cable, s, frames.reference(f"{name}.nodal_vectors")),
                       tuple(_quantities(frames, name, s, notes)))
    pieces, per_element = cable.uniform_pieces, (len(s) - 1) // cable.elements
    makes: list[tuple[Section, Material]] = []
    for k, piece in enumerate(pieces):
        own = np.arange(per_element * piece.first, per_element * piece.end + 1)
        shape = whole if len(pieces) == 1 else taken(replace(whole, name=f"{name}, piece {k}"), "P", own, len(s))
        if (make := (piece.section, piece.material)) not in makes:
            makes.append(make)
        yield replace(shape, section=section_data(piece.section), make=makes.index(make) if len(pieces) > 1 else None)


def section_direction(cable: Cable, s: np.ndarray, nodal: np.ndarray) -> np.ndarray | None:
    """Return the unit vectors (T, P, 3) of the section's height; None for a cable without a director.

    The height of planar cables lies in the plane, normal to the tangent.
    """
    if "r_y" in cable.kind_of_element.nodal_vectors:
        height = along(cable, s, nodal, slope=1)
    elif cable.kind_of_element.director:
        height = np.cross(along(cable, s, nodal, slope=2), along(cable, s, nodal, slope=0))
    elif cable.dim == 2:
        height = np.cross(cable.normal, along(cable, s, nodal, slope=0))
    else:
        return None
    size = np.linalg.norm(height, axis=-1, keepdims=True)
    return np.asarray(height / np.where(size > 0, size, 1.0))


def section_data(section: Section) -> dict[str, object]:
    """Return a section for pictures; of one given by its constants the circle of its area."""
    match section:
        case Rectangle():
            return {"shape": "rectangle", "height": section.height, "width": section.width}
        case Circle():
            return {"shape": "circle", "diameter": 2 * section.radius}
        case Tube():
            return {"shape": "tube", "diameter": 2 * section.outer_radius,
                    "thickness": section.outer_radius - section.inner_radius}
    return {"shape": "unknown", "size": float(np.sqrt(4 * section.area / np.pi))}


def _quantities(frames: Frames, name: str, s: np.ndarray, notes: list[str]) -> list[Quantity]:
    cable, found = frames.scene.cables[name], []
    try:
        forces = frames.section_forces(name, s)
    except (FunicularError, RuntimeError) as error:  # RuntimeError: singular factorisation
        forces = {}
        notes.append(f'tension and strain of "{name}" could not be computed: {error}')
    if forces:
        bent = [forces[key] for key in ("curvature", "curvature_y", "curvature_z") if key in forces]
        found = [Quantity("tension", "tension", "N", forces["tension"]),
                 Quantity("strain", "axial strain", "1", forces["strain"]),
                 Quantity("curvature", "curvature", "1/m", np.linalg.norm(bent, axis=0))]
        if cable.kind_of_element.director:
            found.append(Quantity("moment", "moment in the section", "N m",
                                  np.linalg.norm(forces["moment"], axis=-1)))
    if frames.has(f"{name}.nodal_velocity"):
        velocity = along(cable, s, frames.value(f"{name}.nodal_velocity"))
        found.append(Quantity("speed", "speed", "m/s", np.linalg.norm(velocity, axis=-1)))
    return found


def modal_line(frames: Frames, name: str) -> CableShape | None:
    """Return a modal body as the deformed line through its nodes; None if its nodes are on no line."""
    body = frames.scene.bodies[name]
    assert isinstance(body, ModalBody)
    order = line_order(body.shape.nodes)
    if order is None:
        return None
    nodes, position = body.shape.nodes[order], frames.value(f"{name}.nodes")[:, order]
    s = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(nodes, axis=0), axis=1)))
    section: dict[str, object] = {"shape": "unknown", "size": s[-1] / SLENDERNESS}
    height = None
    if body.section is not None:
        section = section_data(body.section)
        up = rotate(frames.value(f"{name}.orientation"), (0.0, 1.0, 0.0))[:, None]
        height = np.broadcast_to(up, position.shape)
    return CableShape(name, s, position, height, section, frames.reference(f"{name}.nodes")[order])


def line_order(nodes: np.ndarray) -> np.ndarray | None:
    """Return the order of nodes (N, 3) along a line; None if they are on no line."""
    if len(nodes) < 2:
        return None
    centred = nodes - nodes.mean(axis=0)
    along_line = np.linalg.svd(centred, full_matrices=False)[2][0]
    reach = centred @ along_line
    off = np.linalg.norm(centred - np.multiply.outer(reach, along_line), axis=1)
    if off.max() > MAX_DEVIATION * np.ptp(reach):
        return None
    order = np.argsort(reach, kind="stable")
    return order if reach[0] <= reach[-1] else order[::-1]
