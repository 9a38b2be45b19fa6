"""Models of surfaces and of contact with them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import field
from itertools import product
from typing import Any

import numpy as np

from ..base.deferred import dataclass
from ..base.quadrature import gauss
from ..engine import FRICTION_MARK, NO_TIME, SPAN_BEGIN, SPAN_STRETCH
from ..kernels.element_line import along_elements
from ..kernels.mesh import Mesh
from ..parts.attachment import Attachment
from ..parts.contact import GAUSS_POINTS, Contact
from ..parts.friction import Friction
from ..parts.modal_body import ModalBody
from ..parts.piece import UniformPiece
from ..parts.scene_data import SceneData
from ..parts.surface import Surface
from ..parts.surface_shapes import HALF_WIDTH, Geometry
from ..parts.validation import Vector
from .attachments import AttachmentModel, ModelBuilder
from .coupling import CouplingKind, CouplingModel, no_numbers
from .span_coordinates import AlongSpan, SpanCoordinates

KERNELS = {2: "planar_surface", 3: "surface"}
NONE = np.zeros(0)
MARK_PLACE = slice(3, 6)
"""Position of a point among the numbers of its friction: fu_friction_mark of couplings/contact/contact.h."""
STATIC_COMPLIANCE = 1e-10
"""Penetration, in m, of a hard contact in statics under the weight of its body."""


@dataclass(eq=False, repr=False, kw_only=True)
class ContactModel(CouplingModel):
    """Contact with a surface by penalty: fu_contact of engine/couplings/contact/contact.h.

    cable: -1 for a body, whose points are the attachments. on: the one attachment of the surface. direction (dim), in
    its axes, and round_radius, in m: of the surface. first, n_elements: elements of the cable in contact. N, weights,
    arc (m), hull, spread: of the points on them, as in `along_elements` and `Hull`.
    """

    kernel: str
    shape: str
    direction: np.ndarray
    on: list[AttachmentModel]
    round_radius: float
    radius: float
    cable: int = -1
    first: int = 0
    n_elements: int = 0
    stiffness: float = 0.0
    damping: float = 0.0
    friction: float = 0.0
    tangential: float = 0.0
    hertz: int = 0
    n_points: int = 1
    stride: int = 0
    weights: np.ndarray = field(default_factory=no_numbers)
    N: np.ndarray = field(default_factory=no_numbers)
    arc: np.ndarray = field(default_factory=no_numbers)
    spread: np.ndarray = field(default_factory=no_numbers)
    hull: np.ndarray = field(default_factory=no_numbers)
    attachments: list[AttachmentModel] = field(default_factory=list)

    @property
    def ends(self) -> Sequence[AttachmentModel]:
        """Return the attachment of the surface, and the first of the points of a body."""
        return [*self.on, *self.attachments[:1]]

    @property
    def along(self) -> Sequence[int]:
        """Return the number of its cable, if it is on one."""
        return (self.cable,) if self.cable >= 0 else ()


@dataclass(eq=False, repr=False, kw_only=True)
class HardContactModel(ContactModel):
    """Hard contact of one point of a body with a surface: fu_hard_contact of hard_contact.h."""

    @property
    def ends(self) -> Sequence[AttachmentModel]:
        """Return the point, and the attachment of the surface."""
        return [*self.attachments, *self.on]


@dataclass(eq=False, repr=False, kw_only=True)
class RopeContactModel(AlongSpan, CouplingModel):
    """Contact of a span of a rope with a surface: fu_rope_contact of engine/couplings/contact/contact.h.

    on, direction, round_radius, tangential: as of a `ContactModel`. friction, slip_velocity (m/s): of regularised
    friction. sticking: coefficient of friction with a spring. arc, weights: shares in the length of an element, of
    points of quadrature and of their weights.
    """

    coordinates: SpanCoordinates
    kernel: str
    shape: str
    direction: np.ndarray
    on: list[AttachmentModel]
    round_radius: float
    radius: float
    stiffness: float
    damping: float
    hertz: int
    friction: float
    slip_velocity: float
    sticking: float
    tangential: float
    cable: int = -1
    n_points: int = GAUSS_POINTS
    weights: np.ndarray = field(default_factory=lambda: gauss(GAUSS_POINTS)[1] / 2)
    arc: np.ndarray = field(default_factory=lambda: (1 + gauss(GAUSS_POINTS)[0]) / 2)

    @property
    def ends(self) -> Sequence[AttachmentModel]:
        """Return the attachment of the surface."""
        return self.on


def _of_surface(surface: Surface, builder: ModelBuilder, wall: Geometry | None = None) -> dict[str, Any]:
    """Return the arguments of a model that describe a surface, or one of its walls."""
    shape, dim = surface.geometry if wall is None else wall, builder.scene.dim
    on = builder.attachment(Attachment(on=surface.on, at=tuple(shape.origin.tolist())))
    on.axes = shape.axes[:dim, :dim].copy()
    first, second, cells = (NONE if each is None else each for each in (shape.first, shape.second, shape.cells))
    if shape.word == "terrain" and dim == 3 and shape.second is None:  # the same heights from side to side
        second = np.array([-HALF_WIDTH, HALF_WIDTH])
        cells = np.zeros((len(first) - 1, 1, 4, 4))
        cells[:, 0, :, 0] = shape.cells
    return {"kernel": KERNELS[dim], "shape": shape.word, "direction": shape.direction[:dim],
            "round_radius": shape.radius, "on": [on],
            "entries": {"half_length": shape.half_length, "half_size": shape.half_size[:dim],
                        "inside": int(shape.inside), "inset": 0.0, "n_first": len(first), "n_second": len(second),
                        "first": first, "second": second, "heights": cells, "highest": shape.highest,
                        "steepest": shape.steepest, "bend": shape.bend}}


def contact_models(builder: ModelBuilder) -> Iterator[ContactModel]:
    """Yield the models of the contacts of a scene by penalty, of a cable one for each of its stretches."""
    for part in builder.scene.contacts.values():
        if not part.is_hard and part.a not in builder.scene.ropes:
            cable = builder.scene.cables.get(part.a)
            for stretch in (None,) if cable is None else part.stretches(cable):
                yield _contact(part, builder, stretch)


def rope_contact_models(builder: ModelBuilder) -> Iterator[RopeContactModel]:
    """Yield the models of the contacts of ropes, one for each span."""
    for part in builder.scene.contacts.values():
        for span in (span for rope in builder.ropes if rope.part.name == part.a for span in rope.spans):
            friction = part.friction or Friction()
            arguments = _by_penalty(part, builder, part.radius)
            sticking = friction.coefficient if part.has_friction_spring else 0.0
            model = RopeContactModel(**arguments, type="rope contact", coordinates=span,
                                     friction=0.0 if sticking else friction.coefficient,
                                     slip_velocity=friction.velocity, sticking=sticking,
                                     tangential=_tangential(part, arguments["stiffness"]))
            model.is_damped |= friction.coefficient > 0
            if sticking:
                model.n_numbers = (SPAN_STRETCH * model.n_points * span.n_elements + SPAN_BEGIN
                                   + 2 * (span.nodes.stop - span.nodes.start))
            yield model


def _tangential(part: Contact, stiffness: float) -> float:
    """Return the stiffness of friction's spring, by default that of the normal force."""
    return stiffness if part.tangential_stiffness is None else part.tangential_stiffness


