"""Where the parts of a scene are: nodes of supports and ties, points of cables, bodies and the ground."""

from __future__ import annotations

import numpy as np

from ..base.rotations import cross
from .attachment import Attachment
from .load import DistributedForce
from .scene_data import SceneData
from .support import Support, Tie

Node = tuple[str, int]
"""A node of a cable: the cable's name and the node's number."""


def node_of(scene: SceneData, support: Support) -> Node:
    """Return the node of a support of the scene."""
    return support.cable, scene.cables[support.cable].node(support.s)


def ends_of(scene: SceneData, tie: Tie) -> tuple[Node, Node]:
    """Return the nodes that a tie of the scene joins: that of its cable, and the other one."""
    return ((tie.cable, scene.cables[tie.cable].node(tie.s)), (tie.to, scene.cables[tie.to].node(tie.at)))


def joined(scene: SceneData, node: Node, without: Tie | None = None) -> set[Node]:
    """Return all nodes that ties, but for ``without``, join to ``node``, itself included."""
    found, new = {node}, [node]
    while new:
        at = new.pop()
        for tie in scene.ties.values():
            if at[0] not in (tie.cable, tie.to):
                continue
            pair = set(ends_of(scene, tie))
            if tie is not without and at in pair:
                new += pair - found
                found |= pair
    return found


def support_of(scene: SceneData, node: Node) -> Support | None:
    """Return the support of ``node`` or one that is joined to it."""
    nodes = joined(scene, node)
    cables = {cable for cable, _ in nodes}
    return next((s for s in scene.supports if s.cable in cables and node_of(scene, s) in nodes), None)


def point_of(scene: SceneData, end: Attachment) -> np.ndarray:
    """Return (3,): where a complete end starts, in m."""
    if end.on is None:
        return np.array(end.at)
    if end.on in scene.bodies:
        return scene.bodies[end.on].point(end.point)
    return scene.cables[end.on].point(end.arc_length)


def velocity_of(scene: SceneData, end: Attachment) -> np.ndarray:
    """Return (3,): the velocity, in m/s, with which a complete end is drawn."""
    if end.on is None:
        return np.zeros(3)
    if end.on in scene.bodies:
        body = scene.bodies[end.on]
        turning, arm = body.axes @ body.angular_velocity, body.point(end.point) - body.frame[0]
        return body.velocity + cross(turning, arm)
    cable = scene.cables[end.on]
    return cable.velocity + cross(cable.angular_velocity, cable.point(end.arc_length) - cable.point(0.0))


def attached(scene: SceneData, name: str) -> list[float]:
    """Return the arc-lengths, in m, of a cable at which something that stays there is attached to it, its ends too."""
    places: list[float | None] = []
    for load in scene.loads.values():
        if isinstance(load, DistributedForce):
            places += [load.start, load.stop] if load.cable == name else []
        elif load.on == name:
            places.append(load.s)
    attachments = [*(slide.rider for slide in scene.slides.values()), *scene.attachments()]
    places += [attachment.s for attachment in attachments if attachment.on == name]
    places += [support.s for support in scene.supports if support.cable == name]
    for tie in scene.ties.values():
        places += [s for on, s in ((tie.cable, tie.s), (tie.to, tie.at)) if on == name]
    return [float(s) for s in places if s is not None]
