"""Surfaces and contact with them, as the engine takes them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..kernels.mesh import Mesh
from ..parts.attachment import Attachment
from ..parts.contact import GAUSS_POINTS, Contact
from ..parts.modal_body import ModalBody
from ..parts.scene_data import SceneData
from ..parts.surface import Surface
from ..parts.surface_shapes import WIDE, Geometry
from ..parts.validation import Vector
from .attachments import AttachmentBuilder, AttachmentModel
from .coupling import CouplingModel
from .quadrature import along_elements

GAUSS = np.polynomial.legendre.leggauss(GAUSS_POINTS)
KERNELS = {2: "planar_surface", 3: "surface"}
NONE = np.zeros(0)
MARK_NUMBERS, AXES_NUMBERS, MARK_PLACE = 17, 9, slice(3, 6)
"""That a state keeps of friction: of a point, of a body's axes; places among them (couplings/contact/contact.h)."""
NO_TIME = 1e300
"""In s: FU_NO_TIME of engine/couplings/common/stick_friction.h."""


@dataclass(kw_only=True)
class SurfaceModel:
    """fu_surface of engine/couplings/common/surfaces.h, with a list of its one attachment."""

    kernel: str
    shape: str
    direction: np.ndarray
    round_radius: float
    half_length: float
    half_size: np.ndarray
    inside: int
    inset: float
    n_first: int
    n_second: int
    first: np.ndarray
    second: np.ndarray
    heights: np.ndarray
    highest: float
    steepest: float
    bend: float
    on: list[AttachmentModel]


@dataclass(kw_only=True)
class ContactModel(CouplingModel, SurfaceModel):
    """fu_contact of engine/couplings/contact/contact.h; cable -1: of a body, by its points, the attachments."""

    stiffness: float
    damping: float
    friction: float
    tangential: float
    hertz: int
    cable: int
    radius: float
    n_points: int
    stride: int = 0
    weights: np.ndarray = field(default_factory=lambda: NONE)
    N: np.ndarray = field(default_factory=lambda: NONE)
    arc: np.ndarray = field(default_factory=lambda: NONE)
    length: float = 0.0
    n_hull: int = 0
    hull: np.ndarray = field(default_factory=lambda: NONE)
    spread: np.ndarray = field(default_factory=lambda: NONE)
    marks: np.ndarray = field(default_factory=lambda: NONE)
    attachments: list[AttachmentModel] = field(default_factory=list)

    @property
    def ends(self) -> Sequence[AttachmentModel]:
        """Return what carries the surface, and the first of the points of a body that touch it."""
        return [*self.on, *self.attachments[:1]]

    @property
    def along(self) -> Sequence[int]:
        """Return the number of its cable, if it is on one."""
        return (self.cable,) if self.cable >= 0 else ()


def surface_entries(surface: Surface, scene: SceneData, attachments: AttachmentBuilder,
                    wall: Geometry | None = None) -> dict[str, Any]:
    """Return what a model has of a surface, by field: those of `SurfaceModel`; wall: of one of its walls alone."""
    shape, dim = surface.geometry if wall is None else wall, scene.dim
    origin = tuple(shape.origin.tolist())
    on = attachments.model(Attachment(on=surface.on, at=origin))
    on.axes = shape.axes[:dim, :dim].copy()
    first, second = (NONE if knots is None else knots for knots in (shape.first, shape.second))
    cells = NONE if shape.cells is None else shape.cells
    if shape.word == "terrain" and dim == 3 and shape.second is None:  # the same heights from side to side
        second = np.array([-WIDE, WIDE])
        cells = np.zeros((len(first) - 1, 1, 4, 4))
        cells[:, 0, :, 0] = shape.cells
    return {"kernel": KERNELS[dim], "shape": shape.word, "direction": shape.direction[:dim],
            "round_radius": shape.radius, "half_length": shape.half_length,
            "half_size": shape.half_size[:dim], "inside": int(shape.inside), "inset": 0.0,
            "n_first": len(first), "n_second": len(second), "first": first,
            "second": second, "heights": cells, "highest": shape.highest,
            "steepest": shape.steepest, "bend": shape.bend, "on": [on]}


