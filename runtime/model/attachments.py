"""What springs, joints and riders hold on to, and joints between such ends, as the engine takes them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..checks.frames import draws_section, has_section, joint_axes, slide_axes
from ..kernels.libraries import kernels_of
from ..parts.attachment import Attachment
from ..parts.joint import DRIVEN, Joint
from ..parts.modal_body import ModalBody
from ..parts.places import point_of
from ..parts.scene_data import SceneData
from ..parts.slide import Slide

UP, CARRIED = -1, -2
"""What completes the frame of a tangent, as engine.h has it: a direction of the ground, or the slide's director."""

FRAMES = {2: "planar_frame", 3: "frame"}

SECTIONS = {2: np.array([[0.0, 1.0], [-1.0, 0.0]]), 3: np.eye(3)[:, [2, 0, 1]]}
"""`frames.section_frame` in the frame of r_y and r_z."""


@dataclass
class AttachmentModel:
    """fu_attachment of engine.h: -1 for what it is not on; mass and length are scales of it, kg and m.

    spot: of a modal body's node, where it is undeformed, and its displacements and turns by modes.
    """

    cable: int
    body: int
    element: int
    slide: int
    u: tuple[float, ...]
    N: np.ndarray
    S: np.ndarray
    mass: float
    length: float
    frame: str = ""
    slopes: tuple[int, int] = (0, UP)
    up: tuple[float, ...] = (0.0, 0.0, 0.0)
    axes: np.ndarray | None = None
    spot: tuple[np.ndarray, np.ndarray, np.ndarray] | None = None


@dataclass
class JointModel:
    """A joint between two ends; unknown, multiplier: places of its rows; signal: that drives it, or -1.

    slide: the one beside which it ties a rider's axes to the cable; redundant_rows: those that other joints imply
    (model/redundant_constraints.py);
    reversed: the first end is the joint's b.
    """

    name: str
    kernel: str
    ends: tuple[AttachmentModel, AttachmentModel]
    unknown: int
    multiplier: int
    signal: int
    base: float
    scale: np.ndarray
    slide: str | None = None
    redundant_rows: set[int] = field(default_factory=set)
    reversed: bool = False

    @property
    def rows(self) -> int:
        """Number of its equations."""
        return len(self.scale)


