"""The tangent frame of a cable's centreline (eq 13-18)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import sympy as sp

from ..codegen.program import Program


def unit(program: Program, name: str, vector: np.ndarray) -> np.ndarray:
    """Return vector / |vector|, named in the program."""
    inverse = program.define(f"inv_{name}", 1 / program.define(f"len_{name}", sp.sqrt(vector.dot(vector))))
    return program.vector(name, inverse * vector)


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the vector product a x b; for b in the plane, a is the component along z: (a,) times b turned by +90
    degrees.
    """
    if len(b) == 2:
        return np.asarray(a[0] * np.array([-b[1], b[0]]))
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def moment_of(arm: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Return arm x force, (3,), in the plane (1,)."""
    return cross(arm, force) if len(arm) == 3 else np.array([arm[0] * force[1] - arm[1] * force[0]])


def spatial(vector: np.ndarray | Sequence[Any]) -> np.ndarray:
    """Return a vector of the plane or of space with three components."""
    return np.concatenate([vector, np.full(3 - len(vector), sp.S.Zero)])


def tangent_frame(program: Program, tangent: np.ndarray, director: np.ndarray | None) -> np.ndarray:
    """Return A_t = [i j k], by columns: i along the tangent, k normal to tangent and director.

    In the plane [i j], whatever the director; in space without one, [i] alone. Eq 16 prints
    k = i x r_y/|r_y|, of unit length only where r_y is perpendicular to i: here the product is normalised. Singular
    where the director is along the tangent.
    """
    # i = dr/ds (eq 13) with ds = |r_x| dx (eq 14), so that i = r_x/|r_x| (eq 15)
    i = unit(program, "i", tangent)
    if len(tangent) == 2:
        return np.stack([i, cross(np.array([1]), i)], axis=1)
    if director is None:
        return i[:, None]
    k = unit(program, "k", program.vector("m", cross(i, director)))  # (eq 16)
    j = program.vector("j", cross(k, i))  # (eq 17)
    return np.stack([i, j, k], axis=1)  # (eq 18)


def turning(p: Program, A_t: np.ndarray, tangent: np.ndarray, director: np.ndarray | None = None) -> list[np.ndarray]:
    """Return the rotation rate of the frame for each entry of tangent and director.

    Derivatives of i would subtract i_x^2 from 1 and lose all digits where i is along an axis.
    """
    i, dim = A_t[:, 0], len(tangent)
    inverse = p.define("inv_t", 1 / p.define("t_i", tangent.dot(i)))
    units = np.eye(dim, dtype=int)
    across = [[i[0] * axis[1] - i[1] * axis[0]] if dim == 2 else cross(i, axis) for axis in units]
    omega = [inverse * np.array(w) for w in across]
    if director is not None:  # k stays normal to the director: about i, too
        k = A_t[:, 2]
        about = p.vector("about", k * p.define("inv_n", 1 / p.define("n_j", director.dot(A_t[:, 1]))))
        lean = p.define("lean", director.dot(i) * inverse)
        omega = [w - lean * part * i for w, part in zip(omega, about, strict=True)] + [part * i for part in about]
    return [p.vector(f"omega{m}", w) for m, w in enumerate(omega)]
