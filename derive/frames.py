"""The tangent frame of a cable's centreline (eq 13-18)."""

from __future__ import annotations

import numpy as np
import sympy as sp
from funicular.derive.stages import Program


def unit(program: Program, name: str, vector: np.ndarray) -> np.ndarray:
    """vector / |vector|."""
    inverse = program.define(f"inv_{name}", 1 / program.define(f"len_{name}", sp.sqrt(vector.dot(vector))))
    return program.vector(name, inverse * vector)


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Vector product; for b in the plane, a is the component along z: (a,) times b turned by +90 degrees."""
    if len(b) == 2:
        return a[0] * np.array([-b[1], b[0]])
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def spatial(vector: np.ndarray) -> np.ndarray:
    """In three dimensions."""
    return np.concatenate([vector, np.full(3 - len(vector), sp.S.Zero)])


def tangent_frame(program: Program, tangent: np.ndarray, director: np.ndarray | None) -> np.ndarray:
    """A_t = [i j k] (eq 18): i along the tangent, k normal to tangent and director.

    In the plane [i j], whatever the director; in space without one, [i] is all that the tangent fixes. Eq 16 prints
    k = i x r_y/|r_y|, of unit length only where r_y is perpendicular to i: here the product is normalised. Singular
    where the director is along the tangent.
    """
    i = unit(program, "i", tangent)
    if len(tangent) == 2:
        return np.stack([i, cross(np.array([1]), i)], axis=1)
    if director is None:
        return i[:, None]
    k = unit(program, "k", program.vector("m", cross(i, director)))
    j = program.vector("j", cross(k, i))
    return np.stack([i, j, k], axis=1)