def _by_penalty(part: Contact, builder: ModelBuilder, radius: float | None) -> dict[str, Any]:
    """Return the arguments of a model that describe the surface of a contact and its normal force; radius: m."""
    assert part.stiffness is not None and radius is not None, f"{part.where} is not complete"
    surface = builder.scene.surfaces[part.b]
    arguments = builder.once(("surface", part.b), lambda builder: _of_surface(surface, builder))
    entries = arguments["entries"]
    if entries["inside"] and arguments["shape"] == "box":  # its walls as seen by a sphere's centre
        entries = entries | {"inset": radius, "half_size": entries["half_size"] - radius}
    return arguments | {"entries": entries, "name": part.name or "", "is_damped": part.damping > 0,
                        "stiffness": part.stiffness, "damping": part.damping, "hertz": int(part.exponent == 1.5),
                        "radius": radius}


def _contact(part: Contact, builder: ModelBuilder, stretch: UniformPiece | None) -> ContactModel:
    scene = builder.scene
    arguments = _by_penalty(part, builder, part.radius if stretch is None else part.radius_of(stretch.section))
    entries = arguments["entries"] | {"first_element": 0, "start": 0.0, "stop": 0.0, "n_hull": 0, "marks": NONE}
    model = ContactModel(**arguments | {"entries": entries}, type="contact", friction=part.friction_coefficient,
                         tangential=_tangential(part, arguments["stiffness"]))
    if stretch is not None:
        _along_cable(model, builder.cable_index[part.a], stretch, builder)
        drawn = _drawn(model, builder) if part.friction_coefficient else NONE
    else:
        assert part.points is not None, f"{part.where} is not complete"
        points = part.points
        model.n_points = len(points)
        model.attachments, model.spread, drawn = builder.once(
            (part.a, points), lambda builder: _on_body(part.a, points, builder))
    if part.friction_coefficient:
        marks = _marks(part, scene, scene.surfaces[part.b], drawn)
        model.n_numbers, entries["marks"] = marks.size, marks
    return model


