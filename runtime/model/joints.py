"""Models of joints between two attachments, those between a rider's axes and its cable included."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache, partial
from typing import ClassVar

import numpy as np

from ..base.deferred import dataclass
from ..checks.frames import TANGENT_LAST, has_section, joint_axes, slide_axes
from ..kernels.libraries import kernels_of
from ..parts.cable import Cable
from ..parts.friction import Friction
from ..parts.joint import DRIVEN, Joint
from ..parts.locations import point_of
from ..parts.slide import Slide
from .attachments import AttachmentModel, ModelBuilder
from .coupling import CouplingKind, CouplingModel


@dataclass(eq=False, repr=False)
class JointModel(CouplingModel):
    """A joint between two ends; base: its distance or angle without the signal that drives it, m or rad.

    of_points: its equations depend on the two points alone, not on rotations. slide: the slide whose rider's axes it
    holds to the cable; joins_pieces: whether it joins the tangents of two pieces of a cable; reversed: its first end is
    b of the part.
    """

    reports_cost: ClassVar[bool] = True
    kernel: str
    attachments: tuple[AttachmentModel, AttachmentModel]
    base: float
    of_points: bool
    slide: str | None = None
    joins_pieces: bool = False
    reversed: bool = False

    @property
    def is_of_scene(self) -> bool:
        """Return whether it is a joint of the scene."""
        return self.slide is None and not self.joins_pieces

    @property
    def rows(self) -> int:
        """Return the number of its equations."""
        return len(self.scale)

    def moves_points(self, dim: int) -> list[bool]:
        """Return for each equation whether it depends on the gap between both points."""
        return [bool(each) for each in np.any(_derivatives(self.kernel, dim)[:, :dim] != 0, axis=1)]

    def ties_ends(self, dim: int) -> bool:
        """Return whether its stiffness couples both ends: its forces depend on rotations of both, or on the gap.

        The stiffness of a spherical joint has no such entries.
        """
        if any(end.slide >= 0 for end in self.attachments):
            return True
        if all(end.cable >= 0 for end in self.attachments):
            return False  # omitted by engine/couplings/joint/joint.c
        return _has_cross_stiffness(self.kernel, dim)


def joint_models(builder: ModelBuilder) -> Iterator[JointModel]:
    """Yield the joints: first those between a rider's axes and its cable, then those of the scene, then those of the
    tangents of pieces of a cable whose slopes differ in length.
    """
    for k, slide in enumerate(builder.scene.slides.values()):
        if slide.frame != "point":
            yield _frame_joint(builder, slide, k)
    for joint in builder.scene.joints.values():
        model = _joint(builder, joint)
        builder.joints.append((joint, model))
        yield model
    for cable in builder.scene.cables.values():
        if not cable.kind_of_element.director:
            yield from (_joint_of_tangents(builder, cable, element) for element in cable.mesh.doubled
                        if element not in cable.hinges)


def _joint_of_tangents(builder: ModelBuilder, cable: Cable, element: int) -> JointModel:
    """Return the joint that keeps the tangents of two pieces parallel, the second of which begins with this element."""
    ends = [builder.on_element(cable, own, at_end, TANGENT_LAST) for own, at_end in ((element - 1, 1), (element, 0))]
    model = _model(cable.name, "aligned" if cable.dim == 3 else "locked", cable.dim, ends, -1, 0.0)
    model.joins_pieces = True
    return model


def _joint(builder: ModelBuilder, joint: Joint) -> JointModel:
    scene = builder.scene
    at = joint_axes(scene, joint)
    ends = [builder.attachment(attachment, None if joint.is_of_points else axes,
                               None if attachment.on not in scene.cables or has_section(scene.cables[attachment.on])
                               else joint.up)
            for attachment, axes in zip((joint.a, joint.b), at, strict=True)]
    kind, driven, turned = joint.joint_kind, joint.is_driven, False
    if scene.dim == 2:
        kind = {"revolute": "revolute" if driven else "spherical", "cylindrical": "prismatic"}.get(kind, kind)
    if driven and joint.joint_kind != "distance":
        kind += f"_{DRIVEN[joint.joint_kind]}"
        if scene.dim == 2 and joint.axes[2, 2] < -0.5:  # about -z: the angle of b in a is that of a in b about z
            ends.reverse()
            turned = True
    base = 0.0
    if joint.joint_kind == "distance":
        assert driven or joint.length is not None, f"{joint.where} is not complete"
        base = 0.0 if driven else joint.length or 0.0
    elif driven and DRIVEN[joint.joint_kind] == "distance":
        base = float(joint.axes[:, 2] @ (point_of(scene, joint.b) - point_of(scene, joint.a)))
    model = _model(joint.name or "", kind, scene.dim, ends, builder.signals.add(joint.prescribed), base)
    model.reversed = turned
    return model


def _frame_joint(builder: ModelBuilder, slide: Slide, number: int) -> JointModel:
    """Return the joint between a rider's axes and the frame of its cable, beside slide number `number`."""
    dim = builder.scene.dim
    at = slide_axes(builder.scene, slide)
    free = slide.frame == "tangent" and slide.roll == "free" and dim == 3
    ends = [builder.on_slide(slide, number, at.a), builder.attachment(slide.rider, at.b)]
    model = _model(slide.name, "aligned" if free else "locked", dim, ends, -1, 0.0)
    model.slide = slide.name
    return model


