"""Scenes with other models of their cables: the same parts with another element, law or mesh."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TypeVar

import numpy as np

from ..errors import FunicularWarning
from ..kernels.elements import built_in
from ..parts.cable import Cable
from ..parts.load import Force, Moment
from ..parts.rope import Rope
from ..parts.scene_data import SceneData
from ..parts.scene_methods import SceneMethods
from ..parts.validation import LENGTH_TOLERANCE

S = TypeVar("S", bound=SceneMethods)

MAX_COARSEST_ELEMENTS = 1000
"""Elements of a coarsest mesh with nodes at all supports; a scene that needs more is refused."""

MAX_ELEMENTS_FOR_LOADS = 12
"""Elements of a coarsest mesh that also has nodes at point loads and joints."""

ELEMENT_WORK = {"cable8p": 1.0, "cable12": 1.5, "cable18": 3.0, "beam12p": 1.9, "beam24": 4.8}
"""CPU time of an element over a run, relative to cable8p, measured on pendulums of 4 to 64 elements: 1.5 times an
iteration for cable12, 1.6 and 4 times for beams, whose runs have a fifth more iterations."""


@dataclass(frozen=True)
class CableModel:
    """A model of a cable: element, law and number of elements; the arc-lengths of the nodes of unequal elements, m.

    Without a number of elements it stands for the element and law alone.
    """

    element: str
    law: str
    elements: int = 0
    nodes: tuple[float, ...] = ()

    def __str__(self) -> str:
        """Return the model in a few words."""
        return f"{self.elements} {'unequal ' if self.nodes else ''}{self.element}, {self.law}"

    def of(self, elements: int) -> CableModel:
        """Return the same element and law with a number of equal elements, 0 for none."""
        return CableModel(self.element, self.law, elements)

    def halved(self, nodes: np.ndarray) -> CableModel:
        """Return the model with every element halved; nodes: arc-lengths of the nodes then, in m."""
        return replace(self, elements=2 * self.elements, nodes=tuple(nodes.tolist()) if self.nodes else ())

    @property
    def work(self) -> float:
        """Return the CPU time of its elements over a run, relative to one cable8p."""
        return self.elements * ELEMENT_WORK.get(self.element, 6.0)

    @property
    def shears(self) -> bool:
        """Return whether its element is a beam, which shears and twists."""
        kind = built_in().get(self.element)
        return kind is None or not kind.is_cable


def remade(scene: S, models: Mapping[str, CableModel]) -> S:
    """Return the scene with these models of its cables, checked as any scene is. Raises SceneError."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FunicularWarning)  # the scene itself reported its adjustments
        return scene.with_parts(with_model(part, models[part.name]) if isinstance(part, Cable) and part.name in models
                                else part for part in scene.parts())


def with_finer_ropes(scene: S) -> S:
    """Return the scene with ropes of elements of half the length, see `Rope.refined`. Raises SceneError."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FunicularWarning)
        return scene.with_parts(part.refined() if isinstance(part, Rope) else part for part in scene.parts())


def with_model(cable: Cable, model: CableModel) -> Cable:
    """Return a cable with another model. Raises SceneError where its section or shape does not suit the model."""
    given = {name: value for name, value in cable.entries().items() if name not in ("strain", "curvature", "membrane")}
    mesh = {"nodes": model.nodes, "elements": None} if model.nodes else cable.mesh_entries(model.elements)
    return Cable(**given | {"element": model.element, "law": model.law} | mesh)


def coarsest(scene: SceneData, cable: Cable) -> int:
    """Return the smallest number of equal elements with nodes at all supports, ties and watched nodes of a cable; of a
    cable of pieces, of elements in the given ratio of the pieces.

    Nodes at point loads and joints are added where `MAX_ELEMENTS_FOR_LOADS` suffice. Every multiple has these nodes,
    too. 0 where no mesh of up to `MAX_COARSEST_ELEMENTS` has them.
    """
    divide = _common_division if cable.pieces is None else _division_of_pieces
    count = divide(_supported(scene, cable), cable)
    on_nodes = divide(node_places(scene, cable), cable)
    return on_nodes if 0 < on_nodes <= max(count, MAX_ELEMENTS_FOR_LOADS) else count


def node_places(scene: SceneData, cable: Cable) -> list[float]:
    """Return the arc-lengths of a cable's supports, ties, watched nodes, point loads and masses, and joints, in m."""
    loads = [load.s for load in scene.loads.values()
             if isinstance(load, Force | Moment) and load.on == cable.name and isinstance(load.s, float)]
    loads += [mass.s for mass in scene.masses_on(cable.name)]
    return [*_supported(scene, cable), *loads, *(end.arc_length for end in scene.attachments() if end.on == cable.name)]


def _supported(scene: SceneData, cable: Cable) -> list[float]:
    """Return the arc-lengths of supports, ties and watched nodes, which must stand on nodes, in m."""
    ends = [(tie.cable, tie.s) for tie in scene.ties.values()] + [(tie.to, tie.at) for tie in scene.ties.values()]
    ends += [(support.cable, support.s) for support in scene.supports]
    watched = [event.s for event in scene.events.values()
               if event.s is not None and (event.quantity or "").startswith(f"{cable.name}.")]
    return [s for name, s in ends if name == cable.name] + watched


def _common_division(places: list[float], cable: Cable) -> int:
    """Return the smallest number of equal parts of a cable with borders at all places, 0 where it is too large."""
    return _parts(places, cable.length)


def _parts(places: list[float], length: float) -> int:
    count = 1
    for s in places:
        fraction = Fraction(s / length).limit_denominator(MAX_COARSEST_ELEMENTS)
        if abs(float(fraction) - s / length) > LENGTH_TOLERANCE / 2:
            return 0
        count = math.lcm(count, fraction.denominator)
    return count if count <= MAX_COARSEST_ELEMENTS else 0


def _division_of_pieces(places: list[float], cable: Cable) -> int:
    """Return the smallest number of elements of a cable of pieces, in their ratio, with nodes at all places, 0 where it
    is too large.
    """
    assert cable.pieces is not None, f"{cable.where} has no pieces"
    common = math.gcd(*(piece.elements for piece in cable.pieces))
    start, factor, least = 0.0, 1, 0
    for piece in cable.pieces:
        near, elements = LENGTH_TOLERANCE * cable.length, piece.elements // common
        within = [s - start for s in places if start + near < s < start + piece.length - near]
        if not (count := _parts(within, piece.length)):
            return 0
        factor = math.lcm(factor, count // math.gcd(count, elements))
        start, least = start + piece.length, least + elements
    return factor * least if factor * least <= MAX_COARSEST_ELEMENTS else 0
