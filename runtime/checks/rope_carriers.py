"""Which bodies that carry the sheaves and drums of ropes in space may rotate."""

from __future__ import annotations

from ..errors import SceneError
from ..parts.modal_body import ModalBody
from ..parts.scene_data import SceneData


def may_turn(scene: SceneData, body: str | None) -> bool:
    """Return whether a body, None for the ground, may rotate, and with it the grooves of wheels on it."""
    return body is not None and not _translates(scene, body, set())


def check_wheels_with_inertia(scene: SceneData) -> None:
    """Raise SceneError for a wheel with inertia of a rope without mass in space, on a body that may rotate: the moment
    by which a spinning wheel resists a tilt of its axis is not modelled there.
    """
    for rope in scene.ropes.values():
        for wheel in rope.wheels if rope.dim == 3 and not rope.mass else ():
            if wheel.inertia > 0 and may_turn(scene, wheel.end.on):
                raise SceneError(f"{rope.where}: {wheel.where}", f'has inertia on body "{wheel.end.on}", which may '
                                 "rotate, and its rope has no mass: its axis would tilt as it spins",
                                 "leave the inertia out and give it to the body, or give the rope a small mass")


def _translates(scene: SceneData, body: str, known: set[str]) -> bool:
    """Return whether joints keep the orientation of a rigid body, as modes turn points of others; known: bodies on the
    way to it.
    """
    if isinstance(scene.bodies[body], ModalBody):
        return False
    for joint in scene.joints.values():
        ends = [end.on for end in (joint.a, joint.b)]
        if joint.joint_kind in ("prismatic", "weld") and body in ends:
            other = ends[1 - ends.index(body)]
            if other is None or (other in scene.bodies and other not in known
                                 and _translates(scene, other, known | {body})):
                return True
    return False