def contact_model(part: Contact, scene: SceneData, attachments: AttachmentBuilder) -> ContactModel:
    """Return the model of a contact of the scene."""
    assert part.stiffness is not None and part.radius is not None, f"{part.where} is not complete"
    surface = scene.surfaces[part.b]
    entries = attachments.once(("surface", part.b), lambda: surface_entries(surface, scene, attachments))
    if entries["inside"] and entries["shape"] == "box":  # its walls as seen by a sphere's centre
        entries = entries | {"inset": part.radius, "half_size": entries["half_size"] - part.radius}
    tangential = part.stiffness if part.tangential_stiffness is None else part.tangential_stiffness
    model = ContactModel(
        **entries, type="contact", name=part.name or "",
        is_damped=part.damping > 0, stiffness=part.stiffness, damping=part.damping,
        friction=part.friction_coefficient, tangential=tangential, hertz=int(part.exponent == 1.5), cable=-1,
        radius=part.radius, n_points=0)
    if part.a in attachments.cable_index:
        drawn = _along_cable(model, attachments.cable_index[part.a], scene, attachments)
    else:
        assert part.points is not None, f"{part.where} is not complete"
        points = part.points
        model.n_points = len(points)
        model.attachments, model.spread, drawn = attachments.once(
            (part.a, points), lambda: _on_body(part.a, points, scene, attachments))
    if part.friction_coefficient:
        model.marks = _marks(part, scene, surface, drawn)
        model.n_numbers = model.marks.size
    return model


def _marks(part: Contact, scene: SceneData, surface: Surface, drawn: np.ndarray) -> np.ndarray:
    """Return the numbers (n,) of a state as drawn that friction begins with, of points drawn at (m, 3), in m."""
    on, body = scene.bodies.get(surface.on or ""), scene.bodies.get(part.a)
    points = np.zeros((len(drawn), MARK_NUMBERS))
    points[:, MARK_PLACE][:, : scene.dim] = surface.geometry.into(surface.in_axes(on, drawn))[:, : scene.dim]
    axes = np.zeros(AXES_NUMBERS)
    if body is not None:
        ends = np.array([body.point(tuple(point)) for point in np.vstack([np.zeros(3), np.eye(3)])])
        ends = surface.geometry.into(surface.in_axes(on, ends))
        turned = (ends[1:] - ends[0]).T[: scene.dim, : scene.dim]
        axes[: turned.size] = turned.ravel()
    return np.concatenate([points.ravel(), axes, [NO_TIME]])


def _on_body(name: str, points: tuple[Vector, ...], scene: SceneData,
             attachments: AttachmentBuilder) -> tuple[list[AttachmentModel], np.ndarray, np.ndarray]:
    """Return points of a body, (1,) how far they are from its centre at most, and (n, 3) where they are drawn, in m."""
    body = scene.bodies[name]
    on = [attachments.model(Attachment(on=name, at=point)) for point in points]
    for each in on:
        each.axes = np.eye(scene.dim)  # those of the body, by whose turning spheres roll
    assert not isinstance(body, ModalBody), f"{body.where} touches no surfaces"
    farthest = np.linalg.norm([body.arm(point) for point in points], axis=1).max()
    return on, np.array([farthest]), np.array([body.point(point) for point in points])


def _along_cable(model: ContactModel, index: int, scene: SceneData, attachments: AttachmentBuilder) -> np.ndarray:
    """Add the quadrature on a cable; return (n, 3): where its points are drawn."""
    cable = attachments.cables[index]
    hull = attachments.hull(index)
    model.cable, model.n_points, model.length = index, len(GAUSS[0]), cable.mesh.total
    model.N, _, model.weights = along_elements(cable.kernel("on_axis"), cable.mesh.lengths, GAUSS)
    model.hull, model.spread, model.n_hull = hull.points, hull.spread, hull.points.shape[1]
    model.stride = 0 if cable.mesh.is_even else model.n_points
    model.arc = _arc_lengths(cable.mesh, GAUSS[0])
    vectors = scene.cables[cable.name].nodal_vectors
    both = np.concatenate([vectors[:-1], vectors[1:]], axis=1)
    N = np.broadcast_to(model.N, (cable.n_elements, *model.N.shape[1:]))
    return np.einsum("egk,ekd->egd", N, both).reshape(-1, 3)


def _arc_lengths(mesh: Mesh, x: np.ndarray) -> np.ndarray:
    """Return (elements points,): arc-lengths of points on all elements, in m."""
    starts = mesh.node_s[:-1, None]
    return (starts + np.diff(mesh.node_s)[:, None] * (1 + x) / 2).ravel()
