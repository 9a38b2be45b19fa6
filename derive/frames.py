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
    """Vector product."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def spatial(vector: np.ndarray) -> np.ndarray:
    """In three dimensions."""
    return np.concatenate([vector, np.full(3 - len(vector), sp.S.Zero)])


def tangent_frame(program: Program, tangent: np.ndarray, director: np.ndarray) -> np.ndarray:
    """A_t = [i j k] (eq 18): i along the tangent, k normal to tangent and director.

    Eq 16 prints k = i x r_y/|r_y|, of unit length only where r_y is perpendicular to i: here the product is
    normalised. Singular where the director is along the tangent.
    """
    i = unit(program, "i", tangent)
    k = unit(program, "k", program.vector("m", cross(i, director)))
    j = program.vector("j", cross(k, i))
    return np.stack([i, j, k], axis=1)
