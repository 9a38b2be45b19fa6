"""Invariances of kernels under motions of the frame: by role of the family, each as (text, error, ceiling).

The error is relative to the scale that the text's quantity has in the sample.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from ...codegen.family import Family
from ..numbers import Numbers, State
from . import body, crossing, drag, element, frame, joint, law, modal, point_law, resistance, slide, surface
from .measures import Invariance

OF_ROLE: dict[str, Callable[[Any, Numbers, State], Iterator[Invariance]]] = {
    "element": element.element, "law": law.law, "slide": slide.slide, "body": body.body, "modal": modal.modal,
    "frame": frame.frame, "joint": joint.joint, "resistance": resistance.resistance, "drag": drag.drag,
    "crossing": crossing.crossing,
    "surface": surface.surface,
    "point_law": point_law.point_law}


def invariances(family: Family, k: Numbers, states: list[State]) -> Iterator[Invariance]:
    """Yield the invariances of a family at each of its states; the caller keeps the worst of each."""
    for s in states:
        yield from OF_ROLE[family.role](family, k, s)
