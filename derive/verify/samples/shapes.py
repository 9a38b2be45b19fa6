"""Shapes of sample elements: the straight reference, rotations, sections, points of the axis."""

from __future__ import annotations

import numpy as np

from ...spec import Element
from ..motion import exponential
from ..numbers import State
from ..references.element import Shape

LENGTH, HEIGHT, WIDTH = 0.7, 0.31, 0.23


def reference(element: Element, l: float) -> np.ndarray:
    """Return the nodal vectors of the straight undeformed element along x."""
    rows = []
    for ratio in element.node_ratios:
        for vector in element.nodal_vectors:
            slope = vector.partition("_")[2]
            row = np.zeros(3)
            if not slope:
                row[0] = float(ratio) * l
            elif len(slope) == 1:
                row["xyz".index(slope)] = 1.0
            rows.append(row[: element.dim])
    return np.array(rows)


def rotation(random: np.random.Generator, dim: int, angle: float | None = None) -> np.ndarray:
    """Return a rotation matrix: by a random vector, or by an angle about a random axis."""
    if dim == 2:
        turn = random.normal() if angle is None else angle
        return np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    vector = random.normal(size=3)
    vector *= 1.0 if angle is None else angle / np.linalg.norm(vector)
    q = exponential(np, vector)
    v = np.array([[0, -q[3], q[2]], [q[3], 0, -q[1]], [-q[2], q[1], 0]])
    return np.asarray(np.eye(3) + 2 * (q[0] * v + v @ v))


def section(height: float = HEIGHT, width: float = WIDTH) -> np.ndarray:
    """Return the moments of a rectangle, in the order of the kernels' argument."""
    powers = ((0, 0), (2, 0), (0, 2), (4, 0), (2, 2), (0, 4))
    return np.array([height ** (a + 1) / 2**a / (a + 1) * width ** (b + 1) / 2**b / (b + 1) for a, b in powers])


def on_axis(element: Element, state: State, order: int = 0) -> np.ndarray:
    """Return the point of the centreline at the state's x, or a derivative there."""
    return np.asarray(Shape(element, state["l"])((state["x"], 0, 0), (order, 0, 0)).astype(float) @ state["e"])


def director(element: Element, state: State, random: np.random.Generator) -> np.ndarray:
    """Return a direction off the tangent, neither of unit length nor normal to it."""
    tangent = on_axis(element, state, 1)
    tangent /= np.linalg.norm(tangent)
    normal = np.linalg.qr(np.stack([tangent, *random.normal(size=(element.dim - 1, element.dim))], axis=1))[0][:, 1]
    return 0.6 * tangent + 1.3 * normal
