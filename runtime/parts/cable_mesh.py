"""The given nodes of a cable: they increase from 0 to its length, and no element is much shorter than another."""

from __future__ import annotations

from functools import lru_cache
from typing import Annotated, Any

import numpy as np

from ..kernels.mesh import Mesh
from .schemas import checked, list_schema
from .validation import LENGTH_TOLERANCE, MAX_COUNT, items, show, shown, vector

MAX_LENGTH_RATIO = 1e6
"""Of the longest element of a cable over the shortest: above it rounding of stiff elements hides soft ones."""
EVEN_TOLERANCE = 1e-12
"""Distance of nodes from those of equal elements, over the length, up to which elements count as equal."""


def _nodes(value: Any) -> tuple[float, ...]:
    """Return arc-lengths of nodes in m: two or more, increasing from 0."""
    if (given := items(value, 2)) is None:
        raise ValueError(f"must be a list of 2 arc-lengths or more, got {shown(value)}")
    if len(given) > MAX_COUNT + 1:
        raise ValueError(f"must not be more than {MAX_COUNT + 1}, got {len(given)}")
    nodes = vector(given, "m", len(given))
    if nodes[0] != 0:
        raise ValueError(f"must begin at 0, the start of the cable, got {show(nodes[0], 'm')}")
    lengths = np.diff(nodes)
    if (lengths <= 0).any():
        k = int(np.argmax(lengths <= 0))
        raise ValueError(f"must increase, but {show(nodes[k + 1], 'm')} follows on {show(nodes[k], 'm')}",
                         "give each node once, from start to end")
    ratio = float(lengths.max() / lengths.min())
    if ratio > MAX_LENGTH_RATIO:
        k = int(np.argmin(lengths))
        raise ValueError(f"are too close at {show(nodes[k], 'm')} and {show(nodes[k + 1], 'm')}: the longest "
                         f"element is {ratio:.3g} times as long, at most {MAX_LENGTH_RATIO:g} times is allowed",
                         "leave one of them out, or put more nodes elsewhere")
    return nodes


Nodes = Annotated[tuple[float, ...], checked(_nodes, list_schema("m", 2, None))]


def check_ends(nodes: tuple[float, ...], length: float) -> None:
    """Raise ValueError(cause, remedy) unless the last node is at the end of a cable of this undeformed length, m."""
    if abs(nodes[-1] - length) > LENGTH_TOLERANCE * length:
        raise ValueError(f"nodes must end at the cable's undeformed length, {length!r} m, got {nodes[-1]!r} m",
                         "give arc-lengths of the undeformed cable, from 0 to its length")


@lru_cache(maxsize=128)
def even_mesh(length: float, n_elements: int) -> Mesh:
    """Return the mesh of equal elements of a length, in m."""
    return Mesh.even(length, n_elements)


@lru_cache(maxsize=128)
def even_nodes(total: float, n_elements: int) -> np.ndarray:
    """Return (nodes,): arc-lengths of the nodes of equal elements on a cable of a length in m, read-only."""
    node_s: np.ndarray = total * np.arange(n_elements + 1) / n_elements
    node_s.flags.writeable = False
    return node_s


def mesh_of(nodes: tuple[float, ...], length: float) -> Mesh:
    """Return the mesh of nodes on a cable of a length in m; that of equal elements where they are."""
    n, node_s = len(nodes) - 1, np.array(nodes)
    node_s[-1] = length
    if np.abs(node_s - length * np.arange(n + 1) / n).max() <= EVEN_TOLERANCE * length:
        return Mesh.even(length / n, n)
    return Mesh.of_nodes(node_s)


def refined(nodes: tuple[float, ...], elements: int) -> tuple[float, ...]:
    """Return the nodes of a number of elements that divides or joins the given ones evenly; else ()."""
    n = len(nodes) - 1
    if n < 1 or (elements % n and n % elements):
        return ()
    if elements < n:
        return nodes[:: n // elements]
    return tuple(Mesh.of_nodes(np.array(nodes)).divided(elements // n).tolist())
