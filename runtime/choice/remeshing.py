"""Scenes with other models of their cables: the same parts, another element, law or number of elements."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TypeVar

import numpy as np

from ..errors import FunicularWarning
from ..parts.cable import Cable
from ..parts.event import Event
from ..parts.load import Force, Moment
from ..parts.scene_data import SceneData
from ..parts.scene_methods import SceneMethods
from ..parts.validation import EXACT

S = TypeVar("S", bound=SceneMethods)

MOST_PARTS = 1000
"""Elements of the coarsest mesh with nodes at all supports; more are refused."""

FEW_PARTS = 12
"""Elements of the coarsest mesh, up to which point loads and joints on the cable stand on nodes, too."""


@dataclass(frozen=True)
class CableModel:
    """What is chosen of a cable: its element, its law, and the number of its elements; their nodes where unequal."""

    element: str
    law: str
    elements: int
    nodes: tuple[float, ...] = ()

    def __str__(self) -> str:
        """Return it in a few words."""
        return f"{self.elements} {'unequal ' if self.nodes else ''}{self.element}, {self.law}"

    def halved(self, nodes: np.ndarray) -> CableModel:
        """Return it with every element halved; nodes: of these halves, arc-lengths in m."""
        return replace(self, elements=2 * self.elements, nodes=tuple(nodes.tolist()) if self.nodes else ())


def remade(scene: S, models: Mapping[str, CableModel]) -> S:
    """Return the scene with these models of its cables, checked as any scene is. Raises SceneError."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FunicularWarning)  # what was adjusted has been said of the scene itself
        return scene.with_parts(with_model(part, models[part.name]) if isinstance(part, Cable) and part.name in models
                                else part for part in scene.parts())


def with_model(cable: Cable, model: CableModel) -> Cable:
    """Return a cable with another model. Raises SceneError where its section or shape do not suit that."""
    given = {name: value for name, value in cable.entries().items() if name not in ("strain", "curvature", "membrane")}
    mesh = {"nodes": model.nodes, "elements": None} if model.nodes else cable.mesh_entries(model.elements)
    return Cable(**given | {"element": model.element, "law": model.law} | mesh)


def coarsest(scene: SceneData, cable: Cable) -> int:
    """Return the least number of elements that has nodes at all supports and ties of a cable, and, where few elements
    do, at its point loads and joints.

    Every multiple of it has them, too. 0 where no mesh of at most `MOST_PARTS` elements has them.
    """
    needed = _needed(scene, cable)
    count = _common(needed, cable.length)
    on_nodes = _common(node_places(scene, cable), cable.length)
    return on_nodes if 0 < on_nodes <= max(count, FEW_PARTS) else count


def node_places(scene: SceneData, cable: Cable) -> list[float]:
    """Return the arc-lengths of a cable's supports, ties, watched nodes, point loads and joints, in m."""
    wanted = [load.s for load in scene.loads.values()
              if isinstance(load, Force | Moment) and load.on == cable.name and load.s is not None]
    wanted += [end.arc_length for end in scene.attachments() if end.on == cable.name]
    return [*_needed(scene, cable), *wanted]


def _needed(scene: SceneData, cable: Cable) -> list[float]:
    """Return the arc-lengths at which a cable must have nodes: those of supports, ties and watched nodes, in m."""
    needed = [support.s for support in scene.supports if support.cable == cable.name]
    for tie in scene.ties.values():
        needed += [s for name, s in ((tie.cable, tie.s), (tie.to, tie.at)) if name == cable.name]
    return needed + [event.s for event in scene.events.values() if event.s is not None and _watches(event, cable)]


def _watches(event: Event, cable: Cable) -> bool:
    return (event.quantity or "").startswith(f"{cable.name}.")


def _common(places: list[float], length: float) -> int:
    """Return the least number of equal parts of a length with borders at all places, 0 where that exceeds MOST_PARTS.
    """
    count = 1
    for s in places:
        fraction = Fraction(s / length).limit_denominator(MOST_PARTS)
        if abs(float(fraction) - s / length) > EXACT / 2:
            return 0
        count = math.lcm(count, fraction.denominator)
        if count > MOST_PARTS:
            return 0
    return count
