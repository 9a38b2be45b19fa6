"""Where the parts of a scene are: nodes that supports and ties hold, points of cables, bodies and the ground."""

from __future__ import annotations

import numpy as np

from .attachment import Attachment
from .scene_data import SceneData
from .support import Support, Tie

Node = tuple[str, int]
"""A node of a cable: the cable's name and the node's number."""


def node_of(scene: SceneData, support: Support) -> Node:
    """The node that a support of the scene holds."""
    return support.cable, scene.cables[support.cable].node_at(support.s)


def ends_of(scene: SceneData, join: Tie) -> tuple[Node, Node]:
    """The nodes that a join of the scene ties: that of its cable, and the other one."""
    return ((join.cable, scene.cables[join.cable].node_at(join.s)), (join.to, scene.cables[join.to].node_at(join.at)))


def joined(scene: SceneData, node: Node, without: Tie | None = None) -> set[Node]:
    """All nodes that joins, but for ``without``, tie to ``node``, itself included."""
    found, new = {node}, [node]
    while new:
        at = new.pop()
        for join in scene.ties.values():
            if at[0] not in (join.cable, join.to):
                continue
            pair = set(ends_of(scene, join))
            if join is not without and at in pair:
                new += pair - found
                found |= pair
    return found


def support_of(scene: SceneData, node: Node) -> Support | None:
    """What holds ``node`` or one that is joined to it."""
    nodes = joined(scene, node)
    cables = {cable for cable, _ in nodes}
    return next((s for s in scene.supports if s.cable in cables and node_of(scene, s) in nodes), None)


def point_of(scene: SceneData, end: Attachment) -> np.ndarray:
    """(3,): where a complete end starts, in m."""
    if end.on is None:
        return np.array(end.at)
    return scene.bodies[end.on].point(end.at) if end.on in scene.bodies else scene.cables[end.on].point(end.s)
