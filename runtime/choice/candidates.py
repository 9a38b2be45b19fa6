"""The elements and laws that a cable can have: which of them know what the scene asks for, and which is the finest."""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import SceneError
from ..kernels.elements import built_in
from ..parts.cable import Cable
from ..parts.load import Moment
from ..parts.scene_data import SceneData
from ..parts.section_stiffness import is_reduced
from .remeshing import CableModel, with_model

CABLES = {2: "cable8p", 3: "cable12"}
BEAMS = {2: "beam12p", 3: "beam24"}
"""The elements by dimension of the scene: stretch and bending alone, and all that a beam does."""

FULL, REDUCED, STRUCTURAL = "engineering_exact", "engineering_exact_reduced", "structural"
"""The laws that are chosen from. The structural law of a slender beam is the engineering law of a cable; green strain
is another law of material at large strain, and the continuum needs finer meshes for the same answer."""

TURNING = ("weld", "revolute", "universal", "prismatic", "cylindrical")
"""Kinds of joints that hold a section, or its tangent, and may bear a torque along the cable."""

WORK = {"cable8p": 1.0, "cable12": 1.5, "cable18": 3.0, "beam12p": 1.9, "beam24": 4.8}
"""CPU time of an element over a run, in that of cable8p, as measured on pendulums of 4 to 64 elements: 1.5 times for
cable12 and 1.6 and 4 for beams by iteration, and their runs have a fifth more iterations."""


@dataclass(frozen=True)
class Kind:
    """An element with a law."""

    element: str
    law: str

    def with_elements(self, elements: int) -> CableModel:
        """Return it with a number of elements."""
        return CableModel(self.element, self.law, elements)

    @property
    def work(self) -> float:
        """Return the CPU time of an element over a run, about, in that of cable8p."""
        return WORK.get(self.element, 6.0)

    @property
    def is_beam(self) -> bool:
        """Return whether it knows shear."""
        kind = built_in().get(self.element)
        return kind is None or not kind.is_cable

    def __str__(self) -> str:
        """Return it in words."""
        return f"{self.element}, {self.law}"


@dataclass(frozen=True)
class Kinds:
    """What a cable can be made of.

    slender: stretch and bending alone, None where the scene asks for more; finest: the finest model at hand; why: what
    rules out the one or the other, in words.
    """

    slender: Kind | None
    finest: Kind
    why: tuple[str, ...] = ()


def kinds_of(scene: SceneData, cable: Cable, dim: int) -> Kinds:
    """Return the elements and laws that a cable can have in a scene of this dimension. Raises SceneError if none."""
    slender, finest, why = Kind(CABLES[dim], FULL), Kind(BEAMS[dim], STRUCTURAL), []
    refused = _refusal(cable, finest)
    if needs := _torsion(scene, cable) if dim == 3 else None:
        if refused is not None:
            raise refused
        return Kinds(None, finest, (needs,))
    unable = _refusal(cable, slender)
    if unable is not None:
        if refused is not None:
            raise refused
        return Kinds(None, finest, (f"{slender.element}: {unable.cause}",))
    if refused is not None:
        why.append(f"{finest.element}: {refused.cause}")
        finest = slender
    return Kinds(slender, finest, tuple(why))


def reduced(kind: Kind) -> Kind:
    """Return an element of a cable with the reduced axial strain."""
    return Kind(kind.element, REDUCED) if kind.law == FULL and not is_reduced(kind.law) else kind


def _refusal(cable: Cable, kind: Kind) -> SceneError | None:
    """Return why a cable cannot be made of an element and law, None if it can."""
    try:
        with_model(cable, kind.with_elements(64))
    except SceneError as error:
        return error
    return None


def _torsion(scene: SceneData, cable: Cable) -> str | None:
    """Return why torsion may load a cable in space; None where nothing twists it.

    Without a couple about its tangent a cable of equal bending stiffnesses that is straight without stress bears no
    torque, however it bends (Love, Theory of Elasticity, section 260).
    """
    if cable.is_curved:
        return "it is curved without stress, and cable elements resist in the plane of their curve alone"
    if any(isinstance(load, Moment) and load.on == cable.name for load in scene.loads.values()):
        return "a moment acts on it, which may twist it"
    for drag in scene.drags.values():
        if drag.on == cable.name and drag.polar is not None:
            return f'the flow of "{drag.name}" meets its section at an angle, which its twist changes'
    for slide in scene.slides.values():
        if slide.frame == "section" and cable.name in (slide.along, getattr(slide.body, "on", slide.body)):
            return f'the slide "{slide.name}" turns with its section'
    if any(motion.cable == cable.name and motion.rotation is not None for motion in scene.motions):
        return "a support turns its section"
    if _holds(scene, cable) > 1:
        return "it is held against twist at more than one place"
    return None


def _holds(scene: SceneData, cable: Cable) -> int:
    """Return at how many places a cable is held against twist: by clamps, joints, and ties of frames."""
    places: list[set[str | None]] = [{clamp.cable} for clamp in scene.clamps]
    places += [{joint.a.on, joint.b.on} for joint in scene.joints.values() if joint.joint_kind in TURNING]
    places += [{tie.cable, tie.to} for tie in scene.ties.values() if tie.rotation == "rigid"]
    return sum(cable.name in place for place in places)
