"""The elements and laws that a cable can have: the cheapest one that suits the scene, and the finest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..parts.cable import Cable
from ..parts.load import Moment
from ..parts.scene_data import SceneData
from .remeshing import CableModel, with_model

CABLES = {dim: CableModel(element, "engineering_exact") for dim, element in ((2, "cable8p"), (3, "cable12"))}
BEAMS = {dim: CableModel(element, "structural") for dim, element in ((2, "beam12p"), (3, "beam24"))}
"""Models by dimension of the scene: stretch and bending alone, and all deformations of a beam. The structural law of a
slender beam is the engineering law of a cable. Not among them: green strain, which is another law at large strain, and
the continuum laws, which need finer meshes for the same result."""

TORQUE_JOINTS = ("weld", "revolute", "universal", "prismatic", "cylindrical")
"""Kinds of joints that hold a section or its tangent, and may bear a torque along the cable."""


@dataclass(frozen=True)
class Free:
    """A cable whose model is chosen.

    slender: the model with stretch and bending alone, None where the scene asks for more; finest: the finest model at
    hand; why: reasons that rule out either, in words; base: elements of the coarsest mesh; fixed: the given number of
    elements, None where it is chosen; keeps: whether the element was given.
    """

    cable: Cable
    slender: CableModel | None
    finest: CableModel
    why: tuple[str, ...] = ()
    base: int = 1
    fixed: int | None = None
    keeps: bool = False

    @property
    def could_shear(self) -> bool:
        """Return whether both cable elements and beams are possible."""
        return self.slender not in (None, self.finest)

    @property
    def cheapest(self) -> CableModel:
        """Return the cheapest model."""
        return self.slender or self.finest

    def model(self, kind: CableModel, level: float) -> CableModel:
        """Return a model of an element and law on the mesh of a level, rounded up."""
        return kind.of(self.fixed or self.base * max(1, int(np.ceil(level - 1e-9))))


def possible(scene: SceneData, cable: Cable) -> Free:
    """Return the models that a cable can have in a scene. Raises SceneError where there is none."""
    slender, finest = CABLES[scene.dim], BEAMS[scene.dim]
    no_beam = _refusal(cable, finest)
    why = _torsion(scene, cable) if scene.dim == 3 else None
    if why is None and (no_cable := _refusal(cable, slender)) is not None:
        why = f"{slender.element}: {no_cable.cause}"
    if why is not None:
        if no_beam is not None:
            raise no_beam
        return Free(cable, None, finest, (why,))
    if no_beam is not None:
        return Free(cable, slender, slender, (f"{finest.element}: {no_beam.cause}",))
    return Free(cable, slender, finest)


def _refusal(cable: Cable, kind: CableModel) -> SceneError | None:
    """Return the error of a cable with an element and law, None where both suit it."""
    try:
        with_model(cable, kind.of(64))
    except SceneError as error:
        return error
    return None


def _torsion(scene: SceneData, cable: Cable) -> str | None:
    """Return why torsion may load a cable in space; None where nothing twists it.

    Without a couple about its tangent, a cable that is straight without stress and has equal bending stiffnesses bears
    no torque, however it bends (Love, Theory of Elasticity, section 260).
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
    holds: list[set[str | None]] = [{clamp.cable} for clamp in scene.clamps]
    holds += [{joint.a.on, joint.b.on} for joint in scene.joints.values() if joint.joint_kind in TORQUE_JOINTS]
    holds += [{tie.cable, tie.to} for tie in scene.ties.values() if tie.rotation == "rigid"]
    if sum(cable.name in held for held in holds) > 1:
        return "it is held against twist at more than one place"
    return None