class AttachmentBuilder:
    """Makes ends of anchors; `cables` and `rigids` are the models, in the scene's order."""

    def __init__(self, scene: SceneData, cables: list, rigids: list):
        self.scene, self.cables, self.rigids = scene, cables, rigids
        self.cable_index = {name: k for k, name in enumerate(scene.cables)}
        self.body_index = {name: k for k, name in enumerate(scene.bodies)}

    def element(self, cable: str, s: float) -> tuple[int, float]:
        """Element that holds s, and x in it."""
        model = self.cables[self.cable_index[cable]]
        element = min(max(int(s // model.length), 0), model.n_elements - 1)
        return element, s - element * model.length

    def end(self, anchor: Attachment, axes: np.ndarray | None = None, up=None) -> AttachmentModel:
        """The end of a complete anchor, with axes (3, 3) in the frame of what carries it where it has some."""
        none = np.zeros(0)
        axes = self._axes(axes)
        if anchor.on is None:
            return AttachmentModel(-1, -1, 0, -1, anchor.at, none, none, 0.0, 0.0, axes=axes)
        if anchor.on in self.body_index:
            body = self.rigids[self.body_index[anchor.on]]
            length = float(np.sqrt(np.max(np.linalg.eigvalsh(body.inertia)) / body.mass))
            part = self.scene.bodies[anchor.on]
            if isinstance(part, ModalBody):
                return AttachmentModel(-1, self.body_index[anchor.on], 0, -1, (0.0,) * 3, none, none, body.mass, length,
                                axes=axes, spot=self._spot(part.spot(anchor.at)))
            return AttachmentModel(-1, self.body_index[anchor.on], 0, -1, part.arm(anchor.at), none, none, body.mass,
                                   length,
                            axes=axes)
        found = self._on_cable(anchor.on, anchor.s, axes, up, draws_section(self.scene.cables[anchor.on]))
        found.element, x = self.element(anchor.on, anchor.s)
        model = self.cables[found.cable]
        found.N = model.kernel("on_axis")(model.length, x)[0]
        if axes is not None:
            slopes = model.kernel("slopes")(model.length, x)
            found.S = np.array([slopes[k, 0] if k >= 0 else 0 * found.N for k in found.slopes])
        return found

    def on_slide(self, slide: Slide, number: int, axes: np.ndarray) -> AttachmentModel:
        """The cable's frame where a slide is."""
        section = slide.frame == "section" and draws_section(self.scene.cables[slide.along])
        found = self._on_cable(slide.along, slide.s, self._axes(axes), slide.up, section)
        found.slide = number
        if not section and found.slopes[1] == UP and slide.roll == "free":
            found.slopes = (0, CARRIED)
        return found

    def _on_cable(self, name: str, s: float, axes: np.ndarray | None, up, section: bool) -> AttachmentModel:
        """An end with the frame of the section, or of the tangent with the director or up."""
        cable, index = self.scene.cables[name], self.cable_index[name]
        length = self.cables[index].length
        mass = cable.material.density * cable.section.area * length
        director = cable.kind_of_element.director
        if up is None and not director:  # any direction does where the tangent is all that is held
            up = cable.height(s)
        slopes = (0, "xyz".index(director[-1]) if director and up is None and cable.dim == 3 else UP)
        if section:
            slopes, axes = (1, 2 if cable.dim == 3 else UP), None if axes is None else SECTIONS[cable.dim] @ axes
        return AttachmentModel(index, -1, 0, -1, (0.0,) * 3, np.zeros(0), np.zeros(0), mass, length,
                        FRAMES[self.scene.dim], slopes, (0.0,) * 3 if up is None else up, axes)

    def _spot(self, spot) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        dim, (at, displacements, turns) = self.scene.dim, spot
        return at[:dim], displacements[:, :dim], turns[:, 2:] if dim == 2 else turns

    def _axes(self, axes: np.ndarray | None) -> np.ndarray | None:
        """In the plane x is the joint's axis if that lies in it, y square to it; see derive/couplings/joint.py."""
        if axes is None or self.scene.dim == 3:
            return axes
        x = axes[:2, 2] if np.linalg.norm(axes[:2, 2]) > 0.5 else axes[:2, 0]
        return np.array([[x[0], -x[1]], [x[1], x[0]]])


def linked(holder: AttachmentBuilder, joint: Joint, signal, unknown: int, multiplier: int) -> JointModel:
    """The model of a joint; signal(s): number of a signal."""
    scene = holder.scene
    at = joint_axes(scene, joint)
    needs = joint.pair not in ("spherical", "distance")
    ends = [holder.end(anchor, axes if needs else None, None if anchor.on not in scene.cables
                       or has_section(scene.cables[anchor.on]) else joint.up)
            for anchor, axes in zip((joint.a, joint.b), at, strict=True)]
    kind, driven, turned = joint.pair, joint.is_driven, False
    if scene.dim == 2:
        kind = {"revolute": "revolute" if driven else "spherical", "cylindrical": "prismatic"}.get(kind, kind)
    if driven and joint.pair != "distance":
        kind += f"_{DRIVEN[joint.pair]}"
        if scene.dim == 2 and joint.axes[2, 2] < -0.5:  # about -z: what a sees of b is what b sees of a about z
            ends.reverse()
            turned = True
    base = 0.0
    if joint.pair == "distance":
        base = 0.0 if driven else joint.length
    elif driven and DRIVEN[joint.pair] == "distance":
        base = float(joint.axes[:, 2] @ (point_of(scene, joint.b) - point_of(scene, joint.a)))
    link = _link(joint.name, kind, scene.dim, ends, unknown, multiplier, signal(joint.prescribed) if driven else -1,
                 base)
    link.reversed = turned
    return link


def tied(holder: AttachmentBuilder, slide: Slide, number: int, unknown: int, multiplier: int) -> JointModel:
    """What keeps a rider's axes to the frame of its cable, beside slide number `number`."""
    dim = holder.scene.dim
    at = slide_axes(holder.scene, slide)
    free = slide.frame == "tangent" and slide.roll == "free" and dim == 3
    ends = [holder.on_slide(slide, number, at.a), holder.end(slide.rider, at.b)]
    link = _link(slide.name, "aligned" if free else "locked", dim, ends, unknown, multiplier, -1, 0.0)
    link.slide = slide.name
    return link


def _link(name: str, kind: str, dim: int, ends: list[AttachmentModel], unknown: int, multiplier: int, signal: int,
          base: float) -> JointModel:
    kernel = f"joint_{'planar_' * (dim == 2)}{kind}"
    return JointModel(name, kernel, tuple(ends), unknown, multiplier, signal, base, _scales(kernel, dim, ends))


def _scales(kernel: str, dim: int, ends: list[AttachmentModel]) -> np.ndarray:
    """(rows,): kg, and kg m where a row is about turns alone: no displacement of the points changes it."""
    eye, ones = np.eye(dim), np.ones(dim)
    force = getattr(kernels_of(None), f"{kernel}_force")
    J = force(ones, eye, eye, np.array([0.5, np.cos(0.5), np.sin(0.5)]), np.zeros(force.shapes["f"]))[1]
    mass, length = max(end.mass for end in ends), max(end.length for end in ends)
    return np.where(np.any(J[:, :dim] != 0, axis=1), mass, mass * length)