def _marks(part: Contact, scene: SceneData, surface: Surface, drawn: np.ndarray) -> np.ndarray:
    """Return the initial history variables (n,) of friction, of points drawn at (m, 3), in m: fu_friction_mark of each,
    and fu_friction_begin.
    """
    on, body = scene.bodies.get(surface.on or ""), scene.bodies.get(part.a)
    points = np.zeros((len(drawn), FRICTION_MARK))
    points[:, MARK_PLACE][:, : scene.dim] = surface.geometry.into(surface.in_axes(on, drawn))[:, : scene.dim]
    axes = np.zeros(9)
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
    assert not isinstance(body, ModalBody), f"{body.where} has no contact with surfaces"
    farthest = np.linalg.norm([body.arm(point) for point in points], axis=1).max()
    return on, np.array([farthest]), np.array([body.point(point) for point in points])


def _along_cable(model: ContactModel, index: int, stretch: UniformPiece, builder: ModelBuilder) -> None:
    """Add the quadrature on a stretch of a cable."""
    cable = builder.cables[index]
    hull, mesh = builder.hull(index), cable.mesh
    first, end = stretch.first, stretch.end
    own = slice(first, end)
    stored = slice(None) if mesh.is_even else own  # of one element on an even mesh
    model.cable, model.first, model.n_elements, model.n_points = index, first, end - first, GAUSS_POINTS
    model.hull, model.spread = hull.points[stored], hull.spread[stored]
    model.entries |= {"first_element": first, "start": float(mesh.boundaries[first]), "n_hull": hull.points.shape[1],
                      "stop": mesh.total if end == cable.n_elements else float(mesh.boundaries[end])}
    model.N, _, model.weights = along_elements(cable.kernel("on_axis"), mesh.lengths[stored], gauss(GAUSS_POINTS))
    model.stride = 0 if mesh.is_even else model.n_points
    model.arc = _arc_lengths(mesh, gauss(GAUSS_POINTS)[0]).reshape(cable.n_elements, -1)[own].ravel()


def _drawn(model: ContactModel, builder: ModelBuilder) -> np.ndarray:
    """Return (n, 3): where the points on a cable are drawn."""
    cable = builder.cables[model.cable]
    vectors, own = builder.scene.cables[cable.name].nodal_vectors, slice(model.first, model.first + model.n_elements)
    both = np.concatenate([vectors[cable.mesh.first][own], vectors[cable.mesh.last][own]], axis=1)
    N = np.broadcast_to(model.N, (model.n_elements, *model.N.shape[1:]))
    return np.asarray(np.einsum("egk,ekd->egd", N, both).reshape(-1, 3))


def _arc_lengths(mesh: Mesh, x: np.ndarray) -> np.ndarray:
    """Return (elements points,): arc-lengths of points on all elements, in m."""
    starts = mesh.boundaries[:-1, None]
    return np.asarray(starts + np.diff(mesh.boundaries)[:, None] * (1 + x) / 2).ravel()


def hard_contact_models(builder: ModelBuilder) -> Iterator[HardContactModel]:
    """Yield the models of the hard contacts of a scene: one for each point, in a hollow box one for each wall."""
    return (model for contact in builder.scene.contacts.values() if contact.is_hard
            for model in _hard_contact(contact, builder))


def _hard_contact(part: Contact, builder: ModelBuilder) -> Iterator[HardContactModel]:
    scene, surface = builder.scene, builder.scene.surfaces[part.b]
    assert part.restitution is not None and part.points is not None, f"{part.where} is not complete"
    rows = scene.dim if part.friction_coefficient else 1
    weight = scene.bodies[part.a].mass * (float(np.linalg.norm(scene.gravity)) or 1.0)
    # static_stiffness: points that carry the same load share it
    entries = {"sliding": part.friction_coefficient, "restitution": part.restitution,
               "rest_velocity": part.rest_velocity, "weight": weight, "static_stiffness": weight / STATIC_COMPLIANCE}
    walls = [_of_surface(surface, builder, wall) for wall in surface.geometry.walls(scene.dim)]
    for point, wall in product(part.points, walls):
        at = builder.attachment(Attachment(on=part.a, at=point))
        yield HardContactModel(**wall | {"entries": wall["entries"] | entries}, type="hard_contact",
                               name=part.name or "", radius=part.radius or 0.0, attachments=[at],
                               scale=[at.mass] * rows, n_multipliers=rows)


KINDS = (CouplingKind("contact", Contact.group, contact_models, has_state=False),
         CouplingKind("rope contact", Contact.group, rope_contact_models, has_state=False),
         CouplingKind("hard_contact", Contact.group, hard_contact_models, has_state=False))