def _model(name: str, kind: str, dim: int, ends: list[AttachmentModel], drive: int, base: float) -> JointModel:
    kernel = f"joint_{'planar_' * (dim == 2)}{kind}"
    J = _derivatives(kernel, dim)
    mass, length = max(end.mass for end in ends), max(end.length for end in ends)
    # kg, and kg m for rows of rotations alone, which no displacement of the points changes
    scale = np.where(np.any(J[:, :dim] != 0, axis=1), mass, mass * length)
    return JointModel(kernel, (ends[0], ends[1]), base, not np.any(J[:, dim:]), type="joint", name=name, scale=scale,
                      n_multipliers=len(scale), drive=drive)


@cache
def _derivatives(kernel: str, dim: int) -> np.ndarray:
    """Return the derivatives (rows, dim + turns) of a joint's equations by gap and rotations, in a generic state."""
    eye, ones = np.eye(dim), np.ones(dim)
    force = getattr(kernels_of(None), f"{kernel}_force")
    generic = np.array([0.5, np.cos(0.5), np.sin(0.5)])
    return np.asarray(force(ones, eye, eye, generic, np.zeros(force.shapes["f"]))[1])


@cache
def _has_cross_stiffness(kernel: str, dim: int) -> bool:
    """Return whether the second derivatives of the kernel couple its two ends."""
    force = getattr(kernels_of(None), f"{kernel}_force")
    rng = np.random.default_rng(0)  # unrelated numbers do not cancel
    given = [rng.uniform(0.5, 1.0, force.shapes[name]) for name in list(force.shapes)[:5]]
    numbers = np.asarray(force(*given)[2]).ravel()
    moves = int(np.sqrt(numbers.size))
    K, turns = numbers.reshape(moves, moves), (moves - dim) // 2
    first, second = K[: dim + turns], [*range(dim), *range(dim + turns, moves)]
    return bool(np.any(first[:, second] != 0))


@dataclass(eq=False, repr=False)
class JointFrictionModel(CouplingModel):
    """Friction of a joint against the motions that it leaves free.

    arms: from the rates of these motions to the speed of sliding, m or 1. of: the joint, whose force presses unless
    there is a normal force, N; friction_scale: number of the signal of a factor of the coefficients, or -1.
    """

    keeps_forces: ClassVar[bool] = False
    kernel: str
    attachments: tuple[AttachmentModel, AttachmentModel]
    of: JointModel
    arms: tuple[float, float]
    normal_force: float
    coefficient: float
    static_coefficient: float
    viscous: float
    velocity: float
    friction_scale: int
    is_free: bool = True

    @property
    def pressed_by(self) -> int:
        """Return the number of the joint whose force presses, or -1 for a given normal force."""
        return self.of.number if self.needs_reactions else -1

    def ties_ends(self, dim: int) -> bool:
        """Return True: its moment turns with one end."""
        return True


class JointStickingModel(JointFrictionModel):
    """Friction of a joint that sticks, with a multiplier of the one motion that it locks at rest."""


def friction_models(builder: ModelBuilder, sticks: bool = False) -> Iterator[JointFrictionModel]:
    """Yield the friction of the joints of the scene, whose models the builder has, that sticks or is regularised."""
    for joint, of in builder.joints:
        if joint.friction is not None and joint.friction.sticks == sticks:
            yield _friction(builder, joint, of, joint.friction)


def _friction(builder: ModelBuilder, joint: Joint, of: JointModel, friction: Friction) -> JointFrictionModel:
    dim = builder.scene.dim
    kind = {"revolute": "turning", "prismatic": "sliding", "cylindrical": "turning_sliding"}[joint.joint_kind]
    if dim == 2 and joint.joint_kind == "cylindrical":
        kind = "sliding"
    made = _model(joint.name or "", kind, dim, [*of.attachments], -1, 0.0)
    number, factor = builder.signals.scale(friction.scale, friction.when, friction.until)
    return (JointStickingModel if friction.sticks else JointFrictionModel)(
        made.kernel, made.attachments, of, (1.0 if kind == "sliding" else joint.radius or 0.0, 1.0),
        joint.normal_force or 0.0, factor * friction.coefficient, factor * friction.static_friction,
        factor * friction.viscous, friction.velocity, number,
        type="joint_sticking" if friction.sticks else "joint_friction", name=made.name, scale=made.scale,
        n_multipliers=len(made.scale) * friction.sticks, follows_law=True, is_damped=True,
        needs_reactions=joint.normal_force is None and friction.coefficient > 0)


KINDS = (CouplingKind("joint", Joint.group, joint_models), CouplingKind("joint_friction", Joint.group, friction_models),
         CouplingKind("joint_sticking", Joint.group, partial(friction_models, sticks=True)))
