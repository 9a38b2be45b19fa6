"""Substructuring of chains of elements with many attachments, as in a line of many equal spans.

Each coupling attached to a chain has unknowns in the border, with a column along the whole chain, and is coupled to
all others on the chain. The work is quadratic in the length of the chain, that of the border's dense part cubic. Nodes
moved to the border divide the chain into substructures; then both are linear.
"""

from __future__ import annotations

import numpy as np

from ..parts.joint import Joint
from ..parts.point_force import PointForce
from ..parts.scene_data import SceneData
from .numbering import Incidence, Numbering, extents, numbered

MAX_ATTACHMENTS = 24
"""Attachments of a chain up to which it is not divided: the border is small."""
SUBSTRUCTURE_ATTACHMENTS = 4
"""Attachments of a substructure: a step of a catenary takes as long with 3 to 5 of them, and longer with 8."""


def has_many(attachments: int) -> bool:
    """Return whether chains with this number of attachments may be divided."""
    return attachments > MAX_ATTACHMENTS


def attached(scene: SceneData) -> np.ndarray:
    """Return the elements of all cables, in their order, at the ends of springs and joints, once for each end, and at
    slides as drawn; none where these are too few.
    """
    cables = scene.cables
    if not has_many(2 * (len(scene.point_forces) + len(scene.joints)) + len(scene.slides)):
        return np.zeros(0, dtype=int)
    before = dict(zip(cables, np.cumsum([0, *(cable.elements for cable in cables.values())]).tolist(), strict=False))
    parts: list[PointForce | Joint] = [*scene.point_forces.values(), *scene.joints.values()]
    ends = [end for part in parts for end in (part.a, part.b)]
    places = [(end.on, end.arc_length) for end in ends if end.on in cables]
    places += [(slide.along, slide.arc_length) for slide in scene.slides.values() if slide.along in cables]
    return np.array([before[on] + int(cables[on].mesh.element_at(s)) for on, s in places], dtype=int)


def cut(numbering: Numbering, incidence: Incidence, at: np.ndarray) -> Numbering:
    """Return a numbering with chains of more than `MAX_ATTACHMENTS` attachments divided; at: elements, `attached`."""
    if len(at) <= MAX_ATTACHMENTS:
        return numbering
    low, _ = extents(incidence, numbering.number, numbering.n_band)
    order = at[np.argsort(low[at], kind="stable")]
    chain = np.searchsorted(numbering.chains, low[order], "right") - 1
    border = np.zeros(len(numbering.number), dtype=bool)
    for k in range(len(numbering.chains) - 1):
        mine = order[chain == k]
        if len(mine) <= MAX_ATTACHMENTS:
            continue
        for place in range(SUBSTRUCTURE_ATTACHMENTS, len(mine) - SUBSTRUCTURE_ATTACHMENTS // 2,
                           SUBSTRUCTURE_ATTACHMENTS):
            border[_beginning(mine[place], incidence, low, numbering)] = True
    if not border.any():
        return numbering
    taken = np.argsort(numbering.number)
    number = np.argsort(np.concatenate([taken[~border[taken]], taken[border[taken]]]))
    # the former border stays between the band and the nodes that have moved to the border
    n_band = numbering.n_band - int(border.sum())
    return numbered(incidence, number, n_band)


def _beginning(element: int, incidence: Incidence, low: np.ndarray, numbering: Numbering) -> np.ndarray:
    """Return the unknowns of the band that an element shares with those before it in its chain."""
    of_element = incidence.unknown[incidence.element == element]
    earlier = np.isin(incidence.unknown, of_element) & (low[incidence.element] < low[element])
    shared = np.unique(incidence.unknown[earlier])
    return np.asarray(shared[numbering.number[shared] < numbering.n_band])
