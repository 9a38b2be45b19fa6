"""Checks of a scene as a whole, before a run, a search for equilibrium or an analysis of modes."""

from __future__ import annotations

from ..errors import SceneError
from ..parts.modal_body import ModalBody
from ..parts.scene_data import SceneData
from ..parts.validation import LENGTH_TOLERANCE, show
from .joint_placement import check_drive, check_joint
from .planarity import check_plane
from .slide_placement import check_on_cable


def check_scene(scene: SceneData) -> None:
    """Raise SceneError where the parts of a scene do not go together."""
    if not scene.cables and not scene.bodies:
        raise SceneError("scene", "is empty: there is nothing to simulate", "add a cable or a rigid body")
    check_plane(scene)
    for joint in scene.joints.values():
        check_joint(scene, joint)
    for body in scene.bodies.values():
        if isinstance(body, ModalBody) and (massless := body.shape.indefinite(scene.dim)):
            raise SceneError(body.where, f"its mass matrix is not positive definite: {massless}",
                             "leave such a mode out, or give masses off the line that the others are on")
    for slide in scene.slides.values():
        check_on_cable(scene, slide)


def check_start_as_drawn(scene: SceneData) -> None:
    """Raise SceneError where a run that starts as drawn would begin with a jump of what motions and joints drive."""
    for motion in scene.motions:
        length = scene.cables[motion.cable].length
        starts = [(f"displacement {axis}", signal, length, "m")
                  for axis, signal in zip("xyz", motion.displacement or (), strict=False)
                  if signal is not None]
        starts += [("rotation", motion.rotation.angle, 1.0, "rad")] if motion.rotation else []
        for name, signal, size, unit in starts:
            if abs(value := float(signal.value(0.0))) > LENGTH_TOLERANCE * size:
                raise SceneError(motion.where, f"{name} is {show(value, unit)} at t = 0, but counts from the place "
                                 "drawn", 'let it start from 0, or start with initial="equilibrium"')
    for joint in scene.joints.values():
        check_drive(scene, joint)
