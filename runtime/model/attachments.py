"""Models of attachments, and the builder of couplings."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Mapping
from dataclasses import field
from typing import Any, TypeVar

import numpy as np

from ..base.deferred import dataclass
from ..checks.frames import draws_section
from ..parts.attachment import Attachment
from ..parts.cable import Cable
from ..parts.joint import Joint
from ..parts.modal_body import ModalBody
from ..parts.rigid_body import largest_moment
from ..parts.scene_data import SceneData
from ..parts.slide import Slide
from .hulls import Hull, hull_of
from .signals import Signals
from .span_coordinates import SpanCoordinates

UP, CARRIED = -1, -2
"""Second vector of the frame of a tangent, as in couplings/common/attachments.h: a direction of the ground, or the
director that a slide carries."""

T = TypeVar("T")
Modes = tuple[np.ndarray, np.ndarray, np.ndarray]

FRAMES = {2: "planar_frame", 3: "frame"}
ROPE_POINTS = {2: "planar_rope_point", 3: "rope_point"}
"""Kernels of frames of cables, and of material points of ropes."""

SECTIONS = {2: np.array([[0.0, 1.0], [-1.0, 0.0]]), 3: np.eye(3)[:, [2, 0, 1]]}
"""Axes of `frames.section_frame` in the frame of r_y and r_z."""


@dataclass(eq=False, repr=False)
class AttachmentModel:
    """fu_attachment of the engine; cable, body, slide: -1 where it is on none; mass and length: its scales, kg and m.

    node: first dof of a node of a rope, -1 where it is on none. span, material: the span of a material point of a rope,
    None where it is on none, and the material coordinate, m; rope_point: its kernels.

    modal: of a node of a modal body, its undeformed place, and its displacements and rotations by modes.
    """

    cable: int = -1
    body: int = -1
    element: int = 0
    slide: int = -1
    node: int = -1
    span: SpanCoordinates | None = None
    material: float = 0.0
    rope_point: str = ""
    u: tuple[float, ...] = (0.0,) * 3
    N: np.ndarray = field(default_factory=lambda: np.zeros(0))
    S: np.ndarray = field(default_factory=lambda: np.zeros(0))
    mass: float = 0.0
    length: float = 0.0
    frame: str = ""
    slopes: tuple[int, int] = (0, UP)
    up: tuple[float, ...] = (0.0,) * 3
    axes: np.ndarray | None = None
    modal: Modes | None = None


class ModelBuilder:
    """Makes attachments, hulls of cables and signals for the couplings of a model.

    cables, ropes, bodies: the models, in the scene's order; driven: dofs of `DrivenDofs`, by part and quantity; joints:
    those of the scene with their models, once these are made.
    """

    def __init__(self, scene: SceneData, cables: list[Any], ropes: list[Any], bodies: list[Any],
                 driven: Mapping[tuple[str, str], int]):
        self.scene: SceneData = scene
        self.driven = driven
        self.cables, self.ropes, self.bodies = cables, ropes, bodies
        self.cable_index = {name: k for k, name in enumerate(scene.cables)}
        self.body_index = {name: k for k, name in enumerate(scene.bodies)}
        self.joints: list[tuple[Joint, Any]] = []
        self.signals = Signals()
        self.hulls: dict[int, Hull] = {}
        self._made: dict[Hashable, Any] = {}

    def once(self, key: Hashable, make: Callable[[ModelBuilder], T]) -> T:
        """Return make(builder), computed once for each key: many pairs share their bodies and surfaces."""
        if key not in self._made:
            self._made[key] = make(self)
        made: T = self._made[key]
        return made

    def hull(self, index: int) -> Hull:
        """Return the hull of the elements of a cable by its number, and set the cable's `share`."""
        if index not in self.hulls:
            cable = self.cables[index]
            self.hulls[index] = hull_of(cable.kernel("on_axis"), cable.mesh.lengths)
            cable.share = self.hulls[index].share
        return self.hulls[index]

    def element(self, cable: str, s: float) -> tuple[int, float]:
        """Return the element that contains s, and x in it."""
        model = self.cables[self.cable_index[cable]]
        element = int(model.mesh.element_at(s))
        return element, s - model.mesh.start(element)

    def attachment(self, attachment: Attachment, axes: np.ndarray | None = None,
                   up: tuple[float, ...] | np.ndarray | None = None) -> AttachmentModel:
        """Return the model of a complete attachment; axes: (3, 3) in the frame of its body or cable, if it has any."""
        axes = self._axes(axes)
        if attachment.on is None:
            return AttachmentModel(u=attachment.point, axes=axes)
        if attachment.on in self.body_index:
            index, part = self.body_index[attachment.on], self.scene.bodies[attachment.on]
            body = self.bodies[index]
            length = math.sqrt(largest_moment(body.inertia) / body.mass)
            found = AttachmentModel(body=index, mass=body.mass, length=length, axes=axes)
            if isinstance(part, ModalBody):
                found.modal = self._modal(part.attachment_modes(attachment.point))
            else:
                found.u = part.arm(attachment.point)
            return found
        if attachment.on in self.scene.ropes:
            return self._on_rope(attachment.on, attachment.arc_length)
        found = self._on_cable(attachment.on, attachment.arc_length, axes, up,
                               draws_section(self.scene.cables[attachment.on]))
        return self._at(found, *self.element(attachment.on, attachment.arc_length))

    def on_element(self, cable: Cable, element: int, end: int, axes: np.ndarray) -> AttachmentModel:
        """Return an attachment to the tangent at the first end, 0, or the last one, 1, of an element of a cable."""
        x = end * cable.mesh.length(element)
        found = self._on_cable(cable.name, cable.mesh.start(element) + x, self._axes(axes), None, section=False)
        return self._at(found, element, x)

    def _at(self, found: AttachmentModel, element: int, x: float) -> AttachmentModel:
        """Return an attachment to a cable with its place, x in m in an element."""
        model, found.element = self.cables[found.cable], element
        length = model.mesh.length(element)
        found.N = model.kernel("on_axis")(length, x)[0]
        if found.axes is not None:
            slopes = model.kernel("slopes")(length, x)
            found.S = np.array([slopes[k, 0] if k >= 0 else 0 * found.N for k in found.slopes])
        return found

    def _on_rope(self, name: str, s: float) -> AttachmentModel:
        """Return an attachment to a material point of a rope."""
        rope = next(each for each in self.ropes if each.part.name == name)
        number = rope.part.span_at(rope.route, s)
        span = rope.spans[number]
        return AttachmentModel(span=span, material=s, rope_point=ROPE_POINTS[span.dim],
                               mass=rope.mass_of_element(number),
                               length=rope.route.spans[number].length / span.n_elements)

    def on_slide(self, slide: Slide, number: int, axes: np.ndarray) -> AttachmentModel:
        """Return an attachment to the frame of the cable or the rope at a slide of that number."""
        if slide.along in self.scene.ropes:
            found = self._on_rope(slide.along, slide.arc_length)
            found.slide, found.frame, found.axes = number, FRAMES[self.scene.dim], self._axes(axes)
            found.slopes = (0, CARRIED if slide.roll == "free" and self.scene.dim == 3 else UP)
            found.up = (0.0,) * 3 if slide.up is None else tuple(map(float, slide.up))
            return found
        section = slide.frame == "section" and draws_section(self.scene.cables[slide.along])
        found = self._on_cable(slide.along, slide.arc_length, self._axes(axes), slide.up, section)
        found.slide = number
        if not section and found.slopes[1] == UP and slide.roll == "free":
            found.slopes = (0, CARRIED)
        return found

    def _on_cable(self, name: str, s: float, axes: np.ndarray | None, up: tuple[float, ...] | np.ndarray | None,
                  section: bool) -> AttachmentModel:
        """Return an attachment with the frame of the section, or that of the tangent and the director or up."""
        cable, index = self.scene.cables[name], self.cable_index[name]
        length = self.cables[index].mesh.mean
        piece = cable.piece_at(s)
        mass = piece.material.density * piece.section.area * length
        director = cable.kind_of_element.director
        if up is None and not director:  # any direction: only the tangent is held
            up = cable.height(s)
        slopes = (0, "xyz".index(director[-1]) if director and up is None and cable.dim == 3 else UP)
        if section:
            slopes, axes = (1, 2 if cable.dim == 3 else UP), None if axes is None else SECTIONS[cable.dim] @ axes
        return AttachmentModel(cable=index, mass=mass, length=length, frame=FRAMES[self.scene.dim], slopes=slopes,
                               up=(0.0,) * 3 if up is None else tuple(map(float, up)), axes=axes)

    def _modal(self, modes: Modes) -> Modes:
        dim, (at, displacements, turns) = self.scene.dim, modes
        return at[:dim], displacements[:, :dim], turns[:, 2:] if dim == 2 else turns

    def _axes(self, axes: np.ndarray | None) -> np.ndarray | None:
        """Return axes in the dimension of the scene: in the plane, x is the axis of the joint if it lies there, y is
        perpendicular (derive/couplings/joint.py).
        """
        if axes is None or self.scene.dim == 3:
            return axes
        x = axes[:2, 2] if np.linalg.norm(axes[:2, 2]) > 0.5 else axes[:2, 0]
        return np.array([[x[0], -x[1]], [x[1], x[0]]])
