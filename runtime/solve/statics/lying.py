"""Cables that lie on a round surface as drawn: the step of the search that keeps them there, and whether they left it.

A step longer than the diameter of a cable takes it through a drum, or off it; friction holds it only under pressure.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...engine import outputs_by_name
from ...model.model import Model
from ...model.states import distances
from ...parts.scene_data import SceneData
from .static_problem import StaticProblem

BED_SHAPES = ("flat", "terrain")
"""Shapes of surfaces that a cable does not fall off."""
GAP_TOLERANCE = 0.1
"""Gaps below this fraction of a cable's radius count as closed in the drawing."""
MIN_CONTACT_FRACTION = 0.1
"""A cable has left its bed if it is in contact on less than this fraction of the length on which it lies as drawn."""
MAX_RMS_STEP = 0.02
"""Root mean square over the nodes of a step, as a fraction of the same length."""


class Lying(NamedTuple):
    """The number of a penalty contact on which a cable lies as drawn, first and last arc-length in m, the longest step
    in m.
    """

    contact: int
    first: float
    last: float
    step: float


def lying(scene: SceneData, model: Model, q: np.ndarray) -> list[Lying]:
    """Return the contacts on which cables lie at a configuration (n,)."""
    found = []
    for k, contact in enumerate(model.contacts):
        part = scene.contacts[contact.name]
        if contact.cable < 0 or scene.surfaces[part.b].geometry.word in BED_SHAPES:
            continue
        thick = max(contact.radius, float(np.sqrt(
            min(piece.section.area for piece in scene.cables[part.a].uniform_pieces) / np.pi)))
        on = np.flatnonzero(distances(model, scene, contact, q[None]).ravel() <= contact.radius + GAP_TOLERANCE * thick)
        nodes = model.cables[contact.cable].mesh.n_nodes
        if len(on):
            found.append(Lying(k, float(contact.arc[on[0]]), float(contact.arc[on[-1]]),
                               MAX_RMS_STEP * thick * float(np.sqrt(nodes))))
    return found


def left(problem: StaticProblem, places: list[Lying]) -> list[str]:
    """Return a message for each of these contacts that the cable has left in the static state."""
    if not places:
        return []
    in_contact = outputs_by_name("contact", problem.engine.static_outputs("contact"))["touching"]
    return [f"{_lies(problem, place)}, and has left it: it slid off, or the search carried it past the surface. Take "
            "scene.relax(), or more friction" for place in places
            if in_contact[place.contact] < MIN_CONTACT_FRACTION * (place.last - place.first)]


def not_held(problem: StaticProblem, places: list[Lying]) -> str:
    """Return why a search may have failed for cables that lie on a surface; empty for others."""
    return "; ".join(f"{_lies(problem, place)}, and may slide off it: more friction holds it" for place in places)


def _lies(problem: StaticProblem, place: Lying) -> str:
    """Return the place where a cable lies as drawn, in words."""
    part = problem.scene.contacts[problem.model.contacts[place.contact].name]
    return (f'{part.where}: "{part.a}" lies on "{part.b}" as drawn, from s = {place.first:.4g} m to '
            f"{place.last:.4g} m")
