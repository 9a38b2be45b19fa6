"""What would leave the plane of a scene of planar cables."""

from __future__ import annotations

import numpy as np

from ..errors import SceneError
from ..kernels.elements import built_in
from ..parts.laid import turned_alone
from ..parts.part import Part
from ..parts.plane import aligned, called
from ..parts.scene_data import SceneData
from ..parts.validation import show


def check_plane(scene: SceneData, part: Part | None = None) -> None:
    """Refuse a part, or all of the scene, where it leaves the plane. Raises SceneError."""
    planar = next((cable for cable in scene.cables.values() if cable.dim == 2), None)
    if planar is None:
        return
    spatial = ", ".join(f'"{name}"' for name, kind in built_in().items() if kind.dim == 3)
    remedy = f"let it stay in the plane, or take spatial elements: {spatial}"
    own = planar.plane
    plane = f'leaves {called(own)} of the {planar.element} cable "{planar.name}"'
    gravity = scene.gravity if own is None else aligned(own.into(np.array(scene.gravity)))
    if part is None and gravity[2]:
        raise SceneError("scene", f"gravity {show(scene.gravity, 'm/s²')} {plane}", remedy)
    for each in scene.parts() if part is None else [part]:
        seen = each if own is None else turned_alone(scene, own, each)
        for what in seen.off_plane():
            raise SceneError(each.where, f"{what} {plane}" + ", in whose axes it is" * (own is not None), remedy)
