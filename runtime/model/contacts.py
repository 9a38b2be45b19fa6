"""Surfaces and contact with them, as the engine takes them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import product
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
from .attachments import AttachmentModel, ModelBuilder
from .coupling import CouplingKind, CouplingModel
from .quadrature import along_elements

GAUSS = np.polynomial.legendre.leggauss(GAUSS_POINTS)
KERNELS = {2: "planar_surface", 3: "surface"}
NONE = np.zeros(0)
MARK_NUMBERS, AXES_NUMBERS, MARK_PLACE = 17, 9, slice(3, 6)
"""That a state keeps of friction: of a point, of a body's axes; places among them (couplings/contact/contact.h)."""
NO_TIME = 1e300
"""In s: FU_NO_TIME of engine/couplings/common/stick_friction.h."""
STATIC_COMPLIANCE = 1e-10
"""Penetration, in m, of a hard contact in statics under the weight of its body."""


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


@dataclass(kw_only=True)
class HardContactModel(ContactModel):
    """fu_hard_contact of hard_contact.h, of one point of a body; without what a penalty has.

    restitution: of the normal velocity; rest_velocity: m/s, below which what would part stays; sliding: Coulomb's
    coefficient; weight: N, of the body;
    static_stiffness: N/m, of the little by which it gives way in statics, so that points that hold the same share it.
    """

    restitution: float
    rest_velocity: float
    sliding: float
    weight: float
    static_stiffness: float

    @property
    def ends(self) -> Sequence[AttachmentModel]:
        """Return the point and what carries the surface."""
        return [*self.attachments, *self.on]


def _surface_entries(surface: Surface, builder: ModelBuilder, wall: Geometry | None = None) -> dict[str, Any]:
    """Return what a model has of a surface, by field: those of `SurfaceModel`; wall: of one of its walls alone."""
    shape, dim = surface.geometry if wall is None else wall, builder.scene.dim
    origin = tuple(shape.origin.tolist())
    on = builder.attachment(Attachment(on=surface.on, at=origin))
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


def contact_models(builder: ModelBuilder) -> Iterator[ContactModel]:
    """Yield the models of the contacts of a scene by penalty."""
    return (_contact(contact, builder) for contact in builder.scene.contacts.values() if not contact.is_hard)


def _contact(part: Contact, builder: ModelBuilder) -> ContactModel:
    scene = builder.scene
    assert part.stiffness is not None and part.radius is not None, f"{part.where} is not complete"
    surface = scene.surfaces[part.b]
    entries = builder.once(("surface", part.b), lambda builder: _surface_entries(surface, builder))
    if entries["inside"] and entries["shape"] == "box":  # its walls as seen by a sphere's centre
        entries = entries | {"inset": part.radius, "half_size": entries["half_size"] - part.radius}
    tangential = part.stiffness if part.tangential_stiffness is None else part.tangential_stiffness
    model = ContactModel(
        **entries, type="contact", name=part.name or "",
        is_damped=part.damping > 0, stiffness=part.stiffness, damping=part.damping,
        friction=part.friction_coefficient, tangential=tangential, hertz=int(part.exponent == 1.5), cable=-1,
        radius=part.radius, n_points=0)
    if part.a in builder.cable_index:
        drawn = _along_cable(model, builder.cable_index[part.a], builder)
    else:
        assert part.points is not None, f"{part.where} is not complete"
        points = part.points
        model.n_points = len(points)
        model.attachments, model.spread, drawn = builder.once(
            (part.a, points), lambda builder: _on_body(part.a, points, builder))
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


def _on_body(name: str, points: tuple[Vector, ...],
             builder: ModelBuilder) -> tuple[list[AttachmentModel], np.ndarray, np.ndarray]:
    """Return points of a body, (1,) how far they are from its centre at most, and (n, 3) where they are drawn, in m."""
    body = builder.scene.bodies[name]
    on = [builder.attachment(Attachment(on=name, at=point)) for point in points]
    for each in on:
        each.axes = np.eye(builder.scene.dim)  # those of the body, by whose turning spheres roll
    assert not isinstance(body, ModalBody), f"{body.where} touches no surfaces"
    farthest = np.linalg.norm([body.arm(point) for point in points], axis=1).max()
    return on, np.array([farthest]), np.array([body.point(point) for point in points])


def _along_cable(model: ContactModel, index: int, builder: ModelBuilder) -> np.ndarray:
    """Add the quadrature on a cable; return (n, 3): where its points are drawn."""
    cable = builder.cables[index]
    hull = builder.hull(index)
    model.cable, model.n_points, model.length = index, len(GAUSS[0]), cable.mesh.total
    model.N, _, model.weights = along_elements(cable.kernel("on_axis"), cable.mesh.lengths, GAUSS)
    model.hull, model.spread, model.n_hull = hull.points, hull.spread, hull.points.shape[1]
    model.stride = 0 if cable.mesh.is_even else model.n_points
    model.arc = _arc_lengths(cable.mesh, GAUSS[0])
    vectors = builder.scene.cables[cable.name].nodal_vectors
    both = np.concatenate([vectors[:-1], vectors[1:]], axis=1)
    N = np.broadcast_to(model.N, (cable.n_elements, *model.N.shape[1:]))
    return np.einsum("egk,ekd->egd", N, both).reshape(-1, 3)


def _arc_lengths(mesh: Mesh, x: np.ndarray) -> np.ndarray:
    """Return (elements points,): arc-lengths of points on all elements, in m."""
    starts = mesh.node_s[:-1, None]
    return (starts + np.diff(mesh.node_s)[:, None] * (1 + x) / 2).ravel()


def hard_contact_models(builder: ModelBuilder) -> Iterator[HardContactModel]:
    """Yield the models of the hard contacts of a scene: one for each point, in a hollow box one for each wall."""
    return (model for contact in builder.scene.contacts.values() if contact.is_hard
            for model in _hard_contact(contact, builder))


def _hard_contact(part: Contact, builder: ModelBuilder) -> Iterator[HardContactModel]:
    scene = builder.scene
    assert part.restitution is not None and part.points is not None, f"{part.where} is not complete"
    rows = scene.dim if part.friction_coefficient else 1
    weight = scene.bodies[part.a].mass * (float(np.linalg.norm(scene.gravity)) or 1.0)
    surface = scene.surfaces[part.b]
    walls = [_surface_entries(surface, builder, wall) for wall in surface.geometry.walls(scene.dim)]
    for point, wall in product(part.points, walls):
        at = builder.attachment(Attachment(on=part.a, at=point))
        yield HardContactModel(
            **wall, type="hard_contact", name=part.name or "", stiffness=0.0, damping=0.0, friction=0.0,
            tangential=0.0, hertz=0, cable=-1, radius=part.radius or 0.0, n_points=1, attachments=[at],
            scale=[at.mass] * rows, n_multipliers=rows, sliding=part.friction_coefficient,
            restitution=part.restitution, rest_velocity=part.rest_velocity, weight=weight,
            static_stiffness=weight / STATIC_COMPLIANCE)


KINDS = (CouplingKind("contact", Contact.group, contact_models, has_state=False),
         CouplingKind("hard_contact", Contact.group, hard_contact_models, has_state=False))
