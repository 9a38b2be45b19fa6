"""Chains of elements that much is attached to, cut into pieces of a few attachments each.

What is attached to a chain has unknowns in the border, each with a column along the whole chain, and touches all else
that is attached to it. The work grows with the square of the chain's length, of the border's dense part with the cube.
Nodes in the border cut the chain: then both are linear in its length, as in a line of many equal spans.
"""

from __future__ import annotations

import numpy as np

from ..parts.scene_data import SceneData
from .numbering import Numbering, Touches, extents, numbered

MOST = 24
"""Attachments of a chain that is left as it is: of so few the border is small."""
PIECE = 4
"""Attachments of a piece: a step of a catenary takes as long with 3 to 5 of them, and more with 8 or more."""


def attached(scene: SceneData) -> np.ndarray:
    """Return the elements that springs and joints are attached to, of all cables in their order, once for each; none
    where they are too few for a cut.
    """
    cables = scene.cables
    if 2 * (len(scene.point_forces) + len(scene.joints)) <= MOST:
        return np.zeros(0, dtype=int)
    before = dict(zip(cables, np.cumsum([0, *(cable.elements for cable in cables.values())]).tolist(), strict=False))
    ends = [end for part in (*scene.point_forces.values(), *scene.joints.values()) for end in (part.a, part.b)
            if end.on in cables]
    return np.array([before[end.on] + int(cables[end.on].mesh.element_at(end.arc_length)) for end in ends], dtype=int)


def cut(numbering: Numbering, touches: Touches, at: np.ndarray) -> Numbering:
    """Return a numbering with the chains cut that have more than `MOST` attachments; at: elements, `attached`."""
    if len(at) <= MOST:
        return numbering
    low, _ = extents(touches, numbering.number, numbering.n_band)
    order = at[np.argsort(low[at], kind="stable")]
    chain = np.searchsorted(numbering.chains, low[order], "right") - 1
    border = np.zeros(len(numbering.number), dtype=bool)
    for k in range(len(numbering.chains) - 1):
        mine = order[chain == k]
        if len(mine) <= MOST:
            continue
        for place in range(PIECE, len(mine) - PIECE // 2, PIECE):
            border[_beginning(mine[place], touches, low, numbering)] = True
    if not border.any():
        return numbering
    taken = np.argsort(numbering.number)
    number = np.argsort(np.concatenate([taken[~border[taken]], taken[border[taken]]]))
    # those of the border before stay behind the band, and before what has come to it
    n_band = numbering.n_band - int(border.sum())
    return numbered(touches, number, n_band)


def _beginning(element: int, touches: Touches, low: np.ndarray, numbering: Numbering) -> np.ndarray:
    """Return the unknowns that an element shares with those before it in its chain."""
    own = touches.unknown[touches.element == element]
    of_own = np.isin(touches.unknown, own) & (low[touches.element] < low[element])
    shared = np.unique(touches.unknown[of_own])
    return shared[numbering.number[shared] < numbering.n_band]
