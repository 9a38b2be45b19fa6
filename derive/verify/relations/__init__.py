"""Relations between the outputs of kernels and derivatives, by role of the family, for any element and any rider."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...codegen.family import Family
from ..methods import Relation
from . import body, crossing, drag, element, frame, joint, law, modal, point_law, resistance, slide, surface

OF_ROLE: dict[str, Callable[[Any], list[Relation]]] = {
    "element": element.element, "law": law.law, "slide": slide.slide, "body": body.body, "modal": modal.modal,
    "frame": frame.frame, "joint": joint.joint, "resistance": resistance.resistance, "drag": drag.drag,
    "crossing": crossing.crossing,
    "surface": surface.surface,
    "point_law": point_law.point_law}


def relations(family: Family) -> list[Relation]:
    """Return the relations of a family's kernels."""
    return OF_ROLE[family.role](family)
