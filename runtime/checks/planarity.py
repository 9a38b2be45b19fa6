"""What would leave the plane z = 0 of a scene of planar cables."""

from __future__ import annotations

from ..errors import SceneError
from ..kernels.elements import built_in
from ..parts.part import Part
from ..parts.scene_data import SceneData
from ..parts.validation import show


def check_plane(scene: SceneData, part: Part | None = None) -> None:
    """Refuse a part, or all of the scene, where it leaves the plane. Raises SceneError."""
    planar = next((cable for cable in scene.cables.values() if cable.dim == 2), None)
    if planar is None:
        return
    spatial = ", ".join(f'"{name}"' for name, kind in built_in().items() if kind.dim == 3)
    remedy = f"let it stay in the plane, or take spatial elements: {spatial}"
    plane = f'leaves the plane z = 0 of the {planar.element} cable "{planar.name}"'
    if part is None and scene.gravity[2]:
        raise SceneError("scene", f"gravity {show(scene.gravity, 'm/s²')} {plane}", remedy)
    for each in scene.parts() if part is None else [part]:
        for what in each.off_plane():
            raise SceneError(each.where, f"{what} {plane}", remedy)
