"""Checks of branches against their scene."""

from __future__ import annotations

from ..errors import SceneError
from ..parts.branch import Branch
from ..parts.scene_data import SceneData
from .placement import cable_of, check_strained_by_forces

ELEMENTS = ("cable8p", "cable12")
"""Elements whose strain and curvature a branch takes at two points."""


def placed_branch(scene: SceneData, part: Branch) -> Branch:
    """Return the branch, checked to suit its cable. Raises SceneError."""
    if part.cable in scene.ropes:
        raise SceneError(
            part.where,
            f'acts on cables alone, but "{part.cable}" is a rope, through whose elements the material moves',
            "take a cable",
        )
    cable = cable_of(scene, part.cable, part.where)
    if cable.library is not None or cable.element not in ELEMENTS:
        raise SceneError(
            part.where,
            f"acts on {' and '.join(ELEMENTS)}, but {cable.where} is of {cable.element}",
            "take one of these elements",
        )
    stretches = any(curve.cable == part.cable for curve in scene.working_curves.values()) and not part.bends
    if cable.gives_way and not stretches:
        raise SceneError(
            part.where,
            f"{cable.where} resists tension alone, and a branch would push",
            'take the membrane "full" or "assumed"',
        )
    check_strained_by_forces(cable, part.where, "branch")
    if part.bends and cable.is_curved:
        raise SceneError(
            part.where,
            f"{cable.where} is curved where it is free of stress",
            'draw it straight, or give it rest="straight"',
        )
    return part
