"""Check of the bodies that carry the sheaves of ropes in space."""

from __future__ import annotations

from ..errors import SceneError
from ..parts.modal_body import ModalBody
from ..parts.scene_data import SceneData


def check_carriers(scene: SceneData) -> None:
    """Raise SceneError for a sheave in space on a body that may rotate: the plane of its groove is fixed."""
    for rope in scene.ropes.values():
        for item in rope.sheaves if rope.dim == 3 else ():
            body = item.end.on
            if body is not None and not _translates(scene, body, set()):
                raise SceneError(rope.where, f'{item.where} is on body "{body}", which may rotate',
                                 "hold the sheave at the ground, or guide a rigid body by a prismatic joint with the "
                                 "ground or with a body that is guided so: sheaves that tilt are not possible yet")


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
