"""The nodes that a cable is given: they increase from 0 to its length, and no element is much shorter than another."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydantic import PlainValidator

from ..kernels.mesh import Mesh
from .schemas import checked, list_schema
from .validation import EXACT, MOST, show, shown, vector

MOST_RATIO = 1e6
"""Of the longest element of a cable over the shortest: beyond it rounding of the stiff ones hides the soft ones."""

EVEN = 1e-12
"""Of the length: nodes that are so near to those of equal elements are theirs."""


def increasing() -> PlainValidator:
    """Return the check of the arc-lengths of nodes: two or more, from 0 on, each larger than the one before."""
    def check(value: Any) -> tuple[float, ...]:
        value = value.tolist() if isinstance(value, np.ndarray) else value
        if not isinstance(value, list | tuple) or len(value) < 2:
            raise ValueError(f"must be a list of 2 arc-lengths or more, got {shown(value)}")
        if len(value) > MOST + 1:
            raise ValueError(f"must not be more than {MOST + 1}, got {len(value)}")
        nodes = vector(value, "m", len(value))
        if nodes[0] != 0:
            raise ValueError(f"must begin at 0, the start of the cable, got {show(nodes[0], 'm')}")
        lengths = np.diff(nodes)
        if (lengths <= 0).any():
            k = int(np.argmax(lengths <= 0))
            raise ValueError(f"must increase, but {show(nodes[k + 1], 'm')} follows on {show(nodes[k], 'm')}",
                             "give each node once, from start to end")
        ratio = float(lengths.max() / lengths.min())
        if ratio > MOST_RATIO:
            k = int(np.argmin(lengths))
            raise ValueError(f"are too close at {show(nodes[k], 'm')} and {show(nodes[k + 1], 'm')}: the longest "
                             f"element is {ratio:.3g} times as long, at most {MOST_RATIO:g} times is allowed",
                             "leave one of them out, or put more nodes elsewhere")
        return nodes

    return checked(check, list_schema("m", 2, None))


def check_ends(nodes: tuple[float, ...], length: float) -> None:
    """Raise ValueError(cause, remedy) where the last node is not at the end of a cable of that undeformed length."""
    if abs(nodes[-1] - length) > EXACT * length:
        raise ValueError(f"nodes must end at the cable's undeformed length, {length!r} m, got {nodes[-1]!r} m",
                         "give arc-lengths of the undeformed cable, from 0 to its length")


def mesh_of(nodes: tuple[float, ...], length: float) -> Mesh:
    """Return the mesh of nodes on a cable of that length; nodes of equal elements make the mesh of these."""
    n, node_s = len(nodes) - 1, np.array(nodes)
    node_s[-1] = length
    if np.abs(node_s - length * np.arange(n + 1) / n).max() <= EVEN * length:
        return Mesh.even(length / n, n)
    return Mesh.of_nodes(node_s)


def refined(nodes: tuple[float, ...], elements: int) -> tuple[float, ...]:
    """Return the nodes of so many elements, where these divide or join the given ones alike; else ()."""
    n = len(nodes) - 1
    if n < 1 or (elements % n and n % elements):
        return ()
    if elements < n:
        return nodes[:: n // elements]
    return tuple(Mesh.of_nodes(np.array(nodes)).divided(elements // n).tolist())
