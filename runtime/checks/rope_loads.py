"""Checks of what acts on ropes along their spans or at a material point: loads."""

from __future__ import annotations

from ..errors import SceneError
from ..parts.attachment import Attachment
from ..parts.load import DistributedForce, Force, Load, Moment
from ..parts.part import Part
from ..parts.rope import Rope
from ..parts.scene_data import SceneData
from ..parts.signal import Signal
from .placement import check_has_mass, placed_load, placed_on_rope


def rope_of(scene: SceneData, load: Load) -> Rope | None:
    """Return the rope that a load acts on, None for another part."""
    return scene.ropes.get(load.cable if isinstance(load, DistributedForce) else getattr(load, "on", ""))


def placed(scene: SceneData, load: Force | DistributedForce | Moment) -> Part:
    """Return the load with its place complete, on a rope checked to lie in a span or along it. Raises SceneError."""
    if (rope := rope_of(scene, load)) is None or isinstance(getattr(load, "s", None), Signal):
        return placed_load(scene, load)
    if isinstance(load, Moment):
        raise SceneError(load.where, f'acts on rope "{rope.name}", whose sections have no axes on which a moment could '
                         "act", f'let it act on a body that a joint to ("{rope.name}", s) holds')
    if load.follower:
        raise SceneError(load.where, f'follower force on rope "{rope.name}", which has no axes that it could follow',
                         "leave follower out")
    if isinstance(load, Force):
        placed_on_rope(scene, Attachment(on=load.on, s=load.s, at=load.at), load.where, "")
        return load
    check_has_mass(rope, load.where)
    whole = scene.route_of(rope).free_length + rope.length_in_store
    for name in ("start", "stop"):
        s = getattr(load, name)
        if s is not None and not 0 <= s <= whole:
            raise SceneError(load.where, f"{name} must lie on the rope, in [0, {whole:.9g}] m, got {s:.9g} m")
    return load

