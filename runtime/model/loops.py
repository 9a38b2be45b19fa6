"""Joints that close kinematic loops: without one of them, its ends would still be connected."""

from __future__ import annotations

from collections.abc import Sequence

from .model import Model


def joints_in_loops(model: Model) -> list[bool]:
    """Return for each joint whether it is part of a loop; the ground and all cables count as one node.

    Equations of a joint in no loop are independent of all others.
    """
    edges = [(joint.attachments[0].body + 1, joint.attachments[1].body + 1) for joint in model.joints]
    riders = [(0, slide.rider.body + 1) for slide in model.slides]
    cut = bridges(len(model.bodies) + 1, [*edges, *riders])
    return [not cut[k] for k in range(len(edges))]


def bridges(n: int, edges: Sequence[tuple[int, int]]) -> list[bool]:
    """Return for each edge of a graph of n nodes whether it is the only connection of its ends (Tarjan 1974)."""
    beside: list[list[tuple[int, int]]] = [[] for _ in range(n)]
    for edge, (a, b) in enumerate(edges):
        beside[a].append((b, edge))
        beside[b].append((a, edge))
    found, lowest, cut = [-1] * n, [0] * n, [False] * len(edges)
    count = 0
    for root in range(n):
        path = [(root, -1, iter(beside[root]))] if found[root] < 0 else []
        while path:
            at, by, rest = path[-1]
            if found[at] < 0:
                found[at] = lowest[at] = count
                count += 1
            for other, edge in rest:
                if edge == by:
                    continue
                if found[other] < 0:
                    path.append((other, edge, iter(beside[other])))
                    break
                lowest[at] = min(lowest[at], found[other])
            else:
                path.pop()
                if path:
                    above = path[-1][0]
                    lowest[above] = min(lowest[above], lowest[at])
                    cut[by] = lowest[at] > found[above]
    return cut
